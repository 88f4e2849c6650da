//! Certified separation: a direction and a slab width that never exceeds the true distance.

use crate::{HalfSpace, PairKind, Point, Vector};

/// A pair's contact geometry, with a certified lower bound of its distance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Separation {
    /// Unit direction (to rounding) from side *b* to side *a*.
    pub normal: Vector,
    /// Barycentric weights of the closest points, see [`crate::Closest::weights`].
    pub weights: [f64; 4],
    /// Computed distance of the closest points [m]; may be slightly off in either direction.
    pub distance: f64,
    /// Certified width of the slab between the sides along `normal` [m]: in exact arithmetic
    /// min over side a of n.x - max over side b of n.x is at least `width` for a unit n parallel
    /// to `normal`, hence the true distance is too. May be negative where no direction certifies.
    pub width: f64,
}

/// Contact geometry of any pair kind but [`PairKind::VertexHalfSpace`]; unused points are ignored.
pub fn separate(kind: PairKind, points: &[Point; 4]) -> Separation {
    todo!("{kind:?} {points:?}")
}

/// Contact geometry of a vertex above a half-space.
pub fn separate_half_space(point: &Point, half_space: &HalfSpace) -> Separation {
    todo!("{point:?} {half_space:?}")
}
