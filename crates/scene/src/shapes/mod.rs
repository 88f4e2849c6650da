//! Generated meshes: deterministic, in metres, z up, about the origin.

mod ball;
mod block;
mod cone;
mod cuboid;
mod figure;
mod garment;
mod grains;
mod isosurface;
mod lathe;
mod ribbon;
mod round_cone;
mod sheet;
mod strands;
mod tet_ball;
mod tube;
mod wedge;
mod woven;

pub use ball::Ball;
pub use block::Block;
pub use cone::Cone;
pub use cuboid::Cuboid;
pub use figure::{AnimatedFigure, Figure};
pub use garment::Garment;
pub use grains::Grains;
pub use lathe::Lathe;
pub use ribbon::Ribbon;
pub use round_cone::{RoundCone, RoundCones};
pub use sheet::{Diagonals, Sheet};
pub use strands::{Root, Strands};
pub use tet_ball::TetBall;
pub use tube::Tube;
pub use wedge::Wedge;
pub use woven::Woven;

use crate::kind::BodyKind;
use bowknot_geometry::{Point, Vector};
use bowknot_io::Mesh;
use serde::{Deserialize, Serialize};
use std::fmt;
use std::sync::Arc;

/// A generated mesh, or the analytic half-space; the key `type` tells which.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "type", rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Shape {
    /// A flat rectangle.
    Sheet(Sheet),
    /// An open cylinder.
    Tube(Tube),
    /// A closed sphere.
    Ball(Ball),
    /// A closed cone, such as a needle.
    Cone(Cone),
    /// A closed box.
    Box(Cuboid),
    /// A human figure that walks. For obstacles only.
    Figure(Figure),
    /// A tube of cloth around the figure.
    Garment(Garment),
    /// A closed, sharp wedge, such as a blade.
    Wedge(Wedge),
    /// A surface of revolution, such as a funnel.
    Lathe(Lathe),
    /// A strip along a curve.
    Ribbon(Ribbon),
    /// Everything below a plane, such as the ground. For obstacles only.
    HalfSpace(HalfSpaceShape),
    /// A box of tetrahedra.
    Block(Block),
    /// A ball of tetrahedra.
    TetBall(TetBall),
    /// A bundle of strands. For deformable bodies only.
    Strands(Strands),
    /// A plain weave of strands. For deformable bodies only.
    Woven(Woven),
    /// Particles in a box. For deformable bodies only.
    Grains(Grains),
}

/// Everything below the plane through the obstacle's `translate`: an analytic obstacle without mesh.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct HalfSpaceShape {
    /// Direction out of the solid [1], of any length but zero. Default (0, 0, 1).
    pub normal: Vector,
}

impl Default for HalfSpaceShape {
    fn default() -> Self {
        Self { normal: Vector::z() }
    }
}

/// Vertices and triangles of a generated mesh.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TriangleMesh {
    /// Vertices [m].
    pub positions: Vec<Point>,
    /// Triangles; on closed meshes counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
}

/// A generated shape whose vertices move: what an obstacle of that shape follows.
///
/// The vertices are those of [`Shape::mesh`], in its order and in the shape's own axes; their places must be
/// continuous in time, and the same at every call.
pub trait Animated: fmt::Debug + Send + Sync {
    /// Where all vertices are at a time [s], from 0 [m].
    fn positions(&self, time: f64) -> Vec<Point>;
}

/// More vertices than this in one shape are refused: a mistyped edge length rather than a wish.
const MOST_VERTICES: f64 = 2e7;

impl Shape {
    /// Names that the key `type` may have.
    pub const NAMES: [&'static str; 16] = [
        "sheet",
        "tube",
        "ball",
        "cone",
        "box",
        "figure",
        "garment",
        "wedge",
        "lathe",
        "ribbon",
        "half-space",
        "block",
        "tet-ball",
        "strands",
        "woven",
        "grains",
    ];

    /// The kind of body that the shape makes; a half-space makes none, and counts as a surface.
    pub fn kind(&self) -> BodyKind {
        match self {
            Self::Block(_) | Self::TetBall(_) => BodyKind::Solid,
            Self::Strands(_) | Self::Woven(_) => BodyKind::Strands,
            Self::Grains(_) => BodyKind::Particles,
            _ => BodyKind::Cloth,
        }
    }

    /// What the shape is made of; none for a half-space.
    pub fn elements(&self) -> Option<Mesh> {
        match self {
            Self::Block(block) => Some(block.mesh()),
            Self::TetBall(ball) => Some(ball.mesh()),
            Self::Strands(strands) => Some(strands.mesh()),
            Self::Woven(woven) => Some(woven.mesh()),
            Self::Grains(grains) => Some(grains.mesh()),
            surface => surface.mesh().map(|TriangleMesh { positions, triangles }| Mesh {
                positions,
                triangles,
                ..Mesh::default()
            }),
        }
    }

    /// The mesh of a surface; none for a half-space, and for shapes of other elements.
    pub fn mesh(&self) -> Option<TriangleMesh> {
        match self {
            Self::Sheet(sheet) => Some(sheet.mesh()),
            Self::Tube(tube) => Some(tube.mesh()),
            Self::Ball(ball) => Some(ball.mesh()),
            Self::Cone(cone) => Some(cone.mesh()),
            Self::Box(cuboid) => Some(cuboid.mesh()),
            Self::Figure(figure) => Some(figure.mesh()),
            Self::Garment(garment) => Some(garment.mesh()),
            Self::Wedge(wedge) => Some(wedge.mesh()),
            Self::Lathe(lathe) => Some(lathe.mesh()),
            Self::Ribbon(ribbon) => Some(ribbon.mesh()),
            Self::HalfSpace(_)
            | Self::Block(_)
            | Self::TetBall(_)
            | Self::Strands(_)
            | Self::Woven(_)
            | Self::Grains(_) => None,
        }
    }

    /// The shape as one that moves by itself; none for those that do not. Its mesh is that at time 0.
    pub fn animated(&self) -> Option<Arc<dyn Animated>> {
        match self {
            Self::Figure(figure) => Some(Arc::new(AnimatedFigure::new(*figure))),
            _ => None,
        }
    }

    /// Appends the field and what is wrong with it.
    pub(crate) fn validate(&self, problems: &mut Vec<(&'static str, String)>) {
        let (lengths, area, edge): (Vec<(&'static str, f64)>, f64, f64) = match self {
            Self::Sheet(s) => (vec![("size", s.size[0]), ("size", s.size[1])], s.size[0] * s.size[1], s.edge),
            Self::Tube(t) => {
                (vec![("radius", t.radius), ("length", t.length)], 7.0 * t.radius * t.length, t.edge)
            }
            Self::Ball(b) => (vec![("radius", b.radius)], 13.0 * b.radius * b.radius, b.edge),
            Self::Cone(c) => (
                vec![("radius", c.radius), ("height", c.height)],
                4.0 * c.radius * (c.radius + c.height),
                c.edge,
            ),
            Self::Box(b) => (
                b.size.iter().map(|&s| ("size", s)).collect(),
                2.0 * (b.size[0] * b.size[1] + b.size[1] * b.size[2] + b.size[2] * b.size[0]),
                b.edge,
            ),
            Self::Figure(figure) => {
                figure.validate(problems);
                (Vec::new(), 2.0, figure.edge)
            }
            Self::Garment(garment) => {
                garment.validate(problems);
                (Vec::new(), garment.area(), garment.edge)
            }
            Self::Wedge(w) => (
                vec![("length", w.length), ("thickness", w.thickness), ("height", w.height)],
                2.0 * w.length * (w.height + w.thickness),
                w.edge,
            ),
            Self::Lathe(l) => {
                let before = problems.len();
                l.validate(problems);
                let widest = l.profile.iter().fold(0.0f64, |m, p| m.max(p[0]));
                let area = if problems.len() == before { 7.0 * widest * l.profile_length() } else { 0.0 };
                (Vec::new(), area, l.edge)
            }
            Self::Ribbon(r) => {
                let before = problems.len();
                r.validate(problems);
                let area = if problems.len() == before { r.width * r.length() } else { 0.0 };
                (vec![("width", r.width)], area, r.edge)
            }
            Self::HalfSpace(h) => {
                if !(h.normal.iter().all(|c| c.is_finite()) && h.normal.norm() > 0.0) {
                    problems.push(("normal", "must be finite and not zero".to_owned()));
                }
                return;
            }
            Self::Block(block) => return block.validate(problems),
            Self::TetBall(ball) => return ball.validate(problems),
            Self::Strands(strands) => return strands.validate(problems),
            Self::Woven(woven) => return woven.validate(problems),
            Self::Grains(grains) => return grains.validate(problems),
        };
        if let Self::Cone(Cone { sides, .. }) = self
            && !(3..=1000).contains(sides)
        {
            problems.push(("sides", format!("{sides} must lie from 3 to 1000")));
        }
        let before = problems.len();
        let reported = problems.iter().any(|problem| problem.0 == "edge");
        let edges = [("edge", edge)].into_iter().filter(|_| !reported);
        for (key, value) in lengths.into_iter().chain(edges) {
            if !(value.is_finite() && value > 0.0) {
                problems.push((key, format!("{value} must be a length in metres above 0")));
            }
        }
        if problems.len() == before && !reported && area / (edge * edge) > MOST_VERTICES {
            problems.push((
                "edge",
                format!("{edge} m would make more than {MOST_VERTICES:e} vertices; it must be larger"),
            ));
        }
    }
}

/// Reports lengths that are none; whether all are.
fn above_0(
    lengths: impl Iterator<Item = (&'static str, f64)>,
    problems: &mut Vec<(&'static str, String)>,
) -> bool {
    let before = problems.len();
    for (key, value) in lengths {
        if !(value.is_finite() && value > 0.0) {
            problems.push((key, format!("{value} must be a length in metres above 0")));
        }
    }
    problems.len() == before
}

/// Reports an edge length that makes too many vertices.
fn too_many(vertices: f64, edge: f64, problems: &mut Vec<(&'static str, String)>) {
    if vertices > MOST_VERTICES {
        let message = format!("{edge} m would make more than {MOST_VERTICES:e} vertices; it must be larger");
        problems.push(("edge", message));
    }
}

/// Number of segments of about `edge` that a length is divided into, at least 1.
fn segments(length: f64, edge: f64) -> u32 {
    (length / edge).round().clamp(1.0, 1e6) as u32
}

#[cfg(test)]
mod elements_tests;
#[cfg(test)]
mod tests;
