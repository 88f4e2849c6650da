//! Where the time of a device goes, by stage.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

/// What a stage took in all its dispatches.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StageTime {
    /// Number of dispatches.
    pub dispatches: usize,
    /// Seconds on the device between time stamps; 0 if it has none.
    pub seconds: f64,
    /// Bytes of the buffers that were bound: what the stage can have read or written once, at most.
    pub bytes: u64,
}

/// Times by the name of the stage; clones share them.
#[derive(Clone, Debug, Default)]
pub struct Profile {
    stages: Arc<Mutex<BTreeMap<&'static str, StageTime>>>,
}

impl Profile {
    /// The stages in the order of their names.
    pub fn stages(&self) -> Vec<(&'static str, StageTime)> {
        self.lock().iter().map(|(name, time)| (*name, *time)).collect()
    }

    pub(super) fn add(&self, stage: &'static str, seconds: f64, bytes: u64) {
        let mut stages = self.lock();
        let time = stages.entry(stage).or_default();
        time.dispatches += 1;
        time.seconds += seconds;
        time.bytes += bytes;
    }

    fn lock(&self) -> std::sync::MutexGuard<'_, BTreeMap<&'static str, StageTime>> {
        self.stages.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
