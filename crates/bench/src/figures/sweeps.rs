//! Gauss-Seidel sweeps per backward step (paper, section 4.2.1, Fig. 10).

use crate::bench::Bench;
use crate::chart::{Axis, Chart};
use crate::figure::{Figure, Part, Report, verdict};
use crate::methods::Setting;
use crate::solve::Against;
use crate::summary::{lines, on_scenes, table};
use anyhow::Result;

pub struct Sweeps;

/// Numbers of sweeps; 1 is the default of `paper`, 8 that of `fast`.
const SWEEPS: [usize; 6] = [1, 2, 4, 8, 16, 32];

impl Figure for Sweeps {
    fn name(&self) -> &'static str {
        "sweeps"
    }

    fn title(&self) -> &'static str {
        "Fig. 10: Gauss-Seidel sweeps per backward step"
    }

    fn question(&self) -> &'static str {
        "The paper finds one sweep per backward step most efficient: more sweeps do not necessarily save \
         steps. Either preset with 1 to 32 sweeps, on contact-unaware and contact-aware targets."
    }

    fn run(&self, bench: &Bench) -> Result<Report> {
        let scenes: &[&'static str] = bench.size.pick(
            &[
                "bow-knot-unaware",
                "reef-knot-unaware",
                "needle-unaware",
                "stack-unaware",
                "bow-knot",
                "reef-knot",
                "needle",
                "stack",
            ][..],
            &["stack-unaware", "tube"],
            &["needle-unaware"],
        );
        let mut settings = Vec::new();
        let mut values: [Vec<(f64, &str, String)>; 2] = Default::default();
        for (method, values) in ["paper", "fast"].iter().zip(&mut values) {
            for sweeps in SWEEPS {
                let plain = Setting::of(method)?;
                let setting = if plain.params.solver.backward.sweeps == sweeps {
                    plain
                } else {
                    plain.with(format!("{sweeps} sweeps"), |p| {
                        p.solver.backward.sweeps = sweeps;
                        p.solver.backward.polish_sweeps = p.solver.backward.polish_sweeps.max(sweeps);
                    })
                };
                values.push((sweeps as f64, setting.method, setting.change.clone()));
                settings.push(setting);
            }
        }
        let compared = on_scenes(bench, scenes, bench.size.pick(2, 1, 1), &settings, 1, Against::Reference)?;
        let mut report = Report::default();
        let mut best = Vec::new();
        // Whether `paper` is fastest with one sweep in every scene.
        let mut holds = true;
        for (method, values) in ["paper", "fast"].iter().zip(&values) {
            for (what, word, series) in [
                ("CPU seconds per problem", "seconds", lines(&compared, values, |s, _| s.cpu)),
                ("steps", "steps", lines(&compared, values, |s, _| s.steps)),
                ("error [mm]", "error", lines(&compared, values, |s, referenced| 1e3 * s.error(referenced))),
            ] {
                let chart = Chart {
                    title: format!("{method}: {what} by sweeps"),
                    x: Axis::log("sweeps per backward step"),
                    y: Axis::log(what),
                    series,
                    front: false,
                };
                report.parts.push(Part::Chart { name: format!("sweeps-{method}-{word}"), chart });
            }
            let fastest: Vec<String> = compared
                .iter()
                .filter_map(|c| {
                    let all = values.iter().filter_map(|(n, m, change)| Some((*n, c.find(m, change)?.cpu)));
                    let (sweeps, _) = all.min_by(|a, b| a.1.total_cmp(&b.1))?;
                    holds &= *method != "paper" || sweeps == 1.0;
                    Some(format!("{sweeps} ({})", c.scene))
                })
                .collect();
            best.push(format!("`{method}` is fastest with {} sweeps", fastest.join(", ")));
        }
        report.finding = format!("{}: {}. (The paper: 1.)", verdict(holds), best.join("; "));
        report.parts.push(Part::table(
            self.name(),
            "`fast` and `paper` with 1 to 32 sweeps: time, error, steps",
            table(&compared, |_| true),
        ));
        Ok(report)
    }
}
