//! The report in words.

use crate::args::CheckOptions;
use bowknot::judging::JudgingReport;
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
        lines.extend(state.findings.iter().map(|finding| format!("{}: {finding}", state.file)));
    }
    if found.len() > STATES {
        let rest = counted(found.len() - STATES, "more state", "more states");
        lines.push(format!("and {rest}; --json and --table have all"));
    }
    if report.states > 1 && !report.pairs.is_empty() {
        lines.extend(pairs(report));
    }
    lines.push(summary(report, options.min_distance));
    lines.join("\n")
}

fn pairs(report: &JudgingReport) -> Vec<String> {
    let mut rows = vec![["parts", "states", "most pairs", "in", "deepest [m]", "first"].map(str::to_owned)];
    for pair in report.pairs.iter().take(PAIRS) {
        let [a, b] = &pair.parts;
        rows.push([
            if a == b { format!("{a} and itself") } else { format!("{a} and {b}") },
            pair.states.to_string(),
            pair.most.to_string(),
            pair.worst.clone(),
            format!("{:.1e}", pair.depth_m),
            pair.first.clone(),
        ]);
    }
    let width = |column: usize| rows.iter().map(|row| row[column].chars().count()).max().unwrap_or(0);
    let widths: [usize; 6] = std::array::from_fn(width);
    let mut lines: Vec<String> = rows
        .iter()
        .map(|row| {
            let cells = row.iter().zip(widths).map(|(cell, width)| format!("{cell:<width$}"));
            cells.collect::<Vec<_>>().join("  ").trim_end().to_owned()
        })
        .collect();
    if report.pairs.len() > PAIRS {
        lines.push(format!("and {}", counted(report.pairs.len() - PAIRS, "more pair", "more pairs")));
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
