//! Obstacles that jump: what they meet in a time step is far from where it was.

use super::{ObstacleMotion, Presence, Sequence, World, WorldBody, bounds};
use bowknot_geometry::Point;

/// Way in a time step, in mean edge lengths of the deformable bodies, from which on an obstacle is said to
/// jump.
const JUMP: f64 = 10.0;

/// Time steps that are looked at, at most.
const LOOKED_AT: usize = 10_000;

/// The largest way of an obstacle in a time step.
#[derive(Clone, Copy, Debug, Default)]
struct Step {
    /// [m]
    way: f64,
    /// When it begins [s].
    time: f64,
}

/// Warnings of obstacles that jump within so many time steps of `dt` [s].
pub(super) fn warnings(world: &World, dt: f64, steps: usize) -> Vec<String> {
    let Some(edge) = mean_edge(world) else { return Vec::new() };
    let obstacles = world.bodies.iter().filter(|body| body.kind.is_none());
    let warning = |body: &WorldBody| {
        let base = &world.base[body.vertices.start as usize..body.vertices.end as usize];
        let Step { way, time } = match &body.motion {
            ObstacleMotion::Sequence(sequence) => of_sequence(sequence, &body.presence, dt),
            ObstacleMotion::Rigid(_) => of_motion(body, base, dt, steps),
            // Shapes that move by themselves do not jump, and what a program will do is not known.
            ObstacleMotion::Rest | ObstacleMotion::Procedural(_) | ObstacleMotion::Placed(_) => return None,
        };
        (way > JUMP * edge).then(|| {
            format!(
                "obstacle {} moves by up to {way:.3} m in a time step, {:.0} edge lengths, the farthest at \
                 {time:.3} s: bodies that it meets on such a way are torn along or wait; use a smaller dt or \
                 a slower motion",
                body.name,
                way / edge
            )
        })
    };
    obstacles.filter_map(warning).collect()
}

/// Mean edge length of the deformable bodies [m]; none if they have no edges.
fn mean_edge(world: &World) -> Option<f64> {
    let edges = world.collision.topology().edges.iter();
    let of_bodies = edges.filter(|edge| (edge[0] as usize) < world.deformable_vertices);
    let length = |[a, b]: &[u32; 2]| (world.base[*a as usize] - world.base[*b as usize]).norm();
    let (sum, count) = of_bodies.map(length).fold((0.0, 0), |(sum, count), length| (sum + length, count + 1));
    (count > 0).then(|| sum / f64::from(count))
}

/// Of frames, of which a time step may show several, while the obstacle is there.
fn of_sequence(sequence: &Sequence, presence: &Presence, dt: f64) -> Step {
    let Sequence { frames, rate, start } = sequence;
    let way = |pair: &[Vec<Point>]| {
        let ways = pair[0].iter().zip(&pair[1]).map(|(a, b)| (b - a).norm());
        ways.fold(0.0, f64::max) * (rate * dt)
    };
    let ways = frames.windows(2).enumerate().map(|(frame, pair)| (frame, way(pair)));
    let ways = ways.filter(|(frame, _)| presence.holds(start + *frame as f64 / rate, dt));
    let (frame, way) = ways.fold((0, 0.0), |most, next| if next.1 > most.1 { next } else { most });
    Step { way, time: start + frame as f64 / rate }
}

/// Of a rigid motion, while the obstacle is there: the corners of the box around a body move farther than
/// what is in it.
fn of_motion(body: &WorldBody, base: &[Point], dt: f64, steps: usize) -> Step {
    let (low, high) = bounds(base);
    let corner = |k: usize| Point::from([0, 1, 2].map(|c| if k >> c & 1 == 0 { low[c] } else { high[c] }));
    let corners: Vec<Point> = (0..8).map(corner).collect();
    let at = |step: usize| {
        let mut places = corners.clone();
        body.motion.positions(&corners, dt * step as f64, &mut places);
        places
    };
    let mut most = Step::default();
    let mut before = at(0);
    for step in 1..=steps.min(LOOKED_AT) {
        let now = at(step);
        let way = before.iter().zip(&now).map(|(a, b)| (b - a).norm()).fold(0.0, f64::max);
        if way > most.way && body.presence.holds(dt * (step - 1) as f64, dt) {
            most = Step { way, time: dt * (step - 1) as f64 };
        }
        before = now;
    }
    most
}
