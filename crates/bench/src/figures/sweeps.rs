//! Gauss-Seidel sweeps per backward step (paper, section 4.2.1, Fig. 10).

use super::{Figure, Part, Section, verdict};
use crate::bench::Bench;
use crate::chart::{Axis, Chart};
use crate::methods::Setting;
use crate::solve::Against;
use crate::summary::{COLUMNS, lines, on_scenes, table};
use anyhow::Result;

pub struct Sweeps;

/// Sweeps of either preset; 1 is `paper` as it is, 8 `fast` as it is.
const SWEEPS: [usize; 6] = [1, 2, 4, 8, 16, 32];

impl Figure for Sweeps {
    fn name(&self) -> &'static str {
        "sweeps"
    }

    fn title(&self) -> &'static str {
        "Fig. 10: Gauss-Seidel sweeps per backward step"
    }

    fn question(&self) -> &'static str {
        "The paper finds one sweep per backward step the most efficient: more do not necessarily save steps. Either preset, \
         with 1 to 32 sweeps, on targets of a dynamics that is blind to contact, as the paper's, and of Bowknot's."
    }

    fn run(&self, bench: &Bench) -> Result<Section> {
        let scenes: &[&'static str] = bench.size.pick(
            &[
                "bow-knot-blind",
                "reef-knot-blind",
                "needle-blind",
                "stack-blind",
                "bow-knot",
                "reef-knot",
                "needle",
                "stack",
            ][..],
            &["stack-blind", "tube"],
            &["needle-blind"],
        );
        let mut settings = Vec::new();
        let mut values: [Vec<(f64, &str, String)>; 2] = Default::default();
        for (method, values) in ["paper", "fast"].iter().zip(&mut values) {
            for sweeps in SWEEPS {
                let plain = Setting::of(method)?;
                let setting = match plain.params.solver.backward.sweeps == sweeps {
                    true => plain,
                    false => plain.with(format!("{sweeps} sweeps"), |p| {
                        p.solver.backward.sweeps = sweeps;
                        p.solver.backward.polish_sweeps = p.solver.backward.polish_sweeps.max(sweeps);
                    }),
                };
                values.push((sweeps as f64, setting.method, setting.change.clone()));
                settings.push(setting);
            }
        }
        let compared = on_scenes(bench, scenes, bench.size.pick(2, 1, 1), &settings, 1, Against::Exact)?;
        let mut section = Section::default();
        let mut best = Vec::new();
        // In every scene, for the paper's own method.
        let mut holds = true;
        for (method, values) in ["paper", "fast"].iter().zip(&values) {
            for (what, word, series) in [
                ("CPU seconds a problem", "seconds", lines(&compared, values, |s, _| s.cpu)),
                ("steps", "steps", lines(&compared, values, |s, _| s.steps)),
                ("error [mm]", "error", lines(&compared, values, |s, exact| 1e3 * s.error(exact))),
            ] {
                let chart = Chart {
                    title: format!("{method}: {what} by sweeps"),
                    x: Axis::log("sweeps per backward step"),
                    y: Axis::log(what),
                    series,
                    front: false,
                };
                section.parts.push(Part::Chart { name: format!("sweeps-{method}-{word}"), chart });
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
        section.finding = format!("{}: {}. (The paper: 1.)", verdict(holds), best.join("; "));
        section.parts.push(Part::Table {
            name: self.name().to_owned(),
            caption: COLUMNS.to_owned(),
            table: table(&compared, |_| true),
        });
        Ok(section)
    }
}
