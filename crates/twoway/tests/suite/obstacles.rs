//! Bodies that become obstacles for a while, because they rest, and obstacles that come and go.
#![allow(clippy::unwrap_used)] // helpers of tests are outside the functions that the lint knows as tests

use crate::common::sheet;
use bowknot_geometry::{HalfSpace, PairKind, Point, Topology, Vector};
use bowknot_proximity::{BodyFilter, CollisionModel};
use bowknot_twoway::{Params, ResolveError, Resolver};

const FILTERS: [BodyFilter; 3] = [BodyFilter::OBSTACLE, BodyFilter::DEFORMABLE, BodyFilter::DEFORMABLE];

/// Three sheets above each other, the lowest of which is an obstacle without mass.
fn three_sheets() -> (Vec<Point>, Resolver) {
    three_sheets_above(Vec::new())
}

fn three_sheets_above(half_spaces: Vec<HalfSpace>) -> (Vec<Point>, Resolver) {
    let (mut x, mut triangles, mut bodies) = (Vec::new(), Vec::new(), Vec::new());
    for body in 0..3 {
        sheet(4, 0.05, 0.012 * f64::from(body), &mut x, &mut triangles);
        bodies.resize(x.len(), body);
    }
    let masses: Vec<f64> = bodies.iter().map(|body| if *body == 0 { 0.0 } else { 1e-3 }).collect();
    let topology = Topology::builder(x.len()).triangles(triangles).build().unwrap();
    let model = CollisionModel::new(topology, bodies, FILTERS.to_vec(), half_spaces).unwrap();
    let resolver = Resolver::new(model, &x, &masses, Params::fast()).unwrap();
    (x, resolver)
}

/// Moves the upper sheet by 3 cm into what is below; returns where everything is, and the bodies of all
/// pairs.
fn press(resolver: &mut Resolver, x: &[Point]) -> (Vec<Point>, Vec<[u32; 2]>, usize) {
    let mut positions = x.to_vec();
    let bodies = resolver.scene().model().vertex_body().to_vec();
    let down = |(p, body): (&Point, &u32)| if *body == 2 { p - Vector::z() * 0.03 } else { *p };
    let target: Vec<Point> = x.iter().zip(&bodies).map(down).collect();
    let statistics = resolver.resolve(&mut positions, &target).unwrap();
    let contacts = &resolver.state().contacts;
    let mut pairs: Vec<[u32; 2]> = PairKind::ALL
        .iter()
        .flat_map(|&kind| contacts.pairs.pairs()[contacts.pairs.range(kind)].iter().map(move |p| (kind, p)))
        .map(|(kind, p)| [p.vertices[0], p.vertices[kind.side_a()]].map(|v| bodies[v as usize]))
        .collect();
    pairs.iter_mut().for_each(|pair| pair.sort_unstable());
    pairs.sort_unstable();
    pairs.dedup();
    (positions, pairs, statistics.edge_rows)
}

#[test]
fn a_body_that_rests_as_an_obstacle_has_no_rows_and_holds_others() {
    let (x, mut resolver) = three_sheets();
    let lengths = *resolver.scene().lengths();
    let (moved, pairs, edge_rows) = press(&mut resolver, &x);
    assert!(pairs.contains(&[0, 1]) && pairs.contains(&[1, 2]), "{pairs:?}");
    let middle = || (0..x.len()).filter(|&v| resolver.scene().model().vertex_body()[v] == 1);
    assert!(middle().any(|v| moved[v] != x[v]), "the middle sheet yields");

    let (_, mut resting) = three_sheets();
    let obstacles = [BodyFilter::OBSTACLE, BodyFilter::OBSTACLE, BodyFilter::DEFORMABLE];
    resting.set_filters(&obstacles, &[]).unwrap();
    assert_eq!(*resting.scene().lengths(), lengths);
    let (held, pairs, edge_rows_held) = press(&mut resting, &x);
    assert_eq!(pairs, [[1, 2]], "obstacles form no pairs with each other");
    assert_eq!(2 * edge_rows_held, edge_rows);
    assert!(middle().all(|v| held[v] == x[v]), "it stays to the bit");
    let lowest = |body: u32| {
        let of_body = (0..x.len()).filter(|&v| resting.scene().model().vertex_body()[v] == body);
        of_body.map(|v| held[v].z).fold(f64::INFINITY, f64::min)
    };
    assert!(lowest(2) > lowest(1), "the upper sheet stays above");

    // Deformable again, it does to the bit what it would have done.
    resting.set_filters(&FILTERS, &[]).unwrap();
    assert_eq!(press(&mut resting, &x).0, moved);
}

#[test]
fn bodies_without_mass_and_wrong_numbers_are_refused() {
    let (x, mut resolver) = three_sheets();
    let refused = resolver.set_filters(&[BodyFilter::DEFORMABLE; 3], &[]);
    assert!(matches!(refused, Err(ResolveError::Mass { vertex: 0, body: 0, .. })), "{refused:?}");
    let ground = HalfSpace { normal: Vector::z(), offset: -1.0 };
    for refused in [resolver.set_filters(&FILTERS[..1], &[]), resolver.set_filters(&FILTERS, &[ground])] {
        assert!(matches!(refused, Err(ResolveError::Contact(_))), "{refused:?}");
    }
    let (_, mut fresh) = three_sheets();
    assert_eq!(press(&mut resolver, &x).0, press(&mut fresh, &x).0);
}

/// Absent ones meet nothing, in whatever they lie; when they are back they hold as before.
#[test]
fn obstacles_and_half_spaces_that_are_absent_let_everything_through() {
    let ground = HalfSpace { normal: Vector::z(), offset: -0.005 };
    let (x, mut resolver) = three_sheets_above(vec![ground]);
    let bodies = resolver.scene().model().vertex_body().to_vec();
    let fallen = |(p, body): (&Point, &u32)| if *body > 0 { p - Vector::z() * 0.1 } else { *p };
    let down: Vec<Point> = x.iter().zip(&bodies).map(fallen).collect();
    let fall = |resolver: &mut Resolver| {
        let mut positions = x.clone();
        let statistics = resolver.resolve(&mut positions, &down).unwrap();
        let own = bodies.iter().zip(positions).filter(|(body, _)| **body > 0);
        (own.map(|(_, p)| p.z).fold(f64::INFINITY, f64::min), statistics.converged)
    };
    let (held, _) = fall(&mut resolver);
    assert!(held > 0.0, "{held}");
    let absent = FILTERS.map(|filter| if filter.obstacle { filter.absent() } else { filter });
    resolver.set_filters(&absent, &[ground]).unwrap();
    let (on_ground, _) = fall(&mut resolver);
    assert!(on_ground > -0.005 && on_ground < held, "{on_ground}, not {held}");
    resolver.set_filters(&absent, &[ground.absent()]).unwrap();
    let (free, converged) = fall(&mut resolver);
    assert!(converged && (free - (0.012 - 0.1)).abs() < 1e-3, "{free}");
    assert_eq!(resolver.detect_intersections(&down, 9).unwrap().intersection_count, 0);
    resolver.set_filters(&FILTERS, &[ground]).unwrap();
    assert_eq!(fall(&mut resolver).0, held);
}
