//! Polygons, texture coordinates, normals and names: from OBJ to OBJ, PLY and USD.

use super::*;
use crate::{EdgeSplit, Surface, read_obj_surface, write_usda};

/// A quad, a triangle and a pentagon side by side. The quad and the triangle share an edge with a seam in the
/// texture and, at one end, a hard edge.
const GARMENT: &str = "mtllib cloth.mtl\no Shirt\n\
    v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0.5 1\nv 3 0 0\nv 4 0 0\nv 4.5 1 0\nv 3.5 2 0\nv 2.5 1 0\n\
    vt 0 0\nvt 0.5 0\nvt 0.5 0.5\nvt 0 0.5\nvt 0.6\nvt 0.7 0.1 0.9\nvt 0.65 0.2\n\
    vn 0 0 1\nvn 0 1 0\nvn 1 0 0\n\
    g front sleeve\nusemtl Silk #1\ns 1\nf 1/1/1 2/2/1 3/3/1 4/4/1\n\
    g back\nusemtl wool\ns off\nf 2/5/1 -6/6/2 3/-1/2\n\
    g\nf 6//3 7//3 8//3 9//3 10//3\n";

fn read(folder: &TempDir, text: &str) -> Mesh {
    read_obj(&write(folder, "garment.obj", text), &Import::default()).expect("a sound file")
}

fn surface(mesh: &Mesh) -> &Surface {
    mesh.surface.as_ref().expect("a surface")
}

/// Vertex, texture coordinate and normal, from 0.
type Indices = (u32, Option<u32>, Option<u32>);

/// Those of the corners of all polygons.
fn corners(surface: &Surface) -> Vec<Vec<Indices>> {
    let of = |corner: &crate::Corner| (corner.vertex, corner.texture(), corner.normal());
    surface.polygons().map(|polygon| polygon.corners.iter().map(of).collect()).collect()
}

#[test]
fn all_that_an_obj_says_about_faces_is_read() {
    let folder = folder();
    let mesh = read(&folder, GARMENT);
    let surface = surface(&mesh);
    assert_eq!(surface.triangles().collect::<Vec<_>>(), mesh.triangles);
    assert_eq!(mesh.triangles.len(), 2 + 1 + 3);
    assert_eq!(surface.texture_coordinates()[4..], [[0.6, 0.0], [0.7, 0.1], [0.65, 0.2]]);
    let all = corners(surface);
    // Vertex 2 has one normal for both faces, vertex 3 has two.
    let quad = [0, 1, 2, 3].map(|k| (k, Some(k), Some(k)));
    assert_eq!(all[0], quad);
    assert_eq!(all[1], [(1, Some(4), Some(1)), (4, Some(5), Some(4)), (2, Some(6), Some(5))]);
    assert_eq!(all[2].len(), 5);
    assert_eq!((all[2][0], surface.normal_count()), ((5, None, Some(6)), 11));
    let labels: Vec<_> = surface.polygons().map(|polygon| polygon.labels.clone()).collect();
    let text = |name: &str| Some(name.to_owned());
    assert_eq!((&labels[0].object, &labels[0].group), (&text("Shirt"), &text("front sleeve")));
    assert_eq!((&labels[0].material, &labels[0].smoothing), (&text("Silk #1"), &text("1")));
    assert_eq!((&labels[1].group, &labels[1].smoothing), (&text("back"), &text("off")));
    assert_eq!((&labels[2].group, &labels[2].material), (&None, &text("wool")));
    assert_eq!(surface.material_libraries(), [folder.path().join("cloth.mtl")]);
}

#[test]
fn obj_to_obj_keeps_everything() {
    let folder = folder();
    let mesh = read(&folder, &GARMENT.replace("\ng\n", "\n"));
    fs::create_dir(folder.path().join("frames")).unwrap();
    let path = folder.path().join("frames/1.obj");
    write_obj(&path, &mesh.view()).unwrap();
    let text = fs::read_to_string(&path).unwrap();
    assert!(text.starts_with("mtllib ../cloth.mtl\nv "), "{text}");
    for line in ["vt 0.7 0.1", "usemtl Silk #1", "s off", "g back", "f 2/5/2 5/6/5 3/7/6"] {
        assert!(text.lines().any(|other| other == line), "{line:?} is missing in\n{text}");
    }
    let again = read_obj(&path, &Import::default()).unwrap();
    let libraries = surface(&again).material_libraries()[0].canonicalize();
    assert!(libraries.is_err(), "the library need not exist");
    let rewritten = folder.path().join("2.obj");
    write_obj(&rewritten, &again.view()).unwrap();
    let moved = fs::read_to_string(&rewritten).unwrap();
    assert_eq!(moved, text.replace("../cloth.mtl", "cloth.mtl"));
    // Only the path of the library is written otherwise.
    let same = |a: &Mesh, b: &Mesh| {
        let labels = |mesh: &Mesh| surface(mesh).polygons().map(|p| p.labels.clone()).collect::<Vec<_>>();
        corners(surface(a)) == corners(surface(b)) && labels(a) == labels(b) && a.positions == b.positions
    };
    assert!(same(&again, &mesh));
}

#[test]
fn names_that_end_are_taken_back() {
    let folder = folder();
    let mesh = read(
        &folder,
        "v 0 0 0\nv 1 0 0\nv 0 1 0\ng a\nusemtl default\ns 1\nf 1 2 3\ng\nusemtl\ns\nf 3 2 1\n",
    );
    let path = folder.path().join("out.obj");
    write_obj(&path, &mesh.view()).unwrap();
    let text = fs::read_to_string(&path).unwrap();
    let end = "# nameless\ng default\n# nameless\nusemtl default\n# nameless\ns off\nf 3 2 1\n";
    assert!(text.ends_with(&format!("g a\nusemtl default\ns 1\nf 1 2 3\n{end}")), "{text}");
    assert_eq!(read_obj(&path, &Import::default()).unwrap(), mesh);
}

#[test]
fn plain_triangles_have_no_surface() {
    let folder = folder();
    let three = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nmtllib a.mtl\nf 1 2 3\n";
    assert_eq!(read(&folder, three).surface, None);
    assert_eq!(read(&folder, &format!("{three}l 1 2\no late\n")).surface, None);
    // One face with more makes polygons of those before it, too.
    let mesh = read(&folder, &format!("{three}f 1/1 2 3\n"));
    assert_eq!(surface(&mesh).len(), 2);
}

#[test]
fn faults_of_corners_name_the_line() {
    let folder = folder();
    let three = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\n";
    for (tail, place, words) in [
        ("f 1/2 2/1 3/1\n", ":6", "texture coordinate index 2, but the file has 1 texture coordinate"),
        ("f 1/1/5 2 3\n", ":6", "normal index 5, but the file has 1 normal"),
        ("f 1/-2 2 3\n", ":6", "texture coordinate index -2, but only 1 texture coordinate precedes it"),
        ("f 1//-2 2 3\n", ":6", "normal index -2"),
        ("f 1/0 2 3\n", ":6", "texture coordinate index 0: indices count from 1"),
        ("f 1/x 2 3\n", ":6", "'1/x' is not a texture coordinate index"),
        ("f 1/1/1/1 2 3\n", ":6", "'1/1/1/1' has more indices"),
        ("f 1/4294967296 2 3\n", ":6", "larger than any mesh"),
        ("vt\n", ":6", "a texture coordinate needs a number"),
        ("vt a 0\n", ":6", "'a' is not a number"),
        ("vt 0 nan\n", ":6", "nan is not finite"),
    ] {
        let path = write(&folder, "bad.obj", format!("{three}{tail}"));
        let text = message(read_obj(&path, &Import::default()));
        assert!(text.contains(&format!("bad.obj{place}: ")) && text.contains(words), "{tail:?} gave: {text}");
    }
    // What is no number does no harm in a normal; and everything may follow the face that names it.
    let late = "f 1/1/1 2/1/1 3/1/1\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0\nvn nan 0 -nan(ind)\n";
    assert_eq!(surface(&read(&folder, late)).normal_count(), 3);
}

/// Two triangles with an edge in common, each with normals of its own.
fn listed_normals(values: [&str; 6]) -> String {
    let normals: String = values.iter().map(|value| format!("vn {value}\n")).collect();
    format!("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n{normals}f 1//1 2//2 3//3\nf 1//4 3//5 4//6\n")
}

#[test]
fn normals_listed_corner_by_corner_are_shared_where_they_are_equal() {
    let folder = folder();
    let smooth = read(&folder, &listed_normals(["0 0 1"; 6]));
    assert_eq!(surface(&smooth).normal_count(), 4);
    let hard = read(&folder, &listed_normals(["0 0 1", "0 0 1", "0 0 1", "0 1 0", "0 1 0", "0 1 0"]));
    assert_eq!(surface(&hard).normal_count(), 6);
    // The numbers of a file that we wrote count, whatever the state of the mesh: here, it is flat.
    let path = folder.path().join("ours.obj");
    write_obj(&path, &hard.view()).unwrap();
    assert_eq!(read_obj_surface(&path).unwrap().as_ref(), Some(surface(&hard)));
}

#[test]
fn normals_follow_the_shape_and_hard_edges_stay_hard() {
    let folder = folder();
    let hinge = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvn 0 0 1\nvn 1 0 0\n";
    let bend = |mesh: &Mesh| {
        let mut positions = mesh.positions.clone();
        positions[1] = Point::new(1.0, 0.0, -1.0);
        surface(mesh).corner_normals(&positions)
    };
    // Smooth: one normal at each end of the edge from 0 to 2.
    let soft = bend(&read(&folder, &format!("{hinge}f 1//1 2//1 3//1\nf 1//1 3//1 4//1\n")));
    assert_eq!((soft[0], soft[2]), (soft[3], soft[4]));
    assert!((soft[0].norm() - 1.0).abs() < 1e-12 && soft[0].z < 1.0 && soft[0].z > soft[1].z);
    let hard = bend(&read(&folder, &format!("{hinge}f 1//1 2//1 3//1\nf 1//2 3//2 4//2\n")));
    assert_eq!((hard[3], hard[4], hard[5]), (Vector::z(), Vector::z(), Vector::z()));
    assert!((hard[0] - hard[1]).norm() < 1e-12 && (hard[0] - hard[3]).norm() > 0.5);
    // Corners without a normal have that of their polygon; a polygon without area the z axis.
    let flat = bend(&read(&folder, &format!("{hinge}f 1 2 3\nf 1//1 3//1 4//1\nf 1 1 1\n")));
    assert!((flat[0] - hard[0]).norm() < 1e-12 && flat[6] == Vector::z());
}

#[test]
fn polygons_fall_into_pieces_around_triangles_that_are_dropped() {
    let folder = folder();
    let mut mesh = read(&folder, GARMENT);
    // The pentagon's middle triangle.
    mesh.retain_triangles(&[true, true, false, true, false, true]);
    assert_eq!(surface(&mesh).triangles().collect::<Vec<_>>(), mesh.triangles);
    let sizes: Vec<usize> = surface(&mesh).polygons().map(|polygon| polygon.corners.len()).collect();
    assert_eq!(sizes, [4, 3, 3]);
    assert_eq!(mesh.drop_unused_vertices(), 1);
    assert_eq!(surface(&mesh).triangles().collect::<Vec<_>>(), mesh.triangles);
    assert_eq!(surface(&mesh).texture_coordinates().len(), 4, "those of the triangle are dropped");
    mesh.retain_triangles(&[false; 4]);
    assert_eq!(mesh.surface, None);
}

#[test]
fn parts_are_put_together_and_taken_apart() {
    let folder = folder();
    let mesh = read(&folder, GARMENT);
    let own = surface(&mesh);
    let mut both = own.clone();
    both.append(own, 10);
    both.name_objects("body");
    assert_eq!((both.len(), both.texture_coordinates().len(), both.normal_count()), (6, 14, 22));
    let part_of: Vec<u32> = (0..20).map(|v| v / 10 * 2).collect();
    let local: Vec<u32> = (0..20).map(|v| v % 10).collect();
    let parts = both.split(&part_of, &local, 3);
    assert_eq!(parts[1], None);
    for part in [&parts[0], &parts[2]] {
        assert_eq!(part.as_ref(), Some(own));
    }
}

#[test]
fn split_triangles_get_texture_coordinates_between_those_of_the_edge() {
    let folder = folder();
    let mut surface = surface(&read(&folder, GARMENT)).clone();
    surface.isolate_triangles(&[true, false, false, false, false, false]);
    assert_eq!(surface.len(), 4);
    // The edge from vertex 1 to 2 of the first triangle, through vertices 9 and 8.
    surface.split_triangles(&[EdgeSplit { triangle: 0, start: 1, through: vec![(9, 0.25), (8, 0.5)] }]);
    let triangles: Vec<[u32; 3]> = surface.triangles().collect();
    assert_eq!(triangles[0], [1, 9, 0]);
    assert_eq!(triangles[triangles.len() - 2..], [[9, 8, 0], [8, 2, 0]]);
    let texture = |corner: &crate::Corner| surface.texture_coordinates()[corner.texture().unwrap() as usize];
    let first = surface.polygons().next().unwrap();
    assert_eq!(first.corners.iter().map(texture).collect::<Vec<_>>(), [[0.5, 0.0], [0.5, 0.125], [0.0, 0.0]]);
    assert_eq!(surface.polygons().last().unwrap().labels.group.as_deref(), Some("front sleeve"));
}

#[test]
fn ply_keeps_polygons_and_the_triangles_that_were_simulated() {
    let folder = folder();
    let mesh = read(&folder, GARMENT);
    let path = folder.path().join("a.ply");
    let header = |mesh: &Mesh| {
        write_ply(&path, &mesh.view()).unwrap();
        assert_eq!(read_ply(&path, &Import::default()).unwrap().triangles, mesh.triangles);
        let bytes = fs::read(&path).unwrap();
        let end = bytes.windows(10).position(|w| w == b"end_header").unwrap();
        String::from_utf8(bytes[..end].to_vec()).unwrap()
    };
    // Vertices 1 and 2 have two texture coordinates each.
    let text = header(&mesh);
    assert!(text.contains("element face 3\n") && !text.contains("double s"), "{text}");
    let seamless = read(&folder, &GARMENT.replace("f 2/5/1 -6/6/2 3/-1/2\n", ""));
    assert!(header(&seamless).contains("property double s\nproperty double t\nelement face 2\n"));
}

#[test]
fn large_polygons_stay_the_same_fans_in_a_ply() {
    let folder = folder();
    let path = folder.path().join("a.ply");
    for count in [254, 255, 256, 257, 508, 509, 510, 1000] {
        let vertices: String = (0..count).map(|k| format!("v {k} {} 0\n", k * k)).collect();
        let corners: String = (1..=count).map(|k| format!(" {k}")).collect();
        let mesh = read(&folder, &format!("{vertices}f{corners}\n"));
        write_ply(&path, &mesh.view()).unwrap();
        let again = read_ply(&path, &Import::default()).unwrap();
        assert_eq!(again.triangles, mesh.triangles, "{count} corners");
    }
}

#[test]
fn stages_hold_texture_coordinates_normals_and_subsets() {
    let folder = folder();
    let path = folder.path().join("a.usda");
    let mesh = read(&folder, GARMENT);
    let body = |name| crate::UsdBody { name, elements: mesh.view(), obstacle: false, width: 0.1 };
    write_usda(&path, &[body("Shirt"), body("Materials")], 2, 25.0, |_, _| Ok(mesh.positions.clone()))
        .unwrap();
    let text = fs::read_to_string(&path).unwrap();
    for line in [
        "        int[] faceVertexCounts = [4, 3, 5]",
        "        int[] primvars:st:indices = [0, 1, 2, 3, 4, 5, 6, 7, 7, 7, 7, 7]",
        "            interpolation = \"faceVarying\"",
        "        normal3f[] normals.timeSamples = {",
        "        uniform token subsetFamily:materialBind:familyType = \"nonOverlapping\"",
        "        def GeomSubset \"Silk__1\" (",
        "            displayName = \"Silk #1\"",
        "            rel material:binding = </World/Materials_2/Silk__1>",
        "            int[] indices = [1, 2]",
        "        def GeomSubset \"sleeve\"",
        "    def Scope \"Materials_2\"",
    ] {
        assert!(text.lines().any(|l| l == line), "{line:?} is missing in\n{text}");
    }
    assert_eq!(text.matches("def Material \"").count(), 2);
    assert_eq!(text.matches("familyName = \"object\"").count(), 1, "Shirt is all of the body Shirt");
}
