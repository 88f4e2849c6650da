//! Other solvers of the backward step's rows (paper, sections 4.2.2 and 4.3, Fig. 11 to 15).

use super::{Figure, Part, Section, verdict};
use crate::bench::Bench;
use crate::methods::{Setting, rows};
use crate::solve::Against;
use crate::summary::{COLUMNS, on_scenes, ratios, table};
use crate::table::{geometric_mean, times};
use anyhow::Result;
use bowknot_baselines::rows::ProjectedJacobi;

pub struct RowSolvers;

/// What the figures of the paper compare with projected Gauss-Seidel, one sweep.
const OTHERS: [&str; 6] =
    ["Harmon 2008", "Harmon, projected", "Tang 2018, 20", "Tang 2018, 100", "Jacobi", "Jacobi, Chebyshev"];

impl Figure for RowSolvers {
    fn name(&self) -> &'static str {
        "row-solvers"
    }

    fn title(&self) -> &'static str {
        "Fig. 11 to 15: other solvers of the backward step's rows"
    }

    fn question(&self) -> &'static str {
        "`paper` with another solver in place of one sweep of projected Gauss-Seidel: projected Jacobi, also with Chebyshev \
         weights between steps (Fig. 11) and with up to 800 sweeps (Fig. 12); the linear system without lambda >= 0 of Harmon \
         et al. 2008, 20 sweeps and no edge limits, and with the one-line projection (Fig. 13, 14); the augmented Lagrangian of Tang \
         et al. 2018 by gradient descent, 20 and 100 iterations (Fig. 15). With edge limits the linear system makes edges rigid \
         (Fig. 14). Targets of a dynamics that is blind to contact, as the paper's, and two of Bowknot's."
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
                "stack",
            ][..],
            &["stack-blind"],
            &["needle-blind"],
        );
        let mut settings = vec![
            Setting::of("paper")?,
            Setting::of("paper")?.with("no edge limits", |p| p.contact.edges = false),
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
        let compared = on_scenes(bench, scenes, bench.size.pick(2, 1, 1), &settings, 1, Against::Exact)?;
        let mut holds = true;
        let told: Vec<String> = OTHERS
            .iter()
            .filter_map(|method| {
                let base = if method.starts_with("Harmon") { "no edge limits" } else { "" };
                let of = |value: &dyn Fn(&crate::summary::Summary) -> f64| {
                    let ratios = ratios(&compared, (method, ""), ("paper", base), |s, _| value(s));
                    (!ratios.is_empty()).then(|| times(geometric_mean(&ratios)))
                };
                let cpu = ratios(&compared, (method, ""), ("paper", base), |s, _| s.cpu);
                holds &= geometric_mean(&cpu) > 1.0;
                Some(format!("{method} {} the steps and {} the CPU time", of(&|s| s.steps)?, of(&|s| s.cpu)?))
            })
            .collect();
        Ok(Section {
            finding: format!(
                "{}: against one sweep of projected Gauss-Seidel, geometric means over the scenes: {}. (The paper: all of them take \
                 more of both.) Where both run into a limit the ratio says nothing: see *met*.",
                verdict(holds),
                told.join("; ")
            ),
            parts: vec![Part::Table {
                name: self.name().to_owned(),
                caption: COLUMNS.to_owned(),
                table: table(&compared, |_| true),
            }],
        })
    }
}
