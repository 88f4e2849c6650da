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
        "CPU time and error of the collision stage as multiples of those of `fast`, the default: geometric \
         mean over six scenes (smallest to largest). Above 1 is worse. Not all methods solve the same \
         problem. The barriers and the impact zones have no edge limits, and their stretched edges count as \
         error. Impact zones keep no distance, except those with 0.8 delta. The barriers stop at 0.001 mean \
         edge lengths, a tolerance ten times tighter than the 0.01 of `fast`. `contacts-alone` compares \
         without edge limits."
    }

    fn on_page(&self) -> bool {
        true
    }

    fn run(&self, bench: &Bench) -> Result<Report> {
        let settings: Vec<Setting> = METHODS.iter().map(Setting::plain).collect();
        let names: Vec<&str> = METHODS.iter().map(|entry| entry.name).collect();
        let unaware = compared(bench, Targets::Unaware, &settings)?;
        let aware = compared(bench, Targets::Aware, &settings)?;
        let table = table(&against_fast(&unaware, &names), &against_fast(&aware, &names));
        Ok(Report {
            finding: format!(
                "CPU time and error as multiples of those of `fast`. Contact-unaware targets: {} \
                 Contact-aware targets: {}",
                finding(&unaware),
                finding(&aware)
            ),
            parts: vec![Part::table(self.name(), "", table)],
        })
    }
}

/// A method against `fast`: ratios as geometric mean, smallest and largest over the scenes; counts over all
/// problems.
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

/// Both kinds of targets side by side, as text for the page.
fn table(unaware: &[OverFast], aware: &[OverFast]) -> Table {
    let mut header = vec!["method".to_owned()];
    for targets in [Targets::Unaware, Targets::Aware] {
        let word = targets.word();
        header.push(format!("{word}: CPU time"));
        header.extend(["error", "failed", "met its rule"].map(str::to_owned));
    }
    header.push("intersections".to_owned());
    let mut table = Table::new(header);
    for (unaware, aware) in unaware.iter().zip(aware) {
        let spread = |[mean, low, high]: [f64; 3]| -> Entry {
            format!("{} ({} to {})", times(mean), times(low), times(high)).into()
        };
        let of_targets = |method: &OverFast| {
            let count = |number: usize| -> Entry { format!("{number} of {}", method.problems).into() };
            [spread(method.cpu), spread(method.error), count(method.failed), count(method.met)]
        };
        let intersections = (unaware.intersections + aware.intersections).to_string();
        let cells = of_targets(unaware).into_iter().chain(of_targets(aware));
        let name = Entry::from(unaware.name.as_str());
        table.row([name].into_iter().chain(cells).chain([intersections.into()]));
    }
    table
}
