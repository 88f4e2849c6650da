//! Cleaning meshes that no simulation can start from: garments whose panels meet in seams without being
//! joined.
//!
//! What is done, in this order: vertices at the open borders of surfaces that lie together are welded; a
//! border vertex that lies on another border edge (a T-seam) splits the triangle there; triangles without
//! area and elements given twice are dropped, and vertices that nothing uses. Before and after, the exact
//! judge counts the intersections. What intersects away from borders is left as it is: no weld would cure it.
//!
//! Polygons, texture coordinates and names of an OBJ stay with their faces. Corners that are welded keep their
//! own texture coordinates and normals; a vertex on a T-seam gets texture coordinates between those of the
//! edge.

mod clean;
mod seams;
#[cfg(test)]
mod tests;
mod weld;

use bowknot_check::{CheckError, Judge, Parts, StateOptions};
use bowknot_errors::counted;
use bowknot_geometry::{MeshProblem, Point, Topology, check_mesh};
use bowknot_io::Mesh;
use serde::Serialize;

/// The default weld distance over the mean border edge.
const WELD_SHARE: f64 = 0.01;

/// How a mesh is repaired.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RepairParams {
    /// Border vertices nearer than this are welded [unit of the mesh]. Default: a hundredth of the mean border
    /// edge. Larger: wider seams close, but more of the cloth is pulled together; keep it below the shortest
    /// edge.
    pub weld_distance: Option<f64>,
    /// Whether all lines of a mesh of triangles are dropped. Default false.
    pub drop_lines: bool,
}

/// Intersections between two connected parts of a mesh, or of one with itself.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct PartIntersections {
    /// The parts, numbered by their smallest vertices; the same twice: a part with itself.
    pub parts: [u32; 2],
    /// Number of vertices of either part.
    pub vertices: [usize; 2],
    /// Pairs that intersect.
    pub count: usize,
}

/// What the exact judge says about a mesh.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Verdict {
    /// Vertices.
    pub vertices: usize,
    /// Triangles.
    pub triangles: usize,
    /// Connected parts.
    pub parts: usize,
    /// Vertices at open borders.
    pub border_vertices: usize,
    /// Pairs that intersect.
    pub intersections: usize,
    /// The same by parts, most first.
    pub by_parts: Vec<PartIntersections>,
    /// The first of them, in words.
    pub findings: Vec<String>,
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
    /// Strand edges dropped because they repeat another, have no length, or are lines that were to be dropped.
    pub dropped_strands: usize,
    /// Strand edges that stay beside triangles. Those between triangles keep the mesh from being cloth.
    pub lines: usize,
    /// Vertices dropped because nothing uses them, welded ones not counted.
    pub unused_vertices: usize,
    /// The mesh as it was; none if it could not be judged.
    pub before: Option<Verdict>,
    /// The mesh as it is.
    pub after: Verdict,
}

/// Why a mesh cannot be repaired.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RepairError {
    /// It has tetrahedra.
    #[error(
        "it has {}, and only surfaces and strands are repaired: repair its surface and mesh that again",
        counted(*count, "tetrahedron", "tetrahedra")
    )]
    Solid {
        /// How many.
        count: usize,
    },
    /// It has no triangles.
    #[error("it has no triangles: there is nothing to repair")]
    NoTriangles,
    /// The weld distance is not a length.
    #[error("weld distance {0} must be finite and above 0")]
    WeldDistance(f64),
    /// What remains cannot be judged.
    #[error(transparent)]
    Check(#[from] CheckError),
}

/// Repairs a mesh; see the [module](self) for what is done. Deterministic.
///
/// # Errors
/// Tetrahedra, no triangles, a weld distance that is no length, coordinates beyond the judge's range.
pub fn repair(mesh: &Mesh, params: &RepairParams) -> Result<(Mesh, RepairReport), RepairError> {
    if !mesh.tets.is_empty() {
        return Err(RepairError::Solid { count: mesh.tets.len() });
    }
    if mesh.triangles.is_empty() {
        return Err(RepairError::NoTriangles);
    }
    if let Some(distance) = params.weld_distance.filter(|d| !(d.is_finite() && *d > 0.0)) {
        return Err(RepairError::WeldDistance(distance));
    }
    // A mesh that repeats a vertex within a triangle is not judged as it is, but can be repaired.
    let mut report = RepairReport { before: judge(mesh).ok(), ..RepairReport::default() };
    let mut mesh = mesh.clone();
    if params.drop_lines {
        report.dropped_strands = std::mem::take(&mut mesh.strands).len();
    }
    // First, so that a triangle given twice does not hide a border, nor one without area make one.
    clean::drop_bad_elements(&mut mesh, &mut report);
    report.unused_vertices = mesh.drop_unused_vertices();
    let distance = params.weld_distance.unwrap_or_else(|| WELD_SHARE * mean_border_edge(&mesh));
    report.weld_distance = distance;
    weld::weld(&mut mesh, distance, &mut report);
    clean::drop_bad_elements(&mut mesh, &mut report);
    seams::split_t_seams(&mut mesh, distance, &mut report);
    clean::drop_bad_elements(&mut mesh, &mut report);
    mesh.drop_unused_vertices();
    report.lines = mesh.strands.len();
    report.after = judge(&mesh)?;
    Ok((mesh, report))
}

/// Border edges: those of one triangle only, with it.
fn border_edges(mesh: &Mesh) -> Vec<([u32; 2], u32)> {
    let mut edges: Vec<([u32; 2], u32)> = (0..)
        .zip(&mesh.triangles)
        .flat_map(|(t, &[i, j, k])| [[i, j], [j, k], [k, i]].map(|[a, b]| ([a.min(b), a.max(b)], t)))
        .collect();
    edges.sort_unstable();
    edges.chunk_by(|a, b| a.0 == b.0).filter(|same| same.len() == 1).map(|same| same[0]).collect()
}

/// Vertices of border edges, ascending.
fn border_vertices(mesh: &Mesh) -> Vec<u32> {
    let mut vertices: Vec<u32> = border_edges(mesh).iter().flat_map(|(edge, _)| *edge).collect();
    vertices.sort_unstable();
    vertices.dedup();
    vertices
}

/// Mean length of the border edges [unit of the mesh]; 0 if there are none.
fn mean_border_edge(mesh: &Mesh) -> f64 {
    let edges = border_edges(mesh);
    let length =
        |([a, b], _): &([u32; 2], u32)| (mesh.positions[*a as usize] - mesh.positions[*b as usize]).norm();
    edges.iter().map(length).sum::<f64>() / edges.len().max(1) as f64
}

/// Pairs of points nearer than `distance`, smaller index first, nearest pairs first. By a sweep along x.
fn near_pairs(points: &[(u32, Point)], distance: f64) -> Vec<(f64, u32, u32)> {
    let mut sorted = points.to_vec();
    sorted.sort_by(|a, b| a.1.x.total_cmp(&b.1.x).then(a.0.cmp(&b.0)));
    let mut pairs = Vec::new();
    for (k, (a, p)) in sorted.iter().enumerate() {
        for (b, q) in sorted[k + 1..].iter().take_while(|(_, q)| q.x - p.x <= distance) {
            let apart = (p - q).norm();
            if apart <= distance {
                pairs.push((apart, *a.min(b), *a.max(b)));
            }
        }
    }
    pairs.sort_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
    pairs
}

fn judge(mesh: &Mesh) -> Result<Verdict, CheckError> {
    /// Findings in words.
    const LISTED: usize = 5;
    let parts = Parts {
        vertex_count: mesh.positions.len(),
        triangles: &mesh.triangles,
        strands: &mesh.strands,
        particles: &mesh.particles,
        ..Parts::default()
    };
    let judge = Judge::new(&parts)?;
    let state = judge.check_state(&mesh.positions, &StateOptions { limit: usize::MAX, distance: false })?;
    // The judge has taken the elements, so the topology does.
    let topology = Topology::builder(mesh.positions.len())
        .triangles(mesh.triangles.iter().copied())
        .strand_edges(mesh.strands.iter().copied())
        .build()
        .unwrap_or_default();
    let components = topology.connected_components();
    let part = |v: u32| components.of_vertex.get(v as usize).copied().unwrap_or(0);
    let mut sizes = vec![0; components.count];
    components.of_vertex.iter().for_each(|&c| sizes[c as usize] += 1);

    let mut pairs: Vec<[u32; 2]> = state
        .intersections
        .iter()
        .filter_map(|i| Some([part(*i.vertices[0].first()?), part(*i.vertices[1].first()?)]))
        .map(|[a, b]| [a.min(b), a.max(b)])
        .collect();
    pairs.sort_unstable();
    let mut by_parts: Vec<PartIntersections> = pairs
        .chunk_by(|a, b| a == b)
        .map(|same| PartIntersections {
            parts: same[0],
            vertices: same[0].map(|p| sizes[p as usize]),
            count: same.len(),
        })
        .collect();
    by_parts.sort_by_key(|entry| std::cmp::Reverse(entry.count));
    Ok(Verdict {
        vertices: mesh.positions.len(),
        triangles: mesh.triangles.len(),
        parts: components.count,
        border_vertices: border_vertices(mesh).len(),
        intersections: state.intersection_count,
        by_parts,
        findings: state.intersections.iter().take(LISTED).map(ToString::to_string).collect(),
    })
}

/// The problems of the triangles that dropping them cures.
fn droppable(mesh: &Mesh) -> Vec<MeshProblem> {
    let mut problems = check_mesh(&mesh.positions, &mesh.triangles);
    problems.retain(|p| matches!(p, MeshProblem::ZeroArea { .. } | MeshProblem::RepeatedTriangle { .. }));
    problems
}
