//! Every method with the same tolerances.

use super::contacts_alone;
use crate::bench::Bench;
use crate::chart::{Axis, Chart, Series, Style};
use crate::figure::{Figure, Part, Report};
use crate::methods::{Setting, impact_zones, ipc, log_barrier};
use crate::summary::{Summary, ratios, table};
use crate::table::{geometric_mean, times};
use crate::targets::Targets;
use anyhow::Result;
use bowknot::twoway::{Params, StopRule};
use bowknot_baselines::barrier::BarrierParams;
use bowknot_baselines::zones::ZoneParams;

pub struct Tolerance;

/// Largest distance that a vertex may still want to move, in mean edge lengths.
const TOLERANCES: [f64; 5] = [0.1, 0.03, 0.01, 0.003, 0.001];
/// The methods that have such a tolerance.
const METHODS: [&str; 5] = ["fast", "paper", "log barrier", "IPC", "impact zones, 0.8 delta"];

impl Figure for Tolerance {
    fn name(&self) -> &'static str {
        "tolerance"
    }

    fn title(&self) -> &'static str {
        "Equal tolerances: CPU time and error"
    }

    fn question(&self) -> &'static str {
        "What does each method cost, and how exact is it, if all stop where no vertex would move by more than \
         tau, from 0.1 to 0.001 mean edge lengths? The two-way method stops by the distance that is left to \
         its target (`fast` and `paper` with the rule `travel`, and residuals of one edge length, which \
         decide nothing), the barriers by the longest step of a vertex, which may be shorter than what is \
         left, impact zones when a sweep changes no row by more. Contacts alone, contact-unaware targets; the problems of `contacts-alone`."
    }

    fn run(&self, bench: &Bench) -> Result<Report> {
        let mut settings = Vec::new();
        for method in METHODS {
            for tau in TOLERANCES {
                settings.push(at(method, tau)?);
            }
        }
        let compared = contacts_alone::compared(bench, Targets::Unaware, &settings)?;
        let over_scenes = |method: &str, tau: f64, value: &dyn Fn(&Summary, bool) -> f64| {
            let of = compared
                .iter()
                .filter_map(|c| Some(value(c.find(method, &change(tau))?, c.has_references())));
            let values: Vec<f64> = of.filter(|value| *value > 0.0).collect();
            (!values.is_empty()).then(|| geometric_mean(&values))
        };
        let chart = |what: &str, value: &dyn Fn(&Summary, bool) -> f64| Chart {
            title: format!("{what} by tolerance, geometric means over the scenes"),
            x: Axis::log("tau [mean edge lengths]"),
            y: Axis::log(what),
            series: METHODS
                .iter()
                .map(|method| {
                    let points =
                        TOLERANCES.iter().filter_map(|&tau| Some((tau, over_scenes(method, tau, value)?)));
                    Series::new(method, Style::Line, points)
                })
                .collect(),
            front: false,
        };
        let charts = [
            ("seconds", chart("CPU seconds per problem", &|s, _| s.cpu)),
            ("error", chart("error [mm]", &|s, referenced| 1e3 * s.error(referenced))),
        ];
        let texts = TOLERANCES.map(|tau| {
            let of_method = |method: &&str| {
                let change = change(tau);
                let (other, fast) = ((*method, change.as_str()), ("fast", change.as_str()));
                let cpu = ratios(&compared, other, fast, |s, _| s.cpu);
                let error = ratios(&compared, other, fast, |s, referenced| s.error(referenced));
                format!("{method} {} and {}", times(geometric_mean(&cpu)), times(geometric_mean(&error)))
            };
            format!("tau {tau}: {}", METHODS[1..].iter().map(of_method).collect::<Vec<_>>().join("; "))
        });
        let mut parts = vec![Part::table(
            self.name(),
            "methods that stop at the same tolerances, contacts alone: time, error, steps",
            table(&compared, |_| true),
        )];
        parts.extend(
            charts.map(|(word, chart)| Part::Chart { name: format!("{}-{word}", self.name()), chart }),
        );
        Ok(Report {
            finding: format!(
                "CPU time and error as multiples of those of `fast` with the same tau, geometric means over \
                 the scenes. {}.",
                texts.join(". ")
            ),
            parts,
        })
    }
}

fn change(tau: f64) -> String {
    format!("tau {tau}")
}

/// A method that stops at that tolerance.
fn at(method: &'static str, tau: f64) -> Result<Setting> {
    let setting = Setting::of(method)?;
    let change = change(tau);
    Ok(match method {
        "log barrier" => setting.built(change, move |scene| {
            log_barrier(scene, BarrierParams { tolerance: tau, ..BarrierParams::default() })
        }),
        "IPC" => setting
            .built(change, move |scene| ipc(scene, BarrierParams { tolerance: tau, ..BarrierParams::ipc() })),
        "impact zones, 0.8 delta" => setting.built(change, move |scene| {
            impact_zones(scene, ZoneParams { thickness: 0.8, tolerance: tau, ..ZoneParams::default() })
        }),
        _ => setting.with(change, |params: &mut Params| {
            params.solver.stop.rule = StopRule::Travel { net_residual: 1.0, residual: Some(1.0) };
            params.solver.stop.distance = tau;
        }),
    })
}
