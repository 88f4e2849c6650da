//! Newton iterations, and when collisions are handled (paper, section 6.1, Fig. 17).

use crate::bench::Bench;
use crate::figure::{Figure, Part, Report, verdict};
use crate::simulate::simulate;
use crate::table::{Table, largest, mean, short};
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
         collisions after each iteration is more plausible than once per time step (section 6.1). Four things \
         are tested: no intersection in ten states per run; the elastic energy at the end comes nearer to \
         that of the run with most iterations, collisions after each; edges are stretched no further with \
         most iterations than with one; and with as many iterations, handling collisions once stretches edges \
         further or ends farther from that energy. A call of `paper` ends after 1 s even if its rule is not \
         met."
    }

    fn run(&self, bench: &Bench) -> Result<Report> {
        let scale = bench.size.pick(0.4, 0.2, 0.15);
        let frames = bench.size.pick(40, 20, 14);
        let limit = bench.size.pick(1.0, 0.2, 1.0);
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
        let mut tests = Vec::new();
        for preset in ["fast", "paper"] {
            let mut kept = Vec::new();
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
                        format!("solver.stop.max_seconds={limit}"),
                    ];
                    let scene = Scene::builtin("needle", scale)?.with_sets(&sets)?;
                    let key = format!("newton/{preset}-{newton}-{every}");
                    let done = simulate(bench, &key, &scene, frames, 10)?;
                    let steps: Vec<f64> = done.steps.iter().map(|&s| s as f64).collect();
                    let elastic = done.samples.last().map_or(f64::NAN, |s| s.elastic);
                    intersections += done.intersections();
                    runs += 1;
                    kept.push(End { newton: *newton, every, stretch: done.max_stretch, elastic });
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
            tests.extend(tested(preset, &kept));
        }
        let ratio = match (ends.first(), ends.last()) {
            (Some(one), Some(most)) if ends.len() > 1 => format!(
                " With `fast`, {} iterations take {:.1} times the CPU time of one.",
                most.0,
                most.1 / one.1
            ),
            _ => String::new(),
        };
        let holds = intersections == 0 && tests.iter().all(|(_, holds)| *holds);
        let texts: Vec<&str> = tests.iter().map(|(text, _)| text.as_str()).collect();
        Ok(Report {
            finding: format!(
                "{}: {intersections} intersections in ten states of each of {runs} runs. {}.{ratio}",
                verdict(holds),
                texts.join(". ")
            ),
            parts: vec![Part::table(
                self.name(),
                "the needle by Newton iterations, collisions handled after each or once per time step",
                table,
            )],
        })
    }
}

/// Elastic energies that differ by a smaller share count as equal.
const ENERGY_SHARE: f64 = 0.01;

/// How a run ended.
struct End {
    newton: usize,
    every: &'static str,
    /// Largest stretch of an edge during the run.
    stretch: f64,
    /// Elastic energy at the end [J].
    elastic: f64,
}

/// What the runs with a preset show of stretch and energy, and whether it is what the paper says.
fn tested(preset: &str, ends: &[End]) -> Option<(String, bool)> {
    let mut each = ends.iter().filter(|end| end.every == "newton");
    let one = each.next()?;
    let most = each.next_back()?;
    let once = ends.iter().rfind(|end| end.every == "step" && end.newton == most.newton)?;
    let off = |end: &End| (end.elastic - most.elastic).abs();
    // The runs between: nearer with more iterations.
    let between: Vec<f64> = ends.iter().filter(|end| end.every == "newton").map(off).collect();
    let nearer = between.windows(2).all(|two| two[1] <= two[0]);
    let tighter = most.stretch <= one.stretch;
    let plainer = once.stretch > most.stretch || off(once) > ENERGY_SHARE * most.elastic;
    let text = format!(
        "`{preset}`: edges stretch up to {:.2} times their rest length with one iteration, {:.2} with {}, and \
         {:.2} with collisions once; the elastic energy at the end is {}, {} and {} J, {} with more \
         iterations",
        one.stretch,
        most.stretch,
        most.newton,
        once.stretch,
        short(one.elastic),
        short(most.elastic),
        short(once.elastic),
        if nearer { "nearer to the last" } else { "not always nearer to the last" },
    );
    Some((text, nearer && tighter && plainer))
}
