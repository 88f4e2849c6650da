//! Exact intersection tests on `robust`'s predicates.

use crate::Point;

/// Whether the closed segment `edge` and the closed triangle `triangle` share a point, decided
/// exactly. Touching and coplanar overlap count as intersecting.
pub fn edge_triangle(edge: [&Point; 2], triangle: [&Point; 3]) -> bool {
    todo!("{edge:?} {triangle:?}")
}
