//! Frames and meshes as OBJ.

use super::library;
use crate::atomic::write_atomic;
use crate::error::IoError;
use crate::mesh::MeshView;
use crate::surface::{Labels, Surface};
use bowknot_geometry::Point;
use std::io::{Result, Write};
use std::path::Path;

/// Begins the comment that names the first vertex, from 0, of those that all belong to obstacles.
pub(super) const OBSTACLE_FROM: &str = "# obstacle-from ";

/// The comment in front of a name that stands for none.
pub(super) const NAMELESS: &str = "# nameless";

/// Writes positions, faces, strands and particles as an OBJ file, atomically; coordinates round-trip exactly.
/// If the last vertices, and only they, belong to obstacles, a comment says so for [`super::read_obj`];
/// bodies are not written.
///
/// The surface of the mesh, if it has one, is written with all that it holds; its normals are those of these
/// positions. Material libraries are named relative to the file.
///
/// # Errors
/// The system's refusal, with the path.
pub fn write_obj(path: &Path, mesh: &MeshView<'_>) -> std::result::Result<(), IoError> {
    let deformable = mesh.obstacle.iter().take_while(|flag| !**flag).count();
    let suffix = deformable < mesh.obstacle.len() && mesh.obstacle[deformable..].iter().all(|&flag| flag);
    write_atomic(path, |out| {
        if suffix {
            writeln!(out, "{OBSTACLE_FROM}{deformable}")?;
        }
        let folder = path.parent().unwrap_or(Path::new(""));
        for file in mesh.surface.map_or(&[][..], Surface::material_libraries) {
            writeln!(out, "mtllib {}", library::relative(file, folder))?;
        }
        for p in mesh.positions {
            writeln!(out, "v {:?} {:?} {:?}", p.x, p.y, p.z)?;
        }
        match mesh.surface {
            Some(surface) => write_surface(out, surface, mesh.positions)?,
            None => write_faces(out, mesh)?,
        }
        for [i, j] in mesh.strands {
            writeln!(out, "l {} {}", i + 1, j + 1)?;
        }
        for i in mesh.particles {
            writeln!(out, "p {}", i + 1)?;
        }
        Ok(())
    })
}

fn write_faces(out: &mut impl Write, mesh: &MeshView<'_>) -> Result<()> {
    for [i, j, k] in mesh.triangles {
        writeln!(out, "f {} {} {}", i + 1, j + 1, k + 1)?;
    }
    for [i, j, k, l] in mesh.quads {
        writeln!(out, "f {} {} {} {}", i + 1, j + 1, k + 1, l + 1)?;
    }
    Ok(())
}

fn write_surface(out: &mut impl Write, surface: &Surface, positions: &[Point]) -> Result<()> {
    for [u, v] in surface.texture_coordinates() {
        writeln!(out, "vt {u:?} {v:?}")?;
    }
    // Single precision is more than a normal needs.
    for normal in surface.normals(positions) {
        writeln!(out, "vn {:?} {:?} {:?}", normal.x as f32, normal.y as f32, normal.z as f32)?;
    }
    let nameless = Labels::default();
    let mut labels = &nameless;
    for polygon in surface.polygons() {
        write_changes(out, labels, polygon.labels)?;
        labels = polygon.labels;
        out.write_all(b"f")?;
        for corner in polygon.corners {
            write!(out, " {}", corner.vertex + 1)?;
            match (corner.texture(), corner.normal()) {
                (Some(texture), Some(normal)) => write!(out, "/{}/{}", texture + 1, normal + 1)?,
                (Some(texture), None) => write!(out, "/{}", texture + 1)?,
                (None, Some(normal)) => write!(out, "//{}", normal + 1)?,
                (None, None) => {}
            }
        }
        out.write_all(b"\n")?;
    }
    Ok(())
}

/// States what is called otherwise than before. A name cannot be taken back: what has none is called
/// `default`, with a comment, and smoothing is off.
fn write_changes(out: &mut impl Write, before: &Labels, now: &Labels) -> Result<()> {
    let names = [
        ("o", &before.object, &now.object, "default"),
        ("g", &before.group, &now.group, "default"),
        ("usemtl", &before.material, &now.material, "default"),
        ("s", &before.smoothing, &now.smoothing, "off"),
    ];
    for (keyword, _, now, otherwise) in names.into_iter().filter(|(_, before, now, _)| before != now) {
        match now {
            Some(name) => writeln!(out, "{keyword} {}", on_one_line(name))?,
            None => writeln!(out, "{NAMELESS}\n{keyword} {otherwise}")?,
        }
    }
    Ok(())
}

/// A name without what would end the line, or continue it.
fn on_one_line(name: &str) -> String {
    name.trim_end_matches('\\').replace(char::is_control, " ")
}
