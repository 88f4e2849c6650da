//! How much faster than each method, at what error: the first screen of the page.

use super::collision_error::{compared, finding};
use super::{Figure, Part, Section};
use crate::bench::Bench;
use crate::methods::{METHODS, Setting};
use crate::summary::{Compared, Summary, ratios};
use crate::table::{Entry, Table, geometric_mean, largest, smallest, times};
use anyhow::Result;

pub struct Overview;

impl Figure for Overview {
    fn name(&self) -> &'static str {
        "overview"
    }

    fn title(&self) -> &'static str {
        "How fast, at what error: every method against `fast`"
    }

    fn question(&self) -> &'static str {
        "CPU time and error of the collision stage as multiples of those of `fast`, the default: geometric mean over six scenes \
         (smallest to largest), above 1 is worse. Once on targets of a dynamics that knows of no contact, as the paper's, and once \
         on those of Bowknot's own, which meet little that is in the way. What is measured, and how, is said in the next \
         sections. Barriers and impact zones have no edge limits, which is part of their error here; *contacts alone* compares without."
    }

    fn run(&self, bench: &Bench) -> Result<Section> {
        let settings: Vec<Setting> = METHODS.iter().map(Setting::plain).collect();
        let blind = compared(bench, true, &settings)?;
        let own = compared(bench, false, &settings)?;
        let names: Vec<&str> = METHODS.iter().map(|entry| entry.name).collect();
        let name = |word: &str| format!("{}-{word}", self.name());
        Ok(Section {
            finding: format!(
                "Targets of a blind dynamics: {} Targets of Bowknot's: {}",
                finding(&blind),
                finding(&own)
            ),
            parts: vec![
                Part::Table {
                    name: name("blind"),
                    caption: "Targets of a dynamics that knows of no contact:".to_owned(),
                    table: against_fast(&blind, &names),
                },
                Part::Table {
                    name: name("own"),
                    caption: "Targets of Bowknot's dynamics:".to_owned(),
                    table: against_fast(&own, &names),
                },
            ],
        })
    }
}

/// Time and error of methods as they are, as multiples of those of `fast`.
pub fn against_fast(compared: &[Compared], methods: &[&str]) -> Table {
    let mut table = Table::new(["method", "CPU time", "error", "failed", "met its rule", "intersections"]);
    for &name in methods {
        let of = |value: fn(&Summary) -> usize| {
            compared.iter().filter_map(|c| c.find(name, "")).map(value).sum::<usize>()
        };
        let told = |ratios: Vec<f64>| -> Entry {
            let [mean, low, high] = [geometric_mean, smallest, largest].map(|of| times(of(&ratios)));
            format!("{mean} ({low} to {high})").into()
        };
        let (method, fast) = ((name, ""), ("fast", ""));
        let all = of(|s| s.of);
        table.row([
            name.into(),
            told(ratios(compared, method, fast, |s, _| s.cpu)),
            told(ratios(compared, method, fast, |s, exact| s.error(exact))),
            format!("{} of {all}", of(|s| s.failed)).into(),
            format!("{} of {all}", of(|s| s.met)).into(),
            of(|s| s.intersections).to_string().into(),
        ]);
    }
    table
}
