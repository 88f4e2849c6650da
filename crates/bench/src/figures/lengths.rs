//! delta, sigma and the floor swept: each value is a problem of its own, with an exact solution of its own (paper, Table 3
//! and section 7.3).

use super::{Figure, Part, Section};
use crate::bench::Bench;
use crate::case::{Case, ProblemLengths, cases};
use crate::chart::{Axis, Chart};
use crate::methods::Setting;
use crate::solve::{Against, compare};
use crate::summary::{COLUMNS, Compared, Summary, lines, table};
use crate::table::short;
use anyhow::Result;

pub struct LengthsSwept;

/// A length with its values and how they are set.
struct Sweep {
    symbol: &'static str,
    file: &'static str,
    unit: &'static str,
    /// The presets that it is swept of; `paper` has no floor.
    methods: &'static [&'static str],
    /// Its values; the one that makes the problem as it was recorded is among them.
    values: &'static [f64],
    recorded: f64,
    set: fn(f64) -> ProblemLengths,
}

const SWEEPS: [Sweep; 3] = [
    Sweep {
        symbol: "delta",
        file: "delta",
        unit: "delta as recorded",
        methods: &["fast", "paper"],
        values: &[0.25, 0.5, 1.0, 1.5, 2.0],
        recorded: 1.0,
        set: |v| ProblemLengths { delta: Some(v), ..ProblemLengths::default() },
    },
    Sweep {
        symbol: "sigma",
        file: "sigma",
        unit: "1",
        methods: &["fast", "paper"],
        values: &[1.02, 1.05, 1.1, 1.2, 1.4],
        recorded: 1.1,
        set: |v| ProblemLengths { stretch_limit: Some(v), ..ProblemLengths::default() },
    },
    Sweep {
        symbol: "floor",
        file: "floor",
        unit: "delta",
        methods: &["fast"],
        values: &[0.01, 0.03, 0.1, 0.3],
        recorded: 0.1,
        set: |v| ProblemLengths { min_separation: Some(v), ..ProblemLengths::default() },
    },
];

impl Figure for LengthsSwept {
    fn name(&self) -> &'static str {
        "lengths"
    }

    fn title(&self) -> &'static str {
        "Table 3, continued: delta, sigma and the floor"
    }

    fn question(&self) -> &'static str {
        "The distance delta that contacts keep, the stretch limit sigma and the floor of gaps are part of the problem: each value \
         has an exact solution of its own, which results are held against. States were recorded with delta of a tenth of the edge \
         length, sigma = 1.1 and a floor of a tenth of delta; another delta finds gaps that are not its own, as a scene whose \
         settings change. All in targets of a dynamics that is blind to contact, one of Bowknot's."
    }

    fn run(&self, bench: &Bench) -> Result<Section> {
        let scenes: &[&'static str] = bench.size.pick(
            &["needle-blind", "stack-blind", "reef-knot-blind", "stack"][..],
            &["stack-blind"],
            &["needle-blind"],
        );
        let count = bench.size.pick(2, 1, 1);
        let mut section = Section::default();
        let mut told = Vec::new();
        let mut all = Vec::new();
        for sweep in &SWEEPS {
            let settings = sweep.methods.iter().map(|m| Setting::of(m)).collect::<Result<Vec<_>>>()?;
            let mut swept = Vec::new();
            for &scene in scenes {
                swept.extend(on_scene(bench, scene, &cases(bench, scene, count)?, sweep, &settings)?);
            }
            for method in sweep.methods {
                let values: Vec<(f64, &str, String)> =
                    sweep.values.iter().map(|&v| (v, *method, change(sweep, v))).collect();
                let cpu = lines(&swept, &values, |s, _| s.cpu);
                let error = lines(&swept, &values, |s, exact| 1e3 * s.error(exact));
                for (what, word, series) in
                    [("CPU seconds a problem", "seconds", cpu), ("error [mm]", "error", error)]
                {
                    let chart = Chart {
                        title: format!("{method}: {what} by {}", sweep.symbol),
                        x: Axis::log(&format!("{} [{}]", sweep.symbol, sweep.unit)),
                        y: Axis::log(what),
                        series,
                        front: false,
                    };
                    let name = format!("lengths-{method}-{}-{word}", sweep.file);
                    section.parts.push(Part::Chart { name, chart });
                }
                told.push(format!(
                    "{} in `{method}`: time {}x, error {}x",
                    sweep.symbol,
                    short(spread(&swept, &values, |s, _| s.cpu)),
                    short(spread(&swept, &values, |s, exact| s.error(exact)))
                ));
            }
            all.extend(swept);
        }
        section.finding = format!(
            "Factor between the largest and the smallest over the values, largest over the scenes. {}.",
            told.join("; ")
        );
        section.parts.push(Part::Table {
            name: self.name().to_owned(),
            caption: COLUMNS.to_owned(),
            table: table(&all, |_| true),
        });
        Ok(section)
    }
}

fn change(sweep: &Sweep, value: f64) -> String {
    format!("{} = {value}", sweep.symbol)
}

/// The problems of a scene under every value of a length, one summary a method and value; none if there was no time.
fn on_scene(
    bench: &Bench,
    scene: &'static str,
    cases: &[Case],
    sweep: &Sweep,
    settings: &[Setting],
) -> Result<Option<Compared>> {
    let mut summaries = Vec::new();
    for &value in sweep.values {
        let changed: Vec<Case> = match value == sweep.recorded {
            true => cases.to_vec(),
            false => cases.iter().map(|c| c.under(&change(sweep, value), (sweep.set)(value))).collect(),
        };
        let solved = compare(bench, &changed.iter().collect::<Vec<_>>(), settings, 1, Against::Exact)?;
        for (s, setting) in settings.iter().enumerate() {
            // Not `Setting::with`: it is the problem that changes.
            let rows = solved.iter().flatten().map(|row| &row[s]);
            summaries.extend(
                Summary::of(setting, cases, rows).map(|s| Summary { change: change(sweep, value), ..s }),
            );
        }
    }
    let compared = Compared { scene, cases: cases.to_vec(), solved: Vec::new(), summaries };
    Ok((!compared.summaries.is_empty()).then_some(compared))
}

/// Largest over scenes of the ratio of a quantity's extremes.
fn spread(
    compared: &[Compared],
    values: &[(f64, &str, String)],
    quantity: impl Fn(&Summary, bool) -> f64,
) -> f64 {
    let of_scene = |c: &Compared| {
        let exact = c.is_exact();
        let all = values.iter().filter_map(|(_, method, change)| c.find(method, change));
        let (low, high) = all
            .map(|s| quantity(s, exact))
            .fold((f64::INFINITY, 0.0f64), |(low, high), v| (low.min(v), high.max(v)));
        high / low
    };
    compared.iter().map(of_scene).fold(0.0, f64::max)
}
