//! Bodies, obstacles and pins as a scene describes them.

use super::motion::Motion;
use crate::io::Up;
use crate::shapes::Shape;
use bowknot_dynamics::ClothMaterial;
use bowknot_geometry::{Point, Vector};
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// A deformable body, `[[body]]`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct BodySpec {
    /// Name in messages and for pins; no two bodies share one. Default `body` and its index.
    pub name: String,
    /// What the body is made of: `cloth`, a surface of triangles. Default `cloth`.
    pub kind: BodyKind,
    /// Mesh file, OBJ or PLY, relative to the scene file. Either this or `shape`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mesh: Option<PathBuf>,
    /// Generated mesh, see the shapes. Either this or `mesh`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub shape: Option<Shape>,
    /// Axis of the mesh that points up: `x`, `y` or `z`. Default `z`.
    pub up: Up,
    /// Factor on the mesh's coordinates [1]: 0.001 for a mesh in millimetres. Default 1.
    pub scale: f64,
    /// Rotation about the x, then the y, then the z axis through the origin [deg], after `up` and
    /// `scale`. Default (0, 0, 0).
    pub rotate: Vector,
    /// Displacement after the rotation [m]. Default (0, 0, 0).
    pub translate: Vector,
    /// Initial velocity [m/s]. Default (0, 0, 0).
    pub velocity: Vector,
    /// A fabric by name, or a table of the numbers of a cloth over those of its `fabric`. Default
    /// `cotton`.
    pub material: Material,
    /// Collision groups that the body is in, from 0 to 31 [1]. Default `[0]`.
    pub groups: Vec<u32>,
    /// Collision groups that it meets [1]; both sides must agree. Default: all.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub collides_with: Option<Vec<u32>>,
    /// Whether the body collides with itself. Default true.
    pub self_collision: bool,
}

/// What a deformable body is made of.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum BodyKind {
    /// A surface that stretches and bends.
    #[default]
    Cloth,
}

/// Material of a body, of the kind that the body is.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
#[non_exhaustive]
pub enum Material {
    /// Of a cloth.
    Cloth(ClothMaterial),
}

/// Something that deformable bodies collide with and that moves only as prescribed, `[[obstacle]]`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ObstacleSpec {
    /// Name in messages. Default `obstacle` and its index.
    pub name: String,
    /// Mesh file, OBJ or PLY, relative to the scene file. Either this or `shape`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mesh: Option<PathBuf>,
    /// Generated mesh or `half-space`, see the shapes. Either this or `mesh`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub shape: Option<Shape>,
    /// Axis of the mesh that points up: `x`, `y` or `z`. Default `z`.
    pub up: Up,
    /// Factor on the mesh's coordinates [1]: 0.001 for a mesh in millimetres. Default 1.
    pub scale: f64,
    /// Rotation about the x, then the y, then the z axis through the origin [deg], after `up` and
    /// `scale`. Default (0, 0, 0).
    pub rotate: Vector,
    /// Displacement after the rotation [m]. Default (0, 0, 0).
    pub translate: Vector,
    /// Rigid motion over time, see the motions; not for a half-space. Default: at rest.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub motion: Option<Motion>,
    /// Collision groups that the obstacle is in, from 0 to 31 [1]. A half-space meets all. Default
    /// `[0]`.
    pub groups: Vec<u32>,
    /// Collision groups that it meets [1]; both sides must agree. Default: all.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub collides_with: Option<Vec<u32>>,
}

/// Vertices of a body that are held or led, `[[pin]]`. The vertices are those of all selectors given
/// (`vertices`, `box`, `side`).
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

impl Default for Material {
    fn default() -> Self {
        Self::Cloth(ClothMaterial::default())
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
            material: Material::default(),
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
            up: Up::Z,
            scale: 1.0,
            rotate: Vector::zeros(),
            translate: Vector::zeros(),
            motion: None,
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
            motion: None,
            follow: None,
            start: 0.0,
            end: f64::INFINITY,
        }
    }
}
