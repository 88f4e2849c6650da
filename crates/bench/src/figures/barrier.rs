//! The log-barrier interior point method, and its strength k (paper, section 3.4, Fig. 5 and 6).

use crate::bench::Bench;
use crate::chart::{Axis, Chart};
use crate::figure::{Figure, Part, Report, verdict};
use crate::methods::{Setting, ipc, log_barrier};
use crate::solve::Against;
use crate::summary::{lines, on_scenes, ratios, table};
use crate::table::{geometric_mean, times};
use anyhow::Result;
use bowknot_baselines::barrier::{BarrierParams, LinearSolver};

pub struct Barrier;

/// Strengths [kg/s^2]; 20 is the paper's and the default.
const STRENGTHS: [f64; 5] = [0.2, 2.0, 20.0, 200.0, 2000.0];
/// IPC with another linear solver.
const ITERATED: &str = "conjugate gradients";

impl Figure for Barrier {
    fn name(&self) -> &'static str {
        "barrier"
    }

    fn title(&self) -> &'static str {
        "Fig. 5 and 6: against a log barrier, k swept"
    }

    fn question(&self) -> &'static str {
        "The paper's two-way method takes considerably fewer steps than gradient descent on Eq. 7-8 and is \
         some five times faster on its bow knot (Fig. 5), and the barrier needs a suitable strength k (Fig. \
         6). Same search, same bounds on steps; the barrier has no edge limits, the objective of Eq. 7 with \
         masses, 1/2 sum m/dt^2 |x - y|^2, and stops at 0.01 mean edge lengths, as `fast`. IPC (Li et al. \
         2020) minimizes by Newton's method: as published with a factorization, with conjugate gradients, \
         with the range of its paper, and with Eq. 8 and k = 20 in place of its barrier. Five scenes with \
         contact-unaware targets, two with contact-aware ones."
    }

    fn run(&self, bench: &Bench) -> Result<Report> {
        let scenes: &[&'static str] = bench.size.pick(
            &[
                "bow-knot-unaware",
                "reef-knot-unaware",
                "needle-unaware",
                "stack-unaware",
                "tube-unaware",
                "bow-knot",
                "needle",
            ][..],
            &["needle-unaware", "tube"],
            &["needle-unaware"],
        );
        let iterated = LinearSolver::ConjugateGradients;
        let mut settings = vec![
            Setting::of("fast")?,
            Setting::of("paper")?,
            Setting::of("IPC")?,
            Setting::of("IPC")?.built(ITERATED, move |scene| {
                ipc(scene, BarrierParams { linear_solver: iterated, ..BarrierParams::ipc() })
            }),
            Setting::of("IPC, own range")?,
            Setting::of("IPC")?.built("Eq. 8", move |scene| ipc(scene, BarrierParams::default())),
        ];
        let mut values = Vec::new();
        for strength in STRENGTHS {
            let plain = Setting::of("log barrier")?;
            let setting = if strength == BarrierParams::default().strength {
                plain
            } else {
                plain.built(format!("k = {strength}"), move |scene| {
                    log_barrier(scene, BarrierParams { strength, ..BarrierParams::default() })
                })
            };
            values.push((strength, setting.method, setting.change.clone()));
            settings.push(setting);
        }
        let compared = on_scenes(bench, scenes, bench.size.pick(2, 1, 1), &settings, 1, Against::Reference)?;
        let chart = |title: &str, y: &str, series| Chart {
            title: title.to_owned(),
            x: Axis::log("barrier strength k [kg/s^2]"),
            y: Axis::log(y),
            series,
            front: false,
        };
        let seconds = lines(&compared, &values, |s, _| s.cpu);
        let error = lines(&compared, &values, |s, referenced| 1e3 * s.error(referenced));
        let barrier = ("log barrier", "");
        let over = |method: &'static str| {
            let cpu = ratios(&compared, barrier, (method, ""), |s, _| s.cpu);
            let steps = ratios(&compared, barrier, (method, ""), |s, _| s.steps);
            let error = ratios(&compared, barrier, (method, ""), |s, referenced| s.error(referenced));
            format!(
                "{} the CPU time, {} the steps and {} the error of `{method}`",
                times(geometric_mean(&cpu)),
                times(geometric_mean(&steps)),
                times(geometric_mean(&error))
            )
        };
        let newton = |change: &str| {
            let [cpu, steps] = [
                ratios(&compared, ("IPC", change), ("IPC", ""), |s, _| s.cpu),
                ratios(&compared, ("IPC", change), ("IPC", ""), |s, _| s.steps),
            ];
            format!(
                "{} the CPU time and {} the steps",
                times(geometric_mean(&cpu)),
                times(geometric_mean(&steps))
            )
        };
        Ok(Report {
            finding: format!(
                "{}: with k = 20 the barrier takes {}, and {}. (The paper: 5x the time.) IPC takes {} with \
                 conjugate gradients, and {} with Eq. 8.",
                verdict(geometric_mean(&ratios(&compared, barrier, ("paper", ""), |s, _| s.cpu)) > 1.0),
                over("paper"),
                over("fast"),
                newton(ITERATED),
                newton("Eq. 8")
            ),
            parts: vec![
                Part::table(
                    self.name(),
                    "a log barrier of strengths k and IPC against `fast` and `paper`: time, error, steps",
                    table(&compared, |_| true),
                ),
                Part::Chart {
                    name: "barrier-seconds".to_owned(),
                    chart: chart("log barrier: run time", "CPU seconds per problem", seconds),
                },
                Part::Chart {
                    name: "barrier-error".to_owned(),
                    chart: chart("log barrier: error", "error [mm]", error),
                },
            ],
        })
    }
}
