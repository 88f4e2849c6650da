//! What a program had changed, taken over from a checkpoint.

use super::driven::Driven;
use super::error::DriveError;
use super::names::check;
use crate::simulator::Simulator;
use bowknot_errors::Parameters;
use bowknot_geometry::Vector;
use bowknot_scene::world::Pin;
use std::sync::Arc;

impl Simulator {
    /// Whether changes name what there is, and have as many entries as that has vertices. They may be those
    /// of a damaged file.
    pub(crate) fn check_driven(&self, driven: &Driven) -> Result<(), DriveError> {
        for pin in driven.pins.iter().flatten() {
            self.check_pin(pin)?;
            if let Some(grip) = driven.grips.get(&pin.name) {
                check("grip", &pin.name, pin.vertices.len(), grip.iter().map(|x| &x.coords))?;
            }
        }
        for (name, drive) in &driven.obstacles {
            self.check_drive(name, drive)?;
        }
        let scene = "the scene";
        let of_scene: Vec<&Vector> = driven.gravity.iter().chain(&driven.wind).collect();
        check("gravity and wind", scene, of_scene.len(), of_scene.into_iter())?;
        if !driven.external_forces.is_empty() {
            check("forces", scene, self.positions.len(), driven.external_forces.iter())?;
        }
        if ![0, self.world.bodies.len()].contains(&driven.pushed.len()) {
            let message = "bodies that wake are not those of the scene".to_owned();
            return Err(DriveError::Scene { message });
        }
        Ok(())
    }

    fn check_pin(&self, pin: &Pin) -> Result<(), DriveError> {
        let fault = |message: &str| DriveError::Scene { message: format!("{}: {message}", pin.name) };
        let world = &self.world;
        let is_deformable = |v: &u32| {
            (*v as usize) < world.deformable_vertices
                || (world.collision_vertices()..world.positions.len()).contains(&(*v as usize))
        };
        if !pin.vertices.iter().all(is_deformable) {
            return Err(fault("its vertices are not those of the scene"));
        }
        let follows = |body: u32| world.bodies.get(body as usize).is_some_and(|body| body.kind.is_none());
        if !pin.follow.is_none_or(follows) {
            return Err(fault("it follows no obstacle"));
        }
        match pin.motion.as_ref().map(Parameters::validate) {
            Some(Err(source)) => Err(DriveError::Motion { name: pin.name.clone(), source }),
            _ => Ok(()),
        }
    }

    /// Takes over changes that fit, without those of the surroundings.
    pub(crate) fn adopt_driven(&mut self, driven: &Driven) {
        let scene = self.driven.scene.take();
        self.driven = Driven { scene, ..driven.clone() };
        self.world = Arc::clone(&self.undriven);
        if let Some(pins) = &driven.pins {
            Arc::make_mut(&mut self.world).pins.clone_from(pins);
        }
        for (name, drive) in &driven.obstacles {
            if let Some(index) = self.world.index_of(name) {
                Arc::make_mut(&mut self.world).bodies[index].motion = drive.motion();
            }
        }
        self.attachments = vec![Vec::new(); self.world.pins.len()];
        self.pin_forces.clear();
    }
}
