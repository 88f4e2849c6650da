//! The funnel at four time steps (paper, section 7.1, Fig. 19 and the second part of Table 2).

use super::{Figure, Part, Section};
use crate::bench::Bench;
use crate::simulate::{Distances, simulate};
use crate::table::{Table, largest, mean, short};
use anyhow::Result;
use bowknot::Scene;

pub struct Funnel;

impl Figure for Funnel {
    fn name(&self) -> &'static str {
        "funnel"
    }

    fn title(&self) -> &'static str {
        "Fig. 19: the funnel at four time steps"
    }

    fn question(&self) -> &'static str {
        "The paper runs its funnel at 1/20 to 1/160 s with L = 65536: a smaller time step takes fewer steps each, but the larger \
         one is the more efficient for the whole simulation; its steps are 27 (675), 23 (437), 12 (165), 10 (95). The state is \
         that at 0.5 s; its shape is compared with that of the smallest time step. `paper` has 5 s a call."
    }

    fn run(&self, bench: &Bench) -> Result<Section> {
        let scale = 0.2;
        let time = bench.size.pick(0.5, 0.15, 0.1);
        let mut table = Table::new([
            "preset",
            "dt, s",
            "steps a time step",
            "most",
            "collision s a time step",
            "CPU s in all",
            "met",
            "shape off, mm",
            "elastic energy, J",
            "stretch",
            "X",
        ]);
        let mut told = Vec::new();
        for preset in ["fast", "paper"] {
            let mut runs = Vec::new();
            for rate in [20, 40, 80, 160] {
                if !bench.has_time() {
                    break;
                }
                let frames = (time * f64::from(rate) + 0.5) as usize;
                let limit = if preset == "paper" {
                    "solver.stop.max_seconds=5"
                } else {
                    "solver.stop.max_seconds=60"
                };
                let sets = [
                    format!("contact.preset={preset}"),
                    format!("simulation.dt={:?}", 1.0 / f64::from(rate)),
                    "solver.stop.max_steps=65536".to_owned(),
                    limit.to_owned(),
                ];
                let scene = Scene::builtin("funnel", scale)?.with_sets(&sets)?;
                runs.push((rate, simulate(bench, &format!("funnel/{preset}-{rate}"), &scene, frames, 1)?));
            }
            for (rate, done) in &runs {
                let finest = &runs[runs.len() - 1].1;
                let steps: Vec<f64> = done.steps.iter().map(|&s| s as f64).collect();
                table.row([
                    preset.into(),
                    format!("1/{rate}").into(),
                    mean(&steps).into(),
                    largest(&steps).into(),
                    mean(&done.collision).into(),
                    done.cpu_seconds().into(),
                    format!("{} of {}", done.met, steps.len()).into(),
                    (1e3 * Distances::between(done, finest).last).into(),
                    done.samples.last().map_or(f64::NAN, |s| s.elastic).into(),
                    done.max_stretch.into(),
                    done.intersections().into(),
                ]);
            }
            if let (Some((slow, coarse)), Some((fast, fine))) = (runs.first(), runs.last()) {
                let steps = |done: &crate::simulate::Simulation| {
                    mean(&done.steps.iter().map(|&s| s as f64).collect::<Vec<_>>())
                };
                told.push(format!(
                    "`{preset}` takes {} steps at 1/{slow} s and {} at 1/{fast} s, and {} times the CPU time for the whole at 1/{fast} s",
                    short(steps(coarse)),
                    short(steps(fine)),
                    short(fine.cpu_seconds() / coarse.cpu_seconds())
                ));
            }
        }
        Ok(Section {
            finding: format!(
                "{}. (The paper: 27 and 10 steps; 2.7 times the collision time, of 8 times the time steps.)",
                told.join("; ")
            ),
            parts: vec![Part::Table { name: self.name().to_owned(), caption: String::new(), table }],
        })
    }
}
