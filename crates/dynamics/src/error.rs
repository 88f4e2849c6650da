//! What can go wrong, each with the object and the place.

/// Why a material is refused.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MaterialError {
    /// A value must be finite and greater than zero.
    #[error("{field} = {value} {unit}: it must be a finite number greater than 0")]
    NotPositive {
        /// The field of [`crate::ClothMaterial`].
        field: &'static str,
        /// Its value.
        value: f64,
        /// Its unit.
        unit: &'static str,
    },
    /// A value must be finite and not negative.
    #[error("{field} = {value} {unit}: it must be a finite number, 0 or more")]
    Negative {
        /// The field of [`crate::ClothMaterial`].
        field: &'static str,
        /// Its value.
        value: f64,
        /// Its unit.
        unit: &'static str,
    },
    /// Poisson's ratio is outside of its stable range.
    #[error("poisson_ratio = {value}: it must lie in (-1, 1)")]
    PoissonRatio {
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
    #[error(
        "body \"{body}\": {element} {index} names vertex {vertex}, but there are only {vertex_count} vertices"
    )]
    VertexOutOfRange {
        /// Name of the body.
        body: String,
        /// "triangle" or "vertex".
        element: &'static str,
        /// Which of them.
        index: usize,
        /// The vertex that it names.
        vertex: u32,
        /// How many vertices there are.
        vertex_count: usize,
    },
    /// A triangle names a vertex twice.
    #[error("body \"{body}\": triangle {index} names vertex {vertex} twice")]
    RepeatedVertex {
        /// Name of the body.
        body: String,
        /// The triangle.
        index: usize,
        /// The vertex that it repeats.
        vertex: u32,
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
    /// Two triangles of a body have the same vertices.
    #[error("body \"{body}\": triangles {first} and {second} have the same vertices")]
    RepeatedTriangle {
        /// Name of the body.
        body: String,
        /// The one.
        first: usize,
        /// The other.
        second: usize,
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
    /// A Newton iteration was asked for before [`crate::Dynamics::begin_step`].
    #[error("newton_target was called before begin_step")]
    NotBegun,
}
