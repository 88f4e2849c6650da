//! Tests that run the command: exit codes, messages, files.
// The helpers belong to the tests, where a panic is a failure.
#![allow(clippy::unwrap_used)]

/// Wrong arguments, scenes and files.
mod bad_input;
/// `check` on clear and on intersecting states and paths.
mod check;
/// Commands on folders of runs whose files are damaged.
#[cfg(unix)]
mod damaged_runs;
/// `export` of runs and of folders of frames.
mod export;
/// `--dump-on-failure` of `run`, `resolve` and `check`.
mod failures;
/// Damaged checkpoints, locks, signals, folders and disks that cannot be written.
#[cfg(unix)]
mod faults;
/// Runs that are interrupted, resumed, or meet a full disk.
mod interruptions;
/// Runs that are killed.
#[cfg(unix)]
mod kills;
/// Completions and manual pages.
mod pages;
/// Pictures of runs.
#[cfg(feature = "render")]
mod render;
/// `repair` of seams.
mod repair;
/// `report`, and its page in a browser.
mod report;
/// `resolve` on recorded problems.
mod resolve;
/// The files and the output of `run`.
mod run;
/// `scenes` and `info`.
mod scenes;
/// What a command writes where no terminal is.
mod streams;
/// The commands of `docs/tutorials`.
mod tutorials;

use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use tempfile::TempDir;

/// A sheet of 8 x 8 edges over a coarse ball: a time step takes milliseconds.
const SMALL: &str = "run drape --scale 0.16 --frames 3";

/// A temporary folder, in which the command runs.
struct Place(TempDir);

impl Place {
    fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn write(&self, name: &str, content: impl AsRef<[u8]>) {
        std::fs::write(self.path(name), content).unwrap();
    }

    fn read(&self, name: &str) -> String {
        std::fs::read_to_string(self.path(name)).unwrap()
    }

    /// The command with these words, separated by spaces.
    fn command(&self, words: &str) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_bowknot"));
        command.args(words.split_whitespace()).current_dir(self.0.path());
        command
    }

    fn run(&self, words: &str) -> Ended {
        Ended::new(words, self.command(words).output().unwrap())
    }

    /// Files of a folder, sorted by name.
    fn files(&self, folder: &str) -> Vec<String> {
        let mut names: Vec<String> = std::fs::read_dir(self.path(folder))
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    }
}

/// How a command ended.
#[derive(Debug)]
struct Ended {
    #[expect(dead_code, reason = "for the messages of failing tests")]
    words: String,
    code: i32,
    stdout: String,
    stderr: String,
}

impl Ended {
    fn new(words: &str, output: Output) -> Self {
        Self {
            words: words.to_owned(),
            code: output.status.code().unwrap_or(-1),
            stdout: String::from_utf8(output.stdout).unwrap(),
            stderr: String::from_utf8(output.stderr).unwrap(),
        }
    }

    #[track_caller]
    fn ok(self) -> Self {
        assert_eq!(self.code, 0, "{self:#?}");
        self
    }

    /// Asserts that the command ended with this code, without a panic, and that stderr contains all of these.
    #[track_caller]
    fn refused(self, code: i32, says: &[&str]) -> Self {
        assert_eq!(self.code, code, "{self:#?}");
        assert!(!self.stderr.contains("panicked"), "{self:#?}");
        for words in says {
            assert!(self.stderr.contains(words), "does not say {words:?}: {self:#?}");
        }
        self
    }

    #[track_caller]
    fn json(&self) -> serde_json::Value {
        serde_json::from_str(&self.stdout).unwrap_or_else(|error| panic!("{error}: {self:#?}"))
    }
}

/// Writes an OBJ of the surface of one tetrahedron, with a corner at the origin.
fn tetrahedron(path: &Path) {
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
    std::fs::write(path, text).unwrap();
}
