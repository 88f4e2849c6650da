//! Counts that are the same in every run: steps, searches, pairs and rows of small scenes and problems.
//! `counts.csv` has the accepted counts; `BOWKNOT_ACCEPT=1 cargo test -p bowknot-bench --test counts`
//! rewrites it after an intended change. Times are never pinned.

use bowknot::simulator::StepStatistics;
use bowknot::{Scene, Simulator};
use std::path::Path;
use std::process::Command;

/// Scenes into contact: name, scale, time steps with `fast` and with `paper`, which at rest takes all of its steps for
/// `mat`, two minutes in all.
const SCENES: [(&str, f64, [usize; 2]); 8] = [
    ("needle", 0.15, [16, 16]),
    ("stack", 0.1, [40, 40]),
    ("tube", 0.15, [90, 90]),
    ("reef-knot", 0.1, [50, 50]),
    ("dress", 0.08, [8, 8]),
    ("mat", 0.1, [180, 120]),
    ("hair", 0.05, [40, 40]),
    ("sand", 0.1, [40, 40]),
];

/// A figure whose table has steps and searches of methods. Solves that fail may have reached their time
/// limit: the failure is pinned, their steps are not.
const FIGURE: &str = "impact-zones";

#[test]
fn counts_are_those_that_were_accepted() {
    let mut lines = vec!["what,two-way steps,searches,pairs,contact rows,edge rows,active rows".to_owned()];
    for (name, scale, frames) in SCENES {
        for (preset, frames) in ["fast", "paper"].into_iter().zip(frames) {
            lines.push(format!("{name} {preset},{}", of_scene(name, scale, frames, preset)));
        }
    }
    lines.push("figure: scene,method,steps,searches".to_owned());
    lines.extend(of_figure(FIGURE));
    let counted = lines.join("\n") + "\n";

    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/counts.csv");
    if std::env::var_os("BOWKNOT_ACCEPT").is_some() {
        std::fs::write(&path, &counted).expect("a file to write");
    }
    let accepted = std::fs::read_to_string(&path).expect("accepted counts");
    for (accepted, counted) in accepted.lines().zip(counted.lines()) {
        assert_eq!(accepted, counted, "accepted, counted; BOWKNOT_ACCEPT=1 accepts what is counted");
    }
    assert_eq!(accepted.lines().count(), counted.lines().count());
}

/// Sums over time steps.
fn of_scene(name: &str, scale: f64, frames: usize, preset: &str) -> String {
    let set = format!("contact.preset={preset}");
    let scene = Scene::builtin(name, scale).and_then(|scene| scene.with_sets(&[set])).expect("a scene");
    let mut simulator = Simulator::new(&scene).expect("a simulator");
    let steps: Vec<StepStatistics> = (0..frames).map(|_| simulator.step().expect("a step")).collect();
    let sum = |of: fn(&StepStatistics) -> usize| steps.iter().map(of).sum::<usize>().to_string();
    [
        sum(|s| s.two_way_steps),
        sum(|s| s.searches),
        sum(|s| s.pairs),
        sum(|s| s.contact_rows),
        sum(|s| s.edge_rows),
        sum(|s| s.active_rows),
    ]
    .join(",")
}

/// Steps and searches of every method in a figure's table.
fn of_figure(figure: &str) -> Vec<String> {
    let folder = tempfile::tempdir().expect("a folder");
    let run = Command::new(env!("CARGO_BIN_EXE_bowknot-bench"))
        .args([figure, "--tiny", "--out"])
        .arg(folder.path())
        .output()
        .expect("the command runs");
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
    let path = folder.path().join("tiny").join(figure).join(format!("{figure}.csv"));
    let table = std::fs::read_to_string(&path).expect("a table");
    let mut rows = table.lines().map(columns);
    let header = rows.next().expect("a header");
    let place = |name: &str| header.iter().position(|h| h == name).expect("a column of that name");
    let [scene, method, steps, searches, failed] =
        ["scene", "method", "steps", "searches", "failed"].map(place);
    rows.map(|row| {
        let counts = if row[failed] == "0" {
            format!("{},{}", row[steps], row[searches])
        } else {
            "failed".to_owned()
        };
        format!("{figure}: {},{},{counts}", row[scene], row[method])
    })
    .collect()
}

/// Columns of a line of comma-separated values; quoted ones may hold commas.
fn columns(line: &str) -> Vec<String> {
    let mut quoted = false;
    let mut columns = vec![String::new()];
    for c in line.chars() {
        match c {
            '"' => quoted = !quoted,
            ',' if !quoted => columns.push(String::new()),
            c => columns.last_mut().expect("one at least").push(c),
        }
    }
    columns
}
