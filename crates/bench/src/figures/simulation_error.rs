//! Run time against error of whole simulations, and the order of the time integration.

use super::{Figure, Part, Section};
use crate::bench::Bench;
use crate::chart::{Axis, Chart, Mark, Series, Style};
use crate::simulate::{Distances, Simulation, simulate};
use crate::table::{Table, geometric_mean, short, times};
use anyhow::Result;
use bowknot::Scene;

pub struct SimulationError;

/// CPU seconds of a simulation, and how far off it is.
type Timed = (f64, Distances);

/// A scene with its time.
struct Subject {
    name: &'static str,
    /// Time simulated [s].
    time: f64,
    /// Time steps of the coarsest simulation; each next has twice as many.
    coarsest: usize,
    /// How many simulations, each with half of the time step of the one before.
    halvings: usize,
    /// Time step of the coarsest simulation over that of the reference.
    reference: usize,
    scene: fn() -> Result<Scene>,
    contact: bool,
    /// Whether small differences stay small, so that there is an order to observe: folds amplify them.
    smooth: bool,
}

const CAPTION: &str =
    "Distances from the reference; *end*: of the last positions. *X*: intersections of the four states.";
/// Samples that simulations are compared at.
const SAMPLES: usize = 4;
/// Time steps over that of the reference from which on an order is taken: the reference's own error then makes 1 into 1.05.
const RESOLVED: usize = 16;
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
        "Against a simulation of the same mesh with 1/64 of the largest time step (`swing`: 1/256) and converged Newton iterations: how far off \
         are energy, centre of mass, mean stretch, positions and the shape at the end, and at what CPU time? Root mean squares \
         over four times. `swing`, a sheet held along one side, has no contact: implicit Euler is of order 1 there. `block`, a cube of \
         jelly, drops onto the ground; how high it bounces depends on the time step. `drape` and `stack` fold, and folds amplify every difference until they lie elsewhere: \
         their positions tell how far apart two runs of anything end, their energies what a setting does. Presets, time steps, Newton iterations, sweeps, stopping \
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
            reference: size.pick(256, 128, 64),
            scene: swing,
            contact: false,
            smooth: true,
        }];
        if full {
            let of = |name, time, halvings, scene, smooth| Subject {
                name,
                time,
                coarsest: 16,
                halvings,
                reference: 64,
                scene,
                contact: true,
                smooth,
            };
            subjects.push(of("block", 0.32, 4, block as fn() -> Result<Scene>, true));
            subjects.push(of("drape", 0.64, 4, || Ok(Scene::builtin("drape", 0.25)?), false));
            subjects.push(of("stack", 0.64, 4, || Ok(Scene::builtin("stack", 0.15)?), false));
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
        let (mut told, mut compared) = (Vec::new(), Vec::new());
        for subject in &subjects {
            let reference = reference(bench, subject)?;
            let mut series = Vec::new();
            let mut errors_of: Vec<(String, Vec<Timed>)> = Vec::new();
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
                    errors.push((done.cpu_seconds(), error));
                }
                if let Some(order) =
                    subject.order(&errors).filter(|_| !sets.iter().any(|s| s.contains("solver")))
                {
                    told.push(format!("{} {name}: {order}", subject.name));
                }
                errors_of.push((name.clone(), errors));
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
            compared.extend(against_fast(subject, &errors_of));
        }
        section.finding = format!(
            "Observed orders, of energy / centre of mass / positions: {}. (Implicit Euler: 1.) Against `fast` with one Newton iteration, geometric means over \
             the time steps, CPU time / error of the energy / of the centre of mass: {}.",
            told.join("; "),
            compared.join("; ")
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
            ("fast, 1, 1 sweep", "solver.backward.sweeps=1"),
            ("fast, 1, 32 sweeps", "solver.backward.sweeps=32"),
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
    let sets =
        [format!("simulation.newton_iterations={CONVERGED}"), "solver.newton.step_tolerance=0".to_owned()];
    at(bench, subject, "reference", &sets, subject.coarsest * subject.reference)
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

/// A soft cube drops by 2 cm onto the ground.
fn block() -> Result<Scene> {
    let text = r#"
        [[body]]
        name = "block"
        kind = "solid"
        shape = { type = "block", size = [0.1, 0.1, 0.1], edge = 0.025 }
        material = "jelly"
        translate = [0.0, 0.0, 0.07]

        [[obstacle]]
        name = "ground"
        shape = { type = "half-space" }
    "#;
    Ok(Scene::from_toml(text, ".")?)
}

impl Subject {
    /// log2(error / error at half the time step), of the last halving that is coarse against the reference.
    fn order(&self, errors: &[Timed]) -> Option<String> {
        let resolved = (self.reference / RESOLVED).ilog2() as usize + 1;
        let [.., (_, coarse), (_, fine)] = &errors[..errors.len().min(resolved)] else { return None };
        let of = |value: fn(&Distances) -> f64| short((value(coarse) / value(fine)).log2());
        self.smooth.then(|| format!("{} / {} / {}", of(|e| e.energy), of(|e| e.center), of(|e| e.positions)))
    }
}

/// The settings that differ most from the default, against it.
fn against_fast(subject: &Subject, errors_of: &[(String, Vec<Timed>)]) -> Vec<String> {
    let Some((_, fast)) = errors_of.first() else { return Vec::new() };
    let others = errors_of.iter().filter(|(name, _)| {
        ["paper, 1 Newton iteration", "fast, 1, no repulsion", "fast, 4"].contains(&name.as_str())
    });
    let told = others.map(|(name, errors)| {
        let mean = |ratio: &dyn Fn(&Timed, &Timed) -> f64| {
            let ratios: Vec<f64> = errors.iter().zip(fast).map(|(a, b)| ratio(a, b)).collect();
            times(geometric_mean(&ratios))
        };
        format!(
            "{} {name} {} / {} / {}",
            subject.name,
            mean(&|a, b| a.0 / b.0),
            mean(&|a, b| a.1.energy / b.1.energy),
            mean(&|a, b| a.1.center / b.1.center)
        )
    });
    told.collect()
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
                "solver.newton.step_tolerance=0".to_owned(),
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
