//! Why a call is refused.

/// Why a call is refused; the positions are then unchanged.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ResolveError {
    /// A slice has the wrong length.
    #[error("{what} has {given} entries for {vertices} vertices")]
    Length {
        /// Which slice.
        what: &'static str,
        /// Its length.
        given: usize,
        /// The number of vertices.
        vertices: usize,
    },
    /// A coordinate is NaN or infinite.
    #[error("{what} of vertex {vertex} (body {body}) is not finite")]
    NonFinite {
        /// "the position" or "the target".
        what: &'static str,
        /// The vertex.
        vertex: usize,
        /// Its body.
        body: u32,
    },
    /// A deformable vertex has no mass.
    #[error(
        "vertex {vertex} (body {body}) has mass {mass}; masses of deformable vertices must be finite and above 0"
    )]
    Mass {
        /// The vertex.
        vertex: usize,
        /// Its body.
        body: u32,
        /// The mass given [kg].
        mass: f64,
    },
    /// Contact data of bodies, half-spaces or pairs out of their range.
    #[error("contact data out of range: {}", .0.join("; "))]
    Contact(Vec<String>),
    /// Parameters out of their range.
    #[error("parameters out of range: {}", .0.join("; "))]
    Params(Vec<String>),
    /// Coordinates so large that the floor drowns in rounding.
    #[error(
        "the gap floor of {floor:.3e} m is below 16 ulp of the largest coordinate ({coordinate:.3e} m, vertex {vertex}): \
         move the scene nearer to the origin, or raise stepper.floor above {needed:.3e} m"
    )]
    FloorBelowRounding {
        /// The floor [m].
        floor: f64,
        /// The largest coordinate [m].
        coordinate: f64,
        /// The vertex that has it.
        vertex: usize,
        /// The smallest floor allowed [m].
        needed: f64,
    },
}
