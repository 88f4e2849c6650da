//! The machine and the commit that measurements are made with.

use crate::git;
use std::path::Path;

/// The machine and the state of the repository.
#[derive(Clone, Debug)]
pub struct Machine {
    pub cores: usize,
    pub cpu: String,
    pub commit: String,
}

/// End of the name of a commit if files of the code differ from it.
pub const WITH_CHANGES: &str = " with changes";

impl Machine {
    /// This machine, and the repository at `root`.
    pub fn now(root: &Path) -> Self {
        let info = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
        let cpu = info.lines().find_map(|line| line.strip_prefix("model name")).unwrap_or("an unknown CPU");
        Self {
            cores: std::thread::available_parallelism().map_or(1, usize::from),
            cpu: cpu.trim_start_matches(['\t', ' ', ':']).to_owned(),
            commit: commit(root),
        }
    }

    /// The load average of the last minute.
    pub fn load() -> String {
        let text = std::fs::read_to_string("/proc/loadavg").unwrap_or_default();
        text.split_whitespace().next().unwrap_or("unknown").to_owned()
    }
}

/// The commit, and whether files of the code differ from it.
fn commit(root: &Path) -> String {
    let Some(hash) = git::output(root, &["rev-parse", "--short", "HEAD"]) else {
        return "unknown".to_owned();
    };
    match git::output(root, &["status", "--porcelain", "--", "crates", "Cargo.toml", "Cargo.lock"]) {
        Some(changes) if changes.is_empty() => hash,
        _ => format!("{hash}{WITH_CHANGES}"),
    }
}
