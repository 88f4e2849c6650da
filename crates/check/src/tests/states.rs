//! States.

use super::*;
use bowknot_geometry::{BodyFilter, CollisionModel, Topology, TopologyError, VertexOutOfRange, intersection};

fn report(judge: &Judge, x: &[Point]) -> super::super::StateReport {
    judge.check_state(x, &StateOptions { limit: usize::MAX, distance: true }).expect("valid points")
}

fn listed(intersections: &[Intersection]) -> Vec<(PairClass, [u32; 2])> {
    intersections.iter().map(|i| (i.class, i.elements)).collect()
}

/// Random soups against every pair by itself, intersections and the smallest distance.
#[test]
fn soups_equal_all_pairs() {
    for seed in 0..4 {
        let mut random = Random::new(44 + seed);
        let n: u32 = 80;
        let size = [0.6, 0.05][seed as usize % 2];
        let mut x: Vec<Point> = Vec::new();
        for _ in 0..n {
            let center = random.point(0.8);
            x.extend((0..3).map(|_| center + random.vector(size)).collect::<Vec<_>>());
        }
        let triangles: Vec<[u32; 3]> = (0..n).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        let judge = judge_of(x.len(), &triangles, &[], &[]);
        let found = report(&judge, &x);

        let at = |v: u32| &x[v as usize];
        let mut expected = Vec::new();
        let mut nearest = f64::INFINITY;
        for (e, edge) in judge.edges().iter().enumerate() {
            for (t, triangle) in triangles.iter().enumerate() {
                if !triangle.contains(&edge[0]) && intersection::edge_triangle(edge.map(at), triangle.map(at))
                {
                    expected.push((PairClass::EdgeTriangle, [e as u32, t as u32]));
                }
            }
            for other in &judge.edges()[..e] {
                if !other.iter().any(|v| edge.contains(v)) {
                    let four = [other[0], other[1], edge[0], edge[1]].map(|v| x[v as usize]);
                    let kind = bowknot_geometry::PairKind::EdgeEdge;
                    nearest = nearest.min(bowknot_geometry::distance::closest(kind, &four).distance);
                }
            }
        }
        for (v, p) in x.iter().enumerate() {
            for triangle in triangles.iter().filter(|t| !t.contains(&(v as u32))) {
                let [a, b, c] = triangle.map(|v| x[v as usize]);
                let kind = bowknot_geometry::PairKind::VertexTriangle;
                nearest = nearest.min(bowknot_geometry::distance::closest(kind, &[*p, a, b, c]).distance);
            }
        }
        assert_eq!(listed(&found.intersections), expected, "seed {seed}");
        assert_eq!(found.edge_triangle_count, expected.len());
        assert!(seed % 2 == 1 || expected.len() > 50, "{}", expected.len());
        let measured = found.nearest.expect("pairs");
        // The judge measures by code of its own, so that the last bits may differ. Their rounding error is
        // one of the size of the soup, about 1e-16 m: with these seeds the smallest distance is above 3e-4 m.
        assert!((measured.distance - nearest).abs() <= 1e-12 * nearest, "seed {seed}");
        assert!(((measured.places[0] - measured.places[1]).norm() - nearest).abs() < 1e-12);
    }
}

#[test]
fn a_flat_sheet_is_clear_and_a_crossing_one_is_not() {
    let (mut x, mut triangles) = sheet(9, 0.0, 0);
    let judge = judge_of(81, &triangles, &[], &[]);
    let flat = report(&judge, &x);
    assert!(flat.is_clear());
    // A corner of a right triangle over the opposite edge.
    let nearest = flat.nearest.expect("pairs");
    assert!((nearest.distance - 0.125 * 0.5f64.sqrt()).abs() < 1e-12, "{nearest}");

    // A triangle that stands across the sheet.
    x.extend(points(&[[0.3, 0.31, -1.0], [0.63, 0.29, 1.0], [0.36, 0.73, 1.0]]));
    triangles.push([81, 82, 83]);
    let judge = judge_of(84, &triangles, &[], &[]);
    let report = report(&judge, &x);
    assert!(report.edge_triangle_count > 0);
    assert_eq!(report.intersection_count, report.edge_triangle_count);
    for intersection in &report.intersections {
        assert!(intersection.place.z.abs() < 1e-12, "{intersection}");
        assert!(intersection.vertices.iter().flatten().any(|&v| v > 80));
    }
    let mesh = judge.offending_mesh(&x, &report.intersections);
    assert!(mesh.triangles.len() >= 3 && mesh.triangles.len() < 20 && mesh.sources.contains(&128));
    for (triangle, &source) in mesh.triangles.iter().zip(&mesh.sources) {
        assert_eq!(triangle.map(|v| mesh.vertices[v as usize]), triangles[source as usize]);
    }
    assert!(mesh.vertices.iter().zip(&mesh.positions).all(|(&v, p)| x[v as usize] == *p));
}

/// Touching by a corner, an edge, a face; and the same a hair apart.
#[test]
fn touching_counts() {
    let base = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0]];
    for (what, other) in [
        ("corner on face", [[0.5, 0.5, 0.0], [0.5, 0.6, 1.0], [0.4, 0.5, 1.0]]),
        ("corner on corner", [[2.0, 0.0, 0.0], [2.5, 0.6, 1.0], [2.4, 0.5, 1.0]]),
        ("edge along edge", [[0.5, 0.0, 0.0], [1.5, 0.0, 0.0], [1.0, 0.0, 1.0]]),
        ("coplanar inside", [[0.2, 0.2, 0.0], [0.6, 0.2, 0.0], [0.2, 0.6, 0.0]]),
        ("coplanar around", [[-5.0, -5.0, 0.0], [9.0, -5.0, 0.0], [-5.0, 9.0, 0.0]]),
    ] {
        let mut x = points(&base);
        x.extend(points(&other));
        let judge = judge_of(6, &[[0, 1, 2], [3, 4, 5]], &[], &[]);
        assert!(!report(&judge, &x).is_clear(), "{what}");
        x[3..].iter_mut().for_each(|p| p.z += 1e-15);
        assert!(report(&judge, &x).is_clear(), "{what}, apart");
    }
}

/// Contacts in which every edge and triangle share a vertex are found as well.
#[test]
fn contacts_among_neighbors_are_found() {
    // A tetrahedron flattened to a quad: its opposite edges cross.
    let flat = points(&[[0.0, 0.0, 0.0], [1.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
    let faces = [[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]];
    let judge = judge_of(4, &faces, &[], &[]);
    let found = report(&judge, &flat);
    assert_eq!(found.edge_triangle_count, 0);
    let crossing =
        found.intersections.iter().find(|i| i.class == PairClass::EdgeEdge).expect("the diagonals");
    assert_eq!(crossing.vertices, [vec![0, 1], vec![2, 3]]);
    assert!((crossing.place - Point::new(0.5, 0.5, 0.0)).norm() < 1e-12);
    let mut solid = flat.clone();
    solid[3].z = 1e-12;
    assert!(report(&judge, &solid).is_clear());

    // Flattened the other way: one corner lies within the opposite face.
    let fan = points(&[[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0], [1.0, 1.0, 0.0]]);
    let found = report(&judge, &fan);
    assert_eq!(listed(&found.intersections), [(PairClass::VertexTriangle, [3, 0])]);

    // Two triangles on one edge, folded onto each other.
    let folded = points(&[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.4, 1.0, 0.0], [0.6, 0.5, 0.0]]);
    let judge = judge_of(4, &[[0, 1, 2], [0, 1, 3]], &[], &[]);
    assert!(!report(&judge, &folded).is_clear());
}

#[test]
fn strands_particles_and_half_spaces() {
    let strands = [[0, 1], [2, 3]];
    let judge = judge_of(6, &[], &strands, &[4, 5]);
    let mut x = points(&[
        [-1.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [0.5, -1.0, 0.0],
        [0.5, 1.0, 0.0],
        [-0.5, 0.0, 0.0],
        [-0.5, 0.0, 0.0],
    ]);
    let found = report(&judge, &x);
    let expected = [
        (PairClass::EdgeEdge, [0, 1]),
        (PairClass::VertexEdge, [4, 0]),
        (PairClass::VertexEdge, [5, 0]),
        (PairClass::VertexVertex, [4, 5]),
    ];
    assert_eq!(listed(&found.intersections), expected);
    assert_eq!(found.nearest.map(|nearest| nearest.distance), Some(0.0));
    x[2].z = 0.25;
    x[3].z = 0.25;
    x[4].z = 0.5;
    x[5].z = -0.125;
    let found = report(&judge, &x);
    assert!(found.is_clear());
    let nearest = found.nearest.expect("pairs");
    assert_eq!((nearest.class, nearest.elements, nearest.distance), (PairClass::VertexEdge, [5, 0], 0.125));

    let tilted = HalfSpace::new(Point::new(0.0, 0.0, -0.2), Vector::new(1.0, 0.0, 2.0)).expect("a normal");
    let parts = Parts {
        vertex_count: 6,
        strands: &strands,
        particles: &[4, 5],
        half_spaces: &[tilted],
        ..Parts::default()
    };
    let judge = Judge::new(&parts).expect("valid parts");
    let found = report(&judge, &x);
    let expected = [(PairClass::VertexHalfSpace, [0, 0]), (PairClass::VertexHalfSpace, [5, 0])];
    assert_eq!(listed(&found.intersections), expected);
    assert_eq!(found.intersections[0].bodies, [Some(0), None]);
    let nearest = found.nearest.expect("pairs");
    assert_eq!(nearest.class, PairClass::VertexHalfSpace);
    assert!((nearest.distance + 0.6 / 5.0f64.sqrt()).abs() < 1e-12, "{nearest}");
}

#[test]
fn obstacles_and_filters_are_exempt() {
    // Three triangles through one another.
    let corners = [[-1.0, -1.0, 0.0], [2.0, -1.0, 0.0], [0.0, 2.0, 0.0]];
    let turned = |k: usize| corners.map(|p| [p[k], p[(k + 1) % 3], p[(k + 2) % 3]]);
    let x: Vec<Point> = (0..3).flat_map(|k| points(&turned(k))).collect();
    let triangles = [[0, 1, 2], [3, 4, 5], [6, 7, 8]];
    let body = [0, 0, 0, 1, 1, 1, 2, 2, 2];
    let obstacle = [true, true, true, true, true, true, false, false, false];
    let parts = Parts { vertex_count: 9, triangles: &triangles, body: &body, ..Parts::default() };
    let bodies_met = |judge: &Judge| {
        let mut met: Vec<[Option<u32>; 2]> = report(judge, &x)
            .intersections
            .iter()
            .map(|i| [i.bodies[0].min(i.bodies[1]), i.bodies[0].max(i.bodies[1])])
            .collect();
        met.sort_unstable();
        met.dedup();
        met
    };
    let pair = |i, j| [Some(i), Some(j)];
    let judge = Judge::new(&parts).expect("valid parts");
    assert_eq!(bodies_met(&judge), [pair(0, 1), pair(0, 2), pair(1, 2)]);
    let judge = Judge::new(&Parts { obstacle: &obstacle, ..parts }).expect("valid parts");
    assert_eq!(bodies_met(&judge), [pair(0, 2), pair(1, 2)]);

    // Body 2 does not collide with the group of body 1.
    let filters = [
        BodyFilter::OBSTACLE,
        BodyFilter { groups: 2, ..BodyFilter::OBSTACLE },
        BodyFilter { mask: 1, ..BodyFilter::DEFORMABLE },
    ];
    let topology = Topology::builder(9).triangles(triangles.iter().copied()).build().expect("valid topology");
    let model =
        CollisionModel::new(topology, body.to_vec(), filters.to_vec(), Vec::new()).expect("valid model");
    let judge = Judge::from_model(&model);
    assert_eq!(judge.edges(), model.topology().edges);
    assert_eq!(bodies_met(&judge), [pair(0, 2)]);
}

/// A spike of body 1 stands 3 cm through a sheet of body 0; body 2 lies below the ground and crosses itself.
#[test]
fn pairs_of_bodies_are_counted_with_their_depth() {
    let (mut x, mut triangles) = sheet(3, 0.0, 0);
    x.extend(points(&[[0.3, 0.2, -0.03], [0.3, 0.2, 1.0], [0.31, 0.2, 1.0]]));
    triangles.push([9, 10, 11]);
    x.extend(points(&[[5.0, 0.0, -0.4], [6.0, 0.0, -0.4], [5.0, 1.0, -0.4]]));
    x.extend(points(&[[5.2, 0.2, -0.2], [5.2, 0.2, -0.5], [5.3, 0.2, -0.2]]));
    triangles.extend([[12, 13, 14], [15, 16, 17]]);
    let body: Vec<u32> = [vec![0; 9], vec![1; 3], vec![2; 6]].concat();
    let ground = HalfSpace::new(Point::new(0.0, 0.0, -0.1), Vector::z()).expect("a normal");
    let parts = Parts { vertex_count: 18, triangles: &triangles, body: &body, ..Parts::default() };
    let judge = Judge::new(&Parts { half_spaces: &[ground], ..parts }).expect("valid parts");
    let options = StateOptions { limit: 1, distance: false };
    let found = judge.check_state(&x, &options).expect("valid points");
    assert_eq!(found.intersections.len(), 1);
    let rows: Vec<_> = found.body_pairs.iter().map(|pair| (pair.bodies, pair.count)).collect();
    assert_eq!(rows, [([Some(0), Some(1)], 2), ([Some(2), Some(2)], 2), ([Some(2), None], 6)]);
    let depth = |index: usize| found.body_pairs[index].depth.expect("of a state");
    assert!((depth(0) - 0.03).abs() < 1e-12 && (depth(1) - 0.1).abs() < 1e-12, "{found:?}");
    assert!((depth(2) - 0.4).abs() < 1e-12, "{found:?}");
    assert!((found.body_pairs[2].place - Point::new(5.2, 0.2, -0.5)).norm() < 1e-12);
    assert_eq!(found.body_pairs.iter().map(|pair| pair.count).sum::<usize>(), found.intersection_count);

    // Body 2 may cross itself. The filters of the others are the default.
    let filters = [BodyFilter::DEFORMABLE; 2].into_iter();
    let filters: Vec<_> =
        filters.chain([BodyFilter { self_collision: false, ..BodyFilter::DEFORMABLE }]).collect();
    let judge = Judge::new(&Parts { filters: &filters, ..parts }).expect("valid parts");
    let found = judge.check_state(&x, &options).expect("valid points");
    assert_eq!((found.intersection_count, found.body_pairs.len()), (2, 1));

    // On the way from above, the spike meets the sheet too.
    let mut above = x.clone();
    above[9..12].iter_mut().for_each(|p| p.z += 1.0);
    let judge = Judge::new(&Parts { filters: &filters, ..parts }).expect("valid parts");
    let path = judge.check_path(&above, &x, &PathOptions::default()).expect("valid points");
    let rows: Vec<_> = path.body_pairs.iter().map(|pair| (pair.bodies, pair.count, pair.depth)).collect();
    assert_eq!(rows, [([Some(0), Some(1)], path.hit_count, None)]);
    assert!(path.hit_count > 0);
}

#[test]
fn bad_input_is_refused() {
    let parts = Parts { vertex_count: 3, ..Parts::default() };
    let error = |parts: Parts<'_>| Judge::new(&parts).expect_err("must be refused");
    assert_eq!(
        error(Parts { triangles: &[[0, 1, 2], [0, 1, 3]], ..parts }),
        CheckError::Topology(
            VertexOutOfRange { element: "triangle", index: 1, vertex: 3, vertex_count: 3 }.into()
        )
    );
    assert_eq!(
        error(Parts { strands: &[[2, 2]], ..parts }),
        CheckError::Topology(TopologyError::RepeatedVertex { element: "strand edge", index: 0, vertex: 2 })
    );
    assert_eq!(
        error(Parts { particles: &[7], ..parts }),
        CheckError::Topology(
            VertexOutOfRange { element: "particle", index: 0, vertex: 7, vertex_count: 3 }.into()
        )
    );
    assert_eq!(
        error(Parts { obstacle: &[true], ..parts }),
        CheckError::WrongLength { what: "obstacle", given: 1, vertex_count: 3 }
    );
    let judge = judge_of(3, &[[0, 1, 2]], &[], &[]);
    let mut x = points(&[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
    let options = StateOptions::default();
    assert!(
        judge.check_state(&x, &options).is_ok_and(|report| report.is_clear() && report.nearest.is_none())
    );
    assert!(matches!(judge.check_state(&x[..2], &options), Err(CheckError::WrongLength { given: 2, .. })));
    for bad in [f64::NAN, f64::INFINITY, -1e70] {
        x[1].y = bad;
        assert!(matches!(judge.check_state(&x, &options), Err(CheckError::BadCoordinate { vertex: 1, .. })));
    }
}

/// All pairs of a soup within a distance are those that are found one by one, half-spaces included.
#[test]
fn near_pairs_equal_all_pairs() {
    let mut random = Random::new(9);
    let x: Vec<Point> = (0..90).map(|_| random.point(0.3)).collect();
    let triangles: Vec<[u32; 3]> = (0..20).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    let strands: Vec<[u32; 2]> = (0..10).map(|i| [60 + 2 * i, 61 + 2 * i]).collect();
    let particles: Vec<u32> = (80..90).collect();
    let half_spaces = [HalfSpace { normal: Vector::z(), offset: -0.25 }];
    let judge = Judge::new(&Parts {
        vertex_count: x.len(),
        triangles: &triangles,
        strands: &strands,
        particles: &particles,
        half_spaces: &half_spaces,
        ..Parts::default()
    })
    .expect("sound parts");
    let distance = 0.05;
    let mut expected = Vec::new();
    let mut add = |class, elements: [u32; 2]| {
        let sides = judge.sides(class, elements);
        if !sides[0].iter().any(|v| sides[1].contains(v)) && judge.measured(class, elements, &x).1 <= distance
        {
            expected.push((class, elements));
        }
    };
    let edges = judge.edges().len() as u32;
    (0..edges).for_each(|a| (a + 1..edges).for_each(|b| add(PairClass::EdgeEdge, [a, b])));
    (0..90).for_each(|v| (0..20).for_each(|t| add(PairClass::VertexTriangle, [v, t])));
    let strand_edges: Vec<u32> = (0..edges).filter(|&e| judge.edges()[e as usize][0] >= 60).collect();
    particles.iter().for_each(|&v| strand_edges.iter().for_each(|&e| add(PairClass::VertexEdge, [v, e])));
    (80..90).for_each(|a| (a + 1..90).for_each(|b| add(PairClass::VertexVertex, [a, b])));
    (0..90).for_each(|v| add(PairClass::VertexHalfSpace, [v, 0]));
    expected.sort_unstable();
    let found = judge.pairs_within(&x, distance).expect("a sound state");
    let listed: Vec<_> = found.iter().map(|pair| (pair.class, pair.elements)).collect();
    assert_eq!(listed, expected);
    for class in [PairClass::EdgeEdge, PairClass::VertexTriangle, PairClass::VertexEdge] {
        assert!(listed.iter().any(|pair| pair.0 == class), "{class:?}");
    }
    assert!(found.iter().all(|pair| pair.class == PairClass::VertexHalfSpace
        || ((pair.places[0] - pair.places[1]).norm() - pair.distance).abs() < 1e-12));
}
