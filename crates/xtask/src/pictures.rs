//! `cargo xtask pictures`: a small picture of each built-in scene, in `assets/pictures`.
//!
//! Add each new scene to [`PICTURES`]; `cargo xtask pictures NAME` then draws it.

use crate::bowknot;
use crate::workspace::target_folder;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

/// Which frames of a scene are drawn, and how.
struct Scene {
    name: &'static str,
    /// `--scale` of the run.
    scale: &'static str,
    /// Numbers of the frames that are drawn; the run ends with the last.
    frames: &'static [u32],
    /// Further options of `bowknot render`, such as a camera.
    options: &'static str,
}

/// The scenes in the order of `bowknot scenes`.
const PICTURES: &[Scene] = &[
    Scene { name: "drape", scale: "1", frames: &[80], options: "" },
    Scene { name: "needle", scale: "0.5", frames: &[24], options: "" },
    Scene { name: "stack", scale: "0.7", frames: &[70], options: "" },
    Scene { name: "sphere", scale: "0.3", frames: &[60], options: "" },
    Scene { name: "tube", scale: "0.6", frames: &[150], options: "" },
    Scene { name: "blade", scale: "0.3", frames: &[30], options: "" },
    Scene {
        name: "funnel",
        scale: "0.2",
        frames: &[26, 30],
        options: "--camera 1.7,-1.7,1.7 --target 0,0,0.95 --fov 40",
    },
    Scene {
        name: "dress",
        scale: "0.3",
        frames: &[90, 170],
        options: "--camera 5.0,2.9,1.3 --target 0.7,0.03,0.83 --fov 22",
    },
    Scene {
        name: "gown",
        scale: "0.3",
        frames: &[80, 180],
        options: "--camera 4.9,2.7,1.3 --target 0.55,-0.09,0.83 --fov 22",
    },
    Scene {
        name: "bow-knot",
        scale: "0.25",
        frames: &[1, 420],
        options: "--camera 0.4,-1.7,0.6 --target 0,0,0 --fov 44",
    },
    Scene {
        name: "reef-knot",
        scale: "0.25",
        frames: &[120, 280],
        options: "--camera 0.15,-0.8,0.45 --target 0,0,0 --fov 35",
    },
    Scene { name: "mat", scale: "0.25", frames: &[100, 220], options: "" },
    Scene { name: "hair", scale: "0.25", frames: &[80, 150], options: "" },
    Scene { name: "sand", scale: "0.3", frames: &[60, 200], options: "" },
    Scene { name: "trampoline", scale: "1", frames: &[40], options: "" },
    Scene { name: "cards", scale: "1", frames: &[500], options: "" },
    Scene { name: "woven", scale: "1", frames: &[200], options: "--camera 0.5,-0.5,0.25 --target 0,0,0" },
];

/// Largest size of a picture [bytes]: the repository keeps them all.
const MAX_BYTES: u64 = 60_000;
/// Sizes [pixels] that are tried in turn until the file is small enough.
const SIZES: [&str; 3] = ["480x360", "420x315", "360x270"];

/// Names of the scenes that have a picture.
pub fn scene_names() -> impl Iterator<Item = &'static str> {
    PICTURES.iter().map(|scene| scene.name)
}

/// Runs the named scenes, or all if no name is given, and draws them.
pub fn run(root: &Path, names: &[&str]) -> ExitCode {
    if let Some(unknown) = names.iter().find(|name| scene_names().all(|known| known != **name)) {
        let known = scene_names().collect::<Vec<_>>().join(", ");
        eprintln!(
            "there is no picture of {unknown}, only of {known}: add the scene to crates/xtask/src/pictures.rs"
        );
        return ExitCode::from(2);
    }
    let command = match bowknot::build(root) {
        Ok(command) => command,
        Err(message) => {
            eprintln!("{message}");
            return ExitCode::FAILURE;
        }
    };
    let chosen = PICTURES.iter().filter(|scene| names.is_empty() || names.contains(&scene.name));
    for scene in chosen {
        if let Err(message) = draw(root, &command, scene) {
            eprintln!("{}: {message}", scene.name);
            return ExitCode::FAILURE;
        }
    }
    ExitCode::SUCCESS
}

fn draw(root: &Path, command: &Path, scene: &Scene) -> Result<(), String> {
    let folder = target_folder(root).join("xtask").join("pictures").join(scene.name);
    if folder.exists() {
        std::fs::remove_dir_all(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    }
    let last = scene.frames.iter().max().copied().unwrap_or(0).to_string();
    run_command(command, &["run", scene.name, "--scale", scene.scale, "--frames", &last], &folder)?;
    for (index, frame) in scene.frames.iter().enumerate() {
        let number = if scene.frames.len() > 1 { format!("-{}", index + 1) } else { String::new() };
        let out = root.join("assets").join("pictures").join(format!("{}{number}.png", scene.name));
        let frame = frame.to_string();
        let mut bytes = 0;
        for size in SIZES {
            let run = folder.to_string_lossy();
            let mut words = vec!["render", &*run, "--frame", &frame, "--size", size, "--indexed", "--quiet"];
            words.extend(scene.options.split_whitespace());
            run_command(command, &words, &out)?;
            bytes = std::fs::metadata(&out).map_err(|error| format!("{}: {error}", out.display()))?.len();
            if bytes <= MAX_BYTES {
                break;
            }
        }
        println!("{}: {bytes} bytes", relative(root, &out).display());
        if bytes > MAX_BYTES {
            return Err(format!(
                "the picture is larger than {MAX_BYTES} bytes at {}",
                SIZES[SIZES.len() - 1]
            ));
        }
    }
    Ok(())
}

/// Runs the command with these words and its output folder or file.
fn run_command(command: &Path, words: &[&str], out: &Path) -> Result<(), String> {
    let status = Command::new(command)
        .args(words)
        .arg("--out")
        .arg(out)
        .status()
        .map_err(|error| format!("cannot start {}: {error}", command.display()))?;
    if status.success() { Ok(()) } else { Err(format!("bowknot {} failed", words.join(" "))) }
}

fn relative(root: &Path, path: &Path) -> PathBuf {
    path.strip_prefix(root).unwrap_or(path).to_owned()
}
