//! Contact constraints along the normals of faces (Harmon et al. 2008, "Robust Treatment of Simultaneous
//! Collisions"; Tang et al. 2018, "I-Cloth"): what the volume form is compared with (paper, section 4.1).
//!
//! c(x) = m . (sum_k s_k beta_k x_k) - delta, with m the triangle's unit normal, or the common normal of both
//! edges, and the weights of the closest points, all constant. Both papers linearize at a time of impact,
//! where the closest points are inside of the primitives and m is the direction between them. For a pair that
//! is only close, m may have any direction.

use bowknot_geometry::{PairKind, Point, Separation, Vector};

/// Smallest sine of the angle between two sides that have a common normal.
const MIN_SINE: f64 = 1e-6;

/// Value [m] and gradients, or `None` where there is no face and the gap form applies instead.
pub(crate) fn row(
    kind: PairKind,
    points: &[Point; 4],
    separation: &Separation,
    delta: f64,
) -> Option<(f64, [Vector; 4])> {
    let [p0, p1, p2, p3] = points;
    let (u, v) = match kind {
        PairKind::VertexTriangle => (p2 - p1, p3 - p1),
        PairKind::EdgeEdge => (p1 - p0, p3 - p2),
        PairKind::VertexVertex | PairKind::VertexEdge | PairKind::VertexHalfSpace => return None,
    };
    let normal = u.cross(&v);
    let length = normal.norm();
    if length <= MIN_SINE * u.norm() * v.norm() {
        return None;
    }
    // Points to the side that the pair is on.
    let normal = normal * (normal.dot(&separation.normal).signum() / length);
    let gradients = separation.signed_weights(kind).map(|beta| normal * beta);
    let height: f64 = gradients.iter().zip(points).map(|(g, x)| g.dot(&(x - p0))).sum();
    Some((height - delta, gradients))
}
