//! Animated obstacles from files.

use super::part::Part;
use super::{Placing, Sequence};
use crate::error::SceneError;
use crate::obstacle::ObstacleSpec;
use bowknot_errors::counted;
use bowknot_geometry::Point;
#[cfg(feature = "npz")]
use bowknot_io::FrameStack;
use bowknot_io::{self as io, IoError, MESH_ENDINGS, Mesh, Place, files_in};
use std::path::Path;

/// Frames over one topology, as files hold them.
struct Frames {
    mesh: Mesh,
    positions: Vec<Vec<Point>>,
}

/// Loads the sequence of an obstacle: the part that its first frame makes, and all frames, placed.
pub(super) fn load(
    folder: &Path,
    path: &Path,
    spec: &ObstacleSpec,
    placing: &Placing,
    warnings: &mut Vec<String>,
) -> Result<(Part, Sequence), SceneError> {
    let path = folder.join(path);
    let is_mesh = path.extension().is_some_and(|ending| MESH_ENDINGS.iter().any(|known| ending == *known));
    if is_mesh {
        let message =
            "a sequence is a folder of meshes or an archive of frames (.npz), not one mesh; use `mesh`";
        return Err(IoError::content(&path, Place::File, message).into());
    }
    let frames = if path.is_dir() { of_folder(&path, placing)? } else { of_archive(&path, placing)? };
    let owner = format!("obstacle {}", spec.name);
    let mut part = Part::from_mesh(frames.mesh).into_obstacle(&owner, warnings)?;
    let kept = |frame: &Vec<Point>| {
        let mut kept: Vec<Point> = part.numbers.iter().map(|&v| frame[v as usize]).collect();
        placing.place(&mut kept);
        kept
    };
    let positions: Vec<Vec<Point>> = frames.positions.iter().map(kept).collect();
    part.positions.clone_from(&positions[0]);
    let sequence =
        Sequence { frames: positions.into(), rate: spec.sequence_rate, start: spec.sequence_start };
    Ok((part, sequence))
}

/// The meshes of a folder in natural order of their names.
fn of_folder(folder: &Path, placing: &Placing) -> Result<Frames, IoError> {
    let files = files_in(folder, &MESH_ENDINGS)?;
    let Some(first) = files.first() else {
        return Err(IoError::content(folder, Place::File, "no meshes in it, so no sequence"));
    };
    let mut frames: Option<Frames> = None;
    for file in &files {
        let mut mesh = io::read_mesh(file, &placing.import)?;
        let positions = std::mem::take(&mut mesh.positions);
        let Some(frames) = &mut frames else {
            let first = Mesh { positions: positions.clone(), ..mesh };
            frames = Some(Frames { mesh: first, positions: vec![positions] });
            continue;
        };
        if let Some(difference) = difference(&frames.mesh, &mesh, positions.len()) {
            let message = format!("{difference} than {}; a sequence keeps its topology", first.display());
            return Err(IoError::content(file, Place::File, message));
        }
        frames.positions.push(positions);
    }
    // There is a first file, so there is a first frame.
    frames.ok_or_else(|| IoError::content(folder, Place::File, "no meshes in it, so no sequence"))
}

/// How a frame differs from the first one in what must not change.
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
    let message = "archives cannot be read: this program was built without the feature `npz` of bowknot-scene; \
                   give a folder of meshes";
    Err(IoError::content(path, Place::File, message))
}

/// The frames of an NPZ archive.
#[cfg(feature = "npz")]
fn of_archive(path: &Path, placing: &Placing) -> Result<Frames, IoError> {
    let stack = FrameStack::read(path)?;
    let import = |frame: Vec<Point>| frame.iter().map(|p| placing.import.point(p.coords.into())).collect();
    let positions: Vec<Vec<Point>> = (0..stack.len()).filter_map(|f| stack.frame(f)).map(import).collect();
    let Some(first) = positions.first() else {
        return Err(IoError::content(path, Place::Array("X".to_owned()), "holds no frame"));
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
