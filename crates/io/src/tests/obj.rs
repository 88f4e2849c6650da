//! Wavefront OBJ.

use super::*;

#[test]
fn obj_round_trips_to_the_same_bits() {
    let folder = folder();
    let path = folder.path().join("mesh.obj");
    write_obj(&path, &sample().view()).unwrap();
    let expected = Mesh { body: None, names: Vec::new(), ..sample() };
    assert_eq!(read_mesh(&path, &Import::default()).unwrap(), expected);
}

#[test]
fn obj_statements_of_every_kind() {
    let folder = folder();
    let text = "# comment\r\nmtllib a.mtl\no caf\u{e9}\nv 0 0 0\nv 1. .5 1e-3 1.0 # weight\nv 0 1 0 0.5 0.5 \
                0.5\nv -1 \\\n 2 3\n\
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
fn a_byte_order_mark_hides_no_line() {
    let folder = folder();
    let path = write(&folder, "a.obj", "\u{feff}v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    assert_eq!(read_obj(&path, &Import::default()).unwrap().positions.len(), 3);
    let path = write(
        &folder,
        "a.t",
        "\u{feff}Vertex 0 0 0 0\nVertex 1 1 0 0\nVertex 2 0 1 0\nVertex 3 0 0 1\nTet 0 0 1 2 3\n",
    );
    assert_eq!(read_mesh(&path, &Import::default()).unwrap().positions.len(), 4);
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

#[test]
fn names_of_groups_have_the_vertices_of_their_elements() {
    let text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nf 1 2 3\ng hem  front\nf 2 5 3\ng\nf 1 3 4\n\
                g front\nl 4 1\np 5\no body\nf 1 2 4\n";
    let folder = folder();
    let mesh = read_obj(&write(&folder, "a.obj", text), &Import::default()).unwrap();
    let groups: Vec<(&str, &[u32])> = mesh.groups.iter().collect();
    assert_eq!(groups, [("front", &[0, 1, 2, 3, 4][..]), ("hem", &[1, 2, 4])]);
}
