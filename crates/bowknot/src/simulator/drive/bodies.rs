//! Bodies and obstacles added and removed, their materials and friction.

use super::error::DriveError;
use crate::simulator::Simulator;
use crate::simulator::error::SimulationError;
use bowknot_scene::world::Pin;
use bowknot_scene::{BodySpec, Material, ObstacleSpec};

impl Simulator {
    /// Adds a deformable body, where its `spec` puts it and with the velocity that it states. It is there
    /// from the next time step on.
    ///
    /// This sets the simulation up anew, which takes as long as [`Simulator::new`], and wakes all bodies. The
    /// other bodies keep their state; they go on to the same solution, but not to the same bits, as the
    /// systems of equations and the tolerance of the time step are other ones. Lengths that the scene leaves
    /// to its meshes (`contact.delta` and others) stay as they are.
    ///
    /// # Errors
    /// A name that is taken, a spec or a mesh that is refused, [`DriveError::Intersects`] with the pairs. The
    /// simulator is then as it was. A body inside of a closed obstacle, which it can never leave, causes a
    /// warning.
    pub fn add_body(&mut self, spec: BodySpec) -> Result<(), SimulationError> {
        let name = self.new_name(&spec.name)?;
        self.change_scene(Some(&name), |scene| scene.bodies.push(spec))
    }

    /// Adds an obstacle or a half-space, where its `spec` puts it, or where its motion has it at this time.
    /// It is there from the next time step on, or when it `appears`. See [`Self::add_body`] for what this
    /// costs.
    ///
    /// # Errors
    /// As [`Self::add_body`].
    pub fn add_obstacle(&mut self, spec: ObstacleSpec) -> Result<(), SimulationError> {
        let name = self.new_name(&spec.name)?;
        self.change_scene(Some(&name), |scene| scene.obstacles.push(spec))
    }

    /// Removes a body, an obstacle or a half-space, with the pins of a body. See [`Self::add_body`] for what
    /// this costs.
    ///
    /// # Errors
    /// No such body or obstacle, pins that follow the obstacle, the last body of the scene.
    pub fn remove(&mut self, name: &str) -> Result<(), SimulationError> {
        self.require(name)?;
        let follows = |pin: &&Pin| pin.follow.is_some_and(|body| self.world.name_of(body) == name);
        if let Some(pin) = self.world.pins.iter().find(follows) {
            return Err(DriveError::Followed { obstacle: name.to_owned(), pin: pin.name.clone() }.into());
        }
        self.change_scene(None, |scene| {
            scene.bodies.retain(|body| body.name != name);
            scene.obstacles.retain(|obstacle| obstacle.name != name);
            scene.friction_pairs.retain(|pair| pair.bodies.iter().all(|other| other != name));
        })
    }

    /// Gives a body another material of its kind: stiffness, density, damping and the rest. Its rest shape
    /// stays. See [`Self::add_body`] for what this costs.
    ///
    /// # Errors
    /// No such body, a material of another kind, numbers out of their range.
    pub fn set_material(&mut self, body: &str, material: Material) -> Result<(), SimulationError> {
        self.deformable(body)?;
        self.change_scene(None, |scene| {
            let spec = scene.bodies.iter_mut().find(|spec| spec.name == body);
            spec.into_iter().for_each(|spec| spec.material = material);
        })
    }

    /// Sets the coefficient of Coulomb friction of a body, an obstacle or a half-space [1]; two in contact
    /// have the geometric mean of both. See [`Self::add_body`] for what this costs.
    ///
    /// # Errors
    /// No such body or obstacle, a coefficient below 0 or not finite.
    pub fn set_friction(&mut self, name: &str, friction: f64) -> Result<(), SimulationError> {
        self.require(name)?;
        self.change_scene(None, |scene| {
            let of_bodies = scene.bodies.iter_mut().map(|spec| (&spec.name, &mut spec.friction));
            let of_obstacles = scene.obstacles.iter_mut().map(|spec| (&spec.name, &mut spec.friction));
            let named = of_bodies.chain(of_obstacles).filter(|(other, _)| *other == name);
            named.for_each(|(_, own)| *own = friction);
        })
    }

    /// Mass of a body [kg]; obstacles and half-spaces have none, which is 0.
    ///
    /// # Errors
    /// No such body or obstacle.
    pub fn mass_of(&self, name: &str) -> Result<f64, DriveError> {
        self.require(name)?;
        let body = self.world.index_of(name).map(|index| &self.world.bodies[index]);
        let masses = self.dynamics_model().masses();
        let body = body.filter(|body| body.kind.is_some());
        Ok(body.map_or(0.0, |body| body.all_vertices().map(|v| masses[v as usize]).sum()))
    }

    /// A name that nothing has yet.
    fn new_name(&self, name: &str) -> Result<String, DriveError> {
        if self.world.names().any(|other| other == name) {
            return Err(DriveError::Taken { what: "body or obstacle", name: name.to_owned() });
        }
        Ok(name.to_owned())
    }

    /// A name that something has, half-spaces included.
    pub(super) fn require(&self, name: &str) -> Result<(), DriveError> {
        let known: Vec<String> = self.world.names().cloned().collect();
        if known.iter().any(|other| other == name) {
            return Ok(());
        }
        Err(DriveError::Unknown { what: "body or obstacle", name: name.to_owned(), known })
    }
}
