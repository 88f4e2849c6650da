//! What was done to a tetrahedral mesh.

use bowknot_geometry::Point;
use serde::Serialize;

/// How many of something, and where the first is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Found {
    /// How many.
    pub count: usize,
    /// Center of the first [unit of the mesh].
    pub first: Option<[f64; 3]>,
}

impl Found {
    pub(super) fn add(&mut self, place: Point) {
        self.count += 1;
        self.first.get_or_insert(place.coords.into());
    }
}

/// What was done to a tetrahedral mesh, beside what [`RepairReport`](super::RepairReport) counts for all
/// meshes.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct SolidRepair {
    /// Tetrahedra dropped because they name a vertex twice.
    pub repeated_vertices: Found,
    /// Tetrahedra dropped because they repeat another.
    pub repeated_tets: Found,
    /// Flat tetrahedra dropped where nothing else met.
    pub flat_dropped: Found,
    /// Flat tetrahedra collapsed: the edges or faces that coincide in them were split at a common vertex.
    pub flat_collapsed: Found,
    /// Vertices added by that.
    pub added_vertices: usize,
    /// Tetrahedra whose vertices had the opposite order.
    pub turned: Found,
    /// Tetrahedra dropped because they lie on the same side of a face as another.
    pub overlapping: Found,
    /// Triangles dropped: those that are faces of tetrahedra, and all if that was asked for.
    pub dropped_triangles: usize,
    /// Triangles that are no faces of tetrahedra and stay. They keep the mesh from being a solid.
    pub triangles: Found,
    /// Tetrahedra whose smallest height is below a hundredth of their longest edge. They stay.
    pub thin: Found,
    /// The smallest height over the longest edge of any tetrahedron, and the center of that [unit of the
    /// mesh].
    pub thinnest: Option<(f64, [f64; 3])>,
    /// Sum of the volumes of the tetrahedra before and after, each positive [unit of the mesh, cubed].
    pub volume: [f64; 2],
}
