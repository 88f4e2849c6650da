//! Other solvers of the backward step's rows (paper, sections 4.2.2 and 4.3, Fig. 11 to 15).

use crate::bench::Bench;
use crate::figure::{Figure, Part, Report, verdict};
use crate::methods::{Setting, rows};
use crate::solve::Against;
use crate::summary::{on_scenes, ratios, table};
use crate::table::{geometric_mean, times};
use anyhow::Result;
use bowknot_baselines::rows::ProjectedJacobi;

pub struct RowSolvers;

/// The solvers that the paper compares with one sweep of projected Gauss-Seidel.
const OTHERS: [&str; 7] = [
    "Harmon 2008",
    "Harmon, projected",
    "Tang 2018, 20",
    "Tang 2018, 100",
    "Tang, steps by vertex, 100",
    "Jacobi",
    "Jacobi, Chebyshev",
];

/// What differs from another solver by that solver alone.
fn base_of(method: &str) -> (&'static str, &'static str) {
    if method.starts_with("Harmon") { ("paper, active rows", NO_EDGES) } else { ("paper", "") }
}

const NO_EDGES: &str = "no edge limits";

impl Figure for RowSolvers {
    fn name(&self) -> &'static str {
        "row-solvers"
    }

    fn title(&self) -> &'static str {
        "Fig. 11 to 15: other solvers of the backward step's rows"
    }

    fn question(&self) -> &'static str {
        "`paper` with another solver in place of one sweep of projected Gauss-Seidel: projected Jacobi, also \
         with Chebyshev weights between steps (Fig. 11) and with up to 800 sweeps (Fig. 12); the linear \
         system without lambda >= 0 of Harmon et al. 2008, 20 sweeps and no edge limits, and with the \
         one-line projection (Fig. 13, 14); the augmented Lagrangian of Tang et al. 2018 by gradient \
         descent, 20 and 100 iterations (Fig. 15), as published and with a step length per vertex. Each is \
         compared with `paper` with the same rows and limits: the linear system has active rows only. With \
         edge limits the linear system makes edges rigid \
         (Fig. 14). Five scenes with contact-unaware targets, two with contact-aware ones."
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
                "stack",
            ][..],
            &["stack-unaware"],
            &["needle-unaware"],
        );
        let mut settings = vec![
            Setting::of("paper")?,
            Setting::of("paper, active rows")?.with(NO_EDGES, |p| p.contact.edges = false),
            Setting::of("paper, active rows")?,
        ];
        for method in OTHERS {
            settings.push(Setting::of(method)?);
        }
        settings.push(Setting::of("Harmon 2008")?.with("edge limits", |p| p.contact.edges = true));
        for sweeps in bench.size.pick(&[8, 80, 800][..], &[8], &[8]) {
            let sweeps = *sweeps;
            settings.push(
                Setting::of("Jacobi")?
                    .built(format!("{sweeps} sweeps"), move |p| rows(p, ProjectedJacobi::new(sweeps, 0.0))),
            );
        }
        let compared = on_scenes(bench, scenes, bench.size.pick(2, 1, 1), &settings, 1, Against::Reference)?;
        let mut holds = true;
        let texts: Vec<String> = OTHERS
            .iter()
            .filter_map(|method| {
                let base = base_of(method);
                let of = |value: &dyn Fn(&crate::summary::Summary) -> f64| {
                    let ratios = ratios(&compared, (method, ""), base, |s, _| value(s));
                    (!ratios.is_empty()).then(|| times(geometric_mean(&ratios)))
                };
                let cpu = ratios(&compared, (method, ""), base, |s, _| s.cpu);
                holds &= geometric_mean(&cpu) > 1.0;
                Some(format!("{method} {} the steps and {} the CPU time", of(&|s| s.steps)?, of(&|s| s.cpu)?))
            })
            .collect();
        Ok(Report {
            finding: format!(
                "{}. Against one sweep of projected Gauss-Seidel, geometric means over the scenes: {}. (The \
                 paper: all of them take more of both.) A ratio of two solves that were cut off by a limit \
                 means nothing; see `met_rule`.",
                verdict(holds),
                texts.join("; ")
            ),
            parts: vec![Part::table(
                self.name(),
                "`paper` with other row solvers: time, error, steps",
                table(&compared, |_| true),
            )],
        })
    }
}
