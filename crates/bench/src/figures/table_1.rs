//! Strengths and weaknesses of kinds of methods (paper, Table 1), as measured.

use super::{Figure, Part, Section};
use crate::bench::Bench;
use crate::methods::Setting;
use crate::summary::{Compared, on_scenes, ratios};
use crate::table::{Table, geometric_mean, short, times};
use anyhow::Result;

pub struct Table1;

/// Kind of method, and the one that stands for it.
const KINDS: [(&str, &str); 6] = [
    ("impact zone optimizer", "impact zones"),
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
        let scenes: &[&'static str] = bench.size.pick(
            &["needle", "stack", "tube", "bow-knot", "reef-knot", "dress"][..],
            &["needle", "stack", "tube"],
            &["needle"],
        );
        let settings = KINDS.iter().map(|(_, m)| Setting::of(m)).collect::<Result<Vec<_>>>()?;
        let compared = on_scenes(bench, scenes, bench.size.pick(2, 2, 1), &settings, 1)?;
        let mut table = Table::new([
            "kind",
            "failed",
            "intersections",
            "met its rule",
            "CPU time",
            "error",
            "worst error",
        ]);
        let mut told = Vec::new();
        for (kind, method) in KINDS {
            let of = |value: fn(&crate::summary::Summary) -> usize| {
                compared.iter().filter_map(|c: &Compared| c.find(method, "")).map(value).sum::<usize>()
            };
            let all = of(|s| s.of);
            let cpu = ratios(&compared, (method, ""), ("fast", ""), |s, _| s.cpu);
            let error = ratios(&compared, (method, ""), ("fast", ""), |s, exact| s.error(exact));
            let worst = error.iter().copied().fold(0.0, f64::max);
            table.row([
                kind.into(),
                format!("{} of {all}", of(|s| s.failed)).into(),
                of(|s| s.intersections).to_string().into(),
                format!("{} of {all}", of(|s| s.met)).into(),
                times(geometric_mean(&cpu)).into(),
                times(geometric_mean(&error)).into(),
                times(worst).into(),
            ]);
            if method != "fast" {
                told.push(format!(
                    "{method} {}x and {}x",
                    short(geometric_mean(&cpu)),
                    short(geometric_mean(&error))
                ));
            }
        }
        Ok(Section {
            finding: format!("CPU time and error against `fast`: {}.", told.join("; ")),
            parts: vec![Part::Table { name: self.name().to_owned(), caption: String::new(), table }],
        })
    }
}
