//! Run time against error of whole simulations, and the observed order of the time integration.

use crate::bench::Bench;
use crate::chart::{Axis, Chart, Mark, Series, Style};
use crate::figure::{Figure, Part, Report};
use crate::simulate::{Distances, Simulation, simulate};
use crate::table::{Table, geometric_mean, short, times};
use anyhow::Result;
use bowknot::Scene;

pub struct SimulationError;

/// CPU seconds of a simulation, and its distances from the reference.
type Timed = (f64, Distances);

/// A scene with its time.
struct Subject {
    name: &'static str,
    /// Time simulated [s].
    time: f64,
    /// Number of time steps of the coarsest simulation; each next one has twice as many.
    coarsest: usize,
    /// Number of simulations, each with half of the time step of the previous one.
    halvings: usize,
    /// Time step of the coarsest simulation over that of the reference.
    reference: usize,
    scene: fn() -> Result<Scene>,
    contact: bool,
    /// Whether small differences stay small, so that an order can be observed. Folds amplify them.
    smooth: bool,
}

const SHOWS: &str =
    "distances of simulations from the reference by setting and time step; `end_mm`: of the last positions";
/// Number of samples at which simulations are compared.
const SAMPLES: usize = 4;
/// Smallest ratio of a time step to that of the reference at which an order is observed: the reference's own
/// error then turns an order of 1 into 1.05.
const RESOLVED: usize = 16;
/// Newton iterations of the reference; they converge long before.
const CONVERGED: usize = 8;

impl Figure for SimulationError {
    fn name(&self) -> &'static str {
        "simulation-error"
    }

    fn title(&self) -> &'static str {
        "Run time against error: whole simulations"
    }

    fn question(&self) -> &'static str {
        "The reference is a simulation of the same mesh with 1/64 of the largest time step (`swing`: 1/256) \
         and converged Newton iterations. How far from it are energy, center of mass, mean stretch, \
         positions and the last shape, and at what CPU time? Root mean squares over four times. `swing`, a \
         sheet held along one side, has no contact: implicit Euler has order 1 there. `block`, a cube of \
         jelly, drops onto the ground; how high it bounces depends on the time step. `drape` and `stack` \
         fold, and folds amplify small differences: their positions show how far any two runs diverge, their \
         energies the effect of a setting. Presets, time steps, Newton iterations, sweeps, stopping rules, \
         and a dynamics without repulsion are compared. sigma and delta define the problem and stay fixed."
    }

    fn run(&self, bench: &Bench) -> Result<Report> {
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
        let mut report = Report::default();
        let mut table = Table::new([
            "scene",
            "setting",
            "dt_ms",
            "cpu_s",
            "energy_j",
            "centre_of_mass_mm",
            "mean_stretch_permille",
            "positions_mm",
            "end_mm",
            "intersections",
        ]);
        let (mut orders, mut compared) = (Vec::new(), Vec::new());
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
                    orders.push(format!("{} {name}: {order}", subject.name));
                }
                errors_of.push((name.clone(), errors));
                series.push(Series { name, points: marks, style: Style::Line });
            }
            let chart = Chart {
                title: format!("{}: error of the center of mass against run time", subject.name),
                x: Axis::log("CPU seconds of the simulation"),
                y: Axis::log("error [mm]"),
                series,
                front: true,
            };
            report.parts.push(Part::Chart { name: format!("simulation-error-{}", subject.name), chart });
            compared.extend(against_fast(subject, &errors_of));
        }
        report.finding = format!(
            "Observed orders, of energy / center of mass / positions: {}. (Implicit Euler: 1.) Against \
             `fast` with one Newton iteration, geometric means over the time steps, CPU time / error of the \
             energy / of the center of mass: {}.",
            orders.join("; "),
            compared.join("; ")
        );
        report.parts.push(Part::table(self.name(), SHOWS, table));
        Ok(report)
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

/// The scene, simulated in so many time steps.
fn at(bench: &Bench, subject: &Subject, name: &str, sets: &[String], steps: usize) -> Result<Simulation> {
    let key = format!("{}/{name}/{steps}", subject.name);
    let mut sets = sets.to_vec();
    sets.push(format!("simulation.dt={:?}", subject.time / steps as f64));
    simulate(bench, &key, &(subject.scene)()?.with_sets(&sets)?, steps, SAMPLES)
}

/// A sheet held along one side swings down. There is no contact and no edge limit: dynamics alone.
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
    /// log2(error / error at half the time step), of the last halving that the reference resolves.
    fn order(&self, errors: &[Timed]) -> Option<String> {
        let resolved = (self.reference / RESOLVED).ilog2() as usize + 1;
        let [.., (_, coarse), (_, fine)] = &errors[..errors.len().min(resolved)] else { return None };
        let of = |value: fn(&Distances) -> f64| short((value(coarse) / value(fine)).log2());
        self.smooth.then(|| format!("{} / {} / {}", of(|e| e.energy), of(|e| e.center), of(|e| e.positions)))
    }
}

/// The settings that differ most from the default, compared with it.
fn against_fast(subject: &Subject, errors_of: &[(String, Vec<Timed>)]) -> Vec<String> {
    let Some((_, fast)) = errors_of.first() else { return Vec::new() };
    let others = errors_of.iter().filter(|(name, _)| {
        ["paper, 1 Newton iteration", "fast, 1, no repulsion", "fast, 4"].contains(&name.as_str())
    });
    let texts = others.map(|(name, errors)| {
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
    texts.collect()
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
            ("center", errors[0].center / errors[1].center),
            ("positions", errors[0].positions / errors[1].positions),
        ] {
            // The reference has an error too: (1/20 - 1/640)/(1/40 - 1/640) = 2.07.
            assert!((1.8..2.4).contains(&ratio), "{what} goes down by {ratio}");
        }
    }
}
