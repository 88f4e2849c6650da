//! What each point of `fast` is worth: off alone, and on alone in `paper`.

use super::{Figure, Part, Section, is_blind};
use crate::bench::Bench;
use crate::methods::Setting;
use crate::solve::Against;
use crate::summary::{Compared, Summary, on_scenes, table};
use crate::table::{Entry, Table, geometric_mean, short};
use anyhow::Result;
use bowknot::twoway::Params;

pub struct Switches;

/// What a switch takes from the other preset.
struct Switch {
    name: &'static str,
    copy: fn(&mut Params, &Params),
}

const SWITCHES: [Switch; 16] = [
    Switch { name: "gap form", copy: |to, from| to.contact.form = from.contact.form },
    Switch { name: "edges as balls", copy: |to, from| to.contact.edge_form = from.contact.edge_form },
    Switch {
        name: "edges limited from rest",
        copy: |to, from| to.contact.edge_reference = from.contact.edge_reference,
    },
    Switch { name: "planes", copy: |to, from| to.solver.forward.bound = from.solver.forward.bound },
    Switch {
        name: "budgets",
        copy: |to, from| {
            to.solver.forward.trust_region = from.solver.forward.trust_region;
            to.solver.forward.trust_region_min = from.solver.forward.trust_region_min;
            to.solver.forward.trust_region_max = from.solver.forward.trust_region_max;
        },
    },
    Switch { name: "floor", copy: |to, from| to.contact.min_separation = from.contact.min_separation },
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
        name: "further sweeps at the end",
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

/// Seconds of a solve: without some points there is no end.
const LIMIT: f64 = 2.0;

impl Figure for Switches {
    fn name(&self) -> &'static str {
        "switches"
    }

    fn title(&self) -> &'static str {
        "What each point of `fast` is worth"
    }

    fn question(&self) -> &'static str {
        "`fast` with one point as in `paper` (off alone), and `paper` with one point as in `fast` (on alone), on problems of \
         five scenes, with targets of a dynamics that is blind to contact and with Bowknot's own. Each cell: CPU seconds and error as multiples of those of the unchanged preset, and the stretch against \
         rest; a star where not all calls met their stopping rule within the limits on steps and seconds. A point pays if \
         switching it off takes more time, or leaves more error, than it costs elsewhere."
    }

    fn run(&self, bench: &Bench) -> Result<Section> {
        let scenes: &[&'static str] = bench.size.pick(
            &[
                "needle-blind",
                "stack-blind",
                "tube-blind",
                "bow-knot-blind",
                "reef-knot-blind",
                "needle",
                "stack",
                "tube",
                "bow-knot",
                "reef-knot",
            ][..],
            &["needle-blind", "stack"],
            &["needle-blind"],
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
        let compared = on_scenes(bench, scenes, count, &settings, rounds, Against::Exact)?;
        let (blind, own): (Vec<Compared>, Vec<Compared>) =
            compared.iter().cloned().partition(|c| is_blind(c.scene));
        let mut parts = Vec::new();
        for (group, whose) in [(&blind, "blind"), (&own, "own")] {
            for (method, word, what) in
                [("fast", "without", "`fast`, off alone"), ("paper", "with", "`paper`, on alone")]
            {
                parts.push(Part::Table {
                    name: format!("switches-{whose}-{word}"),
                    caption: format!("{what}, {whose} targets:"),
                    table: changes(group, method, word),
                });
            }
        }
        parts.push(Part::Data { name: "switches-all".to_owned(), table: table(&compared, |_| true) });
        Ok(Section {
            finding: format!("Blind targets: {} Own targets: {}", finding(&blind), finding(&own)),
            parts,
        })
    }
}

fn changes(compared: &[Compared], method: &str, word: &str) -> Table {
    let mut table = Table::new(std::iter::once("").chain(compared.iter().map(|c| c.scene)));
    for switch in &SWITCHES {
        let change = format!("{word} {}", switch.name);
        let cells = compared.iter().map(|c| cell(c, method, &change));
        table.row(std::iter::once(Entry::from(switch.name)).chain(cells));
    }
    table
}

fn cell(compared: &Compared, method: &str, change: &str) -> Entry {
    let exact = compared.is_exact();
    let (Some(plain), Some(changed)) = (compared.find(method, ""), compared.find(method, change)) else {
        return "not measured".into();
    };
    let star = if changed.met < changed.of { "\\*" } else { "" };
    let ratio = |value: &dyn Fn(&Summary) -> f64| short(value(changed) / value(plain));
    format!("{}{star}, {}, {}", ratio(&|s| s.cpu), ratio(&|s| s.error(exact)), short(changed.stretch)).into()
}

/// The points by what switching them off costs.
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
    let told = |costs: &[(&str, f64)]| {
        costs.iter().map(|(name, cost)| format!("{name} ({}x)", short(*cost))).collect::<Vec<_>>().join(", ")
    };
    let dear: Vec<(&str, f64)> = costs.iter().copied().filter(|c| c.1 > 1.1).collect();
    let cheap: Vec<(&str, f64)> = costs.iter().copied().filter(|c| c.1 < 0.95).collect();
    format!(
        "Without them `fast` takes longer, geometric mean over the scenes: {}. Without these it is faster, at the errors in \
         the table: {}.",
        if dear.is_empty() { "none".to_owned() } else { told(&dear) },
        if cheap.is_empty() { "none".to_owned() } else { told(&cheap) }
    )
}
