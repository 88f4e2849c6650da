use super::super::tests::euler;
use super::*;
use bowknot_geometry::{Vector, check_mesh};
use std::collections::BTreeMap;

#[test]
fn the_mesh_is_closed_and_its_triangles_well_shaped_at_every_resolution() {
    for edge in [0.011, 0.013, 0.0171, 0.02, 0.0235, 0.0263, 0.03] {
        let mesh = Figure { edge, ..Figure::default() }.mesh();
        assert_eq!(check_mesh(&mesh.positions, &mesh.triangles), [], "edge {edge}");
        assert_eq!(euler(&mesh), 2, "edge {edge}");
        let mut directed: BTreeMap<(u32, u32), u32> = BTreeMap::new();
        let (mut volume, mut lengths, mut worst) = (0.0, 0.0, f64::INFINITY);
        for &[a, b, c] in &mesh.triangles {
            for side in [(a, b), (b, c), (c, a)] {
                *directed.entry(side).or_default() += 1;
            }
            let [p, q, r] = [a, b, c].map(|v| mesh.positions[v as usize].coords);
            volume += p.dot(&q.cross(&r)) / 6.0;
            let sides = [(q - p).norm(), (r - q).norm(), (p - r).norm()];
            lengths += sides.iter().sum::<f64>() / 3.0;
            // 1 for an equilateral triangle, 0 for a flat one.
            let area = 0.5 * (q - p).cross(&(r - p)).norm();
            worst = f64::min(worst, 4.0 * 3.0f64.sqrt() * area / sides.iter().map(|s| s * s).sum::<f64>());
        }
        for (&(a, b), &count) in &directed {
            assert_eq!((count, directed.get(&(b, a))), (1, Some(&1)), "edge {edge}: {a} to {b}");
        }
        // Of a person of 60 kg, about.
        assert!((0.05..0.07).contains(&volume), "edge {edge}: {volume} m^3");
        let mean = lengths / mesh.triangles.len() as f64;
        assert!((0.85..1.1).contains(&(mean / edge)), "edge {edge}: mean {mean}");
        assert!(worst > 0.15, "edge {edge}: quality {worst}");
    }
}

#[test]
fn the_mesh_lies_on_the_body() {
    let body = RestBody::new();
    let mesh = Figure::default().mesh();
    let farthest = mesh.positions.iter().map(|p| body.field(p).abs()).fold(0.0, f64::max);
    assert!(farthest < 2e-4, "{farthest} m");
    let top = mesh.positions.iter().map(|p| p.z).fold(0.0, f64::max);
    assert!((top - 1.7).abs() < 2e-3, "{top} m tall");
}

/// The field is at most the distance: what garments rely on.
#[test]
fn the_field_is_nowhere_steeper_than_one() {
    let body = RestBody::new();
    let at = |k: u32| {
        let u = |n: f64| (f64::from(k) * n).fract();
        Point::new(-0.3 + 0.6 * u(0.618_034), -0.7 + 1.4 * u(0.414_214), 1.8 * u(0.732_051))
    };
    for k in 0..4000 {
        let (p, q) = (at(k), at(k + 1));
        let q = p + (q - p) * (0.001 + 0.3 * f64::from(k % 7));
        let rise = (body.field(&p) - body.field(&q)).abs();
        assert!(rise <= (p - q).norm() * (1.0 + 1e-9), "from {p} to {q}: {rise}");
    }
}

fn walker() -> AnimatedFigure {
    AnimatedFigure::new(Figure {
        edge: 0.03,
        turn_rate: 120.0,
        turn_start: 2.0,
        turn_end: 3.0,
        end: 4.0,
        ..Figure::default()
    })
}

#[test]
fn the_motion_is_smooth_and_begins_at_rest() {
    let figure = walker();
    let (dt, mut last, mut speeds) = (1.0 / 200.0, figure.positions(0.0), vec![]);
    for (p, q) in last.iter().zip(&figure.mesh().positions) {
        assert!((p - q).norm() < 1e-12);
    }
    let (mut fastest, mut jerk) = (0.0f64, 0.0f64);
    for step in 1..=1000 {
        let next = figure.positions(f64::from(step) * dt);
        let velocities: Vec<Vector> = next.iter().zip(&last).map(|(p, q)| (p - q) / dt).collect();
        fastest = velocities.iter().map(Vector::norm).fold(fastest, f64::max);
        if !speeds.is_empty() {
            let change = |(v, u): (&Vector, &Vector)| (v - u).norm() / dt;
            jerk = velocities.iter().zip(&speeds).map(change).fold(jerk, f64::max);
        }
        (last, speeds) = (next, velocities);
    }
    // Walking at 1 m/s moves a foot three to four times as fast.
    assert!((2.0..5.0).contains(&fastest), "{fastest} m/s");
    assert!(jerk < 60.0, "{jerk} m/s^2");
    // It has stopped.
    assert!(speeds.iter().all(|v| v.norm() < 1e-9));
}

#[test]
fn it_goes_where_it_is_told() {
    let walk = Figure { start: 1.0, ease: 0.5, walk_speed: 2.0, ..Figure::default() };
    // Half of the easing counts.
    assert!((walk.pose(3.0).place - Vector::x() * 2.0 * 1.75).norm() < 1e-12);
    let turn = Figure { turn_rate: 90.0, turn_start: 0.5, turn_end: 1.5, ..walk };
    assert!((turn.pose(3.0).heading - std::f64::consts::FRAC_PI_2).abs() < 1e-12);
    // A circle of radius v / w, once both are steady: the distance from its center stays.
    let circle = Figure { start: 0.0, ease: 0.0, walk_speed: 1.0, turn_rate: 180.0, ..Figure::default() };
    let radius = 1.0 / std::f64::consts::PI;
    for time in [0.25, 0.5, 1.3, 2.0] {
        let from_center = circle.pose(time).place - Vector::new(0.0, radius, 0.0);
        assert!((from_center.norm() - radius).abs() < 1e-5, "at {time}");
    }
    assert!(circle.pose(2.0).place.norm() < 1e-5);
}

/// Cloth between them would be pinched.
#[test]
fn limbs_keep_their_distance() {
    let figure = walker();
    let rest = &figure.mesh().positions;
    let select =
        |keep: &dyn Fn(&Point) -> bool| (0..rest.len()).filter(|v| keep(&rest[*v])).collect::<Vec<_>>();
    let legs = [1.0, -1.0].map(|sign| select(&|p: &Point| p.z < 0.6 && sign * p.y > 0.0));
    let arms = select(&|p: &Point| p.y.abs() > 0.27);
    let trunk = select(&|p: &Point| p.y.abs() < 0.2 && p.z < 1.26);
    for step in 0..60 {
        let time = 0.08 * f64::from(step);
        let x = figure.positions(time);
        let nearest = |a: &[usize], b: &[usize]| {
            let to = |v: &usize| b.iter().map(|w| (x[*v] - x[*w]).norm()).fold(f64::INFINITY, f64::min);
            a.iter().map(to).fold(f64::INFINITY, f64::min)
        };
        let (between, aside) = (nearest(&legs[0], &legs[1]), nearest(&arms, &trunk));
        assert!(between > 0.04, "at {time} s the legs are {between} m apart");
        assert!(aside > 0.03, "at {time} s an arm is {aside} m from the body");
    }
}
