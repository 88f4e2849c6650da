//! Placements of the nodes of a scene.

use bowknot_geometry::Point;
use bowknot_geometry::nalgebra::{Matrix4, Vector3, Vector4};

/// A rotation about an axis of coordinates (0: x) by an angle [rad].
pub(crate) fn rotation(axis: usize, angle: f64) -> Matrix4<f64> {
    let (sin, cos) = libm::sincos(angle);
    let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
    let mut matrix = Matrix4::identity();
    (matrix[(i, i)], matrix[(i, j)]) = (cos, -sin);
    (matrix[(j, i)], matrix[(j, j)]) = (sin, cos);
    matrix
}

/// The rotation of a quaternion `[w, x, y, z]` of any length but 0.
pub(crate) fn rotation_of([w, x, y, z]: [f64; 4]) -> Matrix4<f64> {
    let length_squared = w * w + x * x + y * y + z * z;
    let s = if length_squared > 0.0 { 2.0 / length_squared } else { 0.0 };
    #[rustfmt::skip]
    let matrix = Matrix4::new(
        1.0 - s * (y * y + z * z), s * (x * y - z * w), s * (x * z + y * w), 0.0,
        s * (x * y + z * w), 1.0 - s * (x * x + z * z), s * (y * z - x * w), 0.0,
        s * (x * z - y * w), s * (y * z + x * w), 1.0 - s * (x * x + y * y), 0.0,
        0.0, 0.0, 0.0, 1.0,
    );
    matrix
}

/// Between two quaternions on the shorter arc, at a weight of the second (Shoemake 1985).
pub(crate) fn slerp(a: [f64; 4], b: [f64; 4], weight: f64) -> [f64; 4] {
    /// Cosines from which on the arc is taken for straight.
    const STRAIGHT: f64 = 1.0 - 1e-6;
    let (a, b) = (Vector4::from(a), Vector4::from(b));
    let cos = a.dot(&b);
    let (b, cos) = if cos < 0.0 { (-b, -cos) } else { (b, cos) };
    let (of_a, of_b) = if cos < STRAIGHT {
        let angle = libm::acos(cos);
        let sin = libm::sin(angle);
        (libm::sin((1.0 - weight) * angle) / sin, libm::sin(weight * angle) / sin)
    } else {
        (1.0 - weight, weight)
    };
    (a * of_a + b * of_b).into()
}

/// A scaling along the axes.
pub(crate) fn scaling([x, y, z]: [f64; 3]) -> Matrix4<f64> {
    Matrix4::new_nonuniform_scaling(&Vector3::new(x, y, z))
}

/// A translation.
pub(crate) fn translation([x, y, z]: [f64; 3]) -> Matrix4<f64> {
    Matrix4::new_translation(&Vector3::new(x, y, z))
}

/// Moves points; an identity leaves every bit as it is.
pub(crate) fn place(matrix: &Matrix4<f64>, points: &mut [Point]) {
    if *matrix != Matrix4::identity() {
        let (linear, offset) = (matrix.fixed_view::<3, 3>(0, 0), matrix.fixed_view::<3, 1>(0, 3));
        points.iter_mut().for_each(|point| *point = Point::from(linear * point.coords + offset));
    }
}
