use super::*;
use crate::material::{RestShape, StrandMaterial};
use crate::test_support::{Stream, check_balance, check_derivatives, check_positive};
use nalgebra::Rotation3;

const BENT: [Vector; 3] =
    [Vector::new(0.1, 0.2, 0.3), Vector::new(1.0, 0.1, 0.2), Vector::new(1.5, 0.9, 0.6)];

fn edge(damping: f64) -> StrandEdge {
    StrandEdge::new([0, 1], &[BENT[0], BENT[1]], 40.0, damping).expect("it has a length")
}

fn turn(straight: bool, damping: f64) -> StrandTurn {
    StrandTurn::new([0, 1, 2], &BENT, straight, 30.0, damping).expect("they have lengths")
}

#[test]
fn derivatives_match_differences() {
    let mut stream = Stream::new(1);
    for scale in [0.6, 1.0, 1.7] {
        for _ in 0..20 {
            let (x0, x) = (stream.deformed(&BENT, 1.0, 0.1), stream.deformed(&BENT, scale, 0.1));
            let (ends0, ends) = ([x0[0], x0[1]], [x[0], x[1]]);
            check_derivatives(&edge(0.0), &ends, None);
            check_derivatives(&edge(0.05), &ends, Some(Start { x: &ends0, rate: 20.0 }));
            for straight in [true, false] {
                check_derivatives(&turn(straight, 0.0), &x, None);
                check_derivatives(&turn(straight, 0.05), &x, Some(Start { x: &x0, rate: 20.0 }));
            }
        }
    }
}

#[test]
fn rigid_motions_store_no_energy_and_forces_balance() {
    let mut stream = Stream::new(2);
    for _ in 0..20 {
        let rotation = Rotation3::new(stream.vector() * 3.0);
        let shift = stream.vector() * 100.0;
        let x = BENT.map(|x| rotation * x + shift);
        let part = turn(false, 0.0).linearize(&x, None, Filter::Clamp);
        assert!(part.energy < 1e-24 && part.gradient.iter().all(|g| g.norm() < 1e-10), "{}", part.energy);
        let ends = [x[0], x[1]];
        let start = Start { x: &[BENT[0], BENT[1]], rate: 20.0 };
        let part = edge(0.1).linearize(&ends, Some(start), Filter::Clamp);
        assert!(part.energy < 1e-24 && part.gradient.iter().all(|g| g.norm() < 1e-10), "{}", part.energy);

        let x = stream.deformed(&BENT, 0.8, 0.3);
        check_balance(&x, &turn(false, 0.0).linearize(&x, None, Filter::Clamp).gradient);
        let part = edge(0.1).linearize(&[x[0], x[1]], Some(start), Filter::Clamp);
        check_balance(&[x[0], x[1]], &part.gradient);
    }
}

#[test]
fn filtered_hessians_are_positive_also_of_crushed_strands() {
    let mut stream = Stream::new(3);
    let mut states: Vec<[Vector; 3]> =
        (0..50).map(|k| stream.deformed(&BENT, 0.03 * k as f64, 0.2)).collect();
    states.push([Vector::zeros(); 3]);
    states.push([Vector::zeros(), Vector::x(), Vector::x() * 2.0]);
    for x in &states {
        for filter in [Filter::Clamp, Filter::Absolute] {
            let start = Start { x: &BENT, rate: 20.0 };
            for straight in [true, false] {
                let part = turn(straight, 0.02).linearize(x, Some(start), filter);
                check_positive(&part.hessian, "turn");
                assert!(part.gradient.iter().flat_map(|g| g.iter()).all(|g| g.is_finite()));
            }
            let start = Start { x: &[BENT[0], BENT[1]], rate: 20.0 };
            let part = edge(0.02).linearize(&[x[0], x[1]], Some(start), filter);
            check_positive(&part.hessian, "edge");
            assert!(part.gradient.iter().flat_map(|g| g.iter()).all(|g| g.is_finite()));
        }
    }
}

#[test]
fn a_stretched_edge_pulls_with_ea_times_strain() {
    let edge = StrandEdge::new([0, 1], &[Vector::zeros(), Vector::x() * 0.2], 40.0, 0.0).expect("length");
    let part = edge.linearize(&[Vector::zeros(), Vector::x() * 0.202], None, Filter::Clamp);
    assert!((part.gradient[1] - Vector::x() * 0.4).norm() < 1e-12);
    assert!((part.energy - 0.5 * 40.0 * 0.2 * 0.01 * 0.01).abs() < 1e-14);
}

#[test]
fn a_ring_bends_with_ei_over_two_r() {
    // A straight strand that is closed to a ring of radius R has the energy EI/2 * 2 pi R / R^2, to second
    // order in the edge length. A strand whose rest shape is the ring has none.
    let (radius, count) = (0.3, 120);
    let at = |k: u32| {
        let angle = 2.0 * std::f64::consts::PI * f64::from(k) / f64::from(count);
        Vector::new(radius * angle.cos(), radius * angle.sin(), 0.0)
    };
    let ring: Vec<Vector> = (0..count).map(at).collect();
    let edges: Vec<[u32; 2]> = (0..count).map(|k| [k, (k + 1) % count]).collect();
    let mut material =
        StrandMaterial { bend_stiffness: 0.02, rest_shape: RestShape::Flat, ..StrandMaterial::rope() };
    let energy = |material: &StrandMaterial| {
        let (springs, turns) = strand_elements(&edges, &ring, material);
        assert_eq!((springs.len(), turns.len()), (120, 120));
        turns.iter().map(|t| t.energy(&t.nodes.map(|n| ring[n as usize]), None)).sum::<f64>()
    };
    let expected = 0.5 * 0.02 * 2.0 * std::f64::consts::PI / radius;
    let found = energy(&material);
    assert!((found - expected).abs() < 1e-3 * expected, "{found} {expected}");
    material.rest_shape = RestShape::Initial;
    assert!(energy(&material) < 1e-24);
}

#[test]
fn a_path_through_a_branching_vertex_bends_nearly_as_without_branches() {
    // A straight path a b c with a side branch d is bent at b by a small angle; d is free to rotate.
    let material = StrandMaterial { bend_stiffness: 1.0, ..StrandMaterial::rope() };
    let rest = [-Vector::x(), Vector::zeros(), Vector::x(), Vector::y()];
    let energy = |edges: &[[u32; 2]], x: &[Vector; 4]| {
        let (_, turns) = strand_elements(edges, &rest, &material);
        turns.iter().map(|t| t.energy(&t.nodes.map(|n| x[n as usize]), None)).sum::<f64>()
    };
    // The path is bent in the plane of the branch; `branch` is the angle between the branch and the y axis.
    let angle: f64 = 1e-3;
    let at = |branch: f64| {
        let mut x = rest;
        x[2] = Vector::new(angle.cos(), angle.sin(), 0.0);
        x[3] = Vector::new(-branch.sin(), branch.cos(), 0.0);
        x
    };
    let path = energy(&[[0, 1], [1, 2]], &at(0.0));
    let branched = |branch: f64| energy(&[[0, 1], [1, 2], [1, 3]], &at(branch));
    let smallest = (0..=200).map(|k| branched(angle * k as f64 / 200.0)).fold(f64::INFINITY, f64::min);
    // Bending between perpendicular edges has the weight cos^2(45 degrees) = 1/2 relative to that between
    // straight ones. The energy with the branch is therefore 2/3 (1 + 1/2 * 1/2) = 5/6 of that of the path.
    assert!((smallest / path - 5.0 / 6.0).abs() < 1e-3, "{smallest} {path}");
}
