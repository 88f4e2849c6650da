//! What a file says, before prims become parts of a mesh.

use crate::usd::names::OBSTACLE;
use std::collections::BTreeMap;

/// A layer: prims and what holds for all of them.
#[derive(Debug, Default)]
pub(super) struct Layer {
    /// The root's metadata that count, as `upAxis`.
    pub metadata: BTreeMap<String, Value>,
    pub prims: Vec<Prim>,
    /// The first of what other files or variants would add, which is not read.
    pub composed: Option<String>,
}

/// A prim that is defined and active.
#[derive(Debug, Default)]
pub(super) struct Prim {
    pub name: String,
    /// `Mesh`, `Xform`, ..; empty: none.
    pub kind: String,
    /// Its name for people, if it has one.
    pub display_name: Option<String>,
    pub attributes: BTreeMap<String, Attribute>,
    pub children: Vec<Prim>,
}

/// An attribute: its value where nothing moves, and its values at time codes, ascending.
#[derive(Debug, Default)]
pub(super) struct Attribute {
    pub default: Option<Value>,
    pub samples: Vec<(f64, Value)>,
}

/// A value; arrays of numbers stay in the file.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Value {
    /// A number, a vector, a quaternion (real part first) or a matrix (row by row); a truth value is 0 or 1.
    Numbers(Vec<f64>),
    Text(String),
    Texts(Vec<String>),
    Array(ArrayPlace),
}

/// Where an array of numbers is in its file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ArrayPlace {
    /// First byte in a text, representation in a crate file.
    pub start: u64,
    /// Bytes of a text.
    pub length: u64,
    /// Line of a text.
    pub line: usize,
    /// Whether numbers are of single precision.
    pub single: bool,
}

/// Attributes that meshes come from; others are not kept.
pub(super) fn counts(name: &str) -> bool {
    const NAMES: [&str; 15] = [
        "points",
        "faceVertexCounts",
        "faceVertexIndices",
        "curveVertexCounts",
        "type",
        "wrap",
        "orientation",
        "subdivisionScheme",
        "visibility",
        "purpose",
        "xformOpOrder",
        OBSTACLE,
        "tetVertexIndices",
        // Of subsets.
        "elementType",
        "indices",
    ];
    NAMES.contains(&name) || name.starts_with("xformOp:") || name.starts_with(SKIN)
}

/// How attributes begin that bind a prim to a skeleton.
pub(super) const SKIN: &str = "primvars:skel:";

/// Metadata of a layer that count.
pub(super) const METADATA: [&str; 4] = ["upAxis", "metersPerUnit", "timeCodesPerSecond", "framesPerSecond"];

impl Prim {
    /// A text that does not move, such as a token.
    pub fn text(&self, name: &str) -> Option<&str> {
        match self.attributes.get(name)?.first()? {
            Value::Text(text) => Some(text),
            _ => None,
        }
    }
}

impl Attribute {
    /// The value where nothing moves: the default, else that of the first time code.
    pub fn first(&self) -> Option<&Value> {
        self.default.as_ref().or(self.samples.first().map(|(_, value)| value))
    }

    /// The two values around a time code and the weight of the second; without time samples the default.
    pub fn around(&self, time: f64) -> Option<(&Value, &Value, f64)> {
        let after = self.samples.partition_point(|(code, _)| *code <= time);
        match (after.checked_sub(1).and_then(|at| self.samples.get(at)), self.samples.get(after)) {
            (Some((t0, low)), Some((t1, high))) => Some((low, high, (time - t0) / (t1 - t0))),
            (Some((_, value)), None) | (None, Some((_, value))) => Some((value, value, 0.0)),
            (None, None) => self.default.as_ref().map(|value| (value, value, 0.0)),
        }
    }
}
