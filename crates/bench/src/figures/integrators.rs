//! Run time against error of the integrators, over time steps.

use crate::bench::{Bench, Size};
use crate::chart::{Axis, Chart, Mark, Series, Style};
use crate::figure::{Figure, Part, Report};
use crate::simulate::{Distances, Simulation, simulate};
use crate::table::{Table, geometric_mean, short, times};
use anyhow::Result;
use bowknot::Scene;

pub struct Integrators;

const SHOWS: &str = "distances of simulations from the reference by integrator and time step, root mean squares over four \
                     times; `end_mm`: positions at the last; `energy_end_j`: kinetic, elastic and potential energy there";
const SAMPLES: usize = 4;
/// Time steps per second of the reference, by the method of second order.
const REFERENCE: usize = 1600;
const INTEGRATORS: [&str; 2] = ["implicit-euler", "sdirk2"];

/// A scene with the time simulated [s].
struct Subject {
    name: &'static str,
    time: f64,
    scene: fn() -> Result<Scene>,
}

impl Figure for Integrators {
    fn name(&self) -> &'static str {
        "integrators"
    }

    fn title(&self) -> &'static str {
        "Run time against error: integrators"
    }

    fn question(&self) -> &'static str {
        "The reference is a simulation of the same mesh by `sdirk2` at 1/1600 s. `swing`: a sheet held along one side falls; \
         `beam`: a bar of rubber clamped at one end does: no contact. `block`: a cube of jelly drops onto the ground; \
         `cubes`: two meet at 1 m/s without gravity; `trampoline`: the built-in scene. `drape` and `stack` fold, and folds \
         amplify small differences: their positions show how far any two runs diverge."
    }

    fn run(&self, bench: &Bench) -> Result<Report> {
        let subjects = [
            Subject { name: "swing", time: 0.32, scene: swing },
            Subject { name: "beam", time: 0.32, scene: beam },
            Subject { name: "block", time: 0.48, scene: block },
            Subject { name: "cubes", time: 0.24, scene: cubes },
            Subject { name: "trampoline", time: 0.64, scene: || Ok(Scene::builtin("trampoline", 0.4)?) },
            Subject { name: "drape", time: 0.64, scene: || Ok(Scene::builtin("drape", 0.4)?) },
            Subject { name: "stack", time: 0.64, scene: || Ok(Scene::builtin("stack", 0.2)?) },
        ];
        let subjects = if bench.size == Size::Full { &subjects[..] } else { &subjects[..2] };
        let rates: &[usize] = bench.size.pick(&[50, 100, 200, 400], &[50, 100, 200], &[50, 100]);
        let mut report = Report::default();
        let columns = [
            "scene",
            "integrator",
            "dt_ms",
            "cpu_s",
            "positions_mm",
            "centre_of_mass_mm",
            "end_mm",
            "energy_j",
            "energy_end_j",
            "intersections",
        ];
        let mut table = Table::new(columns);
        let (mut errors_at_equal_steps, mut seconds_at_equal_steps) = (Vec::new(), Vec::new());
        for subject in subjects {
            let reference = at(bench, subject, "sdirk2", REFERENCE)?;
            let mut series = Vec::new();
            let mut errors_of = Vec::new();
            for integrator in INTEGRATORS {
                let mut marks = Vec::new();
                for &rate in rates.iter().filter(|_| bench.has_time()) {
                    let done = at(bench, subject, integrator, rate)?;
                    let error = Distances::between(&done, &reference);
                    let dt = 1e3 / rate as f64;
                    table.row([
                        subject.name.into(),
                        integrator.into(),
                        dt.into(),
                        done.cpu_seconds().into(),
                        (1e3 * error.positions).into(),
                        (1e3 * error.center).into(),
                        (1e3 * error.last).into(),
                        error.energy.into(),
                        done.samples.last().map_or(f64::NAN, |sample| sample.energy).into(),
                        done.intersections().into(),
                    ]);
                    marks.push(Mark {
                        x: done.cpu_seconds(),
                        y: 1e3 * error.positions,
                        label: format!("{} ms", short(dt)),
                    });
                    errors_of.push((done.cpu_seconds(), error.positions));
                }
                series.push(Series { name: integrator.to_owned(), points: marks, style: Style::Line });
            }
            let (euler, second) = errors_of.split_at(errors_of.len() / 2);
            for (euler, second) in euler.iter().zip(second) {
                seconds_at_equal_steps.push(second.0 / euler.0);
                errors_at_equal_steps.push(second.1 / euler.1);
            }
            let chart = Chart {
                title: format!("{}: error of positions against run time", subject.name),
                x: Axis::log("CPU seconds of the simulation"),
                y: Axis::log("error [mm]"),
                series,
                front: true,
            };
            report.parts.push(Part::Chart { name: format!("integrators-{}", subject.name), chart });
        }
        report.finding = format!(
            "At equal time steps `sdirk2` takes {} the CPU time of `implicit-euler` and has {} its error of positions \
             (geometric means over scenes and time steps).",
            times(geometric_mean(&seconds_at_equal_steps)),
            times(geometric_mean(&errors_at_equal_steps))
        );
        report.parts.push(Part::table(self.name(), SHOWS, table));
        Ok(report)
    }
}

fn at(bench: &Bench, subject: &Subject, integrator: &str, rate: usize) -> Result<Simulation> {
    let sets =
        [format!("simulation.integrator={integrator}"), format!("simulation.dt={:?}", 1.0 / rate as f64)];
    let key = format!("integrators/{}/{integrator}/{rate}", subject.name);
    let steps = (subject.time * rate as f64).round() as usize;
    simulate(bench, &key, &(subject.scene)()?.with_sets(&sets)?, steps, SAMPLES)
}

fn swing() -> Result<Scene> {
    let text = r#"
        [[body]]
        name = "sheet"
        shape = { type = "sheet", size = [0.5, 0.5], edge = 0.025 }
        material = "cotton"

        [[pin]]
        body = "sheet"
        side = "x-min"
    "#;
    Ok(Scene::from_toml(text, ".")?)
}

fn beam() -> Result<Scene> {
    let text = r#"
        [[body]]
        name = "beam"
        kind = "solid"
        shape = { type = "block", size = [0.5, 0.05, 0.05], edge = 0.0125 }
        material = { density = 1000.0, young_modulus = 300000.0 }

        [[pin]]
        body = "beam"
        side = "x-min"
    "#;
    Ok(Scene::from_toml(text, ".")?)
}

fn block() -> Result<Scene> {
    let text = r#"
        [[body]]
        name = "cube"
        kind = "solid"
        shape = { type = "block", size = [0.16, 0.16, 0.16], edge = 0.02 }
        material = { density = 400.0, young_modulus = 60000.0 }
        translate = [0.0, 0.0, 0.3]
        stretch_limit = inf
        friction = 0.4

        [[obstacle]]
        name = "ground"
        shape = { type = "half-space" }
        friction = 0.4
    "#;
    Ok(Scene::from_toml(text, ".")?)
}

/// Two cubes that meet a little off their centers.
fn cubes() -> Result<Scene> {
    let cube = |name: &str, place: &str, speed: f64| {
        format!(
            r#"
            [[body]]
            name = "{name}"
            kind = "solid"
            shape = {{ type = "block", size = [0.16, 0.16, 0.16], edge = 0.02 }}
            material = {{ density = 400.0, young_modulus = 60000.0 }}
            translate = {place}
            velocity = [{speed:?}, 0.0, 0.0]
            stretch_limit = inf
            friction = 0.4
            "#
        )
    };
    let text = format!(
        "[simulation]\ngravity = [0.0, 0.0, 0.0]\n{}{}",
        cube("left", "[-0.1, 0.0, 0.0]", 0.5),
        cube("right", "[0.1, 0.002, 0.003]", -0.5)
    );
    Ok(Scene::from_toml(&text, ".")?)
}
