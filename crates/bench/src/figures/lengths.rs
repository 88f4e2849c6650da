//! delta, sigma and the minimum separation swept. Each value defines a problem with a reference solution of
//! its own (paper, Table 3 and section 7.3).

use crate::bench::Bench;
use crate::case::{CollisionCase, ProblemLengths, cases};
use crate::chart::{Axis, Chart};
use crate::figure::{Figure, Part, Report};
use crate::methods::Setting;
use crate::solve::{Against, compare};
use crate::summary::{Compared, Summary, lines, table};
use crate::table::short;
use anyhow::Result;

pub struct LengthsSwept;

/// A length with its values and how they are set.
struct Sweep {
    symbol: &'static str,
    file: &'static str,
    unit: &'static str,
    /// The presets with which it is swept; `paper` has no minimum separation.
    methods: &'static [&'static str],
    /// Its values; `recorded` is among them.
    values: &'static [f64],
    /// The value of the recorded problem.
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
        symbol: "minimum separation",
        file: "min-separation",
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
        "Table 3, continued: delta, sigma and the minimum separation"
    }

    fn question(&self) -> &'static str {
        "The distance delta that contacts keep and the stretch limit sigma define the problem, so each of their \
         values has a reference solution of its own. The minimum separation does not change the problem, only \
         how the two-way method solves it. The states were recorded with a \
         delta of a tenth of the edge length, sigma = 1.1 and a minimum separation of a tenth of delta. \
         Another delta starts from gaps that were made with the recorded one, as in a scene whose settings \
         change. Three scenes with contact-unaware targets, one with contact-aware ones."
    }

    fn run(&self, bench: &Bench) -> Result<Report> {
        let scenes: &[&'static str] = bench.size.pick(
            &["needle-unaware", "stack-unaware", "reef-knot-unaware", "stack"][..],
            &["stack-unaware"],
            &["needle-unaware"],
        );
        let count = bench.size.pick(2, 1, 1);
        let mut report = Report::default();
        let mut texts = Vec::new();
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
                let error = lines(&swept, &values, |s, referenced| 1e3 * s.error(referenced));
                for (what, word, series) in
                    [("CPU seconds per problem", "seconds", cpu), ("error [mm]", "error", error)]
                {
                    let chart = Chart {
                        title: format!("{method}: {what} by {}", sweep.symbol),
                        x: Axis::log(&format!("{} [{}]", sweep.symbol, sweep.unit)),
                        y: Axis::log(what),
                        series,
                        front: false,
                    };
                    let name = format!("lengths-{method}-{}-{word}", sweep.file);
                    report.parts.push(Part::Chart { name, chart });
                }
                texts.push(format!(
                    "{} in `{method}`: time {}x, error {}x",
                    sweep.symbol,
                    short(spread(&swept, &values, |s, _| s.cpu)),
                    short(spread(&swept, &values, |s, referenced| s.error(referenced)))
                ));
            }
            all.extend(swept);
        }
        report.finding = format!(
            "Factor between the largest and the smallest over the values, largest over the scenes. {}.",
            texts.join("; ")
        );
        report.parts.push(Part::table(
            self.name(),
            "delta, sigma and the minimum separation swept, each value with a reference solution of its own",
            table(&all, |_| true),
        ));
        Ok(report)
    }
}

fn change(sweep: &Sweep, value: f64) -> String {
    format!("{} = {value}", sweep.symbol)
}

/// The problems of a scene under every value of a length, with one summary per method and value; none if
/// there was no time.
fn on_scene(
    bench: &Bench,
    scene: &'static str,
    cases: &[CollisionCase],
    sweep: &Sweep,
    settings: &[Setting],
) -> Result<Option<Compared>> {
    let mut summaries = Vec::new();
    for &value in sweep.values {
        let changed: Vec<CollisionCase> = if value == sweep.recorded {
            cases.to_vec()
        } else {
            cases.iter().map(|c| c.with_lengths(&change(sweep, value), (sweep.set)(value))).collect()
        };
        let solved = compare(bench, &changed.iter().collect::<Vec<_>>(), settings, 1, Against::Reference)?;
        for (s, setting) in settings.iter().enumerate() {
            // Not `Setting::with`, because the problem changes and not the setting.
            let rows = solved.iter().flatten().map(|row| &row[s]);
            summaries.extend(
                Summary::of(setting, cases, rows).map(|s| Summary { change: change(sweep, value), ..s }),
            );
        }
    }
    let compared = Compared { scene, cases: cases.to_vec(), solved: Vec::new(), summaries };
    Ok((!compared.summaries.is_empty()).then_some(compared))
}

/// Largest ratio of a quantity's extremes over the values, over all scenes.
fn spread(
    compared: &[Compared],
    values: &[(f64, &str, String)],
    quantity: impl Fn(&Summary, bool) -> f64,
) -> f64 {
    let of_scene = |c: &Compared| {
        let referenced = c.has_references();
        let all = values.iter().filter_map(|(_, method, change)| c.find(method, change));
        let (low, high) = all
            .map(|s| quantity(s, referenced))
            .fold((f64::INFINITY, 0.0f64), |(low, high), v| (low.min(v), high.max(v)));
        high / low
    };
    compared.iter().map(of_scene).fold(0.0, f64::max)
}
