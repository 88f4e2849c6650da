//! The effect of each difference between `fast` and `paper`: switched off in `fast`, and switched on in
//! `paper`.

use crate::bench::Bench;
use crate::figure::{Figure, Part, Report};
use crate::methods::Setting;
use crate::solve::Against;
use crate::summary::{Compared, on_scenes, table};
use crate::table::{Table, geometric_mean, times};
use crate::targets::Targets;
use anyhow::Result;
use bowknot::twoway::Params;

pub struct Switches;

/// A difference between the presets, and how it is copied from one to the other.
struct Switch {
    name: &'static str,
    copy: fn(&mut Params, &Params),
}

const SWITCHES: [Switch; 16] = [
    Switch { name: "gap form", copy: |to, from| to.contact.form = from.contact.form },
    Switch {
        name: "edges as distance limits",
        copy: |to, from| to.contact.edge_form = from.contact.edge_form,
    },
    Switch {
        name: "edges limited from rest",
        copy: |to, from| to.contact.edge_reference = from.contact.edge_reference,
    },
    Switch { name: "moving planes", copy: |to, from| to.solver.forward.bound = from.solver.forward.bound },
    Switch {
        name: "trust regions per vertex",
        copy: |to, from| {
            to.solver.forward.trust_region = from.solver.forward.trust_region;
            to.solver.forward.trust_region_min = from.solver.forward.trust_region_min;
            to.solver.forward.trust_region_max = from.solver.forward.trust_region_max;
        },
    },
    Switch {
        name: "minimum separation",
        copy: |to, from| to.contact.min_separation = from.contact.min_separation,
    },
    Switch {
        name: "swept search",
        copy: |to, from| to.solver.forward.swept_travel = from.solver.forward.swept_travel,
    },
    Switch { name: "rows from 2 delta", copy: |to, from| to.contact.range = from.contact.range },
    Switch {
        name: "8 sweeps",
        copy: |to, from| {
            to.solver.backward.sweeps = from.solver.backward.sweeps;
            to.solver.backward.polish_sweeps =
                to.solver.backward.polish_sweeps.max(from.solver.backward.sweeps);
        },
    },
    Switch {
        name: "more sweeps at the end",
        copy: |to, from| {
            to.solver.backward.polish_sweeps =
                from.solver.backward.polish_sweeps.max(to.solver.backward.sweeps)
        },
    },
    Switch {
        name: "proximal term, edges",
        copy: |to, from| to.solver.backward.edge_proximal = from.solver.backward.edge_proximal,
    },
    Switch {
        name: "proximal term, contacts",
        copy: |to, from| to.solver.backward.contact_proximal = from.solver.backward.contact_proximal,
    },
    Switch {
        name: "growth of the proximal term",
        copy: |to, from| to.solver.backward.proximal_growth = from.solver.backward.proximal_growth,
    },
    Switch {
        name: "coarse correction",
        copy: |to, from| to.solver.backward.coarse_correction = from.solver.backward.coarse_correction,
    },
    Switch {
        name: "active rows",
        copy: |to, from| to.solver.backward.active_rows = from.solver.backward.active_rows,
    },
    Switch { name: "stop by travel", copy: |to, from| to.solver.stop.rule = from.solver.stop.rule },
];

/// Time limit of a solve [s]: without some of them a solve does not end.
const LIMIT: f64 = 2.0;

impl Figure for Switches {
    fn name(&self) -> &'static str {
        "switches"
    }

    fn title(&self) -> &'static str {
        "The effect of each difference between `fast` and `paper`"
    }

    fn question(&self) -> &'static str {
        "`fast` with one setting of `paper` (off alone), and `paper` with one setting of `fast` (on alone), \
         on problems of five scenes with contact-unaware and contact-aware targets. CPU time and error are \
         multiples of those of the unchanged preset. A setting is worth keeping if switching it off costs \
         more time or error than it saves elsewhere."
    }

    fn run(&self, bench: &Bench) -> Result<Report> {
        let scenes: &[&'static str] = bench.size.pick(
            &[
                "needle-unaware",
                "stack-unaware",
                "tube-unaware",
                "bow-knot-unaware",
                "reef-knot-unaware",
                "needle",
                "stack",
                "tube",
                "bow-knot",
                "reef-knot",
            ][..],
            &["needle-unaware", "stack"],
            &["needle-unaware"],
        );
        let (fast, paper) = (Params::fast(), Params::paper());
        let mut settings = vec![Setting::of("fast")?.within(LIMIT), Setting::of("paper")?.within(LIMIT)];
        for switch in &SWITCHES {
            let off =
                Setting::of("fast")?.with(format!("without {}", switch.name), |p| (switch.copy)(p, &paper));
            let on = Setting::of("paper")?.with(format!("with {}", switch.name), |p| (switch.copy)(p, &fast));
            settings.extend([off.within(LIMIT), on.within(LIMIT)]);
        }
        let (count, rounds) = (bench.size.pick(2, 1, 1), 1);
        let compared = on_scenes(bench, scenes, count, &settings, rounds, Against::Reference)?;
        let (unaware, aware): (Vec<Compared>, Vec<Compared>) =
            compared.iter().cloned().partition(|c| Targets::of(c.scene) == Targets::Unaware);
        let shows = "each setting switched off in `fast` and on in `paper`: CPU time and error over the \
                     unchanged preset";
        Ok(Report {
            finding: format!(
                "Contact-unaware targets. {} Contact-aware targets. {}",
                finding(&unaware),
                finding(&aware)
            ),
            parts: vec![
                Part::table(self.name(), shows, ratio_table(&compared)),
                Part::table(
                    "switches-all",
                    "the same solves, with all quantities",
                    table(&compared, |_| true),
                ),
            ],
        })
    }
}

/// One row per preset, setting and scene.
fn ratio_table(compared: &[Compared]) -> Table {
    let mut table =
        Table::new(["change", "scene", "cpu_ratio", "error_ratio", "max_stretch", "all_met_rule"]);
    for (method, word) in [("fast", "without"), ("paper", "with")] {
        for switch in &SWITCHES {
            let change = format!("{word} {}", switch.name);
            for c in compared {
                let referenced = c.has_references();
                let (Some(plain), Some(changed)) = (c.find(method, ""), c.find(method, &change)) else {
                    continue;
                };
                table.row([
                    changed.name().into(),
                    c.scene.into(),
                    (changed.cpu / plain.cpu).into(),
                    (changed.error(referenced) / plain.error(referenced)).into(),
                    changed.stretch.into(),
                    if changed.met == changed.problems { "yes".into() } else { "no".into() },
                ]);
            }
        }
    }
    table
}

/// The settings by the CPU time of `fast` without them.
fn finding(compared: &[Compared]) -> String {
    let mut costs: Vec<(&str, f64)> = SWITCHES
        .iter()
        .filter_map(|switch| {
            let change = format!("without {}", switch.name);
            let ratios: Vec<f64> = compared
                .iter()
                .filter_map(|c| Some(c.find("fast", &change)?.cpu / c.find("fast", "")?.cpu))
                .collect();
            (!ratios.is_empty()).then(|| (switch.name, geometric_mean(&ratios)))
        })
        .collect();
    costs.sort_by(|a, b| b.1.total_cmp(&a.1));
    let list = |keep: &dyn Fn(f64) -> bool| {
        let kept: Vec<String> = costs
            .iter()
            .filter(|(_, cost)| keep(*cost))
            .map(|(name, cost)| format!("{name} ({})", times(*cost)))
            .collect();
        if kept.is_empty() { "none".to_owned() } else { kept.join(", ") }
    };
    format!(
        "`fast` is slower without these, geometric mean over the scenes: {}. It is faster without these, at \
         the errors in the table: {}.",
        list(&|cost| cost > 1.1),
        list(&|cost| cost < 0.95)
    )
}
