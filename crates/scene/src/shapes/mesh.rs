//! What surfaces are generated as.

use bowknot_geometry::Point;

/// Vertices and triangles of a generated mesh.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TriangleMesh {
    /// Vertices [m].
    pub positions: Vec<Point>,
    /// Triangles; on closed meshes counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
}

/// Number of segments of about `edge` that a length is divided into, at least 1.
pub(super) fn segments(length: f64, edge: f64) -> u32 {
    (length / edge).round().clamp(1.0, 1e6) as u32
}
