//! Frames of a run, or of any folder, in other formats.

use super::frames::{FrameWriter, SURFACE, field_file};
use super::layout::Layout;
use super::spool::Spool;
use bowknot_errors::counted;
use bowknot_geometry::Point;
use bowknot_io::{Field, FrameSource, IoError, Mesh, Place, Surface, create_folder, read_obj_surface};
use bowknot_scene::shapes::Shape;
use bowknot_scene::{Format, Scene};
use std::path::{Path, PathBuf};

/// What becomes of the frames.
#[derive(Clone, Debug, Default)]
pub struct ExportOptions {
    /// The formats; none that the frames have already, if they stay in their folder.
    pub formats: Vec<Format>,
    /// Output folder; frames of the same names are overwritten.
    pub out: PathBuf,
    /// Time from frame to frame of the source [s]; none: that of the run's scene.
    pub time_step: Option<f64>,
    /// Which frames are taken.
    pub rate: Rate,
}

/// Which frames an export takes. They are numbered anew.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Rate {
    /// The first, and every so many from there on [1]; at least 1.
    Every(usize),
    /// So many per second [1/s], which must be those at whole numbers of time steps.
    PerSecond(f64),
}

impl Default for Rate {
    fn default() -> Self {
        Self::Every(1)
    }
}

impl Rate {
    /// Frames from one that is taken to the next.
    fn stride(self, time_step: f64) -> Result<usize, String> {
        /// Error of a number of time steps that is still whole: steps such as 1/96 s are written with few
        /// digits.
        const WHOLE: f64 = 1e-2;
        match self {
            Self::Every(0) => Err("of frames every 0 none is taken: give 1 or more".to_owned()),
            Self::Every(stride) => Ok(stride),
            Self::PerSecond(rate) => {
                let steps = 1.0 / (rate * time_step);
                let whole = steps.round();
                if whole >= 1.0 && (steps - whole).abs() <= WHOLE {
                    return Ok(whole as usize);
                }
                let below = steps.floor().max(1.0);
                let rates = [below, below + 1.0].map(|stride| 1.0 / (stride * time_step));
                Err(format!(
                    "{rate} frames per second are none of its time steps of {time_step} s: it has {:.6} per \
                     second, {:.6} in \
                     every {} and {:.6} in every {}; run it with a time step that divides 1/{rate} s",
                    1.0 / time_step,
                    rates[0],
                    below,
                    rates[1],
                    below + 1.0
                ))
            }
        }
    }
}

/// What was exported.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Exported {
    /// Frames.
    pub frames: usize,
    /// Vertices of each.
    pub vertices: usize,
}

/// Why frames were not exported.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ExportError {
    /// A file that cannot be read or written, frames whose elements differ, or a rate that takes none of them.
    #[error(transparent)]
    Io(#[from] IoError),
    /// Nothing says the time from frame to frame.
    #[error("{}: no scene.toml in it that says the time from frame to frame: give the time step", path.display())]
    NoTimeStep {
        /// The folder or archive that is read.
        path: PathBuf,
    },
    /// Only some frames are taken, and would be written into the folder that they are read from.
    #[error("{}: some of its frames, numbered anew, would mix with its own: name another output folder", path.display())]
    Mixes {
        /// The folder.
        path: PathBuf,
    },
    /// Frames would be written over those that are read.
    #[error("{}: its frames are {format:?} files already: name another output folder", path.display())]
    Overwrites {
        /// The folder.
        path: PathBuf,
        /// The format of its frames.
        format: Format,
    },
}

/// Writes the frames of `source` in other formats: of a run's folder, of a folder of PLY or OBJ files that
/// differ in positions only, or of an NPZ archive. `progress` hears the frames done and their number.
///
/// Frames are taken from PLY files if there are any, then OBJ, then `frames.npz`; the archive is the only one
/// that is held in memory. What modeling tools say about faces comes from the run's `surface` folder, else
/// from the first OBJ frame.
///
/// # Errors
/// No frames, frames whose elements differ, no time step, formats that would overwrite what is read; files
/// that cannot be read or written.
pub fn export(
    source: &Path,
    options: &ExportOptions,
    progress: &mut dyn FnMut(usize, usize),
) -> Result<Exported, ExportError> {
    let path = || source.to_owned();
    let fault = |message: String| IoError::content(source, Place::File, message);
    let scene_path = source.join("scene.toml");
    let no_sets: [&str; 0] = [];
    let scene = if scene_path.exists() { Scene::load(&scene_path, &no_sets).ok() } else { None };
    let time_step = options
        .time_step
        .or(scene.as_ref().map(|scene| scene.simulation.dt))
        .ok_or_else(|| ExportError::NoTimeStep { path: path() })?;
    let stride = options.rate.stride(time_step).map_err(fault)?;
    let frames = open(source)?;
    let format = match frames.ending().as_str() {
        "ply" => Format::Ply,
        "obj" => Format::Obj,
        _ => Format::Npz,
    };
    if stride > 1 && same_folder(&options.out, source) {
        return Err(ExportError::Mixes { path: path() });
    }
    if options.formats.contains(&format) && same_folder(&options.out, source) {
        return Err(ExportError::Overwrites { path: path(), format });
    }

    let first = frames.read(0)?;
    let names = scene.as_ref().map_or_else(|| first.names.clone(), names);
    let width = scene.as_ref().and_then(|scene| scene.contact.delta);
    create_folder(&options.out)?;
    let spool = options.out.join(format!(".frames.{}.part", std::process::id()));
    let layout = Layout::of_mesh(&first, surface_of(source, &first)?, names);
    let fields = fields_of(source, layout.vertices(), frames.len());
    let own = |field: Field| options.out.join(format!(".{}.{}.part", field.name(), std::process::id()));
    let paths = fields.iter().map(|(field, _)| (*field, own(*field))).collect();
    let time_step = time_step * stride as f64;
    let writer = FrameWriter::new(&options.out, &options.formats, layout, spool, paths, time_step, width)?;
    let elements = Mesh { positions: Vec::new(), surface: None, ..first.clone() };
    let mut write = || {
        let taken = frames.len().div_ceil(stride);
        for place in 0..taken {
            let index = place * stride;
            let mut mesh = frames.read(index)?;
            // That of the first frame is written. Which corners share a normal may look different in each.
            mesh.surface = None;
            let positions: Vec<Point> = std::mem::take(&mut mesh.positions);
            if positions.len() != first.positions.len() || mesh != elements {
                let message = "its elements differ from those of the first frame: export it by itself";
                return Err(IoError::content(frames.path(index), Place::File, message));
            }
            let values = fields.iter().map(|(_, spool)| {
                let values =
                    spool.read(index).map_err(|error| IoError::system("read", spool.path(), error))?;
                Ok(values.iter().map(|value| value.coords).collect())
            });
            writer.write(place, &positions, &values.collect::<Result<Vec<_>, IoError>>()?)?;
            progress(place + 1, taken);
        }
        writer.finish(taken)?;
        Ok(taken)
    };
    let written = write();
    writer.remove_spools();
    Ok(Exported { frames: written?, vertices: first.positions.len() })
}

/// The fields that a run has kept for its frames, of so many vertices each.
fn fields_of(source: &Path, vertices: usize, frames: usize) -> Vec<(Field, Spool)> {
    let mut fields = Vec::new();
    for field in Field::ALL {
        let spool = Spool::new(source.join(field_file(field)), vertices);
        match spool.frames() {
            count if count == frames => fields.push((field, spool)),
            0 => {}
            count => tracing::warn!(
                "{}: it has {}, not {frames}, so it is not used",
                spool.path().display(),
                counted(count, "frame", "frames")
            ),
        }
    }
    fields
}

/// What is known about the faces of the frames of `source`, of which `first` is the first.
fn surface_of(source: &Path, first: &Mesh) -> Result<Option<Surface>, IoError> {
    let path = source.join(SURFACE);
    if path.is_file() {
        let surface = read_obj_surface(&path)?.filter(|s| s.triangles().eq(first.triangles.iter().copied()));
        if surface.is_some() {
            return Ok(surface);
        }
        tracing::warn!("{}: not of these frames, so it is not used", path.display());
    }
    Ok(first.surface.clone())
}

/// The frames of a folder, of `frames/` or `frames.npz` in it, or of an archive.
fn open(source: &Path) -> Result<FrameSource, IoError> {
    let no_frames = |path: &Path| IoError::content(path, Place::File, "it has no frames");
    let of_archive = |path: &Path| FrameSource::of_archive(path)?.ok_or_else(|| no_frames(path));
    let is_npz = |path: &Path| path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("npz"));
    if source.is_file() && is_npz(source) {
        return of_archive(source);
    }
    for folder in [source.join("frames"), source.to_owned()] {
        if let Some(frames) = FrameSource::of_folder(&folder)? {
            return Ok(frames);
        }
    }
    let archive = source.join("frames.npz");
    if archive.exists() {
        return of_archive(&archive);
    }
    // The system's reason, if it has one, says more.
    std::fs::metadata(source).map_err(|error| IoError::system("read", source, error))?;
    let message = "no frames (.ply, .obj) in it nor in frames/ below it, and no frames.npz";
    Err(IoError::content(source, Place::File, message))
}

/// Names by the numbers that bodies have in frames: deformable ones, obstacles with a mesh, half-spaces.
fn names(scene: &Scene) -> Vec<String> {
    let plane = |shape: &Option<Shape>| matches!(shape, Some(Shape::HalfSpace(_)));
    let of = |planes: bool| scene.obstacles.iter().filter(move |o| plane(&o.shape) == planes);
    let bodies = scene.bodies.iter().map(|b| b.name.clone());
    bodies.chain(of(false).chain(of(true)).map(|o| o.name.clone())).collect()
}

fn same_folder(a: &Path, b: &Path) -> bool {
    match (a.canonicalize(), b.canonicalize()) {
        (Ok(a), Ok(b)) => a == b,
        _ => a == b,
    }
}
