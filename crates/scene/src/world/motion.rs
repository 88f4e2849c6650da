//! How obstacles move: where their vertices belong at a time.

use crate::motion::Motion;
use crate::shapes::Animated;
use crate::turn;
use bowknot_geometry::{Point, Vector};
use bowknot_io::Import;
use nalgebra::Rotation3;
use std::sync::Arc;

/// How an obstacle moves.
///
/// Whatever the kind, [`ObstacleMotion::positions`] answers the same question: where the obstacle's vertices
/// belong at a time, in the scene's axes. Between two time steps the simulator moves each vertex on the
/// straight line between two answers, the obstacle as one.
#[derive(Clone, Debug, Default)]
pub enum ObstacleMotion {
    /// At rest.
    #[default]
    Rest,
    /// A rigid motion by keyframes.
    Rigid(Motion),
    /// Positions at given times, joined linearly.
    Sequence(Sequence),
    /// A generated shape that knows where its vertices are at any time.
    Procedural(Procedural),
    /// Held at places that a program gives, one per vertex, in the scene's axes [m].
    Placed(Arc<[Point]>),
}

/// Frames of positions over one topology.
#[derive(Clone, Debug, PartialEq)]
pub struct Sequence {
    /// Positions of all vertices in each frame, in the scene's axes [m]; at least one frame.
    pub frames: Arc<[Vec<Point>]>,
    /// Frames a second [1/s].
    pub rate: f64,
    /// When the first frame is shown [s]. It is held before, the last one after its time.
    pub start: f64,
}

/// A generated shape that moves, and where the scene puts it.
#[derive(Clone, Debug)]
pub struct Procedural {
    /// The shape, in its own axes.
    pub shape: Arc<dyn Animated>,
    /// From its axes to the scene's.
    pub placing: Placing,
}

/// How a mesh is put into the scene: import, then rotation, then translation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placing {
    /// Axes and unit of the mesh.
    pub import: Import,
    /// Rotation about the x, then the y, then the z axis [deg].
    pub rotate: Vector,
    /// Displacement [m].
    pub translate: Vector,
}

impl ObstacleMotion {
    /// Whether the obstacle stays where it is.
    pub fn is_rest(&self) -> bool {
        matches!(self, Self::Rest)
    }

    /// Where the vertices belong at a time [s], given where the scene puts them without motion, `base`. All
    /// slices have one entry per vertex [m].
    pub fn positions(&self, base: &[Point], time: f64, out: &mut [Point]) {
        match self {
            Self::Rest => out.copy_from_slice(base),
            Self::Rigid(motion) => {
                let place = motion.at(time);
                out.iter_mut().zip(base).for_each(|(x, b)| *x = place.apply(b));
            }
            Self::Sequence(sequence) => sequence.positions(time, out),
            Self::Procedural(Procedural { shape, placing }) => {
                out.copy_from_slice(&shape.positions(time));
                placing.import(out);
                placing.place(out);
            }
            Self::Placed(places) => out.copy_from_slice(places),
        }
    }
}

impl Sequence {
    fn positions(&self, time: f64, out: &mut [Point]) {
        let last = self.frames.len() - 1;
        let place = ((time - self.start) * self.rate).clamp(0.0, last as f64);
        let (before, share) = (place.floor() as usize, place.fract());
        let (a, b) = (&self.frames[before], &self.frames[(before + 1).min(last)]);
        for ((x, a), b) in out.iter_mut().zip(a).zip(b) {
            *x = a + (b - a) * share;
        }
    }
}

impl Placing {
    /// The rotation of [`Self::rotate`].
    pub fn rotation(&self) -> Rotation3<f64> {
        let [x, y, z] = [self.rotate.x, self.rotate.y, self.rotate.z].map(f64::to_radians);
        turn::euler(x, y, z)
    }

    /// Axes and unit.
    pub(crate) fn import(&self, positions: &mut [Point]) {
        positions.iter_mut().for_each(|p| *p = self.import.point(p.coords.into()));
    }

    /// Rotation and translation.
    pub(crate) fn place(&self, positions: &mut [Point]) {
        // Without a rotation no rounding by a product: a grid stays a grid.
        if self.rotate != Vector::zeros() {
            let rotation = self.rotation();
            positions.iter_mut().for_each(|p| *p = rotation * *p);
        }
        positions.iter_mut().for_each(|p| *p += self.translate);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sequence() -> ObstacleMotion {
        let frame = |z: f64| vec![Point::new(0.0, 0.0, z), Point::new(1.0, 0.0, -z)];
        let frames = [0.0, 1.0, 4.0].map(frame).to_vec();
        ObstacleMotion::Sequence(Sequence { frames: frames.into(), rate: 10.0, start: 1.0 })
    }

    #[test]
    fn frames_are_joined_linearly_and_held_at_both_ends() {
        let base = vec![Point::origin(); 2];
        let mut x = base.clone();
        for (time, z) in
            [(0.0, 0.0), (1.0, 0.0), (1.05, 0.5), (1.1, 1.0), (1.175, 3.25), (1.2, 4.0), (9.0, 4.0)]
        {
            sequence().positions(&base, time, &mut x);
            assert!((x[0].z - z).abs() < 1e-9 && (x[1].z + z).abs() < 1e-9, "at {time}: {x:?}");
        }
    }

    #[derive(Debug)]
    struct Rising;

    impl Animated for Rising {
        fn positions(&self, time: f64) -> Vec<Point> {
            vec![Point::new(0.0, time, 0.0)]
        }
    }

    #[test]
    fn a_procedural_shape_is_placed_as_its_scene_says() {
        let import = Import { up: bowknot_io::Up::Y, scale: 2.0 };
        let placing =
            Placing { import, rotate: Vector::new(0.0, 90.0, 0.0), translate: Vector::new(0.0, 5.0, 0.0) };
        let motion = ObstacleMotion::Procedural(Procedural { shape: Arc::new(Rising), placing });
        let mut x = [Point::origin()];
        motion.positions(&[Point::origin()], 3.0, &mut x);
        // (0, 3, 0), y up, in half meters, is (0, 0, 6); a quarter turn about y takes z to x.
        assert!((x[0] - Point::new(6.0, 5.0, 0.0)).norm() < 1e-12, "{}", x[0]);
        assert!(!motion.is_rest() && ObstacleMotion::default().is_rest());
    }
}
