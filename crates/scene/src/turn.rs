//! Rotations with the sines of `libm`. Those of nalgebra come from the system: on Linux they depend on the
//! version of its library, and on whether the processor has fused multiply-add.

use bowknot_geometry::Vector;
use nalgebra::{Matrix3, Quaternion, Rotation3, Unit, UnitQuaternion};

/// About an axis by an angle [rad].
pub(crate) fn about_axis(axis: &Unit<Vector>, angle: f64) -> Rotation3<f64> {
    if angle == 0.0 {
        return Rotation3::identity();
    }
    let (x, y, z) = (axis.x, axis.y, axis.z);
    let (sin, cos) = libm::sincos(angle);
    let rest = 1.0 - cos;
    Rotation3::from_matrix_unchecked(Matrix3::new(
        x * x + (1.0 - x * x) * cos,
        x * y * rest - z * sin,
        x * z * rest + y * sin,
        x * y * rest + z * sin,
        y * y + (1.0 - y * y) * cos,
        y * z * rest - x * sin,
        x * z * rest - y * sin,
        y * z * rest + x * sin,
        z * z + (1.0 - z * z) * cos,
    ))
}

/// About an axis by its length [rad].
pub(crate) fn about(axis: &Vector) -> Rotation3<f64> {
    match Unit::try_new_and_get(*axis, 0.0) {
        Some((axis, angle)) => about_axis(&axis, angle),
        None => Rotation3::identity(),
    }
}

/// About the x, then the y, then the z axis [rad].
pub(crate) fn euler(x: f64, y: f64, z: f64) -> Rotation3<f64> {
    let ((sx, cx), (sy, cy), (sz, cz)) = (libm::sincos(x), libm::sincos(y), libm::sincos(z));
    Rotation3::from_matrix_unchecked(Matrix3::new(
        cz * cy,
        cz * sy * sx - sz * cx,
        cz * sy * cx + sz * sx,
        sz * cy,
        sz * sy * sx + cz * cx,
        sz * sy * cx - cz * sx,
        -sy,
        cy * sx,
        cy * cx,
    ))
}

/// About an axis by an angle [rad], as a quaternion.
pub(crate) fn quaternion(axis: &Unit<Vector>, angle: f64) -> UnitQuaternion<f64> {
    let (sin, cos) = libm::sincos(0.5 * angle);
    UnitQuaternion::new_unchecked(Quaternion::from_parts(cos, axis.as_ref() * sin))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rotations_are_those_of_nalgebra() {
        let axis = Unit::new_normalize(Vector::new(0.3, -0.7, 0.2));
        for angle in [-7.0, -0.4, 0.0, 1e-9, 0.3, 2.0] {
            let near = |a: Rotation3<f64>, b: Rotation3<f64>| (a.matrix() - b.matrix()).amax() < 1e-15;
            assert!(near(about_axis(&axis, angle), Rotation3::from_axis_angle(&axis, angle)), "{angle}");
            assert!(near(about(&(axis.as_ref() * angle)), Rotation3::new(axis.as_ref() * angle)), "{angle}");
            assert!(near(euler(angle, 0.4, -1.0), Rotation3::from_euler_angles(angle, 0.4, -1.0)), "{angle}");
            let (ours, theirs) = (quaternion(&axis, angle), UnitQuaternion::from_axis_angle(&axis, angle));
            assert!((ours.coords - theirs.coords).amax() < 1e-15, "{angle}");
        }
        assert_eq!(about(&Vector::zeros()), Rotation3::identity());
    }
}
