//! Velocities, and positions at once.

use super::driven::ObstacleDrive;
use super::error::DriveError;
use super::names::{check, in_mesh_order};
use crate::simulator::Simulator;
use crate::simulator::contact_forces::{CarriedContacts, vertices_of};
use crate::simulator::error::SimulationError;
use crate::simulator::interior::carry_frame_points;
use bowknot_constraints::Feature;
use bowknot_geometry::{Point, Vector};
use std::sync::Arc;

impl Simulator {
    /// Sets the velocities of a deformable body [m/s]: one per vertex of its mesh, in that order. Those of
    /// pinned vertices have no effect but on the drag of air. Wakes the body.
    ///
    /// # Errors
    /// No such body, another number of velocities, one that is not finite.
    pub fn set_velocities(&mut self, body: &str, velocities: &[Vector]) -> Result<(), DriveError> {
        let index = self.deformable(body)?;
        let count = self.world.bodies[index].mesh_order().len();
        check("velocities", body, count, velocities.iter())?;
        in_mesh_order(&self.world, index, velocities).for_each(|(v, given)| self.velocities[v] = *given);
        for [a, b, p] in self.world.bodies[index].rods.iter().map(|rod| rod.map(|v| v as usize)) {
            self.velocities[p] = (self.velocities[a] + self.velocities[b]) * 0.5;
        }
        self.push(&[index]);
        Ok(())
    }

    /// Puts a body or an obstacle somewhere else at once [m]: one position per vertex of its mesh, in that
    /// order. The exact judge looks at the new state, and nothing changes if it intersects; what is between
    /// the places is not looked at. To move something *through* a scene, lead a pin or an obstacle.
    ///
    /// Velocities stay, pins keep their targets, an obstacle stays at its new place. Contacts of what is
    /// placed are forgotten, and all bodies wake.
    ///
    /// # Errors
    /// No such body, or a half-space; another number of positions, one that is not finite or too large for
    /// the minimum separation; [`DriveError::Intersects`] with the pairs.
    pub fn place(&mut self, name: &str, positions: &[Point]) -> Result<(), SimulationError> {
        let index = self.index_of(name)?;
        let count = self.world.bodies[index].mesh_order().len();
        check("positions", name, count, positions.iter().map(|x| &x.coords))?;
        let before = self.positions.clone();
        in_mesh_order(&self.world, index, positions).for_each(|(v, x)| self.positions[v] = *x);
        carry_frame_points(&self.world.bodies[index].rods, |_| false, &before, &mut self.positions);
        let carried = self.carried();
        let kept = self.without_contacts_of(index, &carried);
        let placed = self.refuse_intersections(name).and_then(|()| self.take_out(kept));
        if let Err(error) = placed {
            self.positions = before;
            // The state before was a sound one.
            let _ = self.take_out(carried);
            return Err(error);
        }
        let body = &self.world.bodies[index];
        if body.kind.is_none() {
            let range = body.vertices.start as usize..body.vertices.end as usize;
            let drive = ObstacleDrive::Places(self.positions[range].to_vec());
            Arc::make_mut(&mut self.world).bodies[index].motion = drive.motion();
            self.driven.obstacles.insert(name.to_owned(), drive);
        }
        self.push_all();
        Ok(())
    }

    /// What contacts remember but for those of a body.
    fn without_contacts_of(&self, body: usize, carried: &CarriedContacts) -> CarriedContacts {
        let (topology, of_vertices) = (self.world.collision.topology(), self.world.collision.vertex_body());
        let is_other = |feature: &Feature| {
            vertices_of(topology, feature).first().is_none_or(|&v| of_vertices[v as usize] as usize != body)
        };
        let mut kept = carried.clone();
        kept.forces.retain(|force| force.features.iter().all(is_other));
        kept.means.retain(|mean| mean.features.iter().all(is_other));
        kept
    }
}
