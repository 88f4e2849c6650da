//! Strengths and weaknesses of kinds of methods (paper, Table 1), as measured.

use super::collision_error::compared;
use super::{Figure, Part, Section};
use crate::bench::Bench;
use crate::methods::Setting;
use crate::summary::{Compared, Summary, ratios};
use crate::table::{Table, geometric_mean, largest, short, times};
use anyhow::Result;

pub struct Table1;

/// Kind of method, and the one that stands for it.
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
        "The paper grants impact zone optimizers accuracy and, at the cost of each other, safety or efficiency; interior point methods safety and, at the \
         cost of each other, efficiency or accuracy; and its own method all three. Safety: solves that did not fail, and results without \
         intersections. Efficiency: CPU seconds as multiples of those of `fast`. Accuracy: error likewise. Geometric means over scenes."
    }

    fn run(&self, bench: &Bench) -> Result<Section> {
        let settings = KINDS.iter().map(|(_, m)| Setting::of(m)).collect::<Result<Vec<_>>>()?;
        let mut section = Section::default();
        let mut told = Vec::new();
        for (blind, word, whose) in
            [(true, "blind", "a dynamics blind to contact"), (false, "own", "Bowknot's")]
        {
            let compared = compared(bench, blind, &settings)?;
            let ratio = |method: &str, value: fn(&Summary, bool) -> f64| {
                short(geometric_mean(&ratios(&compared, (method, ""), ("fast", ""), value)))
            };
            let others = KINDS.iter().filter(|(_, method)| *method != "fast").map(|(_, method)| {
                format!("{method} {}x and {}x", ratio(method, |s, _| s.cpu), ratio(method, |s, e| s.error(e)))
            });
            told.push(format!("targets of {whose}: {}", others.collect::<Vec<_>>().join("; ")));
            section.parts.push(Part::Table {
                name: format!("{}-{word}", self.name()),
                caption: format!("Targets of {whose}:"),
                table: by_kind(&compared),
            });
        }
        section.finding = format!("CPU time and error against `fast`; {}.", told.join(". "));
        Ok(section)
    }
}

fn by_kind(compared: &[Compared]) -> Table {
    let mut table =
        Table::new(["kind", "failed", "intersections", "met its rule", "CPU time", "error", "worst error"]);
    for (kind, method) in KINDS {
        let of = |value: fn(&Summary) -> usize| {
            compared.iter().filter_map(|c| c.find(method, "")).map(value).sum::<usize>()
        };
        let all = of(|s| s.of);
        let cpu = ratios(compared, (method, ""), ("fast", ""), |s, _| s.cpu);
        let error = ratios(compared, (method, ""), ("fast", ""), |s, exact| s.error(exact));
        table.row([
            kind.into(),
            format!("{} of {all}", of(|s| s.failed)).into(),
            of(|s| s.intersections).to_string().into(),
            format!("{} of {all}", of(|s| s.met)).into(),
            times(geometric_mean(&cpu)).into(),
            times(geometric_mean(&error)).into(),
            times(largest(&error)).into(),
        ]);
    }
    table
}
