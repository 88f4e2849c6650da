//! Measured quality against known answers.

use super::augmented::project;
use super::statement::Statement;
use super::*;
use crate::case::CollisionCase;
use bowknot::geometry::{HalfSpace, Point, Vector};
use bowknot::lcp::{self, Row};
use bowknot::recording::States;

/// Particles above the ground, 2 mm across: their distances are 2 mm from each other and 1 mm from the
/// ground.
fn particles(x: Vec<Point>, y: Vec<Point>, masses: Vec<f64>) -> CollisionCase {
    let count = x.len();
    let states = States {
        particles: (0..count as u32).collect(),
        rest: x.clone(),
        fixed: vec![false; count],
        obstacle: vec![false; count],
        body: vec![0; count],
        half_spaces: vec![HalfSpace { normal: Vector::z(), offset: 0.0 }],
        body_contacts: vec![bowknot::twoway::BodyContact { delta: Some(2e-3), ..Default::default() }],
        x,
        y,
        masses,
        ..States::default()
    };
    CollisionCase::new("particles", states).expect("a sound case")
}

fn quality(case: &CollisionCase, x: &[Point]) -> Quality {
    CaseEvaluator::of_candidate(case).expect("a sound case").evaluate(x).expect("a result that fits")
}

/// A particle pressed on the ground and slid along it: the solution is right above its target at distance
/// delta.
#[test]
fn a_particle_on_the_ground() {
    let target = Point::new(0.01, 0.0, -0.02);
    let case = particles(vec![Point::new(0.0, 0.0, 0.0015)], vec![target], vec![2.0]);
    let at = |x: f64, z: f64| quality(&case, &[Point::new(x, 0.0, z)]);

    let solved = at(0.01, 1e-3);
    assert!(solved.stationarity < 1e-9 && solved.violation < 1e-12, "{solved:?}");
    assert!((solved.objective - 0.5 * 2.0 * 0.021f64.powi(2)).abs() < 1e-15);
    assert!((solved.distance - 0.021).abs() < 1e-15);
    assert_eq!((solved.intersections, solved.min_gap), (0, Some(1e-3)));
    // Short of it along the ground: the rest of the way is the residual.
    let short = at(0.004, 1e-3);
    assert!((short.stationarity - 0.006).abs() < 1e-9 && short.violation < 1e-12, "{short:?}");
    // Too near, and below the ground.
    let near = at(0.01, 4e-4);
    assert!((near.violation - 6e-4).abs() < 1e-12 && near.stationarity < 1e-9, "{near:?}");
    assert_eq!(at(0.01, -1e-4).intersections, 1);
    // Far above the ground no row is active, and the residual is the whole way.
    let free = at(0.01, 0.5);
    assert!((free.stationarity - 0.52).abs() < 1e-12 && free.min_gap.is_none(), "{free:?}");
}

/// Two particles pressed against each other end with the center of mass of their targets.
#[test]
fn two_particles_of_different_mass() {
    let start = vec![Point::new(-0.01, 0.0, 1.0), Point::new(0.01, 0.0, 1.0)];
    let target = vec![Point::new(0.008, 0.0, 1.0), Point::new(-0.004, 0.0, 1.0)];
    let case = particles(start, target, vec![1.0, 3.0]);
    // Center (0.008 - 3 * 0.004)/4 = -0.001, distance 2 mm shared 3 to 1.
    let solution = [Point::new(-0.001 - 1.5e-3, 0.0, 1.0), Point::new(-0.001 + 0.5e-3, 0.0, 1.0)];
    let solved = quality(&case, &solution);
    assert!(solved.stationarity < 1e-9 && solved.violation < 1e-12, "{solved:?}");
    // Moved together by 1 mm: the residual is 1 mm.
    let moved = solution.map(|p| p + Vector::new(0.001, 0.0, 0.0));
    assert!((quality(&case, &moved).stationarity - 0.001).abs() < 1e-9);
}

#[test]
fn the_reference_solution_is_the_analytic_one() {
    let start = vec![Point::new(-0.01, 0.0, 0.002), Point::new(0.01, 0.0, 0.002)];
    let target = vec![Point::new(0.008, 0.0, -0.01), Point::new(-0.004, 0.0, -0.01)];
    let case = particles(start, target, vec![1.0, 3.0]);
    let solution = [Point::new(-0.0025, 0.0, 1e-3), Point::new(-0.0005, 0.0, 1e-3)];
    for shares in [&[1.0][..], &[0.3, 0.6, 1.0]] {
        let statement = Statement::new(&case).expect("a sound case");
        let found = project(&statement, shares, 60.0).expect("solved");
        for (x, exact) in found.x.iter().zip(&solution) {
            assert!((x - exact).norm() < 4e-6, "{x} is not {exact}");
        }
    }
}

/// A strand of two edges of 1 cm that may become 10 % longer. Its first vertex is held, its target is 2 m ahead: it
/// ends straight, each edge at its limit. The last vertex is five times as heavy as the middle one.
#[test]
fn a_strand_is_pulled_straight() {
    let at = |x: f64, z: f64| Point::new(x, 0.0, z);
    let x = vec![at(0.0, 0.5), at(0.006, 0.508), at(0.012, 0.5)];
    let states = States {
        strands: vec![[0, 1], [1, 2]],
        rest: x.clone(),
        fixed: vec![true, false, false],
        obstacle: vec![false; 3],
        body: vec![0; 3],
        body_contacts: vec![bowknot::twoway::BodyContact { stretch_limit: Some(1.1), ..Default::default() }],
        y: vec![x[0], at(2.0, 0.5), at(2.0, 0.5)],
        x,
        masses: vec![1.0, 1.0, 5.0],
        ..States::default()
    };
    let case = CollisionCase::new("strand", states).expect("a sound case");
    let statement = Statement::new(&case).expect("a sound case");
    let found = project(&statement, &[1.0], 60.0).expect("solved");
    for (x, exact) in found.x.iter().zip([at(0.0, 0.5), at(0.011, 0.5), at(0.022, 0.5)]) {
        assert!((x - exact).norm() < 2e-5, "{x} is not {exact}");
    }
    let solved = quality(&case, &found.x);
    assert!(solved.stationarity < 1e-4 && solved.stretch_violation < 1e-3, "{solved:?}");
}

/// Random redundant rows: the residual is that of the dense active-set method.
#[test]
fn multipliers_equal_those_of_the_reference() {
    let mut state = 88172645463325252u64;
    let mut random = || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1u64 << 53) as f64 - 0.5
    };
    for _ in 0..20 {
        let nodes = 8;
        let weights: Vec<f64> = (0..nodes).map(|v| if v == 0 { 0.0 } else { 1.0 + random() }).collect();
        let mut vector = || Vector::new(random(), random(), random());
        let wanted: Vec<Vector> =
            weights.iter().map(|w| if *w > 0.0 { vector() } else { Vector::zeros() }).collect();
        let mut rows: Vec<Row> = (0..30u32)
            .map(|r| {
                let g = [vector(), vector(), vector(), Vector::zeros()];
                Row::new([r % 8, (r * 3 + 1) % 8, (r * 5 + 2) % 8, r % 8], g, 0.0)
            })
            .collect();
        rows.push(rows[0]);
        let own = |&Row { vertices, gradients, .. }: &Row| nonnegative::Row { vertices, gradients };
        let ours =
            nonnegative::residual(&rows.iter().map(own).collect::<Vec<_>>(), &weights, wanted.clone(), 1500);

        lcp::prepare_rows(&mut rows, &weights).expect("weights of all nodes");
        let problem = lcp::LcpProblem::of_rows(&weights, &rows).expect("a sound problem");
        let mut y = wanted;
        let mut lambda = vec![0.0; rows.len()];
        let mut moving =
            lcp::LcpState { y: &mut y, lambda: &mut lambda, limit_multipliers: &mut [], friction: &mut [] };
        lcp::solve_exact(&problem, &mut moving).expect("solved");
        let error = ours.iter().zip(&y).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
        assert!(error < 1e-5, "off by {error}");
    }
}

/// A free sheet whose target is twice as large.
#[test]
fn stretch_is_measured_against_its_limit() {
    let square = |s: f64| {
        vec![
            Point::new(0.0, 0.0, 1.0),
            Point::new(s, 0.0, 1.0),
            Point::new(s, s, 1.0),
            Point::new(0.0, s, 1.0),
        ]
    };
    let states = States {
        x: square(0.1),
        rest: square(0.1),
        y: square(0.2),
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        masses: vec![1.0; 4],
        fixed: vec![false; 4],
        obstacle: vec![false; 4],
        body: vec![0; 4],
        ..States::default()
    };
    let case = CollisionCase::new("sheet", states).expect("a sound case");
    let centered = |s: f64| -> Vec<Point> {
        square(s).iter().map(|p| p + Vector::new(0.1 - s / 2.0, 0.1 - s / 2.0, 0.0)).collect()
    };
    let at_limit = quality(&case, &centered(0.11));
    assert!(at_limit.stretch_violation.abs() < 1e-9 && at_limit.stationarity < 1e-6, "{at_limit:?}");
    let beyond = quality(&case, &centered(0.121));
    assert!((beyond.stretch_violation - 0.1).abs() < 1e-9, "{beyond:?}");
    let before = quality(&case, &centered(0.1));
    assert!(before.stationarity > 0.01, "no edge is at its limit");
}
