//! The bones of the figure, its rest pose, and the rigid placements of the bones in another pose.
//!
//! The figure is 1.7 m tall, stands at the origin on the xy plane, looks along x and has its left along
//! y. In the rest pose the arms are held away from the body (an A-pose), the legs a little apart.

use crate::turn;
use bowknot_geometry::{Point, Vector};
use nalgebra::{Isometry3, Rotation3, Translation3, UnitQuaternion};

/// Number of bones.
pub(super) const BONES: usize = 15;

pub(super) const PELVIS: usize = 0;
pub(super) const SPINE: usize = 1;
pub(super) const CHEST: usize = 2;
pub(super) const NECK: usize = 3;
pub(super) const HEAD: usize = 4;
// Of pairs, the left one first.
pub(super) const UPPER_ARM: [usize; 2] = [5, 6];
pub(super) const FOREARM: [usize; 2] = [7, 8];
pub(super) const THIGH: [usize; 2] = [9, 10];
pub(super) const SHIN: [usize; 2] = [11, 12];
pub(super) const FOOT: [usize; 2] = [13, 14];

/// The bone that each hangs on; parents come first. The pelvis hangs on none.
const PARENT: [usize; BONES] = [
    PELVIS,
    PELVIS,
    SPINE,
    CHEST,
    NECK,
    CHEST,
    CHEST,
    UPPER_ARM[0],
    UPPER_ARM[1],
    PELVIS,
    PELVIS,
    THIGH[0],
    THIGH[1],
    SHIN[0],
    SHIN[1],
];

/// Left shoulder, elbow, wrist and finger tips at rest [m]; for the right ones y changes its sign.
pub(super) const ARM: [[f64; 3]; 4] =
    [[-0.01, 0.185, 1.375], [-0.012, 0.338, 1.157], [0.012, 0.476, 0.957], [0.03, 0.57, 0.822]];
/// Left hip, knee and ankle at rest [m].
pub(super) const LEG: [[f64; 3]; 3] = [[0.0, 0.092, 0.90], [0.006, 0.108, 0.49], [-0.012, 0.118, 0.09]];

/// The joint that a bone turns about, at rest [m].
fn joint(bone: usize) -> Point {
    let side = |at: [f64; 3], pair: [usize; 2]| {
        if bone == pair[0] { Point::from(at) } else { Point::new(at[0], -at[1], at[2]) }
    };
    match bone {
        PELVIS => Point::new(0.0, 0.0, 0.94),
        SPINE => Point::new(0.0, 0.0, 1.03),
        CHEST => Point::new(0.0, 0.0, 1.16),
        NECK => Point::new(-0.01, 0.0, 1.41),
        HEAD => Point::new(0.0, 0.0, 1.50),
        5 | 6 => side(ARM[0], UPPER_ARM),
        7 | 8 => side(ARM[1], FOREARM),
        9 | 10 => side(LEG[0], THIGH),
        11 | 12 => side(LEG[1], SHIN),
        _ => side(LEG[2], FOOT),
    }
}

/// A pose: what each joint does to the rest pose, and where the whole figure is.
#[derive(Clone, Debug)]
pub(super) struct Pose {
    /// Turn of each bone about its joint, in the axes of its parent.
    pub turns: [Rotation3<f64>; BONES],
    /// Displacement of the pelvis, in the axes of the figure [m].
    pub shift: Vector,
    /// Direction that the figure looks in, about z from x [rad].
    pub heading: f64,
    /// Place of the figure on the ground [m].
    pub place: Vector,
}

impl Default for Pose {
    fn default() -> Self {
        let turns = [Rotation3::identity(); BONES];
        Self { turns, shift: Vector::zeros(), heading: 0.0, place: Vector::zeros() }
    }
}

impl Pose {
    /// For each bone the map from its points at rest to those in this pose.
    pub fn placements(&self) -> [Isometry3<f64>; BONES] {
        let heading = turn::quaternion(&Vector::z_axis(), self.heading);
        let root =
            Isometry3::from_parts(Translation3::from(self.place), heading) * Translation3::from(self.shift);
        let mut placements = [root; BONES];
        for bone in 0..BONES {
            let parent = if bone == PELVIS { root } else { placements[PARENT[bone]] };
            let joint = Translation3::from(joint(bone).coords);
            let turn = UnitQuaternion::from_rotation_matrix(&self.turns[bone]);
            placements[bone] = parent * joint * turn * joint.inverse();
        }
        placements
    }
}
