//! The pages that publish results, from the root of the repository.

/// Figures and tables, with an index of them.
pub const BENCHMARKS: &str = "docs/benchmarks.md";
/// The tables and charts of that page.
pub const FOLDER: &str = "docs/benchmarks";
/// What follows the commits of stale results.
pub const STALE: &str = " (*stale*)";
/// What users read first: the rows of its first section.
pub const README: &str = "README.md";
/// The cases of [`crate::stability`].
pub const STABILITY: &str = "docs/stability.md";
/// The runs of [`crate::figures::gallery`], and the folder of their films.
pub const GALLERY: &str = "docs/gallery.md";
pub const FILMS: &str = "docs/gallery";
/// What `bowknot-bench gpu` measured, with text of its own.
pub const GPU_RESULTS: &str = "docs/gpu/results.md";
