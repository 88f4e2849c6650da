//! What modeling tools say about the faces of a mesh: polygons, texture coordinates, which corners share a
//! normal, names of objects, groups and materials, smoothing groups.
//!
//! A simulation knows triangles only. The polygons cut into fans around their first corners are the triangles
//! of their mesh, in the same order: whoever drops or renumbers triangles does the same with the surface.
//! Readers take polygons as they are, since those of a frame have deformed;
//! [`Mesh::triangulate`](crate::Mesh::triangulate) makes such fans fill a polygon that is concave.

mod edit;
mod normals;
mod polygons;
mod triangulate;

pub use edit::EdgeSplit;
pub use polygons::{Corner, Labels, Polygon, Surface};
pub use triangulate::PolygonFaults;
