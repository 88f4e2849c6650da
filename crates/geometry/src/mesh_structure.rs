//! How the triangles of a mesh hang together: parts, borders, and edges where surfaces branch or turn over.

use crate::point::Point;
use crate::union_find::UnionFind;
#[cfg(feature = "serde")]
use serde::Serialize;

/// A connected part of a mesh.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize))]
pub struct MeshPart {
    /// Its smallest vertex.
    pub vertex: u32,
    /// Number of its vertices.
    pub vertices: usize,
    /// Number of its triangles.
    pub triangles: usize,
    /// Corners of its bounding box [m].
    pub bounds: [Point; 2],
}

/// A connected set of border edges, which belong to one triangle each: the outline of a sheet, a hole, an
/// open seam.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize))]
pub struct MeshBorder {
    /// Its smallest vertex.
    pub vertex: u32,
    /// Number of its edges.
    pub edges: usize,
    /// The place of the vertex [m].
    pub place: Point,
}

/// An edge that joins its triangles in an unusual way.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize))]
pub struct MeshEdge {
    /// Its vertices, ascending.
    pub vertices: [u32; 2],
    /// Its triangles, ascending.
    pub triangles: Vec<u32>,
    /// Its midpoint [m].
    pub place: Point,
}

/// How the triangles of a mesh hang together.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize))]
pub struct MeshStructure {
    /// Connected parts, the one with most triangles first.
    pub parts: Vec<MeshPart>,
    /// Borders, the one with most edges first.
    pub borders: Vec<MeshBorder>,
    /// Edges of more than two triangles, where surfaces branch.
    pub branching_edges: Vec<MeshEdge>,
    /// Edges whose two triangles have opposite front sides.
    pub flipped_edges: Vec<MeshEdge>,
}

impl MeshStructure {
    /// The structure of a mesh. Triangles that name a vertex twice, or one that does not exist, are left out.
    /// O(n log n).
    pub fn new(positions: &[Point], triangles: &[[u32; 3]]) -> Self {
        let is_proper = |[a, b, c]: &[u32; 3]| {
            a != b && b != c && c != a && [a, b, c].iter().all(|v| (**v as usize) < positions.len())
        };
        let numbered: Vec<(u32, [u32; 3])> =
            (0..).zip(triangles.iter().copied()).filter(|(_, triangle)| is_proper(triangle)).collect();
        let mut sides = sides(&numbered);
        sides.sort_unstable();
        let mut structure = Self { parts: parts(positions, &numbered), ..Self::default() };
        let mut border = Vec::new();
        for same in sides.chunk_by(|a, b| a.vertices == b.vertices) {
            let edge = || {
                let [a, b] = same[0].vertices.map(|v| positions[v as usize].coords / 2.0);
                let triangles = same.iter().map(|side| side.triangle).collect();
                MeshEdge { vertices: same[0].vertices, triangles, place: (a + b).into() }
            };
            match same {
                [_] => border.push(same[0].vertices),
                [a, b] if a.ascends == b.ascends => structure.flipped_edges.push(edge()),
                [_, _] => {}
                _ => structure.branching_edges.push(edge()),
            }
        }
        structure.borders = borders(positions, &border);
        structure
    }
}

impl MeshStructure {
    /// Whether the triangles bound a volume: there are some, each edge has two of them, and no border is
    /// open.
    pub fn is_closed(&self) -> bool {
        !self.parts.is_empty() && self.borders.is_empty() && self.branching_edges.is_empty()
    }
}

/// An edge as a side of a triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Side {
    /// Ascending.
    vertices: [u32; 2],
    triangle: u32,
    /// Whether the triangle runs from the smaller to the larger vertex.
    ascends: bool,
}

fn sides(triangles: &[(u32, [u32; 3])]) -> Vec<Side> {
    let of_triangle = |&(triangle, [i, j, k]): &(u32, [u32; 3])| {
        let side = |[a, b]: [u32; 2]| Side { vertices: [a.min(b), a.max(b)], triangle, ascends: a < b };
        [[i, j], [j, k], [k, i]].map(side)
    };
    triangles.iter().flat_map(of_triangle).collect()
}

fn parts(positions: &[Point], triangles: &[(u32, [u32; 3])]) -> Vec<MeshPart> {
    let mut sets = UnionFind::new(positions.len());
    let mut used = vec![false; positions.len()];
    for (_, vertices) in triangles {
        sets.join(vertices[0], vertices[1]);
        sets.join(vertices[0], vertices[2]);
        vertices.iter().for_each(|&v| used[v as usize] = true);
    }
    // A part's smallest vertex comes first and represents it.
    let mut parts: Vec<MeshPart> = Vec::new();
    let mut place = vec![0; positions.len()];
    for v in (0..positions.len() as u32).filter(|&v| used[v as usize]) {
        let (root, p) = (sets.find(v) as usize, positions[v as usize]);
        if root == v as usize {
            place[root] = parts.len();
            parts.push(MeshPart { vertex: v, vertices: 0, triangles: 0, bounds: [p, p] });
        }
        let part = &mut parts[place[root]];
        part.vertices += 1;
        part.bounds = [part.bounds[0].inf(&p), part.bounds[1].sup(&p)];
    }
    for (_, vertices) in triangles {
        parts[place[sets.find(vertices[0]) as usize]].triangles += 1;
    }
    parts.sort_by_key(|part| (std::cmp::Reverse(part.triangles), part.vertex));
    parts
}

fn borders(positions: &[Point], edges: &[[u32; 2]]) -> Vec<MeshBorder> {
    let mut sets = UnionFind::new(positions.len());
    edges.iter().for_each(|&[a, b]| sets.join(a, b));
    let mut roots: Vec<u32> = edges.iter().map(|&[a, _]| sets.find(a)).collect();
    roots.sort_unstable();
    let border =
        |same: &[u32]| MeshBorder { vertex: same[0], edges: same.len(), place: positions[same[0] as usize] };
    let mut borders: Vec<MeshBorder> = roots.chunk_by(|a, b| a == b).map(border).collect();
    borders.sort_by_key(|border| (std::cmp::Reverse(border.edges), border.vertex));
    borders
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_closed_surface_is_one_part_without_borders() {
        let x = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(Point::from);
        let structure = MeshStructure::new(&x, &[[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]);
        let part =
            MeshPart { vertex: 0, vertices: 4, triangles: 4, bounds: [x[0], Point::new(1.0, 1.0, 1.0)] };
        assert_eq!(structure, MeshStructure { parts: vec![part], ..MeshStructure::default() });
    }

    #[test]
    fn parts_borders_and_odd_edges_are_found_with_their_places() {
        // Three triangles at edge (0, 1), a part of two triangles with opposite fronts, a vertex without any.
        let x: Vec<Point> =
            (0..10).map(|k| Point::new(f64::from(k), f64::from(k % 3), f64::from(k / 2))).collect();
        let triangles = [[0, 1, 2], [1, 0, 3], [0, 1, 4], [5, 6, 7], [5, 6, 8], [5, 5, 6], [0, 1, 99]];
        let structure = MeshStructure::new(&x, &triangles);
        let counts: Vec<_> = structure.parts.iter().map(|p| (p.vertex, p.vertices, p.triangles)).collect();
        assert_eq!(counts, [(0, 5, 3), (5, 4, 2)]);
        let borders: Vec<_> = structure.borders.iter().map(|b| (b.vertex, b.edges, b.place)).collect();
        assert_eq!(borders, [(0, 6, x[0]), (5, 4, x[5])]);
        let edge =
            |vertices, triangles: &[u32], place| MeshEdge { vertices, triangles: triangles.to_vec(), place };
        assert_eq!(structure.branching_edges, [edge([0, 1], &[0, 1, 2], Point::new(0.5, 0.5, 0.0))]);
        assert_eq!(structure.flipped_edges, [edge([5, 6], &[3, 4], Point::new(5.5, 1.0, 2.5))]);
    }
}
