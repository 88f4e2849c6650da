//! Against motions whose times of impact are known by construction, degenerate ones included.

use super::*;
use bowknot_twoway::geometry::distance;

fn p(x: f64, y: f64, z: f64) -> Point {
    Point::new(x, y, z)
}

fn v(x: f64, y: f64, z: f64) -> Vector {
    Vector::new(x, y, z)
}

/// Seeded random numbers.
struct Draw(fastrand::Rng);

impl Draw {
    fn new(seed: u64) -> Self {
        Self(fastrand::Rng::with_seed(seed))
    }

    /// Uniform in [-1, 1).
    fn next(&mut self) -> f64 {
        2.0 * self.0.f64() - 1.0
    }

    fn vector(&mut self) -> Vector {
        v(self.next(), self.next(), self.next())
    }

    fn share(&mut self) -> f64 {
        0.5 + 0.5 * self.next()
    }
}

const BOTH: [ClosingSpeed; 2] = [ClosingSpeed::Travel, ClosingSpeed::Slab];

fn ccd(speed: ClosingSpeed, slackness: f64) -> AdditiveCcd {
    AdditiveCcd { slackness, speed, max_iterations: 1_000_000 }
}

fn distance_at(kind: PairKind, x: &[Point; 4], paths: &[Vector; 4], t: f64) -> f64 {
    distance::closest(kind, &std::array::from_fn(|k| x[k] + t * paths[k])).distance
}

/// A motion of a pair of this kind that has a point of both sides at one place at `time`, to rounding.
fn meeting(kind: PairKind, time: f64, draw: &mut Draw) -> ([Point; 4], [Vector; 4]) {
    let mut place: [Point; 4] = std::array::from_fn(|_| Point::from(draw.vector()));
    let speed = 3.0_f64.powf(3.0 * draw.next());
    let paths: [Vector; 4] = std::array::from_fn(|_| speed * draw.vector());
    let (count, side_a) = (kind.vertex_count(), kind.side_a());
    let mut point = |side: std::ops::Range<usize>| {
        let weights: Vec<f64> = side.clone().map(|_| draw.share() + 1e-3).collect();
        let sum: f64 = weights.iter().sum();
        side.zip(weights).map(|(k, w)| place[k].coords * (w / sum)).sum::<Vector>()
    };
    let offset = point(0..side_a) - point(side_a..count);
    place[..side_a].iter_mut().for_each(|q| *q -= offset);
    (std::array::from_fn(|k| place[k] - time * paths[k]), paths)
}

/// The first time on a fine grid at which the vertices of a 4-vertex pair change the sign of their volume with the closest
/// points all but at one place: where the pair surely has met, found without any distance bound.
fn first_crossing(kind: PairKind, x: &[Point; 4], paths: &[Vector; 4]) -> Option<f64> {
    let volume = |t: f64| {
        let q: [Point; 4] = std::array::from_fn(|k| x[k] + t * paths[k]);
        (q[1] - q[0]).cross(&(q[2] - q[0])).dot(&(q[3] - q[0]))
    };
    let steps = 2000;
    (0..steps).find_map(|i| {
        let (mut low, mut high) = (f64::from(i) / f64::from(steps), f64::from(i + 1) / f64::from(steps));
        let sign = volume(low).signum();
        if sign == volume(high).signum() {
            return None;
        }
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if volume(middle).signum() == sign { low = middle } else { high = middle }
        }
        (distance_at(kind, x, paths, high) < 1e-9).then_some(high)
    })
}

#[test]
fn no_impact_is_missed_nor_reported_late_and_the_gap_left_is_small() {
    let mut draw = Draw::new(1);
    let kinds = [PairKind::VertexVertex, PairKind::VertexEdge, PairKind::VertexTriangle, PairKind::EdgeEdge];
    let mut earlier = 0;
    for trial in 0..2000 {
        let kind = kinds[trial % 4];
        let time = 0.02 + 0.98 * draw.share();
        let (x, paths) = meeting(kind, time, &mut draw);
        let gap = distance_at(kind, &x, &paths, 0.0);
        let crossing = if kind.vertex_count() == 4 { first_crossing(kind, &x, &paths) } else { None };
        let first = crossing.unwrap_or(1.0).min(time);
        earlier += usize::from(first < time - 1e-6);
        for speed in BOTH {
            for slackness in [0.1, 1e-4] {
                let found = ccd(speed, slackness).clearance(kind, &x, &paths, 0.0, 1.0).time;
                let what = format!("{kind:?} {speed:?} {slackness} {x:?} {paths:?}");
                assert!(found < first, "{found} after the impact at {first}: {what}");
                // One step of 0.9 gap/speed brought it below the slackness: it was ten times that at most. The time
                // may still be an earlier approach as near as that.
                let left = distance_at(kind, &x, &paths, found);
                if speed == ClosingSpeed::Travel {
                    assert!(
                        left <= 10.0 * slackness * gap * (1.0 + 1e-6),
                        "{left} m of {gap} m left: {what}"
                    );
                }
                assert!(left > 0.0, "{what}");
                for k in 0..=100 {
                    let t = found * f64::from(k) / 100.0;
                    assert!(distance_at(kind, &x, &paths, t) > 0.0, "{what}");
                }
            }
        }
    }
    assert!(earlier > 20, "only {earlier} motions had met before");
}

#[test]
fn a_head_on_approach_stops_at_the_slackness_exactly() {
    let triangle = [p(0.0, 0.0, 0.0), p(1.0, 0.0, 0.0), p(0.0, 1.0, 0.0)];
    let x = [p(0.25, 0.25, 0.5), triangle[0], triangle[1], triangle[2]];
    // The mean motion counts a quarter to the vertex and a quarter to the triangle's: 3/4 + 1/4 of the speed.
    let paths = [v(0.0, 0.0, -1.0), Vector::zeros(), Vector::zeros(), Vector::zeros()];
    for speed in BOTH {
        for slackness in [0.1, 1e-3] {
            let found = ccd(speed, slackness).clearance(PairKind::VertexTriangle, &x, &paths, 0.0, 1.0);
            assert!((found.time - (1.0 - slackness) * 0.5).abs() < 1e-12, "{found:?}");
            assert_eq!(found.iterations, 3);
        }
    }
    let floor = 0.2;
    let found = ccd(ClosingSpeed::Travel, 0.1).clearance(PairKind::VertexTriangle, &x, &paths, floor, 1.0);
    assert!((found.time - 0.9 * 0.3).abs() < 1e-12, "{found:?}");
}

/// Kind, start, end, time of impact.
type Case = (&'static str, PairKind, [Point; 4], [Point; 4], f64);

/// Motions that meet where a cubic's roots are many, double, or none, because it vanishes.
fn degenerate_meetings() -> Vec<Case> {
    let o = Point::origin();
    let (x, y) = (p(1.0, 0.0, 0.0), p(0.0, 1.0, 0.0));
    let up = |q: Point, h: f64| q + v(0.0, 0.0, h);
    let (vt, ee, ve, vv) =
        (PairKind::VertexTriangle, PairKind::EdgeEdge, PairKind::VertexEdge, PairKind::VertexVertex);
    vec![
        (
            "parallel edges side by side",
            ee,
            [o, x, up(o, 1.0), up(x, 1.0)],
            [o, x, up(o, -1.0), up(x, -1.0)],
            0.5,
        ),
        (
            "collinear edges end to end",
            ee,
            [o, x, p(2.0, 0.0, 0.0), p(3.0, 0.0, 0.0)],
            [o, x, p(0.0, 0.0, 0.0), p(1.0, 0.0, 0.0)],
            0.5,
        ),
        (
            "coplanar edges, an end against an inside",
            ee,
            [p(-1.0, 0.0, 0.0), x, p(0.0, 1.0, 0.0), p(0.0, 2.0, 0.0)],
            [p(-1.0, 0.0, 0.0), x, p(0.0, -1.0, 0.0), p(0.0, 0.0, 0.0)],
            0.5,
        ),
        (
            "a vertex in the plane of a triangle against its rim",
            vt,
            [p(-1.0, 0.3, 0.0), o, x, y],
            [p(1.0, 0.3, 0.0), o, x, y],
            0.5,
        ),
        ("a vertex onto a corner", vt, [p(-1.0, -1.0, 1.0), o, x, y], [p(1.0, 1.0, -1.0), o, x, y], 0.5),
        (
            "a triangle without area",
            vt,
            [p(0.5, 0.5, 1.0), o, x, p(2.0, 0.0, 0.0)],
            [p(0.5, -0.5, -1.0), o, x, p(2.0, 0.0, 0.0)],
            0.5,
        ),
        ("a triangle that is a point", vt, [p(0.0, 0.0, 1.0), o, o, o], [p(0.0, 0.0, -3.0), o, o, o], 0.25),
        (
            "an edge that is a point",
            ee,
            [up(o, 1.0), up(o, 1.0), p(-1.0, 0.0, 0.0), x],
            [up(o, -1.0), up(o, -1.0), p(-1.0, 0.0, 0.0), x],
            0.5,
        ),
        (
            "a triangle that collapses onto a vertex",
            vt,
            [p(0.25, 0.25, 0.125), o, x, y],
            [p(0.25, 0.25, 0.125), p(0.25, 0.25, 0.125), p(0.25, 0.25, 0.125), p(0.25, 0.25, 0.125)],
            1.0,
        ),
        (
            "a graze: touching at one moment only",
            ve,
            [p(-1.0, 0.0, 0.0), o, p(0.0, -1.0, 0.0), o],
            [p(1.0, 0.0, 0.0), o, p(0.0, -1.0, 0.0), o],
            0.5,
        ),
        ("two vertices that fly through each other", vv, [o, x, o, o], [x, o, o, o], 0.5),
        (
            "a slow meeting on a fast flight",
            vt,
            [p(0.2, 0.2, 1e-3), o, x, y],
            [p(1e4 + 0.2, 0.2, -1e-3), p(1e4, 0.0, 0.0), p(1e4 + 1.0, 0.0, 0.0), p(1e4, 1.0, 0.0)],
            0.5,
        ),
        (
            "far from the origin",
            vt,
            [p(1e6 + 0.25, 0.25, 0.5), p(1e6, 0.0, 0.0), p(1e6 + 1.0, 0.0, 0.0), p(1e6, 1.0, 0.0)],
            [p(1e6 + 0.25, 0.25, -0.5), p(1e6, 0.0, 0.0), p(1e6 + 1.0, 0.0, 0.0), p(1e6, 1.0, 0.0)],
            0.5,
        ),
        (
            "at the very end",
            ee,
            [p(-1.0, 0.0, 1.0), p(1.0, 0.0, 1.0), p(0.0, -1.0, 0.0), p(0.0, 1.0, 0.0)],
            [p(-1.0, 0.0, 0.0), p(1.0, 0.0, 0.0), p(0.0, -1.0, 0.0), p(0.0, 1.0, 0.0)],
            1.0,
        ),
    ]
}

#[test]
fn degenerate_meetings_are_not_missed() {
    for (name, kind, x, end, time) in degenerate_meetings() {
        let paths: [Vector; 4] = std::array::from_fn(|k| end[k] - x[k]);
        for speed in BOTH {
            for slackness in [0.1, 1e-3] {
                let found = ccd(speed, slackness).clearance(kind, &x, &paths, 0.0, 1.0);
                assert!(found.time < time, "{name}, {speed:?}: {found:?} is not before {time}");
                assert!(
                    found.time > (1.0 - 20.0 * slackness) * time,
                    "{name}, {speed:?}, {slackness}: {found:?} is long before {time}"
                );
            }
        }
    }
}

#[test]
fn what_stays_clear_goes_all_the_way() {
    let edges = [p(-1.0, 0.0, 0.1), p(1.0, 0.0, 0.1), p(0.0, -1.0, 0.0), p(0.0, 1.0, 0.0)];
    for speed in BOTH {
        let all_the_way = |paths: [Vector; 4]| {
            let found = ccd(speed, 0.1).clearance(PairKind::EdgeEdge, &edges, &paths, 0.0, 1.0);
            assert_eq!(found.time, 1.0, "{speed:?} {paths:?}");
            found.iterations
        };
        let rest = Vector::zeros();
        assert_eq!(all_the_way([rest; 4]), 1);
        // In common, however far.
        assert_eq!(all_the_way([v(1e5, -1e5, 3.0); 4]), 1);
        // Apart.
        let apart = all_the_way([v(0.0, 0.0, 1.0), v(0.0, 0.0, 1.0), rest, rest]);
        // Side by side, over each other.
        let aside = all_the_way([v(0.0, 3.0, 0.0), v(0.0, 3.0, 0.0), rest, rest]);
        match speed {
            ClosingSpeed::Slab => assert_eq!((apart, aside), (1, 1)),
            ClosingSpeed::Travel => assert!(apart > 1 && aside > 10, "{apart} {aside}"),
        }
        // Halfway down, and no further.
        all_the_way([v(0.0, 0.0, -0.05), v(0.0, 0.0, -0.05), rest, rest]);
    }
}

#[test]
fn pairs_that_touch_or_are_at_their_floor_may_only_open() {
    let x = [p(0.25, 0.25, 0.0), p(0.0, 0.0, 0.0), p(1.0, 0.0, 0.0), p(0.0, 1.0, 0.0)];
    let up = [v(0.0, 0.0, 1.0), Vector::zeros(), Vector::zeros(), Vector::zeros()];
    let kind = PairKind::VertexTriangle;
    for speed in BOTH {
        let ccd = ccd(speed, 0.1);
        assert_eq!(ccd.clearance(kind, &x, &up, 0.0, 1.0).time, 0.0, "touching");
        let mut above = x;
        above[0].z = 0.01;
        assert_eq!(ccd.clearance(kind, &above, &up, 0.01, 1.0).time, 1.0, "it opens");
        assert_eq!(ccd.clearance(kind, &above, &up.map(|u| -u), 0.01, 1.0).time, 0.0, "it closes");
        assert_eq!(ccd.clearance(kind, &above, &[v(5.0, 1.0, 2.0); 4], 0.01, 1.0).time, 1.0, "it flies");
    }
}

#[test]
fn what_comes_later_than_asked_for_is_not_looked_for() {
    let x = [p(0.25, 0.25, 1.0), p(0.0, 0.0, 0.0), p(1.0, 0.0, 0.0), p(0.0, 1.0, 0.0)];
    let down = [v(0.0, 0.0, -2.0), Vector::zeros(), Vector::zeros(), Vector::zeros()];
    let ccd = ccd(ClosingSpeed::Travel, 0.1);
    let kind = PairKind::VertexTriangle;
    assert!((ccd.clearance(kind, &x, &down, 0.0, 1.0).time - 0.45).abs() < 1e-12);
    assert_eq!(ccd.clearance(kind, &x, &down, 0.0, 0.44).time, 1.0);
    assert!(ccd.clearance(kind, &x, &down, 0.0, 0.46).time < 0.46);
    assert_eq!(ccd.clearance(kind, &x, &down, 0.0, ccd.clearance(kind, &x, &down, 0.0, 1.0).time).time, 1.0);
}

#[test]
fn the_iteration_limit_returns_what_is_safe_so_far() {
    let x = [p(-1.0, 0.0, 0.01), p(1.0, 0.0, 0.01), p(0.0, -1.0, 0.0), p(0.0, 1.0, 0.0)];
    let aside = [v(0.0, 1.0, 0.0), v(0.0, 1.0, 0.0), Vector::zeros(), Vector::zeros()];
    let ccd = AdditiveCcd { max_iterations: 5, ..ccd(ClosingSpeed::Travel, 0.1) };
    let found = ccd.clearance(PairKind::EdgeEdge, &x, &aside, 0.0, 1.0);
    assert!(found.time > 0.04 && found.time < 0.05, "{found:?}");
}

#[test]
fn half_spaces_are_met_when_the_path_does() {
    let ground = HalfSpace::new(p(0.0, 0.0, 1.0), v(0.0, 0.0, 2.0)).expect("a normal");
    let ccd = ccd(ClosingSpeed::Travel, 0.1);
    let time = |z: f64, path: Vector, floor: f64| {
        ccd.half_space_clearance(&ground, &p(3.0, 4.0, z), &path, floor).time
    };
    assert!((time(2.0, v(5.0, 0.0, -4.0), 0.0) - 0.9 * 0.25).abs() < 1e-12);
    assert!((time(2.0, v(5.0, 0.0, -4.0), 0.5) - 0.9 * 0.125).abs() < 1e-12);
    assert_eq!(time(2.0, v(5.0, 0.0, -0.5), 0.0), 1.0);
    assert_eq!(time(1.5, v(5.0, 0.0, 4.0), 0.5), 1.0);
    assert_eq!(time(1.5, v(5.0, 0.0, -4.0), 0.5), 0.0);
    assert_eq!(time(1.0, v(5.0, 0.0, 4.0), 0.0), 0.0);
}
