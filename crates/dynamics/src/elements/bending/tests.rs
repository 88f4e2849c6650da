use super::*;
use crate::linear::scalar::ScalarForm;
use crate::test_support::grid_triangles;
use nalgebra::Rotation3;

/// A sheet of `n` x `n` cells of size `h` with alternating or parallel diagonals, sheared by `shear`.
fn grid(n: usize, h: f64, shear: f64, alternate: bool) -> (Vec<Vector>, Vec<[u32; 3]>) {
    let vertices = (0..=n).flat_map(|j| (0..=n).map(move |i| (i, j)));
    let position =
        |(i, j): (usize, usize)| Vector::new(i as f64 * h + shear * j as f64 * h, j as f64 * h, 0.0);
    (vertices.map(position).collect(), grid_triangles(n, n, alternate))
}

fn form(positions: &[Vector], triangles: &[[u32; 3]], stiffness: f64) -> ScalarForm {
    let mut builder = ScalarBuilder::new(positions.len());
    add_bending(triangles, positions, stiffness, &mut builder);
    builder.build()
}

/// Energy over (area * D / 2) of the surface w = 1/2 x^T K x with the given curvatures K.
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
fn constant_curvature_has_the_energy_of_a_plate() {
    // Triangles at free edges store less energy, up to 2/n of the whole: n is 40 here.
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
    // Alternating diagonals are not an affine image of a regular mesh. The energy is exact along the mesh
    // lines, 1.5 times that of the plate for a cylinder along a diagonal, and twice for twist (see the
    // README).
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
fn flat_states_and_rigid_motions_store_no_energy() {
    let (positions, triangles) = grid(10, 0.1, 0.3, true);
    let form = form(&positions, &triangles, 1.0);
    let turn = Rotation3::new(Vector::new(0.4, -1.0, 2.0));
    for moved in [
        positions.iter().map(|p| turn * p + Vector::new(1e3, -2e3, 5e2)).collect::<Vec<_>>(),
        positions.iter().map(|p| Vector::new(2.0 * p.x + p.y, 0.3 * p.y, p.x)).collect(),
    ] {
        // Entries are near 100; coordinates of 1e3 round to 1e-13, and energies to 100 * 1e-26 per entry.
        let energy = form.energy(&moved);
        assert!(energy.abs() < 1e-12, "{energy:e}");
        let force = (0..moved.len()).map(|n| form.product(n, &moved).norm()).fold(0.0, f64::max);
        assert!(force < 1e-9, "{force:e}");
    }
}

#[test]
fn only_flat_states_store_no_energy() {
    // The null space of the form on one coordinate consists of the constants and the two linear functions.
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
    // Two corners of the sheet are single triangles with one inner edge. They, too, store energy when they
    // bend about it.
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
    // On a tetrahedron the vertices beyond the three edges of a triangle coincide.
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
    // Three pages of a book: the spine is a free edge of each.
    let turn = |angle: f64| Vector::new(angle.cos(), 0.5, angle.sin());
    let positions = [Vector::zeros(), Vector::new(0.0, 1.0, 0.0), turn(0.0), turn(2.0), turn(4.0)];
    let triangles = [[0, 1, 2], [0, 1, 3], [0, 1, 4]];
    assert!(form(&positions, &triangles, 1.0).values.is_empty());
}
