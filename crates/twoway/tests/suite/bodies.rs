//! Thickness, contact distance and stretch limit of each body, against distances by brute force; groups of
//! pins.
#![allow(clippy::unwrap_used)] // helpers of tests are outside the functions that the lint knows as tests

use crate::common::{Draw, Flight, brute_force, sheet};
use bowknot_geometry::{HalfSpace, PairKind, Point, Topology, Vector};
use bowknot_proximity::{BodyFilter, CollisionModel};
use bowknot_twoway::{
    AcceptedState, BodyContact, ContactData, HalfSpaceContact, Lag, MIN_SEPARATION_MARGIN, Params,
    PrescribedEntity, ResolveError, ResolveInput, Resolver,
};
use std::ops::ControlFlow;

fn of_bodies(bodies: Vec<BodyContact>) -> ContactData {
    ContactData { bodies, ..ContactData::default() }
}

fn thick(thickness: f64) -> BodyContact {
    BodyContact { thickness: Some(thickness), ..BodyContact::default() }
}

/// Bodies of every kind above a ground: two sheets, two strands, particles, and an obstacle.
struct Zoo {
    x: Vec<Point>,
    bodies: Vec<u32>,
    topology: Topology,
    model: CollisionModel,
    contact: Vec<BodyContact>,
    ground: HalfSpaceContact,
}

const OBSTACLE: u32 = 4;

fn zoo() -> Zoo {
    let (mut x, mut triangles) = (Vec::new(), Vec::new());
    let mut bodies = Vec::new();
    sheet(3, 0.1, 0.20, &mut x, &mut triangles);
    bodies.resize(x.len(), 0);
    sheet(3, 0.1, 0.25, &mut x, &mut triangles);
    bodies.resize(x.len(), 1);
    let mut strands = Vec::new();
    for (k, height) in [0.32, 0.38].into_iter().enumerate() {
        let first = x.len() as u32;
        for i in 0..5 {
            let along = 0.08 * f64::from(i);
            let across = 0.13 + 0.05 * k as f64;
            let (u, v) = if k == 0 { (along, across) } else { (across, along) };
            x.push(Point::new(u, v, height));
        }
        strands.extend((0..4).map(|i| [first + i, first + i + 1]));
    }
    bodies.resize(x.len(), 2);
    let first = x.len() as u32;
    for i in 0..9 {
        x.push(Point::new(0.05 + 0.1 * f64::from(i % 3), 0.05 + 0.1 * f64::from(i / 3), 0.48));
    }
    let particles: Vec<u32> = (first..x.len() as u32).collect();
    bodies.resize(x.len(), 3);
    sheet(1, 0.2, 0.08, &mut x, &mut triangles);
    bodies.resize(x.len(), OBSTACLE);
    let topology = Topology::builder(x.len())
        .triangles(triangles)
        .strand_edges(strands.iter().copied())
        .particles(particles.iter().copied())
        .build()
        .unwrap();
    let mut filters = vec![BodyFilter::DEFORMABLE; 5];
    filters[OBSTACLE as usize] = BodyFilter::OBSTACLE;
    let ground = HalfSpace::new(Point::origin(), Vector::z()).unwrap();
    let model = CollisionModel::new(topology.clone(), bodies.clone(), filters, vec![ground]).unwrap();
    let contact = vec![
        thick(0.008),
        thick(0.003),
        thick(0.012),
        BodyContact { delta: Some(0.04), ..thick(0.03) },
        thick(0.004),
    ];
    let ground = HalfSpaceContact { thickness: Some(0.006), friction: 0.0 };
    Zoo { x, bodies, topology, model, contact, ground }
}

impl Zoo {
    fn resolver(&self, params: Params) -> Resolver {
        let contact = ContactData {
            bodies: self.contact.clone(),
            half_spaces: vec![self.ground],
            ..ContactData::default()
        };
        Resolver::with_contact(self.model.clone(), &self.x, &vec![1.0; self.x.len()], contact, params)
            .unwrap()
    }

    /// Asserts that every pair keeps its minimum separation.
    fn check(&self, x: &[Point], what: &str) {
        let thickness = |v: u32| self.contact[self.bodies[v as usize] as usize].thickness.unwrap();
        let mut rest = Vec::new();
        brute_force::pairs(&self.topology, &self.x, |_, _, distance| rest.push(distance));
        let mut k = 0;
        brute_force::pairs(&self.topology, x, |a, b, distance| {
            let (body_a, body_b) = (self.bodies[a[0] as usize], self.bodies[b[0] as usize]);
            let mut min_separation = 0.5 * (thickness(a[0]) + thickness(b[0]));
            if body_a == body_b {
                min_separation = min_separation.min(0.5 * rest[k] / MIN_SEPARATION_MARGIN);
            }
            k += 1;
            if body_a != OBSTACLE || body_b != OBSTACLE {
                assert!(
                    distance >= min_separation * (1.0 - 1e-9),
                    "{what}: {a:?} {b:?} at {distance}, minimum {min_separation}"
                );
            }
        });
        for (v, x) in x.iter().enumerate().filter(|(v, _)| self.bodies[*v] != OBSTACLE) {
            let min_separation = 0.5 * (thickness(v as u32) + self.ground.thickness.unwrap());
            assert!(
                x.z >= min_separation * (1.0 - 1e-9),
                "{what}: {v} at {} above the ground, minimum {min_separation}",
                x.z
            );
        }
    }
}

#[test]
fn however_violent_the_targets_bodies_of_all_kinds_keep_their_thickness() {
    let zoo = zoo();
    zoo.check(&zoo.x, "the start");
    let presets = [("fast", Params::fast()), ("quick", Params::quick()), ("paper", Params::paper())];
    for (preset, mut params) in presets {
        params.solver.stop.max_steps = Some(40);
        let mut resolver = zoo.resolver(params);
        let mut draw = Draw::new(7);
        let mut x = zoo.x.clone();
        let mut met = [false; 5];
        for call_index in 0..12 {
            // The bodies are thrown at the ground and at each other; the obstacle moves up and down.
            let reach = [0.05, 0.4, 2.0][call_index % 3];
            let fall = if call_index % 2 == 0 { -0.6 } else { 0.1 };
            let y: Vec<Point> = (0..x.len())
                .map(|i| match zoo.bodies[i] {
                    OBSTACLE => zoo.x[i] + 0.1 * (call_index as f64).sin() * Vector::z(),
                    _ => x[i] + reach * draw.vector() + fall * Vector::z(),
                })
                .collect();
            let mut observer = |state: &AcceptedState<'_>| {
                zoo.check(state.positions, &format!("{preset}, call {call_index}, step {}", state.step));
                ControlFlow::Continue(())
            };
            let input = ResolveInput { time_step: Some(0.02), ..ResolveInput::default() };
            resolver.resolve_with(&mut x, &y, &input, &mut observer).unwrap();
            for kind in PairKind::ALL {
                let contacts = &resolver.state().contacts;
                let near = |p: usize| contacts.separations[p].distance < 1.3 * contacts.deltas[p];
                met[kind as usize] |= contacts.pairs.range(kind).any(near);
            }
        }
        assert_eq!(met, [true; 5], "{preset}: some kind of pair was never in contact");
    }
}

#[test]
fn a_swept_step_without_candidates_keeps_minimum_separations() {
    // Two grains that are no candidates fly to positions side by side, closer than their thickness. Their
    // paths do not intersect.
    let side_by_side = 0.025;
    let mut x = vec![Point::new(-0.2, 0.0, 0.0), Point::new(0.2, side_by_side, 0.0)];
    let y = [Point::new(0.0, 0.0, 0.0), Point::new(0.0, side_by_side, 0.0)];
    let topology = Topology::builder(2).particles([0, 1]).build().unwrap();
    let mut resolver = Resolver::with_contact(
        CollisionModel::single_body(topology),
        &x,
        &[1.0; 2],
        of_bodies(vec![BodyContact { delta: Some(0.04), ..thick(0.03) }]),
        Params::fast(),
    )
    .unwrap();
    let mut observer = |state: &AcceptedState<'_>| {
        let distance = (state.positions[0] - state.positions[1]).norm();
        assert!(distance >= 0.03 * (1.0 - 1e-9), "{distance} m in step {}", state.step);
        ControlFlow::Continue(())
    };
    let report = resolver.resolve_with(&mut x, &y, &ResolveInput::default(), &mut observer).unwrap();
    assert!(report.converged, "{report:?}");
    let distance = (x[0] - x[1]).norm();
    assert!(distance > 0.04 && distance < 0.055, "wanted: 0.045 m; found: {distance} m");
}

#[test]
fn a_gap_that_starts_below_the_thickness_grows_to_it_and_never_shrinks() {
    let (mut x, mut triangles) = (Vec::new(), Vec::new());
    let (thickness, gap) = (0.01, 0.001);
    sheet(3, 0.1, 0.2, &mut x, &mut triangles);
    let n = x.len();
    sheet(3, 0.1, 0.2 + gap, &mut x, &mut triangles);
    let bodies: Vec<u32> = (0..2 * n).map(|i| u32::from(i >= n)).collect();
    let topology = Topology::builder(2 * n).triangles(triangles).build().unwrap();
    let model =
        CollisionModel::new(topology.clone(), bodies.clone(), vec![BodyFilter::DEFORMABLE; 2], vec![])
            .unwrap();
    let resolver = Resolver::with_contact(
        model,
        &x,
        &vec![0.1; 2 * n],
        of_bodies(vec![thick(thickness); 2]),
        Params::fast(),
    )
    .unwrap();
    let speed = resolver.scene().lengths().separation_speed;
    let v = vec![Vector::zeros(); 2 * n];
    let mut flight = Flight { resolver, x, v, gravity: Vector::zeros(), dt: 0.01 };
    let nearest = |x: &[Point]| {
        let mut nearest = f64::INFINITY;
        brute_force::pairs(&topology, x, |a, b, distance| {
            if bodies[a[0] as usize] != bodies[b[0] as usize] {
                nearest = nearest.min(distance);
            }
        });
        nearest
    };
    let mut last = nearest(&flight.x);
    for step in 0..80 {
        // Each step presses the sheets together.
        for i in 0..2 * n {
            flight.v[i].z += if i < n { 0.2 } else { -0.2 };
        }
        let report = flight.step(|_, _| None);
        let now = nearest(&flight.x);
        assert!(now > last.min(thickness) * (1.0 - 1e-9), "{last} m shrinks to {now} m in step {step}");
        if last < thickness {
            assert!(now - last < 1.1 * speed * flight.dt, "{last} m explodes to {now} m in step {step}");
        }
        let bound = 0.5 * 0.1 * 2.0 * n as f64 * (speed * (1.0 + 1e-9)).powi(2);
        assert!(report.injected_j <= bound, "{} J, at most {bound} J", report.injected_j);
        assert!(step > 0 || report.injected_j > 0.0, "{report:?}");
        last = now;
    }
    assert!(last >= thickness, "{last} m, thickness {thickness} m");
}

#[test]
fn grains_of_two_sizes_come_to_rest_at_the_sum_of_their_radii_and_on_the_ground_at_one() {
    // A column of grains, small and large in turn, falls along z.
    let sizes = [0.02, 0.05, 0.02, 0.05];
    let mut x = Vec::new();
    let mut height = 0.1;
    for size in sizes {
        x.push(Point::new(0.0, 0.0, height));
        height += size + 0.05;
    }
    let bodies = vec![0, 1, 0, 1];
    let topology = Topology::builder(4).particles([0, 1, 2, 3]).build().unwrap();
    let ground = HalfSpace::new(Point::origin(), Vector::z()).unwrap();
    let filters = vec![BodyFilter::DEFORMABLE; 2];
    let model = CollisionModel::new(topology, bodies, filters, vec![ground]).unwrap();
    let grain = |delta| BodyContact { delta: Some(delta), ..BodyContact::default() };
    let resolver = Resolver::with_contact(
        model,
        &x,
        &[0.1, 0.8, 0.1, 0.8],
        of_bodies(vec![grain(0.02), grain(0.05)]),
        Params::fast(),
    )
    .unwrap();
    let lengths = resolver.scene().lengths();
    assert!((lengths.edge - 2.5 * 0.035).abs() < 1e-12, "lengths follow the grains: {lengths:?}");
    let v = vec![Vector::zeros(); 4];
    let mut flight = Flight { resolver, x, v, gravity: -9.81 * Vector::z(), dt: 0.005 };
    for _ in 0..200 {
        flight.step(|_, _| None);
    }
    let z: Vec<f64> = flight.x.iter().map(|x| x.z).collect();
    let mut expected = vec![0.01];
    for pair in sizes.windows(2) {
        expected.push(expected[expected.len() - 1] + 0.5 * (pair[0] + pair[1]));
    }
    for (z, expected) in z.iter().zip(&expected) {
        assert!((z / expected - 1.0).abs() < 0.02, "{z} m against {expected} m");
    }
}

#[test]
fn strands_rest_on_strands_and_particles_on_both() {
    // Two crossing strands, the lower one held at its ends, and a particle on their crossing.
    let mut x = Vec::new();
    for i in 0..5 {
        x.push(Point::new(0.1 * f64::from(i) - 0.2, 0.0, 0.0));
    }
    for i in 0..5 {
        x.push(Point::new(0.003, 0.1 * f64::from(i) - 0.2, 0.03));
    }
    x.push(Point::new(0.003, 0.0, 0.08));
    let strands: Vec<[u32; 2]> = (0..4).chain(5..9).map(|i| [i, i + 1]).collect();
    let topology =
        Topology::builder(11).strand_edges(strands.iter().copied()).particles([10]).build().unwrap();
    let bodies: Vec<u32> = (0..11).map(|i| i / 5).collect();
    let model = CollisionModel::new(topology, bodies, vec![BodyFilter::DEFORMABLE; 3], vec![]).unwrap();
    let resolver = Resolver::with_contact(
        model,
        &x,
        &[1.0; 11],
        of_bodies(vec![thick(0.01), thick(0.01), BodyContact { delta: Some(0.02), ..thick(0.01) }]),
        Params::fast(),
    )
    .unwrap();
    let v = vec![Vector::zeros(); 11];
    let mut flight = Flight { resolver, x, v, gravity: -2.0 * Vector::z(), dt: 0.01 };
    for _ in 0..100 {
        // Damping, so that the bodies come to rest.
        flight.v.iter_mut().for_each(|v| *v *= 0.9);
        flight.step(|i, x| [0, 4, 5, 9].contains(&i).then_some(*x));
        let crossing =
            brute_force::segment_segment([&flight.x[2], &flight.x[3]], [&flight.x[6], &flight.x[7]]);
        assert!(crossing >= 0.01 * (1.0 - 1e-9), "{crossing}");
    }
    let [low, high, grain] = [2, 7, 10].map(|i| flight.x[i]);
    assert!(low.z < -0.01, "the lower strand hangs: {low}");
    assert!(high.z - low.z >= 0.01, "{high} {low}");
    assert!(grain.z > high.z + 0.01, "the grain lies on the strand: {grain} {high}");
}

#[test]
fn stretch_limits_are_those_of_each_body_and_none_costs_nothing() {
    let (mut x, mut triangles) = (Vec::new(), Vec::new());
    sheet(3, 0.1, 0.0, &mut x, &mut triangles);
    let n = x.len();
    sheet(3, 0.1, 1.0, &mut x, &mut triangles);
    sheet(3, 0.1, 2.0, &mut x, &mut triangles);
    let bodies: Vec<u32> = (0..3 * n).map(|i| (i / n) as u32).collect();
    let topology = Topology::builder(3 * n).triangles(triangles).build().unwrap();
    let edges = topology.edges.clone();
    let filters = vec![BodyFilter::DEFORMABLE; 3];
    let model = CollisionModel::new(topology, bodies.clone(), filters, vec![]).unwrap();
    let limit = |stretch_limit| BodyContact { stretch_limit, ..BodyContact::default() };
    let mut resolver = Resolver::with_contact(
        model,
        &x,
        &vec![1.0; 3 * n],
        of_bodies(vec![limit(Some(f64::INFINITY)), limit(Some(1.3)), limit(None)]),
        Params::fast(),
    )
    .unwrap();
    let y: Vec<Point> = x.iter().map(|p| Point::new(1.5 * p.x, p.y, p.z)).collect();
    let mut moved = x.clone();
    let report = resolver.resolve(&mut moved, &y).unwrap();
    assert!(report.converged, "{report:?}");
    assert_eq!(report.edge_rows, edges.len() / 3 * 2, "the body without a limit has no rows");
    let mut worst = [0.0f64; 3];
    for [a, b] in edges.iter().map(|e| e.map(|v| v as usize)) {
        let ratio = (moved[a] - moved[b]).norm() / (x[a] - x[b]).norm();
        let body = bodies[a] as usize;
        worst[body] = worst[body].max(ratio);
    }
    assert!((worst[0] - 1.5).abs() < 0.02, "{worst:?}");
    assert!(worst[1] > 1.25 && worst[1] < 1.3 * 1.02 + 1e-12, "{worst:?}");
    assert!(worst[2] > 1.05 && worst[2] < 1.1 * 1.02 + 1e-12, "{worst:?}");

    // Without any limit the stopping rule has no edges. Infinity for all bodies is as good as for each.
    let topology = Topology::builder(n)
        .triangles(resolver.scene().model().topology().triangles[..18].iter().copied())
        .build()
        .unwrap();
    let mut resolver = Resolver::with_contact(
        CollisionModel::single_body(topology.clone()),
        &x[..n],
        &vec![1.0; n],
        of_bodies(vec![limit(Some(f64::INFINITY))]),
        Params::fast(),
    )
    .unwrap();
    let mut moved = x[..n].to_vec();
    let report = resolver.resolve(&mut moved, &y[..n]).unwrap();
    assert!(report.converged && report.edge_rows == 0 && report.max_stretch > 1.0, "{report:?}");
    let mut params = Params::fast();
    params.contact.stretch_limit = Some(f64::INFINITY);
    let mut resolver =
        Resolver::new(CollisionModel::single_body(topology), &x[..n], &vec![1.0; n], params).unwrap();
    let mut again = x[..n].to_vec();
    assert_eq!(resolver.resolve(&mut again, &y[..n]).unwrap().edge_rows, 0);
    assert_eq!(again, moved);
}

#[test]
fn a_group_of_pins_waits_as_a_whole_and_reports_its_lag() {
    // Two pins carry the ends of a strand down through a pinned sheet; one of them alone could go on.
    let (mut x, mut triangles) = (Vec::new(), Vec::new());
    sheet(4, 0.1, 0.0, &mut x, &mut triangles);
    let n = x.len();
    x.extend([Point::new(0.2, 0.2, 0.1), Point::new(0.3, 0.2, 0.2), Point::new(2.0, 0.2, 0.3)]);
    let (a, b) = (n as u32, n as u32 + 2);
    let topology =
        Topology::builder(n + 3).triangles(triangles).strand_edges([[a, a + 1], [a + 1, b]]).build().unwrap();
    let bodies: Vec<u32> = (0..n + 3).map(|i| u32::from(i >= n)).collect();
    let model = CollisionModel::new(topology, bodies, vec![BodyFilter::DEFORMABLE; 2], vec![]).unwrap();
    let start = x.clone();
    let y: Vec<Point> = (0..n + 3)
        .map(|i| if [n, n + 2].contains(&i) { start[i] - Vector::new(0.1, 0.0, 0.8) } else { start[i] })
        .collect();
    let prescribed: Vec<bool> = (0..n + 3).map(|i| i != n + 1).collect();
    let groups: Vec<u32> =
        (0..n + 3).map(|i| if [n, n + 2].contains(&i) { 7 } else { ResolveInput::NO_GROUP }).collect();
    let mut params = Params::fast();
    params.contact.edges = false;
    let mut resolver = Resolver::new(model, &x, &vec![1.0; n + 3], params).unwrap();
    let input = ResolveInput { prescribed: &prescribed, groups: &groups, ..ResolveInput::default() };
    let report = resolver.resolve_with(&mut x, &y, &input, &mut ()).unwrap();
    let share = |i: usize| (x[i] - start[i]).norm() / (y[i] - start[i]).norm();
    assert!((share(n) - share(n + 2)).abs() < 1e-12, "{} {}", share(n), share(n + 2));
    assert!(share(n) > 0.1 && share(n) < 0.125, "it comes to the sheet and stays above: {}", share(n));
    assert!(x[n].z > 0.0);
    let [Lag { entity: PrescribedEntity::Group(7), distance_m }] = report.lags[..] else {
        panic!("{:?}", report.lags)
    };
    assert!((distance_m - report.prescribed_lag_m).abs() < 1e-12 && distance_m > 0.7, "{distance_m}");

    // Without the group the far pin arrives and only the other waits.
    let mut x = start.clone();
    let input = ResolveInput { prescribed: &prescribed, ..ResolveInput::default() };
    let report = resolver.resolve_with(&mut x, &y, &input, &mut ()).unwrap();
    assert!((x[n + 2] - y[n + 2]).norm() < 0.01 && (x[n] - y[n]).norm() > 0.7);
    assert!(matches!(report.lags[..], [Lag { entity: PrescribedEntity::Pins(1), .. }]), "{:?}", report.lags);
}

#[test]
fn layers_within_a_group_do_not_hold_each_other_back() {
    // Two sheets pinned as one group, close together, move along the normal: each is in the other's way but
    // for their common motion.
    let (mut x, mut triangles) = (Vec::new(), Vec::new());
    sheet(4, 0.1, 0.0, &mut x, &mut triangles);
    let n = x.len();
    sheet(4, 0.1, 0.005, &mut x, &mut triangles);
    let topology = Topology::builder(2 * n).triangles(triangles).build().unwrap();
    let bodies = (0..2 * n).map(|i| u32::from(i >= n)).collect();
    let model = CollisionModel::new(topology, bodies, vec![BodyFilter::DEFORMABLE; 2], vec![]).unwrap();
    let mut resolver = Resolver::new(model, &x, &vec![1.0; 2 * n], Params::fast()).unwrap();
    let y: Vec<Point> = x.iter().map(|p| p + 0.5 * Vector::z()).collect();
    let (prescribed, groups) = (vec![true; 2 * n], vec![3; 2 * n]);
    let input = ResolveInput { prescribed: &prescribed, groups: &groups, ..ResolveInput::default() };
    let report = resolver.resolve_with(&mut x, &y, &input, &mut ()).unwrap();
    assert!(report.converged && report.lags.is_empty() && report.steps < 30, "{report:?}");
    assert!(x.iter().zip(&y).all(|(x, y)| (x - y).norm() < 0.01));
}

#[test]
fn invalid_contact_data_and_input_are_refused() {
    let zoo = zoo();
    let resolver = |contact| {
        Resolver::with_contact(zoo.model.clone(), &zoo.x, &vec![1.0; zoo.x.len()], contact, Params::fast())
    };
    let bad = vec![BodyContact { friction: -0.5, ..thick(-1.0) }; 5];
    let contact = ContactData { half_spaces: vec![zoo.ground; 2], ..of_bodies(bad) };
    let error = resolver(contact).unwrap_err();
    let ResolveError::Contact(errors) = &error else { panic!("{error}") };
    assert_eq!(errors.len(), 11, "{errors}");
    assert!(error.to_string().contains("bodies[3].friction = -0.5"), "{error}");
    assert!(error.to_string().contains("half_spaces.len() = 2: must be 1"), "{error}");
    let mut good = resolver(ContactData::default()).unwrap();
    let mut x = zoo.x.clone();
    let groups = [0; 3];
    let input = ResolveInput { groups: &groups, ..ResolveInput::default() };
    let error = good.resolve_with(&mut x, &zoo.x, &input, &mut ()).unwrap_err();
    assert!(matches!(error, ResolveError::Length { what: "groups", given: 3, .. }), "{error}");
    let start = vec![Point::new(f64::NAN, 0.0, 0.0); x.len()];
    let input = ResolveInput { start: Some(&start), ..ResolveInput::default() };
    let error = good.resolve_with(&mut x, &zoo.x, &input, &mut ()).unwrap_err();
    assert!(matches!(error, ResolveError::NonFinite { what: "the start", .. }), "{error}");
    assert_eq!(x, zoo.x);
}
