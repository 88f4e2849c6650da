//! Run time against error of the collision stage: every method and setting on the same problems.

use crate::bench::{Bench, Size};
use crate::chart::{Axis, Chart, Mark, Series, Style, pareto_front};
use crate::figure::{Figure, Part, Report};
use crate::methods::{METHODS, Setting};
use crate::solve::Against;
use crate::summary::{Compared, on_scenes, ratios, table};
use crate::table::{geometric_mean, times};
use crate::targets::{Targets, UNAWARE_SUFFIX};
use anyhow::Result;
use bowknot::constraints::{ContactForm, EdgeReference};
use bowknot::twoway::{Params, StopRule};

pub struct CollisionError {
    /// Whether the targets of the problems are contact-aware, or contact-unaware.
    pub aware: bool,
}

impl CollisionError {
    fn targets(&self) -> Targets {
        if self.aware { Targets::Aware } else { Targets::Unaware }
    }
}

impl Figure for CollisionError {
    fn name(&self) -> &'static str {
        if self.aware { "collision-error" } else { "collision-error-unaware" }
    }

    fn title(&self) -> &'static str {
        match self.aware {
            true => "Run time against error: the collision stage, contact-aware targets",
            false => "Run time against error: the collision stage, contact-unaware targets",
        }
    }

    fn question(&self) -> &'static str {
        match self.aware {
            true => {
                "How close does each method come to the reference solution, and in how many CPU seconds? \
                 Recorded problems of each scene, without friction. Every method solves the same problems, \
                 in turns, within 4 s each. The error is the distance to the reference solution, root mean \
                 square over mass, mean over the problems. If a problem of the scene has no reference, it is \
                 the root of the sum of squares of three quantities: the stationarity residual (the motion \
                 that would still bring x closer to its target and that no active row forbids), the largest \
                 violation of a contact, and the largest excess of an edge over its limit, as a share, times \
                 the edge length. The reference comes from a separate solver of the problem as stated, which \
                 shares with the methods only masses and distances that define it, and is checked by its residuals. The problems are not \
                 convex: a method may end in another good minimum, nearer to its target. Edge limits of the \
                 problem refer to the rest lengths. \
                 `paper` limits edges against the start of the call and so solves another problem; `paper, \
                 edges from rest` solves the same one. Barriers and impact zones have no edge limits. Impact \
                 zones only prevent intersections and keep no distance: a target without intersections on \
                 the way is returned unchanged; with 0.8 delta they solve the problem of the other methods \
                 up to a fifth of the distance."
            }
            false => {
                "The same with targets of a dynamics without repulsion (`--set \
                 solver.repulsion.stiffness=0`), which lie deep in penetration. `contacts-alone` has targets of the \
                 paper's repulsion too. Hard problems have no \
                 reference solution: the separate solver does not come to an end within its time. Barriers and \
                 impact zones have no edge limits, which is part of their error here; `contacts-alone` \
                 compares without limits."
            }
        }
    }

    fn run(&self, bench: &Bench) -> Result<Report> {
        let compared = compared(bench, self.targets(), &settings()?)?;
        let mut report = Report {
            finding: format!("CPU time and error as multiples of those of `fast`: {}", finding(&compared)),
            parts: Vec::new(),
        };
        let shows = format!(
            "all methods, and changes of `fast` and `paper`, on contact-{} targets",
            self.targets().word()
        );
        report.parts.push(Part::table(self.name(), shows, table(&compared, |_| true)));
        for compared in &compared {
            let name = format!("{}-{}", self.name(), compared.scene.trim_end_matches(UNAWARE_SUFFIX));
            report.parts.push(Part::Chart { name, chart: chart(compared) });
        }
        Ok(report)
    }
}

/// Number of problems of each scene.
pub fn count(size: Size) -> usize {
    size.pick(2, 2, 1)
}

/// Problems with these targets, solved by settings.
pub fn compared(bench: &Bench, targets: Targets, settings: &[Setting]) -> Result<Vec<Compared>> {
    on_scenes(
        bench,
        targets.problem_sets(bench.size),
        count(bench.size),
        settings,
        bench.size.pick(3, 1, 1),
        Against::Reference,
    )
}

/// Methods of which changes are measured too.
const VARIED: [&str; 2] = ["fast", "paper"];

/// All methods with their own parameters, and changes of the two presets.
pub fn settings() -> Result<Vec<Setting>> {
    let mut settings: Vec<Setting> = METHODS.iter().map(Setting::plain).collect();
    let mut vary = |method: &str, change: String, set: &dyn Fn(&mut Params)| -> Result<()> {
        settings.push(Setting::of(method)?.with(change, set));
        Ok(())
    };
    for sweeps in [1, 2, 4, 16, 32] {
        vary("fast", format!("{sweeps} sweeps"), &|p| {
            p.solver.backward.sweeps = sweeps;
            p.solver.backward.polish_sweeps = p.solver.backward.polish_sweeps.max(sweeps);
        })?;
    }
    for distance in [0.3, 0.1, 0.01, 0.003, 0.001] {
        vary("fast", format!("stop at {distance} h"), &|p| p.solver.stop.distance = distance)?;
    }
    for distance in [0.01, 0.001] {
        vary("fast", format!("stop at {distance} h, residual {distance}"), &|p| {
            p.solver.stop.distance = distance;
            p.solver.stop.rule = StopRule::Travel { net_residual: 0.2, residual: Some(distance) };
        })?;
    }
    for kappa in [0.05, 0.2, 0.5, 1.0] {
        vary("fast", format!("kappa {kappa}"), &|p| p.solver.backward.contact_proximal = kappa)?;
    }
    for strength in [0.05, 0.2, 0.35, 0.7] {
        vary("fast", format!("edge proximal {strength}"), &|p| p.solver.backward.edge_proximal = strength)?;
    }
    vary("fast", "growth 1".to_owned(), &|p| p.solver.backward.proximal_growth = 1.0)?;
    vary("fast", "volume form".to_owned(), &|p| p.contact.form = ContactForm::Volume)?;
    vary("fast", "no minimum separation".to_owned(), &|p| p.contact.min_separation = Some(0.0))?;
    vary("paper", "edges from rest".to_owned(), &|p| p.contact.edge_reference = EdgeReference::Rest)?;
    for epsilon in [1e-1, 1e-2] {
        vary("paper", format!("epsilon {epsilon}"), &|p| {
            p.solver.stop.rule = StopRule::Clock { remaining_fraction: epsilon };
        })?;
    }
    for sweeps in [4, 16] {
        vary("paper", format!("{sweeps} sweeps"), &|p| {
            p.solver.backward.sweeps = sweeps;
            p.solver.backward.polish_sweeps = sweeps;
        })?;
    }
    vary("paper", "gap form".to_owned(), &|p| p.contact.form = ContactForm::Gap)?;
    Ok(settings)
}

/// One series per method. The presets, and changes on the front, have labels.
fn chart(compared: &Compared) -> Chart {
    let referenced = compared.has_references();
    let summaries = &compared.summaries;
    let places: Vec<(f64, f64)> = summaries.iter().map(|p| (p.cpu, p.error(referenced))).collect();
    let front = pareto_front(&places);
    let series = METHODS.iter().filter_map(|entry| {
        let mut marks = Vec::new();
        for (k, point) in summaries.iter().enumerate().filter(|(_, p)| p.method == entry.name) {
            let label = match point.change.as_str() {
                "" if VARIED.contains(&point.method) => "default".to_owned(),
                "" => String::new(),
                change if front.contains(&k) => change.to_owned(),
                _ => String::new(),
            };
            marks.push(Mark { x: point.cpu, y: 1e3 * point.error(referenced), label });
        }
        (!marks.is_empty()).then(|| Series {
            name: entry.name.to_owned(),
            points: marks,
            style: Style::Marks,
        })
    });
    let error = if referenced {
        "distance to the reference solution, RMS [mm]"
    } else {
        "stationarity residual and violations [mm]"
    };
    Chart {
        title: format!("{}, {} vertices: error against run time", compared.scene, compared.vertices()),
        x: Axis::log("CPU seconds per problem"),
        y: Axis::log(error),
        series: series.collect(),
        front: true,
    }
}

/// The CPU time and error of a method over those of `fast`, geometric means over the scenes; none if there
/// are none.
pub fn over_fast(compared: &[Compared], method: &str) -> Option<[f64; 2]> {
    let (method, fast) = ((method, ""), ("fast", ""));
    let cpu = ratios(compared, method, fast, |s, _| s.cpu);
    let error = ratios(compared, method, fast, |s, referenced| s.error(referenced));
    (!cpu.is_empty() && !error.is_empty()).then(|| [geometric_mean(&cpu), geometric_mean(&error)])
}

/// `paper` and the barriers against `fast`; methods that are faster than `fast`, with their error.
pub fn finding(compared: &[Compared]) -> String {
    if compared.is_empty() {
        return "not measured.".to_owned();
    }
    let shown = |method: &str| {
        let [cpu, error] = over_fast(compared, method)?;
        Some(format!("{method} {} and {}", times(cpu), times(error)))
    };
    let others: Vec<String> = ["paper", "log barrier", "IPC"].into_iter().filter_map(shown).collect();
    let faster: Vec<String> = METHODS
        .iter()
        .filter(|entry| over_fast(compared, entry.name).is_some_and(|[cpu, _]| cpu < 1.0))
        .filter_map(|entry| shown(entry.name))
        .collect();
    let faster = if faster.is_empty() { "no method".to_owned() } else { faster.join("; ") };
    format!("{}. Faster than `fast`: {faster}.", others.join("; "))
}
