//! The time-step loop: [`Simulator`], its statistics, errors and checkpoints, and what it shows to an
//! observer.

mod approach;
mod averaging;
mod backend;
mod checkpoint;
mod clearance;
mod contacts;
mod crowding;
mod ends;
mod error;
mod finished;
mod friction;
mod held;
mod held_apart;
mod inside;
mod interior;
mod least_excess;
mod near_starts;
mod observer;
mod overlap;
mod prescribed;
mod presence;
mod process;
mod reach;
mod rest;
mod rows;
#[allow(clippy::module_inception, reason = "the type that the module is named for")]
mod simulator;
mod sleep;
mod solved;
mod statistics;
mod taut;
mod tolerance;
mod unsolved;
mod waits;
mod waking;

pub use averaging::ContactMean;
pub use backend::{BackendError, CollisionBackend, Cpu};
pub use checkpoint::Checkpoint;
pub use contacts::CarriedContacts;
pub use error::{SimulationError, describe_intersections};
pub use friction::ContactForce;
pub use held_apart::{HeldApart, HeldPair};
pub use near_starts::NearStart;
pub use observer::{AcceptedStep, CollisionProblem, Iterated, SimulationObserver};
pub use process::{cpu_seconds, peak_memory_bytes};
#[cfg(feature = "gpu")]
pub(crate) use simulator::MIN_VERTICES;
pub use simulator::Simulator;
pub use sleep::SleepState;
pub use statistics::{DeviceCounts, Energy, HostSeconds, StepSeconds, StepStatistics};
pub use unsolved::Unsolved;
pub use waits::WaitingElements;
