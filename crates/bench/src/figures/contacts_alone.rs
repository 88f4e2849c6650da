//! Contacts alone: one problem for methods with and without edge limits.

use super::overview::{OverFast, against_fast};
use crate::bench::Bench;
use crate::case::{ProblemLengths, cases};
use crate::figure::{Figure, Part, Report};
use crate::methods::Setting;
use crate::solve::Against;
use crate::summary::{on_cases, ratios, table};
use crate::table::{Entry, Table, geometric_mean, times};
use crate::targets::Targets;
use anyhow::Result;

pub struct ContactsAlone;

/// `fast`, the paper's method, and all methods without edge limits.
const METHODS: [&str; 11] = [
    "fast",
    "paper",
    "log barrier",
    "log barrier, Newton",
    "IPC",
    "IPC, own range",
    "Harmon, projected",
    "impact zones",
    "impact zones, 0.8 delta",
    "rigid zones",
    "two phases",
];

impl Figure for ContactsAlone {
    fn name(&self) -> &'static str {
        "contacts-alone"
    }

    fn title(&self) -> &'static str {
        "Run time against error: contacts alone, no edge limits"
    }

    fn question(&self) -> &'static str {
        "Barriers and impact zones have no edge limits. In the comparison of all methods, edges that they \
         stretch to several times their length are part of their error. Here no method has edge limits \
         (sigma infinite), and the problems have reference solutions of their own. Contact-unaware targets; \
         all else as in `collision-error-unaware`."
    }

    fn run(&self, bench: &Bench) -> Result<Report> {
        let scenes = Targets::Unaware.problem_sets(bench.size);
        let settings = METHODS.iter().map(|m| Setting::of(m)).collect::<Result<Vec<_>>>()?;
        let unlimited = ProblemLengths { stretch_limit: Some(f64::INFINITY), ..ProblemLengths::default() };
        let mut by_scene = Vec::new();
        for scene in scenes {
            let cases = cases(bench, scene, bench.size.pick(2, 1, 1))?;
            by_scene.push(cases.iter().map(|case| case.with_lengths("contacts alone", unlimited)).collect());
        }
        let compared = on_cases(bench, scenes, by_scene, &settings, 1, Against::Reference)?;
        let texts = METHODS[1..].iter().map(|method| {
            let mean = |values: Vec<f64>| times(geometric_mean(&values));
            let (other, fast) = ((*method, ""), ("fast", ""));
            format!(
                "{method} {} and {}",
                mean(ratios(&compared, other, fast, |s, _| s.cpu)),
                mean(ratios(&compared, other, fast, |s, referenced| s.error(referenced)))
            )
        });
        Ok(Report {
            finding: format!(
                "CPU time and error as multiples of those of `fast`, geometric means over the scenes: {}.",
                texts.collect::<Vec<_>>().join("; ")
            ),
            parts: vec![
                Part::table(
                    format!("{}-ratios", self.name()),
                    "CPU time and error over those of `fast` without edge limits: geometric means over the \
                     scenes, smallest and largest",
                    ratio_table(&against_fast(&compared, &METHODS)),
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
