//! What computes a run, and the file `backends.json` that tells it, so that a resumption computes in the same
//! way.

use crate::simulator::{CollisionBackend, Cpu};
use bowknot_dynamics::NewtonBackend;
use bowknot_io::{IoError, write_text};
use serde::{Deserialize, Serialize};
use std::fs;
use std::path::Path;

/// The name of the CPU as a backend.
pub(super) const CPU: &str = "cpu";

/// The file in the folder of a run.
pub(super) const FILE: &str = "backends.json";

/// What computes a run: the CPU by default.
#[derive(Debug)]
pub struct Backends {
    /// Resolves the collisions.
    pub collisions: Box<dyn CollisionBackend>,
    /// Computes the dynamics; None for the CPU.
    pub dynamics: Option<Box<dyn NewtonBackend>>,
    /// Why they were chosen, if the program chose.
    pub why: Option<String>,
    /// Why the CPU computes the dynamics beside a device, if that was not asked for.
    pub dynamics_why: Option<String>,
}

impl Default for Backends {
    fn default() -> Self {
        Self { collisions: Box::new(Cpu), dynamics: None, why: None, dynamics_why: None }
    }
}

impl Backends {
    /// What tells them.
    pub fn record(&self) -> BackendRecord {
        BackendRecord {
            collisions: self.collisions.name(),
            dynamics: self.dynamics.as_ref().map_or_else(|| CPU.to_owned(), |dynamics| dynamics.name()),
            why: self.why.clone(),
            dynamics_why: self.dynamics_why.clone(),
        }
    }
}

/// The content of `backends.json`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct BackendRecord {
    /// What resolves the collisions: "cpu", or "gpu: " and the device.
    pub collisions: String,
    /// What computes the dynamics, likewise.
    #[serde(alias = "linear")]
    pub dynamics: String,
    /// Why they were chosen, if the program chose.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub why: Option<String>,
    /// Why the CPU computes the dynamics beside a device, if that was not asked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub dynamics_why: Option<String>,
}

impl BackendRecord {
    /// What computed the run of a folder so far; None if nothing tells.
    ///
    /// # Errors
    /// The file cannot be read, or holds something else.
    pub fn read(folder: &Path) -> Result<Option<Self>, IoError> {
        let path = folder.join(FILE);
        if !path.exists() {
            return Ok(None);
        }
        let system = |source| IoError::system("read", &path, source);
        let text = fs::read_to_string(&path).map_err(system)?;
        serde_json::from_str(&text).map(Some).map_err(|error| system(error.into()))
    }

    pub(super) fn write(&self, folder: &Path) -> Result<(), IoError> {
        let path = folder.join(FILE);
        let text = serde_json::to_string_pretty(self);
        let text = text.map_err(|error| IoError::system("write", &path, error.into()))?;
        write_text(&path, &(text + "\n"))
    }
}
