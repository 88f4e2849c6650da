//! Elements of your own: energies that a program brings along.
//!
//! | file | holds |
//! |---|---|
//! | `element.rs` | the trait [`CustomElement`], its matrix and groups of elements |
//! | `derivatives.rs` | [`check_derivatives`], for your tests |
//! | `groups.rs` | what is checked of groups when they are added or replaced |
//! | `filter.rs` | takes negative curvature away |
//! | `set.rs` | the assembly |

mod derivatives;
pub(crate) mod element;
mod filter;
pub(crate) mod groups;
pub(crate) mod set;

pub use derivatives::{DerivativeErrors, DerivativeProblem, check_derivatives};
pub use element::{CustomElement, ElementGroup, ElementMatrix, MAX_ELEMENT_VERTICES};
