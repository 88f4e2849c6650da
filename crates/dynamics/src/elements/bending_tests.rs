use super::*;
use crate::linear::scalar::ScalarForm;
use nalgebra::Rotation3;

/// A sheet of `n` x `n` cells of size `h`, alternating diagonals or parallel ones, sheared by `shear`.
fn grid(n: usize, h: f64, shear: f64, alternate: bool) -> (Vec<Vector>, Vec<[u32; 3]>) {
    let index = |i: usize, j: usize| (i + j * (n + 1)) as u32;
    let mut positions = Vec::new();
    let mut triangles = Vec::new();
    for j in 0..=n {
        for i in 0..=n {
            positions.push(Vector::new(i as f64 * h + shear * j as f64 * h, j as f64 * h, 0.0));
            if i < n && j < n {
                let (a, b, c, d) = (index(i, j), index(i + 1, j), index(i + 1, j + 1), index(i, j + 1));
                if alternate && (i + j) % 2 == 1 {
                    triangles.extend([[a, b, d], [b, c, d]]);
                } else {
                    triangles.extend([[a, b, c], [a, c, d]]);
                }
            }
        }
    }
    (positions, triangles)
}

fn form(positions: &[Vector], triangles: &[[u32; 3]], stiffness: f64) -> ScalarForm {
    let mut builder = ScalarBuilder::new(positions.len());
    add_bending(triangles, positions, stiffness, &mut builder);
    builder.build()
}

/// Energy over (area * D / 2) of w = 1/2 x^T K x with the given curvatures.
fn ratio(positions: &[Vector], triangles: &[[u32; 3]], [xx, yy, xy]: [f64; 3]) -> f64 {
    let bent: Vec<Vector> = positions
        .iter()
        .map(|p| Vector::new(0.0, 0.0, 0.5 * (xx * p.x * p.x + yy * p.y * p.y) + xy * p.x * p.y))
        .collect();
    let area: f64 = triangles
        .iter()
        .map(|t| {
            let [a, b, c] = t.map(|v| positions[v as usize]);
            0.5 * (b - a).cross(&(c - a)).norm()
        })
        .sum();
    2.0 * form(positions, triangles, 1.0).energy(&bent) / area
}

#[test]
fn constant_curvature_costs_what_a_plate_costs() {
    // Free edges give their share of up to 2/n away, so look at the trend: 40 cells a side.
    for (shear, alternate, name) in [(0.0, false, "right"), (0.5, false, "equilateral-like")] {
        let (positions, triangles) = grid(40, 0.025, shear, alternate);
        for curvature in
            [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 1.0], [0.5, 0.5, -0.5], [0.0, 0.0, 1.0]]
        {
            let [xx, yy, xy] = curvature;
            let exact = xx * xx + yy * yy + 2.0 * xy * xy;
            let found = ratio(&positions, &triangles, curvature) / exact;
            assert!((0.90..1.001).contains(&found), "{name} {curvature:?}: {found}");
        }
    }
    // Alternating diagonals are no affine image of a regular mesh: exact along the mesh lines, half as
    // much again for a cylinder along a diagonal, twice for twist (the README says so).
    let (positions, triangles) = grid(40, 0.025, 0.0, true);
    for (curvature, exact, expected) in [
        ([1.0, 0.0, 0.0], 1.0, 1.0),
        ([0.0, 1.0, 0.0], 1.0, 1.0),
        ([1.0, 1.0, 1.0], 4.0, 1.5),
        ([0.0, 0.0, 1.0], 2.0, 2.0),
    ] {
        let found = ratio(&positions, &triangles, curvature) / exact;
        assert!((found - expected).abs() < 0.03, "alternating {curvature:?}: {found}");
    }
}

#[test]
fn flat_states_and_rigid_motions_cost_nothing() {
    let (positions, triangles) = grid(10, 0.1, 0.3, true);
    let form = form(&positions, &triangles, 1.0);
    let turn = Rotation3::new(Vector::new(0.4, -1.0, 2.0));
    for moved in [
        positions.iter().map(|p| turn * p + Vector::new(1e3, -2e3, 5e2)).collect::<Vec<_>>(),
        positions.iter().map(|p| Vector::new(2.0 * p.x + p.y, 0.3 * p.y, p.x)).collect(),
    ] {
        // Entries are near 100; coordinates of 1e3 round to 1e-13, so energies to 100 * 1e-26 an entry.
        let energy = form.energy(&moved);
        assert!(energy.abs() < 1e-12, "{energy:e}");
        let force = (0..moved.len()).map(|n| form.product(n, &moved).norm()).fold(0.0, f64::max);
        assert!(force < 1e-9, "{force:e}");
    }
}

#[test]
fn only_flat_states_cost_nothing() {
    // Null space of the form on one coordinate: constants and the two linear functions.
    let (positions, triangles) = grid(4, 0.25, 0.2, true);
    let form = form(&positions, &triangles, 1.0);
    let count = positions.len();
    let mut matrix = nalgebra::DMatrix::zeros(count, count);
    for row in 0..count {
        let (columns, values) = form.row(row);
        matrix[(row, row)] = form.diagonal[row];
        columns.iter().zip(values).for_each(|(&c, &v)| matrix[(row, c as usize)] = v);
    }
    assert!((&matrix - matrix.transpose()).abs().max() == 0.0, "symmetric to the bit");
    let mut eigenvalues: Vec<f64> = matrix.symmetric_eigenvalues().iter().copied().collect();
    eigenvalues.sort_by(f64::total_cmp);
    let largest = eigenvalues[count - 1];
    assert!(eigenvalues[..3].iter().all(|e| e.abs() < 1e-12 * largest), "{:?}", &eigenvalues[..5]);
    // Two corners of alternating diagonals are single triangles that may flap freely about their one
    // inner edge only at a cost, too.
    assert!(eigenvalues[3] > 1e-6 * largest, "{:?}", &eigenvalues[..5]);
}

#[test]
fn the_gradient_matches_differences_of_the_energy() {
    let (positions, triangles) = grid(3, 0.3, 0.1, true);
    let form = form(&positions, &triangles, 2.0);
    let mut x: Vec<Vector> =
        positions.iter().enumerate().map(|(k, p)| p + Vector::new(0.0, 0.1, (k as f64).sin())).collect();
    let h = 1e-4;
    for node in 0..x.len() {
        for axis in 0..3 {
            let here = x[node][axis];
            x[node][axis] = here + h;
            let plus = form.energy(&x);
            x[node][axis] = here - h;
            let minus = form.energy(&x);
            x[node][axis] = here;
            // Quadratic: central differences are exact up to rounding.
            let slope = (plus - minus) / (2.0 * h);
            let gradient = form.product(node, &x)[axis];
            assert!((slope - gradient).abs() < 1e-8 * (1.0 + gradient.abs()), "{slope} {gradient}");
        }
    }
}

#[test]
fn closed_surfaces_and_shared_far_vertices_are_handled() {
    // A tetrahedron: every vertex across an edge is the far corner of all neighbours.
    let positions = [
        Vector::new(0.0, 0.0, 0.0),
        Vector::new(1.0, 0.0, 0.0),
        Vector::new(0.0, 1.0, 0.0),
        Vector::new(0.0, 0.0, 1.0),
    ];
    let triangles = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]];
    let form = form(&positions, &triangles, 1.0);
    assert!(form.values.iter().all(|v| v.is_finite()));
    assert!(form.energy(&positions) > 0.1);
}

#[test]
fn edges_of_three_triangles_do_not_bend() {
    // Three pages of a book: the spine is a free edge for each.
    let turn = |angle: f64| Vector::new(angle.cos(), 0.5, angle.sin());
    let positions = [Vector::zeros(), Vector::new(0.0, 1.0, 0.0), turn(0.0), turn(2.0), turn(4.0)];
    let triangles = [[0, 1, 2], [0, 1, 3], [0, 1, 4]];
    assert!(form(&positions, &triangles, 1.0).values.is_empty());
}
