//! What can go wrong, each with the object and the place.

use bowknot_geometry::VertexOutOfRange;

/// Why a material is refused.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MaterialError {
    /// A value must be finite and greater than zero.
    #[error("{field} = {value} {unit}: it must be a finite number greater than 0")]
    NotPositive {
        /// The field of the material.
        field: &'static str,
        /// Its value.
        value: f64,
        /// Its unit.
        unit: &'static str,
    },
    /// A value must be finite and not negative.
    #[error("{field} = {value} {unit}: it must be a finite number, 0 or more")]
    Negative {
        /// The field of the material.
        field: &'static str,
        /// Its value.
        value: f64,
        /// Its unit.
        unit: &'static str,
    },
    /// Poisson's ratio is outside of its stable range.
    #[error("poisson_ratio = {value}: it must lie in {range}")]
    PoissonRatio {
        /// Its value.
        value: f64,
        /// Where it must lie.
        range: &'static str,
    },
    /// A stretch limit leaves an edge no room.
    #[error("stretch_limit = {value}: it must be above 1, or inf for no limit")]
    StretchLimit {
        /// Its value.
        value: f64,
    },
}

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
        /// Which of them.
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
        /// The one.
        first: usize,
        /// The other.
        second: usize,
    },
    /// A triangle has no area at rest, so it has neither mass nor a rest shape.
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
        "body \"{body}\": edge {index} has no length at rest, vertices {a} and {b} are at one place: merge them"
    )]
    ZeroLength {
        /// Name of the body.
        body: String,
        /// The edge.
        index: usize,
        /// Its one vertex.
        a: u32,
        /// Its other vertex.
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
        /// How many tets it has.
        tets: usize,
        /// Tets of negative volume.
        inverted: Vec<usize>,
        /// Tets of no volume.
        flat: Vec<usize>,
    },
    /// The warp direction is normal to triangles, so that it has no projection there.
    #[error(
        "body \"{body}\": warp_direction is normal to {} of its triangles{}: choose a direction along the cloth",
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
    /// A vertex belongs to no body, so it has no mass.
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
    /// A material is refused.
    #[error("body \"{body}\": {error}")]
    Material {
        /// Name of the body.
        body: String,
        /// What is wrong with it.
        error: MaterialError,
    },
}

/// " (3, 17, ..)", or nothing.
fn first_ten(indices: &[usize]) -> String {
    if indices.is_empty() {
        return String::new();
    }
    let shown: Vec<String> = indices.iter().take(10).map(ToString::to_string).collect();
    let more = if indices.len() > shown.len() { ", .." } else { "" };
    format!(" ({}{more})", shown.join(", "))
}

/// Why [`crate::DynamicsParams`] are refused.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{field} = {value}: {allowed}")]
pub struct ParamsError {
    /// The field of [`crate::DynamicsParams`].
    pub field: &'static str,
    /// Its value.
    pub value: f64,
    /// What is allowed.
    pub allowed: &'static str,
}

/// Why a step cannot be made.
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
    /// An entry is not finite.
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
        /// What is wrong with it.
        problem: &'static str,
    },
    /// A Newton iteration was asked for before [`crate::Dynamics::begin_step`].
    #[error("newton_target was called before begin_step")]
    NotBegun,
}
