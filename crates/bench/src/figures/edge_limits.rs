//! The effect of edge-length limits (paper, section 4.1.1, Fig. 9).

use crate::bench::Bench;
use crate::figure::{Figure, Part, Report, verdict};
use crate::simulate::simulate;
use crate::table::{Table, largest, mean, short};
use anyhow::Result;
use bowknot::Scene;

pub struct EdgeLimits;

impl Figure for EdgeLimits {
    fn name(&self) -> &'static str {
        "edge-limits"
    }

    fn title(&self) -> &'static str {
        "Fig. 9: with and without edge-length limits"
    }

    fn question(&self) -> &'static str {
        "Without edge-length constraints the backward step cannot keep cloth on a needle from being severely \
         deformed, the paper says. The needle at dt = 1/20 s, with limits and without, up to 5 s per call."
    }

    fn run(&self, bench: &Bench) -> Result<Report> {
        let scale = bench.size.pick(0.4, 0.2, 0.15);
        let frames = bench.size.pick(40, 20, 14);
        let limit = bench.size.pick(5.0, 0.2, 5.0);
        let mut table = Table::new([
            "preset",
            "edge_limits",
            "max_stretch",
            "steps",
            "most_steps",
            "cpu_s",
            "time_steps",
            "met_rule",
            "min_gap_mm",
            "intersections",
        ]);
        let mut texts = Vec::new();
        let mut holds = true;
        for preset in ["fast", "paper"] {
            let mut stretches = Vec::new();
            for edges in [true, false] {
                let sets = [
                    format!("contact.preset={preset}"),
                    format!("contact.edges={edges}"),
                    format!("solver.stop.max_seconds={limit}"),
                ];
                let scene = Scene::builtin("needle", scale)?.with_sets(&sets)?;
                let done = simulate(bench, &format!("edge-limits/{preset}-{edges}"), &scene, frames, 10)?;
                let steps: Vec<f64> = done.steps.iter().map(|&s| s as f64).collect();
                stretches.push(done.max_stretch);
                table.row([
                    preset.into(),
                    if edges { "yes".into() } else { "no".into() },
                    done.max_stretch.into(),
                    mean(&steps).into(),
                    largest(&steps).into(),
                    done.cpu_seconds().into(),
                    steps.len().into(),
                    done.met.into(),
                    (1e3 * done.min_gap.unwrap_or(f64::NAN)).into(),
                    done.intersections().into(),
                ]);
            }
            holds &= stretches[1] > stretches[0];
            texts.push(format!(
                "`{preset}` stretches edges to {} times their rest length at most, and to {} without limits",
                short(stretches[0]),
                short(stretches[1])
            ));
        }
        Ok(Report {
            finding: format!("{}: {}.", verdict(holds), texts.join("; ")),
            parts: vec![Part::table(
                self.name(),
                "the needle with and without edge limits, by preset",
                table,
            )],
        })
    }
}
