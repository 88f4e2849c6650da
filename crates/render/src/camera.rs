//! The camera, and the fit that finds where it must stand to see everything.

use crate::RenderError;
use bowknot_geometry::{Point, Vector};

/// A direction to look from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum View {
    /// From -y, nearly level.
    Front,
    /// From +x, nearly level.
    Side,
    /// From above, with +y up in the picture.
    Top,
    /// From the left in front, and above.
    #[default]
    ThreeQuarter,
}

impl View {
    /// Unit vector from the target to the eye.
    pub fn direction(self) -> Vector {
        match self {
            // Not quite level: a ground that is seen edge-on would show no shadows.
            Self::Front => Vector::new(0.0, -1.0, 0.07),
            Self::Side => Vector::new(1.0, 0.0, 0.07),
            Self::Top => Vector::z(),
            Self::ThreeQuarter => Vector::new(-0.62, -1.0, 0.62),
        }
        .normalize()
    }
}

/// A perspective camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Position of the eye [m].
    pub eye: Point,
    /// The point that it looks at [m].
    pub target: Point,
    /// Vertical field of view [deg].
    pub fov: f64,
}

/// Default vertical field of view [deg]: that of a long lens, which distorts proportions little.
pub const DEFAULT_FOV: f64 = 26.0;

/// Share of the picture that [`Fit`] leaves free on each side.
const MARGIN: f64 = 0.07;

impl Camera {
    /// The camera's axes: right, up, and back (from the target to the eye).
    ///
    /// # Errors
    /// The eye is at the target, or a coordinate is not finite.
    pub fn axes(&self) -> Result<[Vector; 3], RenderError> {
        let back = self.eye - self.target;
        let length = back.norm();
        if length.is_finite() && length > 0.0 {
            Ok(axes(&(back / length)))
        } else {
            Err(RenderError::CameraAtTarget(self.target.coords.into()))
        }
    }
}

/// Right, up and back, given the unit vector back. The vertical is z, unless the camera looks along z.
pub(crate) fn axes(back: &Vector) -> [Vector; 3] {
    let vertical = if back.z.abs() < 0.999 { Vector::z() } else { Vector::y() };
    let right = vertical.cross(back).normalize();
    [right, back.cross(&right), *back]
}

/// Finds the nearest eye, in a given direction, that sees all points.
///
/// Each side of the view is a plane through the eye e. With t the tangent of half the angle of view, the left
/// and right planes demand x + t z <= e_x + t e_z and -x + t z <= -e_x + t e_z of each point, where x points
/// right and z back. So the largest x + t z and the largest -x + t z of all points give e_x and the smallest
/// e_z. The height works likewise. The fit therefore keeps four numbers and no points.
#[derive(Clone, Debug)]
pub struct Fit {
    axes: [Vector; 3],
    fov: f64,
    /// Tangents of half the angles of view, horizontal and vertical, reduced by the margin.
    tangents: [f64; 2],
    /// Largest x + t z, -x + t z, y + t z, -y + t z so far [m].
    largest: [f64; 4],
    /// Range of z [m].
    depth: [f64; 2],
}

impl Fit {
    /// A fit for a view, a vertical field of view [deg] and a picture `aspect` times as wide as high.
    pub fn new(view: View, fov: f64, aspect: f64) -> Self {
        let tangent = (fov.to_radians() / 2.0).tan() * (1.0 - 2.0 * MARGIN);
        Self {
            axes: axes(&view.direction()),
            fov,
            tangents: [tangent * aspect, tangent],
            largest: [f64::NEG_INFINITY; 4],
            depth: [f64::INFINITY, f64::NEG_INFINITY],
        }
    }

    /// Includes a ball; a point is a ball of radius 0.
    pub fn add(&mut self, center: &Point, radius: f64) {
        let [x, y, z] = self.axes.map(|axis| axis.dot(&center.coords));
        for (k, (across, t)) in [(x, self.tangents[0]), (y, self.tangents[1])].into_iter().enumerate() {
            // The normals (1, t) of the planes are not unit vectors.
            let grown = radius * (1.0 + t * t).sqrt();
            self.largest[2 * k] = self.largest[2 * k].max(across + t * z + grown);
            self.largest[2 * k + 1] = self.largest[2 * k + 1].max(-across + t * z + grown);
        }
        self.depth = [self.depth[0].min(z - radius), self.depth[1].max(z + radius)];
    }

    /// The camera. If nothing was added, it looks at the origin.
    pub fn camera(&self) -> Camera {
        if self.depth[0] > self.depth[1] {
            let eye = Point::from(self.axes[2] * 5.0);
            return Camera { eye, target: Point::origin(), fov: self.fov };
        }
        let [a, b, c, d] = self.largest;
        let [tx, ty] = self.tangents;
        // A single point is seen from a distance of 1 mm, or of a millionth of its coordinates if that is
        // more.
        let min_distance = 1e-3_f64.max(1e-6 * self.largest.iter().fold(0.0, |m: f64, v| m.max(v.abs())));
        let distance = ((a + b) / (2.0 * tx)).max((c + d) / (2.0 * ty)).max(self.depth[1] + min_distance);
        let place = |z: f64| {
            Point::from(self.axes[0] * ((a - b) / 2.0) + self.axes[1] * ((c - d) / 2.0) + self.axes[2] * z)
        };
        let middle = ((self.depth[0] + self.depth[1]) / 2.0).min(distance - min_distance);
        Camera { eye: place(distance), target: place(middle), fov: self.fov }
    }
}

#[cfg(test)]
mod tests;
