//! Obstacles as a scene describes them.

use crate::body::{check_groups, check_placement};
use crate::motion::Motion;
use crate::shapes::{MeshArrays, Shape};
use bowknot_errors::{Checks, Parameters};
use bowknot_geometry::Vector;
use bowknot_io::Up;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// Something that deformable bodies collide with and that moves only as prescribed, `[[obstacle]]`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ObstacleSpec {
    /// Name in messages. Default `obstacle` and its index.
    pub name: String,
    /// Mesh file (OBJ, PLY, STL, MSH, MESH, ELE, VTU, T, SEG, USD, glTF) relative to the scene file; of tetrahedra, the
    /// surface. This, `shape`, or `sequence`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mesh: Option<PathBuf>,
    /// The part of the mesh file or of the animation that is taken, if it has several, as for bodies. Default: all
    /// as one mesh.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub part: Option<String>,
    /// Generated mesh, one by its arrays, or `half-space`, see the shapes. This, `mesh`, or `sequence`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub shape: Option<Shape>,
    /// An animation, relative to the scene file: a folder of meshes of equal elements, taken in the order of
    /// their names, a USD stage, a glTF scene or a point cache, or an NPZ archive of `X[f,n,3]` and `F[m,3]`.
    /// Frames are joined linearly. During empty frames, which have no vertices or all at one place, the
    /// obstacle is not there. This, `mesh`, or `shape`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sequence: Option<PathBuf>,
    /// Frames of the sequence a second [1/s]. Default 30.
    pub sequence_rate: f64,
    /// When the sequence begins [s]; it is held at its first frame before, and at its last one after. Default
    /// 0.
    pub sequence_start: f64,
    /// When the obstacle appears [s]; before, it meets nothing. It waits while anything is in its place.
    /// Default 0: it is there from the start.
    pub appears: f64,
    /// When it vanishes [s], later than `appears`; what rests on it then falls. Default inf.
    pub vanishes: f64,
    /// Axis of the mesh that points up: `x`, `y` or `z`. With `y`, as most modeling tools have it, y becomes
    /// z and z becomes -y; with `x`, x becomes z, y becomes x and z becomes y. Default `z`.
    pub up: Up,
    /// Factor on the mesh's coordinates [1]: 0.001 for a mesh in millimeters. Default 1.
    pub scale: f64,
    /// Rotation about the x, then the y, then the z axis through the origin [deg], after `up` and
    /// `scale`. Default (0, 0, 0).
    pub rotate: Vector,
    /// Displacement after the rotation [m]. Default (0, 0, 0).
    pub translate: Vector,
    /// Rigid motion over time, see the motions; not for a half-space, nor for what moves by itself. Default:
    /// at rest.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub motion: Option<Motion>,
    /// Coefficient of Coulomb friction [1], as for bodies. Default 0.
    pub friction: f64,
    /// Guaranteed smallest gap [m], as for bodies. A half-space without one counts as 0 against a body that
    /// has one. Default: the minimum separation of the scene.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub thickness: Option<f64>,
    /// Collision groups that the obstacle is in, from 0 to 31 [1]. A half-space meets all. Default
    /// `[0]`.
    pub groups: Vec<u32>,
    /// Collision groups that it meets [1]; both sides must agree. Default: all.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub collides_with: Option<Vec<u32>>,
}

impl Default for ObstacleSpec {
    fn default() -> Self {
        Self {
            name: String::new(),
            mesh: None,
            part: None,
            shape: None,
            sequence: None,
            sequence_rate: 30.0,
            sequence_start: 0.0,
            appears: 0.0,
            vanishes: f64::INFINITY,
            up: Up::Z,
            scale: 1.0,
            rotate: Vector::zeros(),
            translate: Vector::zeros(),
            motion: None,
            friction: 0.0,
            thickness: None,
            groups: vec![0],
            collides_with: None,
        }
    }
}

impl Parameters for ObstacleSpec {
    fn check(&self, checks: &mut Checks) {
        check_placement(checks, self.scale, &self.rotate, &self.translate);
        check_groups(checks, &self.groups, self.collides_with.as_deref());
        checks.non_negative("friction", self.friction);
        if let Some(thickness) = self.thickness {
            checks.non_negative("thickness", thickness);
        }
        let rate = self.sequence_rate;
        let fits = rate.is_finite() && rate > 0.0;
        checks.require(fits, "sequence_rate", rate, "must be a number of frames a second above 0");
        checks.finite("sequence_start", self.sequence_start);
        checks.non_negative("appears", self.appears);
        let later = self.vanishes > self.appears;
        checks.require(
            later,
            "vanishes",
            self.vanishes,
            format!("must be later than appears, {}", self.appears),
        );
        self.check_geometry(checks);
        self.check_motion(checks);
    }
}

impl ObstacleSpec {
    /// An obstacle of a mesh in memory.
    pub fn from_arrays(name: impl Into<String>, mesh: MeshArrays) -> Self {
        Self { name: name.into(), shape: Some(Shape::Arrays(mesh)), ..Self::default() }
    }

    /// What the obstacle is made of: exactly one of `mesh`, `shape` and `sequence`.
    fn check_geometry(&self, checks: &mut Checks) {
        if self.part.is_some() && self.mesh.is_none() && self.sequence.is_none() {
            checks.contradiction("part", "needs a mesh file or a sequence, of which it names a part");
        }
        match (&self.mesh, &self.shape, &self.sequence) {
            (Some(_), Some(_), _) => {
                checks.contradiction("shape", "stands beside mesh; only one of them may be given");
            }
            (Some(_), None, Some(_)) | (None, Some(_), Some(_)) => {
                checks.contradiction("sequence", "stands beside a mesh or a shape; only one may be given");
            }
            (None, None, None) => checks.contradiction("mesh", "needs a mesh file, or a shape"),
            _ => {}
        }
        if let Some(shape) = &self.shape {
            if matches!(shape, Shape::Strands(_) | Shape::Woven(_) | Shape::Grains(_)) {
                let kind = shape.kind().name();
                checks.contradiction("shape", format!("makes a body of kind {kind}, which is no obstacle"));
            }
            checks.within("shape", shape);
        }
    }

    /// How the obstacle moves, and what a half-space cannot have.
    fn check_motion(&self, checks: &mut Checks) {
        let Some(motion) = &self.motion else { return self.check_half_space(checks) };
        if self.sequence.is_some() || self.shape.as_ref().is_some_and(|shape| shape.animated().is_some()) {
            let message = "the obstacle moves by itself already; only one of them may be given";
            checks.contradiction("motion", message);
        }
        checks.within("motion", motion);
        self.check_half_space(checks);
    }

    fn check_half_space(&self, checks: &mut Checks) {
        let Some(Shape::HalfSpace(_)) = self.shape else { return };
        if self.motion.is_some() {
            checks.contradiction("motion", "a half-space does not move; use a box");
        }
        if self.collides_with.is_some() || self.groups != [0] {
            checks.contradiction("groups", "a half-space meets every body; use a box");
        }
    }
}
