//! The report in words.

use crate::args::CheckOptions;
use bowknot::judging::{FrameVerdict, JudgingReport};
use bowknot_errors::counted;

/// States whose findings are printed; the others are counted.
const STATES: usize = 3;
/// Pairs of parts that are printed.
const PAIRS: usize = 20;

/// The findings of the first states, a table of the parts that intersect, and a summary.
pub fn of(report: &JudgingReport, options: &CheckOptions) -> String {
    let mut lines = Vec::new();
    let found: Vec<_> = report.files.iter().filter(|state| !state.findings.is_empty()).collect();
    for state in found.iter().take(STATES) {
        let place = format!("{}{}", state.file, time_of(state));
        lines.extend(state.findings.iter().map(|finding| format!("{place}: {finding}")));
    }
    if found.len() > STATES {
        let rest = counted(found.len() - STATES, "more state", "more states");
        lines.push(format!("and {rest}; --json and --table have all"));
    }
    if report.states > 1 && !report.pairs.is_empty() {
        lines.extend(pairs(report));
    }
    if !report.hint_pairs.is_empty() {
        lines.extend(hints(report));
    }
    lines.extend(report.inside.iter().take(PAIRS).map(|pair| {
        let states = counted(pair.states, "state", "states");
        let first = with_time(report, &pair.first);
        format!(
            "{} lies inside of {}, which is closed, in {states}, the first {first}: no intersection, but a hint",
            pair.part, pair.within
        )
    }));
    lines.push(summary(report, options.min_distance));
    lines.join("\n")
}

/// The time of a state, if its file knows it, and its time code.
fn time_of(state: &FrameVerdict) -> String {
    let Some(time) = state.time_s else { return String::new() };
    let code = state.time_code.map_or_else(String::new, |code| format!(", time code {code}"));
    format!(" ({time:.6} s{code})")
}

/// A state that a table names, with its time.
fn with_time(report: &JudgingReport, file: &str) -> String {
    let time = report.files.iter().find(|state| state.file == file).map(time_of);
    format!("{file}{}", time.unwrap_or_default())
}

fn pairs(report: &JudgingReport) -> Vec<String> {
    let rows = report.pairs.iter().take(PAIRS).map(|pair| {
        [
            parts(&pair.parts),
            pair.states.to_string(),
            pair.most.to_string(),
            with_time(report, &pair.worst),
            format!("{:.1e}", pair.depth_m),
            with_time(report, &pair.first),
        ]
    });
    let header = ["parts", "states", "most pairs", "in", "deepest [m]", "first"].map(str::to_owned);
    table(std::iter::once(header).chain(rows).collect(), report.pairs.len())
}

fn hints(report: &JudgingReport) -> Vec<String> {
    let rows = report.hint_pairs.iter().take(PAIRS).map(|pair| {
        let [worst, first] = [&pair.worst, &pair.first].map(|file| with_time(report, file));
        [parts(&pair.parts), pair.paths.to_string(), pair.most.to_string(), worst, first]
    });
    let header = ["meet between frames (hints)", "paths", "most pairs", "to", "first"].map(str::to_owned);
    table(std::iter::once(header).chain(rows).collect(), report.hint_pairs.len())
}

fn parts([a, b]: &[String; 2]) -> String {
    if a == b { format!("{a} and itself") } else { format!("{a} and {b}") }
}

/// Rows with their columns below each other, of so many pairs in all.
fn table<const N: usize>(rows: Vec<[String; N]>, pairs: usize) -> Vec<String> {
    let width = |column: usize| rows.iter().map(|row| row[column].chars().count()).max().unwrap_or(0);
    let widths: [usize; N] = std::array::from_fn(width);
    let mut lines: Vec<String> = rows
        .iter()
        .map(|row| {
            let cells = row.iter().zip(widths).map(|(cell, width)| format!("{cell:<width$}"));
            cells.collect::<Vec<_>>().join("  ").trim_end().to_owned()
        })
        .collect();
    if pairs > PAIRS {
        lines.push(format!("and {}", counted(pairs - PAIRS, "more pair", "more pairs")));
    }
    lines
}

fn summary(report: &JudgingReport, min_distance: Option<f64>) -> String {
    let mut summary = counted(report.states, "state", "states");
    if report.paths > 0 {
        summary += &format!(" and {}", counted(report.paths, "path", "paths"));
    }
    summary += &match report.intersections + report.path_hits {
        0 => ": no intersection".to_owned(),
        count => format!(": {}", counted(count, "intersection", "intersections")),
    };
    if report.states > 1 && report.intersecting_states > 0 {
        summary += &format!(", in {}", counted(report.intersecting_states, "state", "states"));
    }
    if report.hints_between_frames > 0 {
        let hints = counted(report.hints_between_frames, "pair meets", "pairs meet");
        summary += &format!("; {hints} on the straight way between frames, which is a hint");
    }
    if let Some(distance) = report.min_distance_m {
        summary += &format!("; smallest distance {distance:.3e} m");
    }
    if let Some(limit) = min_distance.filter(|_| report.too_near) {
        summary += &format!(", below {limit:.3e} m");
    }
    summary
}
