//! Safety, efficiency and accuracy of kinds of methods (paper, Table 1), as measured.

use super::collision_error::{compared, over_fast};
use crate::bench::Bench;
use crate::figure::{Figure, Part, Report};
use crate::methods::Setting;
use crate::summary::{Compared, Summary, ratios};
use crate::table::{Table, geometric_mean, largest, times};
use crate::targets::Targets;
use anyhow::Result;

pub struct Table1;

/// Kinds of methods, each with the method that represents it.
const KINDS: [(&str, &str); 7] = [
    ("impact zone optimizer", "impact zones"),
    ("impact zone optimizer that keeps 0.8 delta", "impact zones, 0.8 delta"),
    ("interior point method", "log barrier"),
    ("rigid impact zones", "rigid zones"),
    ("two phases (Wu et al. 2020)", "two phases"),
    ("two-way, as in the paper", "paper"),
    ("two-way, `fast`", "fast"),
];

impl Figure for Table1 {
    fn name(&self) -> &'static str {
        "table-1"
    }

    fn title(&self) -> &'static str {
        "Table 1, as measured: safety, efficiency, accuracy"
    }

    fn question(&self) -> &'static str {
        "According to the paper, impact zone optimizers are accurate and either safe or efficient, interior \
         point methods are safe and either efficient or accurate, and its own method is all three. Safety: \
         solves that did not fail, and results without intersections. Efficiency: CPU seconds as multiples \
         of those of `fast`. Accuracy: error as a multiple of that of `fast`. Geometric means over scenes. \
         The methods do not solve quite the same problem; see `overview`."
    }

    fn run(&self, bench: &Bench) -> Result<Report> {
        let settings = KINDS.iter().map(|(_, m)| Setting::of(m)).collect::<Result<Vec<_>>>()?;
        let mut report = Report::default();
        let mut findings = Vec::new();
        for targets in [Targets::Unaware, Targets::Aware] {
            let compared = compared(bench, targets, &settings)?;
            let others = KINDS.iter().filter(|(_, method)| *method != "fast").filter_map(|(_, method)| {
                let [cpu, error] = over_fast(&compared, method)?;
                Some(format!("{method} {} and {}", times(cpu), times(error)))
            });
            let word = targets.word();
            findings.push(format!("contact-{word} targets: {}", others.collect::<Vec<_>>().join("; ")));
            report.parts.push(Part::table(
                format!("{}-{word}", self.name()),
                format!("safety, efficiency and accuracy of kinds of methods on contact-{word} targets"),
                by_kind(&compared),
            ));
        }
        report.finding = format!("CPU time and error as multiples of `fast`; {}.", findings.join(". "));
        Ok(report)
    }
}

fn by_kind(compared: &[Compared]) -> Table {
    let mut table = Table::new([
        "kind",
        "problems",
        "failed",
        "intersections",
        "met_rule",
        "cpu_ratio",
        "error_ratio",
        "error_ratio_max",
    ]);
    for (kind, method) in KINDS {
        let count = |value: fn(&Summary) -> usize| {
            compared.iter().filter_map(|c| c.find(method, "")).map(value).sum::<usize>()
        };
        let cpu = ratios(compared, (method, ""), ("fast", ""), |s, _| s.cpu);
        let error = ratios(compared, (method, ""), ("fast", ""), |s, referenced| s.error(referenced));
        table.row([
            kind.into(),
            count(|s| s.problems).into(),
            count(|s| s.failed).into(),
            count(|s| s.intersections).into(),
            count(|s| s.met).into(),
            geometric_mean(&cpu).into(),
            geometric_mean(&error).into(),
            largest(&error).into(),
        ]);
    }
    table
}
