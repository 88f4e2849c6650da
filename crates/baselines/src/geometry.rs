//! Contact geometry of one pair at any positions.

use bowknot_twoway::geometry::{HalfSpace, PairKind, Point, Separation, separation};

/// Contact geometry of the pair with these vertices at `x`; `half_space` is the index of the half-space of a
/// [`PairKind::VertexHalfSpace`].
pub fn separation(
    kind: PairKind,
    vertices: &[u32; 4],
    half_space: u32,
    x: &[Point],
    half_spaces: &[HalfSpace],
) -> Separation {
    match kind {
        PairKind::VertexHalfSpace => {
            separation::separate_half_space(&x[vertices[0] as usize], &half_spaces[half_space as usize])
        }
        _ => separation::separate(kind, &vertices.map(|v| x[v as usize])),
    }
}
