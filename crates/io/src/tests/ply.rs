//! PLY, binary and text.

use super::*;

/// A file made by hand, with properties that are not ours.
pub const ASCII: &str = "ply\nformat ascii 1.0\ncomment made by hand\nelement vertex 4\nproperty float \
                         x\nproperty float y\n\
                         property float z\nproperty uchar red\nelement face 2\nproperty list uchar uint \
                         vertex_index\n\
                         property float quality\nelement edge 1\nproperty short vertex1\nproperty short \
                         vertex2\nend_header\n\
                         0 0 0 255\n1. 0 0 0\n\n1 1 .5 0\n0 1 0 0\n3 0 1 2 0.5\n4 0 1 2 3 0.5\n0 3\n";

#[test]
fn ply_round_trips_to_the_same_bits() {
    let folder = folder();
    let path = folder.path().join("mesh.ply");
    write_ply(&path, &sample().view()).unwrap();
    assert_eq!(read_ply(&path, &Import::default()).unwrap(), sample());
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1, "the temporary file is gone");
}

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
    let mut bytes = b"ply\nformat binary_big_endian 1.0\nelement vertex 3\nproperty float32 x\nproperty \
                      float64 y\n\
                      property int16 z\nelement strange 1\nproperty list int32 float32 values\nelement face \
                      1\n\
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

/// Bodies are written as `int`: a larger number would come back as another one, or not at all.
#[test]
fn ply_bodies_are_numbers_that_can_be_written() {
    let folder = folder();
    let read = |body: &str| {
        let text = ASCII.replace("uchar red", "uint body");
        let rows = format!("0 0 0 {body}\n1. 0 0 7\n\n1 1 .5 7\n0 1 0 2147483647\n");
        let text = text.replace("0 0 0 255\n1. 0 0 0\n\n1 1 .5 0\n0 1 0 0\n", &rows);
        read_ply(&write(&folder, "bodies.ply", text), &Import::default())
    };
    let mesh = read("3").unwrap();
    assert_eq!(mesh.body.as_deref(), Some(&[3, 7, 7, i32::MAX as u32][..]));
    let again = folder.path().join("again.ply");
    write_ply(&again, &mesh.view()).unwrap();
    assert_eq!(read_ply(&again, &Import::default()).unwrap().body, mesh.body);
    for body in ["2147483648", "-1"] {
        let text = message(read(body));
        assert!(text.contains(&format!("body {body} must be a whole number from 0 to 2147483647")), "{text}");
    }
}

#[test]
fn names_of_bodies_are_comments() {
    let folder = folder();
    let path = folder.path().join("a.ply");
    let names = ["left  sleeve", " \u{e9}toffe\nelement x", ""].map(str::to_owned).to_vec();
    let mesh =
        Mesh { positions: vec![Point::origin(); 3], triangles: vec![[0, 1, 2]], names, ..Mesh::default() };
    write_ply(&path, &mesh.view()).unwrap();
    let again = read_ply(&path, &Import::default()).unwrap();
    assert_eq!(again.names, ["left  sleeve", " \u{e9}toffe element x", ""]);
    // Others' comments are no names.
    let other = "ply\nformat ascii 1.0\ncomment body 7 x\ncomment body of water\ncomment body 0 a\r\nelement \
                 vertex 1\n\
                 property float x\nproperty float y\nproperty float z\nend_header\n0 0 0\n";
    let path = write(&folder, "b.ply", other);
    assert_eq!(read_ply(&path, &Import::default()).unwrap().names, ["a"]);
}

#[test]
fn bodies_may_have_any_numbers() {
    let text = "ply\nformat ascii 1.0\ncomment body 0 a\nelement vertex 3\nproperty float x\nproperty float y\n\
                property float z\nproperty int body\nend_header\n0 0 0 0\n1 0 0 2147483647\n2 0 0 7\n";
    let folder = folder();
    let path = write(&folder, "far.ply", text);
    let part = read_mesh_part(&path, &Import::default(), "body 2147483647").unwrap();
    assert_eq!((part.positions, part.particles), (vec![Point::new(1.0, 0.0, 0.0)], vec![0]));
    let error = message(read_mesh_part(&path, &Import::default(), "b"));
    assert!(error.ends_with("no part \"b\"; it has a, body 7, body 2147483647"), "{error}");
    let sources = [&path, &path].map(|path| FrameSource::open(path).unwrap());
    let both = FrameSource::together(sources.into()).unwrap().read(0).unwrap();
    assert_eq!(both.body, Some(vec![0, 2, 1, 3, 5, 4]));
    let names = ["a", "far, body 7", "far, body 2147483647"];
    assert_eq!(both.names, [names, names].concat());
    // A name that several have.
    let path = write(&folder, "twice.ply", text.replace("body 0 a", "body 0 a\ncomment body 1 a"));
    let error = message(read_mesh_part(&path, &Import::default(), "a"));
    assert!(error.ends_with("2 parts are called \"a\"; give them different names in the file"), "{error}");
}

#[test]
fn other_properties_of_vertices_are_groups() {
    let text = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
                property float nx\nproperty uchar red\nproperty uchar hem\nproperty list uchar int weights\n\
                property double heat\nproperty int none\nelement face 1\nproperty list uchar int vertex_indices\n\
                property int collar\nend_header\n0 0 0 1 9 0 0 -0.5 0\n1 0 0 1 9 1 2 5 6 nan 0\n0 1 0 1 9 3 0 -0.0 0\n\
                3 0 1 2 1\n";
    let folder = folder();
    let mesh = read_ply(&write(&folder, "a.ply", text), &Import::default()).unwrap();
    let groups: Vec<(&str, &[u32])> = mesh.groups.iter().collect();
    assert_eq!(groups, [("heat", &[0][..]), ("hem", &[1, 2]), ("none", &[])]);
    assert_eq!(mesh.triangles.len(), 1);
}
