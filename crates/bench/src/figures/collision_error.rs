//! Run time against error of the collision stage: every method and setting on the same problems.

use super::{Figure, Part, Section};
use crate::bench::Bench;
use crate::chart::{Axis, Chart, Mark, Series, Style, pareto_front};
use crate::methods::{METHODS, Setting};
use crate::solve::Against;
use crate::summary::{COLUMNS, Compared, on_scenes, ratios, table};
use crate::table::{geometric_mean, times};
use anyhow::Result;
use bowknot::constraints::{ContactForm, EdgeReference};
use bowknot::twoway::{Params, StopRule};

pub struct CollisionError {
    /// Problems of a dynamics that knows of no contact, or of Bowknot's own.
    pub blind: bool,
}

impl Figure for CollisionError {
    fn name(&self) -> &'static str {
        if self.blind { "collision-error-blind" } else { "collision-error" }
    }

    fn title(&self) -> &'static str {
        match self.blind {
            true => "Run time against error: the collision stage, targets of a dynamics blind to contact",
            false => "Run time against error: the collision stage, targets of Bowknot's dynamics",
        }
    }

    fn question(&self) -> &'static str {
        match self.blind {
            true => {
                "The same for problems as the paper's simulator poses them: its dynamics knows of no contact, so that targets go deep \
                 through what is in the way (`--set solver.repulsion.stiffness=0`). Hard ones have no exact solution: the \
                 linearisation does not come to rest within a minute. Barriers and impact zones have no edge limits, which is part of their \
                 error here; the next section compares without."
            }
            false => {
                "How near does each method come to the exact solution, and in how many CPU seconds? Recorded problems of each \
                 scene, without friction; every method solves the same ones, in turns, in 4 seconds each at most. The error is the distance to the exact \
                 solution, root mean square over mass, mean over the problems; where not all problems of a scene have one, it is the \
                 stationarity residual (the motion that would still bring x nearer to its target, all active rows obeyed), the largest \
                 violation of a contact, and the largest share by which an edge exceeds its limit times the edge length, as the root of \
                 the sum of their squares. Problems are not convex, so that a method may do well and end in another minimum. All are judged by the row set of `fast`, \
                 edges limited against rest; `paper` limits them against the start of the call and so solves another problem, \
                 `paper, edges from rest` the same one. Impact zones only keep things from meeting, at no distance: a target that meets \
                 nothing is returned as it is; with 0.8 delta they solve the problem of the others to a fifth."
            }
        }
    }

    fn run(&self, bench: &Bench) -> Result<Section> {
        let compared = compared(bench, self.blind, &settings()?)?;
        let mut section = Section { finding: finding(&compared), parts: Vec::new() };
        section.parts.push(Part::Table {
            name: self.name().to_owned(),
            caption: format!("Methods as they are. {COLUMNS}"),
            table: table(&compared, |s| s.change.is_empty()),
        });
        for compared in &compared {
            let name = format!("{}-{}", self.name(), compared.scene);
            section.parts.push(Part::Chart { name, chart: chart(compared) });
        }
        let name = format!("{}-all", self.name());
        section.parts.push(Part::Data { name, table: table(&compared, |_| true) });
        Ok(section)
    }
}

/// Problems of Bowknot's dynamics, or of one that is blind to contact, solved by settings.
pub fn compared(bench: &Bench, blind: bool, settings: &[Setting]) -> Result<Vec<Compared>> {
    let scenes: &[&'static str] = match blind {
        true => bench.size.pick(
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
        ),
        false => bench.size.pick(
            &["needle", "stack", "tube", "bow-knot", "reef-knot", "dress"][..],
            &["needle", "stack", "tube"],
            &["needle"],
        ),
    };
    on_scenes(bench, scenes, bench.size.pick(2, 2, 1), settings, bench.size.pick(3, 1, 1), Against::Exact)
}

/// Methods of which changes are measured as well.
const VARIED: [&str; 2] = ["fast", "paper"];

/// All methods as they are, and changes of the two presets.
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
        vary("fast", format!("stop at {distance} h, drag {distance}"), &|p| {
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
    vary("fast", "no floor".to_owned(), &|p| p.contact.min_separation = Some(0.0))?;
    vary("paper", "edges from rest".to_owned(), &|p| p.contact.edge_reference = EdgeReference::Rest)?;
    for clock in [1e-1, 1e-2] {
        vary("paper", format!("epsilon {clock}"), &|p| {
            p.solver.stop.rule = StopRule::Clock { remaining_fraction: clock };
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

/// A series for each method; what lies on the front, and methods as they are, have labels.
fn chart(compared: &Compared) -> Chart {
    let exact = compared.is_exact();
    let summaries = &compared.summaries;
    let places: Vec<(f64, f64)> = summaries.iter().map(|p| (p.cpu, p.error(exact))).collect();
    let front = pareto_front(&places);
    let series = METHODS.iter().filter_map(|entry| {
        let mut marks = Vec::new();
        for (k, point) in summaries.iter().enumerate().filter(|(_, p)| p.method == entry.name) {
            let label = match point.change.as_str() {
                "" if VARIED.contains(&point.method) => "as it is".to_owned(),
                "" => String::new(),
                change if front.contains(&k) => change.to_owned(),
                _ => String::new(),
            };
            marks.push(Mark { x: point.cpu, y: 1e3 * point.error(exact), label });
        }
        (!marks.is_empty()).then(|| Series {
            name: entry.name.to_owned(),
            points: marks,
            style: Style::Marks,
        })
    });
    let error = if exact {
        "distance to the exact solution, RMS [mm]"
    } else {
        "stationarity residual and violations [mm]"
    };
    Chart {
        title: format!("{}, {} vertices: error against run time", compared.scene, compared.vertices()),
        x: Axis::log("CPU seconds a problem"),
        y: Axis::log(error),
        series: series.collect(),
        front: true,
    }
}

/// `fast` against the paper's method and its rivals; what is as fast, and at what error.
pub fn finding(compared: &[Compared]) -> String {
    let fast = ("fast", "");
    let over = |method: &str| {
        let cpu = ratios(compared, (method, ""), fast, |s, _| s.cpu);
        let error = ratios(compared, (method, ""), fast, |s, exact| s.error(exact));
        (!cpu.is_empty() && !error.is_empty()).then(|| (geometric_mean(&cpu), geometric_mean(&error)))
    };
    let told = ["paper", "log barrier", "log barrier, Newton"].iter().filter_map(|method| {
        over(method).map(|(c, e)| format!("{method} takes {} the time at {} the error", times(c), times(e)))
    });
    let faster: Vec<String> = METHODS
        .iter()
        .filter_map(|entry| {
            let (cpu, error) = over(entry.name).filter(|(cpu, _)| *cpu < 1.0)?;
            Some(format!("{} ({} at {} the error)", entry.name, times(cpu), times(error)))
        })
        .collect();
    let faster = match faster.is_empty() {
        true => "No method is faster than `fast`".to_owned(),
        false => format!("Faster than `fast`: {}", faster.join(", ")),
    };
    format!(
        "Against `fast`, geometric means over the scenes: {}. {faster}.",
        told.collect::<Vec<_>>().join("; ")
    )
}
