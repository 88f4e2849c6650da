//! CPU time and error of every method over those of `fast`: the second section of the page.

use super::collision_error::{compared, finding};
use super::contacts_alone;
use crate::bench::Bench;
use crate::figure::{Figure, Part, Report};
use crate::methods::{METHODS, Setting};
use crate::over_fast::{OverFast, against_fast};
use crate::table::{Entry, Table, spread};
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
         mean over six scenes (smallest to largest). Above 1 is worse. In the first table the problem has \
         contacts alone, which is what all methods solve; impact zones keep no distance, except those with \
         0.8 delta, barriers less of it where something presses, `fast` and `quick` half of it in sharp \
         folds. In the second one edges have limits as well. What a method *lacks* of that problem counts \
         as its error there: not all solve the same problem. All but `paper`, `quick` and the variants of \
         `paper` stop where no vertex would move by more than 0.01 mean edge lengths; `tolerance` has others."
    }

    fn on_page(&self) -> bool {
        true
    }

    fn run(&self, bench: &Bench) -> Result<Report> {
        let settings: Vec<Setting> = METHODS.iter().map(Setting::plain).collect();
        let names: Vec<&str> = METHODS.iter().map(|entry| entry.name).collect();
        let (mut findings, mut tables) = (Vec::new(), Vec::new());
        for problem in [contacts_alone::compared, compared] {
            let unaware = problem(bench, Targets::Unaware, &settings)?;
            let aware = problem(bench, Targets::Aware, &settings)?;
            let [first, second] = [&unaware, &aware].map(|compared| finding(compared));
            findings.push(format!("contact-unaware targets: {first} Contact-aware targets: {second}"));
            tables.push([&unaware, &aware].map(|compared| against_fast(compared, &names)));
        }
        let shown = |[unaware, aware]: &[Vec<OverFast>; 2], lacks| table(unaware, aware, lacks);
        Ok(Report {
            finding: format!(
                "CPU time and error as multiples of those of `fast`. Contacts alone, {} With edge limits, {}",
                findings[0], findings[1]
            ),
            parts: vec![
                Part::table(
                    format!("{}-contacts-alone", self.name()),
                    "Contacts alone",
                    shown(&tables[0], false),
                ),
                Part::table(self.name(), "Contacts and edge limits", shown(&tables[1], true)),
            ],
        })
    }
}

/// Both kinds of targets side by side, as text for the page, and what methods lack.
fn table(unaware: &[OverFast], aware: &[OverFast], lacks: bool) -> Table {
    let mut header = vec!["method".to_owned()];
    if lacks {
        header.push("lacks".to_owned());
    }
    for targets in [Targets::Unaware, Targets::Aware] {
        let word = targets.word();
        header.push(format!("{word}: CPU time"));
        header.extend(["error", "failed", "met its rule"].map(str::to_owned));
    }
    header.push("intersections".to_owned());
    let mut table = Table::new(header);
    for (unaware, aware) in unaware.iter().zip(aware) {
        let spread = |ratios: [f64; 3]| -> Entry {
            if ratios[0].is_finite() { spread(ratios).into() } else { "-".into() }
        };
        let of_targets = |method: &OverFast| {
            let count = |number: usize| -> Entry { format!("{number} of {}", method.problems).into() };
            [spread(method.cpu), spread(method.error), count(method.failed), count(method.met)]
        };
        let intersections = (unaware.intersections + aware.intersections).to_string();
        let cells = of_targets(unaware).into_iter().chain(of_targets(aware));
        let mut names = vec![Entry::from(unaware.name.as_str())];
        if lacks {
            let entry = METHODS.iter().find(|entry| entry.name == unaware.name);
            names.push(entry.map_or("", |entry| entry.lacks).into());
        }
        table.row(names.into_iter().chain(cells).chain([intersections.into()]));
    }
    table
}
