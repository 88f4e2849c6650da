//! Run time against error of whole simulations, and the order of the time integration.

use super::{Figure, Part, Section};
use crate::bench::Bench;
use crate::chart::{Axis, Chart, Mark, Series, Style};
use crate::simulate::{Distances, Simulation, simulate};
use crate::table::{Table, short};
use anyhow::Result;
use bowknot::Scene;

pub struct SimulationError;

/// A scene with its time.
struct Subject {
    name: &'static str,
    /// Time simulated [s].
    time: f64,
    /// Time steps of the coarsest simulation; each next has twice as many.
    coarsest: usize,
    /// How many simulations, each with half of the time step of the one before.
    halvings: usize,
    scene: fn() -> Result<Scene>,
    contact: bool,
}

/// Time step of the finest simulation over that of the reference.
const REFERENCE: usize = 64;
const CAPTION: &str =
    "Distances from the reference; *end*: of the last positions. *X*: intersections of the four states.";
/// Samples that simulations are compared at.
const SAMPLES: usize = 4;
/// Simulations that an order is taken of: the time step of the third is 16 times that of the reference, whose own error
/// then makes 1 into 1.05; that of the next into 1.1.
const MEASURED: usize = 3;
/// Newton iterations of the reference: its line search and linear solves are converged long before.
const CONVERGED: usize = 8;

impl Figure for SimulationError {
    fn name(&self) -> &'static str {
        "simulation-error"
    }

    fn title(&self) -> &'static str {
        "Run time against error: whole simulations"
    }

    fn question(&self) -> &'static str {
        "Against a simulation of the same mesh with 1/64 of the largest time step and converged Newton iterations: how far off \
         are energy, centre of mass, mean stretch, positions and the shape at the end, and at what CPU time? Root mean squares \
         over four times. `swing`, a sheet held along one side, has no contact: implicit Euler is of order 1 there. `drape` and \
         `stack` have, whose folds amplify differences. Presets, time steps, Newton iterations, sweeps, stopping \
         rules, and a dynamics that is blind to contact. sigma and delta are part of the problem."
    }

    fn run(&self, bench: &Bench) -> Result<Section> {
        let size = bench.size;
        let full = size == crate::bench::Size::Full;
        let mut subjects = vec![Subject {
            name: "swing",
            time: 0.4,
            coarsest: 16,
            halvings: size.pick(5, 4, 3),
            scene: swing,
            contact: false,
        }];
        if full {
            let drape = || Ok(Scene::builtin("drape", 0.25)?);
            let stack = || Ok(Scene::builtin("stack", 0.15)?);
            for (name, scene, time) in
                [("drape", drape as fn() -> Result<Scene>, 0.64), ("stack", stack, 0.64)]
            {
                subjects.push(Subject { name, time, coarsest: 16, halvings: 4, scene, contact: true });
            }
        }
        let mut section = Section::default();
        let mut table = Table::new([
            "scene",
            "setting",
            "dt, ms",
            "CPU s",
            "energy, J",
            "centre, mm",
            "stretch, 1e-3",
            "positions, mm",
            "end, mm",
            "X",
        ]);
        let mut told = Vec::new();
        for subject in &subjects {
            let reference = reference(bench, subject)?;
            let mut series = Vec::new();
            for (name, sets) in settings(subject.contact) {
                let mut marks = Vec::new();
                let mut errors = Vec::new();
                for k in 0..subject.halvings {
                    if !bench.has_time() {
                        break;
                    }
                    let steps = subject.coarsest << k;
                    let done = at(bench, subject, &name, &sets, steps)?;
                    let error = Distances::between(&done, &reference);
                    let dt = subject.time / steps as f64;
                    table.row([
                        subject.name.into(),
                        name.clone().into(),
                        (1e3 * dt).into(),
                        done.cpu_seconds().into(),
                        error.energy.into(),
                        (1e3 * error.center).into(),
                        (1e3 * error.stretch).into(),
                        (1e3 * error.positions).into(),
                        (1e3 * error.last).into(),
                        done.intersections().into(),
                    ]);
                    let label = format!("{} ms", short(1e3 * dt));
                    marks.push(Mark { x: done.cpu_seconds(), y: 1e3 * error.center, label });
                    errors.push(error);
                }
                if let Some(order) = order(&errors) {
                    told.push(format!("{} {name}: {order}", subject.name));
                }
                series.push(Series { name, points: marks, style: Style::Line });
            }
            let chart = Chart {
                title: format!("{}: error of the centre of mass against run time", subject.name),
                x: Axis::log("CPU seconds of the simulation"),
                y: Axis::log("error [mm]"),
                series,
                front: true,
            };
            section.parts.push(Part::Chart { name: format!("simulation-error-{}", subject.name), chart });
        }
        section.finding = format!(
            "Observed orders, of energy / centre of mass / positions, from half to a quarter of the largest time step: {}. (Implicit \
             Euler: 1.)",
            told.join("; ")
        );
        section.parts.push(Part::Table { name: self.name().to_owned(), caption: CAPTION.to_owned(), table });
        Ok(section)
    }
}

/// Names of settings and how they are set.
fn settings(contact: bool) -> Vec<(String, Vec<String>)> {
    let newton = |n: usize| format!("simulation.newton_iterations={n}");
    let named = |name: &str, sets: Vec<String>| (name.to_owned(), sets);
    let mut all = vec![named("fast, 1 Newton iteration", vec![newton(1)]), named("fast, 4", vec![newton(4)])];
    if contact {
        let paper = || "contact.preset=paper".to_owned();
        all.push(named(
            "fast, 4, collisions once",
            vec![newton(4), "simulation.collision_every=step".to_owned()],
        ));
        for (name, set) in [
            ("fast, 1, 1 sweep", "solver.sweeps=1"),
            ("fast, 1, 32 sweeps", "solver.sweeps=32"),
            ("fast, 1, stop at 0.1 h", "solver.stop.distance=0.1"),
            ("fast, 1, stop at 0.001 h", "solver.stop.distance=0.001"),
            ("fast, 1, no repulsion", "solver.repulsion.stiffness=0"),
        ] {
            all.push(named(name, vec![newton(1), set.to_owned()]));
        }
        all.push(named("paper, 1 Newton iteration", vec![paper(), newton(1)]));
        all.push(named("paper, 4", vec![paper(), newton(4)]));
    }
    all
}

fn reference(bench: &Bench, subject: &Subject) -> Result<Simulation> {
    let sets = [format!("simulation.newton_iterations={CONVERGED}")];
    at(bench, subject, "reference", &sets, subject.coarsest * REFERENCE)
}

/// The scene's simulation in that many time steps.
fn at(bench: &Bench, subject: &Subject, name: &str, sets: &[String], steps: usize) -> Result<Simulation> {
    let key = format!("{}/{name}/{steps}", subject.name);
    let mut sets = sets.to_vec();
    sets.push(format!("simulation.dt={:?}", subject.time / steps as f64));
    simulate(bench, &key, &(subject.scene)()?.with_sets(&sets)?, steps, SAMPLES)
}

/// A sheet held along one side swings down; it touches nothing and no edge is limited, so that it is all dynamics.
fn swing() -> Result<Scene> {
    let text = r#"
        [[body]]
        name = "sheet"
        shape = { type = "sheet", size = [0.4, 0.4], edge = 0.05 }
        material = "cotton"
        stretch_limit = inf

        [[pin]]
        body = "sheet"
        side = "x-max"
    "#;
    Ok(Scene::from_toml(text, ".")?)
}

/// log2(error / error at half the time step), of the last halving that is coarse against the reference.
fn order(errors: &[Distances]) -> Option<String> {
    let [.., coarse, fine] = &errors[..errors.len().min(MEASURED)] else { return None };
    let of = |value: fn(&Distances) -> f64| short((value(coarse) / value(fine)).log2());
    Some(format!("{} / {} / {}", of(|e| e.energy), of(|e| e.center), of(|e| e.positions)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simulate::run;

    /// Implicit Euler is of order 1: half of the time step, half of the error.
    #[test]
    fn a_swinging_sheet_converges_at_first_order() {
        let at = |steps: usize| {
            let sets = [
                format!("simulation.dt={:?}", 0.2 / steps as f64),
                "simulation.newton_iterations=6".to_owned(),
                "body.0.shape.edge=0.1".to_owned(),
            ];
            let scene = swing().expect("a scene").with_sets(&sets).expect("sound keys");
            run(&scene, steps, 2).expect("a simulation")
        };
        let reference = at(40 * 16);
        let errors = [20, 40].map(|steps| Distances::between(&at(steps), &reference));
        for (what, ratio) in [
            ("energy", errors[0].energy / errors[1].energy),
            ("centre", errors[0].center / errors[1].center),
            ("positions", errors[0].positions / errors[1].positions),
        ] {
            // The reference's own error of 1/16 makes 2 into 32/15 - 1/15.. : 2.07.
            assert!((1.8..2.4).contains(&ratio), "{what} goes down by {ratio}");
        }
    }
}
