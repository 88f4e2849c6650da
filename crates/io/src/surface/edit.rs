//! Surfaces that follow what happens to their mesh: triangles are dropped, vertices renumbered, meshes put
//! together and taken apart.

use super::polygons::{Corner, Labels, NONE, Surface};

impl Surface {
    /// Renumbers the vertices.
    pub fn renumber(&mut self, number: impl Fn(u32) -> u32) {
        self.corners.iter_mut().for_each(|corner| corner.vertex = number(corner.vertex));
    }

    /// Keeps the triangles that are marked. A polygon that loses some falls into the pieces between them.
    /// Returns how many polygons do.
    pub fn retain_triangles(&mut self, keep: &[bool]) -> usize {
        self.cut(|triangle| if keep[triangle] { Fate::Keep } else { Fate::Drop })
    }

    /// Makes polygons of their own of the triangles that are marked. Returns how many polygons are cut.
    pub fn isolate_triangles(&mut self, alone: &[bool]) -> usize {
        self.cut(|triangle| if alone[triangle] { Fate::Isolate } else { Fate::Keep })
    }

    /// Splits triangles, each a polygon of its own, along their first edge: triangle `t` with corners a, b, c
    /// becomes a, v, c; v, w, c; .. for the vertices v, w, .. that are given with their places from a (0) to
    /// b (1). The first piece stays in the triangle's place, the others are appended, split by split. Texture
    /// coordinates are interpolated. `start` is the corner, 0 to 2, that is a.
    pub fn split_triangles(&mut self, splits: &[EdgeSplit]) {
        let polygon_of = self.polygons_of_triangles();
        for split in splits {
            let index = polygon_of[split.triangle as usize] as usize;
            let first = self.ends[index] - 3;
            let labels = self.polygon(index).labels.clone();
            let corner = |k: usize| self.corners[first + (split.start + k) % 3];
            let [a, b, apex] = [corner(0), corner(1), corner(2)];
            let mut chain = vec![a];
            for &(vertex, share) in &split.through {
                let texture = self.between(a, b, share);
                chain.push(Corner { vertex, texture, normal: self.added_normal(a) });
            }
            chain.push(b);
            self.corners[first..first + 3].copy_from_slice(&[chain[0], chain[1], apex]);
            for pair in chain[1..].windows(2) {
                self.push([pair[0], pair[1], apex], &labels);
            }
        }
    }

    /// A new texture coordinate between those of two corners.
    fn between(&mut self, a: Corner, b: Corner, share: f64) -> u32 {
        let (Some(i), Some(j)) = (a.texture(), b.texture()) else { return NONE };
        let [p, q] = [i, j].map(|index| self.texture_coordinates[index as usize]);
        self.texture_coordinates.push([0, 1].map(|k| p[k] + share * (q[k] - p[k])));
        self.texture_coordinates.len() as u32 - 1
    }

    /// A new normal where the neighboring corner has one.
    fn added_normal(&mut self, neighbor: Corner) -> u32 {
        if neighbor.normal == NONE {
            return NONE;
        }
        self.normal_count += 1;
        self.normal_count - 1
    }

    fn polygons_of_triangles(&self) -> Vec<u32> {
        (0..).zip(self.polygons()).flat_map(|(k, p)| std::iter::repeat_n(k, p.corners.len() - 2)).collect()
    }

    /// Appends another surface, whose vertex 0 is `first_vertex` here.
    pub fn append(&mut self, other: &Self, first_vertex: u32) {
        let (textures, normals) = (self.texture_coordinates.len() as u32, self.normal_count);
        let shifted = |corner: &Corner| Corner {
            vertex: corner.vertex + first_vertex,
            texture: corner.texture().map_or(NONE, |index| index + textures),
            normal: corner.normal().map_or(NONE, |number| number + normals),
        };
        for polygon in other.polygons() {
            self.push(polygon.corners.iter().map(shifted), polygon.labels);
        }
        self.texture_coordinates.extend_from_slice(&other.texture_coordinates);
        self.normal_count += other.normal_count;
        for library in &other.material_libraries {
            if !self.material_libraries.contains(library) {
                self.material_libraries.push(library.clone());
            }
        }
    }

    /// Gives every polygon without an object this one.
    pub fn name_objects(&mut self, name: &str) {
        for labels in &mut self.labels {
            labels.object.get_or_insert_with(|| name.to_owned());
        }
    }

    /// Takes the surface apart into `count` ones: a polygon goes to the part of its first vertex, and vertex
    /// v becomes vertex `local[v]`. A part without polygons is none.
    pub fn split(&self, part_of: &[u32], local: &[u32], count: usize) -> Vec<Option<Self>> {
        let mut parts: Vec<Self> = vec![Self::default(); count];
        let mut copier = Copier::new(self);
        for polygon in self.polygons() {
            let index = part_of[polygon.corners[0].vertex as usize];
            let part = &mut parts[index as usize];
            let renumbered = |mut corner: Corner| {
                corner.vertex = local[corner.vertex as usize];
                corner
            };
            copier.push(part, index, polygon.corners.iter().copied().map(renumbered), polygon.labels);
        }
        let with_libraries =
            |part: Self| Self { material_libraries: self.material_libraries.clone(), ..part };
        parts.into_iter().map(|part| Some(part).filter(|p| !p.is_empty()).map(with_libraries)).collect()
    }

    /// Cuts polygons into pieces by what becomes of the triangles of their fans. Texture coordinates and
    /// normals that no corner refers to any more are dropped. Returns how many polygons are cut.
    fn cut(&mut self, fate: impl Fn(usize) -> Fate) -> usize {
        let triangles = self.corners.len() - 2 * self.len();
        if (0..triangles).all(|t| fate(t) == Fate::Keep) {
            return 0;
        }
        let mut cut = 0;
        let mut pieces = Self { material_libraries: self.material_libraries.clone(), ..Self::default() };
        let mut copier = Copier::new(self);
        let mut first_triangle = 0;
        for polygon in self.polygons() {
            let corners = polygon.corners;
            let fates: Vec<Fate> = (0..corners.len() - 2).map(|k| fate(first_triangle + k)).collect();
            first_triangle += fates.len();
            let is_kept = |fate: &Fate| *fate != Fate::Drop;
            cut += usize::from(
                fates.len() > 1 && fates.iter().any(|f| *f != Fate::Keep) && fates.iter().any(is_kept),
            );
            let mut start = 0;
            for run in fates.chunk_by(|a, b| *a == Fate::Keep && *b == Fate::Keep) {
                let end = start + run.len();
                if run[0] != Fate::Drop {
                    let fan = std::iter::once(&corners[0]).chain(&corners[start + 1..=end + 1]);
                    copier.push(&mut pieces, 0, fan.copied(), polygon.labels);
                }
                start = end;
            }
        }
        *self = pieces;
        cut
    }
}

/// A triangle of a surface that is split at vertices on one of its edges.
#[derive(Clone, Debug, PartialEq)]
pub struct EdgeSplit {
    /// The triangle.
    pub triangle: u32,
    /// Which of its corners the edge begins with, 0 to 2.
    pub start: usize,
    /// Vertices on the edge, each with its place from the beginning (0) to the end (1) of the edge.
    pub through: Vec<(u32, f64)>,
}

/// What becomes of a triangle of a polygon's fan.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Fate {
    Keep,
    Drop,
    /// It becomes a polygon of its own.
    Isolate,
}

/// Copies polygons to other surfaces, which get the texture coordinates and normals that they use.
struct Copier<'a> {
    source: &'a Surface,
    /// For each texture coordinate, the part that it was copied to last, and its index there.
    textures: Vec<(u32, u32)>,
    normals: Vec<(u32, u32)>,
}

impl<'a> Copier<'a> {
    fn new(source: &'a Surface) -> Self {
        let textures = vec![(NONE, 0); source.texture_coordinates.len()];
        Self { source, textures, normals: vec![(NONE, 0); source.normal_count()] }
    }

    fn push(
        &mut self,
        target: &mut Surface,
        part: u32,
        corners: impl Iterator<Item = Corner>,
        labels: &Labels,
    ) {
        let Self { source, textures, normals } = self;
        let copied: Vec<Corner> = corners
            .map(|mut corner| {
                if let Some(index) = corner.texture() {
                    let known = &mut textures[index as usize];
                    if known.0 != part {
                        *known = (part, target.texture_coordinates.len() as u32);
                        target.texture_coordinates.push(source.texture_coordinates[index as usize]);
                    }
                    corner.texture = known.1;
                }
                if let Some(number) = corner.normal() {
                    let known = &mut normals[number as usize];
                    if known.0 != part {
                        *known = (part, target.normal_count);
                        target.normal_count += 1;
                    }
                    corner.normal = known.1;
                }
                corner
            })
            .collect();
        target.push(copied, labels);
    }
}
