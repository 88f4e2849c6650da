//! A mesh as files hold it, whatever their format.

use super::{Import, IoError, Place, read_msh, read_obj, read_ply, read_segments, read_tet_list};
use bowknot_geometry::{Point, boundary_triangles};
use std::cmp::Ordering;
use std::path::Path;

/// A mesh read from a file [m, z up].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Vertices.
    pub positions: Vec<Point>,
    /// Triangles; larger polygons come as fans around their first vertex.
    pub triangles: Vec<[u32; 3]>,
    /// Tetrahedra, with a positive volume if (x1 - x0) x (x2 - x0) . (x3 - x0) is; as the file orders them. Their
    /// faces are not among the triangles.
    pub tets: Vec<[u32; 4]>,
    /// Strand edges: `l` of an OBJ, `edge` of a PLY, `s` of a SEG, lines of a MSH.
    pub strands: Vec<[u32; 2]>,
    /// Loose points that the file means: `p` of an OBJ, points of a MSH; in a PLY every vertex of no face and no edge.
    pub particles: Vec<u32>,
    /// Whether each vertex belongs to an obstacle, if the file says so.
    pub obstacle: Option<Vec<bool>>,
    /// Body of each vertex, if the file says so.
    pub body: Option<Vec<u32>>,
}

/// A mesh to be written, borrowed from wherever it lives.
#[derive(Clone, Copy, Debug, Default)]
pub struct MeshView<'a> {
    /// Vertices [m].
    pub positions: &'a [Point],
    /// Triangles.
    pub triangles: &'a [[u32; 3]],
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
}

impl Mesh {
    /// The mesh, borrowed for writing.
    pub fn view(&self) -> MeshView<'_> {
        MeshView {
            positions: &self.positions,
            triangles: &self.triangles,
            quads: &[],
            strands: &self.strands,
            particles: &self.particles,
            obstacle: self.obstacle.as_deref().unwrap_or(&[]),
            body: self.body.as_deref().unwrap_or(&[]),
        }
    }

    /// The mesh with the surface of its tetrahedra in their place, pointing outward where they have a positive volume,
    /// before the other triangles. Vertices keep their numbers; those inside are then named by nothing.
    pub fn into_surface(mut self) -> Self {
        let mut triangles = boundary_triangles(&self.tets);
        triangles.append(&mut self.triangles);
        Self { triangles, tets: Vec::new(), ..self }
    }

    /// Vertices that no triangle, tetrahedron, strand edge or particle names, ascending.
    pub fn unused_vertices(&self) -> Vec<u32> {
        let mut used = self.used_by_elements();
        self.particles.iter().for_each(|&v| used[v as usize] = true);
        (0..self.positions.len() as u32).filter(|&v| !used[v as usize]).collect()
    }

    /// Drops the vertices that nothing names and renumbers the others in order. Returns how many were dropped.
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
        retain(&mut self.positions, &keep);
        if let Some(obstacle) = &mut self.obstacle {
            retain(obstacle, &keep);
        }
        if let Some(body) = &mut self.body {
            retain(body, &keep);
        }
        unused.len()
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

/// Endings of the files that [`read_mesh`] reads, in lower case.
pub const MESH_ENDINGS: [&str; 5] = ["obj", "ply", "msh", "t", "seg"];

/// Reads a mesh file, told apart by the ending of its name: OBJ, PLY, Gmsh's MSH, lists of tetrahedra (`.t`), strand
/// segments (`.seg`).
///
/// # Errors
/// A missing, malformed or truncated file, numbers that are not finite, indices out of range, an unknown ending.
pub fn read_mesh(path: &Path, import: &Import) -> Result<Mesh, IoError> {
    let ending = path.extension().and_then(|e| e.to_str()).unwrap_or("").to_ascii_lowercase();
    match ending.as_str() {
        "obj" => read_obj(path, import),
        "ply" => read_ply(path, import),
        "msh" => read_msh(path, import),
        "t" => read_tet_list(path, import),
        "seg" => read_segments(path, import),
        _ => {
            let endings = MESH_ENDINGS.map(|ending| format!(".{ending}")).join(", ");
            Err(IoError::content(path, Place::File, format!("not a mesh: only {endings} files are read")))
        }
    }
}

/// Compares two file names so that `2.ply` comes before `10.ply`: runs of digits by value, the rest by bytes.
pub fn natural_order(a: &str, b: &str) -> Ordering {
    let (mut rest_a, mut rest_b) = (a.as_bytes(), b.as_bytes());
    loop {
        let (Some(&first_a), Some(&first_b)) = (rest_a.first(), rest_b.first()) else {
            // One name is a prefix of the other, or they differ in leading zeros only.
            return rest_a.len().cmp(&rest_b.len()).then_with(|| a.cmp(b));
        };
        let order = if first_a.is_ascii_digit() && first_b.is_ascii_digit() {
            let (digits_a, digits_b) = (take_digits(&mut rest_a), take_digits(&mut rest_b));
            digits_a.len().cmp(&digits_b.len()).then_with(|| digits_a.cmp(digits_b))
        } else {
            (rest_a, rest_b) = (&rest_a[1..], &rest_b[1..]);
            first_a.cmp(&first_b)
        };
        if order != Ordering::Equal {
            return order;
        }
    }
}

/// Splits the leading digits off, without their leading zeros.
fn take_digits<'a>(bytes: &mut &'a [u8]) -> &'a [u8] {
    let count = bytes.iter().take_while(|b| b.is_ascii_digit()).count();
    let (digits, rest) = bytes.split_at(count);
    *bytes = rest;
    let zeros = digits.iter().take_while(|&&b| b == b'0').count();
    &digits[zeros..]
}
