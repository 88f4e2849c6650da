//! Which vertices are prescribed in a time step, where to, and which of them lag behind.

use super::simulator::{Scratch, Simulator};
use bowknot_geometry::Point;
use bowknot_scene::world::World;
use bowknot_twoway::ResolveInput;
use std::collections::BTreeMap;

/// Share of its way that an obstacle or pin must make to be led on in a time step, where a collision problem has not
/// converged. Larger: more is held back that would get through. Smaller: targets are computed more often with pins and
/// obstacles where they cannot go.
const LED_ON: f64 = 0.5;

/// What is held back leaves this share of the contact distance of its way. Larger: it waits farther from what stops it.
/// Smaller: what touches it has less room to move.
const ROOM: f64 = 0.5;

/// Share of the contact distance up to which it counts as having arrived.
const ARRIVED: f64 = 0.01;

/// Distances below this are rounding [m].
const NO_DISTANCE: f64 = 1e-9;

impl Simulator {
    /// Fills in which vertices are prescribed at `time`, the end of the time step, and their keyframes. The
    /// vertices of a pin form a group: they move by one fraction of their way.
    pub(super) fn prescribe(&mut self, time: f64, scratch: &mut Scratch) {
        let Self { world, anchors, attachments, positions, dt, .. } = self;
        let Scratch { prescribed, keyframes, groups, .. } = scratch;
        let count = world.collision_vertices();
        prescribed.clear();
        prescribed.resize(positions.len(), false);
        groups.clear();
        groups.resize(count, ResolveInput::NO_GROUP);
        keyframes.clone_from(positions);
        for body in world.bodies.iter().filter(|body| body.kind.is_none()) {
            let range = body.vertices.start as usize..body.vertices.end as usize;
            prescribed[range.clone()].fill(true);
            body.motion.positions(&world.base[range.clone()], time, &mut keyframes[range]);
        }
        for (index, ((pin, anchor), attachments)) in
            world.pins.iter().zip(anchors).zip(attachments).enumerate()
        {
            if !pin.holds(time, *dt) {
                continue;
            }
            if anchor.is_empty() && pin.start > 0.0 {
                let place = pin.motion.as_ref().map(|motion| motion.at(pin.start));
                let undo = |v: &u32| {
                    let x = &positions[*v as usize];
                    place.map_or(*x, |place| place.undo(x))
                };
                *anchor = pin.vertices.iter().map(undo).collect();
            }
            if pin.follow.is_some() && attachments.is_empty() {
                let home = |v: &u32| world.positions[*v as usize];
                let homes: Vec<Point> = pin.vertices.iter().map(home).collect();
                *attachments = world.attach(pin, if anchor.is_empty() { &homes } else { anchor });
            }
            let place = pin.motion.as_ref().map(|motion| motion.at(time));
            for (k, &v) in pin.vertices.iter().enumerate() {
                let v = v as usize;
                let home = anchor.get(k).unwrap_or(&world.positions[v]);
                prescribed[v] = true;
                let followed = attachments.get(k).and_then(|a| a.as_ref()?.place(keyframes));
                let led = || place.map_or(*home, |place| place.apply(home));
                keyframes[v] = followed.unwrap_or_else(led);
                if v < count {
                    groups[v] = index as u32;
                }
            }
        }
    }

    /// The obstacles and pins that are behind their keyframes at the end of the time step, and how far [m].
    pub(super) fn waiting(&self, time: f64, scratch: &Scratch) -> BTreeMap<String, f64> {
        let behind = |vertices: &mut dyn Iterator<Item = u32>| {
            vertices
                .map(|v| (scratch.keyframes[v as usize] - self.positions[v as usize]).norm())
                .fold(0.0, f64::max)
        };
        let obstacles = self.world.bodies.iter().filter(|body| body.kind.is_none() && !body.motion.is_rest());
        let obstacles = obstacles.map(|body| (&body.name, behind(&mut body.vertices.clone())));
        let pins = self.world.pins.iter().filter(|pin| pin.holds(time, self.dt));
        let pins = pins.map(|pin| (&pin.name, behind(&mut pin.vertices.iter().copied())));
        let rounding = NO_DISTANCE.max(self.backend.resolution());
        let waiting = obstacles.chain(pins).filter(|(_, behind)| *behind > rounding);
        waiting.map(|(name, behind)| (name.clone(), behind)).collect()
    }
}

/// Where prescribed vertices shall end in a time step: at their keyframes, or, if something stops an obstacle or a pin,
/// before that. Otherwise the dynamics would compute with it where it cannot go, and the collision stage without.
///
/// All places are on the straight ways from the start to the keyframes.
#[derive(Debug, Default)]
pub(super) struct Ends {
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

    /// Notes where obstacles and pins are before a collision problem, in which `x` moves.
    pub fn note(&mut self, world: &World, prescribed: &[bool], x: &[Point]) {
        let Self { places, ways } = self;
        ways.clear();
        ways.extend(led(world).map(|vertices| farthest(vertices, prescribed, x, places)));
    }

    /// After a collision problem: what it has not moved to its end stops where it is, less some room of its way since the
    /// `start` of the time step. At the minimum separation nothing that touches it could move toward it. `delta`: the
    /// contact distance [m].
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

/// Largest distance of a prescribed vertex that collides from its place at `a`, which has these alone, to that at `b` [m].
fn farthest(vertices: impl Iterator<Item = u32>, prescribed: &[bool], a: &[Point], b: &[Point]) -> f64 {
    let prescribed = vertices.map(|v| v as usize).filter(|&v| v < a.len() && prescribed[v]);
    prescribed.map(|v| (b[v] - a[v]).norm()).fold(0.0, f64::max)
}

/// Largest distance of a prescribed vertex from its keyframe [m]; distances up to `resolution` are rounding.
pub(super) fn largest_lag(x: &[Point], keyframes: &[Point], prescribed: &[bool], resolution: f64) -> f64 {
    let lag = |v: usize| (keyframes[v] - x[v]).norm();
    let largest = (0..x.len()).filter(|&v| prescribed[v]).map(lag).fold(0.0, f64::max);
    if largest > resolution { largest } else { 0.0 }
}
