//! The choice among all shapes.

use super::animated::Animated;
use super::arrays::MeshArrays;
use super::ball::Ball;
use super::block::Block;
use super::cone::Cone;
use super::cuboid::Cuboid;
use super::figure::{AnimatedFigure, Figure};
use super::garment::Garment;
use super::grains::Grains;
use super::half_space::HalfSpaceShape;
use super::lathe::Lathe;
use super::limits::{limit_vertices, positive_lengths};
use super::mesh::TriangleMesh;
use super::ribbon::Ribbon;
use super::sheet::Sheet;
use super::strands::Strands;
use super::tet_ball::TetBall;
use super::tube::Tube;
use super::wedge::Wedge;
use super::woven::Woven;
use crate::kind::BodyKind;
use bowknot_errors::{Checks, Parameters};
use bowknot_io::Mesh;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// A generated mesh, one that is given by its arrays, or the analytic half-space; the key `type` tells which.
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
    /// A mesh by its arrays.
    Arrays(MeshArrays),
}

impl Shape {
    /// Names that the key `type` may have.
    pub const NAMES: [&'static str; 17] = [
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
        "arrays",
    ];

    /// The kind of body that the shape makes; a half-space makes none, and counts as a surface.
    pub fn kind(&self) -> BodyKind {
        match self {
            Self::Block(_) | Self::TetBall(_) => BodyKind::Solid,
            Self::Strands(_) | Self::Woven(_) => BodyKind::Strands,
            Self::Grains(_) => BodyKind::Particles,
            Self::Arrays(arrays) => arrays.kind(),
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
            Self::Arrays(arrays) => Some(arrays.mesh()),
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
            | Self::Grains(_)
            | Self::Arrays(_) => None,
        }
    }

    /// The shape as one that moves by itself; none for those that do not. Its mesh is that at time 0.
    pub fn animated(&self) -> Option<Arc<dyn Animated>> {
        match self {
            Self::Figure(figure) => Some(Arc::new(AnimatedFigure::new(*figure))),
            _ => None,
        }
    }
}

impl Parameters for Shape {
    fn check(&self, checks: &mut Checks) {
        // Lengths that must be positive, the area, and the length of edges: which bounds the number of
        // vertices.
        let before = checks.error_count();
        let (lengths, area, edge): (Vec<(&'static str, f64)>, f64, f64) = match self {
            Self::Sheet(s) => (vec![("size", s.size[0]), ("size", s.size[1])], s.size[0] * s.size[1], s.edge),
            Self::Tube(t) => {
                (vec![("radius", t.radius), ("length", t.length)], 7.0 * t.radius * t.length, t.edge)
            }
            Self::Ball(b) => (vec![("radius", b.radius)], 13.0 * b.radius * b.radius, b.edge),
            Self::Cone(c) => {
                let fits = (3..=1000).contains(&c.sides);
                checks.require(fits, "sides", c.sides, "must lie from 3 to 1000");
                let lengths = vec![("radius", c.radius), ("height", c.height)];
                (lengths, 4.0 * c.radius * (c.radius + c.height), c.edge)
            }
            Self::Box(b) => (
                b.size.iter().map(|&s| ("size", s)).collect(),
                2.0 * (b.size[0] * b.size[1] + b.size[1] * b.size[2] + b.size[2] * b.size[0]),
                b.edge,
            ),
            Self::Figure(figure) => {
                figure.check(checks);
                (Vec::new(), 2.0, figure.edge)
            }
            Self::Garment(garment) => {
                garment.check(checks);
                (Vec::new(), garment.area(), garment.edge)
            }
            Self::Wedge(w) => (
                vec![("length", w.length), ("thickness", w.thickness), ("height", w.height)],
                2.0 * w.length * (w.height + w.thickness),
                w.edge,
            ),
            Self::Lathe(l) => {
                l.check(checks);
                let widest = l.profile.iter().fold(0.0f64, |m, p| m.max(p[0]));
                let area =
                    if checks.error_count() == before { 7.0 * widest * l.profile_length() } else { 0.0 };
                (Vec::new(), area, l.edge)
            }
            Self::Ribbon(r) => {
                r.check(checks);
                let area = if checks.error_count() == before { r.width * r.length() } else { 0.0 };
                (vec![("width", r.width)], area, r.edge)
            }
            Self::HalfSpace(half_space) => return half_space.check(checks),
            Self::Block(block) => return block.check(checks),
            Self::TetBall(ball) => return ball.check(checks),
            Self::Strands(strands) => return strands.check(checks),
            Self::Woven(woven) => return woven.check(checks),
            Self::Grains(grains) => return grains.check(checks),
            Self::Arrays(arrays) => return arrays.check(checks),
        };
        // Figures and garments have checked their edge themselves.
        let checked = matches!(self, Self::Figure(_) | Self::Garment(_));
        let edges = [("edge", edge)].into_iter().filter(|_| !checked);
        let fits = positive_lengths(lengths.into_iter().chain(edges), checks);
        if fits && checks.error_count() == before {
            limit_vertices(area / (edge * edge), edge, checks);
        }
    }
}
