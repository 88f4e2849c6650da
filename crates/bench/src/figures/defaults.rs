//! The choice of the defaults: `fast` with one setting changed, run time against error.

use super::collision_error::{compared, settings};
use crate::bench::Bench;
use crate::figure::{Figure, Part, Report};
use crate::methods::Setting;
use crate::summary::{Compared, ratios};
use crate::table::{Table, geometric_mean, times};
use crate::targets::Targets;
use anyhow::Result;

pub struct Defaults;

/// A change is an improvement if its time or its error is below this multiple of the default's, ..
const BETTER: f64 = 0.95;
/// .. and the other one is below this multiple.
const NO_WORSE: f64 = 1.02;

impl Figure for Defaults {
    fn name(&self) -> &'static str {
        "defaults"
    }

    fn title(&self) -> &'static str {
        "Where the defaults come from"
    }

    fn question(&self) -> &'static str {
        "`fast` with one setting changed, CPU time and error as multiples of those of `fast`: geometric \
         means over six scenes. The defaults are 8 sweeps, stop at 0.01 edge lengths (h), kappa 0.1, edge \
         proximal 0.1, the gap form, a minimum separation of a tenth of delta, growth up to 32. A default \
         should change if another value is faster or more exact on both kinds of targets without a loss in \
         the other quantity. *Not met*: calls that did not meet their stopping rule."
    }

    fn on_page(&self) -> bool {
        true
    }

    fn run(&self, bench: &Bench) -> Result<Report> {
        let settings: Vec<Setting> = settings()?.into_iter().filter(|s| s.method == "fast").collect();
        let unaware = compared(bench, Targets::Unaware, &settings)?;
        let aware = compared(bench, Targets::Aware, &settings)?;
        let mut table = Table::new([
            "change",
            "time, unaware",
            "error, unaware",
            "time, aware",
            "error, aware",
            "not met",
        ]);
        let mut better = Vec::new();
        for setting in settings.iter().filter(|s| !s.change.is_empty()) {
            let change = setting.change.as_str();
            let [unaware_time, unaware_error] = against_fast(&unaware, change);
            let [aware_time, aware_error] = against_fast(&aware, change);
            let gains = |time: f64, error: f64| {
                (time < BETTER && error < NO_WORSE) || (error < BETTER && time < NO_WORSE)
            };
            if gains(unaware_time, unaware_error) && gains(aware_time, aware_error) {
                better.push(change);
            }
            let unmet: usize = unaware
                .iter()
                .chain(&aware)
                .filter_map(|c| c.find("fast", change))
                .map(|s| s.problems - s.met)
                .sum();
            table.row([
                change.into(),
                times(unaware_time).into(),
                times(unaware_error).into(),
                times(aware_time).into(),
                times(aware_error).into(),
                unmet.to_string().into(),
            ]);
        }
        let texts = if better.is_empty() { "none".to_owned() } else { better.join(", ") };
        Ok(Report {
            finding: format!(
                "Changes that are 5 % better in time or error on both kinds of targets, and at most 2 % \
                 worse in the other: {texts}."
            ),
            parts: vec![Part::table(self.name(), "", table)],
        })
    }
}

/// CPU time and error with a change, over those without.
fn against_fast(compared: &[Compared], change: &str) -> [f64; 2] {
    let (with, without) = (("fast", change), ("fast", ""));
    [
        geometric_mean(&ratios(compared, with, without, |s, _| s.cpu)),
        geometric_mean(&ratios(compared, with, without, |s, referenced| s.error(referenced))),
    ]
}
