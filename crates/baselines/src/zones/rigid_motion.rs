//! Motions that keep what is free of intersections free of them: the straight paths are those of an affine map that can be
//! inverted at any time on the way.

use bowknot_twoway::geometry::{Point, Vector};
use nalgebra::{Matrix3, SymmetricEigen};

/// Share of the largest moment of inertia below which one counts as none: vertices on a line.
const DEGENERATE: f64 = 1e-12;
/// How far keyframes may be from a rigid motion, relative to the extent of what they move.
const RIGID: f64 = 1e-6;

/// How a zone moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Motion {
    /// Not at all.
    Rest,
    /// d = v + omega x (x - centre), the velocities of a rigid body (Bridson et al. 2002). The paths are those of the map
    /// 1 + s \[omega\], whose determinant 1 + s^2 |omega|^2 never vanishes. It stretches by sqrt(1 + omega^2), as theirs.
    Twist { centre: Vector, linear: Vector, angular: Vector },
    /// x -> to + R (x - from): that of keyframes. The paths are those of (1 - s) + s R, which can be inverted for any
    /// rotation by less than half a turn.
    Rigid { from: Vector, to: Vector, rotation: Matrix3<f64> },
}

impl Motion {
    /// The displacement of a vertex at `x` [m].
    pub(crate) fn displacement(&self, x: &Point) -> Vector {
        match self {
            Motion::Rest => Vector::zeros(),
            Motion::Twist { centre, linear, angular } => linear + angular.cross(&(x.coords - centre)),
            Motion::Rigid { from, to, rotation } => {
                let r = x.coords - from;
                (to - from) + (rotation * r - r)
            }
        }
    }

    /// The motion that keeps the linear and angular momentum of vertices at `x` that want to move along `paths`; masses
    /// in any unit.
    pub(crate) fn keeping_momentum(vertices: &[(Point, Vector, f64)]) -> Self {
        let total: f64 = vertices.iter().map(|(_, _, m)| m).sum();
        if total <= 0.0 {
            return Motion::Rest;
        }
        let mean = |value: &dyn Fn(&(Point, Vector, f64)) -> Vector| {
            vertices.iter().fold(Vector::zeros(), |sum, v| sum + v.2 * value(v)) / total
        };
        let (centre, linear) = (mean(&|v| v.0.coords), mean(&|v| v.1));
        let mut momentum = Vector::zeros();
        let mut inertia = Matrix3::zeros();
        for (x, path, mass) in vertices {
            let r = x.coords - centre;
            momentum += *mass * r.cross(&(path - linear));
            inertia += *mass * (Matrix3::identity() * r.norm_squared() - r * r.transpose());
        }
        let eigen = SymmetricEigen::new(inertia);
        let largest = eigen.eigenvalues.amax();
        let angular = (0..3).filter(|&k| eigen.eigenvalues[k] > DEGENERATE * largest).fold(
            Vector::zeros(),
            |sum, k| {
                let axis = eigen.eigenvectors.column(k).into_owned();
                sum + axis * (axis.dot(&momentum) / eigen.eigenvalues[k])
            },
        );
        Motion::Twist { centre, linear, angular }
    }

    /// The rigid motion by which vertices at `x` follow `paths`, which are keyframes; `None` if they follow none.
    /// Fewer than three vertices, or such on a line, are only taken along without turning. (Kabsch 1976.)
    pub(crate) fn following(vertices: &[(Point, Vector, f64)]) -> Option<Self> {
        let count = vertices.len() as f64;
        let from = vertices.iter().fold(Vector::zeros(), |sum, v| sum + v.0.coords) / count;
        let travel = vertices.iter().fold(Vector::zeros(), |sum, v| sum + v.1) / count;
        let extent = vertices.iter().map(|v| (v.0.coords - from).norm()).fold(0.0, f64::max);
        let tolerance = RIGID * (extent + travel.norm());
        let follows = |motion: Motion| {
            let off = |v: &(Point, Vector, f64)| (motion.displacement(&v.0) - v.1).norm();
            (vertices.iter().map(off).fold(0.0, f64::max) <= tolerance).then_some(motion)
        };
        if travel == Vector::zeros() && vertices.iter().all(|v| v.1 == travel) {
            return Some(Motion::Rest);
        }
        let straight = Motion::Rigid { from, to: from + travel, rotation: Matrix3::identity() };
        follows(straight).or_else(|| {
            let mut covariance = Matrix3::zeros();
            for (x, path, _) in vertices {
                covariance += (x.coords + path - from - travel) * (x.coords - from).transpose();
            }
            let svd = covariance.svd(true, true);
            let (u, v_t) = (svd.u?, svd.v_t?);
            let mut flip = Matrix3::identity();
            flip[(2, 2)] = (u * v_t).determinant().signum();
            let rotation = u * flip * v_t;
            // Less than half a turn, with a margin: cos of the angle is (trace - 1)/2.
            (rotation.trace() > -0.9).then_some(())?;
            follows(Motion::Rigid { from, to: from + travel, rotation })
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Rotation3;

    fn body() -> Vec<Point> {
        [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.2, 0.9, 0.1], [0.5, -0.3, 0.7]].map(Point::from).to_vec()
    }

    fn momenta(vertices: &[(Point, Vector, f64)]) -> (Vector, Vector) {
        let linear = vertices.iter().fold(Vector::zeros(), |sum, (_, d, m)| sum + d * *m);
        let angular = vertices.iter().fold(Vector::zeros(), |sum, (x, d, m)| sum + x.coords.cross(d) * *m);
        (linear, angular)
    }

    #[test]
    fn a_free_zone_keeps_both_momenta_and_turns_like_a_rigid_body() {
        let wanted: Vec<(Point, Vector, f64)> = body()
            .into_iter()
            .zip([[0.1, 0.0, 0.3], [-0.2, 0.1, 0.0], [0.0, 0.0, -0.4], [0.1, 0.2, 0.1]])
            .zip([1.0, 2.0, 0.5, 1.5])
            .map(|((x, d), m)| (x, Vector::from(d), m))
            .collect();
        let motion = Motion::keeping_momentum(&wanted);
        let moved: Vec<_> = wanted.iter().map(|(x, _, m)| (*x, motion.displacement(x), *m)).collect();
        let ((p, l), (p_after, l_after)) = (momenta(&wanted), momenta(&moved));
        assert!((p - p_after).norm() < 1e-14 && (l - l_after).norm() < 1e-14);
        // Velocities of a rigid body change no distance at first order.
        for (a, da, _) in &moved {
            for (b, db, _) in &moved {
                assert!((a - b).dot(&(da - db)).abs() < 1e-14);
            }
        }
    }

    #[test]
    fn two_vertices_on_a_line_keep_their_momenta_too() {
        let wanted = [
            (Point::origin(), Vector::new(0.0, 0.0, 1.0), 1.0),
            (Point::new(1.0, 0.0, 0.0), Vector::new(0.5, 0.0, -1.0), 3.0),
        ];
        let motion = Motion::keeping_momentum(&wanted);
        let moved = wanted.map(|(x, _, m)| (x, motion.displacement(&x), m));
        let ((p, l), (p_after, l_after)) = (momenta(&wanted), momenta(&moved));
        assert!((p - p_after).norm() < 1e-14 && (l - l_after).norm() < 1e-14, "{l:?} {l_after:?}");
    }

    #[test]
    fn keyframes_that_are_rigid_are_followed_and_others_are_not() {
        let rotation = Rotation3::from_axis_angle(&Vector::z_axis(), 1.2);
        let frame = |x: &Point| rotation * x + Vector::new(0.3, -2.0, 0.0);
        let mut vertices: Vec<_> = body().into_iter().map(|x| (x, frame(&x) - x, 1.0)).collect();
        let motion = Motion::following(&vertices).unwrap();
        let elsewhere = Point::new(3.0, 1.0, -2.0);
        assert!((motion.displacement(&elsewhere) - (frame(&elsewhere) - elsewhere)).norm() < 1e-12);
        // One that moves on its own.
        vertices[2].1 += Vector::new(0.0, 0.0, 1e-3);
        assert_eq!(Motion::following(&vertices), None);
        // At rest; and one vertex alone, which is taken along.
        vertices.iter_mut().for_each(|v| v.1 = Vector::zeros());
        assert_eq!(Motion::following(&vertices), Some(Motion::Rest));
        let alone = Motion::following(&[(elsewhere, Vector::x(), 1.0)]).unwrap();
        assert!((alone.displacement(&Point::origin()) - Vector::x()).norm() < 1e-15);
        // Half a turn has no straight path without a collapse.
        let half = Rotation3::from_axis_angle(&Vector::z_axis(), std::f64::consts::PI);
        let turned: Vec<_> = body().into_iter().map(|x| (x, half * x - x, 1.0)).collect();
        assert_eq!(Motion::following(&turned), None);
    }
}
