//! The command on the smallest scenes: figures are measured, kept and written.

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

/// The first run records and measures; the second one reuses all of it and writes the same tables.
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
    let (table, chart, page) = (read("steps.csv"), read("steps.svg"), read("report.md"));
    assert_eq!(table.lines().count(), 5, "a header and two presets on two kinds of targets:\n{table}");
    assert!(table.lines().skip(1).all(|line| line.ends_with(",0")), "a result intersects:\n{table}");
    assert!(chart.starts_with("<svg") && !chart.contains("NaN"));
    assert!(page.starts_with("## Steps per problem") && page.contains("Commit "), "{page}");
    let pictures: Vec<&str> = page.split("](").skip(1).filter_map(|rest| rest.split(')').next()).collect();
    assert_eq!(pictures, ["steps.svg"], "the page shows the chart beside it:\n{page}");

    let again = bench(&["steps", "--tiny"], folder.path());
    assert!(again.status.success() && !text(&again.stdout).contains("recording"));
    assert_eq!((read("steps.csv"), read("steps.svg")), (table, chart));
}

#[test]
fn figures_are_listed_and_unknown_ones_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let list = text(&bench(&["list"], folder.path()).stdout);
    assert!(list.contains("collision-error") && list.contains("record"), "{list}");
    assert!(list.contains("10 scenes") && list.contains("23 sets"), "{list}");
    let line = list.lines().find(|line| line.starts_with("sweeps ")).expect("a line for each figure");
    assert!(line.contains(" s ") && line.contains("20 min"), "how long it takes: {line}");
    let refused = bench(&["fig-99", "--tiny"], folder.path());
    assert_eq!(refused.status.code(), Some(2));
    assert!(text(&refused.stderr).contains("no figure \"fig-99\""), "{}", text(&refused.stderr));
}
