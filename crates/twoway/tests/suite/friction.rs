//! Coulomb friction in the backward step, against closed forms; and the velocity filter.
#![allow(clippy::unwrap_used)] // helpers of tests are outside the functions that the lint knows as tests

use crate::common::{Flight, sheet};
use bowknot_constraints::FrictionModel;
use bowknot_geometry::{HalfSpace, Point, Topology, Vector};
use bowknot_proximity::{BodyFilter, CollisionModel};
use bowknot_twoway::{
    BodyContact, ContactData, ContactSide, HalfSpaceContact, PairFriction, Params, Resolver,
};

const G: f64 = 9.81;
const H: f64 = 0.05;

fn rough(friction: f64) -> BodyContact {
    BodyContact { friction, ..BodyContact::default() }
}

/// A patch of cloth, or one particle, at rest on an inclined half-space.
fn incline(slope: f64, friction: f64, particle: bool, params: Params) -> (Flight, Vector, usize) {
    let angle = slope.atan();
    let normal = Vector::new(-angle.sin(), 0.0, angle.cos());
    let down = Vector::new(-angle.cos(), 0.0, -angle.sin());
    let (mut x, mut triangles) = (Vec::new(), Vec::new());
    let delta = 0.1 * H;
    if particle {
        x.push(Point::origin());
    } else {
        sheet(4, H, 0.0, &mut x, &mut triangles);
    }
    let side = normal.cross(&down);
    let x: Vec<Point> =
        x.iter().map(|p| Point::origin() + p.x * down + p.y * side + delta * normal).collect();
    let particles: &[u32] = if particle { &[0] } else { &[] };
    let topology =
        Topology::builder(x.len()).triangles(triangles).particles(particles.iter().copied()).build().unwrap();
    let plane = HalfSpace::new(Point::origin(), normal).unwrap();
    let bodies = vec![0; x.len()];
    let model = CollisionModel::new(topology, bodies, vec![BodyFilter::DEFORMABLE], vec![plane]).unwrap();
    let mut params = params;
    params.contact.delta = Some(delta);
    let count = x.len();
    let contact = ContactData {
        bodies: vec![rough(friction)],
        half_spaces: vec![HalfSpaceContact { friction, ..HalfSpaceContact::default() }],
        ..ContactData::default()
    };
    let resolver = Resolver::with_contact(model, &x, &vec![1.0; count], contact, params).unwrap();
    let v = vec![Vector::zeros(); count];
    (Flight { resolver, x, v, gravity: -G * Vector::z(), dt: 0.01 }, down, count)
}

#[test]
fn below_the_angle_of_friction_a_patch_and_a_particle_stick() {
    for particle in [false, true] {
        let (mut flight, _, count) = incline(0.45, 0.5, particle, Params::fast());
        let start = flight.x.clone();
        for _ in 0..200 {
            let report = flight.step(|_, _| None);
            assert!(report.converged && report.sticking_contacts == count, "{report:?}");
        }
        // In these two seconds a body without friction slides by 8 m.
        let slip = flight.x.iter().zip(&start).map(|(x, s)| (x - s).norm()).fold(0.0, f64::max);
        assert!(slip < 1e-9, "slipped by {slip} m");
    }
}

#[test]
fn above_the_angle_of_friction_they_slide_with_the_remaining_acceleration() {
    for (slope, friction) in [(0.6, 0.5), (1.0, 0.2), (0.5, 0.01)] {
        for particle in [false, true] {
            let (mut flight, down, count) = incline(slope, friction, particle, Params::fast());
            let steps = 50;
            for _ in 0..steps {
                let report = flight.step(|_, _| None);
                assert!(report.converged, "{report:?}");
                assert_eq!(report.friction_rows, count);
            }
            let angle: f64 = f64::atan(slope);
            let expected = G * (angle.sin() - friction * angle.cos());
            let found = flight.velocity(count).dot(&down) / (f64::from(steps) * flight.dt);
            assert!(
                (found / expected - 1.0).abs() < 0.02,
                "{found} against {expected} at slope {slope}, mu {friction}, particle {particle}"
            );
        }
    }
}

#[test]
fn friction_dissipates_energy_and_stops_a_sliding_patch_at_the_expected_place() {
    let (mut flight, _, count) = incline(0.0, 0.4, false, Params::fast());
    let speed = 1.5;
    flight.v.iter_mut().for_each(|v| *v = speed * Vector::x());
    let start = flight.x[0].x;
    let energy = |flight: &Flight| flight.v.iter().map(|v| 0.5 * v.xy().norm_squared()).sum::<f64>();
    let mut last = energy(&flight);
    for step in 0..60 {
        flight.step(|_, _| None);
        let now = energy(&flight);
        assert!(now <= last * (1.0 + 1e-9) + 1e-15, "energy grows from {last} to {now} in step {step}");
        last = now;
    }
    assert!(last < 1e-12, "still moving: {last} J");
    // Implicit Euler loses v dt / 2 of the way.
    let expected = speed * speed / (2.0 * 0.4 * G) - 0.5 * speed * flight.dt;
    let gone = flight.x[0].x - start;
    assert!((gone / expected - 1.0).abs() < 0.03, "{gone} m against {expected} m of {count} vertices");
}

/// A patch lying on an obstacle sheet that is much larger.
fn on_a_plate(friction: f64, model: FrictionModel) -> (Flight, usize) {
    let (mut x, mut triangles) = (Vec::new(), Vec::new());
    sheet(4, H, 0.1 * H, &mut x, &mut triangles);
    let count = x.len();
    for p in &mut x {
        *p += Vector::new(-2.0 * H, -2.0 * H, 0.1 * H - p.z);
    }
    let plate = 0.8;
    x.extend(
        [(-plate, -plate), (plate, -plate), (plate, plate), (-plate, plate)]
            .map(|(x, y)| Point::new(x, y, 0.0)),
    );
    let n = count as u32;
    triangles.extend([[n, n + 1, n + 2], [n, n + 2, n + 3]]);
    let bodies = (0..x.len()).map(|i| u32::from(i >= count)).collect();
    let topology = Topology::builder(x.len()).triangles(triangles).build().unwrap();
    let filters = vec![BodyFilter::DEFORMABLE, BodyFilter::OBSTACLE];
    let collision = CollisionModel::new(topology, bodies, filters, vec![]).unwrap();
    let mut params = Params::fast();
    params.contact.delta = Some(0.1 * H);
    params.contact.friction_model = model;
    let pair = PairFriction { sides: [ContactSide::Body(1), ContactSide::Body(0)], friction };
    let contact = ContactData { pairs: vec![pair], ..ContactData::default() };
    let resolver = Resolver::with_contact(collision, &x, &vec![1.0; x.len()], contact, params).unwrap();
    let v = vec![Vector::zeros(); x.len()];
    (Flight { resolver, x, v, gravity: -G * Vector::z(), dt: 0.01 }, count)
}

#[test]
fn a_moving_obstacle_drags_what_lies_on_it() {
    let (mut flight, count) = on_a_plate(0.3, FrictionModel::Coulomb);
    let speed = 0.5;
    let step = speed * flight.dt * Vector::x();
    // As long as the plate is faster, friction accelerates the patch by mu g.
    for _ in 0..10 {
        flight.step(|i, x| (i >= count).then(|| x + step));
    }
    let found = flight.velocity(count).x;
    let expected = 0.3 * G * 10.0 * flight.dt;
    assert!((found / expected - 1.0).abs() < 0.03, "{found} m/s against {expected} m/s");
    // After that they move together.
    for _ in 0..20 {
        flight.step(|i, x| (i >= count).then(|| x + step));
    }
    let found = flight.velocity(count);
    assert!((found - speed * Vector::x()).norm() < 1e-3 * speed, "{found}");
}

#[test]
fn a_turning_obstacle_turns_what_lies_on_it() {
    let (mut flight, count) = on_a_plate(1.0, FrictionModel::Coulomb);
    let rate: f64 = 2.0;
    let (sin, cos) = (rate * flight.dt).sin_cos();
    let turn = |p: &Point| Point::new(cos * p.x - sin * p.y, sin * p.x + cos * p.y, p.z);
    let corner = flight.x[0];
    let steps = 50;
    for _ in 0..steps {
        let report = flight.step(|i, x| (i >= count).then(|| turn(x)));
        assert!(report.converged, "{report:?}");
    }
    let angle =
        (flight.x[0].y.atan2(flight.x[0].x) - corner.y.atan2(corner.x)).rem_euclid(std::f64::consts::TAU);
    let expected = rate * flight.dt * f64::from(steps);
    assert!((angle - expected).abs() < 0.02 * expected, "turned by {angle} rad, not {expected} rad");
    let stretched = flight.x[0].coords.xy().norm() / corner.coords.xy().norm();
    assert!((stretched - 1.0).abs() < 0.02, "thrown outwards: {stretched}");
}

#[test]
fn the_filter_drags_as_well_and_none_does_not() {
    let speed = 0.5;
    let run = |model| {
        let (mut flight, count) = on_a_plate(0.3, model);
        let step = speed * flight.dt * Vector::x();
        let mut rows = 0;
        for _ in 0..40 {
            rows += flight.step(|i, x| (i >= count).then(|| x + step)).friction_rows;
        }
        (flight.velocity(count).x, rows)
    };
    let (filtered, rows) = run(FrictionModel::Filter);
    assert_eq!(rows, 0, "the filter has no rows");
    assert!(filtered > 0.8 * speed && filtered < 1.01 * speed, "{filtered} m/s");
    let (free, rows) = run(FrictionModel::None);
    // Not exactly 0: contacts across the plate's diagonal have tilted normals, which push a little as the
    // diagonal passes.
    assert!(free.abs() < 0.1 * speed && rows == 0, "{free} m/s");
}

#[test]
fn friction_between_two_bodies_is_equal_and_opposite() {
    // Two patches pressed into each other while one moves along the other.
    let (mut x, mut triangles) = (Vec::new(), Vec::new());
    sheet(4, H, 0.0, &mut x, &mut triangles);
    let n = x.len();
    sheet(4, H, 0.12 * H, &mut x, &mut triangles);
    let masses: Vec<f64> = (0..2 * n).map(|i| if i < n { 1.0 } else { 2.0 }).collect();
    let bodies: Vec<u32> = (0..2 * n).map(|i| u32::from(i >= n)).collect();
    let topology = Topology::builder(2 * n).triangles(triangles).build().unwrap();
    let mut given = [0.0; 2];
    for (k, friction) in [0.0, 0.4].into_iter().enumerate() {
        let filters = vec![BodyFilter::DEFORMABLE; 2];
        let model = CollisionModel::new(topology.clone(), bodies.clone(), filters, vec![]).unwrap();
        let mut params = Params::fast();
        params.contact.delta = Some(0.1 * H);
        let contact = ContactData { bodies: vec![rough(friction); 2], ..ContactData::default() };
        let mut resolver = Resolver::with_contact(model, &x, &masses, contact, params).unwrap();
        let y: Vec<Point> = (0..2 * n)
            .map(|i| {
                let sign = if i < n { 1.0 } else { -0.5 };
                x[i] + sign * Vector::new(0.0, 0.0, 0.05 * H) + sign * 0.02 * H * Vector::x()
            })
            .collect();
        let mut moved = x.clone();
        let report = resolver.resolve(&mut moved, &y).unwrap();
        assert!(report.converged, "{report:?}");
        let momentum =
            |range: std::ops::Range<usize>| -> Vector { range.map(|i| masses[i] * (moved[i] - y[i])).sum() };
        let (a, b) = (momentum(0..n), momentum(n..2 * n));
        assert!((a + b).norm() < 1e-3 * a.norm(), "{a} {b}");
        given[k] = -a.x;
        if friction > 0.0 {
            // The warp of the sheets tilts normals. Friction adds at most mu times the normal impulse along
            // x.
            assert!(given[1] < 1.1 * 0.4 * a.z.abs(), "{a}");
            assert!(report.friction_rows == report.contact_rows && report.sliding_contacts > 0, "{report:?}");
        }
    }
    assert!(given[1] > 5.0 * given[0].abs(), "friction passes momentum along the slip: {given:?}");
}

#[test]
fn frictional_results_have_the_same_bits_for_any_number_of_threads() {
    let (mut x, mut triangles) = (Vec::new(), Vec::new());
    let mut bodies = Vec::new();
    for layer in 0..4 {
        sheet(20, H, 0.11 * H * f64::from(layer), &mut x, &mut triangles);
        bodies.resize(x.len(), layer as u32);
    }
    let topology = Topology::builder(x.len()).triangles(triangles).build().unwrap();
    let model = CollisionModel::new(topology, bodies, vec![BodyFilter::DEFORMABLE; 4], vec![]).unwrap();
    let y: Vec<Point> = x
        .iter()
        .map(|p| Point::new(p.x + 0.3 * p.z, p.y, 0.5 * p.z + 0.02 * H * (40.0 * p.x).sin()))
        .collect();
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let mut params = Params::fast();
            params.contact.delta = Some(0.1 * H);
            params.solver.stop.max_steps = Some(8);
            let contact = ContactData { bodies: vec![rough(0.5); 4], ..ContactData::default() };
            let mut resolver =
                Resolver::with_contact(model.clone(), &x, &vec![1.0; x.len()], contact, params).unwrap();
            let mut results = Vec::new();
            for _ in 0..2 {
                let mut moved = x.clone();
                let report = resolver.resolve(&mut moved, &y).unwrap();
                assert!(
                    report.friction_rows > 1024,
                    "too few rows for parallel work: {}",
                    report.friction_rows
                );
                results.push(moved);
            }
            assert!(results[0] == results[1], "state is carried over between calls");
            results.swap_remove(0)
        })
    };
    let one = run(1);
    for threads in [2, 3] {
        assert!(run(threads) == one, "{threads} threads give other bits");
    }
}
