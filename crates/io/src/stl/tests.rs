use super::*;
use bowknot_geometry::Point;

const TEXT: &str = "solid two parts\nfacet normal 0 0 1\n  outer loop\n    vertex 0 0 0\n    vertex 1 0 -0.0\n    \
                    vertex 0 1.5e0 0\n  endloop\nendfacet\nfacet normal nan 0 0\n  outer loop\n    vertex 1 0 0\n    \
                    vertex 1 1 0.1\n    vertex 0 1.5 0\n  endloop\nendfacet\nendsolid two parts\n";

fn expected() -> Mesh {
    let positions = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.5, 0.0], [1.0, 1.0, 0.1]];
    Mesh {
        positions: positions.map(Point::from).to_vec(),
        triangles: vec![[0, 1, 2], [1, 3, 2]],
        ..Mesh::default()
    }
}

/// A binary file of these triangles behind a header that begins with `start`.
fn binary(start: &[u8], triangles: &[[[f32; 3]; 3]]) -> Vec<u8> {
    let mut bytes = start.to_vec();
    bytes.resize(80, b' ');
    bytes.extend((triangles.len() as u32).to_le_bytes());
    for triangle in triangles {
        bytes.extend([0; 12]);
        triangle.as_flattened().iter().for_each(|number| bytes.extend(number.to_le_bytes()));
        bytes.extend([0x7f, 0x80]);
    }
    bytes
}

fn sample() -> Vec<[[f32; 3]; 3]> {
    let at = |v: u32| expected().positions[v as usize].coords.map(|c| c as f32).into();
    expected().triangles.iter().map(|triangle| triangle.map(at)).collect()
}

fn read(bytes: &[u8]) -> Result<(Mesh, Option<String>), String> {
    parse(bytes, &Import::default()).map_err(|(place, message)| format!("a.stl{place}: {message}"))
}

#[test]
fn corners_at_one_place_are_one_vertex() {
    assert_eq!(read(TEXT.as_bytes()), Ok((expected(), None)));
    let windows = TEXT.replace('\n', "\r\n");
    assert_eq!(read(windows.as_bytes()), Ok((expected(), None)));
    assert_eq!(read(TEXT.trim_end().as_bytes()), Ok((expected(), None)));
    let shouted = TEXT.to_ascii_uppercase().replace("ENDSOLID", "end Solid").replace("1.5E0", "1.5e0");
    assert_eq!(read(format!("\u{feff}{shouted}").as_bytes()), Ok((expected(), None)));
}

#[test]
fn binary_files_are_known_by_their_size_whatever_they_begin_with() {
    for start in ["", "solid made by a program", "SOLID\nfacet"] {
        let bytes = binary(start.as_bytes(), &sample());
        let (mesh, note) = read(&bytes).unwrap();
        assert_eq!((mesh.triangles, note), (expected().triangles, None), "{start}");
        assert_eq!(mesh.positions[3].z, f64::from(0.1_f32));
    }
    let mut longer = binary(b"", &sample());
    longer.push(0);
    let (mesh, note) = read(&longer).unwrap();
    assert_eq!((mesh.triangles.len(), note.as_deref()), (2, Some("skipped 1 byte behind its triangles")));
}

#[test]
fn several_solids_share_vertices() {
    let (mesh, _) = read(format!("{TEXT}{TEXT}").as_bytes()).unwrap();
    assert_eq!((mesh.positions.len(), mesh.triangles.len()), (4, 4));
}

#[test]
fn degenerate_triangles_stay() {
    let corner = [1.0, 2.0, 3.0];
    let (mesh, _) = read(&binary(b"", &[[corner, corner, [0.0; 3]]])).unwrap();
    assert_eq!(mesh.triangles, [[0, 0, 1]]);
}

#[test]
fn every_truncation_is_refused() {
    let whole = binary(b"", &sample());
    for length in 0..whole.len() {
        assert!(read(&whole[..length]).is_err(), "{length} of {} bytes", whole.len());
    }
    let needed = TEXT.find("endsolid").unwrap() + "endsolid".len();
    for length in 0..needed {
        assert!(read(&TEXT.as_bytes()[..length]).is_err(), "{length} of {needed} bytes");
    }
    // A binary file that begins as a text and is cut has not its size.
    let solid = binary(b"solid", &sample());
    for length in 0..solid.len() {
        assert!(read(&solid[..length]).is_err(), "{length} of {} bytes", solid.len());
    }
}

#[test]
fn faults_name_the_line_or_the_triangle() {
    for (from, to, words) in [
        ("1.5e0", "inf", "a.stl:6: coordinates [0.0, inf, 0.0] are not finite"),
        ("1.5e0 0\n", "1.5e0\n", "a.stl:6: the line ends before a coordinate"),
        ("1.5e0", "x", "a.stl:6: 'x' is not a coordinate"),
        ("    vertex 1 1 0.1\n", "", "a.stl:14: a facet has 3 vertices, this one has 2"),
        (
            "endfacet\nfacet",
            "facet",
            "a.stl:8: 'facet' stands in a facet, where vertex or endfacet is expected",
        ),
        ("solid two", "solid a\nvertex 1 2 3\nsolid two", "a.stl:2: 'vertex' stands between facets"),
        ("endsolid two parts\n", "endsolid\nfacet", "a.stl:17: 'facet' stands between solids"),
        ("endsolid two parts\n", "", "a.stl: truncated: the last solid has no endsolid"),
    ] {
        assert!(TEXT.contains(from), "{from:?}");
        let error = read(TEXT.replacen(from, to, 1).as_bytes()).unwrap_err();
        assert!(error.contains(words), "{from:?} -> {to:?} gave: {error}");
    }
    let mut triangles = sample();
    triangles[1][2][0] = f32::NAN;
    let error = read(&binary(b"", &triangles)).unwrap_err();
    assert!(error.contains("a.stl: triangle 1: coordinates [NaN, 1.5, 0.0] are not finite"), "{error}");
    assert!(read(b"something else").unwrap_err().contains("not an STL file"));
    let mut many = binary(b"", &sample());
    many[80..84].fill(0xff);
    let error = read(&many).unwrap_err();
    assert!(error.contains("4294967295 triangles would take 214748364834 bytes, it has 184"), "{error}");
}

#[test]
fn files_without_triangles_are_empty() {
    for bytes in [binary(b"", &[]), b"solid\nendsolid\n".to_vec()] {
        let read = read_stl(Path::new("a.stl"), &bytes, &Import::default());
        assert!(matches!(read, Err(IoError::Empty { .. })));
    }
}
