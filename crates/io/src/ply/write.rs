//! Frames and dumps as binary PLY.

use crate::atomic::write_atomic;
use crate::error::IoError;
use crate::mesh::MeshView;
use std::io::Write;
use std::path::Path;

/// Writes a binary little-endian PLY file, atomically.
///
/// `vertex`: x y z (double), `obstacle` (uchar, 0 or 1), `body` (int). `face`: list (uchar int)
/// `vertex_indices`, triangles first, then quads. `edge`, if there are strands: `vertex1`, `vertex2` (int).
/// Particles are the vertices that none of these names.
///
/// # Errors
/// The system's refusal, with the path.
pub fn write_ply(path: &Path, mesh: &MeshView<'_>) -> Result<(), IoError> {
    write_atomic(path, |out| {
        let faces = mesh.triangles.len() + mesh.quads.len();
        write!(
            out,
            "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty double x\nproperty double y\n\
             property double z\nproperty uchar obstacle\nproperty int body\nelement face {faces}\n\
             property list uchar int vertex_indices\n",
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
        }
        for triangle in mesh.triangles {
            write_face(out, triangle)?;
        }
        for quad in mesh.quads {
            write_face(out, quad)?;
        }
        for index in mesh.strands.iter().flatten() {
            out.write_all(&index.to_le_bytes())?;
        }
        Ok(())
    })
}

fn write_face<const N: usize>(out: &mut impl Write, corners: &[u32; N]) -> std::io::Result<()> {
    out.write_all(&[N as u8])?;
    corners.iter().try_for_each(|index| out.write_all(&index.to_le_bytes()))
}
