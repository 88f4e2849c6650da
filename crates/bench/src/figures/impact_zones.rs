//! Impact-zone optimization alone: how often it fails (paper, section 3.3).

use crate::bench::Bench;
use crate::figure::{Figure, Part, Report, verdict};
use crate::methods::{SOFT_ROUNDS, Setting, two_phases};
use crate::solve::Against;
use crate::summary::{Compared, on_scenes, table};
use crate::targets::Targets;
use anyhow::Result;
use bowknot_errors::counted;

pub struct ImpactZones;

const METHODS: [&str; 5] = [
    "impact zones",
    "impact zones, Harmon",
    "impact zones, Harmon, to delta",
    "impact zones, Tang",
    "impact zones, 0.8 delta",
];

/// `two phases` with one round of its soft phase.
const ONE_ROUND: &str = "1 soft round";

impl Figure for ImpactZones {
    fn name(&self) -> &'static str {
        "impact-zones"
    }

    fn title(&self) -> &'static str {
        "Section 3.3: impact-zone optimization alone fails"
    }

    fn question(&self) -> &'static str {
        "In the paper, I-Cloth fails in the knots even at 1/1000 s, while the two-way method cannot fail. \
         The target is optimized until the straight path to it is free of impacts, in at most 100 rounds: by \
         projected Gauss-Seidel, by the linear system of Harmon et al. 2008 (with velocities of 0 as \
         published, and to the contact distance), by the augmented Lagrangian of Tang et al. 2018 as \
         published, and by Gauss-Seidel to 0.8 of the distance that the other methods keep. *-1000* are the \
         knots at 1/1000 s. How often the hard phase of Wu et al. 2020 is needed is counted, after five \
         soft rounds and after one. Zones have 60 s for their rounds, all else 4 s as in other figures. One that \
         fails or runs out of time leaves x unchanged; its error is that of the start."
    }

    fn run(&self, bench: &Bench) -> Result<Report> {
        let scenes: &[&'static str] = bench.size.pick(
            &[
                "bow-knot-unaware",
                "bow-knot-unaware-1000",
                "reef-knot-unaware",
                "reef-knot-unaware-1000",
                "needle-unaware",
                "stack-unaware-20",
                "funnel-unaware",
                "tube-unaware",
                "bow-knot",
                "bow-knot-1000",
                "reef-knot",
                "reef-knot-1000",
                "needle",
                "tube",
            ][..],
            &["reef-knot-unaware", "reef-knot-unaware-1000"],
            &["needle-unaware"],
        );
        let mut settings = vec![
            Setting::of("fast")?,
            Setting::of("rigid zones")?,
            Setting::of("two phases")?,
            Setting::of("two phases")?.built(ONE_ROUND, |scene| two_phases(scene, 1)),
        ];
        let phases = [(2, SOFT_ROUNDS), (3, 1)];
        for method in METHODS {
            // Long enough for all rounds: the question is whether they suffice.
            settings.push(Setting::of(method)?.within(60.0));
        }
        let compared = on_scenes(bench, scenes, bench.size.pick(10, 3, 1), &settings, 1, Against::Residuals)?;
        let hard_phases = phases.map(|(setting, soft_rounds)| {
            let solved = || compared.iter().flat_map(|c| c.solved.iter().map(|row| &row[setting]));
            let hard = solved().filter(|solved| solved.steps > soft_rounds).count();
            format!(
                "{hard} of {} after {}",
                solved().count(),
                counted(soft_rounds, "soft round", "soft rounds")
            )
        });
        let failed = |method: &str, keep: &dyn Fn(&str) -> bool| {
            let group = compared.iter().filter(|c: &&Compared| keep(c.scene));
            group.filter_map(|c| c.find(method, "")).fold((0, 0), |(f, n), s| (f + s.failed, n + s.problems))
        };
        let counts = |keep: &dyn Fn(&str) -> bool| {
            let texts = METHODS.map(|method| {
                let (failed, all) = failed(method, keep);
                format!("{failed} of {all}")
            });
            texts.join(" / ")
        };
        let is_unaware = |scene: &str| Targets::of(scene) == Targets::Unaware;
        let small = |scene: &str| scene.ends_with("-1000");
        // I-Cloth is the method of Tang et al.; the paper says nothing about the failures of others.
        let in_knots = failed("impact zones, Tang", &|scene| scene.contains("knot")).0 > 0;
        let fast = failed("fast", &|_| true);
        let unsafe_ends: usize = compared.iter().flat_map(|c| &c.summaries).map(|s| s.intersections).sum();
        Ok(Report {
            finding: format!(
                "{}. Failures of impact zones by Gauss-Seidel / linear system / linear system to delta / \
                 augmented Lagrangian / Gauss-Seidel to 0.8 delta: with contact-unaware targets {} problems at the scenes' time \
                 steps and {} at 1/1000 s; with contact-aware targets, few of which penetrate, {} and {}. \
                 `fast` fails in {} of {}. (The paper: the augmented Lagrangian fails in knots of 70,000 \
                 vertices; these have up to 5,136.) Problems that need the hard phase of `two phases`: {}. \
                 {unsafe_ends} intersections in all results.",
                verdict(in_knots && fast.0 == 0),
                counts(&|scene| is_unaware(scene) && !small(scene)),
                counts(&|scene| is_unaware(scene) && small(scene)),
                counts(&|scene| !is_unaware(scene) && !small(scene)),
                counts(&|scene| !is_unaware(scene) && small(scene)),
                fast.0,
                fast.1,
                hard_phases.join(", ")
            ),
            parts: vec![Part::table(
                self.name(),
                "impact zones with their solvers, rigid zones, two phases and `fast`: failures, time, \
                 residuals",
                table(&compared, |_| true),
            )],
        })
    }
}
