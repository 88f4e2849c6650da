//! The ends of the sweeps of `bowknot-bench stability`: nothing intersects, all numbers are finite, and no
//! case misses a goal without a known reason.

use std::process::Command;

/// The cells of a line of CSV.
fn cells(line: &str) -> Vec<String> {
    let mut cells = vec![String::new()];
    let mut quoted = false;
    for c in line.chars() {
        match c {
            '"' => quoted = !quoted,
            ',' if !quoted => cells.push(String::new()),
            c => cells.last_mut().expect("a cell").push(c),
        }
    }
    cells
}

#[test]
fn extreme_scenes_stay_valid_and_miss_no_goal_without_a_reason() {
    let folder = tempfile::tempdir().expect("a folder");
    let done = Command::new(env!("CARGO_BIN_EXE_bowknot-bench"))
        .args(["stability", "--tiny", "--out"])
        .arg(folder.path())
        .output()
        .expect("the command runs");
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    let said = String::from_utf8_lossy(&done.stdout);
    assert!(said.contains(" 0 runs that ended early"), "{said}");
    let path = folder.path().join("tiny/stability/stability.csv");
    let table = std::fs::read_to_string(&path).expect("a table");
    let mut lines = table.lines();
    let header = cells(lines.next().expect("a header"));
    let column = |name: &str| header.iter().position(|title| title == name).expect("a column");
    let [result, intersections, not_finite] = ["result", "intersections", "not finite"].map(column);
    let mut count = 0;
    for line in lines {
        let row = cells(line);
        assert_eq!([&row[intersections], &row[not_finite]], ["0", "0"], "{line}");
        // A miss with a reason has it after a colon.
        assert!(row[result] == "ok" || row[result].contains(": "), "{line}");
        assert!(!row[result].contains("refused"), "a scene that can be simulated is refused: {line}");
        count += 1;
    }
    assert!(count >= 24, "only {count} cases:\n{table}");
}
