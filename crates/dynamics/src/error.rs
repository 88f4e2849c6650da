//! Errors of models and of time steps. Each names the object and the place.

use crate::body::Body;
use bowknot_errors::ParamError;
use bowknot_geometry::VertexOutOfRange;

/// Why a [`crate::DynamicsModel`] cannot be built. Elements are counted within their body.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ModelError {
    /// A rest position is not finite.
    #[error("the rest position of vertex {vertex} is not finite")]
    NonFinitePosition {
        /// The vertex.
        vertex: usize,
    },
    /// An element names a vertex that does not exist.
    #[error("body \"{body}\": {error}")]
    VertexOutOfRange {
        /// Name of the body.
        body: String,
        /// The element: "triangle", "tet", "edge", "particle" or "vertex".
        error: VertexOutOfRange,
    },
    /// An element names a vertex twice.
    #[error("body \"{body}\": {element} {index} names vertex {vertex} twice")]
    RepeatedVertex {
        /// Name of the body.
        body: String,
        /// "triangle", "tet" or "edge".
        element: &'static str,
        /// The index of the element.
        index: usize,
        /// The vertex that it repeats.
        vertex: u32,
    },
    /// Two elements of a body have the same vertices.
    #[error("body \"{body}\": {element}s {first} and {second} have the same vertices")]
    RepeatedElement {
        /// Name of the body.
        body: String,
        /// "triangle", "tet", "edge" or "particle".
        element: &'static str,
        /// The first of both elements.
        first: usize,
        /// The second of both elements.
        second: usize,
    },
    /// A triangle has no area at rest, and therefore neither mass nor a rest shape.
    #[error("body \"{body}\": triangle {index} has no area at rest ({area:e} m2)")]
    ZeroArea {
        /// Name of the body.
        body: String,
        /// The triangle.
        index: usize,
        /// Its area [m^2].
        area: f64,
    },
    /// A strand edge has no length at rest: its points coincide.
    #[error(
        "body \"{body}\": edge {index} has no length at rest, vertices {a} and {b} are at one place: merge \
         them"
    )]
    ZeroLength {
        /// Name of the body.
        body: String,
        /// The edge.
        index: usize,
        /// Its first vertex.
        a: u32,
        /// Its second vertex.
        b: u32,
    },
    /// Tets are inverted or flat at rest.
    #[error(
        "body \"{body}\": {} of its {tets} tets are inverted at rest{} and {} are flat{}: mend the mesh \
         (of a mesh that is inverted throughout, swap two vertices of every tet)",
        inverted.len(), first_ten(inverted), flat.len(), first_ten(flat)
    )]
    BadTets {
        /// Name of the body.
        body: String,
        /// The number of its tets.
        tets: usize,
        /// Tets of negative volume.
        inverted: Vec<usize>,
        /// Tets without volume.
        flat: Vec<usize>,
    },
    /// A middle of an edge of a quadratic tet lies elsewhere.
    #[error(
        "body \"{body}\": vertex {vertex} of quadratic tet {index} lies {off:e} m from the middle of its \
         edge: edges must be straight at rest and divided in half"
    )]
    OffMiddle {
        /// Name of the body.
        body: String,
        /// The tet.
        index: usize,
        /// The vertex.
        vertex: u32,
        /// Distance from the middle [m].
        off: f64,
    },
    /// A frame point of a rod is not beside the middle of its edge, at half of its length.
    #[error(
        "body \"{body}\": frame point {vertex} of edge {index} lies {off:e} m off its place beside the middle of the \
         edge, at half of its length: see bowknot_geometry::add_frame_points"
    )]
    OffFrame {
        /// Name of the body.
        body: String,
        /// The edge.
        index: usize,
        /// The frame point.
        vertex: u32,
        /// Distance along the edge or across it, the larger one [m].
        off: f64,
    },
    /// A strand with a twist stiffness has no frame points.
    #[error(
        "body \"{body}\" has a twist stiffness and no frame points: make it of BodyShape::Rods, or set \
         `twist_stiffness = 0`"
    )]
    NoFramePoints {
        /// Name of the body.
        body: String,
    },
    /// The warp direction is normal to triangles, so that it has no projection into them.
    #[error(
        "body \"{body}\": warp_direction is normal to {} of its triangles{}: choose a direction along the \
         cloth",
        triangles.len(), first_ten(triangles)
    )]
    WarpDirection {
        /// Name of the body.
        body: String,
        /// The triangles.
        triangles: Vec<usize>,
    },
    /// Gravity of a body is not finite.
    #[error("body \"{body}\": the components of its gravity must be finite")]
    Gravity {
        /// Name of the body.
        body: String,
    },
    /// A vertex belongs to no body and therefore has no mass.
    #[error("vertex {vertex} belongs to no body, so it has no mass")]
    NoMass {
        /// The vertex.
        vertex: usize,
    },
    /// An obstacle shares a vertex with a deformable body.
    #[error("obstacle \"{obstacle}\" and the deformable body \"{body}\" share vertex {vertex}")]
    SharedVertex {
        /// Name of the obstacle.
        obstacle: String,
        /// Name of the deformable body.
        body: String,
        /// The vertex.
        vertex: u32,
    },
    /// A value of a material is out of its range.
    #[error("body \"{body}\": {error}")]
    Material {
        /// Name of the body.
        body: String,
        /// The value.
        error: ParamError,
    },
    /// A custom element is refused.
    #[error("custom element {index} of \"{group}\": {problem}")]
    CustomElement {
        /// Name of its group.
        group: String,
        /// The index of the element in the group.
        index: usize,
        /// The reason.
        problem: ElementProblem,
    },
    /// Two groups of custom elements have the same name.
    #[error("two groups of custom elements have the name \"{group}\"; names must differ")]
    RepeatedGroup {
        /// The name.
        group: String,
    },
    /// No group of custom elements has the name.
    #[error("no custom elements \"{group}\"; there are: {}", known.join(", "))]
    UnknownGroup {
        /// The name given.
        group: String,
        /// The names that there are.
        known: Vec<String>,
    },
    /// A group of custom elements would be replaced by another number of elements.
    #[error("custom elements \"{group}\": {given} given in place of {expected}")]
    ElementCount {
        /// Name of the group.
        group: String,
        /// Elements given.
        given: usize,
        /// Elements of the group.
        expected: usize,
    },
}

/// Why a custom element is refused.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ElementProblem {
    /// It has no vertices, or too many.
    #[error("it has {given} vertices; 1 to {most} are possible")]
    Count {
        /// Vertices given.
        given: usize,
        /// The most that are possible.
        most: usize,
    },
    /// It names a vertex that does not exist.
    #[error("it names vertex {vertex}, but there are only {count} vertices")]
    OutOfRange {
        /// The vertex.
        vertex: u32,
        /// Vertices of the model.
        count: usize,
    },
    /// It names a vertex twice.
    #[error("it names vertex {vertex} twice")]
    Repeated {
        /// The vertex.
        vertex: u32,
    },
    /// It names a vertex of an obstacle, which is no unknown of the dynamics.
    #[error(
        "vertex {vertex} belongs to the obstacle \"{obstacle}\", which no element moves: let the element hold \
         that place itself, and replace it where the obstacle moves"
    )]
    Obstacle {
        /// The vertex.
        vertex: u32,
        /// Name of the obstacle.
        obstacle: String,
    },
    /// It would replace an element with other vertices.
    #[error(
        "it would replace one with the vertices {expected:?} and must have the same: remove and add elements \
         anew"
    )]
    OtherVertices {
        /// Vertices of the element before.
        expected: Vec<u32>,
    },
}

/// The first ten indices as " (3, 17, ..)", or an empty text if there are none.
fn first_ten(indices: &[usize]) -> String {
    if indices.is_empty() {
        return String::new();
    }
    let shown: Vec<String> = indices.iter().take(10).map(ToString::to_string).collect();
    let more = if indices.len() > shown.len() { ", .." } else { "" };
    format!(" ({}{more})", shown.join(", "))
}

/// Why a time step is not possible.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum StepError {
    /// An array has another length than the model has vertices.
    #[error("{array} has {given} entries for {vertices} vertices")]
    Length {
        /// The argument.
        array: &'static str,
        /// Its length.
        given: usize,
        /// Vertices of the model.
        vertices: usize,
    },
    /// The time step is not a positive finite number.
    #[error("dt = {dt} s: the time step must be a finite number greater than 0")]
    TimeStep {
        /// The time step [s].
        dt: f64,
    },
    /// An entry of an argument or of the result is not finite.
    #[error("{array} of vertex {vertex} (body \"{body}\") is not finite")]
    NonFinite {
        /// The argument or the result.
        array: &'static str,
        /// The first such vertex.
        vertex: usize,
        /// Name of its body.
        body: String,
    },
    /// A repulsion spring is refused.
    #[error("repulsion spring {spring}: {problem}")]
    Repulsion {
        /// The spring.
        spring: usize,
        /// The reason.
        problem: &'static str,
    },
    /// A backend cannot compute a body, see [`crate::Dynamics::set_backend`].
    #[error("body \"{body}\" has {what}, which the CPU alone computes: give it {instead}")]
    OnlyOnCpu {
        /// Name of the first such body.
        body: String,
        /// What it has, see [`crate::BodyShape::only_on_cpu`].
        what: &'static str,
        /// What it needs instead.
        instead: &'static str,
    },
    /// A custom element has computed something that is not finite, at a state that the time step passed
    /// through.
    #[error("custom element {index} of \"{group}\": its {quantity} is not finite")]
    CustomElement {
        /// Name of its group.
        group: String,
        /// The index of the element in the group.
        index: usize,
        /// "energy", "gradient" or "Hessian".
        quantity: &'static str,
    },
    /// A backend cannot compute custom elements, see [`crate::Dynamics::set_backend`].
    #[error(
        "the custom elements \"{group}\" are computed by the CPU alone: remove them, or leave the dynamics \
         there"
    )]
    CustomElements {
        /// Name of the first group.
        group: String,
    },
    /// The backend has failed, see [`crate::Dynamics::set_backend`].
    #[error("{message}")]
    Backend {
        /// What it says.
        message: String,
    },
    /// A Newton iteration was asked for before [`crate::Dynamics::begin_step`].
    #[error("newton_target was called before begin_step")]
    NotBegun,
}

impl StepError {
    /// Why no device computes the dynamics of a body; None if it can.
    pub fn only_on_cpu(body: &Body) -> Option<Self> {
        let [what, instead] = body.shape.only_on_cpu()?;
        Some(Self::OnlyOnCpu { body: body.name.clone(), what, instead })
    }
}
