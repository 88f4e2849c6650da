//! Commands that read the folder of a run end with a message, whatever its files hold: without a panic, in
//! time, and within a limit on memory.
//!
//! `BOWKNOT_SEEDS=200` tries a hundred times as many damages as CI does. A folder that brings a command down
//! is kept, and its path is printed.

use crate::{Ended, Place};
use std::fs;
use std::path::Path;
use std::process::Command;

#[path = "../../../../tests/src/fuzz/mutate.rs"]
mod mutate;

/// Address space that a command may use [kB]: drivers of pictures map gigabytes, but touch little of them.
const MEMORY: &str = "6000000";
/// Time for a command [s]; `timeout` ends it with code 124.
const SECONDS: &str = "60";

/// Every kind of body, a half-space, records and statistics.
const SCENE: &str = r#"
[simulation]
dt = 0.01
frames = 2
[[body]]
shape = { type = "sheet", size = [0.4, 0.4], edge = 0.2 }
translate = [0.0, 0.0, 0.3]
[[body]]
kind = "strands"
shape = { type = "woven", count = [2, 2], spacing = 0.05, segments = 3 }
translate = [0.0, 0.0, 0.6]
[[body]]
kind = "particles"
shape = { type = "grains", count = [2, 2, 1], spacing = 0.05 }
translate = [0.0, 0.0, 0.9]
[[obstacle]]
shape = { type = "half-space" }
[output]
record = true
"#;

/// What is damaged.
const FILES: [&str; 7] = [
    "scene.toml",
    "stats.jsonl",
    "summary.json",
    "frames/000000.ply",
    "frames/000001.ply",
    "frames/000002.ply",
    "states/000001_00.npz",
];

/// Commands on the folder `run`.
const COMMANDS: [&str; 8] = [
    "render run --out picture.png --size 64x48 --quiet",
    "render run --out picture.png --size 64x48 --color gap --quiet",
    "report run --out page.html",
    "render run --out picture.png --size 64x48 --color remaining --quiet",
    "check run",
    "export run --format vtu --format usd --out exported",
    "render run --out picture.png --size 64x48 --color stretch --frame 1 --quiet",
    "run run/scene.toml --out run --resume --frames 3 --quiet",
];

fn seeds() -> usize {
    std::env::var("BOWKNOT_SEEDS").ok().and_then(|text| text.parse().ok()).unwrap_or(2)
}

fn copy(from: &Path, to: &Path) {
    fs::create_dir_all(to).unwrap();
    for entry in fs::read_dir(from).unwrap() {
        let entry = entry.unwrap();
        let target = to.join(entry.file_name());
        if entry.path().is_dir() {
            copy(&entry.path(), &target);
        } else {
            fs::copy(entry.path(), target).unwrap();
        }
    }
}

/// The command within the limits.
fn limited(place: &Place, words: &str) -> Ended {
    let mut command = Command::new("sh");
    command.args(["-c", "ulimit -v \"$1\"; shift; exec timeout \"$@\"", "sh", MEMORY, SECONDS]);
    command.arg(env!("CARGO_BIN_EXE_bowknot")).args(words.split_whitespace()).current_dir(place.0.path());
    let output = command.output().unwrap();
    Ended {
        words: words.to_owned(),
        code: output.status.code().unwrap_or(-1),
        stdout: String::from_utf8_lossy(&output.stdout).into_owned(),
        stderr: String::from_utf8_lossy(&output.stderr).into_owned(),
    }
}

#[test]
fn damaged_runs_are_read_or_refused() {
    let place = Place::new();
    place.write("scene.toml", SCENE);
    place.run("run scene.toml --out sound").ok();
    let sound = |name: &str| fs::read(place.path("sound").join(name)).unwrap();
    let mut state = 1u64;
    let mut below = |end: usize| {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        ((state >> 33) as usize) % end.max(1)
    };
    let run = place.path("run");
    let mut commands = Vec::new();
    for words in COMMANDS {
        copy(&place.path("sound"), &run);
        let ended = limited(&place, words);
        // Without a driver there are no pictures; the readers before it are then not tried by these commands.
        if ended.code == 3 || ended.stderr.contains("unrecognized subcommand") {
            eprintln!("skipped: {words}: {}", ended.stderr.trim());
        } else {
            commands.push(words);
            ended.ok();
        }
        fs::remove_dir_all(&run).unwrap();
    }
    let (mut taken, mut refused) = (0, 0);
    for round in 0..16 * seeds() {
        let words = commands[round % commands.len()];
        copy(&place.path("sound"), &run);
        let (file, other) = (FILES[below(FILES.len())], FILES[below(FILES.len())]);
        fs::write(run.join(file), mutate::mutate(&sound(file), &sound(other), &mut below)).unwrap();
        let ended = limited(&place, words);
        let panicked = ended.stderr.contains("panicked") || ended.stderr.contains("internal error");
        if ![0, 1, 2].contains(&ended.code)
            || panicked
            || (ended.code == 2) != ended.stderr.contains("error: ")
        {
            let kept = place.0.keep();
            panic!("{words}, with damage to {file}, kept in {}: {ended:#?}", kept.display());
        }
        if ended.code == 2 {
            refused += 1
        } else {
            taken += 1
        }
        fs::remove_dir_all(&run).unwrap();
    }
    eprintln!("{} damaged runs: {taken} taken, {refused} refused", taken + refused);
    assert!(taken > 0 && refused > 0, "{taken} taken, {refused} refused");
}

/// A file whose name is a large number is one frame, not the last of as many.
#[test]
fn a_frame_of_a_large_number_is_one_frame() {
    let place = Place::new();
    place.write("scene.toml", SCENE);
    place.run("run scene.toml --out run").ok();
    fs::copy(place.path("run/frames/000002.ply"), place.path("run/frames/9007199254740993.ply")).unwrap();
    let ended = limited(&place, "render run --out pictures --size 64x48 --quiet");
    if ended.code == 3 || ended.stderr.contains("unrecognized subcommand") {
        eprintln!("skipped: {}", ended.stderr.trim());
        return;
    }
    ended.refused(2, &["run has no frame 3"]);
}
