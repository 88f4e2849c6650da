//! Errors that all crates share: [`ParamError`], a parameter out of its range, and [`Errors`], a list of
//! errors that is itself an error.
//!
//! A struct of parameters implements [`Parameters::check`], which looks at every field;
//! [`Parameters::validate`] is what users call. Nested structs are checked by [`Checks::within`], so that
//! each error carries the whole path of its parameter, the one that a scene file has. [`counted`] writes
//! counts in messages.

mod checks;
mod counts;
mod errors;

pub use checks::{Checks, ParamError, Parameters};
pub use counts::counted;
pub use errors::Errors;

/// The README's example is tested with the documentation.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeDoctests;
