//! A mesh on its way into the world: loaded, cleaned, its vertices ordered.

use super::thickness::few_elements_across;
use crate::body::BodySpec;
use crate::elements::SolidElements;
use crate::error::SceneError;
use crate::kind::BodyKind;
use crate::material::Material;
use crate::shapes::Shape;
use bowknot_errors::counted;
use bowknot_geometry::{
    MeshProblem, Point, TetFaults, add_edge_middles, add_frame_points, boundary_triangles, check_mesh,
    check_tets, divide_tetrahedron,
};
use bowknot_io::{self as io, Groups, Import, Mesh, Surface};
use std::collections::{HashMap, HashSet};
use std::path::Path;

/// How many faulty elements a message lists.
const LISTED: usize = 20;

/// A mesh on its way into the world.
#[derive(Clone, Debug, Default)]
pub(super) struct Part {
    pub positions: Vec<Point>,
    pub triangles: Vec<[u32; 3]>,
    pub tets: Vec<[u32; 4]>,
    pub quadratic_tets: Vec<[u32; 10]>,
    pub strands: Vec<[u32; 2]>,
    /// The strands with their frame points, if they resist twist.
    pub rods: Vec<[u32; 3]>,
    pub particles: Vec<u32>,
    /// What the mesh says about its faces: polygons whose fans are the triangles.
    pub surface: Option<Surface>,
    /// Groups of the mesh, by its numbers.
    pub groups: Groups,
    /// Number in the mesh of each vertex but frame points.
    pub numbers: Vec<u32>,
    /// Vertices of the mesh, those left out counted.
    pub mesh_vertices: usize,
    /// How many vertices, the last ones, are inside of a solid or frame points.
    pub interior: usize,
}

impl Part {
    pub fn from_mesh(mesh: Mesh) -> Self {
        let mesh_vertices = mesh.positions.len();
        let Mesh { positions, triangles, tets, strands, particles, surface, groups, .. } = mesh;
        let numbers = (0..mesh_vertices as u32).collect();
        Self {
            positions,
            triangles,
            tets,
            strands,
            particles,
            surface,
            groups,
            numbers,
            mesh_vertices,
            ..Self::default()
        }
    }

    /// Loads a mesh file, or a part of it, or makes a shape.
    pub fn load(
        folder: &Path,
        mesh: Option<&Path>,
        part: Option<&str>,
        shape: Option<&Shape>,
        import: &Import,
    ) -> Result<Self, SceneError> {
        let mesh = match (mesh, shape.and_then(Shape::elements)) {
            (Some(path), _) => match part {
                Some(part) => io::read_mesh_part(&folder.join(path), import, part)?,
                None => io::read_mesh(&folder.join(path), import)?,
            },
            (None, Some(mut mesh)) => {
                mesh.positions.iter_mut().for_each(|p| *p = import.point(p.coords.into()));
                mesh
            }
            (None, None) => Mesh::default(),
        };
        Ok(Self::from_mesh(mesh))
    }

    /// Changes the elements as those of a mesh.
    fn edit<T>(&mut self, edit: impl FnOnce(&mut Mesh) -> T) -> T {
        let mut mesh = Mesh {
            positions: std::mem::take(&mut self.positions),
            triangles: std::mem::take(&mut self.triangles),
            tets: std::mem::take(&mut self.tets),
            strands: std::mem::take(&mut self.strands),
            particles: std::mem::take(&mut self.particles),
            surface: self.surface.take(),
            ..Mesh::default()
        };
        let result = edit(&mut mesh);
        let Mesh { positions, triangles, tets, strands, particles, surface, .. } = mesh;
        (self.positions, self.triangles, self.tets) = (positions, triangles, tets);
        (self.strands, self.particles, self.surface) = (strands, particles, surface);
        result
    }

    /// Keeps the vertices that elements name.
    fn drop_unused(&mut self) {
        let unused = self.edit(|mesh| {
            let unused = mesh.unused_vertices();
            mesh.drop_unused_vertices();
            unused
        });
        let mut drop = vec![false; self.numbers.len()];
        unused.iter().for_each(|&v| drop[v as usize] = true);
        let mut index = 0;
        self.numbers.retain(|_| {
            index += 1;
            !drop[index - 1]
        });
    }

    /// Makes the triangles fill the polygons.
    fn triangulate(&mut self, owner: &str, warnings: &mut Vec<String>) {
        let faults = self.edit(Mesh::triangulate);
        warnings.extend(faults.describe().map(|faults| format!("{owner}: {faults}")));
    }

    /// Makes a body of the mesh: refuses elements of other kinds and faulty ones, drops loose vertices.
    pub fn into_body(mut self, spec: &BodySpec, warnings: &mut Vec<String>) -> Result<Self, SceneError> {
        let (kind, name) = (spec.kind, &*spec.name);
        self.triangulate(&format!("body {name}"), warnings);
        if kind == BodyKind::Cloth && !self.triangles.is_empty() {
            self.leave_out_lines(name, spec.drop_lines, warnings)?;
        }
        // Loose vertices of a PLY come as particles; where there are other elements they are leftovers.
        if kind != BodyKind::Particles {
            self.particles.clear();
        }
        self.drop_unused();
        let fault = |message: String| SceneError::Body { body: format!("body {name}"), message };
        let (own, others) = self.elements(kind);
        if let Some((count, other)) = others.into_iter().find(|(count, _)| *count > 0) {
            let only = match kind {
                BodyKind::Cloth => "a cloth is made of triangles only",
                BodyKind::Solid => "a solid is made of tetrahedra only",
                BodyKind::Strands => "strands are made of edges only",
                BodyKind::Particles => "particles are loose points only",
            };
            let hint = if other == BodyKind::Solid { "; set kind = \"solid\"" } else { "" };
            let (one, many) = element_of(other);
            return Err(fault(format!("the mesh has {}, but {only}{hint}", counted(count, one, many))));
        }
        if own == 0 {
            return Err(fault(format!("the mesh has no {}", element_of(kind).1)));
        }
        match kind {
            BodyKind::Cloth => {
                let problems = check_mesh(&self.positions, &self.triangles);
                if !problems.is_empty() {
                    return Err(SceneError::Mesh { body: name.to_owned(), problems });
                }
            }
            BodyKind::Solid => {
                self.order_tets(name, warnings).map_err(fault)?;
                self.choose_elements(spec, warnings);
                self.split_surface();
            }
            BodyKind::Strands => {
                self.check_strands().map_err(fault)?;
                if matches!(spec.material, Material::Strands(material) if material.twist_stiffness > 0.0) {
                    self.rods = add_frame_points(&mut self.positions, &self.strands);
                    self.interior = self.rods.len();
                }
            }
            BodyKind::Particles => {}
        }
        let left_out = self.mesh_vertices - self.numbers.len();
        if left_out > 0 {
            let mut sorted = self.numbers.clone();
            sorted.sort_unstable();
            let first = sorted.iter().enumerate().find(|(k, number)| *k as u32 != **number);
            let first = first.map_or(sorted.len(), |(k, _)| k);
            let element = element_of(kind).0;
            warnings.push(format!(
                "body {name}: left out {} to no {element}, the first is vertex {first}",
                counted(left_out, "vertex that belongs", "vertices that belong")
            ));
        }
        Ok(self)
    }

    /// Leaves out lines of a cloth that are leftovers: those along edges of triangles, and those with an end
    /// at no triangle. Refuses the others, unless they are to be dropped as well.
    fn leave_out_lines(
        &mut self,
        name: &str,
        drop_lines: bool,
        warnings: &mut Vec<String>,
    ) -> Result<(), SceneError> {
        let mut edges = HashSet::new();
        let mut of_triangles = vec![false; self.positions.len()];
        for &[a, b, c] in &self.triangles {
            edges.extend([[a, b], [b, c], [c, a]].map(|[p, q]| [p.min(q), p.max(q)]));
            [a, b, c].into_iter().for_each(|v| of_triangles[v as usize] = true);
        }
        let sews = |&[p, q]: &[u32; 2]| {
            p != q
                && of_triangles[p as usize]
                && of_triangles[q as usize]
                && !edges.contains(&[p.min(q), p.max(q)])
        };
        let lines = std::mem::take(&mut self.strands);
        let (sewing, others): (Vec<[u32; 2]>, Vec<_>) = lines.into_iter().partition(sews);
        if let (false, Some([p, q])) = (drop_lines, sewing.first()) {
            let [p, q] = [p, q].map(|v| self.numbers[*v as usize]);
            let message = format!(
                "the mesh has {} between vertices of its triangles, the first joins vertices {p} and {q}: \
                 other programs sew along such lines, which is not simulated; leave them out with drop_lines \
                 = true, or let `bowknot repair` weld borders that lie together",
                counted(sewing.len(), "line", "lines")
            );
            return Err(SceneError::Body { body: format!("body {name}"), message });
        }
        if let Some([p, q]) = sewing.first().or(others.first()) {
            let [p, q] = [p, q].map(|v| self.numbers[*v as usize]);
            let lines = counted(sewing.len() + others.len(), "line", "lines");
            warnings.push(format!("body {name}: left out {lines}, the first joins vertices {p} and {q}"));
        }
        Ok(())
    }

    /// Number of elements of a kind, and of the others with their kinds.
    fn elements(&self, kind: BodyKind) -> (usize, Vec<(usize, BodyKind)>) {
        let mut counts = vec![
            (self.triangles.len(), BodyKind::Cloth),
            (self.tets.len(), BodyKind::Solid),
            (self.strands.len(), BodyKind::Strands),
            (self.particles.len(), BodyKind::Particles),
        ];
        let own = counts.iter().find(|c| c.1 == kind).map_or(0, |c| c.0);
        counts.retain(|c| c.1 != kind);
        (own, counts)
    }

    /// Gives all tetrahedra the same handedness: the order of their vertices is no geometry. Refuses flat
    /// ones, and pairs that lie on the same side of the face that they share.
    fn order_tets(&mut self, name: &str, warnings: &mut Vec<String>) -> Result<(), String> {
        let TetFaults { flat, turned, overlapping } = check_tets(&self.positions, &self.tets);
        let mut overlapping: Vec<usize> = overlapping.iter().map(|shared| shared.tets[1]).collect();
        overlapping.sort_unstable();
        overlapping.dedup();
        let listed = |list: &[usize], what: &str| match list {
            [] => None,
            list => Some(format!("{} {what}: {}", list.len(), first(list.iter()))),
        };
        let faults = [listed(&flat, "flat"), listed(&overlapping, "on the same side of a face as another")];
        let faults: Vec<String> = faults.into_iter().flatten().collect();
        let of_all = |count: usize| counted(count, "tetrahedron", "tetrahedra");
        if !faults.is_empty() {
            return Err(format!(
                "of {}, {}; the command `bowknot repair` mends or drops them",
                of_all(self.tets.len()),
                faults.join("; ")
            ));
        }
        turned.iter().for_each(|&index| self.tets[index].swap(2, 3));
        if let Some(first) = turned.first() {
            warnings.push(format!(
                "body {name}: {} of {} had their vertices in the opposite order and have been renumbered, \
                 the first is {first}",
                turned.len(),
                of_all(self.tets.len())
            ));
        }
        Ok(())
    }

    /// Makes the tetrahedra quadratic where the body asks for that or, in a generated mesh without a choice,
    /// where linear ones would be too stiff. The vertices of a mesh that is given are left as they are.
    fn choose_elements(&mut self, spec: &BodySpec, warnings: &mut Vec<String>) {
        let few = match spec.elements {
            Some(SolidElements::Linear) => return,
            Some(SolidElements::Quadratic) => return self.make_quadratic(),
            None => few_elements_across(&self.positions, &self.tets),
        };
        let Some(across) = few else { return };
        if spec.shape.as_ref().is_some_and(|shape| !matches!(shape, Shape::Arrays(_))) {
            return self.make_quadratic();
        }
        warnings.push(format!(
            "body {}: it is {across:.1} tetrahedra thick, and linear ones are several times too stiff in \
             bending there; set elements = \"quadratic\", or mesh it finer (elements = \"linear\" accepts \
             it)",
            spec.name
        ));
    }

    /// Divides each tetrahedron into eight by vertices in the middles of its edges; they follow those of the
    /// mesh.
    fn make_quadratic(&mut self) {
        self.quadratic_tets = add_edge_middles(&mut self.positions, &self.tets);
        self.tets = self.quadratic_tets.iter().flat_map(divide_tetrahedron).collect();
        let added = self.positions.len() - self.numbers.len();
        self.numbers.extend((self.mesh_vertices..self.mesh_vertices + added).map(|v| v as u32));
        self.mesh_vertices += added;
    }

    fn check_strands(&self) -> Result<(), String> {
        let mut seen: HashMap<[u32; 2], usize> = HashMap::new();
        let mut faults = Vec::new();
        for (index, &[a, b]) in self.strands.iter().enumerate() {
            let (p, q) = (self.positions[a as usize], self.positions[b as usize]);
            let [i, j] = [a, b].map(|v| self.numbers[v as usize]);
            if p == q {
                faults.push(format!(
                    "edge {index} joins vertices {i} and {j}, both at ({}, {}, {})",
                    p.x, p.y, p.z
                ));
            } else if let Some(earlier) = seen.insert([a.min(b), a.max(b)], index) {
                faults.push(format!("edge {index} repeats edge {earlier} (vertices {i}, {j})"));
            }
        }
        if faults.is_empty() {
            return Ok(());
        }
        let count = counted(faults.len(), "strand edge is", "strand edges are");
        Err(format!("{count} faulty: {}; merge repeated points", first(faults.iter())))
    }

    /// Finds the surface of the tetrahedra and moves the vertices inside behind those on it.
    fn split_surface(&mut self) {
        self.triangles = boundary_triangles(&self.tets);
        self.surface = None;
        let mut outside = vec![false; self.positions.len()];
        self.triangles.iter().flatten().for_each(|&v| outside[v as usize] = true);
        let (surface, inside): (Vec<u32>, Vec<u32>) =
            (0..self.positions.len() as u32).partition(|&v| outside[v as usize]);
        self.interior = inside.len();
        let order = [surface, inside].concat();
        let mut place = vec![0; order.len()];
        order.iter().enumerate().for_each(|(k, &v)| place[v as usize] = k as u32);
        let renumber = |v: &mut u32| *v = place[*v as usize];
        self.triangles.iter_mut().flatten().for_each(renumber);
        self.tets.iter_mut().flatten().for_each(renumber);
        self.quadratic_tets.iter_mut().flatten().for_each(renumber);
        self.positions = order.iter().map(|&v| self.positions[v as usize]).collect();
        self.numbers = order.iter().map(|&v| self.numbers[v as usize]).collect();
    }

    /// Makes an obstacle of the mesh: the surface of tetrahedra, without triangles that have no area or are
    /// repeated.
    pub fn into_obstacle(mut self, owner: &str, warnings: &mut Vec<String>) -> Result<Self, SceneError> {
        self.triangulate(owner, warnings);
        if !self.tets.is_empty() {
            let mut triangles = boundary_triangles(&std::mem::take(&mut self.tets));
            triangles.append(&mut self.triangles);
            (self.triangles, self.surface) = (triangles, None);
        }
        self.particles.clear();
        self.drop_unused();
        let fault = |message: &str| SceneError::Body { body: owner.to_owned(), message: message.to_owned() };
        if self.triangles.is_empty() && self.strands.is_empty() {
            return Err(fault("the mesh has no triangles"));
        }
        let mut keep = vec![true; self.triangles.len()];
        let mut first = None;
        for problem in check_mesh(&self.positions, &self.triangles) {
            match problem {
                MeshProblem::ZeroArea { triangle, .. } | MeshProblem::RepeatedTriangle { triangle, .. } => {
                    keep[triangle as usize] = false;
                    first = first.or(Some(problem));
                }
                // Of a strand, or of triangles that are dropped.
                MeshProblem::UnreferencedVertex { .. } => {}
                other => return Err(SceneError::Mesh { body: owner.to_owned(), problems: vec![other] }),
            }
        }
        let Some(first) = first else { return Ok(self) };
        let count = keep.iter().filter(|kept| !**kept).count();
        let dropped = counted(count, "triangle that is", "triangles that are");
        warnings.push(format!("{owner}: dropped {dropped} no obstacle: {first}"));
        self.edit(|mesh| mesh.retain_triangles(&keep));
        self.drop_unused();
        if self.triangles.is_empty() && self.strands.is_empty() {
            return Err(fault("no triangle of the mesh has an area"));
        }
        Ok(self)
    }
}

/// The elements of a kind, one and many.
pub(super) fn element_of(kind: BodyKind) -> (&'static str, &'static str) {
    match kind {
        BodyKind::Cloth => ("triangle", "triangles"),
        BodyKind::Solid => ("tetrahedron", "tetrahedra"),
        BodyKind::Strands => ("strand edge", "strand edges"),
        BodyKind::Particles => ("particle", "particles"),
    }
}

/// The first entries of a list in words, and that there are more.
fn first<T: ToString>(list: impl ExactSizeIterator<Item = T>) -> String {
    let more = if list.len() > LISTED { ", .." } else { "" };
    list.take(LISTED).map(|entry| entry.to_string()).collect::<Vec<_>>().join(", ") + more
}
