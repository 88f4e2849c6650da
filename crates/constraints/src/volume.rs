//! The volume form of contact constraints (paper, Eq. 14-16).
//!
//! The paper asks for V(x) >= V(r), with r the positions after pushing the pair apart along the normal n to
//! the contact distance. V(r)/V(x) = delta/d holds exactly, because the closest points lie on the primitives.
//! Dividing by the area |N| of the base at the linearization point gives a length, so that multipliers keep
//! their meaning from one linearization to the next:
//!
//! c(x) = (6 V(x) - 6 V(r)) / |N|, hence at the linearization point c = (6|V|/|N|) (1 - delta/d).
//!
//! - vertex-triangle: 6V = (x_a - x_i) . N, N = (x_j - x_i) x (x_k - x_i);
//! - edge-edge: 6V = (x_0 - x_2) . N, N = (x_1 - x_0) x (x_3 - x_2);
//! - vertex-edge: the area 2A = |(x_a - x_0) x e| over |e|, e = x_1 - x_0;
//! - vertex-vertex: the length, which is the gap form.
//!
//! Where the closest feature is not the interior, d differs from the height above the base, and the
//! constraint would block motion beside the primitive. The gap form applies there instead, see [`row`].

use bowknot_geometry::{PairKind, Point, Separation, Vector};

/// Smallest |n . N| / |N| at which the volume form is used.
const MIN_ALIGNMENT: f64 = 0.3;
/// Smallest sine of the angle between two edges at which the volume form is used.
const MIN_SINE: f64 = 0.05;

/// Value [m] and gradients of the volume form, or `None` where the gap form applies instead.
pub(crate) fn row(
    kind: PairKind,
    points: &[Point; 4],
    separation: &Separation,
    delta: f64,
) -> Option<(f64, [Vector; 4])> {
    let d = separation.distance;
    if d <= 0.0 {
        return None;
    }
    let (volume, base, mut gradients, normal) = match kind {
        PairKind::VertexTriangle => {
            let [a, i, j, k] = points;
            let (r, u, v) = (a - i, j - i, k - i);
            let n = u.cross(&v);
            let (gj, gk) = (v.cross(&r), r.cross(&u));
            (r.dot(&n), n.norm(), [n, -(n + gj + gk), gj, gk], n)
        }
        PairKind::EdgeEdge => {
            let [x0, x1, x2, x3] = points;
            let (r, u, v) = (x0 - x2, x1 - x0, x3 - x2);
            let n = u.cross(&v);
            if n.norm() < MIN_SINE * u.norm() * v.norm() {
                return None;
            }
            let (g1, g3) = (v.cross(&r), r.cross(&u));
            (r.dot(&n), n.norm(), [n - g1, g1, -n - g3, g3], n)
        }
        PairKind::VertexEdge => {
            let [a, x0, x1, _] = points;
            let (r, e) = (a - x0, x1 - x0);
            let c = r.cross(&e);
            let area = c.norm();
            if area == 0.0 {
                return None;
            }
            let m = c / area;
            let (ga, g1) = (e.cross(&m), m.cross(&r));
            (area, e.norm(), [ga, -(ga + g1), g1, Vector::zeros()], ga)
        }
        PairKind::VertexVertex | PairKind::VertexHalfSpace => return None,
    };
    if base <= 0.0 || separation.normal.dot(&normal).abs() < MIN_ALIGNMENT * normal.norm() {
        return None;
    }
    let scale = volume.signum() / base;
    gradients.iter_mut().for_each(|g| *g *= scale);
    Some((volume.abs() / base * (1.0 - delta / d), gradients))
}
