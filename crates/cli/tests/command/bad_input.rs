use crate::{Place, SMALL};

/// A scene that runs, as the text of its file.
const SCENE: &str = r#"
[simulation]
dt = 0.01
frames = 2

[contact]
delta = 0.001

[[body]]
name = "cloth"
shape = { type = "sheet", size = [0.4, 0.4], edge = 0.1 }
translate = [0.0, 0.0, 1.0]

[[obstacle]]
name = "ground"
shape = { type = "half-space" }
"#;

/// Runs the scene after a replacement and expects it to be refused.
#[track_caller]
fn refused(from: &str, to: &str, says: &[&str]) {
    assert!(SCENE.contains(from), "{from:?} is not in the scene");
    let place = Place::new();
    place.write("scene.toml", SCENE.replacen(from, to, 1));
    place.run("run scene.toml").refused(2, says);
    assert!(!place.path("out").exists(), "nothing is written for a scene that is refused");
}

#[test]
fn the_scene_itself_runs() {
    let place = Place::new();
    place.write("scene.toml", SCENE);
    place.run("run scene.toml").ok();
}

#[test]
fn missing_scene() {
    let place = Place::new();
    place.run("run none.toml").refused(2, &["none.toml", "no such file"]);
    place.run("run drap").refused(2, &["drap", "did you mean drape?"]);
    place.run("info none.toml").refused(2, &["none.toml", "no such file"]);
    std::fs::create_dir(place.path("folder.toml")).unwrap();
    place.run("run folder.toml").refused(2, &["folder.toml"]);
}

#[test]
fn malformed_scene() {
    refused("dt = 0.01", "dt = = 0.01", &["scene.toml:3:", "not TOML"]);
    refused("[simulation]", "[simulation", &["scene.toml:2:", "not TOML"]);
    let place = Place::new();
    place.write("scene.toml", [0xff, 0xfe, 0x00]);
    place.run("run scene.toml").refused(2, &["scene.toml"]);
}

#[test]
fn unknown_key_with_the_nearest() {
    refused("delta", "delt", &["scene.toml:7", "contact.delt", "delta"]);
    refused("frames = 2", "framse = 2", &["scene.toml:4", "framse", "frames"]);
    refused("[contact]", "[contacts]", &["scene.toml:6", "contacts", "contact"]);
    refused("size = ", "sice = ", &["scene.toml:11", "sice", "size"]);
    refused("\"sheet\"", "\"sheat\"", &["scene.toml:11", "sheat", "sheet"]);
    Place::new().run(&format!("{SMALL} --set contact.delt=1")).refused(2, &["contact.delt", "delta"]);
    Place::new().run(&format!("{SMALL} --set contact")).refused(2, &["KEY.PATH=VALUE"]);
}

#[test]
fn wrong_type() {
    refused("dt = 0.01", "dt = \"fast\"", &["scene.toml:3", "simulation.dt", "string"]);
    refused("frames = 2", "frames = 2.5", &["scene.toml:4", "simulation.frames"]);
    refused("[0.4, 0.4]", "[0.4]", &["scene.toml:11", "size"]);
    refused("delta = 0.001", "delta = [1]", &["scene.toml:7", "contact.delta"]);
}

#[test]
fn values_out_of_range() {
    for value in ["0.0", "-1", "nan", "inf"] {
        refused("dt = 0.01", &format!("dt = {value}"), &["scene.toml:3", "simulation.dt"]);
        Place::new().run(&format!("{SMALL} --dt={value}")).refused(2, &["--dt", "finite and above 0"]);
        Place::new().run(&format!("{SMALL} --set simulation.dt={value}")).refused(2, &["simulation.dt"]);
        Place::new()
            .run(&format!("run drape --scale={value}"))
            .refused(2, &["--scale", "finite and above 0"]);
        refused("delta = 0.001", &format!("delta = {value}"), &["scene.toml:7", "delta"]);
    }
    refused("edge = 0.1", "edge = 0.0", &["scene.toml:11", "edge"]);
    refused("edge = 0.1", "edge = 1e-9", &["scene.toml:11", "edge", "vertices"]);
    refused("[0.0, 0.0, 1.0]", "[0.0, nan, 1.0]", &["scene.toml:12", "translate"]);
    Place::new().run("run drape --scale 1000").refused(2, &["scale 1000", "at most"]);
    Place::new().run("run drape --dt x").refused(2, &["--dt", "must be a number"]);
    for threads in ["0", "-1", "x", "100000"] {
        let ended = Place::new().run(&format!("{SMALL} --threads={threads}"));
        ended.refused(2, &["--threads", "whole number from 1"]);
    }
    Place::new().run(&format!("{SMALL} --frames=-1")).refused(2, &["--frames"]);
}

#[test]
fn unknown_options_and_formats() {
    let place = Place::new();
    place.run("run drape --fast").refused(2, &["--fast"]);
    place.run("run drape --format stl").refused(2, &["stl", "ply", "obj", "npz"]);
    place.run("run drape --preset slow").refused(2, &["slow", "fast", "quick", "paper"]);
    place.run("dance").refused(2, &["dance"]);
    place.run("run").refused(2, &["SCENE"]);
    place.write("scene.toml", SCENE);
    place.run("run scene.toml --scale 2").refused(2, &["--scale", "built-in"]);
}

#[test]
fn gpus_that_are_not_there_and_settings_that_they_do_not_have() {
    let place = Place::new();
    place.run(&format!("{SMALL} --backend gpu --device 99")).refused(3, &["no device 99"]);
    place
        .run(&format!("{SMALL} --backend gpu --preset paper"))
        .refused(3, &["contact.form", "--backend cpu", "--preset fast"]);
    place.run(&format!("{SMALL} --device 1")).refused(2, &["--backend gpu"]);
    assert!(!place.path("out").exists());
}

/// A scene of one body or obstacle from a mesh file.
fn with_mesh(place: &Place, table: &str, name: &str, content: impl AsRef<[u8]>) {
    place.write(name, content);
    let body = if table == "body" {
        String::new()
    } else {
        "[[body]]\nshape = { type = \"sheet\", size = [0.4, 0.4], edge = 0.1 }\ntranslate = [0.0, 0.0, 5.0]\n"
            .to_owned()
    };
    place.write("scene.toml", format!("{body}[[{table}]]\nname = \"it\"\nmesh = \"{name}\"\n"));
}

const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\nf 2 4 3\n";

#[test]
fn meshes_that_cannot_be_read() {
    let place = Place::new();
    with_mesh(&place, "body", "square.obj", SQUARE);
    place.run("run scene.toml --frames 1").ok();
    place.write("scene.toml", "[[body]]\nmesh = \"none.obj\"\n");
    place.run("run scene.toml").refused(2, &["none.obj", "no such file"]);
    place.run("run none.obj").refused(2, &["none.obj", "no such file"]);
    place.run("info none.ply").refused(2, &["none.ply", "no such file"]);
    for (content, says) in [
        ("", "no vertices"),
        ("v 0 0 0\nv 1 0 zero\n", "mesh.obj:2: 'zero' is not a number"),
        ("v 0 0 0\nv 1 0 nan\n", "mesh.obj:2: coordinate nan is not finite"),
        ("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n", "mesh.obj:4: vertex index 9, but the file has 3 vertices"),
    ] {
        with_mesh(&place, "body", "mesh.obj", content);
        place.run("run scene.toml").refused(2, &[says]);
        place.run("run mesh.obj").refused(2, &[says]);
    }
    let ply = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float \
               z\n\
               element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n";
    with_mesh(&place, "body", "mesh.ply", ply);
    place.run("run scene.toml").refused(2, &["mesh.ply", "truncated"]);
    with_mesh(&place, "body", "mesh.xyz", "solid");
    place.run("run scene.toml").refused(2, &["mesh.xyz", "only .obj, .ply"]);
}

#[test]
fn degenerate_triangles_of_a_body() {
    let place = Place::new();
    let zero_area = format!("{SQUARE}v 0.5 0 0\nf 1 5 2\n");
    with_mesh(&place, "body", "mesh.obj", zero_area);
    place.run("run scene.toml").refused(2, &["body it", "triangle 2", "area"]);
    with_mesh(&place, "body", "mesh.obj", format!("{SQUARE}f 3 1 2\n"));
    place.run("run scene.toml").refused(2, &["body it", "triangle 2", "triangle 0"]);
    with_mesh(&place, "body", "mesh.obj", format!("{SQUARE}f 1 2 2\n"));
    place.run("run scene.toml").refused(2, &["body it", "triangle 2"]);
}

#[test]
fn degenerate_triangles_of_an_obstacle_are_dropped() {
    let place = Place::new();
    with_mesh(&place, "obstacle", "mesh.obj", format!("{SQUARE}v 0.5 0 0\nf 1 5 2\nf 3 1 2\nf 1 2 2\n"));
    let ended = place.run("run scene.toml --frames 1").ok();
    assert!(ended.stderr.contains("WARN") && ended.stderr.contains("obstacle it"), "{ended:#?}");
    let quiet = place.run("run scene.toml --frames 1 --out quiet --quiet").ok();
    assert_eq!(quiet.stderr, "");
}

#[test]
fn a_body_without_mass() {
    refused("translate", "material = { density = 0.0 }\ntranslate", &["scene.toml:12", "density", "above 0"]);
}

#[test]
fn an_empty_scene() {
    let place = Place::new();
    place.write("scene.toml", "");
    place.run("run scene.toml").refused(2, &["empty", "[[body]]"]);
    with_mesh(&place, "body", "points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n");
    place.run("run scene.toml").refused(2, &["body it"]);
}

#[test]
fn a_start_that_intersects() {
    let place = Place::new();
    let sheet = "shape = { type = \"sheet\", size = [0.4, 0.4], edge = 0.05 }";
    place.write(
        "scene.toml",
        format!(
            "[[body]]\nname = \"left\"\n{sheet}\n\
             [[body]]\nname = \"right\"\n{sheet}\nrotate = [80.0, 10.0, 0.0]\n\
             [[obstacle]]\nname = \"ground\"\nshape = {{ type = \"half-space\" }}\ntranslate = [0.0, 0.0, \
             -1.0]\n"
        ),
    );
    let says = [
        "already intersects",
        "left",
        "right",
        "edge (vertices",
        "triangle (vertices",
        " at (",
        "more pairs",
    ];
    place.run("run scene.toml").refused(2, &says);
    assert!(!place.path("out").exists());
    for name in ["dump.ply", "dump.obj"] {
        let ended = place.run(&format!("run scene.toml --dump {name}"));
        ended.refused(2, &["already intersects", &format!("triangles to {name}")]);
        let info = place.run(&format!("info {name} --json")).ok().json();
        assert!(info["triangles"].as_u64().unwrap() >= 2, "{info}");
        place.run(&format!("check {name}")).refused(1, &[]);
    }
    place.run("run scene.toml --dump none/dump.ply").refused(2, &["already intersects", "none/dump.ply"]);
}

#[test]
fn a_start_below_the_ground() {
    refused("[0.0, 0.0, 1.0]", "[0.0, 0.0, -1.0]", &["already intersects", "cloth", "ground"]);
}

#[test]
fn coordinates_beyond_rounding() {
    let place = Place::new();
    place.write("scene.toml", SCENE.replace("[0.0, 0.0, 1.0]", "[1e12, 0.0, 1.0]"));
    place
        .run("run scene.toml")
        .refused(2, &["body cloth", "16 ulp", "minimum separation", "closer to the origin"]);
    assert!(!place.path("out").exists());
}

/// Motions are known from the beginning: the run was refused at the time step that they took too far.
#[test]
fn motions_beyond_rounding_are_refused_before_anything_is_written() {
    let place = Place::new();
    let ball =
        "[[obstacle]]\nname = \"ball\"\nshape = { type = \"ball\", radius = 0.1, edge = 0.05 }\nmotion = ";
    let far = "{ keyframes = [{ time = 0.01 }, { time = 0.02, translate = [1e13, 0.0, 0.0] }] }";
    let pin = "[[pin]]\nbody = \"cloth\"\nvertices = [0]\nmotion = ";
    for (what, start) in [("ball", ball), ("cloth", pin)] {
        place.write("scene.toml", format!("{SCENE}{start}{far}\n"));
        let body = format!("body {what}");
        place.run("run scene.toml").refused(2, &["time step 2", &body, "16 ulp", "closer to the origin"]);
        assert!(!place.path("out").exists(), "{what}");
        // What lies beyond the end of the run is of no matter.
        place.run(&format!("run scene.toml --frames 1 --out near-{what}")).ok();
    }
}

#[test]
fn an_output_folder_that_cannot_be_used() {
    let place = Place::new();
    place.write("file", "");
    place.run(&format!("{SMALL} --out file/below")).refused(2, &["cannot create file/below", "not a folder"]);
    place.run(&format!("{SMALL} --out file")).refused(2, &["file"]);
    place.run(&format!("{SMALL} --out mine")).ok();
    let frame = std::fs::read(place.path("mine/frames/000003.ply")).unwrap();
    place
        .run(&format!("{SMALL} --out mine --dt 0.002"))
        .refused(2, &["mine already holds a run", "--resume", "--out"]);
    assert_eq!(std::fs::read(place.path("mine/frames/000003.ply")).unwrap(), frame, "nothing is lost");
}

/// The same of a body of this kind.
fn with_body(place: &Place, kind: &str, name: &str, content: impl AsRef<[u8]>) {
    with_mesh(place, "body", name, content);
    place.write("scene.toml", place.read("scene.toml") + &format!("kind = \"{kind}\"\n"));
}

/// Two tetrahedra that share a face as Gmsh writes them, the second in this order.
fn two_tetrahedra(second: &str, tip: &str) -> String {
    format!(
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n5\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 \
         {tip}\n$EndNodes\n\
         $Elements\n2\n1 4 2 0 1 1 2 3 4\n2 4 2 0 1 {second}\n$EndElements\n"
    )
}

#[test]
fn tetrahedra_that_overlap_or_are_flat_are_listed_and_their_handedness_does_not_matter() {
    let place = Place::new();
    with_body(&place, "solid", "mesh.msh", two_tetrahedra("1 3 2 5", "0 0 -1"));
    place.run("run scene.toml --frames 1").ok();
    with_body(&place, "solid", "mesh.msh", two_tetrahedra("1 2 3 5", "0 0 -1"));
    let ended = place.run("run scene.toml --frames 1 --out again").ok();
    let warning =
        "1 of 2 tetrahedra had their vertices in the opposite order and have been renumbered, the first is 1";
    assert!(ended.stderr.contains(warning), "{ended:#?}");
    with_body(&place, "solid", "mesh.msh", two_tetrahedra("1 2 3 5", "0 0 2"));
    place
        .run("run scene.toml")
        .refused(2, &["body it", "of 2 tetrahedra, 1 on the same side of a face as another: 1"]);
    with_body(&place, "solid", "mesh.msh", two_tetrahedra("1 2 3 5", "0.5 0.5 0"));
    place.run("run scene.toml").refused(2, &["body it", "of 2 tetrahedra, 1 flat: 1"]);
}

#[test]
fn a_strand_with_repeated_points() {
    let place = Place::new();
    with_body(&place, "strands", "lock.obj", "v 0 0 0\nv 0 0 0\nv 0 0 1\nl 1 2 3\n");
    place
        .run("run scene.toml")
        .refused(2, &["body it", "edge 0 joins vertices 0 and 1", "merge repeated points"]);
}

#[test]
fn a_sequence_that_changes_its_topology() {
    let place = Place::new();
    with_mesh(&place, "obstacle", "none.obj", "");
    let scene = place.read("scene.toml").replace("mesh = \"none.obj\"", "sequence = \"walk\"");
    place.write("scene.toml", scene);
    place.run("run scene.toml").refused(2, &["walk"]);
    std::fs::create_dir(place.path("walk")).unwrap();
    place.write("walk/000.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    place.run("run scene.toml --frames 1").ok();
    place.write("walk/001.obj", SQUARE);
    place.run("run scene.toml").refused(2, &["001.obj", "4 vertices, not 3", "another topology"]);
}

#[test]
fn kinds_and_friction() {
    refused("translate", "kind = \"jelly\"\ntranslate", &["scene.toml:12", "jelly", "cloth", "solid"]);
    refused("translate", "friction = -0.1\ntranslate", &["scene.toml:12", "friction", "-0.1", "at least 0"]);
}
