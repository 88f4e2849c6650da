//! Where the defaults come from: each setting of `fast` changed, run time against error.

use super::collision_error::{compared, settings};
use super::{Figure, Part, Section};
use crate::bench::Bench;
use crate::methods::Setting;
use crate::summary::{Compared, ratios};
use crate::table::{Table, geometric_mean, times};
use anyhow::Result;

pub struct Defaults;

/// How much better a change must be in time or error, and how little worse in the other, to be told.
const BETTER: f64 = 0.95;
const NO_WORSE: f64 = 1.02;

impl Figure for Defaults {
    fn name(&self) -> &'static str {
        "defaults"
    }

    fn title(&self) -> &'static str {
        "Where the defaults come from"
    }

    fn question(&self) -> &'static str {
        "`fast` with one setting changed, as multiples of `fast` as it is: geometric means over six scenes, on targets of a \
         dynamics blind to contact and on those of Bowknot's own. The same runs as in the pictures above: 8 sweeps, stop at 0.01 edge \
         lengths (h), kappa 0.1, edge proximal 0.1, the gap form, a floor of a tenth of delta, growth up to 32. A default is to be changed where \
         something is faster or nearer on both kinds of targets at no cost in the other."
    }

    fn run(&self, bench: &Bench) -> Result<Section> {
        let settings: Vec<Setting> = settings()?.into_iter().filter(|s| s.method == "fast").collect();
        let [blind, own] = [compared(bench, true, &settings)?, compared(bench, false, &settings)?];
        let mut table =
            Table::new(["change", "time, blind", "error, blind", "time, own", "error, own", "failed to end"]);
        let mut better = Vec::new();
        for setting in settings.iter().filter(|s| !s.change.is_empty()) {
            let change = setting.change.as_str();
            let [blind_time, blind_error] = against_fast(&blind, change);
            let [own_time, own_error] = against_fast(&own, change);
            let gains = |time: f64, error: f64| {
                (time < BETTER && error < NO_WORSE) || (error < BETTER && time < NO_WORSE)
            };
            if gains(blind_time, blind_error) && gains(own_time, own_error) {
                better.push(change);
            }
            let unmet: usize =
                blind.iter().chain(&own).filter_map(|c| c.find("fast", change)).map(|s| s.of - s.met).sum();
            table.row([
                change.into(),
                times(blind_time).into(),
                times(blind_error).into(),
                times(own_time).into(),
                times(own_error).into(),
                unmet.to_string().into(),
            ]);
        }
        let told = if better.is_empty() { "none".to_owned() } else { better.join(", ") };
        Ok(Section {
            finding: format!(
                "Changes that are 5 % faster or nearer on both kinds of targets, and no more than 2 % worse in the other: {told}."
            ),
            parts: vec![Part::Table { name: self.name().to_owned(), caption: String::new(), table }],
        })
    }
}

/// CPU time and error with a change, over those without.
fn against_fast(compared: &[Compared], change: &str) -> [f64; 2] {
    let (with, without) = (("fast", change), ("fast", ""));
    [
        geometric_mean(&ratios(compared, with, without, |s, _| s.cpu)),
        geometric_mean(&ratios(compared, with, without, |s, exact| s.error(exact))),
    ]
}
