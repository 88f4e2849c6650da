//! No file makes a reader panic, and a mesh that was read can be written and read again.

use super::Draw;
use bowknot::check::{Judge, Parts, StateOptions};
use bowknot::io::{
    FrameSource, FrameStack, Import, IoError, Mesh, read_mesh as read, read_mesh_part, read_obj, read_ply,
    write_obj, write_ply,
};
use bowknot::recording::States;
use bowknot_geometry::{Topology, check_mesh};
use ndarray::ArrayD;
use ndarray_npy::{NpzWriter, WriteNpzError};
use std::fs::{self, File};
use std::path::Path;

/// Arrays of a collision problem and of a stack of frames, with their columns.
const ARRAYS: [(&str, usize); 14] = [
    ("x", 3),
    ("y", 3),
    ("F", 3),
    ("E", 2),
    ("P", 1),
    ("rest", 3),
    ("mass", 1),
    ("fixed", 1),
    ("O", 1),
    ("body", 1),
    ("planes", 4),
    ("dt", 0),
    ("X", 3),
    ("T", 4),
];

/// Reads the bytes as a file whose format the first byte chooses, or as the arrays of an NPZ file. Readers
/// return a valid mesh or an error with a message, and do not panic.
pub fn read_mesh(data: &[u8]) -> bool {
    let Some((&choice, bytes)) = data.split_first() else { return false };
    let Ok(folder) = tempfile::tempdir() else { return false };
    let file = |ending: &str| folder.path().join(format!("mesh.{ending}"));
    let write = |path: &Path| fs::write(path, bytes).is_ok();
    match choice % 14 {
        0 => write(&file("obj")) && mesh(&file("obj"), |path, mesh| write_obj(path, &mesh.view()), read_obj),
        1 => write(&file("ply")) && mesh(&file("ply"), |path, mesh| write_ply(path, &mesh.view()), read_ply),
        2 => write(&file("npz")) && check_archive(&file("npz")),
        4 => write(&file("msh")) && solid(&file("msh")),
        5 => write(&file("t")) && solid(&file("t")),
        7 => write(&file("stl")) && mesh(&file("stl"), |path, mesh| write_obj(path, &mesh.view()), read_obj),
        8 => write(&file("mesh")) && solid(&file("mesh")),
        9 => write(&file("vtu")) && solid(&file("vtu")),
        // Points and elements of TetGen, which are two files, one behind the other.
        10 => write_pair(bytes, [&file("node"), &file("ele")]) && solid(&file("ele")),
        11 => write(&file("usda")) && animation(&file("usda")),
        12 => write(&file("gltf")) && animation(&file("gltf")),
        13 => write(&file("glb")) && animation(&file("glb")),
        6 => write(&file("seg")) && mesh(&file("seg"), |path, mesh| write_obj(path, &mesh.view()), read_obj),
        _ => write_arrays(&file("npz"), &mut Draw::new(bytes)).is_ok() && check_archive(&file("npz")),
    }
}

/// Writes what stands before and after a line `--`.
fn write_pair(bytes: &[u8], paths: [&Path; 2]) -> bool {
    let split = bytes.windows(4).position(|window| window == b"\n--\n").unwrap_or(bytes.len());
    let parts = [&bytes[..split], bytes.get(split + 4..).unwrap_or(&[])];
    paths.iter().zip(parts).all(|(path, part)| fs::write(path, part).is_ok())
}

fn check_error(error: &IoError) -> bool {
    assert!(error.to_string().contains("mesh."), "an error names its file: {error}");
    false
}

fn mesh(
    path: &Path,
    write: impl Fn(&Path, &Mesh) -> Result<(), IoError>,
    read_again: impl Fn(&Path, &Import) -> Result<Mesh, IoError>,
) -> bool {
    let import = Import::default();
    let mut mesh = match read(path, &import) {
        Ok(mesh) => mesh,
        Err(error) => return check_error(&error),
    };
    check_sound(&mesh);
    part(path, &mesh);
    let again = write(path, &mesh).and_then(|()| read_again(path, &import));
    let again = again.unwrap_or_else(|error| panic!("what was written is refused: {error}"));
    assert_eq!(again.positions, mesh.positions);
    assert_eq!(again.triangles, mesh.triangles);
    assert_eq!(again.strands, mesh.strands);
    assert_eq!(again.particles, mesh.particles);
    mesh.drop_unused_vertices();
    check_sound(&mesh);
    let triangles = mesh.triangles.len();
    mesh.triangulate();
    check_sound(&mesh);
    assert_eq!(mesh.triangles.len(), triangles, "polygons have as many triangles as their fans");
    true
}

/// Reads a file of a format that is not written again, and checks the mesh and the surface of its tetrahedra.
fn solid(path: &Path) -> bool {
    match read(path, &Import::default()) {
        Ok(mut mesh) => {
            check_sound(&mesh);
            part(path, &mesh);
            check_sound(&mesh.clone().into_surface());
            mesh.drop_unused_vertices();
            check_sound(&mesh);
            true
        }
        Err(error) => check_error(&error),
    }
}

/// Reads the first frames of a file that tells how meshes move.
fn animation(path: &Path) -> bool {
    let frames = || -> Result<(), IoError> {
        let source = FrameSource::open(path)?;
        for index in 0..source.len().min(3) {
            let mesh = source.read(index)?;
            check_sound(&mesh);
            part(path, &mesh);
        }
        Ok(())
    };
    frames().map_or_else(|error| check_error(&error), |()| true)
}

/// Reads the part of a file that its `mesh` names last, or one that hardly is there.
fn part(path: &Path, mesh: &Mesh) {
    let name = mesh.names.last().map_or("part", String::as_str);
    match read_mesh_part(path, &Import::default(), name) {
        Ok(part) => check_sound(&part),
        Err(error) => {
            check_error(&error);
        }
    }
}

/// Checks that indices are in range and numbers finite, and that neither the topology nor the judge panics.
fn check_sound(mesh: &Mesh) {
    let Mesh { positions, triangles, tets, strands, particles, obstacle, body, surface, groups, names: _ } =
        mesh;
    let count = positions.len();
    let named = triangles.iter().flatten().chain(strands.iter().flatten()).chain(particles);
    let named = named.chain(tets.iter().flatten());
    assert!(named.into_iter().all(|&v| (v as usize) < count), "an index is out of range");
    assert!(positions.iter().all(|p| p.iter().all(|c| c.is_finite())), "a coordinate is not finite");
    assert!(obstacle.as_ref().is_none_or(|flags| flags.len() == count), "obstacle flags of some vertices");
    assert!(body.as_ref().is_none_or(|bodies| bodies.len() == count), "bodies of some vertices");

    for (name, vertices) in groups.iter() {
        let is_sound = vertices.is_sorted_by(|a, b| a < b) && vertices.iter().all(|&v| (v as usize) < count);
        assert!(is_sound, "group {name} is out of order or of range");
    }

    if let Some(surface) = surface {
        assert!(
            surface.triangles().eq(triangles.iter().copied()),
            "other triangles than those of the polygons"
        );
        let (textures, normals) = (surface.texture_coordinates().len() as u32, surface.normal_count() as u32);
        for corner in surface.corners() {
            assert!(corner.texture().is_none_or(|texture| texture < textures), "an index is out of range");
            assert!(corner.normal().is_none_or(|normal| normal < normals), "an index is out of range");
        }
        assert_eq!(surface.corner_normals(positions).len(), surface.corners().len());
    }

    check_mesh(positions, triangles);
    let is_simple = Topology::builder(count)
        .triangles(triangles.iter().copied())
        .strand_edges(strands.iter().copied())
        .particles(particles.iter().copied())
        .build()
        .is_ok();
    let parts = Parts { triangles, strands, particles, vertex_count: count, ..Parts::default() };
    match Judge::new(&parts) {
        Ok(judge) => {
            // The judge refuses coordinates beyond its range with an error.
            drop(judge.check_state(positions, &StateOptions::default()));
        }
        Err(error) => assert!(!is_simple, "the judge refuses what the topology takes: {error}"),
    }
}

/// Reads a file as a collision problem and as a stack of frames.
pub(super) fn check_archive(path: &Path) -> bool {
    let frames = match FrameStack::read(path) {
        Ok(frames) => {
            let again = frames.write(path).and_then(|()| FrameStack::read(path));
            assert_eq!(again.unwrap_or_else(|e| panic!("what was written is refused: {e}")), frames);
            true
        }
        Err(error) => check_error(&error),
    };
    // Writing the frames has replaced the file, so it contains nothing else.
    if frames {
        return true;
    }
    match States::read(path) {
        Ok(states) => {
            check_states(&states);
            let again = states.write(path).and_then(|()| States::read(path));
            let again = again.unwrap_or_else(|error| panic!("what was written is refused: {error}"));
            if states.masses.iter().all(|mass| !mass.is_nan()) {
                assert_eq!(again, states);
            }
            true
        }
        Err(error) => check_error(&error),
    }
}

fn check_states(states: &States) {
    let n = states.x.len();
    let lengths = [
        states.y.len(),
        states.rest.len(),
        states.masses.len(),
        states.fixed.len(),
        states.obstacle.len(),
        states.body.len(),
    ];
    assert!(n > 0 && lengths.iter().all(|&length| length == n), "{n} vertices, {lengths:?}");
    for half_space in &states.half_spaces {
        assert!((half_space.normal.norm() - 1.0).abs() < 1e-12, "{half_space:?}");
    }
}

/// An archive with some of the arrays, most of them of the right shape.
fn write_arrays(path: &Path, draw: &mut Draw<'_>) -> Result<(), WriteNpzError> {
    let file = File::create(path).map_err(ndarray_npy::WriteNpyError::Io)?;
    let mut archive = if draw.below(2) == 0 { NpzWriter::new(file) } else { NpzWriter::new_compressed(file) };
    let vertices = 1 + draw.below(6);
    let is_stack = draw.below(4) == 0;
    for (name, columns) in ARRAYS {
        let (needed, foreign): (&[&str], _) = if is_stack { (&["X"], "x") } else { (&["x", "y"], "X") };
        if name == foreign || !needed.contains(&name) && draw.below(3) == 0 {
            continue;
        }
        let is_element = matches!(name, "F" | "E" | "P" | "T" | "planes");
        let rows = if draw.rarely(4) || is_element { draw.below(4) } else { vertices };
        let columns = if draw.rarely(4) { draw.below(5) } else { columns };
        let shape = match columns {
            0 => vec![],
            1 => vec![rows],
            _ if name == "X" && draw.below(2) == 0 => vec![1 + draw.below(2), rows, columns],
            _ => vec![rows, columns],
        };
        let is_index = is_element && name != "planes" || matches!(name, "fixed" | "O" | "body");
        let mut number = || match draw.byte() {
            0..4 => draw.any(),
            _ if is_index => draw.below(vertices) as f64,
            4..16 => draw.finite(),
            _ => draw.grid(),
        };
        let values = ArrayD::from_shape_simple_fn(shape, &mut number);
        match draw.below(8) {
            0 => archive.add_array(name, &values.mapv(|v| v as f32))?,
            1 => archive.add_array(name, &values.mapv(|v| v as i64))?,
            2 => archive.add_array(name, &values.mapv(|v| v as i32))?,
            3 => archive.add_array(name, &values.mapv(|v| v as u8))?,
            4 => archive.add_array(name, &values.mapv(|v| v > 0.0))?,
            _ => archive.add_array(name, &values)?,
        }
    }
    archive.finish().map(drop)
}
