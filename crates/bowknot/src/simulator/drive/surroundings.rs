//! Gravity, wind, and forces on vertices.

use super::error::DriveError;
use super::names::check;
use crate::simulator::Simulator;
use crate::simulator::sleep::SleepingBodies;
use bowknot_dynamics::{Dynamics, Errors, ParamError, StepError};
use bowknot_geometry::Vector;

impl Simulator {
    /// Sets the gravity [m/s^2], [`bowknot_dynamics::Environment::gravity`] at first, from the next time step
    /// on. Bodies with a gravity of their own keep it. Wakes all bodies.
    ///
    /// # Errors
    /// A component that is not finite.
    pub fn set_gravity(&mut self, gravity: Vector) -> Result<(), DriveError> {
        check("gravity", "the scene", 1, [&gravity].into_iter())?;
        let before = self.dynamics.params().environment.gravity;
        self.driven.gravity = Some(gravity);
        self.for_each_dynamics(|dynamics| dynamics.set_gravity(gravity))
            .map_err(|error| DriveError::Scene { message: error.to_string() })?;
        if before != gravity {
            self.push_all();
        }
        Ok(())
    }

    /// Sets the wind [m/s], [`bowknot_dynamics::Environment::wind`] at first, from the next time step on. It
    /// has an effect where `air_density` is above 0, and then wakes all bodies.
    ///
    /// # Errors
    /// A component is not finite.
    pub fn set_wind(&mut self, wind: Vector) -> Result<(), Errors<ParamError>> {
        let environment = self.dynamics.params().environment;
        self.for_each_dynamics(|dynamics| dynamics.set_wind(wind))?;
        self.driven.wind = Some(wind);
        if environment.wind != wind && environment.air_density > 0.0 {
            self.push_all();
        }
        Ok(())
    }

    /// Sets the force on each vertex of the world [N], 0 at first, from the next time step on. It is kept
    /// until it is set again, and wakes the bodies on which it changes.
    ///
    /// # Errors
    /// Another number of forces than of vertices, or one that is not finite.
    pub fn set_external_forces(&mut self, forces: &[Vector]) -> Result<(), StepError> {
        self.for_each_dynamics(|dynamics| dynamics.set_external_forces(forces))?;
        let before = |v: usize| self.driven.external_forces.get(v).copied().unwrap_or_else(Vector::zeros);
        let changes = |body: &usize| {
            let mut vertices = self.world.bodies[*body].all_vertices().map(|v| v as usize);
            vertices.any(|v| forces[v] != before(v))
        };
        let changed: Vec<usize> = (0..self.world.bodies.len()).filter(changes).collect();
        self.driven.external_forces = forces.to_vec();
        self.push(&changed);
        Ok(())
    }

    /// Gives the dynamics what is set of the surroundings.
    pub(crate) fn apply_surroundings(&mut self) -> Result<(), String> {
        let home = self.scene().environment;
        let (gravity, wind) = (self.driven.gravity, self.driven.wind);
        let mut forces = std::mem::take(&mut self.driven.external_forces);
        let none = forces.is_empty();
        forces.resize(self.positions.len(), Vector::zeros());
        let set = |dynamics: &mut Dynamics| -> Result<(), String> {
            let words = |error: Errors<ParamError>| error.to_string();
            dynamics.set_gravity(gravity.unwrap_or(home.gravity)).map_err(words)?;
            dynamics.set_wind(wind.unwrap_or(home.wind)).map_err(words)?;
            dynamics.set_external_forces(&forces).map_err(|error| error.to_string())
        };
        let result = self.for_each_dynamics(set);
        self.driven.external_forces = if none { Vec::new() } else { forces };
        result
    }

    /// Changes the dynamics of all bodies, and that of the bodies that are awake if some sleep.
    fn for_each_dynamics<E>(&mut self, change: impl Fn(&mut Dynamics) -> Result<(), E>) -> Result<(), E> {
        change(&mut self.dynamics)?;
        self.sleeping.as_mut().and_then(SleepingBodies::dynamics).map_or(Ok(()), change)
    }

    /// Wakes bodies before the next time step.
    pub(super) fn push(&mut self, bodies: &[usize]) {
        if !bodies.is_empty() {
            self.driven.pushed.resize(self.world.bodies.len(), false);
            bodies.iter().for_each(|&body| self.driven.pushed[body] = true);
        }
    }

    pub(super) fn push_all(&mut self) {
        self.driven.pushed = vec![true; self.world.bodies.len()];
    }
}
