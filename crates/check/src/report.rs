//! What the judge says.

use bowknot_geometry::{PairKind, Point};
#[cfg(feature = "serde")]
use serde::Serialize;
use std::fmt;

/// The classes of pairs that are judged, in the order in which reports list them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(Serialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum PairClass {
    /// An edge and a triangle (states only).
    EdgeTriangle,
    /// Two edges.
    EdgeEdge,
    /// A vertex and a triangle.
    VertexTriangle,
    /// A particle and a strand edge.
    VertexEdge,
    /// Two particles.
    VertexVertex,
    /// A vertex and a half-space.
    VertexHalfSpace,
}

impl PairClass {
    /// How [`bowknot_geometry`] calls pairs of this class that can be measured; edge-triangle pairs cannot.
    pub const fn kind(self) -> PairKind {
        match self {
            PairClass::EdgeEdge | PairClass::EdgeTriangle => PairKind::EdgeEdge,
            PairClass::VertexTriangle => PairKind::VertexTriangle,
            PairClass::VertexEdge => PairKind::VertexEdge,
            PairClass::VertexVertex => PairKind::VertexVertex,
            PairClass::VertexHalfSpace => PairKind::VertexHalfSpace,
        }
    }

    /// Names of the two sides.
    pub const fn sides(self) -> [&'static str; 2] {
        match self {
            PairClass::EdgeTriangle => ["edge", "triangle"],
            PairClass::EdgeEdge => ["edge", "edge"],
            PairClass::VertexTriangle => ["vertex", "triangle"],
            PairClass::VertexEdge => ["vertex", "edge"],
            PairClass::VertexVertex => ["vertex", "vertex"],
            PairClass::VertexHalfSpace => ["vertex", "half-space"],
        }
    }
}

/// Two primitives that intersect or touch.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize))]
pub struct Intersection {
    /// What kind of primitives they are.
    pub class: PairClass,
    /// Indices of the primitives: vertices, triangles and half-spaces as given, edges as in
    /// [`super::Judge::edges`].
    pub elements: [u32; 2],
    /// Vertices of either side; none for a half-space.
    pub vertices: [Vec<u32>; 2],
    /// Body of either side; `None` for a half-space.
    pub bodies: [Option<u32>; 2],
    /// A point of the overlap, to rounding [m].
    pub place: Point,
    /// How far the nearer end of the edge lies behind the plane of the triangle, or the vertex below the
    /// half-space [m]: moved by so much along the normal, this edge would leave this triangle. 0 for pairs
    /// that touch. An edge is no deeper than half its length, however deep its mesh is in the other.
    pub depth: f64,
}

/// The closest two primitives of a state.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize))]
pub struct Nearest {
    /// What kind of primitives they are.
    pub class: PairClass,
    /// Indices of the primitives, see [`Intersection::elements`].
    pub elements: [u32; 2],
    /// Vertices of either side; none for a half-space.
    pub vertices: [Vec<u32>; 2],
    /// Body of either side; `None` for a half-space.
    pub bodies: [Option<u32>; 2],
    /// Closest points of either side [m].
    pub places: [Point; 2],
    /// Their distance, to rounding [m]; negative only below a half-space.
    pub distance: f64,
}

/// Two primitives that are near each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NearPair {
    /// What kind of primitives they are.
    pub class: PairClass,
    /// Indices of the primitives, see [`Intersection::elements`].
    pub elements: [u32; 2],
    /// Closest points of either side [m].
    pub places: [Point; 2],
    /// Their distance, to rounding [m]; negative only below a half-space.
    pub distance: f64,
}

/// How two bodies, or one with itself, intersect.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize))]
pub struct BodyPair {
    /// The two bodies, ascending; half-spaces are `None` and come last.
    pub bodies: [Option<u32>; 2],
    /// How many pairs of primitives intersect, or meet on a path.
    pub count: usize,
    /// The deepest of these intersections [m], see [`Intersection::depth`]; `None` on a path.
    pub depth: Option<f64>,
    /// Where the deepest one is, or the first that meet on a path [m].
    pub place: Point,
}

/// What [`super::Judge::check_state`] computes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StateOptions {
    /// How many intersections to list at most; all are counted.
    pub limit: usize,
    /// Whether to find the smallest distance, which costs about as much again.
    pub distance: bool,
}

impl Default for StateOptions {
    fn default() -> Self {
        Self { limit: 100, distance: true }
    }
}

/// Verdict on a state.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize))]
pub struct StateReport {
    /// The first intersections, ordered by class and elements.
    pub intersections: Vec<Intersection>,
    /// How many pairs intersect in all.
    pub intersection_count: usize,
    /// How many of them are an edge and a triangle.
    pub edge_triangle_count: usize,
    /// The bodies that intersect, ascending; all intersections are counted.
    pub body_pairs: Vec<BodyPair>,
    /// The closest pair, if asked for and if there is any pair.
    pub nearest: Option<Nearest>,
}

impl StateReport {
    /// Whether nothing intersects.
    pub fn is_clear(&self) -> bool {
        self.intersection_count == 0
    }
}

/// What [`super::Judge::check_path`] computes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PathOptions {
    /// How many hits to list at most; all are counted.
    pub limit: usize,
    /// Skip pairs of primitives that do not move. Right whenever the start is known to be clear.
    pub skip_unmoved: bool,
}

impl Default for PathOptions {
    fn default() -> Self {
        Self { limit: 100, skip_unmoved: true }
    }
}

/// Two primitives that meet on a path, or that could not be certified not to.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize))]
pub struct PathHit {
    /// What kind of primitives they are.
    pub class: PairClass,
    /// Indices of the primitives, see [`Intersection::elements`].
    pub elements: [u32; 2],
    /// Vertices of either side; none for a half-space.
    pub vertices: [Vec<u32>; 2],
    /// Body of either side; `None` for a half-space.
    pub bodies: [Option<u32>; 2],
    /// Until when the pair is certified to be apart, as a fraction of the path.
    pub time: f64,
    /// Closest points of either side at that time [m].
    pub places: [Point; 2],
}

/// Verdict on a straight path.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize))]
pub struct PathReport {
    /// The first hits, ordered by class and elements.
    pub hits: Vec<PathHit>,
    /// How many pairs are hits in all.
    pub hit_count: usize,
    /// The bodies that meet, ascending; all hits are counted.
    pub body_pairs: Vec<BodyPair>,
    /// How many pairs' moving boxes met, so that they were looked at one by one.
    pub candidates: usize,
}

impl PathReport {
    /// Whether the path is certified to be free of intersections.
    pub fn is_clear(&self) -> bool {
        self.hit_count == 0
    }
}

impl fmt::Display for Intersection {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.in_words(&[]))
    }
}

impl fmt::Display for Nearest {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.in_words(&[]))
    }
}

impl fmt::Display for PathHit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.in_words(&[]))
    }
}

impl Intersection {
    /// The intersection in words. Bodies have their names, as far as there are any.
    pub fn in_words(&self, names: &[String]) -> String {
        let pair = pair_in_words(self.class, &self.elements, &self.vertices, &self.bodies, names);
        format!("{pair} intersect at {}", Place(&self.place))
    }
}

impl Nearest {
    /// The pair in words. Bodies have their names, as far as there are any.
    pub fn in_words(&self, names: &[String]) -> String {
        let pair = pair_in_words(self.class, &self.elements, &self.vertices, &self.bodies, names);
        format!("{pair} are {:.3e} m apart at {}", self.distance, Place(&self.places[0]))
    }
}

impl PathHit {
    /// The hit in words. Bodies have their names, as far as there are any.
    pub fn in_words(&self, names: &[String]) -> String {
        let pair = pair_in_words(self.class, &self.elements, &self.vertices, &self.bodies, names);
        format!("{pair} meet at {} after {:.9} of the path", Place(&self.places[0]), self.time)
    }
}

struct Place<'a>(&'a Point);

impl fmt::Display for Place<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "({:.6}, {:.6}, {:.6})", self.0.x, self.0.y, self.0.z)
    }
}

fn pair_in_words(
    class: PairClass,
    elements: &[u32; 2],
    vertices: &[Vec<u32>; 2],
    bodies: &[Option<u32>; 2],
    names: &[String],
) -> String {
    let side = |side: usize| {
        let element = format!("{} {}", class.sides()[side], elements[side]);
        let Some(body) = bodies[side] else { return element };
        let body = names.get(body as usize).map_or_else(|| format!("body {body}"), Clone::clone);
        match vertices[side].as_slice() {
            [_] => format!("{element} of {body}"),
            list => format!("{element} (vertices {list:?}) of {body}"),
        }
    };
    format!("{} and {}", side(0), side(1))
}
