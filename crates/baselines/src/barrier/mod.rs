//! The log-barrier interior point method (paper, Eq. 7-8; after Li et al. 2020, "Incremental Potential
//! Contact", and Wu et al. 2020).
//!
//! The distance to the target and a barrier on gaps form one [`Objective`]. It is minimized by gradient
//! descent with the step bounds of the two-way method ([`by_descent`]), or by Newton's method with a line
//! search ([`by_newton`]), which with [`BarrierParams::ipc`] is IPC.

mod cholesky;
mod descent;
mod function;
mod hessian;
mod line_search;
mod mollifier;
mod newton;
mod objective;
mod params;
mod stiffness;
mod system;

pub use descent::{DescentStep, by_descent};
pub use function::{Jet, barrier, squared_barrier};
pub use line_search::LineSearch;
pub use mollifier::Mollifier;
pub use newton::{NewtonStep, by_newton};
pub use objective::{Contact, Derivatives, Objective};
pub use params::{BarrierForm, BarrierParams, LinearSolver, Scaling};
