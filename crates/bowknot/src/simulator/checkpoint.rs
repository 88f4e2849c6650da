//! All that a simulation must remember between two time steps.

use super::contact_forces::CarriedContacts;
use super::drive::Driven;
use super::sleep::SleepState;
use bowknot_geometry::{Point, Vector};
use serde::{Deserialize, Serialize};

/// The state between two time steps, in full: a simulation restored from it goes on to the same bits.
/// Multipliers of the collision stage and search radii are set up anew in each time step, so they are no part
/// of it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Checkpoint {
    /// Time steps made.
    pub step: usize,
    /// Positions of all vertices [m].
    pub positions: Vec<Point>,
    /// Velocities of all vertices [m/s].
    pub velocities: Vec<Vector>,
    /// For each pin that code leads, or that takes hold later than time 0 and has done so: where its vertices
    /// belong without its motion [m]. Empty for the others.
    pub anchors: Vec<Vec<Point>>,
    /// Which bodies, then which half-spaces, are there during the next time step.
    pub present: Vec<bool>,
    /// What contacts remember; the forces include those between bodies asleep.
    pub contacts: CarriedContacts,
    /// Which bodies sleep, and how long the others have been at rest. Empty if bodies never sleep.
    pub sleep: SleepState,
    /// Positions by which a collision backend orders what it searches in [m]. Empty: those that the scene begins with.
    pub order: Vec<Point>,
    /// What a program has changed about the scene.
    pub driven: Driven,
}
