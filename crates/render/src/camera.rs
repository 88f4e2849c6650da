//! Where a picture is taken from, and how far back a camera must stand to see everything.

use crate::RenderError;
use bowknot_geometry::{Point, Vector};

/// A direction to look from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum View {
    /// From -y, level.
    Front,
    /// From +x, level.
    Side,
    /// From above, +y up in the picture.
    Top,
    /// From above the left corner in front.
    #[default]
    ThreeQuarter,
}

impl View {
    /// From the target to the eye, a unit vector.
    pub fn direction(self) -> Vector {
        match self {
            // Not quite level: a ground that is seen as a line shows no shadow.
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
    /// Where it stands [m].
    pub eye: Point,
    /// What it looks at [m].
    pub target: Point,
    /// Vertical field of view [deg].
    pub fov: f64,
}

/// Default vertical field of view [deg]: that of a long lens, which keeps proportions.
pub const DEFAULT_FOV: f64 = 26.0;

/// Share of the picture that stays free on each side.
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
            Err(RenderError::BlindCamera(self.target.coords.into()))
        }
    }
}

/// Right, up and back for a unit vector back; z is up unless one looks along it.
pub(crate) fn axes(back: &Vector) -> [Vector; 3] {
    let vertical = if back.z.abs() < 0.999 { Vector::z() } else { Vector::y() };
    let right = vertical.cross(back).normalize();
    [right, back.cross(&right), *back]
}

/// Finds the nearest place in a given direction from which all points are seen.
///
/// Each side of the view is a plane through the eye. For points p with coordinates x (right), z (back) the left and right
/// planes demand x + t z <= e_x + t e_z and -x + t z <= -e_x + t e_z for the eye e and the half angle's tangent t; so the
/// largest x + t z and -x + t z of all points give e_x and the least e_z, and likewise for the height. Nothing has to be
/// remembered of the points but these four numbers.
#[derive(Clone, Debug)]
pub struct Fit {
    axes: [Vector; 3],
    fov: f64,
    /// Tangents of half the angles of view, horizontally and vertically, less the margin.
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

    /// Takes a ball into the picture; a point is a ball without radius.
    pub fn add(&mut self, center: &Point, radius: f64) {
        let [x, y, z] = self.axes.map(|axis| axis.dot(&center.coords));
        for (k, (across, t)) in [(x, self.tangents[0]), (y, self.tangents[1])].into_iter().enumerate() {
            // The planes' normals (1, t) are longer than 1.
            let grown = radius * (1.0 + t * t).sqrt();
            self.largest[2 * k] = self.largest[2 * k].max(across + t * z + grown);
            self.largest[2 * k + 1] = self.largest[2 * k + 1].max(-across + t * z + grown);
        }
        self.depth = [self.depth[0].min(z - radius), self.depth[1].max(z + radius)];
    }

    /// The camera; without any point, one that looks at the origin.
    pub fn camera(&self) -> Camera {
        if self.depth[0] > self.depth[1] {
            let eye = Point::from(self.axes[2] * 5.0);
            return Camera { eye, target: Point::origin(), fov: self.fov };
        }
        let [a, b, c, d] = self.largest;
        let [tx, ty] = self.tangents;
        // A single point is seen from 1 mm or a millionth of its distance from the origin.
        let least = 1e-3_f64.max(1e-6 * self.largest.iter().fold(0.0, |m: f64, v| m.max(v.abs())));
        let distance = ((a + b) / (2.0 * tx)).max((c + d) / (2.0 * ty)).max(self.depth[1] + least);
        let place = |z: f64| {
            Point::from(self.axes[0] * ((a - b) / 2.0) + self.axes[1] * ((c - d) / 2.0) + self.axes[2] * z)
        };
        let middle = ((self.depth[0] + self.depth[1]) / 2.0).min(distance - least);
        Camera { eye: place(distance), target: place(middle), fov: self.fov }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Where a point comes to lie in the picture: 1 is the edge.
    fn project(camera: &Camera, aspect: f64, point: &Point) -> [f64; 2] {
        let [right, up, back] = camera.axes().unwrap();
        let d = point - camera.eye;
        let t = (camera.fov.to_radians() / 2.0).tan();
        let depth = -d.dot(&back);
        assert!(depth > 0.0, "{point} is behind the camera");
        [d.dot(&right) / depth / t / aspect, d.dot(&up) / depth / t]
    }

    const VIEWS: [View; 4] = [View::Front, View::Side, View::Top, View::ThreeQuarter];

    #[test]
    fn everything_is_seen_and_fills_the_picture() {
        let corners: Vec<Point> = (0..8)
            .map(|k| Point::new(f64::from(k & 1), f64::from(k >> 1 & 1) * 3.0, f64::from(k >> 2) * 0.5))
            .collect();
        for view in VIEWS {
            for aspect in [0.5, 1.0, 1.8] {
                let mut fit = Fit::new(view, 30.0, aspect);
                corners.iter().for_each(|p| fit.add(p, 0.0));
                let camera = fit.camera();
                let mut extreme = [0.0_f64; 2];
                for p in &corners {
                    let [x, y] = project(&camera, aspect, p);
                    extreme = [extreme[0].max(x.abs()), extreme[1].max(y.abs())];
                }
                let most = extreme[0].max(extreme[1]);
                let expected = 1.0 - 2.0 * MARGIN;
                assert!((most - expected).abs() < 1e-9, "{view:?} {aspect}: {extreme:?}");
            }
        }
    }

    #[test]
    fn a_ball_is_seen_whole() {
        let center = Point::new(1.0, -2.0, 3.0);
        let mut fit = Fit::new(View::ThreeQuarter, 40.0, 1.5);
        fit.add(&center, 0.5);
        let camera = fit.camera();
        let [right, up, _] = camera.axes().unwrap();
        for k in 0..360 {
            let (s, c) = f64::from(k).to_radians().sin_cos();
            let [x, y] = project(&camera, 1.5, &(center + (right * c + up * s) * 0.5));
            assert!(x.abs() < 1.0 && y.abs() < 1.0 - MARGIN);
        }
    }

    #[test]
    fn degenerate_fits_still_look_somewhere() {
        let empty = Fit::new(View::Top, 30.0, 1.0).camera();
        assert!(empty.axes().is_ok());
        let mut fit = Fit::new(View::Front, 30.0, 1.0);
        fit.add(&Point::new(5.0, 5.0, 5.0), 0.0);
        let single = fit.camera();
        assert!(single.axes().is_ok());
        assert!(project(&single, 1.0, &Point::new(5.0, 5.0, 5.0))[0].abs() < 1e-6);
        let blind = Camera { eye: Point::origin(), target: Point::origin(), fov: 30.0 };
        assert!(blind.axes().is_err());
    }
}
