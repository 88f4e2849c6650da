//! Frames in every format.
//!
//! ```text
//! frames/000000.ply  .obj  .vtu     one file per frame
//! frames.pvd                        the .vtu files with their times
//! frames.npz                        all frames
//! scene.usda                        all frames
//! scene.glb                         all frames
//! pc2/BODY.pc2, pc2/BODY.obj        the motion of a body, and the body at the first frame
//! fields/velocities.f64, ..         vectors of all vertices of all frames, if the scene asks for them
//! surface/000000.obj                what a mesh says about its faces, for exports of PLY frames later on
//! ```
//!
//! The archive, the USD stage and the glTF scene come into being when a run ends, from a spool of bare positions on
//! disk.

use super::layout::{Layout, Part};
use super::spool::Spool;
use bowknot_errors::counted;
use bowknot_geometry::{Point, Vector};
use bowknot_io::{
    self as io, Field, FieldValues, GltfBody, Import, IoError, MeshView, Place, UsdBody, create_folder,
    write_frame_stack_with_fields, write_glb, write_obj, write_ply, write_usda_with_fields,
    write_vtu_with_fields,
};
use bowknot_scene::Format;
use std::path::{Path, PathBuf};

/// The first frame of a run, with all that its meshes say about their faces.
pub(super) const SURFACE: &str = "surface/000000.obj";

/// Where a run keeps a field.
pub(super) fn field_file(field: Field) -> &'static str {
    match field {
        Field::Velocity => "fields/velocities.f64",
        Field::ContactForce => "fields/contact_forces.f64",
    }
}

/// Formats that are made from the spool.
fn needs_spool(format: &Format) -> bool {
    matches!(format, Format::Npz | Format::Usd | Format::Gltf)
}

/// Writes frames, one after the other.
#[derive(Debug)]
pub(super) struct FrameWriter {
    folder: PathBuf,
    formats: Vec<Format>,
    pub layout: Layout,
    parts: Vec<Part>,
    /// File names of the parts, without endings.
    part_files: Vec<String>,
    spool: Option<Spool>,
    fields: Vec<(Field, Spool)>,
    /// Time from frame to frame [s].
    time_step: f64,
    /// Thickness of strands and particles where it is shown [m]; none: from their size at the first frame.
    width: Option<f64>,
}

impl FrameWriter {
    /// Prepares the folders. The spool is a file of this path, which stays until someone removes it. Fields are
    /// kept in files of their paths, whatever the formats.
    pub fn new(
        folder: &Path,
        formats: &[Format],
        layout: Layout,
        spool: PathBuf,
        fields: Vec<(Field, PathBuf)>,
        time_step: f64,
        width: Option<f64>,
    ) -> Result<Self, IoError> {
        let mut formats = formats.to_vec();
        formats.dedup();
        if formats.iter().any(|f| matches!(f, Format::Ply | Format::Obj | Format::Vtu)) {
            create_folder(&folder.join("frames"))?;
        }
        if formats.contains(&Format::Pc2) {
            create_folder(&folder.join("pc2"))?;
        }
        let parts = layout.parts();
        let spool = formats.iter().any(needs_spool).then(|| Spool::new(spool, layout.vertices()));
        let fields = fields.into_iter().map(|(field, path)| (field, Spool::new(path, layout.vertices())));
        let fields = fields.collect();
        let part_files = file_names(&parts);
        let folder = folder.to_owned();
        Ok(Self { folder, formats, layout, parts, part_files, spool, fields, time_step, width })
    }

    /// The fields that frames have, in the order in which [`Self::write`] takes them.
    pub fn fields(&self) -> impl Iterator<Item = Field> {
        self.fields.iter().map(|(field, _)| *field)
    }

    /// Writes a frame, counted from 0, of as many positions as the layout has vertices, and as many vectors of
    /// each field.
    pub fn write(&self, frame: usize, positions: &[Point], fields: &[Vec<Vector>]) -> Result<(), IoError> {
        let view = self.layout.view(positions);
        for ((_, spool), values) in self.fields.iter().zip(fields) {
            let points: Vec<Point> = values.iter().map(|&value| Point::from(value)).collect();
            spool.write(frame, &points)?;
        }
        let values = self.fields().zip(fields).map(|(field, values)| FieldValues { field, values });
        let values: Vec<FieldValues<'_>> = values.collect();
        for format in &self.formats {
            match format {
                Format::Ply => write_ply(&self.frame_path(frame, "ply"), &view)?,
                Format::Obj => write_obj(&self.frame_path(frame, "obj"), &view)?,
                Format::Vtu => write_vtu_with_fields(&self.frame_path(frame, "vtu"), &view, &values)?,
                Format::Pc2 => self.write_caches(frame, positions)?,
                Format::Npz | Format::Usd | Format::Gltf => {}
            }
        }
        self.spool.as_ref().map_or(Ok(()), |spool| spool.write(frame, positions))
    }

    /// Writes the first frame for those who export frames of formats that do not hold all that the layout
    /// says about faces, if it does.
    pub fn write_surface(&self, positions: &[Point]) -> Result<(), IoError> {
        if !self.layout.has_surface() {
            return Ok(());
        }
        let path = self.folder.join(SURFACE);
        create_folder(path.parent().unwrap_or(&self.folder))?;
        write_obj(&path, &self.layout.view(positions))
    }

    fn write_caches(&self, frame: usize, positions: &[Point]) -> Result<(), IoError> {
        for (part, name) in self.parts.iter().zip(&self.part_files) {
            let positions = part.positions(positions);
            if frame == 0 {
                let view = MeshView { positions: &positions, ..part.elements() };
                write_obj(&self.folder.join(format!("pc2/{name}.obj")), &view)?;
            }
            io::write_pc2_frame(&self.cache_path(name), frame, &positions)?;
        }
        Ok(())
    }

    /// Makes files of many frames hold the first `frames`, as a run that is resumed needs them; what they
    /// lack comes from the other formats.
    ///
    /// # Errors
    /// Fields of fewer frames, which nothing else has.
    pub fn restore(&self, frames: usize) -> Result<(), IoError> {
        if let Some((field, spool)) = self.fields.iter().find(|(_, spool)| spool.frames() < frames) {
            let message = format!(
                "it has {}, {frames} are needed: go on without the output of {}, or compute the run from its start",
                counted(spool.frames(), "frame", "frames"),
                field.name()
            );
            return Err(IoError::content(spool.path(), Place::File, message));
        }
        let caches = self.formats.contains(&Format::Pc2)
            && self.parts.iter().zip(&self.part_files).any(|(part, name)| {
                io::truncate_pc2(&self.cache_path(name), frames, part.vertices.len()).is_err()
            });
        let spool = self.spool.as_ref().filter(|spool| spool.frames() < frames);
        if !caches && spool.is_none() {
            return Ok(());
        }
        for frame in 0..frames {
            let positions = self.past(frame, spool.is_none())?;
            if let Some(spool) = spool {
                spool.write(frame, &positions)?;
            }
            if caches {
                self.write_caches(frame, &positions)?;
            }
        }
        Ok(())
    }

    /// A frame that was written before.
    fn past(&self, frame: usize, from_spool: bool) -> Result<Vec<Point>, IoError> {
        if let Some(spool) = self.spool.as_ref().filter(|_| from_spool) {
            return spool.read(frame).map_err(|source| IoError::system("read", spool.path(), source));
        }
        let paths = ["ply", "obj"].map(|ending| self.frame_path(frame, ending));
        let path = paths.iter().find(|path| path.exists()).unwrap_or(&paths[0]);
        let positions = io::read_mesh(path, &Import::default())?.positions;
        if positions.len() == self.layout.vertices() {
            return Ok(positions);
        }
        let message = format!(
            "it has {}, not {}",
            counted(positions.len(), "vertex", "vertices"),
            self.layout.vertices()
        );
        Err(IoError::content(path, Place::File, message))
    }

    /// Writes what is written once, of `frames` frames.
    pub fn finish(&self, frames: usize) -> Result<(), IoError> {
        if self.formats.contains(&Format::Vtu) {
            // A run resumed with this format has no such files of its first part.
            let grids = (0..frames).filter(|&f| self.frame_path(f, "vtu").exists());
            let grids = grids.map(|f| (f as f64 * self.time_step, format!("frames/{f:06}.vtu")));
            io::write_pvd(&self.folder.join("frames.pvd"), grids)?;
        }
        let Some(spool) = &self.spool else { return Ok(()) };
        if self.formats.contains(&Format::Npz) {
            let path = self.folder.join("frames.npz");
            let (view, fields) = (self.layout.view(&[]), self.fields().collect::<Vec<_>>());
            write_frame_stack_with_fields(&path, &view, frames, &fields, |field, frame, bytes| {
                self.spool_of(spool, field).read_bytes(frame, bytes)
            })?;
        }
        if self.formats.contains(&Format::Usd) {
            self.write_stage(spool, frames)?;
        }
        if self.formats.contains(&Format::Gltf) {
            let bodies = self.parts.iter().map(|part| GltfBody {
                name: &part.name,
                elements: part.elements(),
                obstacle: part.obstacle,
            });
            let (path, bodies) = (self.folder.join("scene.glb"), bodies.collect::<Vec<_>>());
            write_glb(&path, &bodies, frames, self.time_step, |body, frame| {
                Ok(self.parts[body].positions(&spool.read(frame)?))
            })?;
        }
        Ok(())
    }

    /// The spool of a field, else that of positions.
    fn spool_of<'a>(&'a self, positions: &'a Spool, field: Option<Field>) -> &'a Spool {
        let found = self.fields.iter().find(|(own, _)| Some(*own) == field);
        found.map_or(positions, |(_, spool)| spool)
    }

    fn write_stage(&self, spool: &Spool, frames: usize) -> Result<(), IoError> {
        let start = spool.read(0).map_err(|source| IoError::system("read", spool.path(), source))?;
        let bodies: Vec<UsdBody<'_>> = self
            .parts
            .iter()
            .map(|part| UsdBody {
                name: &part.name,
                elements: part.elements(),
                obstacle: part.obstacle,
                width: self.width.unwrap_or_else(|| typical_width(part, &start)),
            })
            .collect();
        let path = self.folder.join("scene.usda");
        let (rate, fields) = (1.0 / self.time_step, self.fields().collect::<Vec<_>>());
        write_usda_with_fields(&path, &bodies, frames, rate, &fields, |field, body, frame| {
            Ok(self.parts[body].positions(&self.spool_of(spool, field).read(frame)?))
        })
    }

    /// Removes the spool and the files of fields.
    pub fn remove_spools(&self) {
        self.spool.iter().chain(self.fields.iter().map(|(_, spool)| spool)).for_each(Spool::remove);
    }

    fn frame_path(&self, frame: usize, ending: &str) -> PathBuf {
        self.folder.join(format!("frames/{frame:06}.{ending}"))
    }

    fn cache_path(&self, name: &str) -> PathBuf {
        self.folder.join(format!("pc2/{name}.pc2"))
    }
}

/// A tenth of the mean strand edge; without strands, the edge of the cube that each vertex has to itself [m].
fn typical_width(part: &Part, start: &[Point]) -> f64 {
    /// Where there is nothing to go by [m].
    const FALLBACK: f64 = 1e-3;
    let positions = part.positions(start);
    let strands = part.elements().strands;
    let width = if strands.is_empty() {
        let first = positions.first().copied().unwrap_or_default();
        let bounds = positions.iter().fold((first, first), |(low, high), p| (low.inf(p), high.sup(p)));
        libm::cbrt((bounds.1 - bounds.0).product() / positions.len() as f64)
    } else {
        let length = |&[i, j]: &[u32; 2]| (positions[i as usize] - positions[j as usize]).norm();
        0.1 * strands.iter().map(length).sum::<f64>() / strands.len() as f64
    };
    if width > 0.0 && width.is_finite() { width } else { FALLBACK }
}

/// Names of the parts as file names: what a system may not like becomes an underscore, names given twice get
/// a number.
fn file_names(parts: &[Part]) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for part in parts {
        let plain = |c: char| if c.is_alphanumeric() || "-_".contains(c) { c } else { '_' };
        let name: String = part.name.chars().map(plain).collect();
        let mut unique = name.clone();
        let mut number = 2;
        // Some systems do not tell capitals from small letters.
        while names.iter().any(|other| other.to_lowercase() == unique.to_lowercase()) {
            unique = format!("{name}_{number}");
            number += 1;
        }
        names.push(unique);
    }
    names
}
