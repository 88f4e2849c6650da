//! What happens at the ends of what users ask for: counts of intersections and of numbers that are not
//! finite, convergence, energy and stretch.

use crate::bench::{Bench, Size};
use crate::figure::{Figure, Part, Report};
use crate::pages;
use crate::stability::{Case, Outcome, cases, run};
use crate::table::Table;
use anyhow::Result;

pub struct Stability;

impl Figure for Stability {
    fn name(&self) -> &'static str {
        "stability"
    }

    fn title(&self) -> &'static str {
        "Stability: small scenes at the ends of what users ask for"
    }

    fn question(&self) -> &'static str {
        "Small scenes, each with one quantity far from its usual value: a soft block falls on a box and a \
         sheet on both (time step, stiffness, density, size, distance from the origin, speed of a sheet, \
         delta, aspect ratio), or a block falls on a sheet that is held along two sides (density and speed \
         of a block, stretch limit). The other scenes are hard by themselves. The judge certifies every \
         state and every path of a two-way step.\n\n\
         *Intersections*: in states and on paths. *Not finite*: vertices with a position or velocity that is \
         not finite, over all time steps. *Converged*: share of time steps whose last collision problem \
         ended by its stopping rule. *Energy growth*: largest rise of kinetic, elastic and potential energy \
         over an earlier time step, once nothing drives the scene any more, relative to the kinetic energy \
         of the start and what gravity can add over the length of the scene. *Stretch*: largest ratio of an \
         edge of cloth to its rest length. *Two-way steps*: per time step, mean and largest, over all Newton \
         iterations.\n\n\
         A case is ok if nothing intersects, all numbers are finite, 0.95 of the time steps converged, the \
         energy growth is at most 0.05, the stretch at most 1.04 times its limit, and no tetrahedron is \
         inverted at the end. Otherwise its row names the goals that it misses, and the reason as far as it \
         is known. Cases whose prescribed places cannot be reached need not converge."
    }

    fn page(&self) -> &'static str {
        pages::STABILITY
    }

    fn on_page(&self) -> bool {
        true
    }

    fn run(&self, bench: &Bench) -> Result<Report> {
        let mut table = Table::new([
            "sweep",
            "value",
            "result",
            "intersections",
            "not finite",
            "converged",
            "energy growth",
            "stretch",
            "two-way steps",
            "most",
        ]);
        let mut count = Count::default();
        let folder = bench.out().join(self.name());
        for case in cases(bench.size).iter().filter(|case| bench.wants(&case.name())) {
            // The tiny form is a test: what it measures must not depend on the machine.
            if bench.size != Size::Tiny && !bench.has_time() {
                break;
            }
            let outcome =
                bench.store.measured(&format!("{}/{}", self.name(), case.name()), || run(case, &folder))?;
            println!("  {:<48} {}", case.name(), result(case, &outcome));
            add(&mut table, case, &outcome);
            count.add(case, &outcome);
        }
        let finding = format!(
            "{} cases with {} states and {} paths judged: {} intersections, {} vertices that are not finite, \
             {} runs that ended early. {} cases reach every goal, {} are refused with a message, {} miss a \
             goal.",
            count.cases,
            count.states,
            count.paths,
            count.intersections,
            count.not_finite,
            count.errors,
            count.reached,
            count.refused,
            count.missed
        );
        Ok(Report { finding, parts: vec![Part::table(self.name(), "", table)] })
    }
}

/// Sums over cases.
#[derive(Default)]
struct Count {
    cases: usize,
    states: usize,
    paths: usize,
    intersections: usize,
    not_finite: usize,
    errors: usize,
    reached: usize,
    refused: usize,
    missed: usize,
}

impl Count {
    fn add(&mut self, case: &Case, outcome: &Outcome) {
        self.cases += 1;
        self.states += outcome.states;
        self.paths += outcome.paths;
        self.intersections += outcome.intersections;
        self.not_finite += outcome.not_finite;
        self.errors += usize::from(outcome.error.is_some());
        let misses = !outcome.missed(case).is_empty();
        match (outcome.refused.is_some(), misses) {
            (true, _) => self.refused += 1,
            (false, true) => self.missed += 1,
            (false, false) => self.reached += 1,
        }
    }
}

fn result(case: &Case, outcome: &Outcome) -> String {
    if let Some(message) = &outcome.refused {
        return format!("refused: {message}");
    }
    let missed = outcome.missed(case);
    match (missed.is_empty(), case.known) {
        (true, _) => "ok".to_owned(),
        (false, "") => missed.join(", "),
        (false, reason) => format!("{}: {reason}", missed.join(", ")),
    }
}

fn add(table: &mut Table, case: &Case, outcome: &Outcome) {
    let made = outcome.time_steps.max(1) as f64;
    table.row([
        case.sweep.into(),
        case.value.clone().into(),
        result(case, outcome).into(),
        outcome.intersections.into(),
        outcome.not_finite.into(),
        (outcome.converged as f64 / made).into(),
        outcome.growth.into(),
        outcome.max_stretch.into(),
        (outcome.steps as f64 / made).into(),
        outcome.most_steps.into(),
    ]);
}
