//! The same problem for methods with and without edge limits: contacts alone.

use super::overview::against_fast;
use super::{Figure, Part, Section};
use crate::bench::Bench;
use crate::case::{ProblemLengths, cases};
use crate::methods::Setting;
use crate::solve::Against;
use crate::summary::{COLUMNS, on_cases, ratios, table};
use crate::table::{geometric_mean, times};
use anyhow::Result;

pub struct ContactsAlone;

/// `fast`, the paper's method, and all that have no edge limits of their own.
const METHODS: [&str; 9] = [
    "fast",
    "paper",
    "log barrier",
    "log barrier, Newton",
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
        "Barriers and impact zones know of no edge limits; above, edges that they stretch to several times their length are part \
         of their error. Here the problem has none for anyone (sigma infinite), with an exact solution of its own. Targets of a dynamics \
         blind to contact; all else as above."
    }

    fn run(&self, bench: &Bench) -> Result<Section> {
        let scenes: &[&'static str] = bench.size.pick(
            &[
                "needle-blind",
                "stack-blind",
                "tube-blind",
                "bow-knot-blind",
                "reef-knot-blind",
                "dress-blind",
            ][..],
            &["needle-blind", "stack-blind"],
            &["needle-blind"],
        );
        let settings = METHODS.iter().map(|m| Setting::of(m)).collect::<Result<Vec<_>>>()?;
        let unlimited = ProblemLengths { stretch_limit: Some(f64::INFINITY), ..ProblemLengths::default() };
        let mut by_scene = Vec::new();
        for scene in scenes {
            let cases = cases(bench, scene, bench.size.pick(2, 1, 1))?;
            by_scene.push(cases.iter().map(|case| case.under("contacts alone", unlimited)).collect());
        }
        let compared = on_cases(bench, scenes, by_scene, &settings, 1, Against::Exact)?;
        let told = METHODS[1..].iter().map(|method| {
            let mean = |values: Vec<f64>| times(geometric_mean(&values));
            let (other, fast) = ((*method, ""), ("fast", ""));
            format!(
                "{method} {} the time at {} the error",
                mean(ratios(&compared, other, fast, |s, _| s.cpu)),
                mean(ratios(&compared, other, fast, |s, exact| s.error(exact)))
            )
        });
        Ok(Section {
            finding: format!(
                "Against `fast`, geometric means over the scenes: {}.",
                told.collect::<Vec<_>>().join("; ")
            ),
            parts: vec![
                Part::Table {
                    name: format!("{}-ratios", self.name()),
                    caption: String::new(),
                    table: against_fast(&compared, &METHODS),
                },
                Part::Table {
                    name: self.name().to_owned(),
                    caption: COLUMNS.to_owned(),
                    table: table(&compared, |_| true),
                },
            ],
        })
    }
}
