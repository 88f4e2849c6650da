//! The pages that publish results, from the root of the repository.

/// Figures and tables, with an index of them.
pub const BENCHMARKS: &str = "docs/benchmarks.md";
/// The cases of [`crate::stability`].
pub const STABILITY: &str = "docs/stability.md";
