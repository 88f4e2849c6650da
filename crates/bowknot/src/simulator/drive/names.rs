//! What goes by which name, and lists of one entry per vertex.

use super::error::DriveError;
use crate::simulator::Simulator;
use bowknot_geometry::nalgebra::SVector;
use bowknot_scene::world::{World, WorldBody};

impl Simulator {
    /// The body or obstacle of a name.
    pub(super) fn index_of(&self, name: &str) -> Result<usize, DriveError> {
        self.world.index_of(name).ok_or_else(|| self.unknown("body or obstacle", name, |_| true))
    }

    /// The deformable body of a name.
    pub(super) fn deformable(&self, name: &str) -> Result<usize, DriveError> {
        let found = self.world.index_of(name).filter(|&body| self.world.bodies[body].kind.is_some());
        found.ok_or_else(|| self.unknown("body", name, |body| body.kind.is_some()))
    }

    /// The obstacle with a mesh of a name.
    pub(super) fn obstacle(&self, name: &str) -> Result<usize, DriveError> {
        let found = self.world.index_of(name).filter(|&body| self.world.bodies[body].kind.is_none());
        found.ok_or_else(|| self.unknown("obstacle with a mesh", name, |body| body.kind.is_none()))
    }

    /// The pin of a name.
    pub(super) fn pin(&self, name: &str) -> Result<usize, DriveError> {
        let pins = &self.world.pins;
        pins.iter().position(|pin| pin.name == name).ok_or_else(|| DriveError::Unknown {
            what: "pin",
            name: name.to_owned(),
            known: pins.iter().map(|pin| pin.name.clone()).collect(),
        })
    }

    fn unknown(&self, what: &'static str, name: &str, is_meant: impl Fn(&WorldBody) -> bool) -> DriveError {
        let meant = self.world.bodies.iter().filter(|body| is_meant(body));
        DriveError::Unknown { what, name: name.to_owned(), known: meant.map(|b| b.name.clone()).collect() }
    }
}

/// Checks a list of so many entries that are finite.
pub(super) fn check<'a>(
    what: &'static str,
    name: &str,
    expected: usize,
    entries: impl ExactSizeIterator<Item = &'a SVector<f64, 3>>,
) -> Result<(), DriveError> {
    let given = entries.len();
    if given != expected {
        return Err(DriveError::Length { what, name: name.to_owned(), given, expected });
    }
    match entries.enumerate().find(|(_, entry)| !entry.iter().all(|c| c.is_finite())) {
        Some((index, _)) => Err(DriveError::NonFinite { what, name: name.to_owned(), index }),
        None => Ok(()),
    }
}

/// The vertices of the world that a list in the order of a body's mesh is about, with their entries.
pub(super) fn in_mesh_order<'a, T>(
    world: &World,
    body: usize,
    entries: &'a [T],
) -> impl Iterator<Item = (usize, &'a T)> + use<'a, T> {
    let order = world.bodies[body].mesh_order();
    order.into_iter().zip(entries).filter_map(|(vertex, entry)| Some((vertex? as usize, entry)))
}
