//! Round trips, third-party readers as oracles, and everything that can be wrong with a file.

use super::*;
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
fn ply_round_trips_to_the_same_bits() {
    let folder = folder();
    let path = folder.path().join("mesh.ply");
    write_ply(&path, &sample().view()).unwrap();
    assert_eq!(read_ply(&path, &Import::default()).unwrap(), sample());
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1, "the temporary file is gone");
}

#[test]
fn obj_round_trips_to_the_same_bits() {
    let folder = folder();
    let path = folder.path().join("mesh.obj");
    write_obj(&path, &sample().view()).unwrap();
    let expected = Mesh { body: None, ..sample() };
    assert_eq!(read_mesh(&path, &Import::default()).unwrap(), expected);
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
fn obj_statements_of_every_kind() {
    let folder = folder();
    let text = "# comment\r\nmtllib a.mtl\no caf\u{e9}\nv 0 0 0\nv 1. .5 1e-3 1.0 # weight\nv 0 1 0 0.5 0.5 0.5\nv -1 \\\n 2 3\n\
                vn 0 0 1\nvt 0 0\nf 1/1/1 2//1 3/1 -1\nl 1 2 -1\np 1 4\ns off\nusemtl x\nf -4 -3 -2\n";
    let mesh = read_obj(&write(&folder, "a.obj", text), &Import::default()).unwrap();
    assert_eq!(mesh.positions.len(), 4);
    assert_eq!(mesh.positions[1], Point::new(1.0, 0.5, 1e-3));
    assert_eq!(mesh.positions[3], Point::new(-1.0, 2.0, 3.0));
    assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3], [0, 1, 2]]);
    assert_eq!(mesh.strands, [[0, 1], [1, 3]]);
    assert_eq!(mesh.particles, [0, 3]);
}

#[test]
fn obj_faces_may_precede_their_vertices() {
    let folder = folder();
    let path = write(&folder, "a.obj", "f 1 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 0\n");
    assert_eq!(read_obj(&path, &Import::default()).unwrap().triangles, [[0, 1, 2]]);
}

#[test]
fn obj_faults_name_the_line() {
    let folder = folder();
    let three = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    for (tail, place, words) in [
        ("v 1 2\n", ":4", "3 coordinates, this one has 2"),
        ("v 1 2 abc\n", ":4", "'abc' is not a number"),
        ("v 1 nan 0\n", ":4", "nan is not finite"),
        ("v 1 1e999 0\n", ":4", "not finite"),
        ("\nf 1 2 4\n", ":5", "vertex index 4, but the file has 3 vertices"),
        ("f 1 2 -4\n", ":4", "only 3 vertices precede"),
        ("f 0 1 2\n", ":4", "indices count from 1"),
        ("f 1 2\n", ":4", "a face needs 3 vertices, this one has 2"),
        ("f 1 2 x\n", ":4", "'x' is not a vertex index"),
        ("l 1\n", ":4", "a line needs 2 vertices"),
        ("p\n", ":4", "a point needs 1 vertex"),
        ("# obstacle-from x\n", ":4", "needs a vertex"),
        ("f 1 2 99999999999\n", ":4", "larger than any mesh"),
    ] {
        let path = write(&folder, "bad.obj", format!("{three}{tail}"));
        let text = message(read_obj(&path, &Import::default()));
        assert!(text.contains(&format!("bad.obj{place}: ")) && text.contains(words), "{tail:?} gave: {text}");
        assert_eq!(text.lines().count(), 1);
    }
    let text = message(read_obj(&write(&folder, "empty.obj", ""), &Import::default()));
    assert!(text.contains("no vertices"), "{text}");
}

const ASCII: &str = "ply\nformat ascii 1.0\ncomment made by hand\nelement vertex 4\nproperty float x\nproperty float y\n\
                     property float z\nproperty uchar red\nelement face 2\nproperty list uchar uint vertex_index\n\
                     property float quality\nelement edge 1\nproperty short vertex1\nproperty short vertex2\nend_header\n\
                     0 0 0 255\n1. 0 0 0\n\n1 1 .5 0\n0 1 0 0\n3 0 1 2 0.5\n4 0 1 2 3 0.5\n0 3\n";

#[test]
fn ply_ascii_with_foreign_properties() {
    let folder = folder();
    let mesh = read_ply(&write(&folder, "a.ply", ASCII), &Import::default()).unwrap();
    assert_eq!(mesh.positions[2], Point::new(1.0, 1.0, 0.5));
    assert_eq!(mesh.triangles, [[0, 1, 2], [0, 1, 2], [0, 2, 3]]);
    assert_eq!(mesh.strands, [[0, 3]]);
    assert_eq!((mesh.obstacle, mesh.body), (None, None));
    let windows = ASCII.replace('\n', "\r\n");
    assert_eq!(read_ply(&write(&folder, "b.ply", windows), &Import::default()).unwrap().triangles.len(), 3);
}

#[test]
fn ply_big_endian_floats_and_short_indices() {
    let folder = folder();
    let mut bytes = b"ply\nformat binary_big_endian 1.0\nelement vertex 3\nproperty float32 x\nproperty float64 y\n\
                      property int16 z\nelement strange 1\nproperty list int32 float32 values\nelement face 1\n\
                      property uchar flags\nproperty list uint16 int16 vertex_indices\nend_header\n"
        .to_vec();
    for [x, y, z] in [[0.0, 0.0, 0.0], [1.5, 0.25, -7.0], [0.0, 1.0, 300.0]] {
        bytes.extend((x as f32).to_be_bytes());
        bytes.extend(f64::to_be_bytes(y));
        bytes.extend((z as i16).to_be_bytes());
    }
    bytes.extend(2_i32.to_be_bytes());
    bytes.extend([0; 8]);
    bytes.push(9);
    bytes.extend(3_u16.to_be_bytes());
    [2_i16, 0, 1].iter().for_each(|i| bytes.extend(i.to_be_bytes()));
    let mesh = read_ply(&write(&folder, "a.ply", bytes), &Import::default()).unwrap();
    assert_eq!(mesh.positions[1], Point::new(1.5, 0.25, -7.0));
    assert_eq!(mesh.triangles, [[2, 0, 1]]);
}

#[test]
fn ply_faults_name_the_place() {
    let folder = folder();
    for (from, to, words) in [
        ("ply\n", "plyx\n", "bad.ply:1: not a PLY file"),
        ("format ascii 1.0", "format ascii2 1.0", "bad.ply:2: format ascii2 is not"),
        ("format ascii 1.0\n", "", "names no format"),
        ("element vertex 4", "element vertex four", "bad.ply:4: 'four' is not a number"),
        ("element vertex 4", "element vertex 400", "truncated"),
        ("element vertex 4", "element vertex 99999999999999999", "at most 4294967295"),
        (
            "element vertex 4",
            "element vertex 5",
            "bad.ply:21: 5 numbers where the properties of element vertex take 4",
        ),
        ("property float x", "property real x", "'real' is no type"),
        ("property float x\n", "", "element vertex has no number x"),
        ("property float y", "property float x", "property x is declared twice"),
        ("end_header\n", "", "is no statement of a PLY header"),
        ("1. 0 0 0", "1. nan 0 0", "bad.ply:17: coordinates [1.0, NaN, 0.0] are not finite"),
        ("1. 0 0 0", "1. 0", "bad.ply:17: the line ends before property z"),
        ("0 3\n", "0 3 1\n", "bad.ply:23: 3 numbers where the properties of element edge take 2"),
        ("1. 0 0 0", "1. zero 0 0", "bad.ply:17: 'zero' is not a number"),
        ("3 0 1 2 0.5", "3 0 1 4 0.5", "bad.ply:21: vertex index 4, but the file has 4 vertices"),
        ("3 0 1 2 0.5", "3 0 1 -1 0.5", "vertex index -1"),
        ("3 0 1 2 0.5", "3 0 1 1.5 0.5", "declared as an integer"),
        ("3 0 1 2 0.5", "2 0 1 0.5", "a face needs 3 vertices, this one has 2"),
        ("vertex_index\n", "corners\n", "no integer list vertex_indices"),
        ("uint vertex_index", "float vertex_index", "no integer list vertex_indices"),
        ("element edge", "element tristrips", "triangle strips are not read"),
        ("0 3\n", "", "truncated"),
    ] {
        assert!(ASCII.contains(from), "{from:?} is not in the sample");
        let text =
            message(read_ply(&write(&folder, "bad.ply", ASCII.replacen(from, to, 1)), &Import::default()));
        assert!(text.contains(words), "{from:?} -> {to:?} gave: {text}");
        assert_eq!(text.lines().count(), 1);
    }
    let mut mesh = sample();
    mesh.positions[3].y = f64::INFINITY;
    let path = folder.path().join("infinite.ply");
    write_ply(&path, &mesh.view()).unwrap();
    let text = message(read_ply(&path, &Import::default()));
    assert!(text.contains("infinite.ply: vertex 3: coordinates"), "{text}");
}

#[test]
fn every_truncation_of_a_binary_file_is_refused() {
    let folder = folder();
    let path = folder.path().join("whole.ply");
    write_ply(&path, &sample().view()).unwrap();
    let whole = fs::read(&path).unwrap();
    for length in 0..whole.len() {
        let path = write(&folder, "cut.ply", &whole[..length]);
        let text = message(read_ply(&path, &Import::default()));
        assert!(text.contains("cut.ply"), "{text}");
    }
    let path = folder.path().join("whole.npz");
    stack().write(&path).unwrap();
    let whole = fs::read(&path).unwrap();
    for length in (0..whole.len()).step_by(11) {
        let path = write(&folder, "cut.npz", &whole[..length]);
        assert!(FrameStack::read(&path).is_err(), "{length} of {} bytes", whole.len());
    }
}

#[test]
fn damaged_files_are_read_or_refused_but_never_panic() {
    let folder = folder();
    let ply = folder.path().join("whole.ply");
    write_ply(&ply, &sample().view()).unwrap();
    let npz = folder.path().join("whole.npz");
    stack().write(&npz).unwrap();
    let sources = [fs::read(&ply).unwrap(), fs::read(&npz).unwrap(), ASCII.as_bytes().to_vec()];
    let mut random = fastrand::Rng::with_seed(1);
    for round in 0..900 {
        let mut bytes = sources[round % 3].clone();
        for _ in 0..1 + random.usize(..4) {
            let at = random.usize(..bytes.len());
            bytes[at] = random.u8(..);
        }
        let (name, is_npz) = [("d.ply", false), ("d.npz", true), ("d.ply", false)][round % 3];
        let path = write(&folder, name, &bytes);
        if is_npz {
            let _ = FrameStack::read(&path);
        } else {
            let _ = read_ply(&path, &Import::default());
            let _ = read_obj(&path, &Import::default());
        }
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
fn missing_files_and_wrong_endings() {
    let folder = folder();
    let at = |name: &str| folder.path().join(name);
    for path in [at("none.obj"), at("none.ply")] {
        let text = message(read_mesh(&path, &Import::default()));
        assert!(text.starts_with("cannot read") && text.contains("no such file"), "{text}");
    }
    assert!(message(FrameStack::read(&at("none.npz"))).contains("no such file"));
    assert!(
        message(read_mesh(&at("none.stl"), &Import::default()))
            .contains("only .obj, .ply, .msh, .t, .seg files")
    );
    assert!(
        message(read_mesh(folder.path(), &Import::default()))
            .contains("only .obj, .ply, .msh, .t, .seg files")
    );
    fs::create_dir(at("folder.npz")).unwrap();
    fs::create_dir(at("folder.ply")).unwrap();
    assert!(message(FrameStack::read(&at("folder.npz"))).contains("it is a folder"));
    assert!(message(read_mesh(&at("folder.ply"), &Import::default())).contains("it is a folder"));
}

#[test]
fn a_failed_write_keeps_the_old_file() {
    let folder = folder();
    let path = write(&folder, "a.txt", "old");
    let result = write_atomic(&path, |out| {
        use std::io::Write;
        out.write_all(b"half of the new")?;
        Err(std::io::ErrorKind::StorageFull.into())
    });
    assert!(message(result).contains("the disk is full"));
    assert_eq!(fs::read_to_string(&path).unwrap(), "old");
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    let below = path.join("b.txt");
    assert!(message(write_text(&below, "")).contains("not a folder"));
}

#[test]
fn frames_stack_and_resume() {
    let folder = folder();
    let path: &Path = &folder.path().join("frames.npz");
    let mesh = sample();
    let mut stack = FrameStack::new(&MeshView { quads: &[[0, 1, 3, 2]], ..mesh.view() }, &[[0, 1, 2, 3]]);
    assert!(stack.is_empty() && stack.push(&mesh.positions));
    assert!(!stack.push(&mesh.positions[..2]), "a frame of another size is refused");
    let moved: Vec<Point> = mesh.positions.iter().map(|p| p * 2.0).collect();
    assert!(stack.push(&moved));
    stack.write(path).unwrap();
    let mut read = FrameStack::read(path).unwrap();
    assert_eq!(read, stack);
    assert_eq!((read.len(), read.frame(1), read.frame(2)), (2, Some(moved), None));
    assert_eq!(read.mesh().triangles.len(), 4);
    read.truncate(1);
    assert_eq!(read.len(), 1);

    let mut unsized_stack = FrameStack::new(&MeshView { positions: &[], ..mesh.view() }, &[]);
    assert!(unsized_stack.push(&mesh.positions) && !unsized_stack.push(&mesh.positions[1..]));
    unsized_stack.write(path).unwrap();
    assert_eq!(FrameStack::read(path).unwrap().frame(0), Some(mesh.positions));
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
    assert_eq!(mesh.unused_vertices(), [0, 5]);
    assert_eq!(mesh.drop_unused_vertices(), 2);
    assert_eq!((mesh.triangles, mesh.strands), (vec![[1, 0, 2]], vec![[2, 3]]));
    assert_eq!((mesh.positions[2], mesh.body), (Point::new(1.0, 2.0, 3.0), Some(vec![0, 0, 0, 1])));
}

#[test]
fn tet_lists_with_any_numbers() {
    let folder = folder();
    let text = "# a solid\nTet 1 10 3 4 -7\nVertex 10 0 0 0\nVertex 3 1 0 0 {rgb=(1 0 0)}\nVertex 4 0 1 0\n\
                Vertex -7 0 0 1e0\nFace 1 3 4 10 {x}\nEdge 3 4\n";
    let mesh = read_mesh(&write(&folder, "a.t", text), &Import { up: Up::Z, scale: 2.0 }).unwrap();
    assert_eq!((mesh.tets, mesh.triangles), (vec![[0, 1, 2, 3]], vec![[1, 2, 0]]));
    assert_eq!(mesh.positions[3], Point::new(0.0, 0.0, 2.0));
    for (from, to, words) in [
        ("Tet 1 10", "Tet 1 11", "bad.t:2: there is no vertex 11"),
        ("Tet 1 10 3 4 -7", "Tet 1 10 3 4", "bad.t:2: the line ends before a vertex"),
        ("Vertex 4 0 1 0", "Vertex 4 0 1", "bad.t:5: the line ends before a coordinate"),
        ("Vertex 4 0 1 0", "Vertex 4 0 1 nan", "bad.t:5: coordinates [0.0, 1.0, NaN] are not finite"),
        ("Vertex 4 0 1 0", "Vertex 4 0 1 y", "bad.t:5: 'y' is not a coordinate"),
        ("Vertex 4 ", "Vertex 3 ", "vertex 3 is given twice"),
        ("Vertex", "Point", "no line begins with Vertex"),
    ] {
        let bad = if from == "Vertex" { text.replace(from, to) } else { text.replacen(from, to, 1) };
        let error = message(read_tet_list(&write(&folder, "bad.t", bad), &Import::default()));
        assert!(error.contains(words), "{from:?} -> {to:?} gave: {error}");
    }
}

#[test]
fn segments_are_strands() {
    let folder = folder();
    let text = "v 0 0 0\nv 1 0 0\nv 2 0 0\ns 1 2\ns 2 3\n";
    let mesh = read_mesh(&write(&folder, "a.seg", text), &Import::default()).unwrap();
    assert_eq!(mesh.strands, [[0, 1], [1, 2]]);
    let error = message(read_mesh(&write(&folder, "b.seg", format!("{text}s 3 4\n")), &Import::default()));
    assert!(error.contains("b.seg:6: vertex index 4"), "{error}");
    // In an OBJ it is a smoothing group, which may have any number.
    assert!(
        read_mesh(&write(&folder, "a.obj", "v 0 0 0\ns 9\n"), &Import::default()).unwrap().strands.is_empty()
    );
}

#[test]
fn point_caches_grow_and_shrink_by_whole_samples() {
    let folder = folder();
    let path = folder.path().join("a.pc2");
    let frame = |k: usize| vec![Point::new(k as f64, 0.5, -1.0 / 3.0), Point::new(0.1, 0.2, 0.3)];
    for k in 0..3 {
        write_pc2_frame(&path, k, &frame(k)).unwrap();
    }
    let bytes = fs::read(&path).unwrap();
    assert_eq!(bytes.len(), 32 + 3 * 24);
    assert_eq!(&bytes[..12], b"POINTCACHE2\0");
    let word = |at: usize| i32::from_le_bytes(bytes[at..at + 4].try_into().unwrap());
    let real = |at: usize| f32::from_le_bytes(bytes[at..at + 4].try_into().unwrap());
    assert_eq!((word(12), word(16), real(20), real(24), word(28)), (1, 2, 0.0, 1.0, 3));
    assert_eq!((real(32 + 48), real(32 + 52), real(32 + 56)), (2.0, 0.5, -1.0 / 3.0));
    // Frame 1 again: what a resumed run does.
    write_pc2_frame(&path, 1, &frame(1)).unwrap();
    write_pc2_frame(&path, 2, &frame(2)).unwrap();
    assert_eq!(fs::read(&path).unwrap(), bytes);
    truncate_pc2(&path, 1, 2).unwrap();
    assert_eq!(fs::read(&path).unwrap().len(), 32 + 24);
    assert!(message(truncate_pc2(&path, 2, 2)).contains("it has 1 samples, 2 are needed"));
    assert!(message(truncate_pc2(&path, 1, 3)).contains("a point cache of 2 points, not of 3"));
    assert!(message(write_pc2_frame(&path, 2, &frame(2))).contains("1 samples"));
    assert!(message(truncate_pc2(&write(&folder, "b.pc2", "no"), 1, 3)).contains("b.pc2: not a point cache"));
}

#[test]
fn grids_say_where_their_arrays_are() {
    let folder = folder();
    let path = folder.path().join("a.vtu");
    let mesh = sample();
    write_vtu(&path, &MeshView { quads: &[[0, 1, 3, 2]], ..mesh.view() }).unwrap();
    let bytes = fs::read(&path).unwrap();
    let start = bytes.windows(2).position(|w| w == b"\n_").unwrap() + 2;
    let head = String::from_utf8(bytes[..start].to_vec()).unwrap();
    assert!(head.contains("NumberOfPoints=\"6\" NumberOfCells=\"5\""), "{head}");
    // Every array's offset leads to its length, which leads to the next array.
    let mut at = 0;
    for part in head.split("offset=\"").skip(1) {
        assert_eq!(part.split('"').next().unwrap().parse(), Ok(at));
        let length = bytes[start + at..start + at + 8].try_into().unwrap();
        at += 8 + u64::from_le_bytes(length) as usize;
    }
    assert_eq!(&bytes[start + at..], b"\n</AppendedData>\n</VTKFile>\n");
    assert_eq!(&bytes[start + 8..start + 16], 0.1_f64.to_le_bytes());
    let types = &bytes[start + at - (8 + 6) - (8 + 24) - 5..][..5];
    assert_eq!(types, [5, 5, 9, 3, 1]);
}

#[test]
fn stages_name_everything_once() {
    let folder = folder();
    let path = folder.path().join("a.usda");
    let mesh = sample();
    let body = |name| UsdBody { name, elements: mesh.view(), obstacle: false, width: 0.25 };
    let bodies = [body("2 cloths"), body("cloth"), body("cloth_strands"), body("cloth")];
    write_usda(&path, &bodies, 2, 50.0, |_, frame| {
        Ok(mesh.positions.iter().map(|p| p + Vector::new(frame as f64, 0.0, 0.0)).collect())
    })
    .unwrap();
    let text = fs::read_to_string(&path).unwrap();
    for line in [
        "    upAxis = \"Z\"",
        "    metersPerUnit = 1",
        "    timeCodesPerSecond = 50",
        "    endTimeCode = 1",
        "    def Mesh \"_2_cloths\"",
        "    def Points \"cloth_particles\"",
        "    def Mesh \"cloth_strands_2\"",
        "    def Mesh \"cloth_2\"",
        "            1: [(2.0, 2.0, 3.0), (0.0, -2.0, -3.0)],",
        "            0: [(-1.125, -2.125, -3.125), (1.125, 2.125, 3.125)],",
    ] {
        assert!(text.lines().any(|l| l == line), "{line:?} is missing in\n{text}");
    }
    let mut prims: Vec<&str> = text.lines().filter(|line| line.starts_with("    def ")).collect();
    let count = prims.len();
    prims.sort_unstable();
    prims.dedup_by_key(|line| line.split('"').nth(1));
    assert_eq!((count, prims.len()), (12, 12));
}

#[test]
fn a_stack_that_is_streamed_is_the_stack() {
    let folder = folder();
    let (streamed, held) = (folder.path().join("a.npz"), folder.path().join("b.npz"));
    let mesh = sample();
    let view = MeshView { quads: &[[0, 1, 3, 2]], ..mesh.view() };
    let mut stack = FrameStack::new(&view, &[]);
    assert!(stack.push(&mesh.positions) && stack.push(&mesh.positions));
    stack.write(&held).unwrap();
    write_frame_stack(&streamed, &view, 2, |_, bytes| {
        bytes.extend(mesh.positions.iter().flat_map(|p| [p.x, p.y, p.z]).flat_map(f64::to_le_bytes));
        Ok(())
    })
    .unwrap();
    assert_eq!(FrameStack::read(&streamed).unwrap(), stack);
    let failing = write_frame_stack(&streamed, &view, 2, |_, _| Err(std::io::ErrorKind::StorageFull.into()));
    assert!(message(failing).contains("the disk is full"));
    assert_eq!(FrameStack::read(&streamed).unwrap(), stack, "the old file stays");
}
