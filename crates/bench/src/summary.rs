//! What a setting did with the problems of a scene.

use crate::bench::Bench;
use crate::case::{Case, cases};
use crate::chart::{Series, Style};
use crate::methods::Setting;
use crate::solve::{Against, Solved, compare};
use crate::table::{Entry, Table, largest, mean, short, smallest};
use anyhow::Result;

/// Means over the problems of a scene, unless said otherwise.
#[derive(Clone, Debug)]
pub struct Summary {
    pub method: &'static str,
    pub change: String,
    pub cpu: f64,
    /// Distance to the exact solution [m]; none if a problem has none.
    pub exact: Option<f64>,
    pub stationarity: f64,
    /// Violation of contacts [m].
    pub violation: f64,
    /// Largest share by which an edge exceeds its limit, times the mean edge length [m].
    pub excess: f64,
    /// Distance to the target [m].
    pub distance: f64,
    pub steps: f64,
    pub most_steps: f64,
    pub searches: f64,
    /// Largest stretch against rest.
    pub stretch: f64,
    /// Smallest gap [m]; infinite if nothing was near.
    pub gap: f64,
    /// Calls that met the method's own stopping rule.
    pub met: usize,
    pub failed: usize,
    pub of: usize,
    /// Sum over the problems.
    pub intersections: usize,
    /// Wall seconds of search, evaluation, backward step, forward step.
    pub stages: [f64; 4],
}

/// A scene's problems solved by several settings.
#[derive(Clone, Debug)]
pub struct Compared {
    pub scene: &'static str,
    pub cases: Vec<Case>,
    /// One entry a problem that there was time for, and setting.
    pub solved: Vec<Vec<Solved>>,
    /// One entry a setting.
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
    by_scene: Vec<Vec<Case>>,
    settings: &[Setting],
    rounds: usize,
    against: Against,
) -> Result<Vec<Compared>> {
    // The first problem of each scene, then the second: time that runs out takes the last ones of all scenes.
    let mut order: Vec<(usize, usize)> =
        by_scene.iter().enumerate().flat_map(|(s, cases)| (0..cases.len()).map(move |k| (s, k))).collect();
    order.sort_by_key(|&(scene, case)| (case, scene));
    let flat: Vec<&Case> = order.iter().map(|&(s, k)| &by_scene[s][k]).collect();
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

    /// Whether every problem has an exact solution that errors are measured against.
    pub fn is_exact(&self) -> bool {
        self.summaries.iter().all(|s| s.exact.is_some())
    }

    /// Vertices of the scene.
    pub fn vertices(&self) -> usize {
        self.cases.first().map_or(0, |case| case.states.x.len())
    }
}

impl Summary {
    /// None of no solves. The problems are those of one scene, whose edges are as long in all of `cases`.
    pub fn of<'a>(
        setting: &Setting,
        cases: &[Case],
        solved: impl Iterator<Item = &'a Solved>,
    ) -> Option<Self> {
        let solved: Vec<&Solved> = solved.collect();
        if solved.is_empty() {
            return None;
        }
        let all = |value: &dyn Fn(&Solved) -> f64| solved.iter().map(|s| value(s)).collect::<Vec<f64>>();
        let of = |value: &dyn Fn(&Solved) -> f64| mean(&all(value));
        let exact = solved.iter().all(|s| s.judged.error.is_some());
        let edge = cases.first().and_then(Case::mean_edge).unwrap_or(0.0);
        Some(Self {
            method: setting.method,
            change: setting.change.clone(),
            cpu: of(&|s| s.cpu_seconds),
            exact: exact.then(|| of(&|s| s.judged.error.unwrap_or(f64::NAN))),
            stationarity: of(&|s| s.judged.stationarity),
            violation: of(&|s| s.judged.violation),
            excess: of(&|s| s.judged.stretch_violation.max(0.0)) * edge,
            distance: of(&|s| s.judged.distance),
            steps: of(&|s| s.steps as f64),
            most_steps: largest(&all(&|s| s.steps as f64)),
            searches: of(&|s| s.searches as f64),
            stretch: largest(&all(&|s| s.judged.rest_stretch)),
            gap: smallest(&all(&|s| s.judged.min_gap.unwrap_or(f64::INFINITY))),
            met: solved.iter().filter(|s| s.converged).count(),
            failed: solved.iter().filter(|s| s.failed).count(),
            of: solved.len(),
            intersections: solved.iter().map(|s| s.judged.intersections).sum(),
            stages: [
                of(&|s| s.stages.search),
                of(&|s| s.stages.evaluate),
                of(&|s| s.stages.backward),
                of(&|s| s.stages.forward),
            ],
        })
    }

    /// Distance to the exact solution; or else the stationarity residual with the violations of contacts and of edge limits,
    /// as the root of the sum of squares: each alone is small where the others are large [m].
    pub fn error(&self, exact: bool) -> f64 {
        match exact {
            true => self.exact.unwrap_or(f64::NAN),
            false => self.stationarity.hypot(self.violation).hypot(self.excess),
        }
    }

    /// Method and change.
    pub fn name(&self) -> String {
        match self.change.is_empty() {
            true => self.method.to_owned(),
            false => format!("{}, {}", self.method, self.change),
        }
    }

    fn row(&self, scene: &str, exact: bool) -> Vec<Entry> {
        let star = if exact { "" } else { "\\*" };
        let failed = if self.failed > 0 { format!(", {} failed", self.failed) } else { String::new() };
        vec![
            scene.into(),
            self.name().into(),
            self.cpu.into(),
            format!("{}{star}", short(1e3 * self.error(exact))).into(),
            format!("{} ({})", short(self.steps), short(self.most_steps)).into(),
            self.searches.into(),
            format!("{} of {}{failed}", self.met, self.of).into(),
            (1e3 * self.violation).into(),
            (1e3 * self.distance).into(),
            self.stretch.into(),
            (1e3 * self.gap).into(),
            self.intersections.into(),
        ]
    }
}

/// What the columns of [`table`] mean.
pub const COLUMNS: &str = "Means over the problems of a scene. *Error*: distance to the exact solution, RMS; a star: not all \
    problems have one, stationarity residual and violations of contacts and edge limits instead. *Steps*: mean (max). *Met*: calls that met the method's own stopping \
    rule. *Violation*: largest by which a contact is nearer than it should be. *To target*: what is minimised. *Stretch* \
    against rest, largest; *gap*, smallest; *X*: intersecting pairs.";

/// The summaries that `keep` accepts, scene by scene.
pub fn table(compared: &[Compared], keep: impl Fn(&Summary) -> bool) -> Table {
    let mut table = Table::new([
        "scene",
        "method",
        "CPU s",
        "error, mm",
        "steps",
        "searches",
        "met",
        "violation, mm",
        "to target, mm",
        "stretch",
        "gap, mm",
        "X",
    ]);
    for compared in compared {
        let exact = compared.is_exact();
        for summary in compared.summaries.iter().filter(|s| keep(s)) {
            table.row(summary.row(compared.scene, exact));
        }
    }
    table
}

/// Ratios of a quantity of one setting to that of another, scene by scene, where both are positive.
pub fn ratios(
    compared: &[Compared],
    more: (&str, &str),
    less: (&str, &str),
    value: impl Fn(&Summary, bool) -> f64,
) -> Vec<f64> {
    compared
        .iter()
        .filter_map(|c| {
            let exact = c.is_exact();
            Some(value(c.find(more.0, more.1)?, exact) / value(c.find(less.0, less.1)?, exact))
        })
        .filter(|ratio| ratio.is_finite() && *ratio > 0.0)
        .collect()
}

/// For each scene a line of a quantity over the values of a parameter: `values` has each value with the method and
/// change that it belongs to.
pub fn lines(
    compared: &[Compared],
    values: &[(f64, &str, String)],
    quantity: impl Fn(&Summary, bool) -> f64,
) -> Vec<Series> {
    compared
        .iter()
        .map(|c| {
            let exact = c.is_exact();
            let point = |(value, method, change): &(f64, &str, String)| {
                c.find(method, change).map(|summary| (*value, quantity(summary, exact)))
            };
            Series::new(c.scene, Style::Line, values.iter().filter_map(point))
        })
        .collect()
}
