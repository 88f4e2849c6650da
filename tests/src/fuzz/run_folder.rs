//! No damage to the folder of a run makes its report panic.

use super::parts::{join, split};
use bowknot::report::{ReportOptions, write_report};
use bowknot::run::{ExportOptions, export};
use bowknot::scene::Format;
use std::fs;
use std::path::Path;

/// Files of a run, by the choices of the parts.
const FILES: [&str; 10] = [
    "scene.toml",
    "stats.jsonl",
    "summary.json",
    "frames/000000.ply",
    "frames/000001.ply",
    "frames/000002.ply",
    "frames/000000.obj",
    "frames.npz",
    "surface/000000.obj",
    "frames/000003.ply",
];

/// Writes the page of a run whose files are the parts of the input, and exports its frames.
pub fn run_folder(data: &[u8]) -> bool {
    let Ok(folder) = tempfile::tempdir() else { return false };
    for below in ["frames", "surface"] {
        if fs::create_dir(folder.path().join(below)).is_err() {
            return false;
        }
    }
    for (choice, content) in split(data) {
        if fs::write(folder.path().join(FILES[usize::from(choice) % FILES.len()]), content).is_err() {
            return false;
        }
    }
    let out = folder.path().join("report.html");
    let page = match write_report(folder.path(), &out, &ReportOptions::default(), &mut |_, _| {}) {
        Ok(info) => {
            assert_eq!(fs::metadata(&out).expect("the page").len(), info.bytes, "size of the page");
            true
        }
        Err(error) => {
            assert!(!error.to_string().is_empty() && !out.exists());
            false
        }
    };
    let formats = vec![Format::Vtu, Format::Pc2, Format::Usd];
    let options = ExportOptions {
        formats,
        out: folder.path().join("exported"),
        time_step: None,
        ..ExportOptions::default()
    };
    match export(folder.path(), &options, &mut |_, _| {}) {
        Ok(exported) => assert!(exported.frames > 0),
        Err(error) => assert!(!error.to_string().is_empty()),
    }
    page
}

/// The input that holds the files of a run.
pub fn files_of(run: &Path) -> Vec<u8> {
    let read = |(choice, name): (usize, &&str)| Some((choice as u8, fs::read(run.join(name)).ok()?));
    let parts: Vec<(u8, Vec<u8>)> = FILES.iter().enumerate().filter_map(read).collect();
    join(&parts)
}
