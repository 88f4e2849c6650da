//! Edges of a mesh.

use bowknot::io::Mesh;

/// Mean length of the edges of triangles and strands [m], in which an edge counts once per element; none if
/// there are no edges.
pub fn mean_edge(mesh: &Mesh) -> Option<f64> {
    let sides = mesh.triangles.iter().flat_map(|&[i, j, k]| [[i, j], [j, k], [k, i]]);
    let lengths = sides
        .chain(mesh.strands.iter().copied())
        .map(|[i, j]| (mesh.positions[i as usize] - mesh.positions[j as usize]).norm())
        // Those of obstacles that are not there are points.
        .filter(|length| *length > 0.0);
    let (sum, count) = lengths.fold((0.0, 0_usize), |(sum, count), length| (sum + length, count + 1));
    (count > 0).then(|| sum / count as f64)
}

/// The edges of triangles and strands, each once, with their lengths [m]. Edges of length 0 are left out.
pub fn edges_with_lengths(mesh: &Mesh) -> Vec<([u32; 2], f64)> {
    let sides = mesh.triangles.iter().flat_map(|&[i, j, k]| [[i, j], [j, k], [k, i]]);
    let mut edges: Vec<[u32; 2]> =
        sides.chain(mesh.strands.iter().copied()).map(|[i, j]| [i.min(j), i.max(j)]).collect();
    edges.sort_unstable();
    edges.dedup();
    let length = |[i, j]: [u32; 2]| (mesh.positions[i as usize] - mesh.positions[j as usize]).norm();
    edges.into_iter().map(|e| (e, length(e))).filter(|(_, length)| *length > 0.0).collect()
}
