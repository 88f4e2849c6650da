//! Universal Scene Description as text, `.usda`: meshes, curves and points that move.
//!
//! Sources: the USD glossary and the schema pages of UsdGeom (Mesh, BasisCurves, Points). Topology is
//! constant, `points`, `extent` and `normals` are time samples, one time code per frame. USD's points are
//! single-precision.

mod attributes;
mod chains;
mod names;
mod read;
mod text;

pub(crate) use read::Stage;

use crate::atomic::write_atomic;
use crate::error::IoError;
use crate::field::Field;
use crate::mesh::MeshView;
use crate::surface::Surface;
use attributes::Materials;
use bowknot_geometry::Point;
use std::io::Write;
use std::path::Path;
use text::{quoted, write_list, write_point};

/// A body of a stage.
#[derive(Clone, Copy, Debug)]
pub struct UsdBody<'a> {
    /// Its name; characters that USD does not allow become underscores, names given twice get a number.
    pub name: &'a str,
    /// Elements, over its own vertices; positions are not looked at.
    pub elements: MeshView<'a>,
    /// Whether it is an obstacle, which is shown in a muted color.
    pub obstacle: bool,
    /// Thickness of its strands and particles [m].
    pub width: f64,
}

/// Writes a stage of all `frames`, atomically. `read(body, frame)` gives the positions of a body [m]; only
/// one frame of one body is held at a time, but that each is asked for in turn, body by body.
///
/// Time code k is frame k, at k / `rate` seconds; z is up, one unit a meter.
///
/// # Errors
/// The system's refusal, with the path; what `read` reports.
pub fn write_usda(
    path: &Path,
    bodies: &[UsdBody<'_>],
    frames: usize,
    rate: f64,
    mut read: impl FnMut(usize, usize) -> std::io::Result<Vec<Point>>,
) -> Result<(), IoError> {
    write_usda_with_fields(path, bodies, frames, rate, &[], |_, body, frame| read(body, frame))
}

/// As [`write_usda`], with time samples of the fields: `velocities` [m/s], `primvars:contactForce` [N].
/// `read(field, body, frame)` gives the vectors of a field, or the positions if it gets none.
///
/// # Errors
/// As [`write_usda`].
pub fn write_usda_with_fields(
    path: &Path,
    bodies: &[UsdBody<'_>],
    frames: usize,
    rate: f64,
    fields: &[Field],
    mut read: impl FnMut(Option<Field>, usize, usize) -> std::io::Result<Vec<Point>>,
) -> Result<(), IoError> {
    let mut names = names::identifiers(bodies.iter().map(|body| body.name).chain(["Materials"]));
    let surfaces = bodies.iter().filter_map(|body| body.elements.surface);
    let materials = Materials::new(surfaces, names.pop().unwrap_or_default());
    write_atomic(path, |out| {
        write!(
            out,
            "#usda 1.0\n(\n    defaultPrim = \"World\"\n    doc = \"Written by Bowknot {}\"\n    endTimeCode \
             = {}\n    framesPerSecond = {rate}\n    metersPerUnit = 1\n    startTimeCode = 0\n    \
             timeCodesPerSecond = {rate}\n    upAxis = \"Z\"\n)\n\ndef Xform \"World\"\n{{\n",
            env!("CARGO_PKG_VERSION"),
            frames.saturating_sub(1)
        )?;
        for (index, (body, name)) in bodies.iter().zip(&names).enumerate() {
            for prim in Prim::of_body(body, name) {
                prim.begin(out, body)?;
                let pad = if prim.kind == PrimKind::Mesh { 0.0 } else { body.width / 2.0 };
                let mut extents = Vec::with_capacity(frames);
                out.write_all(b"        point3f[] points.timeSamples = {\n")?;
                for frame in 0..frames {
                    let positions = read(None, index, frame)?;
                    let points = || prim.vertices.iter().filter_map(|&v| positions.get(v as usize));
                    extents.push(extent(points(), pad));
                    write!(out, "            {frame}: [")?;
                    for (k, point) in points().enumerate() {
                        write_point(out, k, point)?;
                    }
                    out.write_all(b"],\n")?;
                }
                out.write_all(b"        }\n        float3[] extent.timeSamples = {\n")?;
                for (frame, [low, high]) in extents.iter().enumerate() {
                    write!(out, "            {frame}: [")?;
                    write_point(out, 0, low)?;
                    write_point(out, 1, high)?;
                    out.write_all(b"],\n")?;
                }
                out.write_all(b"        }\n")?;
                for &field in fields {
                    prim.write_field(out, field, frames, |frame| read(Some(field), index, frame))?;
                }
                if let Some(surface) = prim.surface {
                    attributes::write_normals(out, surface, frames, |frame| read(None, index, frame))?;
                    attributes::write_subsets(out, surface, body.name, &materials)?;
                }
                out.write_all(b"    }\n\n")?;
            }
        }
        materials.write(out)?;
        out.write_all(b"}\n")
    })
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum PrimKind {
    Mesh,
    BasisCurves,
    Points,
}

/// A primitive of a body: its surface, strands or particles.
struct Prim<'a> {
    kind: PrimKind,
    name: String,
    /// Whether it is the first of its body.
    is_first: bool,
    /// The body's vertices that are its points, in this order.
    vertices: Vec<u32>,
    /// Of a mesh the vertices of each face, of curves those of each curve.
    counts: Vec<usize>,
    /// Of a mesh: the points of each face.
    indices: Vec<u32>,
    /// Of a mesh: its polygons, if more is known of them than their vertices.
    surface: Option<&'a Surface>,
}

impl<'a> Prim<'a> {
    fn of_body(body: &UsdBody<'a>, name: &str) -> Vec<Self> {
        let elements = &body.elements;
        let mut prims = Vec::new();
        if !elements.triangles.is_empty() || !elements.quads.is_empty() {
            let (counts, mut indices) = faces(elements);
            let mut vertices = indices.clone();
            vertices.sort_unstable();
            vertices.dedup();
            indices.iter_mut().for_each(|v| *v = vertices.partition_point(|w| w < v) as u32);
            let surface = elements.surface;
            prims.push(Self {
                kind: PrimKind::Mesh,
                name: name.to_owned(),
                is_first: true,
                vertices,
                counts,
                indices,
                surface,
            });
        }
        if !elements.strands.is_empty() {
            let chains = chains::chains(elements.strands);
            prims.push(Self {
                kind: PrimKind::BasisCurves,
                name: if prims.is_empty() { name.to_owned() } else { format!("{name}_strands") },
                is_first: prims.is_empty(),
                counts: chains.iter().map(Vec::len).collect(),
                vertices: chains.concat(),
                indices: Vec::new(),
                surface: None,
            });
        }
        if !elements.particles.is_empty() {
            prims.push(Self {
                kind: PrimKind::Points,
                name: if prims.is_empty() { name.to_owned() } else { format!("{name}_particles") },
                is_first: prims.is_empty(),
                vertices: elements.particles.to_vec(),
                counts: Vec::new(),
                indices: Vec::new(),
                surface: None,
            });
        }
        prims
    }

    /// All that does not move.
    fn begin(&self, out: &mut impl Write, body: &UsdBody<'_>) -> std::io::Result<()> {
        // The strands and particles of a body have names of their own.
        let label = match body.name != self.name && self.is_first {
            true => format!(" (\n        displayName = {}\n    )", quoted(body.name)),
            false => String::new(),
        };
        write!(out, "    def {:?} \"{}\"{label}\n    {{\n", self.kind, self.name)?;
        match self.kind {
            PrimKind::Mesh => {
                out.write_all(b"        uniform bool doubleSided = 1\n")?;
                write_list(out, "int[] faceVertexCounts", &self.counts)?;
                write_list(out, "int[] faceVertexIndices", &self.indices)?;
                out.write_all(b"        uniform token subdivisionScheme = \"none\"\n")?;
                if let Some(surface) = self.surface {
                    attributes::write_texture_coordinates(out, surface)?;
                }
            }
            PrimKind::BasisCurves => {
                write_list(out, "int[] curveVertexCounts", &self.counts)?;
                out.write_all(b"        uniform token type = \"linear\"\n")?;
                let width = body.width as f32;
                write!(
                    out,
                    "        float[] widths = [{width:?}] (\n            interpolation \
                     = \"constant\"\n        )\n"
                )?;
            }
            // A constant width is read by some programs as that of the first point only.
            PrimKind::Points => {
                write_list(out, "float[] widths", vec![body.width as f32; self.vertices.len()])?
            }
        }
        writeln!(out, "        custom bool {} = {}", names::OBSTACLE, u8::from(body.obstacle))?;
        let color = if body.obstacle { "(0.6, 0.6, 0.62)" } else { "(0.75, 0.35, 0.25)" };
        writeln!(out, "        color3f[] primvars:displayColor = [{color}]")
    }
}

impl Prim<'_> {
    /// The vectors of its points in all frames.
    fn write_field(
        &self,
        out: &mut impl Write,
        field: Field,
        frames: usize,
        mut read: impl FnMut(usize) -> std::io::Result<Vec<Point>>,
    ) -> std::io::Result<()> {
        let name = field.attribute();
        if field != Field::Velocity {
            let metadata = "(\n            interpolation = \"vertex\"\n        )";
            writeln!(out, "        vector3f[] {name} {metadata}")?;
        }
        writeln!(out, "        vector3f[] {name}.timeSamples = {{")?;
        for frame in 0..frames {
            let values = read(frame)?;
            write!(out, "            {frame}: [")?;
            for (k, value) in self.vertices.iter().filter_map(|&v| values.get(v as usize)).enumerate() {
                write_point(out, k, value)?;
            }
            out.write_all(b"],\n")?;
        }
        out.write_all(b"        }\n")
    }
}

/// The number of vertices of each face, and these.
fn faces(elements: &MeshView<'_>) -> (Vec<usize>, Vec<u32>) {
    if let Some(surface) = elements.surface {
        let counts = surface.polygons().map(|polygon| polygon.corners.len()).collect();
        return (counts, surface.corners().iter().map(|corner| corner.vertex).collect());
    }
    let mut counts = vec![3; elements.triangles.len()];
    counts.resize(counts.len() + elements.quads.len(), 4);
    let flat = elements.triangles.as_flattened().iter().chain(elements.quads.as_flattened());
    (counts, flat.copied().collect())
}

/// Corners of the box around points and their thickness.
fn extent<'a>(points: impl Iterator<Item = &'a Point>, pad: f64) -> [Point; 2] {
    let bounds = points.fold(None, |bounds: Option<(Point, Point)>, p| {
        Some(bounds.map_or((*p, *p), |(low, high)| (low.inf(p), high.sup(p))))
    });
    let (low, high) = bounds.unwrap_or_default();
    [low.map(|x| x - pad), high.map(|x| x + pad)]
}
