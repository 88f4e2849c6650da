//! What a device was asked for.

#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};
use std::ops::{Add, Sub};

/// Counts and seconds of the host beside a device, since the device was opened.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct DeviceWork {
    /// Recordings with dispatches that were submitted.
    pub submissions: usize,
    /// Dispatches in them.
    pub dispatches: usize,
    /// Times that the host waited for results.
    pub waits: usize,
    /// Buffers that were made.
    pub buffers: usize,
    /// Time steps that the CPU finished because single precision was not enough.
    pub departures: usize,
    /// Seconds in which the host recorded and submitted.
    pub encode_s: f64,
    /// Seconds in which the host waited.
    pub wait_s: f64,
}

impl DeviceWork {
    /// Counts a submission with so many dispatches, after which the host reads so many buffers.
    pub fn count(&mut self, dispatches: usize, reads: usize) {
        self.submissions += usize::from(dispatches > 0);
        self.dispatches += dispatches;
        self.waits += usize::from(reads > 0);
    }
}

impl Add for DeviceWork {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            submissions: self.submissions + other.submissions,
            dispatches: self.dispatches + other.dispatches,
            waits: self.waits + other.waits,
            buffers: self.buffers + other.buffers,
            departures: self.departures + other.departures,
            encode_s: self.encode_s + other.encode_s,
            wait_s: self.wait_s + other.wait_s,
        }
    }
}

impl Sub for DeviceWork {
    type Output = Self;

    /// The work since `earlier`; counts are zero where a device was opened anew in between.
    fn sub(self, earlier: Self) -> Self {
        Self {
            submissions: self.submissions.saturating_sub(earlier.submissions),
            dispatches: self.dispatches.saturating_sub(earlier.dispatches),
            waits: self.waits.saturating_sub(earlier.waits),
            buffers: self.buffers.saturating_sub(earlier.buffers),
            departures: self.departures.saturating_sub(earlier.departures),
            encode_s: (self.encode_s - earlier.encode_s).max(0.0),
            wait_s: (self.wait_s - earlier.wait_s).max(0.0),
        }
    }
}
