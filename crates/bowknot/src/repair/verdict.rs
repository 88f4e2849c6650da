//! What the exact judge says about a mesh.

use super::borders::border_vertices;
use bowknot_check::{CheckError, Judge, Parts, StateOptions};
use bowknot_geometry::{UnionFind, boundary_triangles};
use bowknot_io::Mesh;
use serde::Serialize;

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
    /// Triangles, those of the surface of tetrahedra included.
    pub triangles: usize,
    /// Tetrahedra.
    pub tets: usize,
    /// Connected parts.
    pub parts: usize,
    /// Vertices at open borders.
    pub border_vertices: usize,
    /// Pairs that intersect.
    pub intersections: usize,
    /// Pairs that intersect by the parts that they belong to, most first.
    pub by_parts: Vec<PartIntersections>,
    /// The first of them, in words.
    pub findings: Vec<String>,
}

pub(super) fn judge(mesh: &Mesh) -> Result<Verdict, CheckError> {
    /// Findings in words.
    const LISTED: usize = 5;
    let mut triangles = boundary_triangles(&mesh.tets);
    triangles.extend(&mesh.triangles);
    let parts = Parts {
        vertex_count: mesh.positions.len(),
        triangles: &triangles,
        strands: &mesh.strands,
        particles: &mesh.particles,
        ..Parts::default()
    };
    let judge = Judge::new(&parts)?;
    let state = judge.check_state(&mesh.positions, &StateOptions { limit: usize::MAX, distance: false })?;
    let mut sets = UnionFind::new(mesh.positions.len());
    let neighbors =
        mesh.tets.iter().flat_map(|t| t.windows(2)).chain(mesh.strands.iter().flat_map(|e| e.windows(2)));
    for pair in mesh.triangles.iter().flat_map(|t| t.windows(2)).chain(neighbors) {
        sets.join(pair[0], pair[1]);
    }
    // Numbered by their smallest vertices, which are the roots.
    let mut part = vec![0; mesh.positions.len()];
    let mut sizes: Vec<usize> = Vec::new();
    for v in 0..mesh.positions.len() {
        let root = sets.find(v as u32) as usize;
        if root == v {
            part[v] = sizes.len() as u32;
            sizes.push(0);
        }
        part[v] = part[root];
        sizes[part[v] as usize] += 1;
    }
    let part = |v: u32| part[v as usize];

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
        triangles: triangles.len(),
        tets: mesh.tets.len(),
        parts: sizes.len(),
        border_vertices: border_vertices(&triangles).len(),
        intersections: state.intersection_count,
        by_parts,
        findings: state.intersections.iter().take(LISTED).map(ToString::to_string).collect(),
    })
}
