//! Who watches while files are judged.

use crate::check::{Judge, StateReport};
use crate::geometry::Point;
use crate::io::Mesh;
use crate::recording::States;
use std::path::Path;

/// A state that was judged.
#[derive(Clone, Copy, Debug)]
pub struct JudgedState<'a> {
    /// The file that holds it.
    pub file: &'a Path,
    /// The name that the report gives it: that of the file, and the number of the frame if there are several.
    pub name: &'a str,
    /// The mesh without its positions. Its bodies are the parts, whose names it has.
    pub mesh: &'a Mesh,
    /// Positions [m].
    pub positions: &'a [Point],
    /// The judge of its elements.
    pub judge: &'a Judge,
    /// The verdict, in which at most [`listed`](super::JudgingParams::listed) intersections are described.
    pub report: &'a StateReport,
    /// The collision problem that it starts, if it is one.
    pub problem: Option<&'a States>,
}

/// Watches while files are judged. Each method does nothing by default.
pub trait JudgingObserver {
    /// A state has been judged, with `done` of so far `total` states. Returns whether to go on.
    fn progressed(&mut self, done: usize, total: usize) -> bool {
        let _ = (done, total);
        true
    }

    /// Something about a file that is no intersection, but worth knowing.
    fn warned(&mut self, text: &str) {
        let _ = text;
    }

    /// A state intersects. Returns whether to go on.
    fn intersected(&mut self, state: &JudgedState<'_>) -> bool {
        let _ = state;
        true
    }
}

/// Watches nothing.
impl JudgingObserver for () {}
