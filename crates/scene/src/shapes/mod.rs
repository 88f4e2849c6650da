//! Generated meshes: deterministic, in meters, z up, about the origin.

mod animated;
mod arrays;
mod ball;
mod block;
mod cone;
mod cuboid;
mod figure;
mod garment;
mod grains;
mod half_space;
mod isosurface;
mod lathe;
mod limits;
mod mesh;
mod ribbon;
mod round_cone;
mod shape;
mod sheet;
mod strands;
#[cfg(test)]
mod tests;
mod tet_ball;
mod tube;
mod wedge;
mod woven;

pub use animated::Animated;
pub use arrays::MeshArrays;
pub use ball::Ball;
pub use block::Block;
pub use cone::Cone;
pub use cuboid::Cuboid;
pub use figure::{AnimatedFigure, Figure};
pub use garment::Garment;
pub use grains::Grains;
pub use half_space::HalfSpaceShape;
pub use lathe::Lathe;
pub use mesh::TriangleMesh;
pub use ribbon::Ribbon;
pub use round_cone::{RoundCone, RoundCones};
pub use shape::Shape;
pub use sheet::{Diagonals, Sheet};
pub use strands::{Root, Strands};
pub use tet_ball::TetBall;
pub use tube::Tube;
pub use wedge::Wedge;
pub use woven::Woven;
