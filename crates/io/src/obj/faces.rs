//! From the statements about faces to a surface.

use super::library;
use crate::groups::Groups;
use crate::surface::{Corner, Labels, Surface};
use std::path::{Path, PathBuf};

/// Collects polygons as soon as a face is more than a nameless triangle; before, it only remembers what holds
/// for the faces that follow.
#[derive(Debug, Default)]
pub(super) struct Faces {
    labels: Labels,
    libraries: Vec<PathBuf>,
    texture_coordinates: Vec<[f64; 2]>,
    /// Bits of the values: they only tell which ones are the same.
    normals: Vec<[u64; 3]>,
    surface: Option<Surface>,
}

impl Faces {
    /// Takes a statement of names; others are skipped. Without a name it returns to what holds at the start.
    pub fn name(&mut self, keyword: &str, name: &str, folder: &Path) {
        // A backslash at the end would continue the line when it is written again.
        let name = name.trim_end_matches(|c: char| c == '\\' || c.is_whitespace());
        let label = (!name.is_empty()).then(|| name.to_owned());
        match keyword {
            "o" => self.labels.object = label,
            "g" => self.labels.group = label,
            "usemtl" => self.labels.material = label,
            "s" => self.labels.smoothing = label,
            "mtllib" if !name.is_empty() => {
                for file in library::named_files(name, folder) {
                    if !self.libraries.contains(&file) {
                        self.libraries.push(file);
                    }
                }
            }
            _ => {}
        }
    }

    /// Texture coordinates so far.
    pub fn texture_coordinates(&self) -> usize {
        self.texture_coordinates.len()
    }

    pub fn add_texture_coordinate(&mut self, coordinate: [f64; 2]) {
        self.texture_coordinates.push(coordinate);
    }

    /// Normals so far.
    pub fn normals(&self) -> usize {
        self.normals.len()
    }

    /// Adds a normal. It need not be sound, since it is not kept.
    pub fn add_normal(&mut self, normal: [f64; 3]) {
        self.normals.push(normal.map(f64::to_bits));
    }

    /// The groups that hold for what follows.
    pub fn groups(&self) -> impl Iterator<Item = &str> {
        names(&self.labels)
    }

    /// Takes a face; `before` are the triangles of the faces before it.
    pub fn face(&mut self, corners: &[Corner], before: &[[u32; 3]]) {
        let is_plain = corners.len() == 3
            && self.labels == Labels::default()
            && corners.iter().all(|corner| corner.texture().or(corner.normal()).is_none());
        if self.surface.is_none() && is_plain {
            return;
        }
        let surface = self.surface.get_or_insert_with(|| Surface::of_triangles(before));
        surface.push(corners.iter().copied(), &self.labels);
    }

    /// The surface, if there is more to the faces than triangles. All indices must have been checked.
    ///
    /// Corners of a vertex share a normal if they name the same one. A file in which no two do lists a normal
    /// for each corner: there, equal values are the same normal, unless `by_index`.
    pub fn finish(self, vertices: usize, by_index: bool) -> Option<Surface> {
        let collected = self.surface?;
        let at_vertex = corners_at_vertices(collected.corners(), vertices);
        let numbers = match number(collected.corners(), &at_vertex, |a, b| a == b) {
            (numbers, shared) if shared || by_index => numbers,
            _ => {
                let same = |a: u32, b: u32| self.normals[a as usize] == self.normals[b as usize];
                number(collected.corners(), &at_vertex, same).0
            }
        };
        let count = numbers.iter().flatten().max().map_or(0, |most| most + 1);
        let mut surface = Surface::new(self.texture_coordinates, count, self.libraries);
        let mut numbers = numbers.into_iter();
        for polygon in collected.polygons() {
            let corners = polygon.corners.iter().zip(numbers.by_ref());
            let numbered = corners.map(|(c, normal)| Corner::new(c.vertex, c.texture(), normal));
            surface.push(numbered, polygon.labels);
        }
        Some(surface)
    }
}

/// Adds the vertices of the polygons of each group to `groups`.
pub(super) fn add_groups(surface: &Surface, groups: &mut Groups) {
    let mut polygons = surface.polygons().peekable();
    while let Some(first) = polygons.next() {
        let mut vertices: Vec<u32> = first.corners.iter().map(|corner| corner.vertex).collect();
        // Labels are one object as long as they do not change.
        while let Some(next) = polygons.next_if(|next| std::ptr::eq(next.labels, first.labels)) {
            vertices.extend(next.corners.iter().map(|corner| corner.vertex));
        }
        names(first.labels).for_each(|name| groups.add(name, vertices.iter().copied()));
    }
}

/// The groups of labels.
fn names(labels: &Labels) -> impl Iterator<Item = &str> {
    labels.group.iter().flat_map(|group| group.split_ascii_whitespace())
}

/// The corners at each vertex, in compressed rows: those of v are at `starts[v]..starts[v + 1]`.
struct CornersAtVertices {
    starts: Vec<usize>,
    corners: Vec<usize>,
}

fn corners_at_vertices(corners: &[Corner], vertices: usize) -> CornersAtVertices {
    let mut starts = vec![0; vertices + 1];
    corners.iter().for_each(|corner| starts[corner.vertex as usize + 1] += 1);
    for v in 0..vertices {
        starts[v + 1] += starts[v];
    }
    let mut next = starts.clone();
    let mut rows = vec![0; corners.len()];
    for (index, corner) in corners.iter().enumerate() {
        let place = &mut next[corner.vertex as usize];
        rows[*place] = index;
        *place += 1;
    }
    CornersAtVertices { starts, corners: rows }
}

/// Numbers the normals in the order of the corners, so that two corners have one number if they are at one
/// vertex and their normals are the `same`. Also whether any two do.
fn number(
    corners: &[Corner],
    at_vertex: &CornersAtVertices,
    same: impl Fn(u32, u32) -> bool,
) -> (Vec<Option<u32>>, bool) {
    // The first corner at the vertex with the normal of each corner.
    let mut first: Vec<usize> = (0..corners.len()).collect();
    let mut shared = false;
    for row in at_vertex.starts.windows(2).map(|ends| &at_vertex.corners[ends[0]..ends[1]]) {
        for (k, &corner) in row.iter().enumerate() {
            let Some(normal) = corners[corner].normal() else { continue };
            let is_same = |other: &&usize| corners[**other].normal().is_some_and(|n| same(n, normal));
            if let Some(&earlier) = row[..k].iter().find(is_same) {
                first[corner] = first[earlier];
                shared = true;
            }
        }
    }
    let mut count = 0;
    let mut numbers: Vec<Option<u32>> = Vec::with_capacity(corners.len());
    for (index, corner) in corners.iter().enumerate() {
        numbers.push(match corner.normal() {
            None => None,
            Some(_) if first[index] < index => numbers[first[index]],
            Some(_) => {
                count += 1;
                Some(count - 1)
            }
        });
    }
    (numbers, shared)
}
