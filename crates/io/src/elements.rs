//! Elements as meshing programs write them: also the boundaries of larger elements are elements.

use crate::groups::Groups;
use crate::mesh::Mesh;
use crate::surface::{Corner, Labels, Surface};
use bowknot_geometry::Point;

/// What an element of a file becomes; its corners come first among its vertices.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Becomes {
    Point,
    Line,
    Triangle,
    /// Of four corners.
    Quad,
    Tet,
    Nothing,
}

/// Elements by what they become, as vertex indices, boundary elements included.
#[derive(Default)]
pub(crate) struct Elements {
    tets: Vec<[u32; 4]>,
    triangles: Vec<[u32; 3]>,
    /// The polygons whose fans are the triangles, once there is one of more than three corners.
    surface: Option<Surface>,
    lines: Vec<[u32; 2]>,
    points: Vec<u32>,
}

impl Becomes {
    /// Number of its corners.
    pub(crate) fn corners(self) -> usize {
        match self {
            Self::Nothing => 0,
            Self::Point => 1,
            Self::Line => 2,
            Self::Triangle => 3,
            Self::Quad | Self::Tet => 4,
        }
    }
}

impl Elements {
    /// Adds an element of these vertices, which must exist and be as many as its corners at least.
    pub(crate) fn add(&mut self, becomes: Becomes, vertices: &[u32]) {
        match (becomes, vertices) {
            (Becomes::Point, &[i, ..]) => self.points.push(i),
            (Becomes::Line, &[i, j, ..]) => self.lines.push([i, j]),
            (Becomes::Tet, &[i, j, k, l, ..]) => self.tets.push([i, j, k, l]),
            (Becomes::Triangle | Becomes::Quad, _) => self.add_polygon(&vertices[..becomes.corners()]),
            _ => {}
        }
    }

    /// Adds a polygon of three corners or more.
    pub(crate) fn add_polygon(&mut self, corners: &[u32]) {
        if corners.len() > 3 {
            self.surface.get_or_insert_with(|| Surface::of_triangles(&self.triangles));
        }
        if let Some(surface) = &mut self.surface {
            surface.push(corners.iter().map(|&v| Corner::new(v, None, None)), &Labels::default());
        }
        self.triangles.extend(corners[1..].windows(2).map(|pair| [corners[0], pair[0], pair[1]]));
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.tets.is_empty() && self.triangles.is_empty() && self.lines.is_empty() && self.points.is_empty()
    }

    /// The mesh, without elements that are the boundary of others: triangles that are faces of tetrahedra,
    /// lines that are edges of either, points that are vertices of any of these.
    pub(crate) fn into_mesh(self, positions: Vec<Point>, groups: Groups) -> Mesh {
        fn sorted<const N: usize>(mut element: [u32; N]) -> [u32; N] {
            element.sort_unstable();
            element
        }
        fn unique<const N: usize>(elements: impl Iterator<Item = [u32; N]>) -> Vec<[u32; N]> {
            let mut elements: Vec<[u32; N]> = elements.map(sorted).collect();
            elements.sort_unstable();
            elements.dedup();
            elements
        }
        let Self { tets, triangles, surface, lines, points } = self;
        let mut mesh =
            Mesh { positions, tets, triangles, strands: lines, surface, groups, ..Mesh::default() };
        let faces =
            unique(mesh.tets.iter().flat_map(|&[i, j, k, l]| [[i, j, k], [i, j, l], [i, k, l], [j, k, l]]));
        if !faces.is_empty() {
            let is_inside = |&triangle: &[u32; 3]| faces.binary_search(&sorted(triangle)).is_err();
            let keep: Vec<bool> = mesh.triangles.iter().map(is_inside).collect();
            mesh.retain_triangles(&keep);
        }
        if !mesh.strands.is_empty() {
            let edges_of = |&[i, j, k]: &[u32; 3]| [[i, j], [j, k], [k, i]];
            let edges = unique(faces.iter().chain(&mesh.triangles).flat_map(edges_of));
            mesh.strands.retain(|&line| edges.binary_search(&sorted(line)).is_err());
        }
        let mut used = mesh.used_by_elements();
        mesh.particles = points;
        mesh.particles.retain(|&v| !std::mem::replace(&mut used[v as usize], true));
        mesh
    }
}
