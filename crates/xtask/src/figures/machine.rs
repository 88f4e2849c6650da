//! What the figures were measured with.

use std::path::Path;
use std::process::Command;
use std::time::Duration;

/// The machine and the state of the repository.
pub struct Machine {
    cores: usize,
    cpu: String,
    commit: String,
    load: String,
}

impl Machine {
    pub fn now(root: &Path) -> Self {
        let info = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
        let cpu = info.lines().find_map(|line| line.strip_prefix("model name")).unwrap_or("an unknown CPU");
        Self {
            cores: std::thread::available_parallelism().map_or(1, usize::from),
            cpu: cpu.trim_start_matches(['\t', ' ', ':']).to_owned(),
            commit: commit(root),
            load: Self::load(),
        }
    }

    /// The load average of the last minute.
    pub fn load() -> String {
        let text = std::fs::read_to_string("/proc/loadavg").unwrap_or_default();
        text.split_whitespace().next().unwrap_or("unknown").to_owned()
    }

    /// The head of the page.
    pub fn describe(&self, quick: bool, duration: Duration, load_after: &str) -> String {
        let Self { cores, cpu, commit, load } = self;
        let option = if quick { " --quick" } else { "" };
        let minutes = duration.as_secs_f64() / 60.0;
        format!(
            "# Figures\n\n\
             `cargo xtask figures{option}` measures all of this and writes this page, texts included: edit\n\
             `crates/xtask/src/figures`, not this file. `--quick` takes smaller scenes and leaves this page alone; `--out DIR`\n\
             says where runs and single measurements stay.\n\n\
             Machine: {cores} cores, {cpu}; commit {commit}; 2 threads unless said otherwise; load average {load} before and\n\
             {load_after} after {minutes:.0} minutes of measuring. CPU seconds are processor time of all threads, medians of three\n\
             where a call takes under two seconds; variants take turns, so that a busy machine slows all alike. *Goal*: what the\n\
             project set out to reach on two cores, \"at least\" and \"aim\". *Prototype*: a serial program that went before this\n\
             one, on its own states of like scenes.\n"
        )
    }
}

/// The commit, and whether files differ from it.
fn commit(root: &Path) -> String {
    let git = |arguments: &[&str]| {
        let output = Command::new("git").args(arguments).current_dir(root).output().ok()?;
        output.status.success().then(|| String::from_utf8_lossy(&output.stdout).trim().to_owned())
    };
    let Some(hash) = git(&["rev-parse", "--short", "HEAD"]) else { return "unknown".to_owned() };
    match git(&["status", "--porcelain", "--", "crates", "Cargo.toml", "Cargo.lock"]) {
        Some(changes) if changes.is_empty() => hash,
        _ => format!("{hash} with changes"),
    }
}
