//! Prescribed rigid motion of obstacles and pins.

use crate::turn;
use bowknot_errors::{Checks, Parameters};
use bowknot_geometry::{Point, Vector};
use nalgebra::{Rotation3, Unit};
use serde::{Deserialize, Serialize};

/// A rigid motion over time: x -> center + R(axis, angle(t)) (x - center) + translate(t), with
/// angle(t) = spin * t + the keyframes' angle. Without a motion an obstacle or pin stays where it is.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Motion {
    /// Axis of rotation [1], of any length but zero. Default (0, 0, 1).
    pub axis: Vector,
    /// A point of the axis at time 0 [m]. Default (0, 0, 0).
    pub center: Point,
    /// Constant angular velocity about the axis [deg/s], counter-clockwise seen against the axis.
    /// Default 0.
    pub spin: f64,
    /// Places to be at given times, in ascending order of time, joined linearly and held after the last.
    /// A motion that does not begin with time 0 starts from no displacement there. Default none.
    pub keyframes: Vec<Keyframe>,
}

/// Where a [`Motion`] is at a time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Keyframe {
    /// When [s]. Default 0.
    pub time: f64,
    /// Displacement from the place in the scene [m]. Default (0, 0, 0).
    pub translate: Vector,
    /// Angle about the motion's axis [deg]; may exceed a full turn. Default 0.
    pub angle: f64,
}

impl Default for Motion {
    fn default() -> Self {
        Self { axis: Vector::z(), center: Point::origin(), spin: 0.0, keyframes: Vec::new() }
    }
}

/// A motion at one time: x -> center + R (x - center) + translate.
#[derive(Clone, Copy, Debug)]
pub struct Placement {
    rotation: Option<Rotation3<f64>>,
    center: Point,
    translate: Vector,
}

impl Motion {
    /// The motion at a time [s].
    pub fn at(&self, time: f64) -> Placement {
        let (translate, angle) = self.keyframe(time);
        let angle = angle + self.spin * time;
        let rotation = Unit::try_new(self.axis, 0.0)
            .filter(|_| angle != 0.0)
            .map(|axis| turn::about_axis(&axis, angle.to_radians()));
        Placement { rotation, center: self.center, translate }
    }

    fn keyframe(&self, time: f64) -> (Vector, f64) {
        let after = self.keyframes.partition_point(|k| k.time <= time);
        let start = Keyframe::default();
        let Some(next) = self.keyframes.get(after) else {
            return self.keyframes.last().map_or((Vector::zeros(), 0.0), |k| (k.translate, k.angle));
        };
        let last = if after > 0 { &self.keyframes[after - 1] } else { &start };
        // Times ascend strictly and start above `last.time`, so this does not divide by zero.
        let s = ((time - last.time) / (next.time - last.time)).clamp(0.0, 1.0);
        (last.translate + (next.translate - last.translate) * s, last.angle + (next.angle - last.angle) * s)
    }
}

impl Parameters for Motion {
    fn check(&self, checks: &mut Checks) {
        let finite = |v: &Vector| v.iter().all(|c| c.is_finite());
        if !(finite(&self.axis) && self.axis.norm() > 0.0) {
            checks.refuse("axis", format!("{:?}", self.axis.as_slice()), "must be finite and not zero");
        }
        checks.all_finite("center", &self.center.coords);
        checks.finite("spin", self.spin);
        for (index, k) in self.keyframes.iter().enumerate() {
            if !(k.time.is_finite() && k.time >= 0.0 && k.angle.is_finite() && finite(&k.translate)) {
                let allowed = "must be finite, its time at least 0";
                checks.refuse("keyframes", format!("keyframe {index}"), allowed);
            }
        }
        if let Some(index) = self.keyframes.windows(2).position(|w| w[0].time >= w[1].time) {
            let [time, next] = [index, index + 1].map(|index| self.keyframes[index].time);
            let given = format!("keyframe {index} at {time} s, the next at {next} s");
            checks.refuse("keyframes", given, "must ascend in time");
        }
    }
}

impl Placement {
    /// Where a point of the scene is.
    #[inline]
    pub fn apply(&self, x: &Point) -> Point {
        match &self.rotation {
            Some(rotation) => self.center + rotation * (x - self.center) + self.translate,
            // No rounding where nothing turns: a body at rest stays at rest to the bit.
            None => x + self.translate,
        }
    }

    /// Which point of the scene is at `x`, to rounding.
    pub fn undo(&self, x: &Point) -> Point {
        match &self.rotation {
            Some(rotation) => self.center + rotation.inverse() * (x - self.translate - self.center),
            None => x - self.translate,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn motion() -> Motion {
        Motion {
            center: Point::new(1.0, 0.0, 0.0),
            keyframes: vec![
                Keyframe { time: 1.0, translate: Vector::new(0.0, 0.0, 2.0), angle: 720.0 },
                Keyframe { time: 3.0, translate: Vector::new(0.0, 0.0, 0.0), angle: 810.0 },
            ],
            ..Motion::default()
        }
    }

    #[test]
    fn keyframes_are_joined_and_held() {
        let x = Point::new(2.0, 0.0, 0.0);
        let near = |t: f64, expected: [f64; 3]| {
            let y = motion().at(t).apply(&x);
            assert!((y - Point::from(expected)).norm() < 1e-12, "at {t}: {y}");
            assert!((motion().at(t).undo(&y) - x).norm() < 1e-12);
        };
        near(0.0, [2.0, 0.0, 0.0]);
        near(0.125, [1.0, 1.0, 0.25]);
        near(1.0, [2.0, 0.0, 2.0]);
        near(3.0, [1.0, 1.0, 0.0]);
        near(9.0, [1.0, 1.0, 0.0]);
    }

    #[test]
    fn a_spin_turns_without_keyframes() {
        let motion = Motion { spin: 90.0, ..Motion::default() };
        let y = motion.at(2.0).apply(&Point::new(1.0, 0.0, 5.0));
        assert!((y - Point::new(-1.0, 0.0, 5.0)).norm() < 1e-12);
    }

    #[test]
    fn rest_is_exact() {
        let x = Point::new(0.1, 0.2, 0.3);
        assert_eq!(Motion::default().at(0.7).apply(&x), x);
    }

    #[test]
    fn times_must_ascend() {
        let mut motion = motion();
        motion.keyframes.swap(0, 1);
        let errors = motion.validate().expect_err("times that do not ascend");
        assert_eq!(errors.len(), 1);
        assert!(errors[0].allowed.contains("must ascend"));
    }
}
