//! Straight paths.

use super::oracle::{self, Answer};
use super::*;
use crate::primitives::gather;
use crate::sweep::Sweep;
use bowknot_geometry::PairKind;

/// A judge of a single vertex-triangle or edge-edge pair.
fn pair_judge(edges: bool) -> Judge {
    if edges { judge_of(4, &[], &[[0, 1], [2, 3]], &[]) } else { judge_of(4, &[[1, 2, 3]], &[], &[0]) }
}

fn hits(judge: &Judge, x0: &[Point], x1: &[Point]) -> usize {
    let options = PathOptions { skip_unmoved: false, ..PathOptions::default() };
    judge.check_path(x0, x1, &options).expect("valid points").hit_count
}

/// A vertex 2e-13 m above a triangle of 0.5 m by 1e-7 m, by exact arithmetic over these coordinates. The
/// plane through the triangle was taken from its two long edges, and was off by 4.5e-11 m.
#[test]
fn a_vertex_that_rests_just_above_a_sliver_is_no_hit() {
    let x = [
        Point::new(-0.15732715683201304, -0.4050834654500105, 2.0414598060059657),
        Point::new(-1.8757292049730676e-7, 5.5146084164496204e-8, 2.288756320508448),
        Point::new(-0.3146541771730918, -0.810166986875561, 1.7941633253593121),
        Point::new(-0.3146540750091194, -0.8101669852166491, 1.7941632576464703),
    ];
    let judge = pair_judge(false);
    assert_eq!(hits(&judge, &x, &x), 0);
    let nearest = judge.check_state(&x, &StateOptions::default()).expect("valid points").nearest;
    let distance = nearest.expect("a pair").distance;
    assert!((distance - 1.98684e-13).abs() < 1e-15, "{distance:e}");
}

/// Two edges of 2.3 m that cross at an angle of 5e-6 come to 5.7e-14 m of each other, by exact arithmetic
/// over these coordinates. Their cross product is off by an angle of 1e-10.
#[test]
fn edges_that_pass_close_by_and_nearly_parallel_are_no_hit() {
    let first = [
        [0.6734231152249678, 3.6721091504738834, 5.761036572072917],
        [2.5954011054771153, 4.087732768141032, 4.651071246495226],
    ];
    let before = [
        [0.6734226991298278, 3.6721061087793494, 5.761036357829615],
        [2.595400262180916, 4.087734265565661, 4.651071992183279],
    ];
    let after = [
        [0.6734226991299403, 3.6721061087792832, 5.761036357829933],
        [2.5954002621810286, 4.087734265565595, 4.651071992183597],
    ];
    let judge = pair_judge(true);
    let at = |second: [[f64; 3]; 2]| points(&[first, second].concat());
    assert_eq!(hits(&judge, &at(before), &at(after)), 0);
    for (second, distance) in [(before, 3.926_092e-13), (after, 5.665_665e-14)] {
        let nearest = judge.check_state(&at(second), &StateOptions::default()).expect("valid points").nearest;
        let found = nearest.expect("a pair").distance;
        assert!((found - distance).abs() < 2e-15, "{found:e}");
    }
}

/// A short edge slides past an edge that is 400,000 times as long, 3e-14 m beside it. By exact arithmetic
/// over these coordinates the lines of both cross at 4e-6 of the path, 4.5e-12 m beyond the end of the short
/// edge. There only directions across the long edge certify anything.
#[test]
fn an_edge_that_slides_off_the_side_of_a_long_one_is_no_hit() {
    let long = [[0.0, 0.0, 1e-9], [-0.006109734554016352, -0.31226992782155005, 0.4030510688834673]];
    let before = [
        [-0.003054867277008176, -0.15613496391077503, 0.20152553494178513],
        [-0.003053584238739361, -0.15613496391077503, 0.20152553494178513],
    ];
    let after = [
        [-0.0030537702794087, -0.15613487590660766, 0.20152540883909553],
        [-0.003052487241139884, -0.15613487590727304, 0.20152540883842765],
    ];
    let at = |short: [[f64; 3]; 2]| points(&[long, short].concat());
    assert_eq!(hits(&pair_judge(true), &at(before), &at(after)), 0);
}

/// Random integer queries: a certain hit is never missed, a certain miss is never flagged (integers
/// leave gaps far above rounding). The shift and the scale exercise rounding: both are exact in
/// doubles, and the answer is the same.
#[test]
fn verdicts_equal_the_exact_ones() {
    let mut random = Random::new(7);
    let (mut sure_hits, mut sure_misses, mut unknown) = (0, 0, 0);
    for round in 0..12_000 {
        let edges = round % 2 == 0;
        let range = [2, 4, 7][round / 2 % 3];
        let x: [[[i64; 3]; 2]; 4] = std::array::from_fn(|_| {
            std::array::from_fn(|_| std::array::from_fn(|_| random.integer(-range, range)))
        });
        let answer = if edges { oracle::edge_edge(&x) } else { oracle::vertex_triangle(&x) };
        let (scale, shift) = [(1.0, 0.0), (0.5f64.powi(20), 3.0), (1024.0, -0.5)][round % 3];
        let at = |end: usize| -> Vec<Point> {
            x.iter().map(|p| Point::from(p[end].map(|c| c as f64 * scale + shift))).collect()
        };
        let count = hits(&pair_judge(edges), &at(0), &at(1));
        match answer {
            Answer::Hit => {
                sure_hits += 1;
                assert_eq!(count, 1, "missed: edges {edges} {x:?}");
            }
            Answer::Clear => {
                sure_misses += 1;
                assert_eq!(count, 0, "false: edges {edges} {x:?}");
            }
            Answer::Unknown => unknown += 1,
        }
    }
    assert!(sure_hits > 1500 && sure_misses > 6000 && unknown < 2000, "{sure_hits} {sure_misses} {unknown}");
}

/// Pairs made to touch, exactly, at a time that is a multiple of 1/8, mostly just grazing: never missed.
/// Moved apart by one part in 2^30 along a direction that separates them all the way: never flagged.
#[test]
fn touching_is_a_hit_and_a_hair_apart_is_not() {
    let mut random = Random::new(8);
    for round in 0..6_000 {
        let edges = round % 2 == 0;
        let mut integers = |low, high| {
            Vector::new(
                random.integer(low, high) as f64,
                random.integer(low, high) as f64,
                random.integer(low, high) as f64,
            )
        };
        // Corners in the plane z = 0 around a common point.
        let flat = |v: Vector| Vector::new(v.x, v.y, 0.0);
        let (u, v, common) = (flat(integers(-6, 6)), flat(integers(-6, 6)), integers(-9, 9));
        let touching: [Vector; 4] = if edges {
            [common + u, common - u * 3.0, common + v, common - v]
        } else {
            [common, common + u, common + v, common - u - v]
        };
        // Side b keeps z, side a comes down onto it and leaves again, or stops there; sideways all move.
        let speeds: [Vector; 4] = std::array::from_fn(|_| flat(integers(-9, 9)));
        let time = (round / 2 % 9) as f64 / 8.0;
        let (x0, x1): (Vec<Point>, Vec<Point>) = (0..4)
            .map(|i| {
                (
                    Point::from(touching[i] - speeds[i] * time),
                    Point::from(touching[i] + speeds[i] * (1.0 - time)),
                )
            })
            .unzip();
        let judge = pair_judge(edges);
        assert_eq!(hits(&judge, &x0, &x1), 1, "missed: {edges} {x0:?} {x1:?}");

        let lift = |x: &[Point], slope: f64| -> Vec<Point> {
            let side_a = if edges { 2 } else { 1 };
            let gap = Vector::new(0.0, 0.0, 0.5f64.powi(30) * slope);
            x.iter().enumerate().map(|(i, p)| if i < side_a { p + gap } else { *p }).collect()
        };
        assert_eq!(hits(&judge, &lift(&x0, 1.0), &lift(&x1, 3.0)), 0, "false: {edges} {x0:?} {x1:?}");
    }
}

/// The time of a hit is that of the first contact.
#[test]
fn time_and_place_are_those_of_the_first_contact() {
    let judge = judge_of(4, &[[1, 2, 3]], &[], &[0]);
    let x0 = points(&[[0.25, 0.25, 0.3], [0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
    let mut x1 = x0.clone();
    x1[0].z = -0.7;
    let report = judge.check_path(&x0, &x1, &PathOptions::default()).expect("valid points");
    assert_eq!(report.hits.len(), 1);
    let hit = &report.hits[0];
    assert_eq!((hit.class, hit.elements), (PairClass::VertexTriangle, [0, 0]));
    assert_eq!(hit.vertices, [vec![0], vec![1, 2, 3]]);
    assert!((hit.time - 0.3).abs() < 1e-9 && hit.time <= 0.3, "{}", hit.time);
    assert!((hit.places[0] - Point::new(0.25, 0.25, 0.0)).norm() < 1e-9);
    assert!(
        format!("{hit}")
            .starts_with("vertex 0 of body 0 and triangle 0 (vertices [1, 2, 3]) of body 0 meet at")
    );
}

/// The trees lose no pair: soups of triangles, strands and particles, against every pair by itself.
#[test]
fn broad_phase_keeps_every_pair() {
    for seed in 0..6 {
        let mut random = Random::new(103 + seed);
        let n: u32 = 60;
        let count = (3 * n + 2 * n + n) as usize;
        let (size, travel) = [(0.3, 0.3), (0.1, 0.02), (0.05, 2.0)][seed as usize % 3];
        let mut x0 = Vec::new();
        for (elements, corners) in [(n, 3), (n, 2), (n, 1)] {
            for _ in 0..elements {
                let center = random.point(0.7);
                x0.extend((0..corners).map(|_| center + random.vector(size)).collect::<Vec<_>>());
            }
        }
        let x1: Vec<Point> = x0.iter().map(|p| p + random.vector(travel)).collect();
        let triangles: Vec<[u32; 3]> = (0..n).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        let strands: Vec<[u32; 2]> = (0..n).map(|i| [3 * n + 2 * i, 3 * n + 2 * i + 1]).collect();
        let particles: Vec<u32> = (5 * n..6 * n).collect();
        let judge = judge_of(count, &triangles, &strands, &particles);
        let options = PathOptions { limit: usize::MAX, skip_unmoved: true };
        let found = judge.check_path(&x0, &x1, &options).expect("valid points");
        assert_eq!(found.hits.len(), found.hit_count);

        let mut expected = 0;
        let mut ask = |kind: PairKind, a: &[u32], b: &[u32]| {
            if !a.iter().any(|v| b.contains(v)) {
                let (start, end) = (gather(&x0, [a, b]), gather(&x1, [a, b]));
                expected += usize::from(Sweep::new(kind, &start, &end).hit().is_some());
            }
        };
        let edges = judge.edges();
        for v in 0..count as u32 {
            triangles.iter().for_each(|t| ask(PairKind::VertexTriangle, &[v], t));
        }
        for (i, a) in edges.iter().enumerate() {
            edges[..i].iter().for_each(|b| ask(PairKind::EdgeEdge, a, b));
        }
        for (i, &v) in particles.iter().enumerate() {
            strands.iter().for_each(|s| ask(PairKind::VertexEdge, &[v], s));
            particles[..i].iter().for_each(|&w| ask(PairKind::VertexVertex, &[w], &[v]));
        }
        assert_eq!(found.hit_count, expected, "seed {seed}");
        assert!(expected > 0, "seed {seed} tests nothing");
    }
}

/// However far two sheets fall together, nothing but the pairs near one another is looked at, and
/// nothing is flagged.
#[test]
fn common_motion_costs_nothing() {
    let (mut x0, mut triangles) = sheet(20, 0.0, 0);
    let (upper, more) = sheet(20, 1e-4, 400);
    x0.extend(upper);
    triangles.extend(more);
    let judge = judge_of(800, &triangles, &[], &[]);
    let still = judge.check_path(&x0, &x0, &PathOptions { skip_unmoved: false, ..PathOptions::default() });
    let fall = |v: Vector| x0.iter().map(|p| p + v).collect::<Vec<_>>();
    let far = judge.check_path(&x0, &fall(Vector::new(512.0, -64.0, -1024.0)), &PathOptions::default());
    let (still, far) = (still.expect("valid points"), far.expect("valid points"));
    assert!(still.is_clear() && far.is_clear(), "{:?}", far.hits);
    assert!(far.candidates <= still.candidates + 4000, "{} {}", far.candidates, still.candidates);

    // The upper sheet passes through the lower one.
    let through: Vec<Point> =
        x0.iter().map(|p| if p.z > 0.0 { p - Vector::new(0.0, 0.0, 3e-4) } else { *p }).collect();
    let report = judge.check_path(&x0, &through, &PathOptions { limit: 3, ..PathOptions::default() });
    let report = report.expect("valid points");
    assert!(report.hit_count > 800 && report.hits.len() == 3);
    assert!(report.hits.iter().all(|hit| (hit.time - 1.0 / 3.0).abs() < 1e-6));
}

#[test]
fn unmoved_and_exempt_pairs_are_skipped() {
    // A vertex rests in a triangle; another one falls through it.
    let x0 = points(&[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.2, 0.2, 0.0], [0.3, 0.3, 1.0]]);
    let mut x1 = x0.clone();
    x1[4].z = -1.0;
    let parts = Parts { vertex_count: 5, triangles: &[[0, 1, 2]], particles: &[3, 4], ..Parts::default() };
    let judge = Judge::new(&parts).expect("valid parts");
    let count = |judge: &Judge, skip_unmoved: bool| {
        judge.check_path(&x0, &x1, &PathOptions { limit: 9, skip_unmoved }).expect("valid points").hit_count
    };
    assert_eq!((count(&judge, true), count(&judge, false)), (1, 2));
    let obstacle = [true, true, true, false, true];
    let judge = Judge::new(&Parts { obstacle: &obstacle, ..parts }).expect("valid parts");
    assert_eq!((count(&judge, true), count(&judge, false)), (0, 1));
}

#[test]
fn half_spaces_are_judged_at_both_ends() {
    let ground = HalfSpace::new(Point::origin(), Vector::z()).expect("a normal");
    let parts = Parts { vertex_count: 2, particles: &[0, 1], half_spaces: &[ground], ..Parts::default() };
    let judge = Judge::new(&parts).expect("valid parts");
    let x0 = points(&[[0.0, 0.0, 1.0], [1.0, 0.0, 1e-9]]);
    let x1 = points(&[[0.0, 0.0, -3.0], [1.0, 0.0, 1e-9]]);
    let report = judge.check_path(&x0, &x1, &PathOptions::default()).expect("valid points");
    assert_eq!(report.hit_count, 1);
    assert_eq!(report.hits[0].elements, [0, 0]);
    assert!((report.hits[0].time - 0.25).abs() < 1e-12);
    let parts = Parts { obstacle: &[true, true], ..parts };
    let judge = Judge::new(&parts).expect("valid parts");
    assert!(judge.check_path(&x0, &x1, &PathOptions::default()).expect("valid points").is_clear());
}

#[test]
fn reports_do_not_depend_on_threads() {
    let mut random = Random::new(5);
    let (mut x0, triangles) = sheet(40, 0.0, 0);
    x0.iter_mut().for_each(|p| *p += random.vector(0.02));
    let x1: Vec<Point> = x0.iter().map(|p| p + random.vector(0.02)).collect();
    let judge = judge_of(x0.len(), &triangles, &[], &[]);
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        pool.install(|| {
            let path = judge.check_path(&x0, &x1, &PathOptions { limit: usize::MAX, skip_unmoved: true });
            let state = judge.check_state(&x0, &StateOptions { limit: usize::MAX, distance: true });
            (path.expect("valid points"), state.expect("valid points"))
        })
    };
    let one = run(1);
    assert!(
        one.0.hit_count > 10 && one.1.intersection_count > 10,
        "{} {}",
        one.0.hit_count,
        one.1.intersection_count
    );
    assert_eq!(one, run(2));
    assert_eq!(one, run(7));
}

/// Two edges 4e8 m long, 4 cm apart, on a path of 1e8 m along which they keep 7 mm (by rational arithmetic:
/// all differences of their ends are positive along one direction, at both ends of the path). The direction
/// of closest points as `f64` has them is too rough to see it.
#[test]
fn narrow_gaps_of_huge_edges_are_certified() {
    let x0 = [
        [-1000000.0315868761, 0.11427178862742784, -0.07224481686574157],
        [-338611411.3229854, -324319623.4983467, 220643678.2807948],
        [-41666578.168637924, -39065531.70004228, 26577369.9443615],
        [-56386489.55521001, -193719254.70931104, 14914700.923483405],
    ];
    let x1 = [
        [-1000000.029712478, 0.11816476926486423, -0.07719515026890142],
        [-386808574.64544976, -370619260.69867826, 252142611.78713953],
        [-134288907.64783743, -128041312.77454889, 87110073.46226354],
        [-56382338.34993558, -193721133.8840941, 14908894.621463442],
    ];
    assert_eq!(hits(&pair_judge(true), &x0.map(Point::from), &x1.map(Point::from)), 0);
}
