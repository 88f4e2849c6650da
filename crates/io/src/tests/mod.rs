//! Round trips, third-party readers as oracles, and everything that can be wrong with a file.

mod archives;
mod exports;
mod lists;
mod obj;
mod ply;
mod polygons;
mod robust;
mod scenes;
mod sources;
mod stages;
mod surface;

use super::*;
use crate::folder::natural_order;
use bowknot_geometry::{Point, Vector};
use std::fs;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

fn folder() -> TempDir {
    tempfile::tempdir().expect("a folder")
}

fn write(folder: &TempDir, name: &str, content: impl AsRef<[u8]>) -> PathBuf {
    let path = folder.path().join(name);
    fs::write(&path, content).expect("a writable folder");
    path
}

/// A small mesh with numbers that do not survive a careless print.
fn sample() -> Mesh {
    let p = |x: f64, y: f64, z: f64| Point::new(x, y, z);
    Mesh {
        positions: vec![
            p(0.1, 1.0 / 3.0, -2.5e-7),
            p(1e10, 0.0, -0.0),
            p(f64::MIN_POSITIVE, 0.3, 0.7),
            p(1.0, 2.0, 3.0),
            p(-1.0, -2.0, -3.0),
            p(4.0, 5.0, 6.0),
        ],
        triangles: vec![[0, 1, 2], [2, 1, 3]],
        strands: vec![[3, 4]],
        tets: Vec::new(),
        particles: vec![5],
        obstacle: Some(vec![false, false, false, false, false, true]),
        body: Some(vec![0, 0, 0, 0, 1, 2]),
        names: vec!["a".to_owned(), "b c".to_owned()],
        surface: None,
        groups: Groups::default(),
    }
}

/// Two frames of the sample.
fn stack() -> FrameStack {
    let mesh = sample();
    let mut stack = FrameStack::new(&mesh.view(), &[]);
    assert!(stack.push(&mesh.positions) && stack.push(&mesh.positions));
    stack
}

fn message(result: Result<impl std::fmt::Debug, IoError>) -> String {
    result.expect_err("a refusal").to_string()
}

#[test]
fn other_readers_read_what_we_write() {
    let folder = folder();
    let mesh = sample();
    let path = folder.path().join("mesh.ply");
    write_ply(&path, &mesh.view()).unwrap();
    let parser = ply_rs_bw::parser::Parser::<ply_rs_bw::ply::DefaultElement>::new();
    let ply = parser.read_ply(&mut fs::File::open(&path).unwrap()).unwrap();
    for (element, point) in ply.payload["vertex"].iter().zip(&mesh.positions) {
        for (name, value) in ["x", "y", "z"].iter().zip(point.iter()) {
            assert_eq!(element[*name], ply_rs_bw::ply::Property::Double(*value));
        }
    }
    let faces: Vec<_> =
        ply.payload["face"].iter().map(|f| f["vertex_indices"].to_u32_list().unwrap()).collect();
    assert_eq!(faces, mesh.triangles);
    assert_eq!(ply.payload["edge"].len(), 1);

    let path = folder.path().join("mesh.obj");
    write_obj(&path, &MeshView { strands: &[], particles: &[], ..mesh.view() }).unwrap();
    let (models, _) = tobj::load_obj(&path, &tobj::LoadOptions::default()).unwrap();
    assert_eq!(models[0].mesh.indices, mesh.triangles.concat());
}

#[test]
fn quads_are_written_and_come_back_as_fans() {
    let folder = folder();
    let mesh = sample();
    let view = MeshView { quads: &[[0, 1, 3, 2]], ..mesh.view() };
    for name in ["quad.ply", "quad.obj"] {
        let path = folder.path().join(name);
        if name.ends_with("ply") { write_ply(&path, &view) } else { write_obj(&path, &view) }.unwrap();
        let read = read_mesh(&path, &Import::default()).unwrap();
        assert_eq!(read.triangles[2..], [[0, 1, 3], [0, 3, 2]], "{name}");
    }
}

#[test]
fn import_turns_and_scales() {
    let folder = folder();
    let path = write(&folder, "a.obj", "v 1 2 3\n");
    let read = |up, scale| read_obj(&path, &Import { up, scale }).map(|m| m.positions[0]);
    assert_eq!(read(Up::Z, 1.0).unwrap(), Point::new(1.0, 2.0, 3.0));
    assert_eq!(read(Up::Y, 1.0).unwrap(), Point::new(1.0, -3.0, 2.0));
    assert_eq!(read(Up::X, 0.5).unwrap(), Point::new(1.0, 1.5, 0.5));
    for scale in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(message(read(Up::Z, scale)).contains("must be finite and above 0"));
    }
    assert!(message(read(Up::Z, 1e308)).contains("overflows when scaled"));
}

#[test]
fn names_sort_by_their_numbers() {
    let mut names = ["10_2_1.ply", "2_10_3.ply", "2_9_12.ply", "a.ply", "002.ply", "2.ply", "2_9_2.ply"];
    names.sort_by(|a, b| natural_order(a, b));
    assert_eq!(names, ["002.ply", "2.ply", "2_9_2.ply", "2_9_12.ply", "2_10_3.ply", "10_2_1.ply", "a.ply"]);
}

#[test]
fn unused_vertices_are_dropped_in_order() {
    let mut mesh = sample();
    mesh.triangles = vec![[2, 1, 3]];
    mesh.particles.clear();
    mesh.groups.add("ends", [5, 0]);
    mesh.groups.add("edge", [3, 0, 1, 3]);
    assert_eq!(mesh.unused_vertices(), [0, 5]);
    assert_eq!(mesh.drop_unused_vertices(), 2);
    assert_eq!((mesh.groups.get("ends"), mesh.groups.get("edge")), (Some(&[][..]), Some(&[0, 2][..])));
    assert_eq!((mesh.triangles, mesh.strands), (vec![[1, 0, 2]], vec![[2, 3]]));
    assert_eq!((mesh.positions[2], mesh.body), (Point::new(1.0, 2.0, 3.0), Some(vec![0, 0, 0, 1])));
}

#[test]
fn obstacles_at_one_place_are_absent() {
    let at = |z: f64| Point::new(0.0, 0.0, z);
    // A cloth, two parts of an obstacle, a wire, a loose point of an obstacle.
    let mesh = Mesh {
        triangles: vec![[0, 1, 2], [3, 4, 5], [6, 7, 8]],
        strands: vec![[9, 10]],
        particles: vec![11],
        obstacle: Some((0..12).map(|v| v > 2).collect()),
        ..Mesh::default()
    };
    let positions = |absent: &[usize]| -> Vec<Point> {
        (0..12).map(|v| if absent.contains(&v) { at(9.0) } else { at(v as f64) }).collect()
    };
    let absent = |vertices: &[usize]| -> Vec<usize> {
        let marked = mesh.absent(&positions(vertices));
        (0..marked.len()).filter(|&v| marked[v]).collect()
    };
    assert_eq!(absent(&[]), [0; 0]);
    assert_eq!(absent(&[3, 4, 5]), [3, 4, 5]);
    assert_eq!(absent(&[6, 7, 8, 9, 10]), [6, 7, 8, 9, 10]);
    // What collapses in part is there, as are what deforms and single points.
    assert_eq!(absent(&[3, 4, 6, 7, 8]), [6, 7, 8]);
    assert_eq!(absent(&[0, 1, 2, 11]), [0; 0]);
    let mut left = mesh.clone();
    left.leave_out(&mesh.absent(&positions(&[3, 4, 5, 9, 10])));
    assert_eq!((left.triangles, left.strands.len()), (vec![[0, 1, 2], [6, 7, 8]], 0));
}

#[test]
fn meshes_without_vertices_are_told_from_damaged_files() {
    let folder = folder();
    let header = "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float y\nproperty \
                  float z\nend_header\n";
    for (name, content, is_empty) in [
        ("a.obj", "# exported\no Plate\n", true),
        ("b.obj", "", false),
        ("c.obj", " \n\n", false),
        ("d.obj", "f 1 2 3\n", false),
        ("e.ply", header, true),
        ("f.ply", "ply\nformat ascii 1.0\nend_header\n", false),
        ("g.ply", &header.replace("vertex 0", "vertex 3"), false),
        ("h.ply", &header[..40], false),
    ] {
        let error = read_mesh(&write(&folder, name, content), &Import::default()).expect_err(name);
        assert_eq!(matches!(error, IoError::Empty { .. }), is_empty, "{name}: {error}");
    }
}
