//! States and paths judged one after another.

use super::clips::Clip;
use super::elements::{PartElement, PartNumbers};
use super::error::JudgingError;
use super::inside::inside;
use super::observer::{JudgedState, JudgingObserver};
use super::params::JudgingParams;
use super::parts::exempt;
use super::report::{FrameVerdict, HintPairOfFrame, JudgingReport, PartPairOfFrame};
use crate::check::{CheckError, Judge, Parts, PathOptions, PathReport, StateOptions};
use crate::geometry::{BodyFilter, MeshProblem, Point, check_mesh};
use crate::io::{FrameSource, Mesh};
use crate::recording::States;
use bowknot_errors::counted;
use std::path::Path;

/// Judges states and keeps what was found.
pub(super) struct StateJudging<'a> {
    params: &'a JudgingParams,
    observer: &'a mut dyn JudgingObserver,
    report: JudgingReport,
    /// Number of states in all, as far as it is known.
    total: usize,
    /// Whether the clip is a trace.
    is_trace: bool,
    /// What the clip shows.
    whole: String,
    /// The state before in the same clip.
    previous: Option<PreviousState>,
}

/// The state that was judged last, with the judge for its elements.
struct PreviousState {
    /// The mesh without its positions.
    elements: Mesh,
    /// Vertices of obstacles that are not there, see [`Mesh::absent`].
    absent: Vec<bool>,
    judge: Judge,
    positions: Vec<Point>,
}

/// A state, and what the report calls it.
struct Named<'a> {
    file: &'a Path,
    name: String,
    time: Option<f64>,
    code: Option<f64>,
}

impl<'a> StateJudging<'a> {
    /// Judges `total` states or more.
    pub fn new(params: &'a JudgingParams, observer: &'a mut dyn JudgingObserver, total: usize) -> Self {
        let report = JudgingReport::default();
        Self { params, observer, report, total, is_trace: false, whole: String::new(), previous: None }
    }

    /// Begins a clip: no path leads from the one before it.
    pub fn begin(&mut self, clip: &Clip) {
        self.is_trace = clip.is_trace;
        self.whole = clip.name();
        self.previous = None;
    }

    /// The verdict on all states.
    pub fn into_report(self) -> JudgingReport {
        self.report.finish()
    }

    /// Judges all frames of a source.
    pub fn frames(&mut self, source: &FrameSource) -> Result<(), JudgingError> {
        // The file was counted as one frame.
        self.total = self.total.max(self.report.states + source.len());
        for index in 0..source.len() {
            let file = source.path(index);
            let is_own_file = source.len() == 1 || source.path(0) != source.path(1);
            let name = match is_own_file {
                true => file.display().to_string(),
                false => format!("{}[{index}]", file.display()),
            };
            let time = source.times().map(|times| times[index]);
            let code = time.and(source.codes()).map(|codes| codes[index]);
            let mut mesh = source.read(index)?;
            // The polygons of a frame have deformed.
            if mesh.body.is_none()
                && mesh.obstacle.is_none()
                && let Some(faults) = mesh.triangulate().describe()
            {
                self.observer.warned(&format!("{}: {faults}", file.display()));
            }
            self.state(&Named { file, name, time, code }, mesh.into_surface())?;
        }
        Ok(())
    }

    /// Judges the start of a collision problem, with its half-spaces and collision groups.
    pub fn problem(&mut self, file: &Path, problem: &States) -> Result<(), JudgingError> {
        self.previous = None;
        let model = problem.collision_model().map_err(|message| JudgingError::Content {
            file: file.to_owned(),
            message: message.to_string(),
        })?;
        let mesh = Mesh {
            obstacle: Some(problem.obstacle.clone()),
            body: Some(problem.body.clone()),
            ..Mesh::default()
        };
        let named = Named { file, name: file.display().to_string(), time: None, code: None };
        self.note_problems(&named, &problem.x, &problem.triangles);
        let judge = Judge::from_model(&model);
        self.judged(&named, &mesh, &problem.x, &judge, None, Some(problem))
    }

    /// Judges a state, and the path from the one before if there is one.
    fn state(&mut self, named: &Named<'_>, mut mesh: Mesh) -> Result<(), JudgingError> {
        let bad = |source| JudgingError::Check { file: named.file.to_owned(), source };
        mesh.name_parts(&self.whole);
        // Names of faces make no other state.
        mesh.surface = None;
        let filters = exempt(&mut mesh, self.params);
        let positions = std::mem::take(&mut mesh.positions);
        let absent = mesh.absent(&positions);
        let previous = self.previous.take();
        let had_previous = previous.is_some();
        let last = previous.filter(|p| p.positions.len() == positions.len() && p.elements == mesh);
        if self.is_trace && had_previous && last.is_none() {
            let message =
                "its elements differ from those of the file before it, so that there is no path between them";
            return Err(JudgingError::Content { file: named.file.to_owned(), message: message.to_owned() });
        }
        let count = positions.len();
        if last.is_none() {
            let mut present = mesh.clone();
            present.leave_out(&absent);
            self.note_problems(named, &positions, &present.triangles);
        }
        let judge_without = |marked: [&[bool]; 2]| judge_of(&mesh, count, &filters, marked).map_err(bad);
        let mut path = None;
        let mut hint_pairs = Vec::new();
        if let Some(last) = last.as_ref().filter(|_| self.is_trace || self.params.paths) {
            // What appears or vanishes has no path.
            let common = match last.absent == absent {
                true => None,
                false => Some(judge_without([&absent, &last.absent])?),
            };
            let judge = common.as_ref().unwrap_or(&last.judge);
            let limit = if self.is_trace { self.params.listed } else { usize::MAX };
            let options = PathOptions { limit, ..PathOptions::default() };
            let mut found = judge.check_path(&last.positions, &positions, &options).map_err(bad)?;
            if !self.is_trace {
                // What intersects in the frame before is no news.
                found.hits.retain(|hit| hit.time > 0.0);
                found.hit_count = found.hits.len();
                hint_pairs = HintPairOfFrame::all_of(&found.hits, &mesh.names);
                found.hits.truncate(self.params.listed);
            }
            path = Some(found);
        }
        let judge = match last {
            Some(last) if last.absent == absent => last.judge,
            _ => judge_without([&absent, &[]])?,
        };
        let path = path.as_ref().map(|path| (path, hint_pairs));
        self.judged(named, &mesh, &positions, &judge, path, None)?;
        self.previous = Some(PreviousState { elements: mesh, absent, judge, positions });
        Ok(())
    }

    /// Adds the verdict on a state, and that on the `path` to it.
    fn judged(
        &mut self,
        named: &Named<'_>,
        mesh: &Mesh,
        positions: &[Point],
        judge: &Judge,
        path: Option<(&PathReport, Vec<HintPairOfFrame>)>,
        problem: Option<&States>,
    ) -> Result<(), JudgingError> {
        let Named { file, name, time, code } = named;
        let (path, hint_pairs) = path.map_or((None, Vec::new()), |(path, pairs)| (Some(path), pairs));
        let options = StateOptions { limit: self.params.listed, distance: true };
        let report = judge
            .check_state(positions, &options)
            .map_err(|source| JudgingError::Check { file: (*file).to_owned(), source })?;
        let names = &mesh.names;
        // Numbers within the parts say something new where there are several.
        let shown = path.filter(|_| self.is_trace || report.is_clear()).map_or(&[][..], |path| &path.hits);
        let numbers =
            (names.len() > 1 && !(report.is_clear() && shown.is_empty())).then(|| PartNumbers::new(mesh));
        let elements: Vec<_> =
            numbers.iter().flat_map(|n| report.intersections.iter().map(|i| n.of(i))).collect();
        let within = |pair: Option<&[PartElement; 2]>| {
            pair.map_or_else(String::new, |[a, b]| format!("; by its part: {a} and {b}"))
        };
        let found = report.intersections.iter().enumerate();
        let mut findings: Vec<String> =
            found.map(|(k, i)| i.in_words(names) + &within(elements.get(k))).collect();
        findings.extend(more(report.intersection_count, findings.len()));
        if let (Some(limit), Some(nearest)) = (self.params.min_distance, &report.nearest)
            && nearest.distance < limit
        {
            self.report.too_near = true;
            if report.is_clear() {
                findings.push(format!("{}, below {limit:.3e} m", nearest.in_words(names)));
            }
        }
        // Where the frame intersects, it would be no wonder that something meets on the way.
        if let Some(path) = path.filter(|_| self.is_trace || report.is_clear()) {
            let hint = if self.is_trace { "" } else { " (a hint: straight between the frames)" };
            findings.extend(path.hits.iter().map(|hit| {
                let elements = numbers.as_ref().map(|numbers| numbers.of_hit(hit));
                hit.in_words(names) + &within(elements.as_ref()) + hint
            }));
            findings.extend(more(path.hit_count, path.hits.len()));
        }
        let state = JudgedState { file, name, mesh, positions, judge, report: &report, problem };
        let goes_on = report.is_clear() || self.observer.intersected(&state);
        self.report.add_inside(&inside(mesh, positions, &report.body_pairs), names, name);
        let hits = path.map(|path| path.hit_count);
        self.report.add(FrameVerdict {
            file: name.clone(),
            time_s: *time,
            time_code: *code,
            intersections: report.intersection_count,
            path_hits: hits.filter(|_| self.is_trace),
            hints_between_frames: hits.filter(|_| !self.is_trace),
            min_distance_m: report.nearest.as_ref().map(|nearest| nearest.distance),
            pairs: report.body_pairs.iter().map(|pair| PartPairOfFrame::new(pair, names)).collect(),
            findings,
            elements,
            hint_pairs,
        });
        let done = self.report.states;
        self.total = self.total.max(done);
        if goes_on && self.observer.progressed(done, self.total) {
            Ok(())
        } else {
            Err(JudgingError::Interrupted)
        }
    }

    /// Warns of triangles that no intersection shows, but that a deformable body may not have.
    fn note_problems(&mut self, named: &Named<'_>, positions: &[Point], triangles: &[[u32; 3]]) {
        let problems: Vec<MeshProblem> = check_mesh(positions, triangles)
            .into_iter()
            .filter(|p| !matches!(p, MeshProblem::UnreferencedVertex { .. }))
            .collect();
        self.report.mesh_problems += problems.len();
        if let Some(first) = problems.first() {
            let count = counted(problems.len(), "such triangle", "such triangles");
            self.observer.warned(&format!(
                "{}: {first}; {count} in all, which a deformable body may not have: `bowknot info` lists \
                 them, `bowknot repair` drops them",
                named.name
            ));
        }
    }
}

/// A judge of a mesh without the elements of vertices that are marked in either list.
fn judge_of(
    mesh: &Mesh,
    vertex_count: usize,
    filters: &[BodyFilter],
    marked: [&[bool]; 2],
) -> Result<Judge, CheckError> {
    let mut mesh = mesh.clone();
    marked.iter().for_each(|marked| mesh.leave_out(marked));
    Judge::new(&Parts {
        vertex_count,
        triangles: &mesh.triangles,
        strands: &mesh.strands,
        particles: &mesh.particles,
        obstacle: mesh.obstacle.as_deref().unwrap_or(&[]),
        body: mesh.body.as_deref().unwrap_or(&[]),
        half_spaces: &[],
        filters,
    })
}

/// A line for the intersections that are not listed.
fn more(count: usize, listed: usize) -> Option<String> {
    (count > listed).then(|| format!("and {} more", count - listed))
}
