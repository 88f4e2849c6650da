//! The surface of the figure at rest as the zero set of a function.
//!
//! Each bone carries round cones. The field of their union has slope 1 at most, so a surface on which it is
//! at least g keeps g from the body.

use super::super::round_cone::{RoundCone, bounds, smooth_union};
use super::skeleton::{ARM, CHEST, FOOT, FOREARM, HEAD, LEG, NECK, PELVIS, SHIN, SPINE, THIGH, UPPER_ARM};
use bowknot_geometry::Point;

/// A round cone that moves with a bone.
#[derive(Clone, Copy, Debug)]
struct Part {
    bone: usize,
    cone: RoundCone,
}

/// The body at rest.
#[derive(Clone, Debug)]
pub(crate) struct RestBody {
    trunk: Vec<Part>,
    arms: Vec<Part>,
    legs: Vec<Part>,
}

impl RestBody {
    pub fn new() -> Self {
        let waist = pair(SPINE, [[0.0, 0.058, 1.0], [0.002, 0.042, 1.095]], [0.092, 0.08], 0);
        let ribs = pair(SPINE, [[0.002, 0.042, 1.095], [-0.004, 0.055, 1.18]], [0.08, 0.087], 0);
        let seat = pair(PELVIS, [[-0.05, 0.065, 0.905], [-0.05, 0.06, 0.93]], [0.075, 0.07], 0);
        let bust = pair(CHEST, [[0.046, 0.066, 1.225], [0.03, 0.06, 1.27]], [0.056, 0.05], 0);
        let shoulders = pair(CHEST, [[-0.012, 0.03, 1.40], [-0.012, 0.16, 1.382]], [0.05, 0.047], 0);
        let trunk = vec![
            // Hips, waist, ribs: broad, so each a bar from side to side, or two.
            bar(PELVIS, [0.0, 0.072, 0.935], 0.102, 0.01),
            waist[0],
            waist[1],
            ribs[0],
            ribs[1],
            bar(CHEST, [-0.005, 0.06, 1.235], 0.092, 0.05),
            bar(CHEST, [-0.015, 0.062, 1.33], 0.078, 0.05),
            seat[0],
            seat[1],
            bust[0],
            bust[1],
            shoulders[0],
            shoulders[1],
            bone(NECK, [[-0.014, 0.0, 1.39], [0.004, 0.0, 1.50]], [0.053, 0.046], 0.04),
            bone(HEAD, [[0.026, 0.0, 1.545], [0.008, 0.0, 1.612]], [0.062, 0.088], 0.02),
        ];
        let [shoulder, elbow, wrist, tip] = ARM;
        let [hip, knee, ankle] = LEG;
        let arms = [
            pair(UPPER_ARM[0], [shoulder, elbow], [0.047, 0.037], 0),
            pair(FOREARM[0], [elbow, wrist], [0.038, 0.027], 1),
            pair(FOREARM[0], [wrist, tip], [0.031, 0.026], 1),
        ];
        let calf = [-0.02, 0.112, 0.37];
        let heel = [-0.035, 0.118, 0.045];
        let toes = [0.135, 0.13, 0.034];
        let legs = [
            pair(THIGH[0], [hip, knee], [0.088, 0.056], 0),
            pair(SHIN[0], [knee, ankle], [0.053, 0.036], 1),
            pair(SHIN[0], [calf, [-0.014, 0.115, 0.26]], [0.048, 0.038], 1),
            pair(FOOT[0], [heel, toes], [0.042, 0.032], 1),
            pair(FOOT[0], [ankle, [0.05, 0.122, 0.05]], [0.036, 0.036], 1),
        ];
        Self { trunk, arms: arms.into_iter().flatten().collect(), legs: legs.into_iter().flatten().collect() }
    }

    /// All parts.
    fn parts(&self) -> impl Iterator<Item = &Part> {
        self.trunk.iter().chain(&self.arms).chain(&self.legs)
    }

    /// The field of the whole body [m]: negative inside.
    pub fn field(&self, p: &Point) -> f64 {
        join(self.parts(), p)
    }

    /// The field without the arms [m].
    pub fn field_without_arms(&self, p: &Point) -> f64 {
        join(self.trunk.iter().chain(&self.legs), p)
    }

    /// A box around the body [m].
    pub fn bounds(&self) -> (Point, Point) {
        self.parts().fold((Point::origin(), Point::origin()), |(low, high), part| {
            let (a, b) = bounds(&part.cone);
            (low.inf(&a), high.sup(&b))
        })
    }

    /// Distance to the parts of each bone [m].
    pub fn bone_distances<const N: usize>(&self, p: &Point) -> [f64; N] {
        let mut distances = [f64::INFINITY; N];
        for part in self.parts() {
            distances[part.bone] = distances[part.bone].min(part.cone.distance(p));
        }
        distances
    }
}

fn join<'a>(parts: impl Iterator<Item = &'a Part>, p: &Point) -> f64 {
    smooth_union(parts.map(|part| &part.cone), p)
}

fn bone(bone: usize, ends: [[f64; 3]; 2], radii: [f64; 2], blend: f64) -> Part {
    Part { bone, cone: RoundCone { ends: ends.map(Point::from), radii, blend } }
}

/// A part from the mirror image of its end to the end.
fn bar(of: usize, [x, y, z]: [f64; 3], radius: f64, blend: f64) -> Part {
    bone(of, [[x, -y, z], [x, y, z]], [radius; 2], blend)
}

/// A part of the left side and its mirror image. The right bone of a pair follows the left one by
/// `1`; parts of the trunk belong to one bone on both sides.
fn pair(of: usize, ends: [[f64; 3]; 2], radii: [f64; 2], level: usize) -> [Part; 2] {
    // Joints within a limb are rounded less than where it grows from the trunk.
    let blend = [0.035, 0.02][level];
    let mirrored = ends.map(|[x, y, z]| [x, -y, z]);
    let right = if of > HEAD { of + 1 } else { of };
    [bone(of, ends, radii, blend), bone(right, mirrored, radii, blend)]
}
