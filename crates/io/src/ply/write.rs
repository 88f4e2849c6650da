//! Frames and dumps as binary PLY.

use crate::atomic::write_atomic;
use crate::error::IoError;
use crate::mesh::MeshView;
use crate::surface::{Polygon, Surface};
use std::io::Write;
use std::path::Path;

/// Largest number of corners that a face can have.
const PIECE: usize = u8::MAX as usize;

/// Writes a binary little-endian PLY file, atomically.
///
/// `vertex`: x y z (double), `obstacle` (uchar, 0 or 1), `body` (int). `face`: list (uchar int)
/// `vertex_indices`, triangles first, then quads. `edge`, if there are strands: `vertex1`, `vertex2` (int).
/// Particles are the vertices that none of these names. Names of bodies are comments: `body`, number, name.
///
/// The surface of the mesh, if it has one, gives the faces: polygons, those of more than 255 corners in
/// pieces. If no vertex has two texture coordinates, vertices also have `s` and `t` (double). What else it
/// holds is left out.
///
/// # Errors
/// The system's refusal, with the path.
pub fn write_ply(path: &Path, mesh: &MeshView<'_>) -> Result<(), IoError> {
    write_atomic(path, |out| {
        let pieces = |polygon: Polygon<'_>| (polygon.corners.len() - 2).div_ceil(PIECE - 2);
        let faces = match mesh.surface {
            Some(surface) => surface.polygons().map(pieces).sum(),
            None => mesh.triangles.len() + mesh.quads.len(),
        };
        let texture =
            mesh.surface.and_then(|surface| surface.vertex_texture_coordinates(mesh.positions.len()));
        let names = mesh.names.iter().enumerate().map(|(body, name)| {
            let name = name.replace(char::is_control, " ");
            format!("comment body {body} {name}\n")
        });
        let texture_header = if texture.is_some() { "property double s\nproperty double t\n" } else { "" };
        write!(
            out,
            "ply\nformat binary_little_endian 1.0\n{}element vertex {}\nproperty double x\nproperty double \
             y\n\
             property double z\nproperty uchar obstacle\nproperty int body\n{texture_header}element face \
             {faces}\n\
             property list uchar int vertex_indices\n",
            names.collect::<String>(),
            mesh.positions.len()
        )?;
        if !mesh.strands.is_empty() {
            write!(out, "element edge {}\nproperty int vertex1\nproperty int vertex2\n", mesh.strands.len())?;
        }
        out.write_all(b"end_header\n")?;
        for (index, point) in mesh.positions.iter().enumerate() {
            for coordinate in point.iter() {
                out.write_all(&coordinate.to_le_bytes())?;
            }
            out.write_all(&[u8::from(mesh.obstacle.get(index).copied().unwrap_or(false))])?;
            out.write_all(&mesh.body.get(index).copied().unwrap_or(0).to_le_bytes())?;
            for coordinate in texture.iter().flat_map(|texture| texture[index]) {
                out.write_all(&coordinate.to_le_bytes())?;
            }
        }
        match mesh.surface {
            Some(surface) => write_polygons(out, surface)?,
            None => write_faces(out, mesh)?,
        }
        for index in mesh.strands.iter().flatten() {
            out.write_all(&index.to_le_bytes())?;
        }
        Ok(())
    })
}

fn write_faces(out: &mut impl Write, mesh: &MeshView<'_>) -> std::io::Result<()> {
    mesh.triangles.iter().try_for_each(|triangle| write_face(out, triangle))?;
    mesh.quads.iter().try_for_each(|quad| write_face(out, quad))
}

/// Each polygon as pieces around its first corner, so that its fan stays the same.
fn write_polygons(out: &mut impl Write, surface: &Surface) -> std::io::Result<()> {
    let mut piece = Vec::with_capacity(PIECE);
    for polygon in surface.polygons() {
        let [first, rest @ ..] = polygon.corners else { continue };
        let mut start = 0;
        while start + 1 < rest.len() {
            let end = rest.len().min(start + PIECE - 1);
            piece.clear();
            piece.push(first.vertex);
            piece.extend(rest[start..end].iter().map(|corner| corner.vertex));
            write_face(out, &piece)?;
            start = end - 1;
        }
    }
    Ok(())
}

fn write_face(out: &mut impl Write, corners: &[u32]) -> std::io::Result<()> {
    out.write_all(&[corners.len() as u8])?;
    corners.iter().try_for_each(|index| out.write_all(&index.to_le_bytes()))
}
