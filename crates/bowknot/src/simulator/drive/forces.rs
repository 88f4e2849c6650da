//! What acts on bodies, obstacles and pins at the end of the last time step.

use super::error::DriveError;
use crate::simulator::Simulator;
use crate::simulator::report::{Contact, Wrench};
use bowknot_geometry::{Point, Vector};
use bowknot_twoway::ContactSide;

impl Simulator {
    /// The contacts that carried a force at the end of the last time step, those of bodies asleep included.
    /// Also after a checkpoint was restored.
    ///
    /// The list is made anew for each call. Where the dynamics knows no contacts (`solver.repulsion.stiffness = 0`,
    /// a quadratic law, or friction by the velocity filter) it holds those of grains with obstacles and with each
    /// other only.
    pub fn contacts(&self) -> Vec<Contact> {
        let carried = self.carried();
        carried
            .forces
            .iter()
            .filter_map(|force| Contact::new(&self.world.collision, &self.positions, force))
            .collect()
    }

    /// What all [contacts](Self::contacts) exert on each vertex that collides [N]: of a contact within an
    /// element by the weights of its closest point. Half-spaces have no vertices, so the forces on them are
    /// not among these.
    pub fn contact_forces(&self) -> Vec<Vector> {
        let mut forces = vec![Vector::zeros(); self.world.collision_vertices()];
        for contact in self.contacts() {
            for (vertex, weight) in contact.vertices.into_iter().zip(contact.weights) {
                // The weights of the second side are negative, as is the force on it.
                if weight != 0.0 {
                    forces[vertex as usize] += contact.force * weight;
                }
            }
        }
        forces
    }

    /// What all [contacts](Self::contacts) exert on a body, an obstacle or a half-space, with the torque
    /// about a point [m]: the load on a finger of a robot, in the axes of the scene. Each force acts at the
    /// contact's point on the body that is asked for; the points of both sides are a gap apart.
    ///
    /// # Errors
    /// No such body or obstacle.
    pub fn contact_wrench(&self, name: &str, about: &Point) -> Result<Wrench, DriveError> {
        let side = self.side(name)?;
        Ok(Wrench::of_contacts(&self.contacts(), about, |own, _| Some(own) == side))
    }

    /// What the [contacts](Self::contacts) with one other body, obstacle or half-space exert, otherwise as
    /// [`Self::contact_wrench`].
    ///
    /// # Errors
    /// No such body or obstacle.
    pub fn contact_wrench_by(&self, name: &str, other: &str, about: &Point) -> Result<Wrench, DriveError> {
        let sides = [self.side(name)?, self.side(other)?];
        Ok(Wrench::of_contacts(&self.contacts(), about, |own, by| [Some(own), Some(by)] == sides))
    }

    /// The side of contacts that a body, an obstacle or a half-space is.
    fn side(&self, name: &str) -> Result<Option<ContactSide>, DriveError> {
        self.require(name)?;
        let half_space = || self.world.half_space_names.iter().position(|other| other == name);
        Ok(match self.world.index_of(name) {
            Some(body) => Some(ContactSide::Body(body as u32)),
            None => half_space().map(|h| ContactSide::HalfSpace(h as u32)),
        })
    }

    /// The force that a pin exerted on each of its vertices in the last time step, in its order [N]; empty if
    /// it has held in none since it was added, bodies or elements have come or gone, or a checkpoint was
    /// restored, and while a backend computes the dynamics. Of a body asleep they are those with which it
    /// fell asleep.
    ///
    /// # Errors
    /// No such pin.
    pub fn pin_forces(&self, name: &str) -> Result<&[Vector], DriveError> {
        let index = self.pin(name)?;
        Ok(self.pin_forces.get(index).map_or(&[], Vec::as_slice))
    }

    /// What a pin exerted on its body in the last time step, with the torque about a point. What the body
    /// exerts on the hand that holds it is opposite. As [`Self::pin_forces`] otherwise.
    ///
    /// # Errors
    /// No such pin.
    pub fn pin_wrench(&self, name: &str, about: &Point) -> Result<Wrench, DriveError> {
        let vertices = &self.world.pins[self.pin(name)?].vertices;
        let places = vertices.iter().map(|&v| self.positions[v as usize]);
        Ok(Wrench::about(about, places.zip(self.pin_forces(name)?.iter().copied())))
    }

    /// Records what pins exert in a time step that ends at `time` [s]. Bodies asleep are not looked at.
    pub(crate) fn record_pin_forces(&mut self, time: f64) {
        let Self { world, sleeping, dynamics, pin_forces, dt, .. } = self;
        let awake = sleeping.as_ref().and_then(|sleeping| sleeping.awake_dynamics());
        let dynamics = awake.unwrap_or(dynamics);
        pin_forces.resize(world.pins.len(), Vec::new());
        for (pin, forces) in world.pins.iter().zip(pin_forces) {
            if !pin.holds(time, *dt) {
                forces.clear();
                continue;
            }
            let known: Option<Vec<Vector>> =
                pin.vertices.iter().map(|&v| dynamics.holding_force(v)).collect();
            match known {
                Some(known) => *forces = known,
                // A device does not tell them, and those of an earlier time step are no longer right.
                None if dynamics.backend().is_some() => forces.clear(),
                None => {}
            }
        }
    }
}
