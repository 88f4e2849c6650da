//! Pins as a scene describes them.

use crate::motion::Motion;
use bowknot_errors::{Checks, Parameters};
use bowknot_geometry::Point;
use serde::de::value::SeqAccessDeserializer;
use serde::de::{self, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize};
use std::fmt;

/// Vertices of a body that are held or led, `[[pin]]`. The vertices are those of all selectors given
/// (`vertices`, `group`, `box`, `side`, `roots`). While an obstacle or another body is in the way they wait, as one.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct PinSpec {
    /// Name of the body. May be left out if there is only one.
    pub body: String,
    /// Vertices by index in the body's mesh, from 0; of quadratic elements also the middles of edges between
    /// them. Default none.
    pub vertices: Vec<u32>,
    /// Name of a group of vertices of the body's mesh file, or a list of names, as `bowknot info MESH` lists
    /// them; of quadratic elements also the middles of edges between them. Default none.
    #[serde(deserialize_with = "one_or_more")]
    pub group: Vec<String>,
    /// Vertices within an axis-aligned box of the scene at its start. Default none.
    #[serde(rename = "box", skip_serializing_if = "Option::is_none")]
    pub region: Option<Region>,
    /// Vertices on a side of the body's bounding box: `x-min`, `x-max`, `y-min`, `y-max`, `z-min`,
    /// `z-max`. Default none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub side: Option<Side>,
    /// How many vertices of each strand are held, from its root on [1]: 1 hinges strands, 2 or more clamp
    /// their direction as well. Default 0.
    pub roots: usize,
    /// Which end of each strand is its root: `first`, the vertex that comes first in the mesh; `last`, the
    /// one farthest from that along the strand; `nearest`, that of the two which is nearer to an obstacle at
    /// the start. Default `first`.
    pub root_end: RootEnd,
    /// Rigid motion over time, see the motions. Default: held where they are.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub motion: Option<Motion>,
    /// Name of an obstacle with a mesh that they follow instead: each keeps its place relative to the
    /// triangle that is nearest to it when the pin takes hold, as if sewn on. Default none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub follow: Option<String>,
    /// When the pin takes hold [s]; it takes the vertices from where they are then. Default 0.
    pub start: f64,
    /// When it lets go [s]. Default inf.
    pub end: f64,
}

/// An axis-aligned box of the scene.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Region {
    /// Lower corner [m]; components may be -inf. Default -inf.
    pub min: Point,
    /// Upper corner [m]; components may be inf. Default inf.
    pub max: Point,
}

/// Which end of a strand is its root.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum RootEnd {
    /// The vertex that comes first in the mesh.
    #[default]
    First,
    /// The vertex that is farthest from it along the strand.
    Last,
    /// That of the two which is nearer to an obstacle.
    Nearest,
}

/// A side of a body's bounding box.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[allow(missing_docs)]
pub enum Side {
    XMin,
    XMax,
    YMin,
    YMax,
    ZMin,
    ZMax,
}

impl Side {
    /// Axis, and whether it is the upper end.
    pub fn axis(self) -> (usize, bool) {
        match self {
            Self::XMin => (0, false),
            Self::XMax => (0, true),
            Self::YMin => (1, false),
            Self::YMax => (1, true),
            Self::ZMin => (2, false),
            Self::ZMax => (2, true),
        }
    }
}

impl Default for Region {
    fn default() -> Self {
        let infinity = f64::INFINITY;
        Self {
            min: Point::new(-infinity, -infinity, -infinity),
            max: Point::new(infinity, infinity, infinity),
        }
    }
}

impl Region {
    /// Whether a point lies in the box or on its surface.
    pub fn contains(&self, p: &Point) -> bool {
        (0..3).all(|c| self.min[c] <= p[c] && p[c] <= self.max[c])
    }
}

impl Default for PinSpec {
    fn default() -> Self {
        Self {
            body: String::new(),
            vertices: Vec::new(),
            group: Vec::new(),
            region: None,
            side: None,
            roots: 0,
            root_end: RootEnd::First,
            motion: None,
            follow: None,
            start: 0.0,
            end: f64::INFINITY,
        }
    }
}

impl Parameters for PinSpec {
    fn check(&self, checks: &mut Checks) {
        let has_names = !self.vertices.is_empty() || !self.group.is_empty();
        if !has_names && self.region.is_none() && self.side.is_none() && self.roots == 0 {
            checks.contradiction("vertices", "a pin needs vertices, a group, a box, a side or roots");
        }
        if let Some(region) = self.region {
            // Not by `<`, which is false for NaN.
            if !(0..3).all(|c| region.min[c] <= region.max[c]) {
                checks.contradiction("box", "min must not exceed max, and neither be NaN");
            }
        }
        checks.non_negative("start", self.start);
        let later = self.end > self.start;
        checks.require(later, "end", self.end, format!("must be later than start, {} s", self.start));
        if let Some(motion) = &self.motion {
            if self.follow.is_some() {
                checks.contradiction("follow", "stands beside motion; only one of them may be given");
            }
            checks.within("motion", motion);
        }
    }
}

/// Reads a name as the list of it alone.
fn one_or_more<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<String>, D::Error> {
    struct Names;

    impl<'de> Visitor<'de> for Names {
        type Value = Vec<String>;

        fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
            write!(f, "a name or a list of names")
        }

        fn visit_str<E: de::Error>(self, name: &str) -> Result<Self::Value, E> {
            Ok(vec![name.to_owned()])
        }

        fn visit_seq<A: SeqAccess<'de>>(self, names: A) -> Result<Self::Value, A::Error> {
            Vec::deserialize(SeqAccessDeserializer::new(names))
        }
    }

    deserializer.deserialize_any(Names)
}
