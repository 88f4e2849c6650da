//! Impact-zone optimisation alone: how often it fails (paper, section 3.3).

use super::{Figure, Part, Section, verdict};
use crate::bench::Bench;
use crate::methods::Setting;
use crate::summary::{COLUMNS, Compared, on_scenes, table};
use anyhow::Result;

pub struct ImpactZones;

const METHODS: [&str; 3] = ["impact zones", "impact zones, Harmon", "impact zones, Tang"];

impl Figure for ImpactZones {
    fn name(&self) -> &'static str {
        "impact-zones"
    }

    fn title(&self) -> &'static str {
        "Section 3.3: impact-zone optimisation alone fails"
    }

    fn question(&self) -> &'static str {
        "The paper's I-Cloth fails in its knots even at 1/1000 s, while the two-way method cannot. The target is optimised until the \
         straight path to it is free of impacts, up to 100 rounds: by projected Gauss-Seidel, by the linear system of Harmon et al. \
         2008, by the augmented Lagrangian of Tang et al. 2018. *-1000* are the knots at 1/1000 s. A solve that fails leaves x where \
         it was; its error is that of x."
    }

    fn run(&self, bench: &Bench) -> Result<Section> {
        let scenes: &[&'static str] = bench.size.pick(
            &["bow-knot", "bow-knot-1000", "reef-knot", "reef-knot-1000", "needle", "tube"][..],
            &["reef-knot", "reef-knot-1000"],
            &["needle"],
        );
        let mut settings =
            vec![Setting::of("fast")?, Setting::of("rigid zones")?, Setting::of("two phases")?];
        for method in METHODS {
            settings.push(Setting::of(method)?);
        }
        let compared = on_scenes(bench, scenes, bench.size.pick(10, 3, 1), &settings, 1)?;
        let failed = |small: bool| {
            let of = |method: &str| {
                let group = compared.iter().filter(|c: &&Compared| c.scene.ends_with("-1000") == small);
                let (failed, all) = group
                    .filter_map(|c| c.find(method, ""))
                    .fold((0, 0), |(f, n), s| (f + s.failed, n + s.of));
                format!("{failed} of {all}")
            };
            METHODS.map(of).join(" / ")
        };
        let count = |method: &str, of: &str| {
            let scenes = compared.iter().filter(|c: &&Compared| c.scene.contains(of));
            scenes.filter_map(|c| c.find(method, "")).map(|s| s.failed).sum::<usize>()
        };
        let holds = METHODS.iter().any(|method| count(method, "knot") > 0) && count("fast", "") == 0;
        let why = if holds {
            ""
        } else {
            " Targets here come from a Newton step that knows of contacts: in the knots most meet nothing or little."
        };
        let unsafe_ends: usize = compared.iter().flat_map(|c| &c.summaries).map(|s| s.intersections).sum();
        Ok(Section {
            finding: format!(
                "{}: impact zones by Gauss-Seidel / linear system / augmented Lagrangian fail in {} problems at the scenes' time steps and in \
                 {} at 1/1000 s; `fast` in {}.{why} {unsafe_ends} intersections in all results.",
                verdict(holds),
                failed(false),
                failed(true),
                count("fast", "")
            ),
            parts: vec![Part::Table {
                name: self.name().to_owned(),
                caption: COLUMNS.to_owned(),
                table: table(&compared, |_| true),
            }],
        })
    }
}
