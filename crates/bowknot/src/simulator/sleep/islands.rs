//! When bodies at rest fall asleep, and when those that they touch wake them.
//!
//! Engines of rigid bodies (Box2D, Bullet, PhysX, Jolt) put *islands* to sleep: bodies connected by contacts
//! that have all been slow for about half a second. They differ in what slow means. A limit on speeds, as in
//! Box2D and Bullet, mistakes the tremble of a pile for motion and a slow slide for rest. Here, as in Jolt
//! (`Body::UpdateSleepStateInternal`), a body is at rest while its points stay near the places where they
//! were when its time began; the time begins anew when one leaves. All vertices of a body are tested, since
//! it can bend about any three points.
//!
//! Unlike there, an island must be held by something at rest: an obstacle, a half-space or a pin. What floats
//! without gravity may drift as slowly as it likes, and the momentum of free bodies is not changed.

use crate::simulator::contact_forces::ContactForce;
use bowknot_dynamics::Touching;
use bowknot_geometry::{Point, UnionFind};
use bowknot_scene::SleepParams;
use bowknot_scene::world::World;
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// Which bodies sleep, and how long the others have been at rest. Part of the state between two time steps.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SleepState {
    /// Places that vertices at rest stay near, one entry per vertex [m].
    pub origins: Vec<Point>,
    /// Time steps that each body has stayed there; obstacles count too, to no effect.
    pub calm_steps: Vec<u32>,
    /// The smallest body of the island that each body sleeps in, or [`Self::AWAKE`].
    pub islands: Vec<u32>,
}

impl SleepState {
    /// The entry of [`Self::islands`] for bodies that do not sleep.
    pub const AWAKE: u32 = u32::MAX;
}

/// The rule by which bodies fall asleep, and its state.
#[derive(Clone, Debug)]
pub(crate) struct Sleep {
    /// Largest distance of a vertex at rest from its origin [m].
    distance: f64,
    /// Time steps at rest after which a body may sleep.
    steps: u32,
    /// Pairs of bodies that custom elements join.
    pub joined: Vec<[u32; 2]>,
    pub state: SleepState,
}

/// What holds or moves the bodies in a time step, one entry per body of the world.
#[derive(Clone, Debug, Default)]
pub(crate) struct Hold {
    /// Whether it has prescribed vertices.
    pub held: Vec<bool>,
    /// Whether prescribed vertices of it move.
    pub moved: Vec<bool>,
}

impl Sleep {
    /// The rule for time steps of `dt` [s] and contacts at a distance of `delta` [m]; all bodies are awake.
    pub fn new(params: &SleepParams, world: &World, delta: f64, dt: f64, joined: Vec<[u32; 2]>) -> Self {
        let bodies = world.bodies.len();
        Self {
            distance: params.distance * delta,
            steps: (params.time / dt).ceil().clamp(1.0, f64::from(u32::MAX)) as u32,
            joined,
            state: SleepState {
                origins: world.positions.clone(),
                calm_steps: vec![0; bodies],
                islands: vec![SleepState::AWAKE; bodies],
            },
        }
    }

    /// Whether each body sleeps.
    pub fn asleep(&self) -> Vec<bool> {
        self.state.islands.iter().map(|&island| island != SleepState::AWAKE).collect()
    }

    /// Wakes bodies with their islands. Returns whether any was asleep.
    pub fn wake(&mut self, bodies: &[bool]) -> bool {
        let SleepState { islands, calm_steps, .. } = &mut self.state;
        let mut woken = vec![false; islands.len()];
        for (&island, _) in
            islands.iter().zip(bodies).filter(|(island, wakes)| **wakes && is_asleep(**island))
        {
            woken[island as usize] = true;
        }
        for (island, calm) in islands.iter_mut().zip(calm_steps) {
            if is_asleep(*island) && woken[*island as usize] {
                (*island, *calm) = (SleepState::AWAKE, 0);
            }
        }
        woken.contains(&true)
    }

    /// Begins the time of bodies that are awake anew: forces on them have changed.
    pub fn stir(&mut self) {
        self.state.calm_steps.fill(0);
    }

    /// Records where the bodies are at the end of a time step, and which have touched in it. Bodies at rest
    /// fall asleep, as islands; those that others have touched wake. Returns whether any did.
    pub fn update(&mut self, world: &World, positions: &[Point], touching: &Touching, hold: &Hold) -> bool {
        self.count_calm_steps(world, positions);
        let islands = self.islands(world, touching, hold);
        let changed = islands != self.state.islands;
        for ((before, after), calm) in self.state.islands.iter().zip(&islands).zip(&mut self.state.calm_steps)
        {
            if is_asleep(*before) && !is_asleep(*after) {
                *calm = 0;
            }
        }
        self.state.islands = islands;
        changed
    }

    /// Counts the time steps that bodies have been at rest.
    fn count_calm_steps(&mut self, world: &World, positions: &[Point]) {
        let SleepState { origins, calm_steps, islands } = &mut self.state;
        for (index, body) in world.bodies.iter().enumerate() {
            if body.kind.is_none() || is_asleep(islands[index]) {
                continue;
            }
            let ranges = [&body.vertices, &body.interior].map(as_usize);
            // A place that is not a number is not near.
            let near = |v: usize| (positions[v] - origins[v]).norm() <= self.distance;
            if ranges.iter().all(|range| range.clone().all(near)) {
                calm_steps[index] = calm_steps[index].saturating_add(1);
            } else {
                calm_steps[index] = 0;
                for range in ranges {
                    origins[range.clone()].copy_from_slice(&positions[range]);
                }
            }
        }
    }

    /// The islands that sleep after a time step.
    fn islands(&self, world: &World, touching: &Touching, hold: &Hold) -> Vec<u32> {
        let SleepState { calm_steps, islands, .. } = &self.state;
        let count = world.bodies.len();
        let mut sets = UnionFind::new(count);
        let mut restless = hold.moved.clone();
        let mut held = hold.held.clone();
        let is_obstacle = |body: usize| world.bodies[body].kind.is_none();
        for (body, &island) in islands.iter().enumerate() {
            if is_asleep(island) {
                sets.join(body as u32, island);
                held[body] = true;
            } else if calm_steps[body] < self.steps {
                restless[body] |= !is_obstacle(body);
            }
        }
        self.joined.iter().for_each(|&[a, b]| sets.join(a, b));
        let body_of = |vertex: u32| world.collision.vertex_body()[vertex as usize] as usize;
        for pair in &touching.pairs {
            let [a, b] = pair.map(body_of);
            match (is_obstacle(a), is_obstacle(b)) {
                (false, false) => sets.join(a as u32, b as u32),
                (false, true) | (true, false) => {
                    let (body, obstacle) = if is_obstacle(a) { (b, a) } else { (a, b) };
                    restless[body] |= hold.moved[obstacle];
                    held[body] |= !hold.moved[obstacle];
                }
                (true, true) => {}
            }
        }
        // Contacts with moving obstacles have made their bodies restless.
        touching.held.iter().for_each(|contact| held[body_of(contact.vertex)] = true);
        let (mut any_restless, mut any_held) = (vec![false; count], vec![false; count]);
        for body in 0..count {
            let root = sets.find(body as u32) as usize;
            any_restless[root] |= restless[body];
            any_held[root] |= held[body];
        }
        let island = |body: usize| {
            let root = sets.root(body as u32) as usize;
            let sleeps = !is_obstacle(body) && any_held[root] && !any_restless[root];
            if sleeps { root as u32 } else { SleepState::AWAKE }
        };
        (0..count).map(island).collect()
    }
}

/// Parts of the contact forces.
pub(crate) struct Parted {
    /// Those with a side that is awake.
    pub awake: Vec<ContactForce>,
    /// Those between bodies asleep and obstacles.
    pub asleep: Vec<ContactForce>,
}

/// Divides contact forces by whether one of their sides is a deformable body that is awake.
pub(crate) fn part(world: &World, asleep: &[bool], forces: &[ContactForce]) -> Parted {
    let topology = world.collision.topology();
    let is_awake = |feature: &bowknot_constraints::Feature| {
        use bowknot_constraints::Feature;
        // Features of a checkpoint may be anything.
        let vertex = match *feature {
            Feature::Vertex(v) => Some(v),
            Feature::Edge(e) => topology.edges.get(e as usize).map(|edge| edge[0]),
            Feature::Triangle(t) => topology.triangles.get(t as usize).map(|triangle| triangle[0]),
            Feature::HalfSpace(_) => None,
        };
        let body = vertex.and_then(|v| world.collision.vertex_body().get(v as usize));
        body.is_some_and(|&b| world.bodies[b as usize].kind.is_some() && !asleep[b as usize])
    };
    let (awake, asleep) = forces.iter().partition(|force| force.features.iter().any(is_awake));
    Parted { awake, asleep }
}

fn is_asleep(island: u32) -> bool {
    island != SleepState::AWAKE
}

fn as_usize(range: &Range<u32>) -> Range<usize> {
    range.start as usize..range.end as usize
}
