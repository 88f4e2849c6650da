//! `cargo xtask hashes`: a hash of the frames of each built-in scene.
//!
//! A change of form alone must not change a bit of any result. To show it, run the command before and after
//! the change, on the same machine, and compare what it prints:
//!
//! ```sh
//! cargo xtask hashes > before.txt
//! # ... the change ...
//! cargo xtask hashes | diff before.txt -
//! ```
//!
//! Each scene runs on one thread at a small scale, as long as it takes to come to its contacts.

use crate::bowknot;
use std::fs::File;
use std::io::{self, Read};
use std::num::NonZero;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc;
use std::thread;

/// How a scene is run.
struct Scene {
    name: &'static str,
    /// `--scale` of the run.
    scale: &'static str,
    /// `--frames` of the run.
    frames: &'static str,
}

/// Every built-in scene, in the order of `bowknot scenes`.
const SCENES: &[Scene] = &[
    Scene { name: "drape", scale: "0.5", frames: "60" },
    Scene { name: "needle", scale: "0.3", frames: "40" },
    Scene { name: "stack", scale: "0.2", frames: "120" },
    Scene { name: "sphere", scale: "0.15", frames: "120" },
    Scene { name: "tube", scale: "0.25", frames: "100" },
    Scene { name: "dress", scale: "0.15", frames: "120" },
    Scene { name: "gown", scale: "0.15", frames: "120" },
    Scene { name: "blade", scale: "0.15", frames: "60" },
    Scene { name: "funnel", scale: "0.2", frames: "80" },
    Scene { name: "bow-knot", scale: "0.15", frames: "150" },
    Scene { name: "reef-knot", scale: "0.25", frames: "150" },
    Scene { name: "mat", scale: "0.2", frames: "220" },
    Scene { name: "hair", scale: "0.1", frames: "150" },
    Scene { name: "sand", scale: "0.15", frames: "120" },
    Scene { name: "trampoline", scale: "0.6", frames: "100" },
    Scene { name: "cards", scale: "1", frames: "200" },
    Scene { name: "woven", scale: "1", frames: "120" },
];

/// What the command line asks for.
pub struct Options {
    scenes: Vec<&'static Scene>,
    /// Number of scenes that run at the same time.
    jobs: usize,
}

impl Options {
    /// Reads `[--scenes A,B] [--jobs N]`.
    pub fn parse(mut arguments: &[&str]) -> Result<Self, String> {
        let mut options = Self {
            scenes: SCENES.iter().collect(),
            jobs: thread::available_parallelism().map_or(1, NonZero::get),
        };
        while let [name, rest @ ..] = arguments {
            let [value, rest @ ..] = rest else { return Err(format!("{name}: a value is missing")) };
            match *name {
                "--scenes" => options.scenes = value.split(',').map(find).collect::<Result<_, _>>()?,
                "--jobs" => {
                    let jobs = value.parse().ok().filter(|&jobs| jobs > 0);
                    options.jobs = jobs.ok_or("--jobs: must be a whole number, at least 1")?;
                }
                _ => return Err(format!("hashes: unknown argument {name}")),
            }
            arguments = rest;
        }
        Ok(options)
    }
}

fn find(name: &str) -> Result<&'static Scene, String> {
    let known = || SCENES.iter().map(|scene| scene.name).collect::<Vec<_>>().join(", ");
    SCENES
        .iter()
        .find(|scene| scene.name == name)
        .ok_or_else(|| format!("--scenes: no scene {name}, only {}: see crates/xtask/src/hashes.rs", known()))
}

/// The frames of a run.
struct Frames {
    count: usize,
    hash: u64,
}

/// Builds the command, runs the scenes and prints a line per scene: its name, the number of its frame files,
/// their hash.
pub fn run(root: &Path, options: &Options) -> ExitCode {
    let command = match bowknot::build(root) {
        Ok(command) => command,
        Err(message) => {
            eprintln!("{message}");
            return ExitCode::FAILURE;
        }
    };
    let folder = std::env::temp_dir().join(format!("bowknot-hashes-{}", std::process::id()));
    let next = AtomicUsize::new(0);
    let mut code = ExitCode::SUCCESS;
    thread::scope(|scope| {
        let (sender, results) = mpsc::channel();
        for _ in 0..options.jobs {
            let (sender, command, folder, next) = (sender.clone(), &command, &folder, &next);
            scope.spawn(move || {
                loop {
                    let index = next.fetch_add(1, Ordering::Relaxed);
                    let Some(scene) = options.scenes.get(index) else { return };
                    // Sending fails only once the receiver is gone.
                    let _ = sender.send((index, run_scene(command, scene, &folder.join(scene.name))));
                }
            });
        }
        drop(sender);
        code = print_in_order(&options.scenes, results);
    });
    // What remains in the temporary folder does no harm.
    let _ = std::fs::remove_dir_all(&folder);
    code
}

/// Prints each line as soon as it and those above it are known.
fn print_in_order(
    scenes: &[&Scene],
    results: impl IntoIterator<Item = (usize, Result<Frames, String>)>,
) -> ExitCode {
    let mut known: Vec<Option<Result<Frames, String>>> = scenes.iter().map(|_| None).collect();
    let mut printed = 0;
    let mut code = ExitCode::SUCCESS;
    for (index, result) in results {
        known[index] = Some(result);
        while let Some(result) = known.get_mut(printed).and_then(Option::take) {
            let name = scenes[printed].name;
            match result {
                Ok(Frames { count, hash }) => println!("{name:<10} {count:>4} {hash:016x}"),
                Err(message) => {
                    eprintln!("{name}: {message}");
                    code = ExitCode::FAILURE;
                }
            }
            printed += 1;
        }
    }
    code
}

/// Runs a scene into the folder, hashes its frames and removes the folder.
fn run_scene(command: &Path, scene: &Scene, folder: &Path) -> Result<Frames, String> {
    let output = Command::new(command)
        .args(["run", scene.name, "--scale", scene.scale, "--frames", scene.frames])
        .args(["--threads", "1", "--quiet", "--out"])
        .arg(folder)
        .output()
        .map_err(|error| format!("cannot start {}: {error}", command.display()))?;
    if !output.status.success() {
        return Err(format!("the run failed: {}", String::from_utf8_lossy(&output.stderr).trim()));
    }
    let frames = folder.join("frames");
    let hashed = hash_files(&frames).map_err(|error| format!("cannot read {}: {error}", frames.display()))?;
    // It is removed with the whole temporary folder if not now.
    let _ = std::fs::remove_dir_all(folder);
    Ok(hashed)
}

/// Hashes the bytes of all files of a folder, in the order of their names.
fn hash_files(folder: &Path) -> io::Result<Frames> {
    let entries = std::fs::read_dir(folder)?.map(|entry| Ok(entry?.path()));
    let mut files = entries.collect::<io::Result<Vec<PathBuf>>>()?;
    files.sort();
    let mut hash = Fnv::default();
    for file in &files {
        let mut reader = File::open(file)?;
        let mut buffer = [0; 1 << 16];
        loop {
            match reader.read(&mut buffer)? {
                0 => break,
                count => hash.write(&buffer[..count]),
            }
        }
    }
    Ok(Frames { count: files.len(), hash: hash.0 })
}

/// The 64-bit FNV-1a hash (Fowler, Noll and Vo): it finds accidental differences; nobody makes frames that
/// collide on purpose.
struct Fnv(u64);

impl Default for Fnv {
    fn default() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }
}

impl Fnv {
    fn write(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// From the reference tables of Fowler, Noll and Vo.
    #[test]
    fn hashes_are_those_of_the_reference() {
        for (text, expected) in
            [("", 0xcbf2_9ce4_8422_2325), ("a", 0xaf63_dc4c_8601_ec8c), ("foobar", 0x8594_4171_f739_67e8)]
        {
            let mut hash = Fnv::default();
            hash.write(text.as_bytes());
            assert_eq!(hash.0, expected, "{text:?}");
        }
    }

    #[test]
    fn every_scene_with_a_picture_has_a_hash() {
        let mut hashed: Vec<&str> = SCENES.iter().map(|scene| scene.name).collect();
        let mut drawn: Vec<&str> = crate::pictures::scene_names().collect();
        hashed.sort_unstable();
        drawn.sort_unstable();
        assert_eq!(hashed, drawn);
    }

    #[test]
    fn options_are_read() {
        let options = Options::parse(&["--jobs", "3", "--scenes", "sand,drape"]).map_err(|e| e.to_string());
        let read = options.map(|o| (o.jobs, o.scenes.iter().map(|scene| scene.name).collect::<Vec<_>>()));
        assert_eq!(read, Ok((3, vec!["sand", "drape"])));
        for (wrong, says) in [
            (["--jobs", "0"].as_slice(), "at least 1"),
            (&["--scenes", "sea"], "no scene sea"),
            (&["--scenes"], "missing"),
            (&["--fast", "1"], "unknown argument --fast"),
        ] {
            let error = Options::parse(wrong).err().unwrap_or_default();
            assert!(error.contains(says), "{wrong:?}: {error}");
        }
    }
}
