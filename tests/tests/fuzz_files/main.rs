//! Damaged files of every kind are read or refused: without a panic, in time, and with memory that their
//! sizes justify. The bodies are those of the fuzz targets in `tests/fuzz`.
//!
//! `BOWKNOT_SEEDS=200 cargo test --release -p bowknot-tests --test fuzz_files` tries a hundred times as many
//! inputs as CI does. An input that takes too much time or memory, or panics, is written to the temporary
//! folder, and its path is printed.
//!
//! The tests have a binary of their own, because they replace the allocator.
// Counts, and the paths of inputs to look at, are for people.
#![allow(clippy::print_stderr)]

mod memory;
mod seeds;

use bowknot_tests::{Random, fuzz};
use memory::{ALLOCATOR, Counting};
use std::panic::{self, AssertUnwindSafe};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

#[global_allocator]
static GLOBAL: Counting = Counting;

/// Memory that reading needs however small the file [bytes]: tables, simulators of small scenes, pages of
/// reports.
const BASE: usize = 24 << 20;
/// Memory per byte of a file [bytes]. The largest honest need is that of text whose every few bytes are a
/// vertex of a mesh, which is then judged.
const PER_BYTE: usize = 1500;
/// Time for one input [s], on a machine that does other work too.
const SECONDS: u64 = 20;

/// How many inputs are tried, relative to the number of CI.
fn effort() -> f64 {
    let seeds = std::env::var("BOWKNOT_SEEDS").ok().and_then(|text| text.parse().ok());
    seeds.unwrap_or(2.0) / 2.0
}

/// One test at a time: memory is that of the process.
fn alone() -> MutexGuard<'static, ()> {
    static ONE: Mutex<()> = Mutex::new(());
    ONE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Writes an input to look at.
fn keep(name: &str, data: &[u8]) -> PathBuf {
    let path = std::env::temp_dir().join(format!("bowknot-{name}-{}", std::process::id()));
    std::fs::write(&path, data).expect("the temporary folder can be written");
    path
}

/// Runs a body on one input within the limits.
fn limited(name: &str, body: fn(&[u8]) -> bool, data: &[u8]) -> bool {
    let limit = BASE + PER_BYTE * data.len();
    let start = Instant::now();
    ALLOCATOR.watch(data, 1 << 30, Duration::from_secs(3 * SECONDS));
    let taken = panic::catch_unwind(AssertUnwindSafe(|| body(data)));
    let peak = ALLOCATOR.unwatch();
    let seconds = start.elapsed().as_secs();
    let Ok(taken) = taken else { panic!("{name} panicked, input: {}", keep(name, data).display()) };
    assert!(
        peak <= limit,
        "{name} took {peak} bytes of memory for {} bytes, input: {}",
        data.len(),
        keep(name, data).display()
    );
    assert!(seconds < SECONDS, "{name} took {seconds} s, input: {}", keep(name, data).display());
    taken
}

/// Runs a body on sound files, which it must take, and on `count` damaged ones, some of which it must take
/// and some refuse.
fn damage(name: &str, body: fn(&[u8]) -> bool, sound: &[Vec<u8>], prefix: usize, count: usize) {
    let _one = alone();
    for (index, file) in sound.iter().enumerate() {
        assert!(limited(name, body, file), "{name}: sound file {index} is refused");
    }
    let count = (count as f64 * effort()) as usize;
    let mut random = Random::new(count as u64);
    let mut taken = 0;
    for index in 0..count {
        let file = &sound[index % sound.len()];
        let other = &sound[random.below(sound.len())];
        let mut below = |end| random.below(end);
        let damaged =
            [&file[..prefix], &fuzz::mutate(&file[prefix..], &other[prefix..], &mut below)].concat();
        taken += usize::from(limited(name, body, &damaged));
    }
    eprintln!("{name}: {count} damaged files, {taken} taken, {} refused", count - taken);
    assert!(taken > 0 && taken < count, "{name}: {taken} of {count} taken");
}

#[test]
fn meshes() {
    damage("meshes", fuzz::read_mesh, &seeds::meshes(), 1, 3000);
}

#[test]
fn scenes() {
    damage("scenes", fuzz::scene, &seeds::scenes(), 0, 1500);
}

#[test]
fn arrays_of_archives() {
    damage("arrays", fuzz::arrays, &seeds::arrays(), 0, 2000);
}

#[test]
fn checkpoints() {
    damage("checkpoints", fuzz::checkpoint, &seeds::checkpoints(), 1, 1500);
}

#[test]
fn checkpoints_without_a_checksum() {
    let _one = alone();
    let mut random = Random::new(7);
    let count = (600.0 * effort()) as usize;
    let inputs = (0..count).map(|_| (0..24).map(|_| random.bits() as u8).collect::<Vec<u8>>());
    let taken = inputs.filter(|input| limited("restore", fuzz::restore, input)).count();
    eprintln!("restore: {count} changed checkpoints, {taken} taken");
    assert!(taken > 0 && taken < count, "{taken} of {count} taken");
}

#[test]
fn folders_of_runs() {
    let folder = tempfile::tempdir().expect("a folder");
    damage("folders", fuzz::run_folder, &seeds::run_folders(folder.path()), 0, 500);
}

/// The page had a place for each key in each row of the statistics.
#[test]
fn a_report_of_statistics_with_a_key_per_line_takes_memory_as_its_file_justifies() {
    let _one = alone();
    let folder = tempfile::tempdir().expect("a folder");
    let runs = seeds::run_folders(folder.path());
    let lines: String = (0..5500).map(|k| format!("{{\"{k}\":1}}\n")).collect();
    let length = u16::try_from(lines.len()).expect("a part of an input").to_le_bytes();
    // The second kind of file of a run folder.
    let statistics = [&[1], &length[..], lines.as_bytes()].concat();
    assert!(limited("report", fuzz::run_folder, &[&runs[0][..], &statistics].concat()));
}

/// The limit on memory is one: a list that a header claims, and that is made before it is read, is noticed.
#[test]
fn memory_on_the_word_of_a_header_is_noticed() {
    fn believes(data: &[u8]) -> bool {
        let claimed = data.iter().fold(0usize, |n, digit| 10 * n + usize::from(digit - b'0'));
        std::hint::black_box(Vec::<u8>::with_capacity(claimed)).capacity() > 0
    }
    let _one = alone();
    assert!(limited("belief", believes, b"1000"));
    let quiet = panic::take_hook();
    panic::set_hook(Box::new(|_| {}));
    let refused = panic::catch_unwind(|| limited("belief", believes, b"100000000"));
    panic::set_hook(quiet);
    let _ = std::fs::remove_file(Path::new(&keep("belief", b"")));
    assert!(refused.is_err(), "100 MB for nine bytes");
}
