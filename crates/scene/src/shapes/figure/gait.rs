//! What the figure does over time: it stands, walks, turns.
//!
//! A cycle of the gait, angle 0 to 2 pi, is two steps. The thighs swing as sines in opposition; a knee
//! bends while its leg swings forward; arms swing against the legs; the pelvis sinks when the legs are
//! apart, sways to the leg that stands, and turns with the legs while the chest turns against them.

use super::Figure;
use super::skeleton::{CHEST, FOOT, FOREARM, HEAD, Pose, SHIN, SPINE, THIGH, UPPER_ARM};
use crate::turn;
use bowknot_geometry::Vector;
use std::f64::consts::{PI, TAU};

/// From hip to ankle [m].
pub(super) const LEG_LENGTH: f64 = 0.81;
/// Bend of the knee of a walking figure: always, and while its leg swings forward [deg].
const KNEE: [f64; 2] = [6.0, 46.0];
/// Bend of the elbow of a walking figure, and how much more when the arm is in front [deg].
const ELBOW: [f64; 2] = [16.0, 8.0];
/// How far the arms come down from the rest pose [deg].
const ARMS_DOWN: f64 = 6.0;
/// Turn of the pelvis about the vertical with the legs, and its drop on the swinging side [deg].
const PELVIS_TURN: [f64; 2] = [5.0, 3.0];
/// Time step of the sum along a curved path [s].
const PATH_STEP: f64 = 2e-3;

/// A switch that is eased on from `start` and off from `end`: its value, and its integral from time 0.
fn eased(time: f64, start: f64, end: f64, ease: f64) -> (f64, f64) {
    let ramp = |from: f64| {
        if time <= from {
            return (0.0, 0.0);
        }
        if ease <= 0.0 {
            return (1.0, time - from);
        }
        let u = ((time - from) / ease).min(1.0);
        let past = (time - from - ease).max(0.0);
        (u * u * (3.0 - 2.0 * u), ease * (u * u * u - 0.5 * u.powi(4)) + past)
    };
    let ((on, whole), (off, rest)) = (ramp(start), ramp(end));
    (on - off, whole - rest)
}

impl Figure {
    /// The pose at a time [s].
    pub(super) fn pose(&self, time: f64) -> Pose {
        let (walk, walked) = eased(time, self.start, self.end, self.ease);
        let phase = PI * self.cadence * walked;
        let mut pose = Pose { heading: self.heading(time), place: self.place(time), ..Pose::default() };

        let (sin, cos) = libm::sincos(phase);
        let swing = walk * self.leg_swing.to_radians();
        let about = |axis: Vector, degrees: f64| turn::about(&(axis * degrees.to_radians()));
        let (x, y, z) = (Vector::x(), Vector::y(), Vector::z());
        // The left leg comes forward through the middle at phase 0, when the right one stands.
        let [turn, drop] = PELVIS_TURN.map(|degrees| walk * degrees);
        pose.shift = Vector::new(
            0.0,
            -walk * self.hip_sway * cos,
            LEG_LENGTH * (libm::cos(swing * sin) - 1.0)
                - walk * LEG_LENGTH * (1.0 - libm::cos(KNEE[0].to_radians())),
        );
        pose.turns[0] = about(z, -turn * sin) * about(x, -drop * cos);
        pose.turns[SPINE] = about(z, turn * sin) * about(x, drop * cos);
        pose.turns[CHEST] = about(z, turn * sin);
        pose.turns[HEAD] = about(z, -turn * sin);
        for (side, sign) in [1.0, -1.0].into_iter().enumerate() {
            let (sin, cos) = (sign * sin, sign * cos);
            let hip = swing.to_degrees() * sin + walk * 0.5 * KNEE[0];
            let knee = walk * (KNEE[0] + KNEE[1] * cos.max(0.0).powi(2));
            // The hip's own turns are undone, so that the leg swings in the direction of the path.
            pose.turns[THIGH[side]] = pose.turns[0].inverse() * about(y, -hip);
            pose.turns[SHIN[side]] = about(y, knee);
            pose.turns[FOOT[side]] = about(y, 0.7 * (hip - knee));
            let arm = -walk * self.arm_swing * sin;
            pose.turns[UPPER_ARM[side]] = about(y, -arm) * about(x, -sign * walk * ARMS_DOWN);
            pose.turns[FOREARM[side]] = about(y, -walk * (ELBOW[0] - ELBOW[1] * sin));
        }
        pose
    }

    /// Direction of view at a time, about z from x [rad].
    fn heading(&self, time: f64) -> f64 {
        let (_, turned) = eased(time, self.turn_start, self.turn_end, self.ease);
        (self.turn_rate * turned).to_radians()
    }

    /// Place on the ground at a time [m]: the integral of the velocity, by the midpoint rule.
    fn place(&self, time: f64) -> Vector {
        if self.turn_rate == 0.0 || self.walk_speed == 0.0 {
            return Vector::x() * (self.walk_speed * eased(time, self.start, self.end, self.ease).1);
        }
        let steps = (time / PATH_STEP).ceil().clamp(0.0, 1e6) as u32;
        let walked = |time: f64| eased(time, self.start, self.end, self.ease).1;
        let mut place = Vector::zeros();
        for step in 0..steps {
            let from = f64::from(step) * PATH_STEP;
            let to = (from + PATH_STEP).min(time);
            let (sin, cos) = libm::sincos(self.heading(0.5 * (from + to)) % TAU);
            place += Vector::new(cos, sin, 0.0) * (self.walk_speed * (walked(to) - walked(from)));
        }
        place
    }
}
