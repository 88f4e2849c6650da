//! `bowknot check`: checks states, and the straight paths between the states of a trace, for intersections.

mod files;
mod smallest;

use crate::args::CheckOptions;
use crate::exit::{Exit, Failure};
use crate::progress::Bar;
use crate::{archive, failure_dump, output};
use bowknot::check::{CheckError, Judge, Parts, PathOptions, PathReport, StateOptions};
use bowknot::geometry::{MeshProblem, Point, check_mesh};
use bowknot::io::{Import, Mesh, read_mesh};
use bowknot::recording::States;
use bowknot_errors::counted;
use files::{Group, extension, groups_of};
use serde::Serialize;
use std::path::{Path, PathBuf};

/// The result, as `--json` prints it.
#[derive(Debug, Default, Serialize)]
struct Report {
    /// Whether nothing intersects and nothing is too near.
    clear: bool,
    states: usize,
    paths: usize,
    /// Intersecting pairs over all states.
    intersections: usize,
    /// Pairs that meet, or are not certified to stay apart, over all paths.
    path_hits: usize,
    /// Triangles that no deformable body may have, over all meshes; they do not count as intersections.
    mesh_problems: usize,
    /// Smallest distance over all states [m].
    min_distance_m: Option<f64>,
    /// Whether a distance is below `--min-distance`.
    too_near: bool,
    files: Vec<Entry>,
}

/// The result for one state and the path that leads to it.
#[derive(Debug, Serialize)]
struct Entry {
    file: String,
    intersections: usize,
    /// None if no path leads to it.
    path_hits: Option<usize>,
    min_distance_m: Option<f64>,
    /// The first intersections, as text.
    findings: Vec<String>,
}

pub fn check(options: &CheckOptions) -> Result<Exit, Failure> {
    if let Some(dump) = &options.dump {
        let paths: Vec<&Path> = options.paths.iter().map(PathBuf::as_path).collect();
        output::refuse_overwrite(dump, &paths)?;
    }
    if let Some(dump) = &options.dump_on_failure {
        let paths: Vec<&Path> = options.paths.iter().map(PathBuf::as_path).collect();
        failure_dump::refuse(dump, &paths)?;
    }
    let groups = options.paths.iter().map(|path| groups_of(path)).collect::<Result<Vec<_>, _>>()?.concat();
    let mut checker = Checker {
        min_distance: options.min_distance,
        list: options.list,
        dump: options.dump.as_deref(),
        dumped: None,
        failure_dump: options.dump_on_failure.as_deref(),
        smallest: None,
        previous: None,
        report: Report::default(),
        bar: Bar::new(groups.iter().map(|g| g.files.len()).sum(), "files", false),
    };
    for group in &groups {
        checker.group(group)?;
    }
    let (dumped, smallest) = (checker.dumped, checker.smallest);
    let mut report = checker.report;
    report.clear = report.intersections == 0 && report.path_hits == 0 && !report.too_near;
    checker.bar.finish();

    if options.json {
        output::print_json(&report)?;
    } else {
        output::print(&to_text(&report, options.min_distance))?;
        if let (Some(triangles), Some(path)) = (dumped, &options.dump) {
            output::print(&format!(
                "wrote {} to {}",
                counted(triangles, "triangle", "triangles"),
                path.display()
            ))?;
        }
    }
    if let Some(text) = smallest {
        eprintln!("{text}");
    }
    Ok(if report.clear { Exit::Success } else { Exit::CheckFailed })
}

/// A state of a file, with the judge of its elements.
struct StateOfFile<'a> {
    file: &'a Path,
    mesh: &'a Mesh,
    positions: &'a [Point],
    judge: &'a Judge,
}

/// The state that was checked last, with the judge for its elements.
struct PreviousState {
    /// The mesh without its positions.
    elements: Mesh,
    /// Vertices of obstacles that are not there, see [`Mesh::absent`].
    absent: Vec<bool>,
    judge: Judge,
    positions: Vec<Point>,
}

struct Checker<'a> {
    min_distance: Option<f64>,
    /// Largest number of intersections that are printed per state and path.
    list: usize,
    /// File for the elements that intersect.
    dump: Option<&'a Path>,
    /// Number of triangles written there.
    dumped: Option<usize>,
    /// File for the fewest elements that intersect.
    failure_dump: Option<&'a Path>,
    /// What was written there, in words.
    smallest: Option<String>,
    previous: Option<PreviousState>,
    report: Report,
    bar: Bar,
}

impl Checker<'_> {
    /// Checks the files of a group.
    fn group(&mut self, group: &Group) -> Result<(), Failure> {
        let mut joined = false;
        for file in &group.files {
            if extension(file) == "npz" {
                self.archive(file)?;
                joined = false;
            } else {
                let mut mesh = read_mesh(file, &Import::default())?;
                // The polygons of a frame have deformed.
                if mesh.body.is_none()
                    && mesh.obstacle.is_none()
                    && let Some(faults) = mesh.triangulate().describe()
                {
                    self.bar.print(&format!("warning: {}: {faults}", file.display()));
                }
                let mut mesh = mesh.into_surface();
                // Names of faces make no other state.
                mesh.surface = None;
                self.state(file, file.display().to_string(), mesh, joined)?;
                joined = group.trace;
            }
            self.bar.advance(1);
        }
        Ok(())
    }

    /// Checks an archive: its frames `X`, or the start of a recorded problem.
    fn archive(&mut self, file: &Path) -> Result<(), Failure> {
        self.previous = None;
        if archive::is_problem(file)? {
            return self.problem(file, &States::read(file)?);
        }
        let frames = archive::read(file)?;
        for index in 0..frames.len() {
            self.state(file, format!("{}[{index}]", file.display()), frames.frame_mesh(index), false)?;
        }
        Ok(())
    }

    /// Checks the start of a problem, with its half-spaces and collision groups.
    fn problem(&mut self, file: &Path, states: &States) -> Result<(), Failure> {
        let name = file.display().to_string();
        let model = states.collision_model().map_err(|error| Failure::input(format!("{name}: {error}")))?;
        let judge = Judge::from_model(&model);
        let mesh = Mesh {
            obstacle: Some(states.obstacle.clone()),
            body: Some(states.body.clone()),
            ..Mesh::default()
        };
        self.note_problems(&name, &states.x, &states.triangles);
        let state = StateOfFile { file, mesh: &mesh, positions: &states.x, judge: &judge };
        self.judged(&state, name, None, || states.clone())
    }

    /// Checks a state, and the path from the previous one if `joined`.
    fn state(&mut self, file: &Path, name: String, mut mesh: Mesh, joined: bool) -> Result<(), Failure> {
        let bad_input = |error| Failure::check(file, &error);
        let positions = std::mem::take(&mut mesh.positions);
        let absent = mesh.absent(&positions);
        let previous = self.previous.take();
        let same =
            previous.as_ref().is_some_and(|p| p.positions.len() == positions.len() && p.elements == mesh);
        if joined && !same {
            let message =
                "its elements differ from those of the file before it, so that there is no path between them";
            return Err(Failure::input(format!("{}: {message}", file.display())));
        }
        let last = previous.filter(|_| same);
        let count = positions.len();
        if last.is_none() {
            let mut present = mesh.clone();
            present.leave_out(&absent);
            self.note_problems(&name, &positions, &present.triangles);
        }
        let mut path = None;
        if let Some(last) = last.as_ref().filter(|_| joined) {
            // What appears or vanishes has no path.
            let common = match last.absent == absent {
                true => None,
                false => Some(judge_of(&mesh, count, [&absent, &last.absent]).map_err(bad_input)?),
            };
            let judge = common.as_ref().unwrap_or(&last.judge);
            let options = PathOptions { limit: self.list, ..PathOptions::default() };
            path = Some(judge.check_path(&last.positions, &positions, &options).map_err(bad_input)?);
        }
        let judge = match last {
            Some(last) if last.absent == absent => last.judge,
            _ => judge_of(&mesh, count, [&absent, &[]]).map_err(bad_input)?,
        };
        let state = StateOfFile { file, mesh: &mesh, positions: &positions, judge: &judge };
        self.judged(&state, name, path, || {
            let mut present = mesh.clone();
            present.leave_out(&absent);
            smallest::state_of(&present, &positions)
        })?;
        self.previous = Some(PreviousState { elements: mesh, absent, judge, positions });
        Ok(())
    }

    /// Adds the verdict on a state, and that on the `path` to it. The mesh says what is of an obstacle and of
    /// which body.
    fn judged(
        &mut self,
        &StateOfFile { file, mesh, positions, judge }: &StateOfFile<'_>,
        name: String,
        path: Option<PathReport>,
        states: impl FnOnce() -> States,
    ) -> Result<(), Failure> {
        let bad_input = |error| Failure::check(file, &error);
        let dump = self.dump.filter(|_| self.dumped.is_none());
        let limit = if dump.is_some() { usize::MAX } else { self.list };
        let state =
            judge.check_state(positions, &StateOptions { limit, distance: true }).map_err(bad_input)?;
        let listed = state.intersections.iter().take(self.list);
        let mut findings: Vec<String> = listed.map(ToString::to_string).collect();
        findings.extend(more(state.intersection_count, findings.len()));
        if let Some(path) = dump.filter(|_| !state.is_clear()) {
            let offending = judge.offending_mesh(positions, &state.intersections);
            let obstacle: Vec<bool> = offending
                .vertices
                .iter()
                .filter_map(|v| mesh.obstacle.as_ref()?.get(*v as usize).copied())
                .collect();
            let body: Vec<u32> = offending
                .vertices
                .iter()
                .filter_map(|v| mesh.body.as_ref()?.get(*v as usize).copied())
                .collect();
            crate::dump::write(path, &offending, &obstacle, &body)?;
            self.dumped = Some(offending.triangles.len());
        }
        if let Some(file) = self.failure_dump.filter(|_| !state.is_clear() && self.smallest.is_none()) {
            self.smallest = Some(smallest::write(file, &states())?);
        }
        let distance = state.nearest.as_ref().map(|nearest| nearest.distance);
        if let (Some(limit), Some(nearest)) = (self.min_distance, &state.nearest)
            && nearest.distance < limit
            && state.is_clear()
        {
            findings.push(format!("{nearest}, below {limit:.3e} m"));
        }
        self.report.too_near |= distance.zip(self.min_distance).is_some_and(|(found, limit)| found < limit);

        let mut path_hits = None;
        if let Some(path) = path {
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
        let entry = Entry {
            file: name,
            intersections: state.intersection_count,
            path_hits,
            min_distance_m: distance,
            findings,
        };
        self.report.files.push(entry);
        Ok(())
    }
}

impl Checker<'_> {
    /// Warns of triangles that no intersection shows, but that a deformable body may not have.
    fn note_problems(&mut self, name: &str, positions: &[Point], triangles: &[[u32; 3]]) {
        let problems: Vec<MeshProblem> = check_mesh(positions, triangles)
            .into_iter()
            .filter(|p| !matches!(p, MeshProblem::UnreferencedVertex { .. }))
            .collect();
        self.report.mesh_problems += problems.len();
        if let Some(first) = problems.first() {
            self.bar.print(&format!(
                "warning: {name}: {first}; {} in all, which a deformable body may not have: `bowknot info` \
                 lists them, `bowknot repair` drops them",
                counted(problems.len(), "such triangle", "such triangles")
            ));
        }
    }
}

/// A judge of a mesh without the elements of vertices that are marked in either list.
fn judge_of(mesh: &Mesh, vertex_count: usize, marked: [&[bool]; 2]) -> Result<Judge, CheckError> {
    let mut mesh = mesh.clone();
    marked.iter().for_each(|marked| mesh.leave_out(marked));
    Judge::new(&Parts {
        vertex_count,
        triangles: &mesh.triangles,
        strands: &mesh.strands,
        particles: &mesh.particles,
        obstacle: mesh.obstacle.as_deref().unwrap_or(&[]),
        body: mesh.body.as_deref().unwrap_or(&[]),
        ..Parts::default()
    })
}

/// A line for the intersections that are not listed.
fn more(count: usize, listed: usize) -> Option<String> {
    (count > listed).then(|| format!("and {} more", count - listed))
}

fn to_text(report: &Report, min_distance: Option<f64>) -> String {
    let mut lines: Vec<String> = report
        .files
        .iter()
        .flat_map(|entry| entry.findings.iter().map(move |finding| format!("{}: {finding}", entry.file)))
        .collect();
    let mut summary = counted(report.states, "state", "states");
    if report.paths > 0 {
        summary += &format!(" and {}", counted(report.paths, "path", "paths"));
    }
    summary += &match report.intersections + report.path_hits {
        0 => ": no intersection".to_owned(),
        count => format!(": {}", counted(count, "intersection", "intersections")),
    };
    if let Some(distance) = report.min_distance_m {
        summary += &format!("; smallest distance {distance:.3e} m");
    }
    if let Some(limit) = min_distance.filter(|_| report.too_near) {
        summary += &format!(", below {limit:.3e} m");
    }
    lines.push(summary);
    lines.join("\n")
}
