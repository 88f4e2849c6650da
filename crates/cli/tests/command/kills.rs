//! Runs that are killed at random moments.
//!
//! `BOWKNOT_KILLS=200 cargo test --release -p bowknot-cli --test command kills` kills 200 times; `cargo xtask
//! faults --kills 200` does so and prints the count.

use crate::Place;
use std::fs;
use std::os::unix::process::ExitStatusExt;
use std::path::Path;
use std::process::Stdio;
use std::time::{Duration, Instant, SystemTime};

const FRAMES: usize = 60;
/// Every format, so that every kind of file is cut; contact from about the twentieth frame on.
const WORDS: &str = "run drape --scale 0.16 --frames 60 --quiet --set output.checkpoint_every=3 \
    --set output.formats=[\"ply\",\"npz\",\"pc2\",\"usd\"] --set body.0.velocity=[0,0,-2]";
/// Kills of one run before it is left alone. It gets a fourth of a run further with each on average.
const KILLS_OF_A_RUN: usize = 8;

fn wanted() -> usize {
    std::env::var("BOWKNOT_KILLS").ok().and_then(|text| text.parse().ok()).unwrap_or(5)
}

/// Random delays. The moment of a kill cannot be repeated anyway, so the seed is the time.
struct Delays(u64);

impl Delays {
    fn new() -> Self {
        let time = SystemTime::now().duration_since(SystemTime::UNIX_EPOCH).unwrap();
        Self(time.as_nanos() as u64 | 1)
    }

    /// Below `longest`, half of them within its first fifth: starts are where files come into being.
    fn next(&mut self, longest: Duration) -> Duration {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        let share = (self.0 >> 12) as f64 / (1u64 << 52) as f64;
        longest.mul_f64(if self.0.is_multiple_of(2) { 0.2 * share } else { share })
    }
}

/// Every frame that is there is that of the run that was never killed.
fn check_frames(cut: &Path, whole: &Path) -> usize {
    let Ok(entries) = fs::read_dir(cut.join("frames")) else { return 0 };
    let mut frames = 0;
    for entry in entries {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        if name.ends_with(".ply") {
            let same = fs::read(&path).unwrap() == fs::read(whole.join("frames").join(&name)).unwrap();
            assert!(same, "{name} is torn or another one");
            frames += 1;
        }
    }
    frames
}

/// All files below a folder but those that hold times, by their paths.
fn files(folder: &Path, below: &str) -> Vec<String> {
    let mut names = Vec::new();
    for entry in fs::read_dir(folder.join(below)).unwrap() {
        let entry = entry.unwrap();
        let name = format!("{below}{}", entry.file_name().to_string_lossy());
        if entry.path().is_dir() {
            names.extend(files(folder, &format!("{name}/")));
        } else if !["stats.jsonl", "summary.json", "checkpoint/lock"].contains(&name.as_str()) {
            names.push(name);
        }
    }
    names.sort();
    names
}

#[test]
fn a_killed_run_resumes_to_the_same_bits() {
    let place = Place::new();
    let started = Instant::now();
    place.run(&format!("{WORDS} --out whole")).ok();
    let longest = started.elapsed();
    let whole = place.path("whole");
    let expected = files(&whole, "");
    let mut delays = Delays::new();
    let (mut kills, mut runs, mut torn_ends) = (0, 0, 0);
    while kills < wanted() {
        let cut = place.path("cut");
        let mut of_this_run = 0;
        loop {
            // A run that was killed before it took the folder is begun anew.
            let resume = if cut.join("checkpoint/lock").exists() { " --resume" } else { "" };
            let words = format!("{WORDS} --out cut{resume}");
            if of_this_run == KILLS_OF_A_RUN || kills == wanted() {
                place.run(&words).ok();
                break;
            }
            let mut child =
                place.command(&words).stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap();
            std::thread::sleep(delays.next(longest));
            child.kill().unwrap();
            let ended = child.wait_with_output().unwrap();
            if ended.status.code().is_some() {
                let error = String::from_utf8_lossy(&ended.stderr);
                assert!(ended.status.success(), "after {of_this_run} kills: {error}");
                break;
            }
            assert_eq!(ended.status.signal(), Some(9));
            (kills, of_this_run) = (kills + 1, of_this_run + 1);
            let frames = check_frames(&cut, &whole);
            torn_ends += usize::from(frames > 0 && frames <= FRAMES);
        }
        assert_eq!(files(&cut, ""), expected, "files are missing or left over");
        for name in &expected {
            // The checkpoint before the last may be of another time step.
            let same = name == "checkpoint/previous.npz"
                || fs::read(cut.join(name)).unwrap() == fs::read(whole.join(name)).unwrap();
            assert!(same, "{name} differs after {of_this_run} kills");
        }
        let steps = place.read("cut/stats.jsonl");
        let steps = steps.lines().map(|line| serde_json::from_str::<serde_json::Value>(line).unwrap());
        let steps: Vec<u64> = steps.map(|line| line["step"].as_u64().unwrap()).collect();
        assert!(steps.iter().copied().eq(1..=FRAMES as u64), "{steps:?}");
        fs::remove_dir_all(&cut).unwrap();
        runs += 1;
    }
    eprintln!(
        "{kills} kills of {runs} runs, {torn_ends} of them after the first frame: every run ended with the \
         same bits"
    );
}
