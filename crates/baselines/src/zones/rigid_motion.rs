//! Motions that cause no intersections: the straight paths are those of an affine map that can be inverted at
//! any time on the way.

use bowknot_twoway::geometry::{Point, Vector};
use nalgebra::{Matrix3, SymmetricEigen};

/// A moment of inertia below this share of the largest one counts as 0: vertices on a line.
const DEGENERATE: f64 = 1e-12;
/// Largest distance of keyframes from a rigid motion, relative to the extent of their vertices and their
/// travel.
const RIGID: f64 = 1e-6;

/// How a zone moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Motion {
    /// No motion.
    Rest,
    /// d = v + omega x (x - center), the velocities of a rigid body (Bridson et al. 2002). The paths are
    /// those of the map 1 + s \[omega\], whose determinant 1 + s^2 |omega|^2 never vanishes. It stretches by
    /// sqrt(1 + omega^2), as theirs.
    Twist { center: Vector, linear: Vector, angular: Vector },
    /// x -> to + R (x - from), the motion of keyframes. The paths are those of (1 - s) + s R, which can be
    /// inverted for any rotation by less than half a turn.
    Rigid { from: Vector, to: Vector, rotation: Matrix3<f64> },
}

impl Motion {
    /// The displacement of a vertex at `x` [m].
    pub(crate) fn displacement(&self, x: &Point) -> Vector {
        match self {
            Motion::Rest => Vector::zeros(),
            Motion::Twist { center, linear, angular } => linear + angular.cross(&(x.coords - center)),
            Motion::Rigid { from, to, rotation } => {
                let r = x.coords - from;
                (to - from) + (rotation * r - r)
            }
        }
    }

    /// The motion that keeps the linear and angular momentum of vertices: position, desired path, and mass in
    /// any unit.
    pub(crate) fn keeping_momentum(vertices: &[(Point, Vector, f64)]) -> Self {
        let total: f64 = vertices.iter().map(|(_, _, m)| m).sum();
        if total <= 0.0 {
            return Motion::Rest;
        }
        let mean = |value: &dyn Fn(&(Point, Vector, f64)) -> Vector| {
            vertices.iter().fold(Vector::zeros(), |sum, v| sum + v.2 * value(v)) / total
        };
        let (center, linear) = (mean(&|v| v.0.coords), mean(&|v| v.1));
        let mut momentum = Vector::zeros();
        let mut inertia = Matrix3::zeros();
        for (x, path, mass) in vertices {
            let r = x.coords - center;
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
        Motion::Twist { center, linear, angular }
    }

    /// The rigid motion that moves vertices along the paths of their keyframes (Kabsch 1976); `None` if there
    /// is none. Fewer than three vertices, or vertices on a line, move without turning.
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
mod tests;
