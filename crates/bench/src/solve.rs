//! Solves problems by methods and times the solves.

use crate::bench::Bench;
use crate::case::CollisionCase;
use crate::measures::{CaseEvaluator, Quality, with_reference};
use crate::methods::Setting;
use crate::table::median;
use anyhow::Result;
use bowknot::simulator::cpu_seconds;
use bowknot::twoway::StageSeconds;
use bowknot_baselines::Outcome;
use serde::{Deserialize, Serialize};
use std::time::Instant;

/// A solve that takes fewer CPU seconds is repeated until so many have passed in total.
const SHORT: f64 = 0.1;
/// Largest number of such solves.
const MAX_REPEATS: usize = 20;
/// A solve that takes more CPU seconds is measured in the first round only.
const LONG: f64 = 1.0;

/// A method's solve of a problem, and the quality of its result.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Solved {
    pub steps: usize,
    pub searches: usize,
    pub converged: bool,
    pub failed: bool,
    /// Wall seconds by stage, of the last solve.
    pub stages: Stages,
    /// Processor time of all threads.
    pub cpu_seconds: f64,
    pub wall_seconds: f64,
    pub quality: Quality,
}

/// Wall seconds by stage, see [`StageSeconds`].
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub struct Stages {
    pub search: f64,
    pub evaluate: f64,
    pub backward: f64,
    pub forward: f64,
}

impl From<StageSeconds> for Stages {
    fn from(s: StageSeconds) -> Self {
        Self { search: s.search, evaluate: s.evaluate, backward: s.backward, forward: s.forward }
    }
}

/// What results are compared with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Against {
    /// The reference solution if there is one; finding it takes up to minutes per problem.
    Reference,
    /// Nothing: only stationarity and violations are measured.
    Residuals,
}

/// Solves every case by every setting. Each solve is a measurement of its own that all figures share. In each
/// of `rounds` rounds the settings take turns, so that a busy machine slows all of them alike; times are
/// medians over rounds. A case that there was no time for has no result for any setting, so that settings are
/// always compared on the same cases.
pub fn compare(
    bench: &Bench,
    cases: &[&CollisionCase],
    settings: &[Setting],
    rounds: usize,
    against: Against,
) -> Result<Vec<Option<Vec<Solved>>>> {
    let mut solved: Vec<Vec<Vec<Solved>>> = vec![vec![Vec::new(); settings.len()]; cases.len()];
    for round in 0..rounds {
        for (case, solved) in cases.iter().zip(&mut solved) {
            let mut evaluator = None;
            for (setting, solved) in settings.iter().zip(solved) {
                if solved.first().is_some_and(|first| first.cpu_seconds > LONG) {
                    continue;
                }
                let key = |kind: &str| format!("{kind}/{}/{}/{round}", case.name, setting.key());
                let found = bench.store.find(&key("solved"));
                // A result that was compared with the reference has residuals too.
                let (found, key) = match against {
                    Against::Reference => (found, key("solved")),
                    Against::Residuals => {
                        (found.or_else(|| bench.store.find(&key("unreferenced"))), key("unreferenced"))
                    }
                };
                if let Some(found) = found {
                    solved.push(found);
                } else if bench.has_time() {
                    let evaluator = match &evaluator {
                        Some(evaluator) => evaluator,
                        None => evaluator.insert(match against {
                            Against::Reference => with_reference(bench, case)?,
                            Against::Residuals => CaseEvaluator::of_residuals(case)?,
                        }),
                    };
                    solved.push(bench.store.measured(&key, || solve(bench, case, setting, evaluator))?);
                }
            }
        }
    }
    Ok(solved.into_iter().map(|row| row.into_iter().map(summary).collect()).collect())
}

/// The first of several solves, with median times.
fn summary(rounds: Vec<Solved>) -> Option<Solved> {
    let of = |value: fn(&Solved) -> f64| median(&rounds.iter().map(value).collect::<Vec<_>>());
    let (cpu_seconds, wall_seconds) = (of(|s| s.cpu_seconds), of(|s| s.wall_seconds));
    rounds.into_iter().next().map(|first| Solved { cpu_seconds, wall_seconds, ..first })
}

fn solve(
    bench: &Bench,
    case: &CollisionCase,
    setting: &Setting,
    evaluator: &CaseEvaluator,
) -> Result<Solved> {
    let mut params = setting.params.clone();
    params.solver.stop.max_seconds = Some(setting.limit(bench.size));
    let scene = case.scene(params)?;
    let call = case.states.input();
    let (mut cpu, mut wall) = (Vec::new(), Vec::new());
    let mut ended: (Outcome, Vec<_>) = (Outcome::default(), Vec::new());
    // The first of several short solves warms the caches of the processor.
    while cpu.len() < 2 || (cpu.iter().sum::<f64>() < SHORT && cpu.len() < MAX_REPEATS) {
        // The two-way method would take its pairs from the solve before, the others search anew.
        let mut method = (setting.build)(scene.clone())?;
        let mut x = case.states.x.clone();
        let (timer, cpu_before) = (Instant::now(), cpu_seconds());
        let outcome = method.solve(&mut x, &case.states.y, &call)?;
        cpu.push(cpu_seconds() - cpu_before);
        wall.push(timer.elapsed().as_secs_f64());
        ended = (outcome, x);
        if cpu[0] > SHORT {
            break;
        }
    }
    if cpu.len() > 1 {
        cpu.remove(0);
        wall.remove(0);
    }
    let (outcome, x) = ended;
    Ok(Solved {
        steps: outcome.steps,
        searches: outcome.searches,
        converged: outcome.converged,
        failed: outcome.failed,
        stages: outcome.seconds.into(),
        cpu_seconds: median(&cpu),
        wall_seconds: median(&wall),
        quality: evaluator.evaluate(&x)?,
    })
}
