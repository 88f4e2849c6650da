//! CPU time and error of every method over those of `fast`: the first section of the page.

use super::collision_error::{compared, finding};
use crate::bench::Bench;
use crate::figure::{Figure, Part, Report};
use crate::methods::{METHODS, Setting};
use crate::summary::{Compared, Summary, ratios};
use crate::table::{Entry, Table, geometric_mean, largest, smallest, times};
use crate::targets::Targets;
use anyhow::Result;

pub struct Overview;

impl Figure for Overview {
    fn name(&self) -> &'static str {
        "overview"
    }

    fn title(&self) -> &'static str {
        "Every method against `fast`: CPU time and error"
    }

    fn question(&self) -> &'static str {
        "CPU time and error of the collision stage as multiples of those of `fast`, the default: geometric mean over six scenes \
         (smallest to largest). Above 1 is worse than `fast`. Not all methods solve the same problem. The barriers and the impact \
         zones have no edge limits, and their stretched edges count as error. Impact zones keep no distance, except those with 0.8 \
         delta. The barriers stop when no vertex would move by more than 0.001 mean edge lengths, a tolerance ten times tighter \
         than the 0.01 of `fast`. `contacts-alone` compares without edge limits."
    }

    fn on_page(&self) -> bool {
        true
    }

    fn run(&self, bench: &Bench) -> Result<Report> {
        let settings: Vec<Setting> = METHODS.iter().map(Setting::plain).collect();
        let names: Vec<&str> = METHODS.iter().map(|entry| entry.name).collect();
        let mut report = Report::default();
        let mut findings = Vec::new();
        for targets in [Targets::Unaware, Targets::Aware] {
            let compared = compared(bench, targets, &settings)?;
            let word = targets.word();
            findings.push(format!("Contact-{word} targets. {}", finding(&compared)));
            report.parts.push(Part::table(
                format!("{}-{word}", self.name()),
                format!("Contact-{word} targets"),
                table(&against_fast(&compared, &names)),
            ));
        }
        report.finding = findings.join(" ");
        Ok(report)
    }
}

/// A method against `fast`: ratios as geometric mean, smallest and largest over the scenes; counts over all problems.
pub struct OverFast {
    pub name: String,
    pub cpu: [f64; 3],
    pub error: [f64; 3],
    pub problems: usize,
    pub failed: usize,
    pub met: usize,
    pub intersections: usize,
}

/// Methods with their own parameters against `fast`.
pub fn against_fast(compared: &[Compared], methods: &[&str]) -> Vec<OverFast> {
    let over_fast = |name: &str| {
        let count = |value: fn(&Summary) -> usize| {
            compared.iter().filter_map(|c| c.find(name, "")).map(value).sum::<usize>()
        };
        let spread = |ratios: Vec<f64>| [geometric_mean, smallest, largest].map(|of| of(&ratios));
        let (method, fast) = ((name, ""), ("fast", ""));
        OverFast {
            name: name.to_owned(),
            cpu: spread(ratios(compared, method, fast, |s, _| s.cpu)),
            error: spread(ratios(compared, method, fast, |s, referenced| s.error(referenced))),
            problems: count(|s| s.problems),
            failed: count(|s| s.failed),
            met: count(|s| s.met),
            intersections: count(|s| s.intersections),
        }
    };
    methods.iter().copied().map(over_fast).collect()
}

/// As text, for the page.
fn table(methods: &[OverFast]) -> Table {
    let mut table = Table::new(["method", "CPU time", "error", "failed", "met its rule", "intersections"]);
    for method in methods {
        let spread = |[mean, low, high]: [f64; 3]| -> Entry {
            format!("{} ({} to {})", times(mean), times(low), times(high)).into()
        };
        table.row([
            method.name.as_str().into(),
            spread(method.cpu),
            spread(method.error),
            format!("{} of {}", method.failed, method.problems).into(),
            format!("{} of {}", method.met, method.problems).into(),
            method.intersections.to_string().into(),
        ]);
    }
    table
}
