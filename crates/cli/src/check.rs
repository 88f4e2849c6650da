//! `bowknot check`: judge states, and the straight paths of a trace.

use crate::args::CheckOptions;
use crate::failure::{Done, Failure};
use crate::output;
use crate::progress::Bar;
use bowknot::check::{Judge, Parts, PathOptions, StateOptions};
use bowknot::geometry::Point;
use bowknot::io::{FrameStack, Import, Mesh, MeshView, files_in, read_mesh};
use bowknot::recording::States;
use serde::Serialize;
use std::path::{Path, PathBuf};

/// The verdict, as `--json` prints it.
#[derive(Debug, Default, Serialize)]
struct Report {
    /// Whether nothing intersects and nothing is too near.
    clear: bool,
    states: usize,
    paths: usize,
    /// Intersecting pairs over all states.
    intersections: usize,
    /// Pairs that meet, or are not certified not to, over all paths.
    path_hits: usize,
    /// Over all states [m].
    min_distance_m: Option<f64>,
    /// Whether a distance is below `--min-distance`.
    too_near: bool,
    files: Vec<Verdict>,
}

/// The verdict on one state and the path that leads to it.
#[derive(Debug, Serialize)]
struct Verdict {
    file: String,
    intersections: usize,
    /// None if no path leads here.
    path_hits: Option<usize>,
    min_distance_m: Option<f64>,
    /// The first findings in words.
    findings: Vec<String>,
}

pub fn check(options: &CheckOptions) -> Result<Done, Failure> {
    let groups = options.paths.iter().map(|path| expand(path)).collect::<Result<Vec<_>, _>>()?.concat();
    let mut checker = Checker {
        min_distance: options.min_distance,
        list: options.list,
        dump: options.dump.as_deref(),
        dumped: None,
        judged: None,
        report: Report::default(),
        bar: Bar::new(groups.iter().map(|g| g.files.len()).sum(), "files", false),
    };
    for group in &groups {
        checker.group(group)?;
    }
    let dumped = checker.dumped;
    let mut report = checker.report;
    report.clear = report.intersections == 0 && report.path_hits == 0 && !report.too_near;
    checker.bar.finish();

    if options.json {
        output::print_json(&report)?;
    } else {
        output::print(&in_words(&report, options.min_distance))?;
        if let (Some(triangles), Some(path)) = (dumped, &options.dump) {
            output::print(&format!("wrote {triangles} triangles to {}", path.display()))?;
        }
    }
    Ok(if report.clear { Done::Fine } else { Done::Found })
}

/// Files that are judged in order; joined by straight paths if they are a trace.
#[derive(Clone, Debug)]
struct Group {
    files: Vec<PathBuf>,
    trace: bool,
}

/// A file by itself, the frames of a folder, or the frames and the trace of a run.
fn expand(path: &Path) -> Result<Vec<Group>, Failure> {
    if !path.is_dir() {
        return Ok(vec![Group { files: vec![path.to_owned()], trace: false }]);
    }
    let mut groups = Vec::new();
    for folder in [path.join("frames"), path.join("trace")] {
        if folder.is_dir() {
            groups.extend(group_of(&folder)?);
        }
    }
    // Of a run this is `frames.npz`; of any other folder its frames.
    groups.extend(group_of(path)?);
    if groups.is_empty() {
        let message = "no frames (.ply, .obj, .npz) in it, nor in frames/ or trace/ below it";
        return Err(Failure::input(format!("{}: {message}", path.display())));
    }
    Ok(groups)
}

/// The frames that lie directly in a folder, in natural order.
fn group_of(folder: &Path) -> Result<Option<Group>, Failure> {
    let files = files_in(folder, &["ply", "obj", "npz"])?;
    // `trace/.` names the folder as well.
    let real = folder.canonicalize().unwrap_or_else(|_| folder.to_owned());
    let trace = real.file_name().is_some_and(|n| n == "trace");
    Ok((!files.is_empty()).then_some(Group { files, trace }))
}

fn ending(path: &Path) -> String {
    path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase()
}

/// What is fixed about the states that were judged last.
struct Judged {
    elements: Mesh,
    judge: Judge,
    last: Vec<Point>,
}

struct Checker<'a> {
    min_distance: Option<f64>,
    /// Most findings that are written out for a state or path.
    list: usize,
    /// Where the offending elements go.
    dump: Option<&'a Path>,
    /// Triangles written there.
    dumped: Option<usize>,
    judged: Option<Judged>,
    report: Report,
    bar: Bar,
}

impl Checker<'_> {
    fn group(&mut self, group: &Group) -> Result<(), Failure> {
        let mut joined = false;
        for file in &group.files {
            if ending(file) == "npz" {
                self.archive(file)?;
                joined = false;
            } else {
                let mesh = read_mesh(file, &Import::default())?.into_surface();
                self.state(file, file.display().to_string(), mesh, joined)?;
                joined = group.trace;
            }
            self.bar.advance(1);
        }
        Ok(())
    }

    /// Frames of an `X`, or the start of a recorded problem.
    fn archive(&mut self, file: &Path) -> Result<(), Failure> {
        let frames = FrameStack::read(file).or_else(|error| match States::read(file) {
            Ok(states) => {
                let view = MeshView {
                    positions: &states.x,
                    triangles: &states.triangles,
                    strands: &states.strands,
                    particles: &states.particles,
                    obstacle: &states.obstacle,
                    ..MeshView::default()
                };
                let mut stack = FrameStack::new(&view, &[]);
                // The stack was made for as many vertices as there are.
                let _ = stack.push(&states.x);
                Ok(stack)
            }
            Err(_) => Err(error),
        })?;
        let view = frames.mesh();
        for (index, positions) in (0..frames.len()).filter_map(|i| Some((i, frames.frame(i)?))) {
            let mesh = Mesh {
                positions,
                triangles: view.triangles.to_vec(),
                strands: view.strands.to_vec(),
                particles: view.particles.to_vec(),
                obstacle: Some(view.obstacle.to_vec()),
                ..Mesh::default()
            };
            self.state(file, format!("{}[{index}]", file.display()), mesh, false)?;
        }
        Ok(())
    }

    /// Judges a state, and the path from the last one if they are joined.
    fn state(&mut self, file: &Path, name: String, mut mesh: Mesh, joined: bool) -> Result<(), Failure> {
        let fault = |error| Failure::judge(file, &error);
        let positions = std::mem::take(&mut mesh.positions);
        let previous = self.judged.take();
        let same = previous.as_ref().is_some_and(|j| j.last.len() == positions.len() && j.elements == mesh);
        if joined && !same {
            let message = "its elements differ from those of the file before it, so that no path joins them";
            return Err(Failure::input(format!("{}: {message}", file.display())));
        }
        let (judge, last) = match previous {
            Some(previous) if same => (previous.judge, Some(previous.last)),
            _ => {
                let parts = Parts {
                    vertex_count: positions.len(),
                    triangles: &mesh.triangles,
                    strands: &mesh.strands,
                    particles: &mesh.particles,
                    obstacle: mesh.obstacle.as_deref().unwrap_or(&[]),
                    body: mesh.body.as_deref().unwrap_or(&[]),
                    half_spaces: &[],
                };
                (Judge::new(&parts).map_err(fault)?, None)
            }
        };

        let dump = self.dump.filter(|_| self.dumped.is_none());
        let limit = if dump.is_some() { usize::MAX } else { self.list };
        let state = judge.check_state(&positions, &StateOptions { limit, distance: true }).map_err(fault)?;
        let listed = state.intersections.iter().take(self.list);
        let mut findings: Vec<String> = listed.map(ToString::to_string).collect();
        findings.extend(more(state.intersection_count, findings.len()));
        if let Some(path) = dump.filter(|_| !state.is_clear()) {
            let offending = judge.offending_mesh(&positions, &state.intersections);
            let of = |v: &u32| *v as usize;
            let obstacle: Vec<bool> = offending
                .vertices
                .iter()
                .filter_map(|v| mesh.obstacle.as_ref()?.get(of(v)).copied())
                .collect();
            let body: Vec<u32> =
                offending.vertices.iter().filter_map(|v| mesh.body.as_ref()?.get(of(v)).copied()).collect();
            crate::dump::write(path, &offending, &obstacle, &body)?;
            self.dumped = Some(offending.triangles.len());
        }
        let distance = state.nearest.as_ref().map(|nearest| nearest.distance);
        if let (Some(least), Some(nearest)) = (self.min_distance, &state.nearest)
            && nearest.distance < least
            && state.is_clear()
        {
            findings.push(format!("{nearest}, below {least:.3e} m"));
        }
        self.report.too_near |= distance.zip(self.min_distance).is_some_and(|(found, least)| found < least);

        let mut path_hits = None;
        if let Some(last) = last.filter(|_| joined) {
            let options = PathOptions { limit: self.list, ..PathOptions::default() };
            let path = judge.check_path(&last, &positions, &options).map_err(fault)?;
            findings.extend(path.hits.iter().map(ToString::to_string));
            findings.extend(more(path.hit_count, path.hits.len()));
            path_hits = Some(path.hit_count);
            self.report.paths += 1;
            self.report.path_hits += path.hit_count;
        }

        self.report.states += 1;
        self.report.intersections += state.intersection_count;
        self.report.min_distance_m = match (self.report.min_distance_m, distance) {
            (Some(a), Some(b)) => Some(a.min(b)),
            (a, b) => a.or(b),
        };
        let verdict = Verdict {
            file: name,
            intersections: state.intersection_count,
            path_hits,
            min_distance_m: distance,
            findings,
        };
        self.report.files.push(verdict);
        self.judged = Some(Judged { elements: mesh, judge, last: positions });
        Ok(())
    }
}

fn more(count: usize, listed: usize) -> Option<String> {
    (count > listed).then(|| format!("and {} more", count - listed))
}

fn in_words(report: &Report, min_distance: Option<f64>) -> String {
    let mut lines: Vec<String> = report
        .files
        .iter()
        .flat_map(|verdict| {
            verdict.findings.iter().map(move |finding| format!("{}: {finding}", verdict.file))
        })
        .collect();
    let counted = |count: usize, what: &str| format!("{count} {what}{}", if count == 1 { "" } else { "s" });
    let mut summary = counted(report.states, "state");
    if report.paths > 0 {
        summary += &format!(" and {}", counted(report.paths, "path"));
    }
    summary += &match report.intersections + report.path_hits {
        0 => ": no intersection".to_owned(),
        count => format!(": {}", counted(count, "intersection")),
    };
    if let Some(distance) = report.min_distance_m {
        summary += &format!("; smallest distance {distance:.3e} m");
    }
    if let Some(least) = min_distance.filter(|_| report.too_near) {
        summary += &format!(", below {least:.3e} m");
    }
    lines.push(summary);
    lines.join("\n")
}
