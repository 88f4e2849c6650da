//! The time of the collision stage by part (paper, section 7.2, Fig. 20).

use crate::bench::Bench;
use crate::figure::{Figure, Part, Report};
use crate::methods::Setting;
use crate::record::PROBLEM_SETS;
use crate::solve::Against;
use crate::summary::{Compared, on_scenes};
use crate::table::{Entry, Table, mean};
use anyhow::Result;

pub struct Breakdown;

impl Figure for Breakdown {
    fn name(&self) -> &'static str {
        "breakdown"
    }

    fn title(&self) -> &'static str {
        "Fig. 20: where the collision stage spends its time"
    }

    fn question(&self) -> &'static str {
        "In the paper's bow knot, the proximity search and the update of Jacobians take almost half of the \
         time. Shares of the wall time of the recorded problems: *search* includes the distances of new \
         pairs; *evaluate*: distances between searches; *backward*: rows, colors and sweeps; *forward*: the \
         step and its certificates."
    }

    fn run(&self, bench: &Bench) -> Result<Report> {
        let scenes: Vec<&'static str> = bench.size.pick(
            PROBLEM_SETS.iter().map(|set| set.name).collect(),
            vec!["needle", "stack", "tube", "reef-knot", "sand", "needle-unaware", "stack-unaware"],
            vec!["needle", "needle-unaware"],
        );
        let settings = [Setting::of("fast")?, Setting::of("paper")?];
        let compared =
            on_scenes(bench, &scenes, bench.size.pick(10, 3, 2), &settings, 1, Against::Residuals)?;
        let mut table = Table::new([
            "scene",
            "preset",
            "search_percent",
            "evaluate_percent",
            "backward_percent",
            "forward_percent",
        ]);
        for c in &compared {
            for summary in &c.summaries {
                let total: f64 = summary.stages.iter().sum();
                let shares = summary.stages.iter().map(|s| Entry::from(100.0 * s / total));
                table.row([Entry::from(c.scene), summary.method.into()].into_iter().chain(shares));
            }
        }
        let share = |method: &str| {
            let share = |c: &Compared| {
                c.find(method, "").map(|s| (s.stages[0] + s.stages[1]) / s.stages.iter().sum::<f64>())
            };
            let shares: Vec<f64> = compared.iter().filter_map(share).collect();
            let knot = compared.iter().find(|c| c.scene.ends_with("knot")).and_then(share);
            let knot = knot.map_or_else(String::new, |s| format!(" ({:.0} % in the knot)", 100.0 * s));
            format!("{:.0} %{knot}", 100.0 * mean(&shares))
        };
        Ok(Report {
            finding: format!(
                "Search and evaluation of pairs take {} of the time of `paper` and {} of `fast`, means over \
                 the scenes. (The paper: almost half, on its GPU.)",
                share("paper"),
                share("fast")
            ),
            parts: vec![Part::table(
                self.name(),
                "shares of the stages in the wall time of the collision stage, by scene and preset",
                table,
            )],
        })
    }
}
