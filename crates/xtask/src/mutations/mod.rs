//! `cargo xtask mutations`: do the safety tests catch mistakes in the code?
//!
//! Each mutation in `tests/safety/mutations` is a mistake of a line or two that makes the method unsafe. The
//! command makes each of them, one at a time, in a copy of the workspace, and runs the tests of
//! `bowknot-safety` there. A mutation that no test notices has survived: the tests are too weak.

mod data;

use crate::workspace::{cargo, target_folder};
use data::Mutation;
use std::collections::BTreeSet;
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode, Stdio};
use std::thread;
use std::time::{Duration, Instant};

/// Longest time of the tests with a mutation, in times of those without, and at least [`SHORTEST`]. A
/// mutation may make a loop endless; that is noticed too.
const PATIENCE: f64 = 10.0;
const SHORTEST: Duration = Duration::from_secs(120);

/// What became of the tests.
enum Outcome {
    Passed(Duration),
    /// The names of the tests that failed.
    Failed(Vec<String>),
    TimedOut,
}

/// Runs all mutations, or those whose names are given. Fails if one survives.
pub fn run(root: &Path, names: &[&str]) -> ExitCode {
    match try_run(root, names) {
        Ok(survivors) if survivors.is_empty() => ExitCode::SUCCESS,
        Ok(survivors) => {
            eprintln!("survived: {}", survivors.join(", "));
            ExitCode::FAILURE
        }
        Err(message) => {
            eprintln!("{message}");
            ExitCode::from(2)
        }
    }
}

fn try_run(root: &Path, names: &[&str]) -> Result<Vec<String>, String> {
    let mut mutations = data::read_all(root)?;
    if let Some(unknown) = names.iter().find(|name| mutations.iter().all(|m| m.name != **name)) {
        return Err(format!("no mutation {unknown} in {}", data::folder(root).display()));
    }
    mutations.retain(|mutation| names.is_empty() || names.contains(&mutation.name.as_str()));
    let outdated: Vec<String> = mutations.iter().filter_map(|m| m.apply_below(root).err()).collect();
    if !outdated.is_empty() {
        return Err(outdated.join("\n"));
    }

    let folder = target_folder(root).join("mutations");
    let copy = folder.join("tree");
    copy_workspace(root, &copy).map_err(|error| format!("{}: {error}", copy.display()))?;
    let Outcome::Passed(usual) = test(&folder, &copy, Duration::MAX)? else {
        return Err("the tests fail without any mutation".to_owned());
    };
    println!("no mutation: passed in {:.0} s", usual.as_secs_f64());
    let longest = usual.mul_f64(PATIENCE).max(SHORTEST);
    let mut survivors = Vec::new();
    for mutation in &mutations {
        let timer = Instant::now();
        let outcome = test_with(mutation, &folder, &copy, longest)?;
        let said = match outcome {
            Outcome::Passed(_) => {
                survivors.push(mutation.name.clone());
                format!("SURVIVED: {}", mutation.why)
            }
            Outcome::Failed(tests) => format!("caught by {}", tests.join(", ")),
            Outcome::TimedOut => "caught: the tests do not end".to_owned(),
        };
        println!("{}: {said} ({:.0} s)", mutation.name, timer.elapsed().as_secs_f64());
    }
    println!("{} of {} mutations caught", mutations.len() - survivors.len(), mutations.len());
    Ok(survivors)
}

/// Runs the tests with a mutation in the copy, which is then as it was.
fn test_with(mutation: &Mutation, folder: &Path, copy: &Path, longest: Duration) -> Result<Outcome, String> {
    let path = copy.join(&mutation.file);
    let fault = |error: std::io::Error| format!("{}: {error}", path.display());
    let original = fs::read(&path).map_err(fault)?;
    fs::write(&path, mutation.apply_below(copy)?).map_err(fault)?;
    let outcome = test(folder, copy, longest).map_err(|message| format!("{}: {message}", mutation.name));
    fs::write(&path, original).map_err(fault)?;
    outcome
}

/// Builds and runs the safety tests of the copy.
fn test(folder: &Path, copy: &Path, longest: Duration) -> Result<Outcome, String> {
    let build = cargo(copy, "test --release --package bowknot-safety --test all --no-run")
        .env("CARGO_TARGET_DIR", folder.join("target"))
        .output()
        .map_err(|error| format!("cannot start cargo: {error}"))?;
    let log = String::from_utf8_lossy(&build.stderr);
    let tests = executable(&log).filter(|_| build.status.success());
    let tests = tests.ok_or_else(|| format!("the tests do not build:\n{log}"))?;
    let output = folder.join("output.txt");
    let fault = |error: std::io::Error| format!("{}: {error}", output.display());
    let file = File::create(&output).map_err(fault)?;
    let timer = Instant::now();
    let mut child = Command::new(copy.join(tests))
        .current_dir(copy)
        // The first failure counts, not the smallest case.
        .env("PROPTEST_MAX_SHRINK_ITERS", "0")
        .stdout(file)
        .stderr(Stdio::null())
        .spawn()
        .map_err(|error| format!("cannot start the tests: {error}"))?;
    loop {
        if let Some(status) = child.try_wait().map_err(|error| error.to_string())? {
            if status.success() {
                return Ok(Outcome::Passed(timer.elapsed()));
            }
            let failed = failed_tests(&fs::read_to_string(&output).map_err(fault)?);
            return Ok(Outcome::Failed(failed));
        }
        if timer.elapsed() > longest {
            child.kill().and_then(|()| child.wait()).map_err(|error| error.to_string())?;
            return Ok(Outcome::TimedOut);
        }
        thread::sleep(Duration::from_millis(100));
    }
}

/// The path of the test program in what `cargo test --no-run` writes: `Executable tests/all.rs (PATH)`.
fn executable(log: &str) -> Option<PathBuf> {
    let line = log.lines().rev().find(|line| line.trim_start().starts_with("Executable"))?;
    line.rsplit_once('(')?.1.strip_suffix(')').map(PathBuf::from)
}

/// The names of the tests that failed, in the output of a test program; "an abort" if it names none.
fn failed_tests(output: &str) -> Vec<String> {
    let name = |line: &str| line.strip_prefix("test ")?.strip_suffix(" ... FAILED").map(str::to_owned);
    let names: Vec<String> = output.lines().filter_map(name).collect();
    if names.is_empty() { vec!["an abort".to_owned()] } else { names }
}

/// Makes `copy` hold the files of the workspace that git does not ignore. Files that are the same keep their
/// time, so that cargo does not build them again.
fn copy_workspace(root: &Path, copy: &Path) -> std::io::Result<()> {
    let listed = Command::new("git")
        .args(["ls-files", "--cached", "--others", "--exclude-standard", "-z"])
        .current_dir(root)
        .output()?;
    if !listed.status.success() {
        return Err(std::io::Error::other(String::from_utf8_lossy(&listed.stderr).into_owned()));
    }
    let listed = String::from_utf8_lossy(&listed.stdout).into_owned();
    // Listed files may have been removed since.
    let files: BTreeSet<PathBuf> =
        listed.split_terminator('\0').map(PathBuf::from).filter(|file| root.join(file).is_file()).collect();
    for file in &files {
        let (from, to) = (root.join(file), copy.join(file));
        let bytes = fs::read(&from)?;
        if fs::read(&to).ok().as_ref() != Some(&bytes) {
            if let Some(parent) = to.parent() {
                fs::create_dir_all(parent)?;
            }
            fs::write(&to, bytes)?;
        }
    }
    remove_others(copy, copy, &files)
}

/// Removes the files below `folder` that are not among `files`, which are relative to `copy`.
fn remove_others(copy: &Path, folder: &Path, files: &BTreeSet<PathBuf>) -> std::io::Result<()> {
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_dir() {
            remove_others(copy, &path, files)?;
        } else if path.strip_prefix(copy).is_ok_and(|file| !files.contains(file)) {
            fs::remove_file(&path)?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn test_programs_and_failures_are_found_in_output() {
        let log =
            "   Compiling x\n    Finished `release`\n  Executable tests/all.rs (target/release/deps/all-1)\n";
        assert_eq!(executable(log), Some(PathBuf::from("target/release/deps/all-1")));
        assert_eq!(executable("error"), None);
        let output = "test a::b ... ok\ntest c::d ... FAILED\ntest e has been running\n";
        assert_eq!(failed_tests(output), ["c::d"]);
        assert_eq!(failed_tests(""), ["an abort"]);
    }

    #[test]
    fn a_copy_follows_the_workspace() {
        let folder = std::env::temp_dir().join(format!("bowknot-copy-{}", std::process::id()));
        let root = crate::workspace::root();
        copy_workspace(&root, &folder).unwrap_or_else(|error| panic!("{error}"));
        let (manifest, stray) = (folder.join("Cargo.toml"), folder.join("crates").join("stray.rs"));
        fs::write(&manifest, "changed").unwrap_or_else(|error| panic!("{error}"));
        fs::write(&stray, "stray").unwrap_or_else(|error| panic!("{error}"));
        copy_workspace(&root, &folder).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(fs::read(&manifest).ok(), fs::read(root.join("Cargo.toml")).ok());
        assert!(!stray.exists());
        // What remains in the temporary folder does no harm.
        let _ = fs::remove_dir_all(&folder);
    }
}
