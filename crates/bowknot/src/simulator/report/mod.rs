//! What a simulation reports: the statistics of a time step, what held it back, and what observers see.

mod blocking;
mod contacts;
mod observer;
mod process;
mod statistics;
mod unsolved;

pub use blocking::WaitingElements;
pub(crate) use blocking::element_words;
pub use contacts::{Contact, Wrench};
pub(crate) use observer::Relay;
pub use observer::{AcceptedStep, CollisionProblem, Iterated, SimulationObserver};
pub use process::{cpu_seconds, peak_memory_bytes};
pub use statistics::{Energy, StepSeconds, StepStatistics};
pub(crate) use unsolved::Search;
pub use unsolved::Unsolved;
