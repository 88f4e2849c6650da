//! The log-barrier interior point method, and its strength k (paper, section 3.4, Fig. 5 and 6).

use super::{Figure, Part, Section, verdict};
use crate::bench::Bench;
use crate::chart::{Axis, Chart};
use crate::methods::{Setting, log_barrier};
use crate::solve::Against;
use crate::summary::{COLUMNS, lines, on_scenes, ratios, table};
use crate::table::{geometric_mean, times};
use anyhow::Result;
use bowknot_baselines::barrier::BarrierParams;

pub struct Barrier;

/// Strengths [kg/s^2]; the paper's is 20, which is the method as it is.
const STRENGTHS: [f64; 5] = [0.2, 2.0, 20.0, 200.0, 2000.0];

impl Figure for Barrier {
    fn name(&self) -> &'static str {
        "barrier"
    }

    fn title(&self) -> &'static str {
        "Fig. 5 and 6: against a log barrier, k swept"
    }

    fn question(&self) -> &'static str {
        "The paper's two-way method takes considerably fewer steps than gradient descent on Eq. 7-8 and is some five times \
         faster on its bow knot (Fig. 5), and the barrier needs a suitable strength k (Fig. 6). Same search, same bounds on \
         steps; the barrier has no edge limits and the objective of Eq. 7 with masses, 1/2 sum m/dt^2 |x - y|^2. Targets of a \
         dynamics that is blind to contact, as the paper's, and two of Bowknot's."
    }

    fn run(&self, bench: &Bench) -> Result<Section> {
        let scenes: &[&'static str] = bench.size.pick(
            &[
                "bow-knot-blind",
                "reef-knot-blind",
                "needle-blind",
                "stack-blind",
                "tube-blind",
                "bow-knot",
                "needle",
            ][..],
            &["needle-blind", "tube"],
            &["needle-blind"],
        );
        let mut settings = vec![Setting::of("fast")?, Setting::of("paper")?];
        let mut values = Vec::new();
        for strength in STRENGTHS {
            let plain = Setting::of("log barrier")?;
            let setting = match strength == BarrierParams::default().strength {
                true => plain,
                false => plain.built(format!("k = {strength}"), move |problem| {
                    log_barrier(problem, BarrierParams { strength, ..BarrierParams::default() })
                }),
            };
            values.push((strength, setting.method, setting.change.clone()));
            settings.push(setting);
        }
        let compared = on_scenes(bench, scenes, bench.size.pick(2, 1, 1), &settings, 1, Against::Exact)?;
        let chart = |title: &str, y: &str, series| Chart {
            title: title.to_owned(),
            x: Axis::log("barrier strength k [kg/s^2]"),
            y: Axis::log(y),
            series,
            front: false,
        };
        let seconds = lines(&compared, &values, |s, _| s.cpu);
        let error = lines(&compared, &values, |s, exact| 1e3 * s.error(exact));
        let barrier = ("log barrier", "");
        let over = |method: &'static str| {
            let cpu = ratios(&compared, barrier, (method, ""), |s, _| s.cpu);
            let steps = ratios(&compared, barrier, (method, ""), |s, _| s.steps);
            let error = ratios(&compared, barrier, (method, ""), |s, exact| s.error(exact));
            format!(
                "{} the CPU time, {} the steps and {} the error of `{method}`",
                times(geometric_mean(&cpu)),
                times(geometric_mean(&steps)),
                times(geometric_mean(&error))
            )
        };
        Ok(Section {
            finding: format!(
                "{}: with k = 20 the barrier takes {}, and {}. (The paper: 5x the time.)",
                verdict(geometric_mean(&ratios(&compared, barrier, ("paper", ""), |s, _| s.cpu)) > 1.0),
                over("paper"),
                over("fast")
            ),
            parts: vec![
                Part::Table {
                    name: self.name().to_owned(),
                    caption: COLUMNS.to_owned(),
                    table: table(&compared, |_| true),
                },
                Part::Chart {
                    name: "barrier-seconds".to_owned(),
                    chart: chart("log barrier: run time", "CPU seconds a problem", seconds),
                },
                Part::Chart {
                    name: "barrier-error".to_owned(),
                    chart: chart("log barrier: error", "error [mm]", error),
                },
            ],
        })
    }
}
