//! The offending elements as a mesh of their own, to look at.

use crate::judge::Judge;
use crate::report::Intersection;
use bowknot_geometry::Point;

/// The elements named by some intersections, over vertices of their own.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct OffendingMesh {
    /// Positions [m].
    pub positions: Vec<Point>,
    /// Vertices of the triangles, as indices into `positions`.
    pub triangles: Vec<[u32; 3]>,
    /// Vertices of strand edges, as indices into `positions`.
    pub edges: Vec<[u32; 2]>,
    /// Which vertex of the state each position is.
    pub vertices: Vec<u32>,
    /// Which triangle of the state each triangle is.
    pub sources: Vec<u32>,
}

impl Judge {
    /// The triangles and strand edges that some intersections name, and those at the edges and vertices
    /// that they name, in the state `x`. Particles come as vertices without elements.
    pub fn offending_mesh(&self, x: &[Point], intersections: &[Intersection]) -> OffendingMesh {
        let mut sides: Vec<&[u32]> =
            intersections.iter().flat_map(|i| i.vertices.iter().map(Vec::as_slice)).collect();
        sides.retain(|side| !side.is_empty());
        let mut sorted: Vec<Vec<u32>> = sides.iter().map(|side| side.to_vec()).collect();
        sorted.iter_mut().for_each(|side| side.sort_unstable());
        sorted.sort_unstable();
        sorted.dedup();
        let named = |part: &[u32]| {
            let mut part = part.to_vec();
            part.sort_unstable();
            sorted.binary_search(&part).is_ok()
        };

        let sources: Vec<u32> = (0..self.triangles.len() as u32)
            .filter(|&t| {
                let [i, j, k] = self.triangles[t as usize];
                let parts: [&[u32]; 7] = [&[i, j, k], &[i, j], &[j, k], &[k, i], &[i], &[j], &[k]];
                parts.iter().any(|part| named(part))
            })
            .collect();
        let triangles: Vec<[u32; 3]> = sources.iter().map(|&t| self.triangles[t as usize]).collect();
        let edges: Vec<[u32; 2]> = self
            .strands
            .iter()
            .map(|&e| self.edges[e as usize])
            .filter(|&[i, j]| named(&[i, j]) || named(&[i]) || named(&[j]))
            .collect();

        let mut vertices: Vec<u32> = triangles
            .iter()
            .flatten()
            .chain(edges.iter().flatten())
            .chain(sides.iter().copied().flatten())
            .copied()
            .collect();
        vertices.sort_unstable();
        vertices.dedup();
        let local = |v: u32| vertices.partition_point(|&w| w < v) as u32;
        OffendingMesh {
            positions: vertices.iter().map(|&v| x[v as usize]).collect(),
            triangles: triangles.into_iter().map(|t| t.map(local)).collect(),
            edges: edges.into_iter().map(|e| e.map(local)).collect(),
            vertices,
            sources,
        }
    }
}
