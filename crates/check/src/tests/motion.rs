//! States and paths judged one after the other.

use super::*;
use crate::MotionJudge;

/// Two crumpled sheets, strands and particles, above a half-space.
fn crowd(random: &mut Random) -> (Judge, Vec<Point>) {
    let (mut x, mut triangles) = sheet(12, 0.0, 0);
    let (above, more) = sheet(12, 0.3, 144);
    x.extend(above);
    triangles.extend(more);
    let strands: Vec<[u32; 2]> = (288..318).map(|v| [v, v + 1]).collect();
    let particles: Vec<u32> = (319..360).collect();
    x.extend((288..360).map(|_| random.point(0.5) + Vector::new(0.5, 0.5, 0.5)));
    let half_spaces = [HalfSpace { normal: Vector::z(), offset: -50.0 }];
    let body: Vec<u32> = (0..360).map(|v| v / 144).collect();
    let obstacle: Vec<bool> = (0..360).map(|v| (144..288).contains(&v)).collect();
    let judge = Judge::new(&Parts {
        vertex_count: x.len(),
        triangles: &triangles,
        strands: &strands,
        particles: &particles,
        obstacle: &obstacle,
        body: &body,
        half_spaces: &half_spaces,
        filters: &[],
    });
    (judge.expect("valid parts"), x)
}

/// Whatever was judged before, the report is that of a judge who sees but this path: over many paths,
/// so that orders are kept and renewed, clear ones and ones full of hits, with jumps in between.
#[test]
fn an_order_that_is_kept_changes_no_verdict() {
    let mut random = Random::new(21);
    let (judge, mut x) = crowd(&mut random);
    let mut motion = MotionJudge::new(judge.clone());
    let (mut clear, mut struck) = (0, 0);
    let mut states = [0, 0];
    for round in 0..48 {
        let size = [1e-5, 3e-3, 3e-2][round % 3];
        let drift = random.vector(0.1);
        let mut y: Vec<Point> = x
            .iter()
            .map(|p| if random.unit() < -0.5 { *p } else { p + drift * size + random.vector(size) })
            .collect();
        if round == 30 {
            // All else but near where the order was found.
            y.reverse();
        }
        let options = PathOptions { limit: 1000, skip_unmoved: round % 2 == 0 };
        let alone = judge.check_path(&x, &y, &options).expect("valid points");
        let kept = motion.check_path(&x, &y, &options).expect("valid points");
        assert_eq!(kept, alone, "round {round}");
        if alone.is_clear() {
            clear += 1
        } else {
            struck += 1
        }
        // Distances look at the vertices of triangles as well, whose order is found when it is wanted first.
        let options = StateOptions { limit: 1000, distance: round % 4 == 3 };
        let alone = judge.check_state(&y, &options).expect("valid points");
        let kept = motion.check_state(&y, &options).expect("valid points");
        assert_eq!(kept, alone, "round {round}");
        states[usize::from(alone.is_clear())] += 1;
        if round % 3 == 2 {
            x = y;
        }
    }
    assert!(clear >= 10 && struck >= 10, "{clear} clear, {struck} struck");
    assert!(states[0] >= 10, "{states:?}");
}

/// Every pair whose moving boxes meet is looked at, each once: counted without a tree.
#[test]
fn an_outdated_order_leaves_no_pair_out() {
    let mut random = Random::new(22);
    let (count, range) = (300, 0.2);
    let triangles: Vec<[u32; 3]> = (0..count).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    let judge = judge_of(3 * count as usize, &triangles, &[], &[]);
    let mut motion = MotionJudge::new(judge);
    for _ in 0..5 {
        // Places at random each time: the order of the first is worth nothing for the others.
        let centers: Vec<Vector> = (0..count).map(|_| random.vector(1.0)).collect();
        let mut at = || -> Vec<Point> {
            (0..3 * count as usize).map(|v| Point::from(centers[v / 3]) + random.vector(range)).collect()
        };
        let (x0, x1) = (at(), at());
        let hull = |vertices: &[u32]| {
            [&x0, &x1].map(|x| {
                let corner = |pick: fn(f64, f64) -> f64, start: f64| -> [f64; 3] {
                    std::array::from_fn(|c| vertices.iter().fold(start, |m, &v| pick(m, x[v as usize][c])))
                };
                [corner(f64::min, f64::INFINITY), corner(f64::max, f64::NEG_INFINITY)]
            })
        };
        let apart = |a: &[u32], b: &[u32]| {
            let (a, b) = (hull(a), hull(b));
            (0..3).any(|c| (0..2).all(|k| a[k][1][c] < b[k][0][c]) || (0..2).all(|k| b[k][1][c] < a[k][0][c]))
        };
        let mut expected = 0;
        let edges = motion.judge().edges().to_vec();
        for (i, e) in edges.iter().enumerate() {
            let met = |f: &&[u32; 2]| !e.iter().any(|v| f.contains(v)) && !apart(e, &f[..]);
            expected += edges[..i].iter().filter(met).count();
        }
        for v in 0..3 * count {
            expected += triangles.iter().filter(|t| !t.contains(&v) && !apart(&[v], &t[..])).count();
        }
        let options = PathOptions::default();
        let report = motion.check_path(&x0, &x1, &options).expect("valid points");
        // Boxes are rounded to single precision: of random places a few in a million then seem to meet.
        assert!(report.candidates >= expected && report.candidates <= expected + 1, "{expected} {report:?}");
        assert!(expected > 3_000, "{expected}");
    }
}

/// Coordinates that single precision cannot hold, or cannot tell apart.
#[test]
fn boxes_far_from_the_origin_and_huge_ones_hide_nothing() {
    for (shift, size) in [(1e9, 1.0), (0.0, 1e50), (1e50, 1e48), (0.0, 1e-60), (-0.0, 1.0)] {
        let place = |p: [f64; 3]| Point::from(p.map(|c| shift + size * c));
        let triangle = [[0.0, 0.0, -0.0], [4.0, 0.0, -0.0], [0.0, 4.0, -0.0]].map(place);
        let judge = judge_of(4, &[[1, 2, 3]], &[], &[0]);
        let with = |p: [f64; 3]| [&[place(p)], &triangle[..]].concat();
        let (above, on, below) = (with([1.0, 1.0, 1.0]), with([1.0, 1.0, 0.0]), with([1.0, 1.0, -1.0]));
        let hits = |x0: &[Point], x1: &[Point]| {
            judge.check_path(x0, x1, &PathOptions::default()).expect("valid points").hit_count
        };
        assert_eq!(hits(&above, &below), 1, "{shift} {size}");
        assert_eq!(hits(&above, &on), 1, "{shift} {size}");
        let report = judge.check_state(&on, &StateOptions::default()).expect("valid points");
        assert_eq!(report.intersection_count, 1, "{shift} {size}");
        if size > 1e-30 {
            assert_eq!(hits(&above, &with([2.0, 2.0, 1.0])), 0, "{shift} {size}");
        }
        let report = judge.check_state(&above, &StateOptions::default()).expect("valid points");
        assert_eq!(report.nearest.map(|nearest| nearest.elements), Some([0, 0]), "{shift} {size}");
    }
}
