//! Where obstacles and pins end in a time step: at their keyframes, or, if something stops one, before that.
//! Otherwise the dynamics would compute with it where it cannot go, and the collision stage without, in each
//! iteration.

use bowknot_geometry::Point;
use bowknot_scene::world::World;

/// Share of its way that an obstacle or pin must make to be led on in a time step, where a collision problem
/// has not converged. Larger: more is held back that would get through. Smaller: targets are computed more
/// often with pins and obstacles where they cannot go.
const LED_ON: f64 = 0.5;

/// What is held back leaves this share of the contact distance of its way. Larger: it waits farther from what
/// stops it. Smaller: what touches it has less room to move.
const ROOM: f64 = 0.5;

/// Share of the contact distance up to which it counts as having arrived.
const ARRIVED: f64 = 0.01;

/// The ends of prescribed vertices, on the straight ways from the start of the time step to their keyframes.
#[derive(Debug, Default)]
pub(crate) struct Ends {
    /// One entry per vertex [m]; only those of prescribed ones count.
    pub places: Vec<Point>,
    /// How far each obstacle and pin had to go before the last collision problem [m].
    ways: Vec<f64>,
}

impl Ends {
    /// Begins a time step.
    pub fn begin(&mut self, keyframes: &[Point]) {
        self.places.clear();
        self.places.extend_from_slice(keyframes);
    }

    /// Records how far obstacles and pins have to go before a collision problem, in which `x` moves.
    pub fn record_ways(&mut self, world: &World, prescribed: &[bool], x: &[Point]) {
        let Self { places, ways } = self;
        ways.clear();
        ways.extend(led(world).map(|vertices| farthest(vertices, prescribed, x, places)));
    }

    /// Whether all obstacles and pins are at their ends in `x`.
    pub fn are_reached(&self, world: &World, prescribed: &[bool], x: &[Point], delta: f64) -> bool {
        led(world).all(|vertices| farthest(vertices, prescribed, x, &self.places) <= ARRIVED * delta)
    }

    /// After a collision problem: what it has not moved to its end stops where it is, less some room of its
    /// way since the `start` of the time step. At the minimum separation nothing that touches it could move
    /// toward it. `delta`: the contact distance [m].
    pub fn hold_back(
        &mut self,
        world: &World,
        prescribed: &[bool],
        [start, x]: [&[Point]; 2],
        delta: f64,
        converged: bool,
    ) {
        let Self { places, ways } = self;
        for (vertices, &way) in led(world).zip(ways.iter()) {
            let left = farthest(vertices.clone(), prescribed, x, places);
            if left > ARRIVED * delta && (converged || left > LED_ON * way) {
                // All vertices of an obstacle or pin make one fraction of their way.
                let whole = farthest(vertices.clone(), prescribed, &start[..x.len()], places);
                let made = farthest(vertices.clone(), prescribed, &start[..x.len()], x);
                let fraction = ((made - ROOM * delta) / whole).clamp(0.0, 1.0);
                for v in vertices.map(|v| v as usize).filter(|&v| prescribed[v]) {
                    places[v] = start[v] + (places[v] - start[v]) * fraction;
                }
            }
        }
    }
}

/// The vertices of each obstacle that moves and of each pin.
fn led(world: &World) -> impl Iterator<Item = impl Iterator<Item = u32> + Clone + '_> {
    let obstacles = world.bodies.iter().filter(|body| body.kind.is_none() && !body.motion.is_rest());
    let obstacles = obstacles.map(|body| (body.vertices.clone(), &[][..]));
    let pins = world.pins.iter().map(|pin| (0..0, &pin.vertices[..]));
    obstacles.chain(pins).map(|(range, list)| range.chain(list.iter().copied()))
}

/// Largest distance of a prescribed vertex that collides from its place at `a`, which has these alone, to
/// that at `b` [m].
fn farthest(vertices: impl Iterator<Item = u32>, prescribed: &[bool], a: &[Point], b: &[Point]) -> f64 {
    let prescribed = vertices.map(|v| v as usize).filter(|&v| v < a.len() && prescribed[v]);
    prescribed.map(|v| (b[v] - a[v]).norm()).fold(0.0, f64::max)
}
