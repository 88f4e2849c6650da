//! Frames of a run, or of any folder, in other formats.

use super::frames::FrameWriter;
use super::layout::Layout;
use crate::io::{FrameStack, Import, IoError, Mesh, Place, create_folder, natural_order, read_mesh};
use crate::scene::{Format, Scene};
use crate::shapes::Shape;
use bowknot_geometry::Point;
use std::path::{Path, PathBuf};

/// What becomes of the frames.
#[derive(Clone, Debug, Default)]
pub struct ExportOptions {
    /// The formats; none that the frames have already, if they stay in their folder.
    pub formats: Vec<Format>,
    /// Output folder; frames of the same names are overwritten.
    pub out: PathBuf,
    /// Time from frame to frame [s]; none: that of the run's scene.
    pub time_step: Option<f64>,
}

/// What was exported.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Exported {
    /// Frames.
    pub frames: usize,
    /// Vertices of each.
    pub vertices: usize,
}

/// Writes the frames of `source` in other formats: of a run's folder, of a folder of PLY or OBJ files that differ in
/// positions only, or of an NPZ archive. `progress` hears the frames done and their number.
///
/// Frames are taken from PLY files if there are any, then OBJ, then `frames.npz`; the archive is the only one that is
/// held in memory.
///
/// # Errors
/// No frames, frames whose elements differ, no time step, formats that would overwrite what is read; files that cannot
/// be read or written.
pub fn export(
    source: &Path,
    options: &ExportOptions,
    progress: &mut dyn FnMut(usize, usize),
) -> Result<Exported, IoError> {
    let fault = |message: String| IoError::content(source, Place::File, message);
    let scene_path = source.join("scene.toml");
    let no_sets: [&str; 0] = [];
    let scene = if scene_path.exists() { Scene::load(&scene_path, &no_sets).ok() } else { None };
    let time_step =
        options.time_step.or(scene.as_ref().map(|scene| scene.simulation.dt)).ok_or_else(|| {
            fault("no scene.toml in it that says the time from frame to frame: give it with --dt".to_owned())
        })?;
    let frames = Frames::open(source)?;
    if let Some(format) = frames.format().filter(|format| options.formats.contains(format))
        && same_folder(&options.out, source)
    {
        let message = format!("its frames are {format:?} files already: name another folder with --out");
        return Err(fault(message));
    }

    let first = frames.read(0)?;
    let names = scene.as_ref().map(names).unwrap_or_default();
    let width = scene.as_ref().and_then(|scene| scene.twoway.constraints.delta);
    create_folder(&options.out)?;
    let spool = options.out.join(format!(".frames.{}.part", std::process::id()));
    let layout = Layout::of_mesh(&first, names);
    let writer = FrameWriter::new(&options.out, &options.formats, layout, spool, time_step, width)?;
    let elements = Mesh { positions: Vec::new(), ..first.clone() };
    let mut write = || {
        for index in 0..frames.len() {
            let mut mesh = frames.read(index)?;
            let positions: Vec<Point> = std::mem::take(&mut mesh.positions);
            if positions.len() != first.positions.len() || mesh != elements {
                let message = "its elements differ from those of the first frame: export it by itself";
                return Err(IoError::content(frames.path(index), Place::File, message));
            }
            writer.write(index, &positions)?;
            progress(index + 1, frames.len());
        }
        writer.finish(frames.len())
    };
    let written = write();
    writer.remove_spool();
    written?;
    Ok(Exported { frames: frames.len(), vertices: first.positions.len() })
}

/// Where the frames are.
enum Frames {
    Files(Vec<PathBuf>, Format),
    Archive(PathBuf, FrameStack),
}

impl Frames {
    fn open(source: &Path) -> Result<Self, IoError> {
        let is_npz = |path: &Path| path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("npz"));
        if source.is_file() && is_npz(source) {
            return Ok(Self::Archive(source.to_owned(), FrameStack::read(source)?)).and_then(Self::not_empty);
        }
        for folder in [source.join("frames"), source.to_owned()] {
            if !folder.is_dir() {
                continue;
            }
            for (ending, format) in [("ply", Format::Ply), ("obj", Format::Obj)] {
                let files = files(&folder, ending)?;
                if !files.is_empty() {
                    return Ok(Self::Files(files, format));
                }
            }
        }
        let archive = source.join("frames.npz");
        if archive.exists() {
            return FrameStack::read(&archive)
                .map(|stack| Self::Archive(archive, stack))
                .and_then(Self::not_empty);
        }
        // The system's reason, if it has one, says more.
        std::fs::metadata(source).map_err(|error| IoError::system("read", source, error))?;
        let message = "no frames (.ply, .obj) in it nor in frames/ below it, and no frames.npz";
        Err(IoError::content(source, Place::File, message))
    }

    fn not_empty(self) -> Result<Self, IoError> {
        if self.len() > 0 {
            Ok(self)
        } else {
            Err(IoError::content(self.path(0), Place::File, "it has no frames"))
        }
    }

    fn len(&self) -> usize {
        match self {
            Self::Files(files, _) => files.len(),
            Self::Archive(_, stack) => stack.len(),
        }
    }

    fn format(&self) -> Option<Format> {
        Some(match self {
            Self::Files(_, format) => *format,
            Self::Archive(..) => Format::Npz,
        })
    }

    fn path(&self, index: usize) -> &Path {
        match self {
            Self::Files(files, _) => &files[index],
            Self::Archive(path, _) => path,
        }
    }

    fn read(&self, index: usize) -> Result<Mesh, IoError> {
        match self {
            Self::Files(files, _) => read_mesh(&files[index], &Import::default()),
            Self::Archive(_, stack) => {
                let view = stack.mesh();
                Ok(Mesh {
                    positions: stack.frame(index).unwrap_or_default(),
                    triangles: view.triangles.to_vec(),
                    strands: view.strands.to_vec(),
                    particles: view.particles.to_vec(),
                    obstacle: Some(view.obstacle.to_vec()),
                    ..Mesh::default()
                })
            }
        }
    }
}

/// Files of a folder with this ending, in natural order.
fn files(folder: &Path, ending: &str) -> Result<Vec<PathBuf>, IoError> {
    let system = |error| IoError::system("read", folder, error);
    let mut files = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(system)? {
        let path = entry.map_err(system)?.path();
        if path.is_file() && path.extension().is_some_and(|e| e.eq_ignore_ascii_case(ending)) {
            files.push(path);
        }
    }
    let name = |path: &Path| path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    files.sort_by(|a, b| natural_order(&name(a), &name(b)));
    Ok(files)
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
