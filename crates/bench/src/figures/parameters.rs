//! The parameters of the paper's Table 3, swept.

use super::{Figure, Part, Section};
use crate::bench::Bench;
use crate::chart::{Axis, Chart};
use crate::methods::Setting;
use crate::solve::Against;
use crate::summary::{COLUMNS, Compared, Summary, lines, on_scenes, table};
use crate::table::short;
use anyhow::Result;
use bowknot::twoway::Params;

pub struct Parameters;

/// A parameter with its symbol, its values, and how they are set.
struct Sweep {
    symbol: &'static str,
    file: &'static str,
    unit: &'static str,
    /// The presets that it is swept of.
    methods: &'static [&'static str],
    values: &'static [f64],
    set: fn(&mut Params, f64),
}

const SWEEPS: [Sweep; 4] = [
    Sweep {
        symbol: "D_min",
        file: "d-min",
        unit: "delta",
        methods: &["paper"],
        values: &[0.5, 1.0, 2.0, 3.0, 3.8],
        set: |p, v| p.solver.forward.trust_region_min = 0.5 * v,
    },
    Sweep {
        symbol: "D_max",
        file: "d-max",
        unit: "delta",
        methods: &["paper"],
        values: &[2.5, 4.0, 6.0, 10.0, 16.0],
        set: |p, v| p.solver.forward.trust_region_max = 0.5 * v,
    },
    Sweep {
        symbol: "gamma",
        file: "gamma",
        unit: "1",
        methods: &["paper", "fast"],
        values: &[0.3, 0.5, 0.7, 0.9, 0.99],
        set: |p, v| p.solver.forward.damping = v,
    },
    Sweep {
        symbol: "budgets up to",
        file: "budget",
        unit: "edge lengths",
        methods: &["fast"],
        values: &[0.12, 0.18, 0.25, 0.4, 0.6],
        set: |p, v| p.solver.forward.trust_region_max = v,
    },
];

impl Figure for Parameters {
    fn name(&self) -> &'static str {
        "parameters"
    }

    fn title(&self) -> &'static str {
        "Table 3: its parameters swept"
    }

    fn question(&self) -> &'static str {
        "The paper calls its method insensitive to parameters. One parameter at a time, all others as they are: the bounds of \
         the search D_min and D_max (2 and 4 delta), the damping gamma (0.9), and the bound of \
         `fast`'s budgets (0.25). delta and sigma make another problem: the next figure sets each against its own exact solution."
    }

    fn run(&self, bench: &Bench) -> Result<Section> {
        let scenes: &[&'static str] = bench.size.pick(
            &["needle-blind", "stack-blind", "tube-blind", "reef-knot-blind", "needle", "stack"][..],
            &["stack-blind"],
            &["needle-blind"],
        );
        let mut settings = vec![Setting::of("fast")?, Setting::of("paper")?];
        let swept: Vec<(&Sweep, &str)> = SWEEPS
            .iter()
            .flat_map(|sweep| sweep.methods.iter().map(move |method| (sweep, *method)))
            .collect();
        let mut values: Vec<Vec<(f64, &str, String)>> = Vec::new();
        for (sweep, method) in &swept {
            let mut of_sweep = Vec::new();
            for &value in sweep.values {
                let mut setting = Setting::of(method)?;
                let before = setting.params.clone();
                (sweep.set)(&mut setting.params, value);
                if setting.params != before {
                    setting = setting.with(format!("{} = {value}", sweep.symbol), |_| ());
                    settings.push(setting.clone());
                }
                of_sweep.push((value, setting.method, setting.change));
            }
            values.push(of_sweep);
        }
        let compared = on_scenes(bench, scenes, bench.size.pick(2, 1, 1), &settings, 1, Against::Exact)?;
        let mut section = Section::default();
        let mut told = Vec::new();
        for ((sweep, method), values) in swept.iter().zip(&values) {
            let chart = Chart {
                title: format!("{method}: CPU seconds by {}", sweep.symbol),
                x: Axis::log(&format!("{} [{}]", sweep.symbol, sweep.unit)),
                y: Axis::log("CPU seconds a problem"),
                series: lines(&compared, values, |s, _| s.cpu),
                front: false,
            };
            let name = format!("parameters-{method}-{}", sweep.file);
            section.parts.push(Part::Chart { name, chart });
            told.push(format!(
                "{} in `{method}` by up to {}",
                sweep.symbol,
                short(spread(&compared, values, |s| s.cpu))
            ));
        }
        section.finding = format!(
            "Factor between the slowest and the fastest value, largest over the scenes: {}.",
            told.join("; ")
        );
        section.parts.push(Part::Data { name: self.name().to_owned(), table: table(&compared, |_| true) });
        section.parts.push(Part::Table {
            name: "parameters-steps".to_owned(),
            caption: format!("The presets as they are. {COLUMNS}"),
            table: table(&compared, |s| s.change.is_empty()),
        });
        Ok(section)
    }
}

/// Largest over scenes of the ratio of a quantity's extremes.
fn spread(compared: &[Compared], values: &[(f64, &str, String)], quantity: impl Fn(&Summary) -> f64) -> f64 {
    let of_scene = |c: &Compared| {
        let all = values.iter().filter_map(|(_, method, change)| c.find(method, change)).map(&quantity);
        let (low, high) = all.fold((f64::INFINITY, 0.0f64), |(l, h), v| (l.min(v), h.max(v)));
        high / low
    };
    compared.iter().map(of_scene).fold(0.0, f64::max)
}
