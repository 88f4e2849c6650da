//! The polygons of a mesh.

use std::path::PathBuf;

/// Stands for an index that a corner does not have. Half of the size of an `Option<u32>`: meshes have
/// millions of corners.
pub(super) const NONE: u32 = u32::MAX;

/// A corner of a polygon.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Corner {
    /// Its vertex.
    pub vertex: u32,
    pub(super) texture: u32,
    pub(super) normal: u32,
}

impl Corner {
    /// A corner at a vertex, with the index of its texture coordinate and the number of its normal. Neither
    /// may be `u32::MAX`.
    pub fn new(vertex: u32, texture: Option<u32>, normal: Option<u32>) -> Self {
        Self { vertex, texture: texture.unwrap_or(NONE), normal: normal.unwrap_or(NONE) }
    }

    /// Index of its texture coordinate.
    pub fn texture(&self) -> Option<u32> {
        (self.texture != NONE).then_some(self.texture)
    }

    /// Number of its normal: corners of a vertex with one number are smooth, others have an edge between
    /// them.
    pub fn normal(&self) -> Option<u32> {
        (self.normal != NONE).then_some(self.normal)
    }
}

/// Names that hold for a polygon, as the file gives them; none: never stated.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Labels {
    /// Object, `o` of an OBJ.
    pub object: Option<String>,
    /// Groups, separated by blanks, `g` of an OBJ.
    pub group: Option<String>,
    /// Material, `usemtl` of an OBJ.
    pub material: Option<String>,
    /// Smoothing group, `s` of an OBJ.
    pub smoothing: Option<String>,
}

/// A polygon of a [`Surface`].
#[derive(Clone, Copy, Debug)]
pub struct Polygon<'a> {
    /// Its corners, three at least.
    pub corners: &'a [Corner],
    /// Its names.
    pub labels: &'a Labels,
}

/// The polygons of a mesh and what belongs to them.
///
/// The values of normals are not kept, because they would be wrong once the mesh deforms; [`Self::normals`]
/// computes them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Surface {
    /// Corners of all polygons.
    pub(super) corners: Vec<Corner>,
    /// Where the corners of each polygon end.
    pub(super) ends: Vec<usize>,
    /// Labels of each polygon.
    pub(super) label: Vec<u32>,
    /// In the order in which polygons change from one to the next.
    pub(super) labels: Vec<Labels>,
    pub(super) texture_coordinates: Vec<[f64; 2]>,
    pub(super) normal_count: u32,
    pub(super) material_libraries: Vec<PathBuf>,
}

impl Surface {
    /// A surface without polygons. Texture coordinates may be of any number; normals are numbered from 0 to
    /// `normal_count`; libraries are files with materials.
    pub fn new(
        texture_coordinates: Vec<[f64; 2]>,
        normal_count: u32,
        material_libraries: Vec<PathBuf>,
    ) -> Self {
        Self { texture_coordinates, normal_count, material_libraries, ..Self::default() }
    }

    /// A surface of nameless triangles.
    pub fn of_triangles(triangles: &[[u32; 3]]) -> Self {
        let mut surface = Self::default();
        surface.push_triangles(triangles, &Labels::default());
        surface
    }

    /// Appends a polygon. Its corners, three at least, must be of existing texture coordinates and normals.
    pub fn push(&mut self, corners: impl IntoIterator<Item = Corner>, labels: &Labels) {
        if self.labels.last() != Some(labels) {
            self.labels.push(labels.clone());
        }
        self.corners.extend(corners);
        self.ends.push(self.corners.len());
        self.label.push(self.labels.len() as u32 - 1);
    }

    /// Appends triangles without texture coordinates and normals.
    pub fn push_triangles(&mut self, triangles: &[[u32; 3]], labels: &Labels) {
        for triangle in triangles {
            self.push(triangle.map(|v| Corner::new(v, None, None)), labels);
        }
    }

    /// Number of polygons.
    pub fn len(&self) -> usize {
        self.ends.len()
    }

    /// Whether there are no polygons.
    pub fn is_empty(&self) -> bool {
        self.ends.is_empty()
    }

    /// The polygons in their order.
    pub fn polygons(&self) -> impl Iterator<Item = Polygon<'_>> {
        (0..self.len()).map(|index| self.polygon(index))
    }

    pub(super) fn polygon(&self, index: usize) -> Polygon<'_> {
        let start = if index == 0 { 0 } else { self.ends[index - 1] };
        let labels = &self.labels[self.label[index] as usize];
        Polygon { corners: &self.corners[start..self.ends[index]], labels }
    }

    /// Corners of all polygons.
    pub fn corners(&self) -> &[Corner] {
        &self.corners
    }

    /// The triangles of all polygons, as fans around their first corners.
    pub fn triangles(&self) -> impl Iterator<Item = [u32; 3]> {
        self.polygons().flat_map(|polygon| {
            let [first, rest @ ..] = polygon.corners else { return Vec::new() };
            rest.windows(2).map(|pair| [first.vertex, pair[0].vertex, pair[1].vertex]).collect()
        })
    }

    /// Texture coordinates that corners refer to.
    pub fn texture_coordinates(&self) -> &[[f64; 2]] {
        &self.texture_coordinates
    }

    /// Number of normals that corners refer to; 0: it has none.
    pub fn normal_count(&self) -> usize {
        self.normal_count as usize
    }

    /// Files that hold the materials.
    pub fn material_libraries(&self) -> &[PathBuf] {
        &self.material_libraries
    }

    /// The texture coordinate of each of `vertices` vertices, if none has two different ones and any has one;
    /// vertices without one get 0, 0.
    pub fn vertex_texture_coordinates(&self, vertices: usize) -> Option<Vec<[f64; 2]>> {
        let mut found = vec![None; vertices];
        let mut any = false;
        for corner in &self.corners {
            let Some(texture) = corner.texture() else { continue };
            let coordinate = self.texture_coordinates[texture as usize];
            let slot = &mut found[corner.vertex as usize];
            if slot.is_some_and(|other| other != coordinate) {
                return None;
            }
            *slot = Some(coordinate);
            any = true;
        }
        any.then(|| found.into_iter().map(Option::unwrap_or_default).collect())
    }
}
