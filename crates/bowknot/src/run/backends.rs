//! What computes a run.

use crate::simulator::{CollisionBackend, Cpu};
use bowknot_dynamics::LinearBackend;

/// The name of the CPU as a backend.
pub(super) const CPU: &str = "cpu";

/// What computes a run: the CPU by default.
#[derive(Debug)]
pub struct Backends {
    /// Resolves the collisions.
    pub collisions: Box<dyn CollisionBackend>,
    /// Does the linear solves of the dynamics; None for the CPU.
    pub linear: Option<Box<dyn LinearBackend>>,
}

impl Default for Backends {
    fn default() -> Self {
        Self { collisions: Box::new(Cpu), linear: None }
    }
}

impl Backends {
    /// Names of what resolves collisions and of what does linear solves.
    pub fn names(&self) -> [String; 2] {
        let linear = self.linear.as_ref().map_or_else(|| CPU.to_owned(), |linear| linear.name());
        [self.collisions.name(), linear]
    }
}
