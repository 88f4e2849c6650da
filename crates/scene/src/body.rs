//! Deformable bodies as a scene describes them.

use crate::elements::SolidElements;
use crate::kind::BodyKind;
use crate::material::Material;
use crate::shapes::{MeshArrays, Shape};
use bowknot_errors::{Checks, Parameters};
use bowknot_geometry::Vector;
use bowknot_io::{Import, Up};
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
    /// Mesh file (OBJ, PLY, STL, MSH, MESH, ELE, VTU, T, SEG, USD, glTF) relative to the scene file, with the elements
    /// of the kind. Either this or `shape`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mesh: Option<PathBuf>,
    /// The part of the mesh file that is taken, if it has several: a prim of a USD stage by its name or path, or
    /// all below that path; a node of a glTF scene, an object of an OBJ by its name. Default: all as one mesh.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub part: Option<String>,
    /// Generated mesh, or one by its arrays, see the shapes. Either this or `mesh`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub shape: Option<Shape>,
    /// The elements of a solid: `linear` or `quadratic`. Linear tetrahedra are too stiff in bending where a
    /// body is only a few of them thick. Quadratic ones are not: each edge gets a vertex in its middle, which
    /// follow those of the mesh in number, and each tetrahedron becomes eight small ones in frames and for
    /// contact. Default: quadratic for a shape that is fewer than three elements thick and more than four
    /// times as long as thick, linear otherwise.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub elements: Option<SolidElements>,
    /// Whether lines of a cloth's mesh that join vertices of its triangles where no edge does are left out.
    /// Other programs sew along such lines; sewing is not simulated, so without this key they are refused.
    /// Lines that lead elsewhere or run along edges are left out with a warning anyway. Default false.
    pub drop_lines: bool,
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
    /// `[contact]` if it is given there (`paper` gives it), otherwise that of the material of a cloth, none
    /// for solids and 1.1 for strands.
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

impl Default for BodySpec {
    fn default() -> Self {
        Self {
            name: String::new(),
            kind: BodyKind::default(),
            mesh: None,
            part: None,
            shape: None,
            elements: None,
            drop_lines: false,
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

impl Parameters for BodySpec {
    fn check(&self, checks: &mut Checks) {
        check_placement(checks, self.scale, &self.rotate, &self.translate);
        checks.all_finite("velocity", &self.velocity);
        checks.all_finite("angular_velocity", &self.angular_velocity);
        if let Some(gravity) = &self.gravity {
            checks.all_finite("gravity", gravity);
        }
        check_groups(checks, &self.groups, self.collides_with.as_deref());
        checks.non_negative("friction", self.friction);
        if let Some(thickness) = self.thickness {
            checks.non_negative("thickness", thickness);
        }
        if let Some(delta) = self.delta {
            checks.positive("delta", delta);
        }
        if let Some(limit) = self.stretch_limit {
            checks.above_or_infinite("stretch_limit", limit, 1.0);
        }
        if self.material.kind() != self.kind {
            let (own, kind) = (self.material.kind().name(), self.kind.name());
            checks.contradiction("material", format!("is one of kind {own}, but the body is of kind {kind}"));
        }
        checks.within("material", &self.material);
        if self.part.is_some() && self.mesh.is_none() {
            checks.contradiction("part", "needs a mesh file, of which it names a part");
        }
        match &self.shape {
            None if self.mesh.is_none() => checks.contradiction("mesh", "needs a mesh file, or a shape"),
            None => {}
            Some(shape) => {
                if self.mesh.is_some() {
                    checks.contradiction("shape", "stands beside mesh; only one of them may be given");
                }
                if let Some(message) = self.unfit(shape) {
                    checks.contradiction("shape", message);
                }
                checks.within("shape", shape);
            }
        }
    }
}

impl BodySpec {
    /// A body of a mesh in memory, of the kind that its elements make, with the first material of that kind.
    pub fn from_arrays(name: impl Into<String>, mesh: MeshArrays) -> Self {
        let kind = mesh.kind();
        let (shape, material) = (Some(Shape::Arrays(mesh)), Material::of(kind));
        Self { name: name.into(), kind, shape, material, ..Self::default() }
    }

    /// Why a shape is none for this body.
    fn unfit(&self, shape: &Shape) -> Option<String> {
        let (own, kind) = (shape.kind(), self.kind);
        match shape {
            Shape::HalfSpace(_) => Some("a half-space can only be an obstacle".to_owned()),
            Shape::Figure(_) => Some("a figure can only be an obstacle".to_owned()),
            _ if own != kind => {
                let (own, kind) = (own.name(), kind.name());
                Some(format!("makes a body of kind {own}, but this one is of kind {kind}"))
            }
            _ => None,
        }
    }
}

/// Checks where a mesh is placed.
pub(crate) fn check_placement(checks: &mut Checks, scale: f64, rotate: &Vector, translate: &Vector) {
    Import { scale, ..Import::default() }.check(checks);
    checks.all_finite("rotate", rotate);
    checks.all_finite("translate", translate);
}

/// Checks collision groups.
pub(crate) fn check_groups(checks: &mut Checks, groups: &[u32], collides_with: Option<&[u32]>) {
    for (field, list) in [("groups", groups), ("collides_with", collides_with.unwrap_or_default())] {
        if let Some(group) = list.iter().find(|group| **group > 31) {
            checks.refuse(field, format!("group {group}"), "must be at most 31");
        }
    }
    if groups.is_empty() {
        checks.contradiction("groups", "must name at least one group");
    }
}
