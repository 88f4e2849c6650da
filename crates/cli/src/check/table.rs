//! The report as a table: a row per state and pair of parts that intersect.

use crate::exit::Failure;
use bowknot::io::write_atomic;
use bowknot::judging::JudgingReport;
use std::fmt::Debug;
use std::io::Write;
use std::path::Path;

/// Writes the table. A state in which nothing intersects has one row without parts.
pub fn write(path: &Path, report: &JudgingReport) -> Result<(), Failure> {
    let written = write_atomic(path, |out| {
        writeln!(
            out,
            "state,time_s,part_a,part_b,intersections,depth_m,x_m,y_m,z_m,hints_between_frames,path_hits,min_distance_m"
        )?;
        for state in &report.files {
            let before = format!("{},{}", quoted(&state.file), number(state.time_s));
            let after = format!(
                "{},{},{}",
                number(state.hints_between_frames),
                number(state.path_hits),
                number(state.min_distance_m)
            );
            if state.pairs.is_empty() {
                writeln!(out, "{before},,,0,,,,,{after}")?;
            }
            for pair in &state.pairs {
                let [a, b] = pair.parts.each_ref().map(|part| quoted(part));
                let [x, y, z] = pair.place_m;
                let (count, depth) = (pair.intersections, pair.depth_m);
                writeln!(out, "{before},{a},{b},{count},{depth:?},{x:?},{y:?},{z:?},{after}")?;
            }
        }
        Ok(())
    });
    Ok(written?)
}

/// A number that reads back as the same; nothing if there is none.
fn number<T: Debug>(value: Option<T>) -> String {
    value.map_or_else(String::new, |value| format!("{value:?}"))
}

/// A name as RFC 4180 has it.
fn quoted(name: &str) -> String {
    if name.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", name.replace('"', "\"\""))
    } else {
        name.to_owned()
    }
}
