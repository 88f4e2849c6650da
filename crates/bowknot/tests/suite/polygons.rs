//! Concave polygons are what their outlines are: as obstacles, as cloth, and in exports.

use bowknot::io::{Import, read_mesh};
use bowknot::run::{Progress, RunOptions, run};
use bowknot::{Scene, Simulator};
use std::fs;
use std::ops::ControlFlow;
use std::path::Path;

/// A channel along z with the profile of a C, open towards x: no corner of its end faces sees all others.
const CHANNEL: [[f64; 2]; 8] = [
    [-0.2, -0.15],
    [0.1, -0.15],
    [0.1, -0.05],
    [-0.1, -0.05],
    [-0.1, 0.05],
    [0.1, 0.05],
    [0.1, 0.15],
    [-0.2, 0.15],
];

fn write_channel(folder: &Path) {
    let at = |z: f64| CHANNEL.map(|[x, y]| format!("v {x} {y} {z}\n")).concat();
    let side = |k: usize| format!("f {} {} {} {}\n", k, k % 8 + 1, k % 8 + 9, k + 8);
    let sides: String = (1..=8).map(side).collect();
    let ends = "f 8 7 6 5 4 3 2 1\nf 9 10 11 12 13 14 15 16\n";
    fs::write(folder.join("channel.obj"), at(0.0) + &at(0.3) + ends + &sides).expect("writes");
}

#[test]
fn a_grain_falls_through_the_open_side_of_a_channel() {
    let folder = tempfile::tempdir().expect("a folder");
    write_channel(folder.path());
    fs::write(folder.path().join("grain.obj"), "v 0 0 0.35\nv 0.05 0.1 0.35\np 1 2\n").expect("writes");
    let text = r#"
        [[body]]
        name = "grains"
        kind = "particles"
        mesh = "grain.obj"
        material = { base = "sand", radius = 0.005 }

        [[obstacle]]
        name = "channel"
        mesh = "channel.obj"
    "#;
    let scene = Scene::from_toml(text, folder.path()).expect("a scene");
    let mut simulator = Simulator::new(&scene).expect("a start without intersections");
    for _ in 0..30 {
        simulator.step().expect("a step");
    }
    let [through, held] = [0, 1].map(|grain| simulator.positions()[grain].z);
    assert!(through < -0.03, "the one above the opening is at {through} m");
    assert!((0.3..0.32).contains(&held), "the one above the profile is at {held} m");
}

#[test]
fn a_concave_polygon_is_cloth_and_comes_back_whole_where_a_fan_fills_it() {
    let folder = tempfile::tempdir().expect("a folder");
    let dart = "v 0 0 0\nv 1 0.4 0\nv 2 0 0\nv 1 2 0\nf 1 2 3 4\n";
    fs::write(folder.path().join("dart.obj"), dart).expect("writes");
    let text = r#"
        simulation = { frames = 2 }
        output = { formats = ["obj", "ply"] }
        body = [{ name = "dart", mesh = "dart.obj" }]
    "#;
    let scene = Scene::from_toml(text, folder.path()).expect("a scene");
    let out = folder.path().join("run");
    run(&scene, &RunOptions { out: out.clone(), ..RunOptions::default() }, &mut |_: &Progress<'_>| {
        ControlFlow::Continue(())
    })
    .expect("runs");
    for name in ["frames/000002.obj", "frames/000002.ply"] {
        let mesh = read_mesh(&out.join(name), &Import::default()).expect("a frame");
        assert_eq!(mesh.triangles, [[1, 2, 3], [1, 3, 0]], "{name}");
        assert_eq!(mesh.surface.map(|surface| surface.len()), Some(1), "{name}");
    }
}
