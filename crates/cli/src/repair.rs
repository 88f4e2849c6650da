//! `bowknot repair`: welds the seams of a mesh, and mends its tetrahedra.

use crate::args::RepairOptions;
use crate::exit::{Exit, Failure};
use crate::{dump, output};
use bowknot::io::{Import, Labels, Mesh, read_mesh, write_msh, write_tet_list};
use bowknot::repair::{Found, RepairParams, RepairReport, SolidRepair, Verdict};
use bowknot_errors::counted;
use std::path::Path;

pub fn repair(options: &RepairOptions) -> Result<Exit, Failure> {
    let extension = options.out.extension().unwrap_or_default().to_ascii_lowercase();
    let extension = extension.to_str().unwrap_or_default();
    let (surface, solid) = (["obj", "ply"].contains(&extension), ["msh", "t"].contains(&extension));
    if !surface && !solid {
        return Err(Failure::input(format!(
            "{}: a repaired mesh is written as .obj or .ply, one of tetrahedra as .msh or .t",
            options.out.display()
        )));
    }
    output::refuse_overwrite(&options.out, &[&options.mesh])?;
    let mut mesh = read_mesh(&options.mesh, &Import::default())?;
    if let Some(faults) = mesh.triangulate().describe() {
        eprintln!("warning: {}: {faults}", options.mesh.display());
    }
    let is_solid = !mesh.tets.is_empty();
    if is_solid != solid && (is_solid || !mesh.triangles.is_empty()) {
        let holds = if solid {
            "has no tetrahedra: write it as .obj or .ply"
        } else {
            "has tetrahedra, which .obj and .ply cannot hold: write it as .msh or .t"
        };
        return Err(Failure::input(format!("{}: {} {holds}", options.out.display(), options.mesh.display())));
    }
    let params = RepairParams {
        weld_distance: options.weld_distance,
        drop_lines: options.drop_lines,
        drop_triangles: options.drop_triangles,
    };
    let (clean, report) = bowknot::repair::repair(&mesh, &params)
        .map_err(|error| Failure::input(format!("{}: {error}", options.mesh.display())))?;
    match extension {
        "msh" => write_msh(&options.out, &clean.view())?,
        "t" => write_tet_list(&options.out, &clean.view())?,
        _ => dump::write_view(&options.out, &clean.view())?,
    }
    if options.json {
        output::print_json(&report)?;
    } else {
        output::print(&to_text(&report, &options.out, &left_out(&clean, extension)))?;
    }
    Ok(if report.after.intersections == 0 { Exit::Success } else { Exit::CheckFailed })
}

/// What the mesh has but the format cannot hold.
fn left_out(mesh: &Mesh, extension: &str) -> Vec<&'static str> {
    if extension == "t" && !mesh.strands.is_empty() {
        return vec!["lines"];
    }
    let is_ply = extension == "ply";
    let Some(surface) = mesh.surface.as_ref().filter(|_| is_ply) else { return Vec::new() };
    let has_texture = surface.corners().iter().any(|corner| corner.texture().is_some());
    let fits = surface.vertex_texture_coordinates(mesh.positions.len()).is_some();
    let has_names = surface.polygons().any(|polygon| *polygon.labels != Labels::default());
    [
        (has_texture && !fits, "texture coordinates, because some vertices have two"),
        (surface.normal_count() > 0, "normals"),
        (has_names, "names of objects, groups and materials"),
    ]
    .into_iter()
    .filter_map(|(is_left_out, what)| is_left_out.then_some(what))
    .collect()
}

fn to_text(report: &RepairReport, out: &Path, left_out: &[&str]) -> String {
    let mut lines = Vec::new();
    lines.push(match &report.before {
        Some(before) => format!("before: {}", counts(before)),
        None => "before: cannot be checked, because a tetrahedron, triangle or strand names a vertex twice"
            .to_owned(),
    });
    // The file may be in centimeters: a mesh is repaired in its own unit, and written in it.
    let welded = match report.solid {
        Some(_) => counted(report.welded_vertices, "vertex", "vertices"),
        None => counted(report.welded_vertices, "border vertex", "border vertices"),
    };
    let mut welds = format!(
        "welded {welded} nearer than {:.3e}, moving none by more than {:.3e} (units of the file)",
        report.weld_distance, report.largest_move
    );
    if let Some([x, y, z]) = report.weld_places.first() {
        welds += &format!("; the first at ({x:.6}, {y:.6}, {z:.6})");
    }
    lines.push(welds);
    for (count, what) in [
        (report.split_triangles, "split triangles at vertices of T-seams"),
        (report.zero_area_triangles, "dropped triangles without area"),
        (report.repeated_triangles, "dropped triangles given twice"),
        (report.cut_polygons, "cut polygons around these triangles"),
        (report.dropped_strands, "dropped lines"),
        (
            report.lines,
            "lines that stay (--drop-lines drops them; a solid may have none, nor may cloth that join its \
             triangles)",
        ),
        (report.unused_vertices, "dropped vertices that no element used"),
    ] {
        if count > 0 {
            lines.push(format!("{what}: {count}"));
        }
    }
    lines.extend(report.solid.iter().flat_map(of_solid));
    lines.push(format!("after: {}", counts(&report.after)));
    for entry in &report.after.by_parts {
        let [a, b] = entry.parts;
        let [n, m] = entry.vertices.map(|count| counted(count, "vertex", "vertices"));
        lines.push(if a == b {
            format!("  part {a} ({n}) with itself: {}", entry.count)
        } else {
            format!("  part {a} ({n}) with part {b} ({m}): {}", entry.count)
        });
    }
    lines.extend(report.after.findings.iter().map(|finding| format!("  {finding}")));
    lines.push(format!("wrote {}", out.display()));
    if !left_out.is_empty() {
        let can = if report.solid.is_some() { ".msh" } else { ".obj" };
        let what = left_out.join("; ");
        lines.push(format!("left out, because the format cannot hold it ({can} can): {what}"));
    }
    if report.largest_move > report.weld_distance {
        lines.push(
            "the weld distance joins vertices in chains, far beyond its own length: give a smaller \
             --weld-distance"
                .to_owned(),
        );
    } else if report.solid.is_some() {
        if report.after.intersections > 0 {
            lines.push(
                "the surface of the solid intersects: mesh it anew there, or give a larger --weld-distance \
                 if vertices should lie together"
                    .to_owned(),
            );
        }
    } else if report.after.parts > 1 && report.welded_vertices == 0 {
        lines.push(
            "no borders lie together within the weld distance, and parts stay apart: if they are panels of \
             one garment, give a larger --weld-distance"
                .to_owned(),
        );
    } else if report.after.intersections > 0 {
        let remedy = "a larger --weld-distance closes wider seams; `bowknot check --dump FILE` writes the \
                      triangles that intersect; a mesh for an obstacle needs no further repair, since \
                      obstacles may intersect themselves";
        lines.push(remedy.to_owned());
    }
    lines.join("\n")
}

/// What was done to tetrahedra, with the center of the first.
fn of_solid(solid: &SolidRepair) -> Vec<String> {
    let mut lines = Vec::new();
    let mut tell = |what: &str, found: &Found| {
        let Found { count, first: Some([x, y, z]) } = *found else { return };
        lines.push(format!("{what}: {count}; the first at ({x:.6}, {y:.6}, {z:.6})"));
    };
    tell("dropped tetrahedra that named a vertex twice", &solid.repeated_vertices);
    tell("dropped tetrahedra given twice", &solid.repeated_tets);
    tell("dropped flat tetrahedra", &solid.flat_dropped);
    tell("collapsed flat tetrahedra, whose neighbors now meet", &solid.flat_collapsed);
    tell("ordered the vertices of tetrahedra that were inside out", &solid.turned);
    tell("dropped tetrahedra on the same side of a face as another", &solid.overlapping);
    tell("triangles that stay (--drop-triangles drops them; a solid may have none)", &solid.triangles);
    tell("thin tetrahedra that stay, lower than a hundredth of their longest edge", &solid.thin);
    if let Some((thinness, [x, y, z])) = solid.thinnest.filter(|_| solid.thin.count > 0) {
        lines.push(format!(
            "  the thinnest, {thinness:.1e} of its longest edge high, at ({x:.6}, {y:.6}, {z:.6})"
        ));
    }
    for (count, what) in [
        (solid.added_vertices, "added vertices where edges crossed"),
        (solid.dropped_triangles, "dropped triangles"),
    ] {
        if count > 0 {
            lines.push(format!("{what}: {count}"));
        }
    }
    let [before, after] = solid.volume;
    lines.push(format!("volume: {before:.6e} before, {after:.6e} after (units of the file, cubed)"));
    lines
}

fn counts(verdict: &Verdict) -> String {
    let tets = match verdict.tets {
        0 => String::new(),
        count => counted(count, "tetrahedron, ", "tetrahedra, "),
    };
    format!(
        "{}, {tets}{} in {}, {}, {}",
        counted(verdict.vertices, "vertex", "vertices"),
        counted(verdict.triangles, "triangle", "triangles"),
        counted(verdict.parts, "part", "parts"),
        counted(verdict.border_vertices, "border vertex", "border vertices"),
        counted(verdict.intersections, "intersection", "intersections")
    )
}
