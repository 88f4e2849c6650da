//! The funnel at four time steps (paper, section 7.1, Fig. 19 and the second part of Table 2).

use crate::bench::Bench;
use crate::figure::{Figure, Part, Report};
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
        "The paper runs its funnel with time steps of 1/20 to 1/160 s and L = 65536. A smaller time step \
         takes fewer steps (mean and largest number: 27 and 675, 23 and 437, 12 and 165, 10 and 95), but the \
         largest time step is the most efficient for the whole simulation. Here the shape at 0.5 s is \
         compared with that of the smallest time step. `paper` has 5 s per call."
    }

    fn run(&self, bench: &Bench) -> Result<Report> {
        let scale = 0.2;
        let time = bench.size.pick(0.5, 0.15, 0.1);
        let mut table = Table::new([
            "preset",
            "dt_s",
            "steps",
            "most_steps",
            "collision_s",
            "cpu_s",
            "time_steps",
            "met_rule",
            "shape_distance_mm",
            "elastic_energy_j",
            "max_stretch",
            "intersections",
        ]);
        let mut texts = Vec::new();
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
                    steps.len().into(),
                    done.met.into(),
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
                texts.push(format!(
                    "`{preset}` takes {} steps at 1/{slow} s and {} at 1/{fast} s, and {} times the CPU \
                     time in total at 1/{fast} s",
                    short(steps(coarse)),
                    short(steps(fine)),
                    short(fine.cpu_seconds() / coarse.cpu_seconds())
                ));
            }
        }
        Ok(Report {
            finding: format!(
                "{}. (The paper: 27 and 10 steps; 2.7 times the collision time, of 8 times the time steps.)",
                texts.join("; ")
            ),
            parts: vec![Part::table(
                self.name(),
                "the funnel at four time steps: steps, times, distance of the shape at 0.5 s from that at \
                 1/160 s",
                table,
            )],
        })
    }
}
