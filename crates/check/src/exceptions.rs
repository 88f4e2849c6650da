//! The few touching pairs that no edge-triangle pair stands for.
//!
//! Where two edges, or a vertex and a triangle, touch in a mesh, an edge also touches a triangle: a
//! triangle at one of the edges, an edge at the vertex. Edge-triangle pairs are judged anyway, so only
//! those touching pairs need a look of their own for which every such edge-triangle pair shares a vertex
//! and is left out: the two diagonals of a quad folded flat, say. They follow from the topology alone.

use crate::report::PairClass;

/// Edge-edge and vertex-triangle pairs that no edge-triangle pair stands for, particles and pairs of
/// strand edges excepted. `edges` are sorted and unique, smaller vertex first.
pub(super) fn uncovered_pairs(
    vertex_count: usize,
    triangles: &[[u32; 3]],
    edges: &[[u32; 2]],
) -> Vec<(PairClass, [u32; 2])> {
    let triangles_at_vertex = Table::new(vertex_count, triangles);
    let edges_at_vertex = Table::new(vertex_count, edges);
    let triangles_at_edge = |[i, j]: [u32; 2]| {
        triangles_at_vertex.at(i).iter().map(|&t| triangles[t as usize]).filter(move |t| t.contains(&j))
    };
    let disjoint = |a: &[u32], b: &[u32]| !a.iter().any(|v| b.contains(v));
    let mut uncovered = Vec::new();

    // An edge e that touches edge f must have a vertex in every triangle at f, hence, as e and f share
    // none, the vertex opposite f: start from the first of these.
    for (f, &edge_f) in edges.iter().enumerate() {
        let Some(first) = triangles_at_edge(edge_f).next() else { continue };
        let Some(&opposite) = first.iter().find(|v| !edge_f.contains(v)) else { continue };
        for &e in edges_at_vertex.at(opposite) {
            let edge_e = edges[e as usize];
            if disjoint(&edge_e, &edge_f)
                && !triangles_at_edge(edge_f).any(|t| disjoint(&t, &edge_e))
                && !triangles_at_edge(edge_e).any(|t| disjoint(&t, &edge_f))
            {
                uncovered.push((PairClass::EdgeEdge, [e.min(f as u32), e.max(f as u32)]));
            }
        }
    }
    // A vertex all of whose neighbors are in one triangle, without being in it itself.
    for v in 0..vertex_count as u32 {
        let neighbors: Vec<u32> =
            edges_at_vertex.at(v).iter().flat_map(|&e| edges[e as usize]).filter(|&w| w != v).collect();
        let Some(&first) = neighbors.first() else { continue };
        for &t in triangles_at_vertex.at(first) {
            let triangle = &triangles[t as usize];
            if !triangle.contains(&v) && neighbors.iter().all(|w| triangle.contains(w)) {
                uncovered.push((PairClass::VertexTriangle, [v, t]));
            }
        }
    }
    uncovered.sort_unstable();
    uncovered.dedup();
    uncovered
}

/// The elements at each vertex.
struct Table {
    starts: Vec<u32>,
    elements: Vec<u32>,
}

impl Table {
    fn new<const N: usize>(vertex_count: usize, elements: &[[u32; N]]) -> Self {
        let mut starts = vec![0u32; vertex_count + 1];
        elements.iter().flatten().for_each(|&v| starts[v as usize + 1] += 1);
        for v in 0..vertex_count {
            starts[v + 1] += starts[v];
        }
        let mut next = starts.clone();
        let mut table = vec![0; elements.len() * N];
        for (index, vertices) in elements.iter().enumerate() {
            for &v in vertices {
                table[next[v as usize] as usize] = index as u32;
                next[v as usize] += 1;
            }
        }
        Self { starts, elements: table }
    }

    fn at(&self, vertex: u32) -> &[u32] {
        let v = vertex as usize;
        &self.elements[self.starts[v] as usize..self.starts[v + 1] as usize]
    }
}
