//! A mesh as files hold it, whatever their format.

use crate::groups::Groups;
use crate::surface::Surface;
use bowknot_geometry::{Point, UnionFind, boundary_triangles};

/// A mesh read from a file [m, z up].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Vertices.
    pub positions: Vec<Point>,
    /// Triangles; larger polygons come as fans around their first vertex.
    pub triangles: Vec<[u32; 3]>,
    /// Tetrahedra, with a positive volume if (x1 - x0) x (x2 - x0) . (x3 - x0) is; as the file orders them.
    /// Their faces are not among the triangles.
    pub tets: Vec<[u32; 4]>,
    /// Strand edges: `l` of an OBJ, `edge` of a PLY, `s` of a SEG, lines of a MSH.
    pub strands: Vec<[u32; 2]>,
    /// Loose points that the file means: `p` of an OBJ, points of a MSH; in a PLY every vertex of no face and
    /// no edge.
    pub particles: Vec<u32>,
    /// Whether each vertex belongs to an obstacle, if the file says so.
    pub obstacle: Option<Vec<bool>>,
    /// Body of each vertex, if the file says so.
    pub body: Option<Vec<u32>>,
    /// Names of the bodies, in the order of their numbers, if the file says so; there may be fewer than
    /// bodies.
    pub names: Vec<String>,
    /// The polygons whose fans are the triangles, and what modeling tools say about them; none if the file
    /// has nameless triangles only.
    pub surface: Option<Surface>,
    /// Named sets of vertices, if the file has some.
    pub groups: Groups,
}

/// A mesh to be written, borrowed from wherever it lives.
#[derive(Clone, Copy, Debug, Default)]
pub struct MeshView<'a> {
    /// Vertices [m].
    pub positions: &'a [Point],
    /// Triangles.
    pub triangles: &'a [[u32; 3]],
    /// Tetrahedra. Only Gmsh files and lists of tetrahedra hold them.
    pub tets: &'a [[u32; 4]],
    /// Quadrilaterals, such as those that stand for half-spaces.
    pub quads: &'a [[u32; 4]],
    /// Strand edges.
    pub strands: &'a [[u32; 2]],
    /// Loose points. A PLY does not list them: vertices of no face and no edge are.
    pub particles: &'a [u32],
    /// Whether each vertex belongs to an obstacle; empty: none does.
    pub obstacle: &'a [bool],
    /// Body of each vertex; empty: all belong to body 0.
    pub body: &'a [u32],
    /// Names of the bodies, in the order of their numbers; there may be fewer than bodies.
    pub names: &'a [String],
    /// The polygons whose fans are the triangles, then the fans of the quads: what OBJ, PLY and USD hold in
    /// their place.
    pub surface: Option<&'a Surface>,
}

impl Mesh {
    /// The mesh, borrowed for writing.
    pub fn view(&self) -> MeshView<'_> {
        MeshView {
            positions: &self.positions,
            triangles: &self.triangles,
            tets: &self.tets,
            quads: &[],
            strands: &self.strands,
            particles: &self.particles,
            obstacle: self.obstacle.as_deref().unwrap_or(&[]),
            body: self.body.as_deref().unwrap_or(&[]),
            names: &self.names,
            surface: self.surface.as_ref(),
        }
    }

    /// The mesh with the surface of its tetrahedra in their place, pointing outward where they have a
    /// positive volume, before the other triangles. Vertices keep their numbers; those inside are then named
    /// by nothing.
    pub fn into_surface(mut self) -> Self {
        if self.tets.is_empty() {
            return self;
        }
        let mut triangles = boundary_triangles(&self.tets);
        triangles.append(&mut self.triangles);
        Self { triangles, tets: Vec::new(), surface: None, ..self }
    }

    /// Whether each vertex belongs to an obstacle that is not there in a frame with these `positions` [m]:
    /// all vertices of such a connected part are at one place. Empty if there is none, or the mesh does not
    /// say what is an obstacle.
    pub fn absent(&self, positions: &[Point]) -> Vec<bool> {
        let Some(obstacle) = self.obstacle.as_ref() else { return Vec::new() };
        let sides = self.triangles.iter().flat_map(|&[i, j, k]| [[i, j], [i, k]]);
        let pairs = sides.chain(self.strands.iter().copied()).filter(|[i, _]| obstacle[*i as usize]);
        let (at_one_place, apart): (Vec<[u32; 2]>, Vec<[u32; 2]>) =
            pairs.partition(|[i, j]| positions[*i as usize] == positions[*j as usize]);
        if at_one_place.is_empty() {
            return Vec::new();
        }
        let mut parts = UnionFind::new(positions.len());
        at_one_place.iter().chain(&apart).for_each(|[i, j]| parts.join(*i, *j));
        // What elements join has more than one vertex.
        let mut absent = vec![false; positions.len()];
        at_one_place.iter().for_each(|[i, _]| absent[parts.root(*i) as usize] = true);
        apart.iter().for_each(|[i, _]| absent[parts.root(*i) as usize] = false);
        (0..positions.len() as u32).map(|v| absent[parts.root(v) as usize]).collect()
    }

    /// Leaves out the elements with a vertex that is marked, one entry per vertex or none at all. Vertices
    /// keep their numbers.
    pub fn leave_out(&mut self, marked: &[bool]) {
        let stays = |v: &u32| marked.get(*v as usize) != Some(&true);
        self.triangles.retain(|t| t.iter().all(stays));
        self.tets.retain(|t| t.iter().all(stays));
        self.strands.retain(|e| e.iter().all(stays));
        self.particles.retain(stays);
        self.surface = None;
    }

    /// Vertices that no triangle, tetrahedron, strand edge or particle names, ascending.
    pub fn unused_vertices(&self) -> Vec<u32> {
        let mut used = self.used_by_elements();
        self.particles.iter().for_each(|&v| used[v as usize] = true);
        (0..self.positions.len() as u32).filter(|&v| !used[v as usize]).collect()
    }

    /// Drops the vertices that nothing names and renumbers the others in order. Returns how many were
    /// dropped.
    pub fn drop_unused_vertices(&mut self) -> usize {
        let unused = self.unused_vertices();
        if unused.is_empty() {
            return 0;
        }
        let mut keep = vec![true; self.positions.len()];
        unused.iter().for_each(|&v| keep[v as usize] = false);
        let mut next = 0;
        let renumbered: Vec<u32> = keep
            .iter()
            .map(|&k| {
                let index = next;
                next += u32::from(k);
                index
            })
            .collect();
        let renumber = |v: &mut u32| *v = renumbered[*v as usize];
        self.triangles.iter_mut().flatten().for_each(renumber);
        self.tets.iter_mut().flatten().for_each(renumber);
        self.strands.iter_mut().flatten().for_each(renumber);
        self.particles.iter_mut().for_each(renumber);
        if let Some(surface) = &mut self.surface {
            surface.renumber(|v| renumbered[v as usize]);
        }
        retain(&mut self.positions, &keep);
        if let Some(obstacle) = &mut self.obstacle {
            retain(obstacle, &keep);
        }
        if let Some(body) = &mut self.body {
            retain(body, &keep);
        }
        self.groups.renumber(|v| keep[v as usize].then_some(renumbered[v as usize]));
        unused.len()
    }

    /// Keeps the triangles that are marked. Returns how many polygons of the surface lose some of theirs.
    pub fn retain_triangles(&mut self, keep: &[bool]) -> usize {
        retain(&mut self.triangles, keep);
        let cut = self.surface.as_mut().map_or(0, |surface| surface.retain_triangles(keep));
        self.surface = self.surface.take().filter(|surface| !surface.is_empty());
        cut
    }

    pub(super) fn used_by_elements(&self) -> Vec<bool> {
        let mut used = vec![false; self.positions.len()];
        self.triangles.iter().flatten().for_each(|&v| used[v as usize] = true);
        self.tets.iter().flatten().for_each(|&v| used[v as usize] = true);
        self.strands.iter().flatten().for_each(|&v| used[v as usize] = true);
        used
    }
}

fn retain<T>(values: &mut Vec<T>, keep: &[bool]) {
    let mut index = 0;
    values.retain(|_| {
        index += 1;
        keep[index - 1]
    });
}
