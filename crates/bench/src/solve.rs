//! Solving problems by methods, and timing it.

use crate::bench::Bench;
use crate::case::Case;
use crate::measures::{Judged, Judgement};
use crate::methods::Setting;
use crate::table::median;
use anyhow::Result;
use bowknot::simulator::cpu_seconds;
use bowknot::twoway::StageSeconds;
use bowknot_baselines::Outcome;
use serde::{Deserialize, Serialize};
use std::time::Instant;

/// CPU seconds below which a solve is repeated, with warm buffers, until that many have passed.
const SHORT: f64 = 0.1;
/// Solves at most for that.
const REPEATS: usize = 20;
/// CPU seconds above which a solve is measured in the first round alone.
const LONG: f64 = 1.0;

/// What a method did with a problem, and how good its result is.
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
    pub judged: Judged,
}

/// [`StageSeconds`].
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

/// What results are judged against.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Against {
    /// The exact solution where there is one: up to a minute a problem.
    Exact,
    /// Nothing but themselves: stationarity and violation.
    Residuals,
}

/// Solves every case by every setting, each solve a measurement of its own that all figures share. In each of `rounds`
/// the settings take turns, so that a busy machine slows all alike; times are medians over rounds. Of a case for which
/// there was no time nothing is returned, so that settings are always compared on the same cases.
pub fn compare(
    bench: &Bench,
    cases: &[&Case],
    settings: &[Setting],
    rounds: usize,
    against: Against,
) -> Result<Vec<Option<Vec<Solved>>>> {
    let mut solved: Vec<Vec<Vec<Solved>>> = vec![vec![Vec::new(); settings.len()]; cases.len()];
    for round in 0..rounds {
        for (case, solved) in cases.iter().zip(&mut solved) {
            let mut judgement = None;
            for (setting, solved) in settings.iter().zip(solved) {
                if solved.first().is_some_and(|first| first.cpu_seconds > LONG) {
                    continue;
                }
                let key = |kind: &str| format!("{kind}/{}/{}/{round}", case.name, setting.key());
                let found = bench.store.find(&key("solve"));
                // What was judged by the exact solution is as good as what was not.
                let (found, key) = match against {
                    Against::Exact => (found, key("solve")),
                    Against::Residuals => {
                        (found.or_else(|| bench.store.find(&key("residuals"))), key("residuals"))
                    }
                };
                if let Some(found) = found {
                    solved.push(found);
                } else if bench.has_time() {
                    let judgement = match &judgement {
                        Some(judgement) => judgement,
                        None => judgement.insert(match against {
                            Against::Exact => Judgement::new(bench, case)?,
                            Against::Residuals => Judgement::of_residuals(case)?,
                        }),
                    };
                    solved.push(bench.store.measured(&key, || solve(bench, case, setting, judgement))?);
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

fn solve(bench: &Bench, case: &Case, setting: &Setting, judgement: &Judgement) -> Result<Solved> {
    let mut params = setting.params.clone();
    params.solver.stop.max_seconds = Some(setting.limit(bench.size));
    let mut method = (setting.build)(case.scene(params)?)?;
    let call = case.states.input();
    let (mut cpu, mut wall) = (Vec::new(), Vec::new());
    let mut ended: (Outcome, Vec<_>) = (Outcome::default(), Vec::new());
    // The first solve of a short one is to warm caches and buffers.
    while cpu.len() < 2 || (cpu.iter().sum::<f64>() < SHORT && cpu.len() < REPEATS) {
        let mut x = case.states.x.clone();
        let (wall_clock, cpu_clock) = (Instant::now(), cpu_seconds());
        let outcome = method.solve(&mut x, &case.states.y, &call)?;
        cpu.push(cpu_seconds() - cpu_clock);
        wall.push(wall_clock.elapsed().as_secs_f64());
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
        judged: judgement.judge(&x)?,
    })
}
