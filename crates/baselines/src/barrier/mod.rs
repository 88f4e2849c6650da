//! The log-barrier interior point method (paper, Eq. 7-8; after Li et al. 2020, "Incremental Potential Contact", and Wu et
//! al. 2020).
//!
//! The targets' distance and a barrier on gaps are one [`Objective`], minimised by gradient descent ([`by_descent`]).

mod descent;
mod element;
mod function;
mod objective;
mod params;

pub use descent::{DescentStep, by_descent};
pub use function::{Jet, barrier};
pub use objective::{Contact, Derivatives, Objective};
pub use params::{BarrierParams, Scaling};
