use super::*;
use crate::body::Body;
use crate::elements::bending::add_bending;
use crate::elements::set::ElementKind;
use crate::linear::scalar::ScalarBuilder;
use crate::material::{ClothMaterial, RestShape};
use crate::model::DynamicsModel;
use crate::test_support::{
    Stream, check_balance, check_derivatives, check_gradient, check_positive, grid_triangles,
};
use bowknot_geometry::Point;
use nalgebra::Rotation3;

/// A triangle with a neighbor at each side, all in different planes.
const REST: [Vector; 6] = [
    Vector::new(0.0, 0.0, 0.0),
    Vector::new(1.0, 0.1, 0.2),
    Vector::new(0.3, 0.9, -0.1),
    Vector::new(1.2, 1.1, -0.4),
    Vector::new(-0.7, 0.6, -0.3),
    Vector::new(0.6, -0.9, -0.2),
];
const TRIANGLES: [[u32; 3]; 4] = [[0, 1, 2], [1, 3, 2], [0, 2, 4], [0, 5, 1]];

fn bend() -> CurvedBend<6> {
    let mut bends = CurvedBends::default();
    bends.add(&TRIANGLES, &REST, 3.0);
    assert_eq!((bends.one.len(), bends.two.len(), bends.three.len()), (3, 0, 1));
    bends.three.remove(0)
}

#[test]
fn the_gradient_matches_differences_and_the_hessian_at_rest_too() {
    let mut stream = Stream::new(1);
    let bend = bend();
    for (scale, amount) in [(1.0, 0.1), (1.3, 0.2), (0.7, 0.2)] {
        for _ in 0..20 {
            check_gradient(&bend, &stream.deformed(&REST, scale, amount), None);
        }
    }
    // Where the residuals vanish, the Gauss-Newton matrix is the exact Hessian.
    for _ in 0..5 {
        check_derivatives(&bend, &stream.deformed(&REST, 1.0, 0.0), None);
    }
}

#[test]
fn rigid_motions_store_no_energy_forces_balance_and_hessians_are_positive() {
    let mut stream = Stream::new(2);
    let bend = bend();
    for k in 0..20 {
        let turn = Rotation3::new(stream.vector() * 3.0);
        let shift = stream.vector() * 100.0;
        let x = REST.map(|x| turn * x + shift);
        let part = bend.linearize(&x, None, Filter::Clamp);
        assert!(part.energy < 1e-24 && part.gradient.iter().all(|g| g.norm() < 1e-11), "{:e}", part.energy);
        let x = stream.deformed(&REST, 0.1 * f64::from(k), 0.3);
        let part = bend.linearize(&x, None, Filter::Clamp);
        check_balance(&x, &part.gradient);
        check_positive(&part.hessian, "bend");
    }
    let part = bend.linearize(&[Vector::zeros(); 6], None, Filter::Clamp);
    check_positive(&part.hessian, "crushed");
}

#[test]
fn for_a_flat_rest_shape_it_equals_the_flat_form() {
    let flat = REST.map(|x| Vector::new(x.x, x.y, 0.0));
    let mut form = ScalarBuilder::new(6);
    add_bending(&TRIANGLES, &flat, 3.0, &mut form);
    let form = form.build();
    let mut bends = CurvedBends::default();
    bends.add(&TRIANGLES, &flat, 3.0);
    let mut stream = Stream::new(3);
    for _ in 0..10 {
        let x = stream.deformed(&REST, 1.0, 0.3);
        let four = |n: [u32; 4]| n.map(|n| x[n as usize]);
        let energy: f64 = bends.one.iter().map(|b| b.energy(&four(b.nodes()), None)).sum::<f64>()
            + bends.three[0].energy(&bends.three[0].nodes().map(|n| x[n as usize]), None);
        let expected = form.energy(&x);
        assert!((energy - expected).abs() < 1e-12 * expected, "{energy} {expected}");
    }
}

#[test]
fn a_tube_wall_bends_with_its_change_of_curvature() {
    // A part of a cylinder of radius R that is bent to radius R' without stretch: D/2 (1/R' - 1/R)^2 per
    // area.
    let (columns, rows, width, length) = (80u32, 8u32, 0.4, 0.2);
    let shape = |radius: f64| {
        let mut positions = Vec::new();
        for j in 0..=rows {
            for i in 0..=columns {
                let angle = width * (f64::from(i) / f64::from(columns) - 0.5) / radius;
                let y = length * f64::from(j) / f64::from(rows);
                positions.push(Vector::new(radius * angle.sin(), y, radius * (angle.cos() - 1.0)));
            }
        }
        positions
    };
    let triangles = grid_triangles(columns as usize, rows as usize, false);
    let rest = shape(0.15);
    let material =
        ClothMaterial { bend_stiffness: 1e-3, rest_shape: RestShape::Initial, ..ClothMaterial::cotton() };
    let points = |x: &[Vector]| -> Vec<Point> { x.iter().map(|v| (*v).into()).collect() };
    let body = Body::cloth("tube", triangles, material);
    let model = DynamicsModel::new(points(&rest), vec![body]).expect("valid");
    assert!(model.element_sets.iter().any(|set| set.kind() == ElementKind::Bending));
    assert!(model.elastic_energies(&points(&rest)).bending < 1e-24);
    for radius in [0.1, 0.2, 1.0, 1e6] {
        let bending = model.elastic_energies(&points(&shape(radius))).bending;
        let change: f64 = 1.0 / radius - 1.0 / 0.15;
        let expected = 0.5 * 1e-3 * change * change * width * length;
        // The flat form has the same error: the outermost triangles, 1 in 80, have no inner edge across the
        // bend.
        assert!((bending / expected - 1.0).abs() < 0.02, "radius {radius}: {bending:e} {expected:e}");
    }
}
