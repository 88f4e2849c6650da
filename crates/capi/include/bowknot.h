// Bowknot for C: simulator, resolver, judge. Made from crates/capi by its test; do not edit.
//
// Every function returns a BowknotStatus or a number that cannot fail; bowknot_error() has the words. What _new makes _free
// ends. A handle is used by one thread at a time; different ones are independent. Positions are x y z of each vertex, in m.

#ifndef BOWKNOT_H
#define BOWKNOT_H

#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

// Whether a call did what it was asked for; if not, `bowknot_error` says why.
typedef enum BowknotStatus {
  // It did.
  BOWKNOT_STATUS_OK = 0,
  // What was given is refused; nothing has changed.
  BOWKNOT_STATUS_INPUT = 1,
  // A state intersects that must not; nothing has changed.
  BOWKNOT_STATUS_INTERSECTS = 2,
  // A fault of the library itself. The handle can only be freed.
  BOWKNOT_STATUS_INTERNAL = 3,
} BowknotStatus;

// Moves positions toward targets without intersections, whatever computes the targets.
typedef struct BowknotResolver BowknotResolver;

// A running simulation.
typedef struct BowknotSimulator BowknotSimulator;

// What collides. Arrays may be NULL where their count is 0, or where it says so.
typedef struct BowknotMesh {
  // x y z of each vertex at rest [m].
  const double *rest;
  // How many vertices there are.
  size_t vertices;
  // Three vertices for each triangle.
  const uint32_t *triangles;
  // How many triangles there are.
  size_t triangle_count;
  // Two vertices for each edge of strands.
  const uint32_t *edges;
  // How many such edges there are.
  size_t edge_count;
  // Vertices that are grains.
  const uint32_t *particles;
  // How many grains there are.
  size_t particle_count;
  // Mass of each vertex [kg]. NULL: all have the same.
  const double *masses;
  // Whether each vertex belongs to an obstacle, which goes to its targets as they are. NULL: none does.
  const bool *obstacle;
  // Four numbers for each half-space: a normal and an offset [m]; what lies at n . x < offset is solid.
  const double *planes;
  // How many half-spaces there are.
  size_t plane_count;
  // Coefficient of Coulomb friction of everything.
  double friction;
  // Contact distance [m]; 0: a share of the edges' length.
  double delta;
  // Largest ratio of an edge's length to its rest length; 0: no limit.
  double stretch_limit;
} BowknotMesh;

// What a call did.
typedef struct BowknotResolved {
  // Whether no vertex wants to move any more.
  bool converged;
  // Two-way steps.
  uint32_t steps;
  // Smallest distance of a pair [m]; infinite if none is within reach.
  double min_gap;
  // Largest ratio of an edge's length to its rest length.
  double max_stretch;
} BowknotResolved;

// What a time step did.
typedef struct BowknotStep {
  // Number of the time step, from 1.
  uint64_t step;
  // Time at its end [s].
  double time;
  // Whether the time step was solved to its tolerance.
  bool solved;
  // Newton iterations.
  uint32_t newton_iterations;
  // Two-way steps.
  uint32_t two_way_steps;
  // Residual of the time step [m].
  double residual;
  // Smallest distance of a pair [m]; infinite if none is within reach.
  double min_gap;
  // Largest ratio of an edge's length to its rest length.
  double max_stretch;
  // Kinetic, elastic and potential energy [J].
  double energy[3];
} BowknotStep;

// A body or an obstacle with a mesh.
typedef struct BowknotBody {
  // Its name. It stays until the simulation is freed.
  const char *name;
  // Its first vertex that collides.
  uint32_t first_vertex;
  // How many vertices of it collide.
  uint32_t vertices;
  // Whether it is an obstacle.
  bool is_obstacle;
} BowknotBody;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

// The words to the last call of this thread that failed, empty if none has. They stay until another one fails.
const char *bowknot_error(void);

// Makes a resolver. The handle is written to `resolver`, NULL if the call fails. The arrays are copied.
//
// # Safety
// `mesh` points to a `BowknotMesh` whose arrays have the entries that it says; `resolver` points to a pointer.
enum BowknotStatus bowknot_resolver_new(const struct BowknotMesh *mesh, struct BowknotResolver **resolver);

// Frees a resolver; NULL does nothing.
//
// # Safety
// The handle is null or one of `bowknot_resolver_new` that has not been freed.
void bowknot_resolver_free(struct BowknotResolver *resolver);

// Moves `x` toward `y`, both x y z of each vertex [m], `count` numbers. `x` must be free of intersections: unless it is what
// the last call ended with, the judge looks at it. Where there is friction, `time_step` [s] is the time between both; 0: none.
// What the call did is written to `resolved`, unless that is NULL. If it fails `x` stays as it is.
//
// # Safety
// The handle is that of a resolver; both arrays have so many entries; `resolved` is null or points to a
// `BowknotResolved`.
enum BowknotStatus bowknot_resolver_resolve(struct BowknotResolver *resolver,
                                            double *x,
                                            const double *y,
                                            size_t count,
                                            double time_step,
                                            struct BowknotResolved *resolved);

// Judges a state, x y z of each vertex [m], with exact arithmetic: how many pairs intersect is written to `intersections`.
//
// # Safety
// The handle is that of a resolver; the array has so many entries; `intersections` points to a number.
enum BowknotStatus bowknot_resolver_intersections(const struct BowknotResolver *resolver,
                                                  const double *x,
                                                  size_t count,
                                                  size_t *intersections);

// Contact distance [m]: pairs nearer than this press on each other. NaN for NULL.
//
// # Safety
// The handle is null or that of a resolver.
double bowknot_resolver_delta(const struct BowknotResolver *resolver);

// Makes a simulation of a scene: the `toml` of a scene file, whose paths are relative to `folder` (NULL: to the current
// folder). The handle is written to `simulator`, NULL if the call fails. A start that intersects is refused.
//
// # Safety
// Both texts are null or end with a zero; `simulator` is null or points to a pointer.
enum BowknotStatus bowknot_simulator_new(const char *toml, const char *folder, struct BowknotSimulator **simulator);

// Frees a simulation; NULL does nothing.
//
// # Safety
// The handle is null or one of `bowknot_simulator_new` that has not been freed.
void bowknot_simulator_free(struct BowknotSimulator *simulator);

// Makes one time step. What it did is written to `step`, unless that is NULL. If it fails the state is that before.
//
// # Safety
// The handle is that of a simulation; `step` is null or points to a `BowknotStep`.
enum BowknotStatus bowknot_simulator_step(struct BowknotSimulator *simulator, struct BowknotStep *step);

// How many vertices there are: of deformable bodies, then of obstacles, then those that do not collide (inside of solids).
//
// # Safety
// The handle is null, for which there are none, or that of a simulation.
size_t bowknot_simulator_vertices(const struct BowknotSimulator *simulator);

// Writes x y z of each vertex [m]. `count` is the room of the array, three numbers per vertex.
//
// # Safety
// The handle is that of a simulation; the array has that much room.
enum BowknotStatus bowknot_simulator_positions(const struct BowknotSimulator *simulator,
                                               double *positions,
                                               size_t count);

// Writes the velocities [m/s], as `bowknot_simulator_positions` does positions.
//
// # Safety
// As for `bowknot_simulator_positions`.
enum BowknotStatus bowknot_simulator_velocities(const struct BowknotSimulator *simulator,
                                                double *velocities,
                                                size_t count);

// Writes the vertices of the triangles, three for each, and how many numbers that are to `count`, which holds the room of
// the array before. With NULL as `triangles` it only counts.
//
// # Safety
// The handle is that of a simulation; `count` points to a number; the array is null or has that much room.
enum BowknotStatus bowknot_simulator_triangles(const struct BowknotSimulator *simulator,
                                               uint32_t *triangles,
                                               size_t *count);

// Writes the vertices of the edges of strands, two for each, as `bowknot_simulator_triangles` does triangles.
//
// # Safety
// As for `bowknot_simulator_triangles`.
enum BowknotStatus bowknot_simulator_edges(const struct BowknotSimulator *simulator, uint32_t *edges, size_t *count);

// How many bodies and obstacles with a mesh there are.
//
// # Safety
// The handle is null, for which there are none, or that of a simulation.
size_t bowknot_simulator_bodies(const struct BowknotSimulator *simulator);

// Tells of the body or obstacle of an `index`.
//
// # Safety
// The handle is that of a simulation; `body` points to a `BowknotBody`.
enum BowknotStatus bowknot_simulator_body(const struct BowknotSimulator *simulator,
                                          size_t index,
                                          struct BowknotBody *body);

// Adds a pin that holds `count` vertices of a body where they are. They are numbered as in the body's mesh, from 0.
//
// # Safety
// The handle is that of a simulation; the texts end with a zero; the array has so many entries.
enum BowknotStatus bowknot_simulator_add_pin(struct BowknotSimulator *simulator,
                                             const char *name,
                                             const char *body,
                                             const uint32_t *vertices,
                                             size_t count);

// Leads the vertices of a pin to `targets` at the end of the next time step: x y z for each of its vertices [m], `count`
// numbers together. They go there without cutting through anything, and wait where they cannot.
//
// # Safety
// As for `bowknot_simulator_add_pin`.
enum BowknotStatus bowknot_simulator_set_pin_targets(struct BowknotSimulator *simulator,
                                                     const char *name,
                                                     const double *targets,
                                                     size_t count);

// Removes a pin.
//
// # Safety
// The handle is that of a simulation; the text ends with a zero.
enum BowknotStatus bowknot_simulator_remove_pin(struct BowknotSimulator *simulator, const char *name);

// Leads an obstacle: x y z of each vertex of its mesh at the end of the next time step [m], `count` numbers together.
//
// # Safety
// As for `bowknot_simulator_add_pin`.
enum BowknotStatus bowknot_simulator_set_obstacle_targets(struct BowknotSimulator *simulator,
                                                          const char *name,
                                                          const double *targets,
                                                          size_t count);

// Sets the acceleration of gravity [m/s^2].
//
// # Safety
// The handle is that of a simulation.
enum BowknotStatus bowknot_simulator_set_gravity(struct BowknotSimulator *simulator, double x, double y, double z);

// Judges the present state with exact arithmetic: how many pairs intersect is written to `count`.
//
// # Safety
// The handle is that of a simulation; `count` points to a number.
enum BowknotStatus bowknot_simulator_intersections(const struct BowknotSimulator *simulator, size_t *count);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* BOWKNOT_H */
