//! Obstacles that appear and vanish, between two time steps.
//!
//! **No path crosses.** Which obstacles are there changes only between time steps, so all iterations of a
//! time step are computed with one collision model. One that is not there meets nothing, and what moves
//! through its place crosses nothing. It comes back only if its place is clear (`clearance.rs`), so that the
//! time step starts from a state without intersections, from which on the collision stage holds it as any
//! other.

use super::clearance::in_the_way;
use crate::simulator::Simulator;
use crate::simulator::contact_forces::vertices_of;
use crate::simulator::error::SimulationError;
use crate::simulator::report::StepStatistics;
use crate::simulator::sleep::Motion;
use bowknot_constraints::Feature;
use bowknot_geometry::CollisionModel;
use bowknot_scene::world::World;

impl Simulator {
    /// Which bodies of the world, then which half-spaces, are there during the next time step. Deformable
    /// ones always are.
    pub fn present(&self) -> &[bool] {
        &self.present
    }

    /// The collision model of the world, with those absent that are not there.
    pub fn collision_model(&self) -> CollisionModel {
        self.world.collision_of(&self.present)
    }

    /// Puts the obstacles that are not there where they belong at `time`, so that they do not move within the
    /// time step.
    pub(crate) fn place_absent(&mut self, time: f64) {
        let Self { world, present, positions, .. } = self;
        for (body, _) in world.bodies.iter().zip(present).filter(|(_, present)| !**present) {
            let range = body.vertices.start as usize..body.vertices.end as usize;
            body.motion.positions(&world.base[range.clone()], time, &mut positions[range]);
        }
    }

    /// Lets obstacles vanish and appear at the end of a time step. Those that would meet something wait. What
    /// was near one that vanishes wakes, and so does what is near one that appears.
    pub(crate) fn update_presence(&mut self, statistics: &mut StepStatistics) -> Result<(), SimulationError> {
        let Self { world, present, resolver, positions, dt, .. } = self;
        let wanted = world.present(statistics.time, *dt);
        let mut changed = vec![false; present.len()];
        for (index, name) in world.names().enumerate() {
            let mut wait = None;
            if wanted[index] && !present[index] {
                let x = &positions[..world.collision_vertices()];
                wait = in_the_way(world, resolver.scene(), x, index)?;
            }
            changed[index] = wanted[index] != present[index] && wait.is_none();
            if present[index] == changed[index] {
                statistics.absent.insert(name.clone(), wait);
            }
        }
        // All at once: an error above changes nothing.
        present.iter_mut().zip(&changed).for_each(|(present, changed)| *present ^= changed);
        if changed.contains(&true) { self.follow_presence(&changed) } else { Ok(()) }
    }

    /// Follows a change of which obstacles are there: wakes bodies, forgets the contacts of those that are
    /// gone, and finds contacts anew.
    fn follow_presence(&mut self, changed: &[bool]) -> Result<(), SimulationError> {
        let mut carried = self.carried();
        let is_there = |feature: &Feature| is_there(&self.world, &self.present, feature);
        carried.forces.retain(|force| force.features.iter().all(is_there));
        carried.means.retain(|mean| mean.features.iter().all(is_there));
        let Self { world, sleeping, positions, .. } = self;
        if let Some(sleeping) = sleeping {
            let (bodies, half_spaces) = changed.split_at(world.bodies.len());
            let motion = Motion {
                start: &positions[..world.collision_vertices()],
                inner: &[],
                end: &positions[..world.collision_vertices()],
                margins: &sleeping.margins,
                asleep: &sleeping.asleep,
                at_rest: &vec![true; bodies.len()],
                changed: bodies,
            };
            let mut wakes = sleeping.elements.approached(world, &motion);
            // A half-space may hold any body.
            wakes.iter_mut().for_each(|wakes| *wakes |= half_spaces.contains(&true));
            sleeping.sleep.wake(&wakes);
        }
        self.take_out(carried)
    }

    /// Gives the collision stage the filters that are in force: of obstacles that are there, and of bodies
    /// asleep, which are obstacles.
    pub(crate) fn apply_filters(&mut self) -> Result<(), SimulationError> {
        let Self { world, present, resolver, sleeping, step, .. } = self;
        let (mut filters, half_spaces) = world.filters(present);
        let asleep = sleeping.as_ref().map_or_else(Vec::new, |sleeping| sleeping.sleep.asleep());
        filters.iter_mut().zip(asleep).for_each(|(filter, asleep)| filter.obstacle |= asleep);
        let model = resolver.scene().model();
        if model.bodies() == filters && model.half_spaces() == half_spaces {
            return Ok(());
        }
        resolver
            .set_filters(&filters, &half_spaces)
            .map_err(|source| SimulationError::resolve(world, *step, source))
    }
}

/// Whether the body or half-space of a feature is there. The features of a checkpoint may be anything.
fn is_there(world: &World, present: &[bool], feature: &Feature) -> bool {
    let index = match feature {
        Feature::HalfSpace(half_space) => Some(world.bodies.len() + *half_space as usize),
        _ => vertices_of(world.collision.topology(), feature)
            .first()
            .and_then(|&v| world.collision.vertex_body().get(v as usize))
            .map(|&body| body as usize),
    };
    index.and_then(|index| present.get(index)).copied().unwrap_or(true)
}
