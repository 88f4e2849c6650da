// A sheet falls on a ball; then the resolver keeps a vertex above a triangle out of it.
//
//   cargo build --release --package bowknot-capi
//   cc crates/capi/examples/drape.c -Icrates/capi/include -Ltarget/release -lbowknot_c -o drape
//   LD_LIBRARY_PATH=target/release ./drape

#include "bowknot.h"
#include <stdio.h>
#include <stdlib.h>

static const char *SCENE =
    "[[body]]\n"
    "name = \"sheet\"\n"
    "shape = { type = \"sheet\", size = [0.6, 0.6], edge = 0.04 }\n"
    "translate = [0, 0, 0.3]\n"
    "[[obstacle]]\n"
    "name = \"ball\"\n"
    "shape = { type = \"ball\", radius = 0.15 }\n"
    "translate = [0, 0, 0.13]\n";

static void must(BowknotStatus status) {
    if (status != BOWKNOT_STATUS_OK) {
        fprintf(stderr, "status %d: %s\n", (int)status, bowknot_error());
        exit(1);
    }
}

static void simulate(void) {
    BowknotSimulator *simulator = NULL;
    must(bowknot_simulator_new(SCENE, NULL, &simulator));
    BowknotStep step;
    for (int k = 0; k < 40; k++) must(bowknot_simulator_step(simulator, &step));

    size_t count = 3 * bowknot_simulator_vertices(simulator);
    double *positions = malloc(count * sizeof *positions);
    must(bowknot_simulator_positions(simulator, positions, count));
    BowknotBody sheet;
    must(bowknot_simulator_body(simulator, 0, &sheet));
    double lowest = 1e9;
    for (uint32_t v = sheet.first_vertex; v < sheet.first_vertex + sheet.vertices; v++)
        if (positions[3 * v + 2] < lowest) lowest = positions[3 * v + 2];

    size_t intersections = 0;
    must(bowknot_simulator_intersections(simulator, &intersections));
    printf("%s: %u vertices, time %.2f s, lowest at %.3f m, %zu intersections\n", sheet.name, sheet.vertices, step.time,
           lowest, intersections);

    // What is wrong comes with words, and nothing is lost.
    uint32_t none = 100000;
    if (bowknot_simulator_add_pin(simulator, "hand", "sheet", &none, 1) != BOWKNOT_STATUS_INPUT) exit(2);
    printf("refused: %s\n", bowknot_error());
    // A corner of the sheet, led up.
    uint32_t corner = 0;
    must(bowknot_simulator_add_pin(simulator, "hand", "sheet", &corner, 1));
    double target[3] = {positions[0], positions[1], positions[2]};
    for (int k = 0; k < 20; k++) {
        target[2] += 0.005;
        must(bowknot_simulator_set_pin_targets(simulator, "hand", target, 3));
        must(bowknot_simulator_step(simulator, NULL));
    }
    must(bowknot_simulator_positions(simulator, positions, count));
    printf("corner at %.3f m, led to %.3f m\n", positions[2], target[2]);
    free(positions);
    bowknot_simulator_free(simulator);
}

static void resolve(void) {
    // Two triangles above each other: a table and a leaf, of which the second is the obstacle's.
    double rest[18] = {0, 0, 0.1, 1, 0, 0.1, 0, 1, 0.1, -1, -1, 0, 2, -1, 0, -1, 2, 0};
    uint32_t triangles[6] = {0, 1, 2, 3, 4, 5};
    bool obstacle[6] = {false, false, false, true, true, true};
    BowknotMesh mesh = {0};
    mesh.rest = rest;
    mesh.vertices = 6;
    mesh.triangles = triangles;
    mesh.triangle_count = 2;
    mesh.obstacle = obstacle;
    mesh.delta = 0.01;
    BowknotResolver *resolver = NULL;
    must(bowknot_resolver_new(&mesh, &resolver));
    double x[18], y[18];
    for (int k = 0; k < 18; k++) x[k] = y[k] = rest[k];
    for (int v = 0; v < 3; v++) y[3 * v + 2] = -0.5; // through the table
    BowknotResolved resolved;
    must(bowknot_resolver_resolve(resolver, x, y, 18, 0.0, &resolved));
    size_t intersections = 1;
    must(bowknot_resolver_intersections(resolver, x, 18, &intersections));
    printf("leaf at %.4f m above the table, %zu intersections, converged %d\n", x[2], intersections, resolved.converged);
    // A state that intersects is no start.
    for (int v = 0; v < 3; v++) x[3 * v + 2] = v == 0 ? -0.1 : 0.1;
    if (bowknot_resolver_resolve(resolver, x, y, 18, 0.0, NULL) != BOWKNOT_STATUS_INTERSECTS) exit(3);
    printf("refused: %s\n", bowknot_error());
    bowknot_resolver_free(resolver);
}

int main(void) {
    simulate();
    resolve();
    return 0;
}
