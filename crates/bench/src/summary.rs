//! Results of settings on the problems of scenes, summed up.

use crate::bench::Bench;
use crate::case::{CollisionCase, cases};
use crate::chart::{Series, Style};
use crate::methods::{Setting, name_of};
use crate::solve::{Against, Solved, compare};
use crate::table::{Entry, Table, largest, mean, smallest};
use anyhow::Result;

/// Smallest error that counts, in mean edge lengths: a tenth of the tolerance of most methods. Ratios of smaller ones, such
/// as of problems whose targets are reached, would be those of roundings.
const LEAST_ERROR: f64 = 1e-3;

/// Results of one setting on the problems of a scene: means over the problems, unless a field says otherwise.
#[derive(Clone, Debug)]
pub struct Summary {
    pub method: &'static str,
    pub change: String,
    pub cpu: f64,
    /// Distance to the reference solution [m]; none if one of the problems has no reference solution.
    pub distance_to_reference: Option<f64>,
    pub stationarity: f64,
    /// Violation of contacts [m].
    pub violation: f64,
    /// Largest excess of an edge over its limit as a share of the limit, times the mean edge length [m].
    pub excess: f64,
    /// Distance to the target [m].
    pub distance: f64,
    /// Smallest error that counts [m].
    pub least_error: f64,
    pub steps: f64,
    /// Largest number of steps.
    pub most_steps: f64,
    pub searches: f64,
    /// Largest ratio of an edge's length to its rest length.
    pub stretch: f64,
    /// Smallest gap [m]; infinite if no pair was in range.
    pub gap: f64,
    /// Number of calls that met the method's own stopping rule.
    pub met: usize,
    /// Number of calls that failed.
    pub failed: usize,
    /// Number of calls, one per problem.
    pub problems: usize,
    /// Sum over the problems.
    pub intersections: usize,
    /// Wall seconds of search, evaluation, backward step, forward step.
    pub stages: [f64; 4],
}

/// The problems of a scene, solved by several settings.
#[derive(Clone, Debug)]
pub struct Compared {
    pub scene: &'static str,
    pub cases: Vec<CollisionCase>,
    /// One entry per problem that there was time for, and setting.
    pub solved: Vec<Vec<Solved>>,
    /// One entry per setting.
    pub summaries: Vec<Summary>,
}

/// Solves `count` problems of each scene by every setting, in `rounds` rounds.
pub fn on_scenes(
    bench: &Bench,
    scenes: &[&'static str],
    count: usize,
    settings: &[Setting],
    rounds: usize,
    against: Against,
) -> Result<Vec<Compared>> {
    let mut by_scene = Vec::new();
    for scene in scenes {
        by_scene.push(cases(bench, scene, count)?);
    }
    on_cases(bench, scenes, by_scene, settings, rounds, against)
}

/// Solves the given problems of each scene by every setting, in `rounds` rounds.
pub fn on_cases(
    bench: &Bench,
    scenes: &[&'static str],
    by_scene: Vec<Vec<CollisionCase>>,
    settings: &[Setting],
    rounds: usize,
    against: Against,
) -> Result<Vec<Compared>> {
    // The first problem of each scene, then the second: if time runs out, the last problems of all scenes are
    // left out.
    let mut order: Vec<(usize, usize)> =
        by_scene.iter().enumerate().flat_map(|(s, cases)| (0..cases.len()).map(move |k| (s, k))).collect();
    order.sort_by_key(|&(scene, case)| (case, scene));
    let flat: Vec<&CollisionCase> = order.iter().map(|&(s, k)| &by_scene[s][k]).collect();
    let solved = compare(bench, &flat, settings, rounds, against)?;
    let mut solved_of: Vec<Vec<Vec<Solved>>> = vec![Vec::new(); scenes.len()];
    for (&(scene, _), solved) in order.iter().zip(solved) {
        solved_of[scene].extend(solved);
    }
    let compared = scenes.iter().zip(by_scene).zip(solved_of).map(|((&scene, cases), solved)| Compared {
        scene,
        summaries: settings
            .iter()
            .enumerate()
            .filter_map(|(s, setting)| Summary::of(setting, &cases, solved.iter().map(|row| &row[s])))
            .collect(),
        cases,
        solved,
    });
    Ok(compared.filter(|c| !c.solved.is_empty()).collect())
}

impl Compared {
    /// The summary of a method with a change.
    pub fn find(&self, method: &str, change: &str) -> Option<&Summary> {
        self.summaries.iter().find(|s| s.method == method && s.change == change)
    }

    /// Whether every problem has a reference solution that errors are distances to.
    pub fn has_references(&self) -> bool {
        self.summaries.iter().all(|s| s.distance_to_reference.is_some())
    }

    /// Vertices of the scene.
    pub fn vertices(&self) -> usize {
        self.cases.first().map_or(0, |case| case.states.x.len())
    }
}

impl Summary {
    /// The summary; none if nothing was solved. All `cases` are of one scene and have the same mean edge
    /// length.
    pub fn of<'a>(
        setting: &Setting,
        cases: &[CollisionCase],
        solved: impl Iterator<Item = &'a Solved>,
    ) -> Option<Self> {
        let solved: Vec<&Solved> = solved.collect();
        if solved.is_empty() {
            return None;
        }
        let all = |value: &dyn Fn(&Solved) -> f64| solved.iter().map(|s| value(s)).collect::<Vec<f64>>();
        let of = |value: &dyn Fn(&Solved) -> f64| mean(&all(value));
        let referenced = solved.iter().all(|s| s.quality.error.is_some());
        let edge = cases.first().and_then(CollisionCase::mean_edge).unwrap_or(0.0);
        Some(Self {
            method: setting.method,
            change: setting.change.clone(),
            cpu: of(&|s| s.cpu_seconds),
            distance_to_reference: referenced.then(|| of(&|s| s.quality.error.unwrap_or(f64::NAN))),
            stationarity: of(&|s| s.quality.stationarity),
            violation: of(&|s| s.quality.violation),
            excess: of(&|s| s.quality.stretch_violation.max(0.0)) * edge,
            distance: of(&|s| s.quality.distance),
            least_error: LEAST_ERROR * edge,
            steps: of(&|s| s.steps as f64),
            most_steps: largest(&all(&|s| s.steps as f64)),
            searches: of(&|s| s.searches as f64),
            stretch: largest(&all(&|s| s.quality.rest_stretch)),
            gap: smallest(&all(&|s| s.quality.min_gap.unwrap_or(f64::INFINITY))),
            met: solved.iter().filter(|s| s.converged).count(),
            failed: solved.iter().filter(|s| s.failed).count(),
            problems: solved.len(),
            intersections: solved.iter().map(|s| s.quality.intersections).sum(),
            stages: [
                of(&|s| s.stages.search),
                of(&|s| s.stages.evaluate),
                of(&|s| s.stages.backward),
                of(&|s| s.stages.forward),
            ],
        })
    }

    /// The distance to the reference solution [m]. Without references: the root of the sum of squares of the
    /// stationarity residual and the violations of contacts and edge limits, because each alone can be small
    /// while the others are large. At least [`LEAST_ERROR`].
    pub fn error(&self, referenced: bool) -> f64 {
        let error = if referenced {
            self.distance_to_reference.unwrap_or(f64::NAN)
        } else {
            self.stationarity.hypot(self.violation).hypot(self.excess)
        };
        // Unlike `max`, it keeps what is not a number.
        if error < self.least_error { self.least_error } else { error }
    }

    /// Method and change.
    pub fn name(&self) -> String {
        name_of(self.method, &self.change)
    }

    fn row(&self, scene: &str, referenced: bool) -> Vec<Entry> {
        vec![
            scene.into(),
            self.name().into(),
            self.cpu.into(),
            (1e3 * self.error(referenced)).into(),
            if referenced { "distance".into() } else { "residuals".into() },
            self.steps.into(),
            self.most_steps.into(),
            self.searches.into(),
            self.problems.into(),
            self.met.into(),
            self.failed.into(),
            (1e3 * self.violation).into(),
            (1e3 * self.stationarity).into(),
            (1e3 * self.distance).into(),
            self.stretch.into(),
            (1e3 * self.gap).into(),
            self.intersections.into(),
        ]
    }
}

/// Columns of [`table`]; the page explains them.
const COLUMNS: [&str; 17] = [
    "scene",
    "method",
    "cpu_s",
    "error_mm",
    "error_is",
    "steps",
    "most_steps",
    "searches",
    "problems",
    "met_rule",
    "failed",
    "violation_mm",
    "stationarity_mm",
    "to_target_mm",
    "max_stretch",
    "min_gap_mm",
    "intersections",
];

/// The summaries that `keep` accepts, scene by scene.
pub fn table(compared: &[Compared], keep: impl Fn(&Summary) -> bool) -> Table {
    let mut table = Table::new(COLUMNS);
    for compared in compared {
        let referenced = compared.has_references();
        for summary in compared.summaries.iter().filter(|s| keep(s)) {
            table.row(summary.row(compared.scene, referenced));
        }
    }
    table
}

/// Ratios of a quantity of one setting to that of another, one per scene in which the ratio is positive.
pub fn ratios(
    compared: &[Compared],
    more: (&str, &str),
    less: (&str, &str),
    value: impl Fn(&Summary, bool) -> f64,
) -> Vec<f64> {
    compared
        .iter()
        .filter_map(|c| {
            let referenced = c.has_references();
            Some(value(c.find(more.0, more.1)?, referenced) / value(c.find(less.0, less.1)?, referenced))
        })
        .filter(|ratio| ratio.is_finite() && *ratio > 0.0)
        .collect()
}

/// One line per scene: a quantity over the values of a parameter. `values` has each value with the method and
/// the change of its setting.
pub fn lines(
    compared: &[Compared],
    values: &[(f64, &str, String)],
    quantity: impl Fn(&Summary, bool) -> f64,
) -> Vec<Series> {
    compared
        .iter()
        .map(|c| {
            let referenced = c.has_references();
            let point = |(value, method, change): &(f64, &str, String)| {
                c.find(method, change).map(|summary| (*value, quantity(summary, referenced)))
            };
            Series::new(c.scene, Style::Line, values.iter().filter_map(point))
        })
        .collect()
}
