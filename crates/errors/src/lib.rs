#![doc = include_str!("../README.md")]
//!
//! ## Parameters
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
