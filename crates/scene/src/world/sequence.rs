//! Animated obstacles from files.

use super::part::Part;
use super::{Placing, Presence, Sequence};
use crate::error::SceneError;
use crate::obstacle::ObstacleSpec;
use bowknot_errors::counted;
use bowknot_geometry::Point;
#[cfg(feature = "npz")]
use bowknot_io::FrameStack;
use bowknot_io::{self as io, FrameOptions, FrameSource, IoError, MESH_ENDINGS, Mesh, Place, files_in};
use std::path::{Path, PathBuf};

/// Endings of files with the motion of meshes.
const ANIMATIONS: [&str; 6] = ["usda", "usd", "gltf", "glb", "pc2", "pvd"];

const ALL_EMPTY: &str = "all of its frames are empty, so there is nothing to show: a frame must have \
                         vertices at different places";

/// Frames over one topology, as files hold them.
struct Frames {
    /// That of the first frame that is not empty.
    mesh: Mesh,
    /// None where a frame is empty; one is not.
    positions: Vec<Option<Vec<Point>>>,
}

/// Loads the sequence of an obstacle: the part that its first frame makes, all frames, placed, and when it is
/// there.
pub(super) fn load(
    folder: &Path,
    path: &Path,
    spec: &ObstacleSpec,
    placing: &Placing,
    warnings: &mut Vec<String>,
) -> Result<(Part, Sequence, Presence), SceneError> {
    let path = folder.join(path);
    let is = |endings: &[&str]| path.extension().is_some_and(|e| endings.iter().any(|known| e == *known));
    let part = spec.part.as_deref();
    let frames = if path.is_dir() {
        of_folder(&path, placing, part)?
    } else if is(&ANIMATIONS) {
        of_animation(&path, placing, spec)?
    } else if is(&MESH_ENDINGS) {
        let message = "a sequence is a folder of meshes, an animation (USD, glTF, PC2, PVD) or an archive of frames \
                       (.npz), not one mesh; use `mesh`";
        return Err(IoError::content(&path, Place::File, message).into());
    } else if part.is_some() {
        let message = "an archive has no parts; leave out the key part";
        return Err(IoError::content(&path, Place::File, message).into());
    } else {
        of_archive(&path, placing)?
    };
    let owner = format!("obstacle {}", spec.name);
    let mut part = Part::from_mesh(frames.mesh).into_obstacle(&owner, warnings)?;
    let (rate, start) = (spec.sequence_rate, spec.sequence_start);
    let time = |frame: usize| start + frame as f64 / rate;
    let shown: Vec<bool> = frames.positions.iter().map(Option::is_some).collect();
    let first = shown.iter().take_while(|shown| !**shown).count();
    let mut positions: Vec<Vec<Point>> = Vec::new();
    for frame in &frames.positions[first..] {
        let mut placed: Option<Vec<Point>> =
            frame.as_ref().map(|frame| part.numbers.iter().map(|&v| frame[v as usize]).collect());
        placed.iter_mut().for_each(|frame| placing.place(frame));
        // Where it is meanwhile shows nowhere.
        positions.extend(placed.or_else(|| positions.last().cloned()));
    }
    part.positions.clone_from(&positions[0]);
    let presence = Presence::of_frames(&shown, time);
    Ok((part, Sequence { frames: positions.into(), rate, start: time(first) }, presence))
}

/// The frames of an animation, as many per second as the sequence has, if the file knows its times.
fn of_animation(path: &Path, placing: &Placing, spec: &ObstacleSpec) -> Result<Frames, IoError> {
    let (import, rate) = (placing.import, Some(spec.sequence_rate));
    let mut source = FrameSource::open_with(path, &FrameOptions { import, rate, ..FrameOptions::default() })?;
    if let Some(part) = &spec.part {
        source = source.part(part)?;
    }
    let mut known: Option<Mesh> = None;
    let mut frames = Vec::with_capacity(source.len());
    for index in 0..source.len() {
        let mut mesh = source.read(index)?;
        let positions = std::mem::take(&mut mesh.positions);
        if let Some(difference) = known.as_ref().and_then(|known| difference(known, &mesh, positions.len())) {
            let message = format!("{difference} than in the first frame; a sequence keeps its topology");
            return Err(IoError::content(source.path(index), Place::File, message));
        }
        if known.is_none() && !is_empty(&positions) {
            known = Some(Mesh { positions: positions.clone(), ..mesh });
        }
        frames.push(Some(positions).filter(|positions| !is_empty(positions)));
    }
    let mesh = known.ok_or_else(|| IoError::content(path, Place::File, ALL_EMPTY))?;
    Ok(Frames { mesh, positions: frames })
}

/// The meshes of a folder in natural order of their names.
fn of_folder(folder: &Path, placing: &Placing, part: Option<&str>) -> Result<Frames, IoError> {
    let mut files = files_in(folder, &MESH_ENDINGS)?;
    // A frame that is there in several formats, or in the two files of TetGen, is one frame.
    files.dedup_by(|later, earlier| later.file_stem() == earlier.file_stem());
    if files.is_empty() {
        return Err(IoError::content(folder, Place::File, "no meshes in it, so no sequence"));
    }
    let mut known: Option<(&PathBuf, Mesh)> = None;
    let mut frames = Vec::with_capacity(files.len());
    for file in &files {
        let read = match part {
            Some(part) => io::read_mesh_part(file, &placing.import, part),
            None => io::read_mesh(file, &placing.import),
        };
        let mut mesh = match read {
            Err(IoError::Empty { .. }) => {
                frames.push(None);
                continue;
            }
            mesh => mesh?,
        };
        let positions = std::mem::take(&mut mesh.positions);
        match &known {
            Some((first, known)) => {
                if let Some(difference) = difference(known, &mesh, positions.len()) {
                    let message =
                        format!("{difference} than {}; a sequence keeps its topology", first.display());
                    return Err(IoError::content(file, Place::File, message));
                }
            }
            None if is_empty(&positions) => {}
            None => known = Some((file, Mesh { positions: positions.clone(), ..mesh })),
        }
        frames.push(Some(positions).filter(|positions| !is_empty(positions)));
    }
    let (_, mesh) = known.ok_or_else(|| IoError::content(folder, Place::File, ALL_EMPTY))?;
    Ok(Frames { mesh, positions: frames })
}

/// Whether a frame shows nothing: all of its vertices are at one place, as frames of a run have it, and
/// exports of what was scaled to nothing.
fn is_empty(positions: &[Point]) -> bool {
    positions.len() > 1 && positions.iter().all(|p| *p == positions[0])
}

/// How a frame, whose positions are left out, differs from the first one in what must not change.
fn difference(first: &Mesh, other: &Mesh, vertices: usize) -> Option<String> {
    if vertices != first.positions.len() {
        return Some(format!(
            "has {}, not {}, so another topology",
            counted(vertices, "vertex", "vertices"),
            first.positions.len()
        ));
    }
    let elements = |one: &str, many: &str, a: usize, b: usize| {
        if a == b {
            format!("joins its vertices to other {many}")
        } else {
            format!("has {}, not {a}, so another topology", counted(b, one, many))
        }
    };
    if first.triangles != other.triangles {
        return Some(elements("triangle", "triangles", first.triangles.len(), other.triangles.len()));
    }
    if first.tets != other.tets {
        return Some(elements("tetrahedron", "tetrahedra", first.tets.len(), other.tets.len()));
    }
    (first.strands != other.strands)
        .then(|| elements("edge", "edges", first.strands.len(), other.strands.len()))
}

/// Without support for archives every one is refused.
#[cfg(not(feature = "npz"))]
fn of_archive(path: &Path, _: &Placing) -> Result<Frames, IoError> {
    let message = "archives cannot be read: this program was built without the feature `npz` of \
                   bowknot-scene; give a folder of meshes";
    Err(IoError::content(path, Place::File, message))
}

/// The frames of an NPZ archive.
#[cfg(feature = "npz")]
fn of_archive(path: &Path, placing: &Placing) -> Result<Frames, IoError> {
    let stack = FrameStack::read(path)?;
    let import = |frame: Vec<Point>| -> Vec<Point> {
        frame.iter().map(|p| placing.import.point(p.coords.into())).collect()
    };
    let shown = |frame: Vec<Point>| (!is_empty(&frame)).then(|| import(frame));
    let positions: Vec<Option<Vec<Point>>> =
        (0..stack.len()).filter_map(|f| stack.frame(f)).map(shown).collect();
    let Some(first) = positions.iter().flatten().next() else {
        let message = if positions.is_empty() { "holds no frame" } else { ALL_EMPTY };
        return Err(IoError::content(path, Place::Array("X".to_owned()), message));
    };
    let view = stack.mesh();
    let mesh = Mesh {
        positions: first.clone(),
        triangles: view.triangles.to_vec(),
        strands: view.strands.to_vec(),
        ..Mesh::default()
    };
    Ok(Frames { mesh, positions })
}
