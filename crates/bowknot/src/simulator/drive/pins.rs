//! Pins: added, removed, led.

use super::error::DriveError;
use super::names::check;
use crate::simulator::Simulator;
use bowknot_geometry::nalgebra::Isometry3;
use bowknot_geometry::{Point, carried_frame_point};
use bowknot_scene::world::{Pin, World};
use std::sync::Arc;

impl Simulator {
    /// Adds a pin of a `name` that holds `vertices` of a `body` where they are, until it is led or removed.
    /// The vertices are numbered as in the body's mesh, from 0; targets have their order.
    ///
    /// # Errors
    /// A name that a pin has already, no such body, vertices that the body does not have or that a pin holds,
    /// none at all.
    pub fn add_pin(&mut self, name: &str, body: &str, vertices: &[u32]) -> Result<(), DriveError> {
        let index = self.deformable(body)?;
        if self.world.pins.iter().any(|pin| pin.name == name) {
            return Err(DriveError::Taken { what: "pin", name: name.to_owned() });
        }
        let of_body = self.world.bodies[index].mesh_order();
        let pin = || name.to_owned();
        let mut held = Vec::with_capacity(vertices.len());
        for &vertex in vertices {
            let found = of_body.get(vertex as usize).copied().flatten();
            let found = found.ok_or_else(|| {
                let (body, count) = (body.to_owned(), of_body.len());
                DriveError::NoVertex { pin: pin(), body, vertex, count }
            })?;
            let holds = |other: &&Pin| other.end > self.time() && other.vertices.contains(&found);
            let other = self.world.pins.iter().find(holds).map(|other| other.name.clone());
            if let Some(other) = other.or_else(|| held.contains(&found).then(pin)) {
                return Err(DriveError::Held { pin: pin(), body: body.to_owned(), vertex, other });
            }
            held.push(found);
        }
        if held.is_empty() {
            return Err(DriveError::Empty { pin: pin() });
        }
        held.extend(self.world.bodies[index].frame_points_between(held.clone()));
        let places: Vec<Point> = held.iter().map(|&v| self.positions[v as usize]).collect();
        let (start, end) = (self.time(), f64::INFINITY);
        let pin = Pin { name: pin(), vertices: held, motion: None, follow: None, start, end };
        self.change_pins(|world| world.pins.push(pin));
        self.driven.grips.insert(name.to_owned(), places.clone());
        self.anchors.push(places);
        self.attachments.push(Vec::new());
        self.pin_forces.resize(self.anchors.len(), Vec::new());
        self.push(&[index]);
        Ok(())
    }

    /// Removes a pin: its vertices are free from the next time step on, with the velocities that they have.
    ///
    /// # Errors
    /// No such pin.
    pub fn remove_pin(&mut self, name: &str) -> Result<(), DriveError> {
        let index = self.pin(name)?;
        let bodies = self.bodies_of(index);
        self.change_pins(|world| drop(world.pins.remove(index)));
        self.driven.grips.remove(name);
        self.anchors.remove(index);
        self.attachments.remove(index);
        self.pin_forces.resize(self.anchors.len() + 1, Vec::new());
        self.pin_forces.remove(index);
        self.push(&bodies);
        Ok(())
    }

    /// Leads the vertices of a pin to `targets` at the end of the next time step, and holds them there [m];
    /// one target per vertex of the pin, in its order. It replaces the motion that the scene has for it, and
    /// what it follows. The vertices go as one: each makes the same fraction of its way. The frame points of rods, which are
    /// its last vertices, may be left out: they then follow their edges without a turn.
    ///
    /// # Errors
    /// No such pin, another number of targets, one that is not finite.
    pub fn set_pin_targets(&mut self, name: &str, targets: &[Point]) -> Result<(), DriveError> {
        let index = self.pin(name)?;
        let targets = self.with_frame_points(index, targets);
        let pin = &self.world.pins[index];
        check("targets", name, pin.vertices.len(), targets.iter().map(|x| &x.coords))?;
        if !self.driven.grips.contains_key(name) {
            self.driven.grips.insert(name.to_owned(), self.places_of(index));
        }
        if pin.motion.is_some() || pin.follow.is_some() {
            self.change_pins(|world| (world.pins[index].motion, world.pins[index].follow) = (None, None));
        }
        self.anchors[index] = targets;
        Ok(())
    }

    /// Leads the vertices of a pin as a rigid body, such as a hand: to where the `pose` takes the places that
    /// they had when the pin was added, or, for a pin of the scene, when code first led it.
    ///
    /// # Errors
    /// As [`Self::set_pin_targets`].
    pub fn set_pin_pose(&mut self, name: &str, pose: &Isometry3<f64>) -> Result<(), DriveError> {
        let index = self.pin(name)?;
        let grip = self.driven.grips.get(name).cloned().unwrap_or_else(|| self.places_of(index));
        let targets: Vec<Point> = grip.iter().map(|x| pose * x).collect();
        self.set_pin_targets(name, &targets)
    }

    /// The `targets` of a pin [m], with those of the frame points that it holds if they alone are left out.
    fn with_frame_points(&self, pin: usize, targets: &[Point]) -> Vec<Point> {
        let vertices = &self.world.pins[pin].vertices;
        let mut all = targets.to_vec();
        let (own, left_out) = vertices.split_at(targets.len().min(vertices.len()));
        // Frame points are the last vertices of a pin, in the order of their edges.
        let rods = self.world.bodies.iter().flat_map(|body| &body.rods);
        let rods: Vec<&[u32; 3]> = rods.filter(|rod| left_out.binary_search(&rod[2]).is_ok()).collect();
        if rods.len() < left_out.len() {
            return all;
        }
        let target = |v: u32| own.iter().position(|&other| other == v).map(|k| &targets[k]);
        for &[a, b, p] in rods {
            let [from_a, from_b, from_p] = [a, b, p].map(|v| &self.positions[v as usize]);
            // A pin that holds a frame point holds both ends of its edge.
            let to = [target(a).unwrap_or(from_a), target(b).unwrap_or(from_b)];
            all.push(carried_frame_point([from_a, from_b], to, from_p));
        }
        all
    }

    /// Where the vertices of a pin are [m].
    fn places_of(&self, pin: usize) -> Vec<Point> {
        self.world.pins[pin].vertices.iter().map(|&v| self.positions[v as usize]).collect()
    }

    /// Changes the pins of the world, of which this simulator then has its own.
    fn change_pins(&mut self, change: impl FnOnce(&mut World)) {
        change(Arc::make_mut(&mut self.world));
        self.driven.pins = Some(self.world.pins.clone());
    }

    /// The bodies of the vertices that a pin holds.
    fn bodies_of(&self, pin: usize) -> Vec<usize> {
        let vertices = &self.world.pins[pin].vertices;
        let has = |body: &usize| {
            let body = &self.world.bodies[*body];
            vertices.iter().any(|v| body.vertices.contains(v) || body.interior.contains(v))
        };
        (0..self.world.bodies.len()).filter(has).collect()
    }
}
