//! A stack of frames written as it is read, one frame in memory.

use super::frames::element_table;
use crate::atomic::write_atomic;
use crate::error::IoError;
use crate::field::Field;
use crate::mesh::MeshView;
use ndarray::Array1;
use ndarray_npy::{WriteNpyError, WriteNpyExt};
use std::io::Write;
use std::path::Path;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipWriter};

/// Writes an archive as [`super::FrameStack::write`] does, of as many `frames`; `read(frame, bytes)` appends
/// the coordinates of a frame as little-endian doubles, 24 bytes per vertex. The number of vertices is that
/// of `mesh.obstacle`. Atomic.
///
/// # Errors
/// The system's refusal, with the path; what `read` reports.
pub fn write_frame_stack(
    path: &Path,
    mesh: &MeshView<'_>,
    frames: usize,
    mut read: impl FnMut(usize, &mut Vec<u8>) -> std::io::Result<()>,
) -> Result<(), IoError> {
    write_frame_stack_with_fields(path, mesh, frames, &[], |_, frame, bytes| read(frame, bytes))
}

/// As [`write_frame_stack`], with an array `[f,n,3]` for each field: `V` [m/s], `C` [N]. `read` appends the
/// vectors of a field in a frame, or the coordinates if it gets none.
///
/// # Errors
/// As [`write_frame_stack`].
pub fn write_frame_stack_with_fields(
    path: &Path,
    mesh: &MeshView<'_>,
    frames: usize,
    fields: &[Field],
    mut read: impl FnMut(Option<Field>, usize, &mut Vec<u8>) -> std::io::Result<()>,
) -> Result<(), IoError> {
    let vertices = mesh.obstacle.len();
    let quads = mesh.quads.iter().flat_map(|&[i, j, k, l]| [[i, j, k], [i, k, l]]);
    let triangles: Vec<[u32; 3]> = mesh.triangles.iter().copied().chain(quads).collect();
    let no_tets: [[u32; 4]; 0] = [];
    write_atomic(path, |out| {
        let mut zip = ZipWriter::new(out);
        let options = SimpleFileOptions::default().compression_method(CompressionMethod::Stored);
        // 64-bit sizes where they are needed only: some readers know no others.
        let size = 24 * vertices as u64 * frames as u64;
        for field in std::iter::once(None).chain(fields.iter().copied().map(Some)) {
            let name = field.map_or("X", Field::array);
            let large = size > u64::from(u32::MAX) - 1024;
            zip.start_file(format!("{name}.npy"), options.large_file(large))?;
            zip.write_all(&npy_header(&format!("({frames}, {vertices}, 3)")))?;
            let mut bytes = Vec::new();
            for frame in 0..frames {
                bytes.clear();
                read(field, frame, &mut bytes)?;
                zip.write_all(&bytes)?;
            }
        }
        let mut array = |name: &str, write: &dyn Fn(&mut ZipWriter<_>) -> Result<(), WriteNpyError>| {
            zip.start_file(format!("{name}.npy"), options)?;
            write(&mut zip).map_err(|error| match error {
                WriteNpyError::Io(source) => source,
                other => std::io::Error::other(other.to_string()),
            })
        };
        array("F", &|zip| element_table(&triangles).write_npy(zip))?;
        array("E", &|zip| element_table(mesh.strands).write_npy(zip))?;
        array("T", &|zip| element_table(&no_tets).write_npy(zip))?;
        array("P", &|zip| Array1::from_iter(mesh.particles.iter().map(|&p| p as i32)).write_npy(zip))?;
        array("O", &|zip| Array1::from_iter(mesh.obstacle.iter().copied()).write_npy(zip))?;
        zip.finish()?;
        Ok(())
    })
}

/// What stands before the numbers of an array of doubles in row-major order: NumPy's format, version 1.0.
fn npy_header(shape: &str) -> Vec<u8> {
    let text = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': {shape}, }}");
    // Magic, version, length, text, blanks and a line end make a multiple of 64 bytes.
    let padded = (10 + text.len() + 1).next_multiple_of(64) - 10;
    let mut header = b"\x93NUMPY\x01\x00".to_vec();
    header.extend((padded as u16).to_le_bytes());
    header.extend(format!("{text:<width$}\n", width = padded - 1).bytes());
    header
}
