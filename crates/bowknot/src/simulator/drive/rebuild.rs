//! A simulator of a changed scene, and how it takes the place of the one before.

use super::elements::renumbered_elements;
use super::error::DriveError;
use super::renumber::renumbered;
use crate::simulator::Simulator;
use crate::simulator::error::SimulationError;
use bowknot_dynamics::StepError;
use bowknot_scene::world::World;
use bowknot_scene::{BodySpec, Material, ObstacleSpec, Scene, SceneError};
use std::sync::Arc;

impl Simulator {
    /// The scene as it is now: that which the simulation began with, or, after bodies, materials or frictions
    /// have changed, the changed one.
    pub fn scene(&self) -> &Scene {
        self.driven.scene.as_deref().unwrap_or(&self.home.scene)
    }

    /// Goes on with a changed scene, or stays as it is. What is `added` must not intersect.
    pub(super) fn change_scene(
        &mut self,
        added: Option<&str>,
        change: impl FnOnce(&mut Scene),
    ) -> Result<(), SimulationError> {
        let mut scene = self.scene().clone();
        // The pins of the world count.
        scene.pins.clear();
        let lengths = self.resolver.scene().lengths();
        scene.contact.delta.get_or_insert(lengths.delta);
        scene.contact.min_separation.get_or_insert(lengths.min_separation);
        scene.contact.separation_speed.get_or_insert(lengths.separation_speed);
        change(&mut scene);
        let mut next = self.rebuilt(Some(Box::new(scene)))?;
        next.restore(&renumbered(self, &next))?;
        if let Some(name) = added {
            next.refuse_intersections(name)?;
        }
        self.give_way_to(next)
    }

    /// A simulator at the start of a scene, None for that which this one began with. Bodies that both scenes
    /// have keep their rest shapes, and the custom elements on them.
    pub(crate) fn rebuilt(&self, scene: Option<Box<Scene>>) -> Result<Self, SimulationError> {
        let world = match &scene {
            None => Arc::clone(&self.home.world),
            Some(scene) => Arc::new(world_of(scene, self.scene(), &self.world)?),
        };
        let groups = renumbered_elements(&self.world, &world, self.dynamics.model().element_groups())?;
        let mut next = Self::at_start(world, self.home.clone(), scene, groups)?;
        next.measured = self.measured;
        next.apply_filters()?;
        Ok(next)
    }

    /// Lets another simulator take the place of this one, with the backends that this one has.
    pub(crate) fn give_way_to(&mut self, mut next: Self) -> Result<(), SimulationError> {
        let has_backend = self.dynamics_backend().is_some();
        if let Some(group) = next.dynamics.model().element_groups().first().filter(|_| has_backend) {
            let source = StepError::CustomElements { group: group.name.clone() };
            return Err(SimulationError::target(self.step, source));
        }
        let bodies = next.dynamics.model().bodies();
        if let Some(source) = bodies.iter().find_map(StepError::only_on_cpu).filter(|_| has_backend) {
            return Err(SimulationError::target(self.step, source));
        }
        let home =
            |simulator: &Self| simulator.world.positions[..simulator.world.collision_vertices()].to_vec();
        if let Err(source) = self.backend.prepare(next.resolver.scene(), &home(&next)) {
            let before = home(self);
            // It was prepared for this scene before.
            let _ = self.backend.prepare(self.resolver.scene(), &before);
            return Err(SimulationError::backend(&self.world, self.step, source));
        }
        std::mem::swap(&mut self.backend, &mut next.backend);
        next.search_order.tell_again();
        next.set_dynamics_backend(self.active_dynamics().take_backend())?;
        *self = next;
        Ok(())
    }

    /// Refuses a state in which something `placed` intersects, or anything else. Warns of what is enclosed.
    pub(super) fn refuse_intersections(&self, placed: &str) -> Result<(), SimulationError> {
        match self.intersections()? {
            None => {
                self.warn_of_enclosed();
                Ok(())
            }
            Some((lines, count)) => {
                Err(DriveError::Intersects { what: placed.to_owned(), lines, count }.into())
            }
        }
    }
}

/// The world of a changed scene. Bodies that are as in the scene `before` but for their materials keep the
/// rest shapes that they have in its world: files may have changed, and a program may have made that world.
fn world_of(scene: &Scene, before: &Scene, world_before: &World) -> Result<World, SceneError> {
    let mut world = World::new(scene)?;
    for now in world.bodies.iter().filter(|now| is_same(&now.name, [scene, before])) {
        let Some(then) = world_before.bodies.iter().find(|then| then.name == now.name) else { continue };
        if now.rods.len() != then.rods.len() {
            return Err(SceneError::Model(format!(
                "body {}: twist_stiffness cannot become 0, or cease to be 0, while a simulation runs",
                now.name
            )));
        }
        if (now.vertices.len(), now.interior.len()) != (then.vertices.len(), then.interior.len()) {
            return Err(SceneError::Model(format!("the mesh of {} has changed since the start", now.name)));
        }
        for (v, w) in now.all_vertices().zip(then.all_vertices()).map(|(v, w)| (v as usize, w as usize)) {
            world.positions[v] = world_before.positions[w];
            if let (Some(base), Some(before)) = (world.base.get_mut(v), world_before.base.get(w)) {
                *base = *before;
            }
        }
    }
    Ok(world)
}

/// Whether what has a name is the same in both scenes, but for its material and friction.
fn is_same(name: &str, scenes: [&Scene; 2]) -> bool {
    let bodies = scenes.map(|scene| {
        let body = scene.bodies.iter().find(|body| body.name == name).cloned();
        body.map(|body| BodySpec { material: Material::default(), friction: 0.0, ..body })
    });
    let obstacles = scenes.map(|scene| {
        let obstacle = scene.obstacles.iter().find(|obstacle| obstacle.name == name).cloned();
        obstacle.map(|obstacle| ObstacleSpec { friction: 0.0, ..obstacle })
    });
    bodies[0] == bodies[1] && obstacles[0] == obstacles[1]
}
