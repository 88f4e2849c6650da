//! Contacts alone: one problem for methods with and without edge limits.

use super::collision_error::finding;
use crate::bench::Bench;
use crate::case::{ProblemLengths, cases};
use crate::figure::{Figure, Part, Report};
use crate::methods::{METHODS, Setting};
use crate::over_fast::{OverFast, against_fast};
use crate::solve::Against;
use crate::summary::{Compared, on_cases, table};
use crate::table::{Entry, Table};
use crate::targets::Targets;
use anyhow::Result;

pub struct ContactsAlone;

impl Figure for ContactsAlone {
    fn name(&self) -> &'static str {
        "contacts-alone"
    }

    fn title(&self) -> &'static str {
        "Run time against error: contacts alone, no edge limits"
    }

    fn question(&self) -> &'static str {
        "Barriers and impact zones have no edge limits. With them, edges that they stretch to several times \
         their length would be part of their error. Here no method has edge limits (sigma infinite), and the \
         problems have reference solutions of their own. Contact-unaware targets; all else as in \
         `collision-error-unaware`."
    }

    fn run(&self, bench: &Bench) -> Result<Report> {
        let settings: Vec<Setting> = METHODS.iter().map(Setting::plain).collect();
        let names: Vec<&str> = METHODS.iter().map(|entry| entry.name).collect();
        let compared = compared(bench, Targets::Unaware, &settings)?;
        Ok(Report {
            finding: format!(
                "CPU time and error as multiples of those of `fast`, geometric means over the scenes: {}",
                finding(&compared)
            ),
            parts: vec![
                Part::table(
                    format!("{}-ratios", self.name()),
                    "CPU time and error over those of `fast` without edge limits: geometric means over the \
                     scenes, smallest and largest",
                    ratio_table(&against_fast(&compared, &names)),
                ),
                Part::table(
                    self.name(),
                    "methods on contact-unaware targets without edge limits, by scene",
                    table(&compared, |_| true),
                ),
            ],
        })
    }
}

/// Problems without edge limits, solved by settings.
pub fn compared(bench: &Bench, targets: Targets, settings: &[Setting]) -> Result<Vec<Compared>> {
    let scenes = targets.problem_sets(bench.size);
    let unlimited = ProblemLengths { stretch_limit: Some(f64::INFINITY), ..ProblemLengths::default() };
    let mut by_scene = Vec::new();
    for scene in scenes {
        let cases = cases(bench, scene, bench.size.pick(2, 1, 1))?;
        by_scene.push(cases.iter().map(|case| case.with_lengths("contacts alone", unlimited)).collect());
    }
    on_cases(bench, scenes, by_scene, settings, 1, Against::Reference)
}

fn ratio_table(methods: &[OverFast]) -> Table {
    let mut table = Table::new([
        "method",
        "cpu_ratio",
        "cpu_ratio_min",
        "cpu_ratio_max",
        "error_ratio",
        "error_ratio_min",
        "error_ratio_max",
        "problems",
        "failed",
        "met_rule",
        "intersections",
    ]);
    for method in methods {
        let ratios = method.cpu.into_iter().chain(method.error).map(Entry::from);
        let counts = [method.problems, method.failed, method.met, method.intersections].map(Entry::from);
        table.row([Entry::from(method.name.as_str())].into_iter().chain(ratios).chain(counts));
    }
    table
}
