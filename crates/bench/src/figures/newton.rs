//! Newton iterations, and when collisions are handled (paper, section 6.1, Fig. 17).

use crate::bench::Bench;
use crate::figure::{Figure, Part, Report};
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
        "The paper's needle at dt = 1/20 s. The paper says that more Newton iterations make the dynamics \
         more accurate, that collisions are handled safely with any number of them, and that handling \
         collisions after each iteration is more plausible than once per time step (section 6.1). Measured \
         here: intersections of ten states per run, stretch, elastic energy and gap. Whether a result is \
         plausible is not tested. A call of `paper` ends after 1 s even if its rule is not met."
    }

    fn run(&self, bench: &Bench) -> Result<Report> {
        let scale = bench.size.pick(0.4, 0.2, 0.15);
        let frames = bench.size.pick(40, 20, 14);
        let mut table = Table::new([
            "preset",
            "newton_iterations",
            "collisions",
            "steps",
            "most_steps",
            "cpu_s",
            "max_stretch",
            "end_elastic_energy_j",
            "min_gap_mm",
            "intersections",
        ]);
        let (mut intersections, mut runs) = (0, 0);
        let mut ends = Vec::new();
        let mut stretches = Vec::new();
        for preset in ["fast", "paper"] {
            let mut stretch = 0.0f64;
            for newton in bench.size.pick(&[1, 2, 4, 8][..], &[1, 4], &[1, 2]) {
                for every in ["newton", "step"] {
                    // With one iteration both are the same.
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
                    stretch = stretch.max(done.max_stretch);
                    if preset == "fast" && every == "newton" {
                        ends.push((*newton, done.cpu_seconds()));
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
            stretches.push((preset, stretch));
        }
        let ratio = match (ends.first(), ends.last()) {
            (Some(one), Some(most)) if ends.len() > 1 => format!(
                " With `fast`, {} iterations take {:.1} times the CPU time of one.",
                most.0,
                most.1 / one.1
            ),
            _ => String::new(),
        };
        let stretches: Vec<String> =
            stretches.iter().map(|(preset, stretch)| format!("{stretch:.2} with `{preset}`")).collect();
        Ok(Report {
            finding: format!(
                "{intersections} intersections in ten states of each of {runs} runs; nothing else of the \
                 paper's finding is tested. Edges stretch up to {} times their rest length.{ratio}",
                stretches.join(" and ")
            ),
            parts: vec![Part::table(
                self.name(),
                "the needle by Newton iterations, collisions handled after each or once per time step",
                table,
            )],
        })
    }
}
