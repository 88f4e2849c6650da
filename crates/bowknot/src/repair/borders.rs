//! Borders of surfaces.

use bowknot_io::Mesh;

/// Border edges: those of one triangle only, with it.
pub(super) fn border_edges(triangles: &[[u32; 3]]) -> Vec<([u32; 2], u32)> {
    let mut edges: Vec<([u32; 2], u32)> = (0..)
        .zip(triangles)
        .flat_map(|(t, &[i, j, k])| [[i, j], [j, k], [k, i]].map(|[a, b]| ([a.min(b), a.max(b)], t)))
        .collect();
    edges.sort_unstable();
    edges.chunk_by(|a, b| a.0 == b.0).filter(|same| same.len() == 1).map(|same| same[0]).collect()
}

/// Vertices of border edges, ascending.
pub(super) fn border_vertices(triangles: &[[u32; 3]]) -> Vec<u32> {
    let mut vertices: Vec<u32> = border_edges(triangles).iter().flat_map(|(edge, _)| *edge).collect();
    vertices.sort_unstable();
    vertices.dedup();
    vertices
}

/// Mean length of the border edges [unit of the mesh]; 0 if there are none.
pub(super) fn mean_border_edge(mesh: &Mesh) -> f64 {
    let edges = border_edges(&mesh.triangles);
    let length =
        |([a, b], _): &([u32; 2], u32)| (mesh.positions[*a as usize] - mesh.positions[*b as usize]).norm();
    edges.iter().map(length).sum::<f64>() / edges.len().max(1) as f64
}
