//! Run time against error of the collision stage: every method and setting on the same problems.

use super::{Figure, Part, Section};
use crate::bench::Bench;
use crate::chart::{Axis, Chart, Mark, Series, Style, pareto_front};
use crate::methods::{METHODS, Setting};
use crate::summary::{COLUMNS, Compared, on_scenes, ratios, table};
use crate::table::{geometric_mean, times};
use anyhow::Result;
use bowknot::constraints::{ContactForm, EdgeReference};
use bowknot::twoway::Params;

pub struct CollisionError;

impl Figure for CollisionError {
    fn name(&self) -> &'static str {
        "collision-error"
    }

    fn title(&self) -> &'static str {
        "Run time against error: the collision stage"
    }

    fn question(&self) -> &'static str {
        "How near does each method come to the exact solution, and in how many CPU seconds? Recorded problems of each \
         scene, without friction; every method solves the same ones, in turns. The error is the distance to the exact \
         solution, root mean square over mass, mean over the problems; where not all problems of a scene have one, it is the \
         stationarity residual (the motion that would still bring x nearer to its target, all active rows obeyed) and the largest \
         violation of a contact, as the root of the sum of their squares. Problems are not convex, so that a method may do well and end in another minimum. All are judged by the row set of `fast`, \
         edges limited against rest; `paper` limits them against the start of the call and so solves another problem, \
         `paper, edges from rest` the same one."
    }

    fn run(&self, bench: &Bench) -> Result<Section> {
        let scenes: &[&'static str] = bench.size.pick(
            &["needle", "stack", "tube", "bow-knot", "reef-knot", "dress"][..],
            &["needle", "stack", "tube"],
            &["needle"],
        );
        let (count, rounds) = (bench.size.pick(3, 2, 1), bench.size.pick(3, 1, 1));
        let compared = on_scenes(bench, scenes, count, &settings()?, rounds)?;
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

/// All methods as they are, and changes of the two presets.
fn settings() -> Result<Vec<Setting>> {
    let mut settings: Vec<Setting> = METHODS.iter().map(Setting::plain).collect();
    let mut vary = |method: &str, change: String, set: &dyn Fn(&mut Params)| -> Result<()> {
        settings.push(Setting::of(method)?.with(change, set));
        Ok(())
    };
    for sweeps in [1, 2, 4, 16, 32] {
        vary("fast", format!("{sweeps} sweeps"), &|p| {
            p.backward.sweeps = sweeps;
            p.backward.polish_sweeps = p.backward.polish_sweeps.max(sweeps);
        })?;
    }
    for distance in [0.3, 0.1, 0.01, 0.003, 0.001] {
        vary("fast", format!("stop at {distance} h"), &|p| p.stop.distance = distance)?;
    }
    for distance in [0.01, 0.001] {
        vary("fast", format!("stop at {distance} h, drag {distance}"), &|p| {
            p.stop.distance = distance;
            p.stop.drag = Some(distance);
        })?;
    }
    for kappa in [0.1, 0.25, 1.0] {
        vary("fast", format!("kappa {kappa}"), &|p| p.backward.contact_proximal = kappa)?;
    }
    for strength in [0.1, 0.2, 0.7] {
        vary("fast", format!("edge proximal {strength}"), &|p| p.backward.edge_proximal = strength)?;
    }
    vary("fast", "volume form".to_owned(), &|p| p.constraints.form = ContactForm::Volume)?;
    vary("fast", "no floor".to_owned(), &|p| p.stepper.floor = Some(0.0))?;
    vary("paper", "edges from rest".to_owned(), &|p| p.constraints.edge_reference = EdgeReference::Rest)?;
    for clock in [1e-1, 1e-2] {
        vary("paper", format!("epsilon {clock}"), &|p| p.stop.clock = clock)?;
    }
    for sweeps in [4, 16] {
        vary("paper", format!("{sweeps} sweeps"), &|p| {
            p.backward.sweeps = sweeps;
            p.backward.polish_sweeps = sweeps;
        })?;
    }
    vary("paper", "gap form".to_owned(), &|p| p.constraints.form = ContactForm::Gap)?;
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
                "" => "as it is".to_owned(),
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
        "stationarity residual and violation [mm]"
    };
    Chart {
        title: format!("{}, {} vertices: error against run time", compared.scene, compared.vertices()),
        x: Axis::log("CPU seconds a problem"),
        y: Axis::log(error),
        series: series.collect(),
        front: true,
    }
}

/// Time and error of each other method as it is, over those of `fast`.
fn finding(compared: &[Compared]) -> String {
    let fast = ("fast", "");
    let parts: Vec<String> = METHODS
        .iter()
        .filter(|entry| entry.name != "fast")
        .filter_map(|entry| {
            let cpu = ratios(compared, (entry.name, ""), fast, |s, _| s.cpu);
            let error = ratios(compared, (entry.name, ""), fast, |s, exact| s.error(exact));
            (!cpu.is_empty() && !error.is_empty()).then(|| {
                let (cpu, error) = (times(geometric_mean(&cpu)), times(geometric_mean(&error)));
                format!("{} takes {cpu} at {error}", entry.name)
            })
        })
        .collect();
    format!(
        "CPU seconds and error as multiples of those of `fast`, geometric means over the scenes: {}.",
        parts.join("; ")
    )
}
