#![doc = include_str!("../README.md")]
//!
//! ## Modules
//!
//! ```text
//! frames.rs    where the frames of a run's folder are
//! bodies.rs    the first frame split into bodies, with names from scene.toml
//! codec.rs     quantized positions, predicted, deflated, base64
//! pack.rs      which frames go in: two passes over the folder, the budget kept by a stride
//! columns.rs   stats.jsonl as columns
//! facts.rs     what the page says in words: scene, counts, machine, what was left out
//! page.rs      the parts put together
//! assets/      the page itself (HTML, CSS, scripts) and the libraries in it, with their licenses
//! ```
//!
//! Only what the page keeps is held in memory: at most [`ReportOptions::max_bytes`], and two frames.

mod bodies;
mod codec;
mod columns;
mod error;
mod facts;
mod frames;
mod options;
mod pack;
mod page;
#[cfg(test)]
mod tests;
mod write;

pub use error::ReportError;
pub use options::{ReportInfo, ReportOptions};
pub use write::write_report;
