//! Step sizes by distances against continuous collision detection (paper, section 5.1, Fig. 16).

use crate::bench::Bench;
use crate::figure::{Figure, Part, Report, verdict};
use crate::methods::Setting;
use crate::solve::Against;
use crate::summary::{Compared, on_scenes, ratios, table};
use crate::table::{Entry, Table, geometric_mean, times};
use anyhow::Result;

pub struct StepSizes;

/// Scenes at 1/20 s; the others are at 1/100 s.
const SLOW: [&str; 3] = ["needle-unaware", "funnel-unaware", "stack-unaware-20"];

impl Figure for StepSizes {
    fn name(&self) -> &'static str {
        "step-sizes"
    }

    fn title(&self) -> &'static str {
        "Fig. 16: step sizes by distances against CCD"
    }

    fn question(&self) -> &'static str {
        "In the paper, step sizes without CCD are five times faster at 1/100 s and seven times at 1/20 s, \
         for 10 to 20 % more steps. Here `paper` runs with its own bound on steps, and with conservative \
         additive CCD (Li et al. 2021): all vertices by the earliest impact, as in IPC, or each vertex by \
         its own. CCD searches once per step, along the paths. (The bound of offset geometric contact, Chen et al. 2025, used by the trust region of \
         ipctk and by NVIDIA Newton, is that of `paper`: `bound = \"isotropic\"`.) Contact-unaware targets; \
         needle and stack at both time steps. Wall seconds per problem: *broad*: searches, also those of \
         CCD along paths; *narrow*: distances, and CCD tests in the forward step."
    }

    fn run(&self, bench: &Bench) -> Result<Report> {
        let scenes: &[&'static str] = bench.size.pick(
            &[
                "bow-knot-unaware",
                "reef-knot-unaware",
                "stack-unaware",
                "tube-unaware",
                "needle-unaware-100",
                "stack-unaware-20",
                "needle-unaware",
                "funnel-unaware",
            ][..],
            &["stack-unaware", "needle-unaware"],
            &["needle-unaware"],
        );
        let methods = ["paper", "CCD, earliest", "CCD, per vertex", "fast"];
        let settings = methods.iter().map(|m| Setting::of(m)).collect::<Result<Vec<_>>>()?;
        let compared = on_scenes(bench, scenes, bench.size.pick(3, 1, 1), &settings, 1, Against::Residuals)?;
        let mut stages =
            Table::new(["scene", "method", "broad_s", "narrow_s", "backward_s", "steps", "cpu_s"]);
        for c in &compared {
            for s in &c.summaries {
                let [search, evaluate, backward, forward] = s.stages;
                let times = [search, evaluate + forward, backward].map(Entry::from);
                let ends = [Entry::from(s.steps), Entry::from(s.cpu)];
                stages.row([Entry::from(c.scene), s.name().into()].into_iter().chain(times).chain(ends));
            }
        }
        let (slow, fast): (Vec<Compared>, Vec<Compared>) =
            compared.iter().cloned().partition(|c| SLOW.contains(&c.scene));
        let over = |compared: &[Compared], method: &str| {
            let mean = |value: &dyn Fn(&crate::summary::Summary) -> f64| {
                let ratios = ratios(compared, (method, ""), ("paper", ""), |s, _| value(s));
                if ratios.is_empty() { "-".to_owned() } else { times(geometric_mean(&ratios)) }
            };
            // The backward step is the same and left out.
            let bound = mean(&|s| s.stages[0] + s.stages[1] + s.stages[3]);
            format!(
                "{bound} the time of search and bounds, {} the steps and {} the CPU time",
                mean(&|s| s.steps),
                mean(&|s| s.cpu)
            )
        };
        let bounding = |s: &crate::summary::Summary, _| s.stages[0] + s.stages[1] + s.stages[3];
        let all_above = |value: &dyn Fn(&crate::summary::Summary, bool) -> f64| {
            ["CCD, earliest", "CCD, per vertex"]
                .iter()
                .all(|method| geometric_mean(&ratios(&compared, (method, ""), ("paper", ""), value)) > 1.0)
        };
        let (dearer, slower) = (all_above(&bounding), all_above(&|s, _| s.cpu));
        let why = match (dearer, slower) {
            (true, false) => {
                " Bounding a step by CCD costs more, but steps are longer, so that the total costs less."
            }
            _ => "",
        };
        Ok(Report {
            finding: format!(
                "{} for the total time.{why} As multiples of `paper`, CCD by the earliest impact takes {} at \
                 1/100 s and {} at 1/20 s; per vertex it takes {} and {}. (The paper: 5x and 7x the time of \
                 bounding steps.)",
                verdict(dearer && slower),
                over(&fast, "CCD, earliest"),
                over(&slow, "CCD, earliest"),
                over(&fast, "CCD, per vertex"),
                over(&slow, "CCD, per vertex"),
            ),
            parts: vec![
                Part::table(
                    "step-sizes-stages",
                    "`paper` with its own bound and with CCD: wall seconds by stage",
                    stages,
                ),
                Part::table(
                    self.name(),
                    "`fast`, and `paper` with its own bound and with CCD: time, residuals, steps",
                    table(&compared, |_| true),
                ),
            ],
        })
    }
}
