//! Friction rows: the slip of a contact along its two tangents since the start of the time step,
//! u = T^T sum_k s_k beta_k (y_k - start_k), s_k = +1 on side a and -1 on side b.
//!
//! Coulomb's law at the level of positions bounds the multiplier along the slip by mu times the normal's:
//! over a time step dt the slip is dt times the relative velocity at its end (implicit Euler). The weights
//! are those of the closest points at the linearization point. The motion of every vertex of the pair counts,
//! prescribed or not, so a moving obstacle drags what it touches.

use bowknot_geometry::{PairKind, Point, Separation, Vector};
use bowknot_lcp::FrictionRow;

/// The friction row of one pair with coefficient `friction` [1]; its normal's row has index `normal`.
pub(crate) fn friction_row(
    kind: PairKind,
    vertices: [u32; 4],
    start: &[Point],
    separation: &Separation,
    friction: f64,
    normal: u32,
) -> FrictionRow {
    let coefficients = separation.signed_weights(kind);
    let tangents = tangents(&separation.normal);
    let origin = vertices
        .iter()
        .zip(&coefficients)
        .fold(Vector::zeros(), |sum, (&v, beta)| sum + *beta * start[v as usize].coords);
    FrictionRow {
        tangents,
        coefficients,
        offsets: [-tangents[0].dot(&origin), -tangents[1].dot(&origin)],
        vertices,
        friction,
        inverse_diagonal: f64::NAN,
        normal,
    }
}

/// Two unit vectors that form a right-handed frame with the unit `normal`.
pub fn tangents(normal: &Vector) -> [Vector; 2] {
    // The coordinate axis with the smallest component along the normal: its part across is at least sqrt(2/3)
    // long.
    let axis = Vector::ith(normal.iamin(), 1.0);
    let first = (axis - *normal * normal.dot(&axis)).normalize();
    [first, normal.cross(&first)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use bowknot_geometry::separation;

    #[test]
    fn slip_is_the_tangential_motion_of_the_closest_points_since_the_start() {
        let start = [
            Point::new(0.2, 0.3, 0.1),
            Point::new(0.0, 0.0, 0.0),
            Point::new(1.0, 0.0, 0.0),
            Point::new(0.0, 1.0, 0.0),
        ];
        let kind = PairKind::VertexTriangle;
        let separation = separation::separate(kind, &start);
        let row = friction_row(kind, [0, 1, 2, 3], &start, &separation, 0.3, 7);
        assert_eq!((row.friction, row.normal), (0.3, 7));
        let at = |moves: [Vector; 4]| {
            let y: Vec<Vector> = start.iter().zip(moves).map(|(x, d)| x.coords + d).collect();
            let slip = row.slip(&y);
            row.direction(slip)
        };
        let (along, up) = (Vector::new(0.03, -0.04, 0.0), 0.5 * Vector::z());
        assert!(at([Vector::zeros(); 4]).norm() < 1e-15);
        // Common motion is no slip, and neither is motion along the normal.
        assert!(at([along; 4]).norm() < 1e-15);
        let only_a = [along + up, Vector::zeros(), Vector::zeros(), Vector::zeros()];
        assert!((at(only_a) - along).norm() < 1e-15);
        // A corner of the triangle counts with its weight and the opposite sign.
        let corner = at([Vector::zeros(), along, Vector::zeros(), Vector::zeros()]);
        assert!((corner + 0.5 * along).norm() < 1e-15, "{corner}");
    }

    #[test]
    fn tangents_and_normal_are_a_right_handed_frame_in_all_directions() {
        for k in 0..200 {
            let angle = f64::from(k);
            let normal = Vector::new(angle.sin(), (1.7 * angle).cos(), (0.3 * angle).sin() - 0.2).normalize();
            let [t, b] = tangents(&normal);
            assert!((t.norm() - 1.0).abs() < 1e-14 && t.dot(&normal).abs() < 1e-14);
            assert!((b - normal.cross(&t)).norm() < 1e-14 && (t.cross(&b) - normal).norm() < 1e-14);
        }
    }
}
