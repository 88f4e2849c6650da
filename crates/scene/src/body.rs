//! Bodies, obstacles and pins as a scene describes them.

use crate::kind::BodyKind;
use crate::material::Material;
use crate::motion::Motion;
use crate::shapes::Shape;
use bowknot_geometry::{Point, Vector};
use bowknot_io::Up;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// A deformable body, `[[body]]`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct BodySpec {
    /// Name in messages and for pins; no two bodies share one. Default `body` and its index.
    pub name: String,
    /// What the body is: `cloth`, a surface of triangles; `solid`, a volume of tetrahedra; `strands`, hair or
    /// yarn of edges; `particles`, grains. Default `cloth`.
    pub kind: BodyKind,
    /// Mesh file (OBJ, PLY, MSH, T, SEG) relative to the scene file, with the elements of the kind. Either
    /// this or `shape`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mesh: Option<PathBuf>,
    /// Generated mesh, see the shapes. Either this or `mesh`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub shape: Option<Shape>,
    /// Axis of the mesh that points up: `x`, `y` or `z`. Default `z`.
    pub up: Up,
    /// Factor on the mesh's coordinates [1]: 0.001 for a mesh in millimeters. Default 1.
    pub scale: f64,
    /// Rotation about the x, then the y, then the z axis through the origin [deg], after `up` and
    /// `scale`. Default (0, 0, 0).
    pub rotate: Vector,
    /// Displacement after the rotation [m]. Default (0, 0, 0).
    pub translate: Vector,
    /// Initial velocity [m/s]. Default (0, 0, 0).
    pub velocity: Vector,
    /// Initial angular velocity about the mean of the body's vertices [deg/s]: its direction is the axis,
    /// counter-clockwise seen against it. Default (0, 0, 0).
    pub angular_velocity: Vector,
    /// Acceleration of gravity on this body [m/s^2]. Default: that of the scene.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub gravity: Option<Vector>,
    /// A material of the body's kind by name, or a table of its numbers over those of the one that `base`
    /// names. Default: the first of the kind, see the materials.
    pub material: Material,
    /// Coefficient of Coulomb friction [1], at least 0. Two bodies in contact have the geometric mean of
    /// both, unless `contact.friction_pairs` says otherwise: it takes both to rub. Default 0.
    pub friction: f64,
    /// Guaranteed smallest gap to a body of the same thickness [m]; a pair keeps the mean of both. Larger:
    /// layers that lie further apart. Default: the minimum separation of the scene.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub thickness: Option<f64>,
    /// Distance that contacts with a body alike are separated to [m]; a pair takes the mean of both. Default:
    /// that of the scene, and for particles their diameter.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub delta: Option<f64>,
    /// Largest ratio of an edge's length to its rest length [1], above 1; inf: no limit. Default: that of
    /// `[contact]` if it is given there (`paper` gives it), otherwise that of the material of a cloth and 1.1
    /// for other kinds.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stretch_limit: Option<f64>,
    /// Collision groups that the body is in, from 0 to 31 [1]. Default `[0]`.
    pub groups: Vec<u32>,
    /// Collision groups that it meets [1]; both sides must agree. Default: all.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub collides_with: Option<Vec<u32>>,
    /// Whether the body collides with itself. Default true.
    pub self_collision: bool,
}

/// Something that deformable bodies collide with and that moves only as prescribed, `[[obstacle]]`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ObstacleSpec {
    /// Name in messages. Default `obstacle` and its index.
    pub name: String,
    /// Mesh file (OBJ, PLY, MSH, T, SEG) relative to the scene file; of tetrahedra, the surface. This,
    /// `shape`, or `sequence`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mesh: Option<PathBuf>,
    /// Generated mesh or `half-space`, see the shapes. This, `mesh`, or `sequence`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub shape: Option<Shape>,
    /// An animation, relative to the scene file: a folder of meshes of equal elements, taken in the order of
    /// their names, or an NPZ archive of `X[f,n,3]` and `F[m,3]`. Frames are joined linearly. This, `mesh`,
    /// or `shape`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sequence: Option<PathBuf>,
    /// Frames of the sequence a second [1/s]. Default 30.
    pub sequence_rate: f64,
    /// When the sequence begins [s]; it is held at its first frame before, and at its last one after. Default
    /// 0.
    pub sequence_start: f64,
    /// Axis of the mesh that points up: `x`, `y` or `z`. Default `z`.
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

/// Vertices of a body that are held or led, `[[pin]]`. The vertices are those of all selectors given
/// (`vertices`, `box`, `side`, `roots`). While an obstacle or another body is in the way they wait, as one.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct PinSpec {
    /// Name of the body. May be left out if there is only one.
    pub body: String,
    /// Vertices by index in the body's mesh, from 0. Default none.
    pub vertices: Vec<u32>,
    /// Vertices within an axis-aligned box of the scene at its start. Default none.
    #[serde(rename = "box", skip_serializing_if = "Option::is_none")]
    pub region: Option<Region>,
    /// Vertices on a side of the body's bounding box: `x-min`, `x-max`, `y-min`, `y-max`, `z-min`,
    /// `z-max`. Default none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub side: Option<Side>,
    /// How many vertices of each strand are held, from its root on, the end that comes first in the mesh [1]:
    /// 1 hinges strands, 2 or more clamp their direction as well. Default 0.
    pub roots: usize,
    /// Rigid motion over time, see the motions. Default: held where they are.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub motion: Option<Motion>,
    /// Name of an obstacle with a mesh that they follow instead: each keeps its place relative to the
    /// triangle that is nearest to it when the pin takes hold, as if sewn on. Default none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub follow: Option<String>,
    /// When the pin takes hold [s]; it takes the vertices from where they are then. Default 0.
    pub start: f64,
    /// When it lets go [s]. Default inf.
    pub end: f64,
}

/// An axis-aligned box of the scene.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Region {
    /// Lower corner [m]; components may be -inf. Default -inf.
    pub min: Point,
    /// Upper corner [m]; components may be inf. Default inf.
    pub max: Point,
}

/// A side of a body's bounding box.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[allow(missing_docs)]
pub enum Side {
    XMin,
    XMax,
    YMin,
    YMax,
    ZMin,
    ZMax,
}

impl Side {
    /// Axis, and whether it is the upper end.
    pub fn axis(self) -> (usize, bool) {
        match self {
            Self::XMin => (0, false),
            Self::XMax => (0, true),
            Self::YMin => (1, false),
            Self::YMax => (1, true),
            Self::ZMin => (2, false),
            Self::ZMax => (2, true),
        }
    }
}

impl Default for Region {
    fn default() -> Self {
        let infinity = f64::INFINITY;
        Self {
            min: Point::new(-infinity, -infinity, -infinity),
            max: Point::new(infinity, infinity, infinity),
        }
    }
}

impl Region {
    /// Whether a point lies in the box or on its surface.
    pub fn contains(&self, p: &Point) -> bool {
        (0..3).all(|c| self.min[c] <= p[c] && p[c] <= self.max[c])
    }
}

impl Default for BodySpec {
    fn default() -> Self {
        Self {
            name: String::new(),
            kind: BodyKind::default(),
            mesh: None,
            shape: None,
            up: Up::Z,
            scale: 1.0,
            rotate: Vector::zeros(),
            translate: Vector::zeros(),
            velocity: Vector::zeros(),
            angular_velocity: Vector::zeros(),
            gravity: None,
            material: Material::default(),
            friction: 0.0,
            thickness: None,
            delta: None,
            stretch_limit: None,
            groups: vec![0],
            collides_with: None,
            self_collision: true,
        }
    }
}

impl Default for ObstacleSpec {
    fn default() -> Self {
        Self {
            name: String::new(),
            mesh: None,
            shape: None,
            sequence: None,
            sequence_rate: 30.0,
            sequence_start: 0.0,
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

impl Default for PinSpec {
    fn default() -> Self {
        Self {
            body: String::new(),
            vertices: Vec::new(),
            region: None,
            side: None,
            roots: 0,
            motion: None,
            follow: None,
            start: 0.0,
            end: f64::INFINITY,
        }
    }
}
