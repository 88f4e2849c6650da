//! The kinds of pairs of primitives, and the layout of their vertices.

#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

/// The kinds of pairs of primitives between which distances are measured.
///
/// Every pair kind lists its vertices in an array of four: first those of side *a*, then those of side *b*.
/// Unused places have no meaning. The signs of gradients follow: moving a vertex of side *a* along the normal
/// opens the gap, moving one of side *b* closes it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
#[repr(u8)]
pub enum PairKind {
    /// Two particles: `[a | b]`.
    VertexVertex = 0,
    /// A particle and a strand edge: `[a | b0, b1]`.
    VertexEdge = 1,
    /// A vertex and a triangle: `[a | b0, b1, b2]`.
    VertexTriangle = 2,
    /// Two edges: `[a0, a1 | b0, b1]`.
    EdgeEdge = 3,
    /// A vertex and an immovable analytic half-space: `[a |]`.
    VertexHalfSpace = 4,
}

impl PairKind {
    /// All kinds, in the order of pair lists.
    pub const ALL: [PairKind; 5] = [
        PairKind::VertexVertex,
        PairKind::VertexEdge,
        PairKind::VertexTriangle,
        PairKind::EdgeEdge,
        PairKind::VertexHalfSpace,
    ];

    /// Number of vertices on side *a*.
    #[inline]
    pub const fn side_a(self) -> usize {
        if matches!(self, PairKind::EdgeEdge) { 2 } else { 1 }
    }

    /// Number of vertices on both sides together.
    #[inline]
    pub const fn vertex_count(self) -> usize {
        match self {
            PairKind::VertexHalfSpace => 1,
            PairKind::VertexVertex => 2,
            PairKind::VertexEdge => 3,
            PairKind::VertexTriangle | PairKind::EdgeEdge => 4,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kinds_are_numbered_in_order_and_know_their_vertices() {
        for (i, kind) in PairKind::ALL.into_iter().enumerate() {
            assert_eq!(kind as usize, i);
            assert!((1..kind.vertex_count().max(2)).contains(&kind.side_a()));
        }
        assert_eq!(PairKind::ALL.map(PairKind::vertex_count), [2, 3, 4, 4, 1]);
        assert_eq!(PairKind::ALL.map(PairKind::side_a), [1, 1, 1, 2, 1]);
    }

    #[test]
    fn names_are_stable_in_files() {
        let names = PairKind::ALL.map(|kind| serde_json::to_string(&kind).unwrap());
        let expected = ["vertex-vertex", "vertex-edge", "vertex-triangle", "edge-edge", "vertex-half-space"];
        assert_eq!(names, expected.map(|name| format!("{name:?}")));
    }
}
