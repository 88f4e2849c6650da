//! Where obstacles go.

use super::driven::ObstacleDrive;
use super::error::DriveError;
use super::names::{check, in_mesh_order};
use crate::simulator::Simulator;
use bowknot_errors::Parameters;
use bowknot_geometry::Point;
use bowknot_geometry::nalgebra::Isometry3;
use bowknot_scene::Motion;
use std::sync::Arc;

impl Simulator {
    /// Leads an obstacle as a rigid body, such as a finger of a robot: to where the `pose` takes it from its
    /// place in the scene, at the end of the next time step. It stays there until it is led elsewhere. This
    /// replaces the motion that the scene has for it. Rotations of the pose are about the origin of the scene.
    /// Where the obstacle has got is in [`Self::positions`]: it waits where something that deforms is in its way.
    /// **Obstacles go through each other**, such as a finger through a table.
    ///
    /// All of its vertices move on straight lines, so a turn of more than some tens of degrees in a time step
    /// shrinks it on the way.
    ///
    /// # Errors
    /// No such obstacle, or a half-space, which does not move; a pose that is not finite.
    pub fn set_obstacle_pose(&mut self, name: &str, pose: &Isometry3<f64>) -> Result<(), DriveError> {
        let body = &self.world.bodies[self.obstacle(name)?];
        let base = &self.world.base[body.vertices.start as usize..body.vertices.end as usize];
        let places = base.iter().map(|x| pose * x).collect();
        self.drive_obstacle(name, ObstacleDrive::Places(places))
    }

    /// Leads the vertices of an obstacle to `targets` at the end of the next time step [m]: one per vertex of
    /// its mesh, in that order. They stay there until they are led elsewhere. This replaces the motion that
    /// the scene has for the obstacle.
    ///
    /// # Errors
    /// No such obstacle, or a half-space; another number of targets, one that is not finite.
    pub fn set_obstacle_targets(&mut self, name: &str, targets: &[Point]) -> Result<(), DriveError> {
        let index = self.obstacle(name)?;
        let body = &self.world.bodies[index];
        let count = body.mesh_order().len();
        check("targets", name, count, targets.iter().map(|x| &x.coords))?;
        let start = body.vertices.start as usize;
        let mut places = vec![Point::origin(); body.vertices.len()];
        in_mesh_order(&self.world, index, targets).for_each(|(v, x)| places[v - start] = *x);
        self.drive_obstacle(name, ObstacleDrive::Places(places))
    }

    /// Gives an obstacle a motion by keyframes and spin, over the time of the simulation, from the next time
    /// step on. It displaces the obstacle from its place in the scene. This replaces the motion that it had.
    ///
    /// # Errors
    /// No such obstacle, or a half-space; keyframes that do not ascend, or numbers that are not finite.
    pub fn set_obstacle_motion(&mut self, name: &str, motion: Motion) -> Result<(), DriveError> {
        self.obstacle(name)?;
        self.drive_obstacle(name, ObstacleDrive::Motion(motion))
    }

    fn drive_obstacle(&mut self, name: &str, drive: ObstacleDrive) -> Result<(), DriveError> {
        let index = self.check_drive(name, &drive)?;
        Arc::make_mut(&mut self.world).bodies[index].motion = drive.motion();
        self.driven.obstacles.insert(name.to_owned(), drive);
        Ok(())
    }

    /// Checks how code leads an obstacle; the obstacle's index.
    pub(super) fn check_drive(&self, name: &str, drive: &ObstacleDrive) -> Result<usize, DriveError> {
        let index = self.obstacle(name)?;
        let count = self.world.bodies[index].vertices.len();
        match drive {
            ObstacleDrive::Places(places) => {
                check("targets", name, count, places.iter().map(|x| &x.coords))?;
            }
            ObstacleDrive::Motion(motion) => {
                motion.validate().map_err(|source| DriveError::Motion { name: name.to_owned(), source })?
            }
        }
        Ok(index)
    }
}
