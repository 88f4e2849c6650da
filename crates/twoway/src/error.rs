//! Why a call is refused.

use bowknot_check::{CheckError, Intersection};
use bowknot_errors::{Errors, ParamError};

/// Why a scene or a call is refused. The positions are unchanged then.
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
        /// "the position", "the target" and the like.
        what: &'static str,
        /// The vertex.
        vertex: usize,
        /// Its body.
        body: u32,
    },
    /// A time step that is not finite or not above 0.
    #[error("the time step is {0} s; it must be finite and above 0")]
    TimeStep(f64),
    /// The start intersects. Only debug builds look, see [`crate::Resolver::detect_intersections`].
    #[error(
        "{count} pairs intersect at the start, the first: {first}; the start must be free of intersections, \
         which `Resolver::detect_intersections` tells"
    )]
    StartIntersects {
        /// How many pairs intersect.
        count: usize,
        /// The first of them.
        first: Box<Intersection>,
    },
    /// The start cannot be judged. Only debug builds look.
    #[error("the start: {0}")]
    Unjudged(CheckError),
    /// A deformable vertex has no mass.
    #[error(
        "vertex {vertex} (body {body}) has mass {mass}; masses of deformable vertices must be finite and \
         above 0; to pin \
         a vertex, give it its mass and name it in `ResolveInput::prescribed`"
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
    #[error("contact data out of range:\n{0}")]
    Contact(Errors<ParamError>),
    /// Parameters out of their range.
    #[error("parameters out of range:\n{0}")]
    Params(Errors<ParamError>),
    /// More rows than indices of 32 bits can number.
    #[error(
        "{pairs} pairs within contact range and {edges} edges: together at most {limit} are possible; use a \
         shorter contact distance (contact.delta, contact.range) or fewer elements"
    )]
    TooManyRows {
        /// Pairs within contact range.
        pairs: usize,
        /// Edges of all meshes.
        edges: usize,
        /// The largest sum of both.
        limit: usize,
    },
    /// Coordinates so large that their rounding exceeds the minimum separation.
    #[error(
        "the minimum separation of {min_separation:.3e} m is below 16 ulp of the largest coordinate \
         ({coordinate:.3e} m, {what} of vertex {vertex}): if the dynamics has not diverged, move the scene \
         closer to the origin, or raise contact.min_separation above {needed:.3e} m"
    )]
    MinSeparationBelowRounding {
        /// The minimum separation [m].
        min_separation: f64,
        /// "the position" or "the target".
        what: &'static str,
        /// The largest coordinate [m].
        coordinate: f64,
        /// The vertex that has it.
        vertex: usize,
        /// The smallest minimum separation allowed [m].
        needed: f64,
    },
}
