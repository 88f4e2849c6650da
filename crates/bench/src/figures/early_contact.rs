//! Early contact by a large delta (paper, section 7.3).

use super::{Figure, Part, Section, verdict};
use crate::bench::Bench;
use crate::simulate::simulate;
use crate::table::{Table, mean, short};
use anyhow::Result;
use bowknot::Scene;

pub struct EarlyContact;

/// Contact distances, in edge lengths; 0.1 is the default.
const DELTAS: [f64; 5] = [0.025, 0.05, 0.1, 0.2, 0.4];
/// Height from which the sheet falls, and its edge length [m].
const HEIGHT: f64 = 0.1;
const EDGE: f64 = 0.05;

impl Figure for EarlyContact {
    fn name(&self) -> &'static str {
        "early-contact"
    }

    fn title(&self) -> &'static str {
        "Section 7.3: early contact against delta"
    }

    fn question(&self) -> &'static str {
        "delta is the distance that contacts are brought to: a large one makes early collisions, the paper says. A sheet with edges of 5 cm \
         falls flat by 10 cm onto the ground; how high does it rest, and what does a smaller delta cost in `drape`?"
    }

    fn run(&self, bench: &Bench) -> Result<Section> {
        let mut table = Table::new([
            "preset",
            "delta, edge lengths",
            "rests at, mm",
            "rests at, deltas",
            "drape: steps a time step",
            "drape: CPU s",
            "drape: gap, mm",
        ]);
        let mut costs = Vec::new();
        for preset in ["fast", "paper"] {
            for delta in DELTAS {
                if !bench.has_time() {
                    break;
                }
                let sets = [
                    format!("contact.preset={preset}"),
                    format!("contact.delta={:?}", delta * EDGE),
                    "solver.stop.max_seconds=5".to_owned(),
                ];
                let key = format!("early-contact/{preset}-{delta}");
                let flat = simulate(bench, &format!("{key}-flat"), &sheet()?.with_sets(&sets)?, 100, 1)?;
                let height = flat.samples.last().map_or(f64::NAN, |s| s.center[2]);
                let drape = Scene::builtin("drape", bench.size.pick(0.4, 0.2, 0.15))?;
                let edge = bowknot::Simulator::new(&drape)?.resolver().scene().lengths().edge;
                let sets = [
                    format!("contact.preset={preset}"),
                    format!("contact.delta={:?}", delta * edge),
                    "solver.stop.max_seconds=5".to_owned(),
                ];
                let frames = bench.size.pick(80, 50, 40);
                let drape = simulate(bench, &format!("{key}-drape"), &drape.with_sets(&sets)?, frames, 1)?;
                let steps: Vec<f64> = drape.steps.iter().map(|&s| s as f64).collect();
                table.row([
                    preset.into(),
                    delta.to_string().into(),
                    (1e3 * height).into(),
                    (height / (delta * EDGE)).into(),
                    mean(&steps).into(),
                    drape.cpu_seconds().into(),
                    (1e3 * drape.min_gap.unwrap_or(f64::NAN)).into(),
                ]);
                costs.push((preset, delta, height / (delta * EDGE), drape.cpu_seconds()));
            }
        }
        let told: Vec<String> = ["fast", "paper"]
            .iter()
            .filter_map(|preset| {
                let of = |delta: f64| costs.iter().find(|c| c.0 == *preset && c.1 == delta);
                let (small, usual) = (of(DELTAS[0])?, of(0.1)?);
                Some(format!(
                    "With `{preset}` the sheet rests at {} delta, and a quarter of the default delta takes {} times the CPU time \
                     in `drape`",
                    short(usual.2),
                    short(small.3 / usual.3)
                ))
            })
            .collect();
        let (low, high) =
            costs.iter().fold((f64::INFINITY, 0.0f64), |(low, high), c| (low.min(c.2), high.max(c.2)));
        Ok(Section {
            finding: format!(
                "{}: a sheet rests at {} to {} delta, so that contact is as early as delta is large. {}.",
                verdict(low > 0.9 && high < 1.1),
                short(low),
                short(high),
                told.join("; ")
            ),
            parts: vec![Part::Table { name: self.name().to_owned(), caption: String::new(), table }],
        })
    }
}

/// A sheet that falls flat.
fn sheet() -> Result<Scene> {
    let text = format!(
        r#"
        [[body]]
        name = "sheet"
        shape = {{ type = "sheet", size = [0.4, 0.4], edge = {EDGE} }}
        translate = [0.0, 0.0, {HEIGHT}]

        [[obstacle]]
        name = "ground"
        shape = {{ type = "half-space" }}
    "#
    );
    Ok(Scene::from_toml(&text, ".")?)
}
