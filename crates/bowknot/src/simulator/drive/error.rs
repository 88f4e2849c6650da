//! Why a change between time steps is refused.

use bowknot_dynamics::ModelError;
use bowknot_errors::{Errors, ParamError};

/// Why a change between time steps is refused. The simulator is then as it was.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DriveError {
    /// Nothing has the name.
    #[error("no {what} {name:?}; there are: {}", .known.join(", "))]
    Unknown {
        /// "body", "obstacle", "body or obstacle", or "pin".
        what: &'static str,
        /// The name given.
        name: String,
        /// The names that there are.
        known: Vec<String>,
    },
    /// The name is taken.
    #[error("{name:?} is the name of a {what} already; names must differ")]
    Taken {
        /// "body or obstacle", "pin", or "group of custom elements".
        what: &'static str,
        /// The name given.
        name: String,
    },
    /// A list has another number of entries than vertices.
    #[error("{what} of {name}: {given} given, but it has {expected} vertices")]
    Length {
        /// What the list holds, such as "targets".
        what: &'static str,
        /// The body, obstacle or pin.
        name: String,
        /// Entries given.
        given: usize,
        /// Entries needed.
        expected: usize,
    },
    /// A number is not finite.
    #[error("{what} of {name}: entry {index} is not finite")]
    NonFinite {
        /// What the number belongs to, such as "targets".
        what: &'static str,
        /// The body, obstacle or pin; "the scene" for what acts on all.
        name: String,
        /// Which entry of the list, from 0.
        index: usize,
    },
    /// A pin would hold a vertex that the body's mesh does not have or no element names.
    #[error(
        "pin {pin}: vertex {vertex} is none of body {body}, which has {count} in its mesh, counted from 0"
    )]
    NoVertex {
        /// The pin.
        pin: String,
        /// The body.
        body: String,
        /// The vertex.
        vertex: u32,
        /// Vertices of its mesh.
        count: usize,
    },
    /// A pin would hold a vertex that is held already.
    #[error("pin {pin}: vertex {vertex} of body {body} is held by {other}; remove that pin first")]
    Held {
        /// The pin.
        pin: String,
        /// The body.
        body: String,
        /// The vertex.
        vertex: u32,
        /// The pin that holds it.
        other: String,
    },
    /// A pin would hold nothing.
    #[error("pin {pin} would hold no vertex")]
    Empty {
        /// The pin.
        pin: String,
    },
    /// A body has no such vertex.
    #[error("body {body} has no vertex {vertex}; its mesh has {count}, counted from 0")]
    Vertex {
        /// The body.
        body: String,
        /// The vertex, as in its mesh.
        vertex: u32,
        /// Vertices of its mesh.
        count: usize,
    },
    /// Custom elements are refused.
    #[error("{}", .source.iter().map(ToString::to_string).collect::<Vec<_>>().join("; "))]
    Elements {
        /// What is wrong with each.
        source: Errors<ModelError>,
    },
    /// Custom elements act on a body that would be removed.
    #[error("custom elements {group:?} act on body {body}; remove them first")]
    Needed {
        /// The group of elements.
        group: String,
        /// The body.
        body: String,
    },
    /// Pins follow an obstacle that would be removed.
    #[error("{pin} follows obstacle {obstacle}; remove that pin first")]
    Followed {
        /// The obstacle.
        obstacle: String,
        /// The pin.
        pin: String,
    },
    /// A rigid motion is out of its range.
    #[error("motion of {name}: {source}")]
    Motion {
        /// The obstacle.
        name: String,
        /// What is wrong with it.
        source: Errors<ParamError>,
    },
    /// The state would intersect.
    #[error("{what} would intersect: {} ({count} in all); move it to where nothing is", .lines.join("; "))]
    Intersects {
        /// What would.
        what: String,
        /// The first intersecting pairs, in words.
        lines: Vec<String>,
        /// How many pairs intersect in all.
        count: usize,
    },
    /// What is changed does not fit the scene.
    #[error("{message}")]
    Scene {
        /// What is wrong and what is allowed.
        message: String,
    },
}
