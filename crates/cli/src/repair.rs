//! `bowknot repair`: welds the seams of a mesh.

use crate::args::RepairOptions;
use crate::exit::{Exit, Failure};
use crate::{dump, output};
use bowknot::io::{Import, read_mesh};
use bowknot::repair::{RepairParams, RepairReport, Verdict};
use std::path::Path;

pub fn repair(options: &RepairOptions) -> Result<Exit, Failure> {
    let extension = options.out.extension().unwrap_or_default().to_ascii_lowercase();
    if extension != "obj" && extension != "ply" {
        return Err(Failure::input(format!(
            "{}: a repaired mesh is written as .obj or .ply",
            options.out.display()
        )));
    }
    let mesh = read_mesh(&options.mesh, &Import::default())?;
    let params = RepairParams { weld_distance: options.weld_distance };
    let (clean, report) = bowknot::repair::repair(&mesh, &params)
        .map_err(|error| Failure::input(format!("{}: {error}", options.mesh.display())))?;
    dump::write_view(&options.out, &clean.view())?;
    if options.json {
        output::print_json(&report)?;
    } else {
        output::print(&to_text(&report, &options.out))?;
    }
    Ok(if report.after.intersections == 0 { Exit::Success } else { Exit::CheckFailed })
}

fn to_text(report: &RepairReport, out: &Path) -> String {
    let mut lines = Vec::new();
    lines.push(match &report.before {
        Some(before) => format!("before: {}", counts(before)),
        None => "before: cannot be checked, because a triangle or strand names a vertex twice".to_owned(),
    });
    let mut welds = format!(
        "welded {} border vertices nearer than {:.3e} m, moving none by more than {:.3e} m",
        report.welded_vertices, report.weld_distance, report.largest_move
    );
    if let Some([x, y, z]) = report.weld_places.first() {
        welds += &format!("; the first at ({x:.6}, {y:.6}, {z:.6})");
    }
    lines.push(welds);
    for (count, what) in [
        (report.split_triangles, "split triangles at vertices of T-seams"),
        (report.zero_area_triangles, "dropped triangles without area"),
        (report.repeated_triangles, "dropped triangles given twice"),
        (report.dropped_strands, "dropped strand edges given twice or without length"),
        (report.unused_vertices, "dropped vertices that no element used"),
    ] {
        if count > 0 {
            lines.push(format!("{what}: {count}"));
        }
    }
    lines.push(format!("after: {}", counts(&report.after)));
    for entry in &report.after.by_parts {
        let ([a, b], [n, m]) = (entry.parts, entry.vertices);
        lines.push(if a == b {
            format!("  part {a} ({n} vertices) with itself: {}", entry.count)
        } else {
            format!("  part {a} ({n} vertices) with part {b} ({m} vertices): {}", entry.count)
        });
    }
    lines.extend(report.after.findings.iter().map(|finding| format!("  {finding}")));
    lines.push(format!("wrote {}", out.display()));
    if report.after.intersections > 0 {
        let remedy = "a larger --weld-distance closes wider seams; `bowknot check --dump FILE` writes the \
                      triangles that intersect; a mesh for an obstacle needs no further repair, since obstacles \
                      may intersect themselves";
        lines.push(remedy.to_owned());
    }
    lines.join("\n")
}

fn counts(verdict: &Verdict) -> String {
    format!(
        "{} vertices, {} triangles in {} parts, {} border vertices, {} intersections",
        verdict.vertices, verdict.triangles, verdict.parts, verdict.border_vertices, verdict.intersections
    )
}
