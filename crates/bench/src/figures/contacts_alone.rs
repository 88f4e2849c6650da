//! Contacts alone: one problem for methods with and without edge limits.

use super::collision_error::{self, finding};
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
         problems have reference solutions of their own, which take minutes each: there is one problem of each \
         scene. `referenced` problems have one. Three kinds of targets: contact-unaware and contact-aware ones as \
         in the two sections before, and `repelled` ones of a dynamics with a repulsion of quadratic energy, as \
         the paper has it (section 6.2). It does not give reach and stiffness: here they are those of the preset \
         `paper`. All methods get the same contact distances, without the paper's immediate opening of pairs that \
         begin too near, and no friction."
    }

    fn run(&self, bench: &Bench) -> Result<Report> {
        let settings: Vec<Setting> = METHODS.iter().map(Setting::plain).collect();
        let names: Vec<&str> = METHODS.iter().map(|entry| entry.name).collect();
        let kinds = [Targets::Unaware, Targets::Repelled, Targets::Aware];
        let compared: Vec<Vec<Compared>> =
            kinds.iter().map(|&targets| compared(bench, targets, &settings)).collect::<Result<_>>()?;
        let findings = kinds
            .iter()
            .zip(&compared)
            .map(|(targets, compared)| format!("{} targets: {}", targets.word(), finding(compared)));
        let mut ratios = Table::new(RATIO_COLUMNS);
        for (targets, compared) in kinds.iter().zip(&compared) {
            add_ratios(&mut ratios, targets.word(), &against_fast(compared, &names));
        }
        Ok(Report {
            finding: format!(
                "CPU time and error as multiples of those of `fast`, geometric means over the scenes; {}",
                findings.collect::<Vec<_>>().join(" ")
            ),
            parts: vec![
                Part::table(
                    format!("{}-ratios", self.name()),
                    "CPU time and error over those of `fast` without edge limits: geometric means over the \
                     scenes, smallest and largest",
                    ratios,
                ),
                Part::table(
                    self.name(),
                    "methods without edge limits, by scene",
                    table(&compared.concat(), |_| true),
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
        // The first of those with edge limits.
        let cases = cases(bench, scene, collision_error::count(bench.size))?;
        by_scene
            .push(cases.iter().take(1).map(|case| case.with_lengths("contacts alone", unlimited)).collect());
    }
    on_cases(bench, scenes, by_scene, settings, 1, Against::Reference)
}

const RATIO_COLUMNS: [&str; 13] = [
    "targets",
    "method",
    "cpu_ratio",
    "cpu_ratio_min",
    "cpu_ratio_max",
    "error_ratio",
    "error_ratio_min",
    "error_ratio_max",
    "problems",
    "referenced",
    "failed",
    "met_rule",
    "intersections",
];

fn add_ratios(table: &mut Table, targets: &str, methods: &[OverFast]) {
    for method in methods.iter().filter(|method| method.problems > 0) {
        let ratios = method.cpu.into_iter().chain(method.error).map(Entry::from);
        let OverFast { problems, referenced, failed, met, intersections, .. } = *method;
        let counts = [problems, referenced, failed, met, intersections].map(Entry::from);
        let names = [Entry::from(targets), Entry::from(method.name.as_str())];
        table.row(names.into_iter().chain(ratios).chain(counts));
    }
}
