//! Why a simulator cannot go on from a checkpoint.

use super::drive::DriveError;
use std::error::Error;

/// Why a simulator cannot go on from a checkpoint. It is then as it was.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RestoreError {
    /// A list has another number of entries than the scene has vertices.
    #[error("its {what} are {given}, but the scene has {expected} vertices: it is of another scene")]
    Length {
        /// "positions" or "velocities".
        what: &'static str,
        /// Entries given.
        given: usize,
        /// Entries needed.
        expected: usize,
    },
    /// Other pins.
    #[error("its pins are not those of the scene")]
    Pins,
    /// Another number of obstacles.
    #[error("its obstacles are not those of the scene")]
    Obstacles,
    /// Bodies asleep that there are not.
    #[error("its bodies asleep are not those of the scene")]
    Sleep,
    /// Other custom elements.
    #[error("its custom elements {group:?} {problem}")]
    Elements {
        /// The group.
        group: String,
        /// What differs, and what to do.
        problem: &'static str,
    },
    /// A search order of another number of vertices.
    #[error("its order of a search is not one of the scene")]
    Order,
    /// What a program had changed does not fit the scene.
    #[error("what was changed by code: {0}")]
    Driven(#[from] DriveError),
    /// The state intersects.
    #[error("its state intersects: {} ({count} in all); take one of a simulation", .lines.join("; "))]
    Intersects {
        /// The first intersecting pairs, in words.
        lines: Vec<String>,
        /// How many pairs intersect in all.
        count: usize,
    },
    /// The changed scene, the state, or a backend is refused.
    #[error("{source}")]
    Refused {
        /// Why.
        source: Box<dyn Error + Send + Sync>,
    },
}

impl RestoreError {
    /// Refused by a part of the simulator.
    pub(super) fn refused(source: impl Error + Send + Sync + 'static) -> Self {
        Self::Refused { source: Box::new(source) }
    }
}
