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
