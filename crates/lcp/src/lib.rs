//! Linear complementarity problems over sparse rows, and their projected solvers.
//!
//! The problem: project node positions y_free (3-vectors with inverse weights w >= 0) onto linear
//! inequalities over up to four nodes ([`Row`]), limits on distances ([`BallRow`]), and friction
//! bounds ([`FrictionRow`]). It is handed over as borrowed arrays ([`Problem`]), and solved in place
//! ([`State`]):
//!
//! - [`sweep_serial`], [`solve_serial`]: projected Gauss-Seidel, one row after the other;
//! - [`sweep_coloured`], [`solve_coloured`]: the same, colour by colour in parallel, to the same bits;
//! - [`Jacobi`]: all rows at once, with split masses, for comparison and where no colours are at hand;
//! - [`solve_exact`]: an active-set method on the dense Delassus matrix, the reference for small problems.
//!
//! It knows neither meshes nor contacts. Positions and row values share one unit (metres, as a rule);
//! with weights relative to their mean, multipliers have it too.

mod colours;
mod error;
mod exact;
mod gauss_seidel;
mod jacobi;
mod kernels;
mod multipliers;
mod params;
mod problem;
mod residual;
mod slots;
mod team;

/// A node's position or displacement, or a gradient.
pub type Vector = nalgebra::Vector3<f64>;
/// A friction multiplier or slip along two tangents.
pub type TangentVector = nalgebra::Vector2<f64>;

pub use colours::validate_colours;
pub use error::Error;
pub use exact::{delassus, solve_dense, solve_exact};
pub use gauss_seidel::{solve_coloured, solve_serial, sweep_coloured, sweep_serial};
pub use jacobi::Jacobi;
pub use multipliers::apply_multipliers;
pub use params::{FrictionBound, Info, Params};
pub use problem::{
    BallRow, Family, FrictionRow, Problem, Row, Schedule, State, prepare_friction, prepare_rows,
};
pub use residual::{Residuals, residuals};

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeDocTests;
