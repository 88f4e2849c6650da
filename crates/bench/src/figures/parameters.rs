//! The parameters of the paper's Table 3, swept.

use crate::bench::Bench;
use crate::chart::{Axis, Chart};
use crate::figure::{Figure, Part, Report};
use crate::methods::Setting;
use crate::solve::Against;
use crate::summary::{Compared, Summary, lines, on_scenes, table};
use crate::table::short;
use anyhow::Result;
use bowknot::twoway::Params;

pub struct Parameters;

/// A parameter with its symbol, its values, and how they are set.
struct Sweep {
    symbol: &'static str,
    file: &'static str,
    unit: &'static str,
    /// The presets with which it is swept.
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
        symbol: "trust regions up to",
        file: "trust-region",
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
        "The paper calls its method insensitive to parameters. One parameter is changed at a time: the \
         bounds of the search D_min and D_max (2 and 4 delta), the damping gamma (0.9), and the largest \
         trust region of `fast` (0.25 edge lengths). delta and sigma define another problem; see `lengths`."
    }

    fn run(&self, bench: &Bench) -> Result<Report> {
        let scenes: &[&'static str] = bench.size.pick(
            &["needle-unaware", "stack-unaware", "tube-unaware", "reef-knot-unaware", "needle", "stack"][..],
            &["stack-unaware"],
            &["needle-unaware"],
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
        let compared = on_scenes(bench, scenes, bench.size.pick(2, 1, 1), &settings, 1, Against::Reference)?;
        let mut report = Report::default();
        let mut texts = Vec::new();
        for ((sweep, method), values) in swept.iter().zip(&values) {
            let chart = Chart {
                title: format!("{method}: CPU seconds by {}", sweep.symbol),
                x: Axis::log(&format!("{} [{}]", sweep.symbol, sweep.unit)),
                y: Axis::log("CPU seconds per problem"),
                series: lines(&compared, values, |s, _| s.cpu),
                front: false,
            };
            let name = format!("parameters-{method}-{}", sweep.file);
            report.parts.push(Part::Chart { name, chart });
            texts.push(format!(
                "{} in `{method}` by up to {}",
                sweep.symbol,
                short(spread(&compared, values, |s| s.cpu))
            ));
        }
        report.finding = format!(
            "Factor between the slowest and the fastest value, largest over the scenes: {}.",
            texts.join("; ")
        );
        let shows = "`fast` and `paper` with one parameter changed";
        report.parts.push(Part::table(self.name(), shows, table(&compared, |_| true)));
        Ok(report)
    }
}

/// Largest ratio of a quantity's extremes over the values, over all scenes.
fn spread(compared: &[Compared], values: &[(f64, &str, String)], quantity: impl Fn(&Summary) -> f64) -> f64 {
    let of_scene = |c: &Compared| {
        let all = values.iter().filter_map(|(_, method, change)| c.find(method, change)).map(&quantity);
        let (low, high) = all.fold((f64::INFINITY, 0.0f64), |(l, h), v| (l.min(v), h.max(v)));
        high / low
    };
    compared.iter().map(of_scene).fold(0.0, f64::max)
}
