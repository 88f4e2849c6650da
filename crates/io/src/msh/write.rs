//! Meshes as Gmsh files.

use crate::atomic::write_atomic;
use crate::error::IoError;
use crate::mesh::MeshView;
use std::io::Write;
use std::path::Path;

/// Writes nodes, tetrahedra, triangles, quadrilaterals, lines and points as a Gmsh file, version 2.2, text;
/// atomically. Coordinates round-trip exactly, and nodes keep the order of the vertices. Bodies and obstacles
/// are not written.
///
/// # Errors
/// The system's refusal, with the path.
pub fn write_msh(path: &Path, mesh: &MeshView<'_>) -> Result<(), IoError> {
    write_atomic(path, |out| {
        writeln!(out, "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{}", mesh.positions.len())?;
        for (number, p) in (1_usize..).zip(mesh.positions) {
            writeln!(out, "{number} {:?} {:?} {:?}", p.x, p.y, p.z)?;
        }
        let mut elements: Vec<(u32, &[u32])> = Vec::new();
        elements.extend(mesh.tets.iter().map(|tet| (4, &tet[..])));
        elements.extend(mesh.triangles.iter().map(|triangle| (2, &triangle[..])));
        elements.extend(mesh.quads.iter().map(|quad| (3, &quad[..])));
        elements.extend(mesh.strands.iter().map(|line| (1, &line[..])));
        elements.extend(mesh.particles.iter().map(|point| (15, std::slice::from_ref(point))));
        writeln!(out, "$EndNodes\n$Elements\n{}", elements.len())?;
        for (number, (kind, vertices)) in (1_usize..).zip(elements) {
            // Two tags, which some programs demand: no physical group, and geometric entity 1.
            write!(out, "{number} {kind} 2 0 1")?;
            for v in vertices {
                write!(out, " {}", u64::from(*v) + 1)?;
            }
            writeln!(out)?;
        }
        writeln!(out, "$EndElements")
    })
}
