//! Adjacency: triangles of edges, connected components, boundaries.

use super::primitives::Topology;
use crate::union_find::UnionFind;

/// The triangles at each edge, in compressed rows: those of edge e are at `starts[e]..starts[e + 1]`,
/// ascending.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct EdgeTriangles {
    /// Start of each edge's row, and the end: one entry more than there are edges.
    pub starts: Vec<u32>,
    /// Triangles.
    pub triangles: Vec<u32>,
    /// The vertex of the triangle at the same place that is not on the edge.
    pub opposite_vertices: Vec<u32>,
}

impl EdgeTriangles {
    /// The triangles at an edge, each with its vertex opposite to the edge.
    pub fn of(&self, edge: u32) -> impl ExactSizeIterator<Item = (u32, u32)> + '_ {
        let row = self.row(edge);
        self.triangles[row.clone()].iter().copied().zip(self.opposite_vertices[row].iter().copied())
    }

    /// Number of triangles at an edge: 0 on strands, 1 on a boundary, 2 inside a surface, more where surfaces
    /// branch.
    pub fn count(&self, edge: u32) -> usize {
        self.row(edge).len()
    }

    fn row(&self, edge: u32) -> std::ops::Range<usize> {
        self.starts[edge as usize] as usize..self.starts[edge as usize + 1] as usize
    }
}

/// Connected components of the graph of vertices and edges.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Components {
    /// How many there are.
    pub count: usize,
    /// Component of each vertex, below `count`. Components are numbered in the order of their smallest
    /// vertices. A vertex without edges is a component of its own.
    pub of_vertex: Vec<u32>,
}

impl Topology {
    /// The triangles at each edge with their opposite vertices, for bending and boundaries. O(n).
    pub fn edge_triangles(&self) -> EdgeTriangles {
        let mut starts = vec![0_u32; self.edges.len() + 1];
        for &e in self.triangle_edges.iter().flatten() {
            starts[e as usize + 1] += 1;
        }
        for e in 0..self.edges.len() {
            starts[e + 1] += starts[e];
        }
        let mut next = starts.clone();
        let total = 3 * self.triangles.len();
        let (mut triangles, mut opposite_vertices) = (vec![0; total], vec![0; total]);
        for (t, (vertices, edges)) in self.triangles.iter().zip(&self.triangle_edges).enumerate() {
            for k in 0..3 {
                // Edge k joins vertices k and k + 1.
                let place = &mut next[edges[k] as usize];
                triangles[*place as usize] = t as u32;
                opposite_vertices[*place as usize] = vertices[(k + 2) % 3];
                *place += 1;
            }
        }
        EdgeTriangles { starts, triangles, opposite_vertices }
    }

    /// Edges of exactly one triangle, ascending. O(n).
    pub fn boundary_edges(&self) -> Vec<u32> {
        let mut counts = vec![0_u32; self.edges.len()];
        for &e in self.triangle_edges.iter().flatten() {
            counts[e as usize] += 1;
        }
        (0..self.edges.len() as u32).filter(|&e| counts[e as usize] == 1).collect()
    }

    /// Connected components of vertices along edges. Nearly O(n).
    pub fn connected_components(&self) -> Components {
        let mut sets = UnionFind::new(self.vertex_count);
        for &[i, j] in &self.edges {
            sets.join(i, j);
        }
        let mut of_vertex = vec![0; self.vertex_count];
        let mut count = 0;
        for v in 0..self.vertex_count as u32 {
            let root = sets.find(v);
            of_vertex[v as usize] = if root == v {
                count += 1;
                count - 1
            } else {
                of_vertex[root as usize]
            };
        }
        Components { count: count as usize, of_vertex }
    }
}
