//! Grids as unstructured `.vtu` files, one a frame, and a collection `.pvd` with their times. Arrays are appended
//! raw, little-endian, neither encoded nor compressed.

use crate::atomic::write_atomic;
use crate::error::IoError;
use crate::field::FieldValues;
use crate::mesh::MeshView;
use std::io::Write;
use std::path::Path;

/// VTK's numbers for the cells that we write.
const VERTEX: u8 = 1;
const LINE: u8 = 3;
const TRIANGLE: u8 = 5;
const QUAD: u8 = 9;

/// Writes a grid of triangles, quads, strand edges and particles, in this order, over all vertices, with the
/// point arrays `body` (i32) and `obstacle` (0 or 1); atomically. Coordinates are doubles [m].
///
/// # Errors
/// The system's refusal, with the path.
pub fn write_vtu(path: &Path, mesh: &MeshView<'_>) -> Result<(), IoError> {
    write_vtu_with_fields(path, mesh, &[])
}

/// As [`write_vtu`], with a point array of doubles for each field, of as many values as there are vertices:
/// `velocity` [m/s], `contact_force` [N].
///
/// # Errors
/// As [`write_vtu`].
pub fn write_vtu_with_fields(
    path: &Path,
    mesh: &MeshView<'_>,
    fields: &[FieldValues<'_>],
) -> Result<(), IoError> {
    let points = mesh.positions.len();
    let counts =
        [(TRIANGLE, 3, mesh.triangles.len()), (QUAD, 4, mesh.quads.len()), (LINE, 2, mesh.strands.len())];
    let counts = counts.into_iter().chain([(VERTEX, 1, mesh.particles.len())]);
    let counts: Vec<(u8, usize, usize)> = counts.collect();
    let cells: usize = counts.iter().map(|(_, _, count)| count).sum();
    let corners: usize = counts.iter().map(|(_, size, count)| size * count).sum();

    let mut arrays = vec![
        ("<Points>", "Float64", "Points", 3, 24 * points, "</Points>\n<Cells>"),
        ("", "Int32", "connectivity", 1, 4 * corners, ""),
        ("", "Int64", "offsets", 1, 8 * cells, ""),
        ("", "UInt8", "types", 1, cells, "</Cells>\n<PointData>"),
        ("", "Int32", "body", 1, 4 * points, ""),
        ("", "UInt8", "obstacle", 1, points, ""),
    ];
    arrays.extend(fields.iter().map(|f| ("", "Float64", f.field.name(), 3, 24 * points, "")));
    if let Some(last) = arrays.last_mut() {
        last.5 = "</PointData>";
    }
    write_atomic(path, |out| {
        write!(
            out,
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" \
             byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<UnstructuredGrid>\n<Piece \
             NumberOfPoints=\"{points}\" NumberOfCells=\"{cells}\">\n"
        )?;
        let mut offset = 0;
        for (before, kind, name, components, bytes, after) in arrays {
            writeln!(
                out,
                "{before}<DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{components}\" \
                 format=\"appended\" offset=\"{offset}\"/>{after}"
            )?;
            offset += 8 + bytes;
        }
        out.write_all(b"</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_")?;
        let length = |bytes: usize| (bytes as u64).to_le_bytes();

        out.write_all(&length(24 * points))?;
        for coordinate in mesh.positions.iter().flat_map(|p| [p.x, p.y, p.z]) {
            out.write_all(&coordinate.to_le_bytes())?;
        }
        out.write_all(&length(4 * corners))?;
        let flat = mesh.triangles.as_flattened().iter().chain(mesh.quads.as_flattened());
        for index in flat.chain(mesh.strands.as_flattened()).chain(mesh.particles) {
            out.write_all(&index.to_le_bytes())?;
        }
        out.write_all(&length(8 * cells))?;
        let mut end = 0_u64;
        for size in counts.iter().flat_map(|(_, size, count)| std::iter::repeat_n(*size, *count)) {
            end += size as u64;
            out.write_all(&end.to_le_bytes())?;
        }
        out.write_all(&length(cells))?;
        for kind in counts.iter().flat_map(|(kind, _, count)| std::iter::repeat_n(*kind, *count)) {
            out.write_all(&[kind])?;
        }
        out.write_all(&length(4 * points))?;
        for index in 0..points {
            out.write_all(&mesh.body.get(index).copied().unwrap_or(0).to_le_bytes())?;
        }
        out.write_all(&length(points))?;
        for index in 0..points {
            out.write_all(&[u8::from(mesh.obstacle.get(index).copied().unwrap_or(false))])?;
        }
        for field in fields {
            out.write_all(&length(24 * points))?;
            for index in 0..points {
                let value = field.values.get(index).copied().unwrap_or_default();
                value.iter().try_for_each(|component| out.write_all(&component.to_le_bytes()))?;
            }
        }
        out.write_all(b"\n</AppendedData>\n</VTKFile>\n")
    })
}

/// Writes a collection of grids: each with its time [s] and its path relative to the collection; atomically.
///
/// # Errors
/// The system's refusal, with the path.
pub fn write_pvd(path: &Path, grids: impl Iterator<Item = (f64, String)>) -> Result<(), IoError> {
    write_atomic(path, |out| {
        out.write_all(
            b"<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" \
              byte_order=\"LittleEndian\">\n<Collection>\n",
        )?;
        for (time, file) in grids {
            writeln!(out, "<DataSet timestep=\"{time:?}\" part=\"0\" file=\"{file}\"/>")?;
        }
        out.write_all(b"</Collection>\n</VTKFile>\n")
    })
}
