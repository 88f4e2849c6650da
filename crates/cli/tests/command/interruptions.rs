use crate::{Ended, Place, SMALL};
use std::process::Command;

/// The bytes of the frames of a run.
fn frames(place: &Place, run: &str, count: usize) -> Vec<Vec<u8>> {
    (0..=count).map(|f| std::fs::read(place.path(&format!("{run}/frames/{f:06}.ply"))).unwrap()).collect()
}

#[test]
fn a_resumed_run_has_the_same_bits() {
    let place = Place::new();
    let scene = "run drape --scale 0.16 --set output.checkpoint_every=4";
    place.run(&format!("{scene} --frames 40 --out whole")).ok();
    place.run(&format!("{scene} --frames 25 --out parts")).ok();
    place.run(&format!("{scene} --frames 40 --out parts")).refused(2, &["parts already holds a run"]);
    place.run(&format!("{scene} --frames 40 --out parts --resume")).ok();
    assert!(frames(&place, "whole", 40) == frames(&place, "parts", 40), "the frames differ");
    assert_eq!(place.read("parts/stats.jsonl").lines().count(), 40);
}

#[test]
fn a_renamed_scene_file_is_resumed_and_a_shorter_run_has_nothing_to_do() {
    let place = Place::new();
    let scene =
        "[simulation]\ndt = 0.01\n[[body]]\nshape = { type = \"sheet\", size = [1.0, 1.0], edge = 0.5 }\n";
    place.write("a.toml", scene);
    place.run("run a.toml --frames 4 --out run").ok();
    place.write("b.toml", scene);
    place.run("run b.toml --frames 6 --out run --resume").ok();
    assert_eq!(place.read("run/stats.jsonl").lines().count(), 6);
    let ended = place.run("run b.toml --frames 3 --out run --resume").ok();
    assert!(ended.stdout.contains("nothing to do, 3 frames were asked for and there are 6"), "{ended:#?}");
    place.write("b.toml", scene.replace("0.01", "0.02").replace("edge = 0.5", "edge = 0.25"));
    place
        .run("run b.toml --frames 9 --out run --resume")
        .refused(2, &["simulation.dt (0.01 there, 0.02 here)", "body[0].shape.edge (0.5 there, 0.25 here)"]);
}

#[test]
fn runs_that_cannot_be_resumed() {
    let place = Place::new();
    place.run(&format!("{SMALL} --out none --resume")).refused(2, &["cannot resume none", "no run"]);
    place.run(&format!("{SMALL} --out run")).ok();
    place
        .run(&format!("{SMALL} --out run --resume --dt 0.002"))
        .refused(2, &["cannot resume run", "simulation.dt"]);
    place.write("run/checkpoint/state.npz", "no checkpoint");
    place.run(&format!("{SMALL} --out run --resume")).refused(2, &["state.npz"]);
}

/// A limit on the size of files stands for a full disk: the files written so far stay complete.
#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_leaves_whole_frames() {
    let place = Place::new();
    // Frames stay below the larger limit; `stats.jsonl`, which grows by about a kilobyte per frame, reaches
    // it.
    let script = "trap '' XFSZ; ulimit -f \"$1\"; shift; exec \"$@\"";
    let run = |blocks: &str, out: &str| {
        let words =
            format!("run drape --scale 0.16 --frames 400 --set output.checkpoint_every=400 --out {out}");
        let mut command = Command::new("sh");
        command.args(["-c", script, "sh", blocks, env!("CARGO_BIN_EXE_bowknot")]);
        command.args(words.split_whitespace()).current_dir(place.0.path());
        Ended::new(&words, command.output().unwrap())
    };
    // 512 bytes: not even the first frame.
    run("1", "none").refused(2, &["cannot write none/"]);
    // 32 kB.
    run("64", "some").refused(2, &["cannot write some/stats.jsonl"]);
    let lines = place.read("some/stats.jsonl");
    assert!(lines.ends_with('\n'));
    let steps: Vec<serde_json::Value> =
        lines.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    assert!(steps.len() > 5, "only {} steps before the limit", steps.len());
    assert!(place.files("some/frames").iter().all(|name| name.ends_with(".ply")), "no half-written file");
    place.run("check some/frames").ok();
    // Without the limit the run continues.
    place
        .run(
            "run drape --scale 0.16 --frames 400 --set output.checkpoint_every=400 --out some --resume --set \
               simulation.frames=4",
        )
        .ok();
}
