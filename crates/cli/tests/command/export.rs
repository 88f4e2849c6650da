use crate::{Place, SMALL};

#[test]
fn a_run_in_every_format() {
    let place = Place::new();
    place.run(&format!("{SMALL} --out run --format ply,obj,npz,pc2,usd,vtu")).ok();
    place.run(&format!("{SMALL} --out plain")).ok();
    let ended = place.run("export plain --format obj,npz,pc2,usd,vtu --out there").ok();
    assert!(ended.stdout.contains("exported 4 frames of") && ended.stdout.contains("to there"), "{ended:#?}");
    assert_eq!(place.files("there"), ["frames", "frames.npz", "frames.pvd", "pc2", "scene.usda"]);
    assert_eq!(place.files("run/frames").len(), 3 * 4);
    // Half-spaces are quads in a run, and two triangles in what a PLY reader makes of it; all else is the
    // same.
    for file in ["frames.pvd", "pc2/sheet.pc2", "pc2/sheet.obj", "pc2/ball.pc2", "pc2/ground.pc2"] {
        let bytes = |folder: &str| std::fs::read(place.path(&format!("{folder}/{file}"))).unwrap();
        assert!(bytes("run") == bytes("there"), "{file} differs");
    }
    let stage = place.read("there/scene.usda");
    for line in ["upAxis = \"Z\"", "endTimeCode = 3", "def Mesh \"sheet\"", "def Mesh \"ground\""] {
        assert!(stage.contains(line), "{line:?} is missing");
    }
    // Into the run's own folder, and from the archive.
    place.run("export plain --format vtu").ok();
    assert_eq!(place.files("plain/frames").len(), 2 * 4);
    place.run("export there/frames.npz --format ply --dt 0.01 --out again").ok();
    assert_eq!(place.files("again/frames").len(), 4);
    place.run("check again").ok();
}

/// A sheet of two quads, a hexagon and a triangle, with a seam in the texture, groups, materials and a hard
/// edge.
const GARMENT: &str = "mtllib cloth.mtl\no Garment\n\
    v 0 0 1\nv 1 0 1\nv 2 0 1\nv 2 1 1\nv 1 1 1\nv 0 1 1\nv 3 0.5 1\nv 0 2 1\nv 1 3 1\nv 2 2 1\nv 9 9 9\n\
    vt 0 0\nvt 0.4 0\nvt 0.4 0.4\nvt 0 0.4\nvt 0.6 0\nvt 1 0\nvt 1 0.4\nvt 0.6 0.4\nvn 0 0 1\nvn 0 1 0\n\
    g left all\nusemtl silk\ns 1\nf 1/1/1 2/2/1 5/3/1 6/4/1\n\
    g right all\nusemtl wool #2\nf 2/5/1 3/6/1 4/7/1 5/8/1\nf 3/6/2 7/7/2 4/8/2\n\
    g back\ns off\nf 9 8 6 5 4 10\n";

#[test]
fn an_obj_comes_back_with_what_it_says_about_its_faces() {
    let place = Place::new();
    place.write("garment.obj", GARMENT);
    place.run("run garment.obj --frames 3 --out run --format ply,obj,npz,pc2,usd").ok();
    place.run("run garment.obj --frames 3 --out plain").ok();
    place.run("export plain --format obj,npz,pc2,usd").ok();
    for file in ["frames/000000.obj", "frames/000003.obj", "frames.npz", "pc2/body.obj", "scene.usda"] {
        let bytes = |folder: &str| std::fs::read(place.path(&format!("{folder}/{file}"))).unwrap();
        assert!(bytes("run") == bytes("plain"), "{file} differs");
    }
    let frame = place.read("run/frames/000003.obj");
    assert!(frame.contains("\nmtllib ../../cloth.mtl\n"), "{frame}");
    // The vertex that no face names is left out. Vertex 4 has a normal on either side of the hard edge.
    let faces: Vec<&str> = frame.lines().skip_while(|line| *line != "o Garment").take(13).collect();
    let expected = [
        ["o Garment", "g left all", "usemtl silk", "s 1", "f 1/1/1 2/2/2 5/3/3 6/4/4"].as_slice(),
        &["g right all", "usemtl wool #2", "f 2/5/2 3/6/5 4/7/6 5/8/3", "f 3/6/7 7/7/8 4/8/9"],
        &["g back", "s off", "f 9 8 6 5 4 10", "o ball"],
    ];
    assert_eq!(faces, expected.concat());
    assert_eq!(frame.lines().last().map(|line| line.split(' ').count()), Some(5), "the ground is a quad");
    // Names of the garment are not those of the ball.
    let ball = frame.split("o ball\n").nth(1).unwrap();
    assert!(
        ball.starts_with("# nameless\ng default\n# nameless\nusemtl default\n# nameless\ns off\nf "),
        "{ball}"
    );

    let stage = place.read("run/scene.usda");
    for words in ["faceVertexCounts = [4, 4, 3, 6]", "texCoord2f[] primvars:st", "normals.timeSamples"] {
        assert_eq!(stage.matches(words).count(), 1, "{words}");
    }
    assert!(stage.contains("rel material:binding = </World/Materials/wool__2>"));
    assert_eq!(stage.matches("def Material ").count(), 2);
    // Other commands read the triangles that were simulated.
    place.run("check run plain").ok();
    place.run("report run --out report.html").ok();
    place.run("run garment.obj --frames 2 --out resumed --format obj,usd").ok();
    place.run("run garment.obj --frames 3 --out resumed --format obj,usd --resume").ok();
    for file in ["frames/000003.obj", "scene.usda"] {
        assert_eq!(place.read(&format!("resumed/{file}")), place.read(&format!("run/{file}")), "{file}");
    }
    // From OBJ frames alone, bodies are not told apart, but faces are what they were.
    std::fs::remove_dir_all(place.path("resumed/surface")).unwrap();
    place.run("export resumed --format ply,usd --out again").ok();
    assert!(place.read("again/scene.usda").contains("faceVertexCounts = [4, 4, 3, 6, 3"));
    place.run("check again").ok();
    // A run of a mesh of plain triangles has no such folder.
    place.run(&format!("{SMALL} --out drape")).ok();
    assert!(!place.path("drape/surface").exists());
}

#[test]
fn what_cannot_be_exported() {
    let place = Place::new();
    place.run(&format!("{SMALL} --out run")).ok();
    place.run("export run").refused(2, &["--format"]);
    place.run("export run --format stl").refused(2, &["stl", "usd", "vtu"]);
    place.run("export run --format ply").refused(2, &["run", "already", "--out"]);
    place.run("export none --format usd --dt 0.01").refused(2, &["none", "no such file"]);
    std::fs::create_dir(place.path("empty")).unwrap();
    place.run("export empty --format usd --dt 0.01").refused(2, &["empty", "no frames"]);
    place.run("export empty --format usd --dt 0").refused(2, &["--dt", "above 0"]);
    std::fs::create_dir(place.path("loose")).unwrap();
    place.write("loose/1.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    place.run("export loose --format usd").refused(2, &["loose", "--dt"]);
    place.run("export loose --format usd --dt 0.04").ok();
    place.write("loose/2.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 3 2 1\n");
    place.run("export loose --format usd --dt 0.04").refused(2, &["loose/2.obj", "differ"]);
    assert!(place.files("loose").iter().all(|name| !name.contains(".part")), "{:?}", place.files("loose"));
    place.write("file", "");
    place.run("export run --format usd --out file/x").refused(2, &["file/x", "not a folder"]);
}
