//! Lists of tetrahedra and segments.

use super::*;

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
        let error = message(read_mesh(&write(&folder, "bad.t", bad), &Import::default()));
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

/// What is written is read again to the bit.
#[test]
fn solids_are_written_as_gmsh_files_and_as_lists() {
    let folder = folder();
    let places =
        [[0.1, 0.2, 1.0 / 3.0], [1e-300, 0.0, 0.0], [0.0, 1e30, 0.0], [-0.0, 0.0, 7.0], [5.0, 5.0, 5.0]];
    let mesh = Mesh {
        positions: places.map(|[x, y, z]| Point::new(x, y, z)).to_vec(),
        tets: vec![[1, 0, 2, 3]],
        triangles: vec![[2, 1, 4]],
        ..Mesh::default()
    };
    let path = folder.path().join("solid.t");
    write_tet_list(&path, &mesh.view()).unwrap();
    assert_eq!(read_mesh(&path, &Import::default()).unwrap(), mesh);
    let whole = Mesh { strands: vec![[4, 0]], particles: Vec::new(), ..mesh };
    let path = folder.path().join("solid.msh");
    write_msh(&path, &whole.view()).unwrap();
    assert_eq!(read_mesh(&path, &Import::default()).unwrap(), whole);
    let points = Mesh { particles: vec![3, 1], tets: Vec::new(), triangles: Vec::new(), ..whole };
    write_msh(&path, &points.view()).unwrap();
    assert_eq!(read_mesh(&path, &Import::default()).unwrap(), points);
}

#[test]
fn bytes_are_read_as_the_file_of_their_name() {
    let folder = folder();
    let mesh = Mesh { obstacle: None, body: None, names: Vec::new(), ..sample() };
    let import = Import { up: Up::Y, scale: 0.5 };
    for (name, write) in [("a.obj", write_obj as fn(&Path, &MeshView<'_>) -> _), ("a.ply", write_ply)] {
        let path = folder.path().join(name);
        write(&path, &mesh.view()).unwrap();
        let bytes = fs::read(&path).unwrap();
        let read = read_mesh_bytes(Path::new(name), &bytes, &import).unwrap();
        assert_eq!(read, read_mesh(&path, &import).unwrap());
        let cut = message(read_mesh_bytes(Path::new(name), &bytes[..bytes.len() / 2 - 1], &import));
        assert!(cut.starts_with(name), "{cut}");
    }
    let refused = |name: &str, scale| {
        message(read_mesh_bytes(Path::new(name), b"", &Import { scale, ..Import::default() }))
    };
    assert!(refused("a.glb", 1.0).contains("convert it to OBJ or PLY"));
    assert!(refused("a.png", 1.0).contains("not a mesh: only"));
    assert!(refused("a.obj", -1.0).contains("scale"));
}
