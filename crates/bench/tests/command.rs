//! The command at its smallest: figures are measured, kept, and written.

use std::path::Path;
use std::process::{Command, Output};

fn bench(arguments: &[&str], out: &Path) -> Output {
    Command::new(env!("CARGO_BIN_EXE_bowknot-bench"))
        .args(arguments)
        .arg("--out")
        .arg(out)
        .output()
        .expect("the command runs")
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// The columns of a row that hold counts.
fn counts(row: &str) -> String {
    let cells: Vec<&str> = row.split(',').collect();
    [0, 1, 4, 5, 6].map(|column| cells[column]).join(",")
}

/// Steps, searches and calls that met their rule, of two problems of a small needle: mean (max) of either preset. They
/// depend on the input alone; who tunes a preset changes them here and says so in CHANGELOG.md. Times are never pinned.
const COUNTS: [&str; 2] = ["needle,fast,7.00 (12.0),8.5,2 of 2", "needle,paper,20.0 (33.0),13.5,2 of 2"];

/// The first run records and measures, the second takes what is there, to the same tables.
#[test]
fn a_figure_is_measured_once() {
    let folder = tempfile::tempdir().expect("a folder");
    let first = bench(&["steps", "--tiny"], folder.path());
    assert!(first.status.success(), "{}", text(&first.stderr));
    assert!(text(&first.stdout).contains("recording bowknot run needle"), "{}", text(&first.stdout));
    let read = |name: &str| {
        let path = folder.path().join("tiny/steps").join(name);
        std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
    };
    let (table, chart, page) = (read("steps.csv"), read("steps.svg"), read("section.md"));
    assert_eq!(table.lines().count(), 3, "a header and two presets:\n{table}");
    assert!(table.lines().skip(1).all(|line| line.ends_with(",0")), "a result intersects:\n{table}");
    let counts: Vec<String> = table.lines().skip(1).map(counts).collect();
    assert_eq!(counts, COUNTS);
    assert!(chart.starts_with("<svg") && !chart.contains("NaN"));
    assert!(page.starts_with("## Steps of a problem") && page.contains("Commit "), "{page}");

    let again = bench(&["steps", "--tiny"], folder.path());
    assert!(again.status.success() && !text(&again.stdout).contains("recording"));
    assert_eq!((read("steps.csv"), read("steps.svg")), (table, chart));
}

#[test]
fn figures_are_listed_and_unknown_ones_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let list = text(&bench(&["list"], folder.path()).stdout);
    assert!(list.contains("collision-error") && list.contains("record"), "{list}");
    let refused = bench(&["fig-99", "--tiny"], folder.path());
    assert_eq!(refused.status.code(), Some(2));
    assert!(text(&refused.stderr).contains("no figure \"fig-99\""), "{}", text(&refused.stderr));
}
