//! Newton iterations, and when collisions are handled (paper, section 6.1, Fig. 17).

use super::{Figure, Part, Section, verdict};
use crate::bench::Bench;
use crate::simulate::simulate;
use crate::table::{Table, largest, mean};
use anyhow::Result;
use bowknot::Scene;

pub struct Newton;

impl Figure for Newton {
    fn name(&self) -> &'static str {
        "newton"
    }

    fn title(&self) -> &'static str {
        "Fig. 17: Newton iterations, collisions after each or once"
    }

    fn question(&self) -> &'static str {
        "The paper's needle at dt = 1/20 s: more Newton iterations give more accurate dynamics, collisions are safe with any, and \
         handling them after each iteration is more plausible than once per time step (section 6.1). A call of `paper` ends after 1 s, \
         wherever it is. *X*: intersections of ten states."
    }

    fn run(&self, bench: &Bench) -> Result<Section> {
        let scale = bench.size.pick(0.4, 0.2, 0.15);
        let frames = bench.size.pick(40, 20, 14);
        let mut table = Table::new([
            "preset",
            "Newton iterations",
            "collisions",
            "steps a time step",
            "most",
            "CPU s",
            "stretch",
            "elastic energy at the end, J",
            "gap, mm",
            "X",
        ]);
        let (mut intersections, mut runs) = (0, 0);
        let mut ends = Vec::new();
        for preset in ["fast", "paper"] {
            for newton in bench.size.pick(&[1, 2, 4, 8][..], &[1, 4], &[1, 2]) {
                for every in ["newton", "step"] {
                    // One iteration makes no difference; `paper` once is left to the others.
                    if every == "step" && *newton == 1 || !bench.has_time() {
                        continue;
                    }
                    let sets = [
                        format!("contact.preset={preset}"),
                        format!("simulation.newton_iterations={newton}"),
                        "solver.newton.step_tolerance=0".to_owned(),
                        format!("simulation.collision_every={every}"),
                        "solver.stop.max_seconds=1".to_owned(),
                    ];
                    let scene = Scene::builtin("needle", scale)?.with_sets(&sets)?;
                    let key = format!("newton/{preset}-{newton}-{every}");
                    let done = simulate(bench, &key, &scene, frames, 10)?;
                    let steps: Vec<f64> = done.steps.iter().map(|&s| s as f64).collect();
                    let elastic = done.samples.last().map_or(f64::NAN, |s| s.elastic);
                    intersections += done.intersections();
                    runs += 1;
                    if preset == "fast" && every == "newton" {
                        ends.push((*newton, done.cpu_seconds(), done.max_stretch));
                    }
                    table.row([
                        preset.into(),
                        newton.to_string().into(),
                        if every == "newton" { "after each".into() } else { "once".into() },
                        mean(&steps).into(),
                        largest(&steps).into(),
                        done.cpu_seconds().into(),
                        done.max_stretch.into(),
                        elastic.into(),
                        (1e3 * done.min_gap.unwrap_or(f64::NAN)).into(),
                        done.intersections().into(),
                    ]);
                }
            }
        }
        let told = match (ends.first(), ends.last()) {
            (Some(one), Some(most)) if ends.len() > 1 => format!(
                " {} iterations take {:.1} times the CPU time of one and end with a largest stretch of {:.2} against {:.2}.",
                most.0,
                most.1 / one.1,
                most.2,
                one.2
            ),
            _ => String::new(),
        };
        Ok(Section {
            finding: format!(
                "{}, safe with any number of iterations: {intersections} intersections in ten states of each of {runs} runs.{told}",
                verdict(intersections == 0)
            ),
            parts: vec![Part::Table { name: self.name().to_owned(), caption: String::new(), table }],
        })
    }
}
