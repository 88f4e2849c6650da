//! What a repair is asked for, and what it says.

use super::solid_report::SolidRepair;
use super::verdict::Verdict;
use bowknot_check::CheckError;
use serde::Serialize;

/// How a mesh is repaired.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RepairParams {
    /// Border vertices, and any vertices of solids, nearer than this are welded [unit of the mesh]. Default:
    /// a hundredth of the mean border edge; of solids a ten-thousandth of the mean edge. Larger: wider seams
    /// close, but more of the cloth is pulled together; keep it below the shortest edge.
    pub weld_distance: Option<f64>,
    /// Whether all lines of a mesh of triangles or tetrahedra are dropped. Default false.
    pub drop_lines: bool,
    /// Whether all triangles of a mesh of tetrahedra are dropped. Default false.
    pub drop_triangles: bool,
}

/// What was done to a mesh. Vertices are those of the file, triangles those at the time. Lengths are in the
/// unit of the mesh, which need not be the meter.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct RepairReport {
    /// The weld distance used [unit of the mesh].
    pub weld_distance: f64,
    /// Vertices that were welded to another one.
    pub welded_vertices: usize,
    /// The farthest that welding moved a vertex [unit of the mesh].
    pub largest_move: f64,
    /// Where the first were welded [unit of the mesh].
    pub weld_places: Vec<[f64; 3]>,
    /// Triangles that were split at a vertex of a T-seam.
    pub split_triangles: usize,
    /// Triangles dropped because they have no area.
    pub zero_area_triangles: usize,
    /// Triangles dropped because they repeat another.
    pub repeated_triangles: usize,
    /// Polygons of an OBJ that were cut because triangles of them were dropped or split.
    pub cut_polygons: usize,
    /// Strand edges dropped because they repeat another, have no length, or are lines that were to be
    /// dropped.
    pub dropped_strands: usize,
    /// Strand edges that stay beside triangles. Those between triangles keep the mesh from being cloth.
    pub lines: usize,
    /// Vertices dropped because nothing uses them, welded ones not counted.
    pub unused_vertices: usize,
    /// What was done to tetrahedra; none if there are none.
    pub solid: Option<SolidRepair>,
    /// The mesh as it was; none if it could not be judged.
    pub before: Option<Verdict>,
    /// The mesh as it is.
    pub after: Verdict,
}

/// Why a mesh cannot be repaired.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RepairError {
    /// It has no triangles and no tetrahedra.
    #[error("it has no triangles and no tetrahedra: there is nothing to repair")]
    NoElements,
    /// The weld distance is not a length.
    #[error("weld distance {0} must be finite and above 0")]
    WeldDistance(f64),
    /// What remains cannot be judged.
    #[error(transparent)]
    Check(#[from] CheckError),
}
