//! A human figure that stands, walks and turns.

mod body;
mod gait;
mod skeleton;
mod skin;
#[cfg(test)]
mod tests;

pub(super) use body::RestBody;

use super::animated::Animated;
use super::isosurface::{self, Isosurface};
use super::mesh::TriangleMesh;
use bowknot_errors::{Checks, Parameters};
use bowknot_geometry::{Point, Topology};
use serde::{Deserialize, Serialize};
use skin::Skin;

/// A human figure, 1.7 m tall, that stands at the origin on the xy plane, looks along x and holds its
/// arms away from the body. As an obstacle it is animated: it stands until `start`, then walks and
/// turns.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Figure {
    /// Length of the edges [m], roughly, at most 0.03. Smaller: smoother hands and feet. Default 0.02.
    pub edge: f64,
    /// When it begins to walk [s]; until then it stands in the rest pose. Default 0.3.
    pub start: f64,
    /// When it begins to stop [s]. Default inf.
    pub end: f64,
    /// Time in which it gets going, stops, and begins and ends to turn [s]. Shorter: it jerks the
    /// cloth. Default 0.6.
    pub ease: f64,
    /// Speed of walking in the direction of view [m/s]; 0 walks in place. The feet do not slide much at
    /// 1.6 m * sin(leg_swing) * cadence. Default 1.
    pub walk_speed: f64,
    /// Steps per second [1/s]. Default 1.8.
    pub cadence: f64,
    /// How far the legs swing to either side [deg], at most 45. Default 20.
    pub leg_swing: f64,
    /// How far the arms swing to either side [deg], at most 60. Default 20.
    pub arm_swing: f64,
    /// How far the hips sway to either side [m], at most 0.1. Default 0.02.
    pub hip_sway: f64,
    /// Angular velocity of turning about the vertical [deg/s], to the left if positive. Default 0.
    pub turn_rate: f64,
    /// When it begins to turn [s]. Default 0.
    pub turn_start: f64,
    /// When it begins to end turning [s]. Default inf.
    pub turn_end: f64,
}

impl Default for Figure {
    fn default() -> Self {
        Self {
            edge: 0.02,
            start: 0.3,
            end: f64::INFINITY,
            ease: 0.6,
            walk_speed: 1.0,
            cadence: 1.8,
            leg_swing: 20.0,
            arm_swing: 20.0,
            hip_sway: 0.02,
            turn_rate: 0.0,
            turn_start: 0.0,
            turn_end: f64::INFINITY,
        }
    }
}

/// Longest edge [m]: the hands are 5 cm thick.
const LONGEST_EDGE: f64 = 0.03;

impl Figure {
    /// The mesh in the rest pose: closed, of triangles of nearly equal size.
    pub fn mesh(&self) -> TriangleMesh {
        let body = RestBody::new();
        let (low, high) = body.bounds();
        let surface = Isosurface { field: |p: &Point| body.field(p), low, high };
        // Edges come out shorter than the spacing of the grid by a tenth.
        isosurface::mesh(&surface, 1.1 * self.edge.min(LONGEST_EDGE))
    }
}

impl Parameters for Figure {
    fn check(&self, checks: &mut Checks) {
        let ranges = [
            ("edge", self.edge, f64::MIN_POSITIVE, LONGEST_EDGE, "m"),
            ("start", self.start, 0.0, f64::MAX, "s"),
            ("ease", self.ease, 0.0, f64::MAX, "s"),
            ("walk_speed", self.walk_speed, -10.0, 10.0, "m/s"),
            ("cadence", self.cadence, 0.0, 10.0, "steps a second"),
            ("leg_swing", self.leg_swing, 0.0, 45.0, "degrees"),
            ("arm_swing", self.arm_swing, 0.0, 60.0, "degrees"),
            ("hip_sway", self.hip_sway, 0.0, 0.1, "m"),
            ("turn_rate", self.turn_rate, -3600.0, 3600.0, "degrees a second"),
            ("turn_start", self.turn_start, 0.0, f64::MAX, "s"),
        ];
        for (key, value, least, most, unit) in ranges {
            if !(least..=most).contains(&value) {
                let range = match (least == f64::MIN_POSITIVE, most == f64::MAX) {
                    (true, _) => format!("above 0 and at most {most}"),
                    (_, true) => "finite and at least 0".to_owned(),
                    _ => format!("from {least} to {most}"),
                };
                checks.refuse(key, value, format!("must be {range} {unit}"));
            }
        }
        for (key, end, start) in [("end", self.end, self.start), ("turn_end", self.turn_end, self.turn_start)]
        {
            if end.is_nan() || end < start {
                checks.refuse(key, end, format!("must not be earlier than the start, {start} s"));
            }
        }
    }
}

/// A figure with its mesh bound to its bones, ready to move.
#[derive(Clone, Debug)]
pub struct AnimatedFigure {
    figure: Figure,
    mesh: TriangleMesh,
    skin: Skin,
}

impl AnimatedFigure {
    /// Binds the mesh of [`Figure::mesh`] to the bones.
    pub fn new(figure: Figure) -> Self {
        let mesh = figure.mesh();
        let topology =
            Topology::builder(mesh.positions.len()).triangles(mesh.triangles.iter().copied()).build();
        // The mesh is our own, so there is a topology; without one the weights would only be rougher.
        let topology = topology.unwrap_or_default();
        let skin = Skin::new(&RestBody::new(), &mesh.positions, &topology, figure.edge);
        Self { figure, mesh, skin }
    }

    /// The mesh in the rest pose.
    pub fn mesh(&self) -> &TriangleMesh {
        &self.mesh
    }
}

impl Animated for AnimatedFigure {
    /// A few hundred microseconds for 10,000 vertices. Before [`Figure::start`] the places are those of the
    /// mesh.
    fn positions(&self, time: f64) -> Vec<Point> {
        self.skin.apply(&self.figure.pose(time), &self.mesh.positions)
    }
}
