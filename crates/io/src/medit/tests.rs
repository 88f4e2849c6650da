use super::*;
use crate::surface::Surface;

/// A tetrahedron with its boundary, a lone triangle, a quadrilateral and a lone edge.
const TEXT: &str = "MeshVersionFormatted 2 # a comment with Vertices 9\nDimension\n3\n\nVertices\n9\n0 0 0 0\n1 0 0 5\n0 1 0 0\n\
                    0 0 1 5\n5 0. 0 0\n6 0 0 0\n6 1e0 0 0\n5 1 0 0\n9 0 -.5 0\nTriangles 2\n1 3 2 1\n5 6 7 -2\n\
                    Quadrilaterals 1\n5 6 7 8 0\nTetrahedra 1\n1 2 3 4 7\nCorners 2\n1\n2\nEdges 2\n1 2 0\n8 9 4\n\
                    Normals\n1\n0.5 nan -1e-3\n\nEnd\n";

fn read(text: &str) -> Result<(Mesh, Vec<String>), String> {
    parse(text, &Import::default()).map_err(|(place, message)| format!("a.mesh{place}: {message}"))
}

#[test]
fn elements_and_references() {
    let (mesh, notes) = read(TEXT).unwrap();
    assert_eq!((mesh.positions.len(), mesh.positions[8]), (9, Point::new(9.0, 0.0, -0.5)));
    assert_eq!(mesh.tets, [[0, 1, 2, 3]]);
    // The face of the tetrahedron and its edge are not there again.
    assert_eq!(mesh.triangles, [[4, 5, 6], [4, 5, 6], [4, 6, 7]]);
    assert_eq!(mesh.strands, [[7, 8]]);
    assert_eq!(mesh.surface.as_ref().map(Surface::len), Some(2));
    let groups: Vec<(&str, &[u32])> = mesh.groups.iter().collect();
    let expected = [
        ("edges-4", &[7, 8][..]),
        ("tetrahedra-7", &[0, 1, 2, 3]),
        ("triangles--2", &[4, 5, 6]),
        ("triangles-1", &[0, 1, 2]),
        ("vertices-5", &[1, 3]),
    ];
    assert_eq!(groups, expected);
    assert_eq!(notes, ["skipped the sections Corners, Normals"]);
    assert_eq!(read(&TEXT.replace('\n', "\r\n")).unwrap().0, mesh);
    assert_eq!(read(TEXT.trim_end()).unwrap().0, mesh);
}

#[test]
fn planes_and_elements_of_order_2() {
    let text = "MeshVersionFormatted 1 Dimension 2 Vertices 6 0 0 0 1 0 0 0 1 0 .5 0 0 .5 .5 0 0 .5 0 TrianglesP2 1 \
                1 2 3 4 5 6 3 End";
    let (mesh, notes) = read(text).unwrap();
    assert_eq!((mesh.triangles, mesh.positions[1]), (vec![[0, 1, 2]], Point::new(1.0, 0.0, 0.0)));
    assert_eq!(mesh.groups.get("triangles-3"), Some(&[0, 1, 2][..]));
    assert_eq!(notes, ["took the corners only of TrianglesP2"]);
}

#[test]
fn every_truncation_is_refused() {
    let needed = TEXT.trim_end().len();
    for length in 0..needed {
        assert!(read(&TEXT[..length]).is_err(), "{length} of {needed} bytes");
    }
}

#[test]
fn faults_name_the_line() {
    for (from, to, words) in [
        ("MeshVersion", "Version", "a.mesh: not a Medit file"),
        ("Formatted 2", "Formatted two", "a.mesh:1: 'two' is not the version"),
        ("Dimension\n3", "Dimension\n4", "a.mesh:3: dimension 4 must be 2 or 3"),
        ("Dimension\n3", "", "a.mesh:4: Dimension must stand before Vertices"),
        ("Vertices\n9\n", "Vertices\n-9\n", "a.mesh:6: '-9' is not the number of vertices"),
        ("Vertices\n9\n", "Vertices\n99999999999999999999\n", "is not the number of vertices"),
        (
            "Vertices\n9\n",
            "Vertices\n4000000000000000000\n",
            "a.mesh:6: truncated: 4000000000000000000 vertices are",
        ),
        ("Vertices\n9\n", "Vertices\n10\n", "a.mesh:16: 'Triangles' is not a coordinate"),
        ("Vertices\n9\n", "Vertices\n8\n", "a.mesh:15: '9' stands where a section is expected"),
        ("6 1e0 0 0", "6 inf 0 0", "a.mesh:13: coordinates [6.0, inf, 0.0] are not finite"),
        ("1 3 2 1\n", "1 3 0 1\n", "a.mesh:17: vertex 0, but the vertices before have the numbers 1 to 9"),
        ("1 3 2 1\n", "1 3 10 1\n", "a.mesh:17: vertex 10"),
        ("1 3 2 1\n", "1 3 2 x\n", "a.mesh:17: 'x' is not a reference"),
        ("Triangles 2", "Vertices 0 Vertices 2", "a second section Vertices"),
        ("\nEnd", "", "a.mesh: truncated: it does not end with End"),
    ] {
        assert!(TEXT.contains(from), "{from:?}");
        let error = read(&TEXT.replacen(from, to, 1)).unwrap_err();
        assert!(error.contains(words), "{from:?} -> {to:?} gave: {error}");
    }
    let empty = "MeshVersionFormatted 2\nDimension 3\nVertices 1\n0 0 0 0\nHexahedra 0\nEnd\n";
    assert!(read(empty).unwrap_err().contains("edges in it (skipped the sections Hexahedra)"));
}

#[test]
fn binary_files_are_refused_with_the_remedy() {
    let error = crate::read_mesh(Path::new("a.meshb"), &Import::default()).unwrap_err().to_string();
    assert!(error.contains("a.meshb: binary Medit files are not read: convert it"), "{error}");
}
