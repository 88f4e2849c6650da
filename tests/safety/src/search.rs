//! Any number of problems from a seed, each of which can be drawn again by its own seed.
//!
//! A seed draws another problem as soon as the strategies change. So the smallest case of a failure is kept
//! as a test of its own, named by its symptom, and not its seed.

use crate::{Random, Scenario, Tally};
use proptest::strategy::Strategy;
use proptest::test_runner::{Config, RngAlgorithm, TestError, TestRng, TestRunner};
use std::fmt;

/// The seed of one problem.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Seed([u8; 32]);

impl Seed {
    /// The seed of the problem with the number `index` of those from `seed`.
    pub fn new(seed: u64, index: u64) -> Self {
        let mut random = Random::new(seed ^ Random::new(index).bits());
        let mut bytes = [0; 32];
        bytes.chunks_mut(8).for_each(|chunk| chunk.copy_from_slice(&random.bits().to_le_bytes()));
        Self(bytes)
    }

    /// The seed that [`fmt::Display`] writes; none for another text.
    pub fn parse(text: &str) -> Option<Self> {
        let text = text.trim().as_bytes();
        if text.len() != 64 {
            return None;
        }
        let mut bytes = [0; 32];
        for (byte, digits) in bytes.iter_mut().zip(text.chunks(2)) {
            *byte = u8::from_str_radix(std::str::from_utf8(digits).ok()?, 16).ok()?;
        }
        Some(Self(bytes))
    }

    fn runner(self) -> TestRunner {
        let mut config = Config { failure_persistence: None, ..Config::default() };
        // Unless `PROPTEST_MAX_SHRINK_ITERS` is set.
        if config.max_shrink_iters == u32::MAX {
            config.max_shrink_iters = 20_000;
        }
        TestRunner::new_with_rng(config, TestRng::from_seed(RngAlgorithm::ChaCha, &self.0))
    }

    /// The problem that a strategy draws from the seed.
    pub fn draw(self, strategy: &impl Strategy<Value = Scenario>) -> Option<Scenario> {
        use proptest::strategy::ValueTree;
        strategy.new_tree(&mut self.runner()).ok().map(|tree| tree.current())
    }
}

impl fmt::Display for Seed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.iter().try_for_each(|byte| write!(f, "{byte:02x}"))
    }
}

/// A problem that fails, and how small it can be made.
#[derive(Clone, Debug)]
pub struct Failure {
    /// Its seed.
    pub seed: Seed,
    /// The smallest problem found that fails as well.
    pub minimal: Scenario,
    /// How that one fails.
    pub reason: String,
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}\nseed: {}\nsmallest case: {:#?}", self.reason, self.seed, self.minimal)
    }
}

/// Draws one problem and checks it. If it fails, looks for a smaller one that does. A panic is a failure.
///
/// # Errors
/// The smallest problem that fails.
pub fn search_one(
    seed: Seed,
    strategy: &impl Strategy<Value = Scenario>,
    check: impl Fn(&Scenario) -> Result<Tally, String>,
) -> Result<Tally, Box<Failure>> {
    let mut runner = seed.runner();
    let Ok(tree) = strategy.new_tree(&mut runner) else { return Ok(Tally::default()) };
    let tally = std::cell::Cell::new(Tally::default());
    let outcome = runner.run_one(tree, |scenario| {
        let checked = check(&scenario).map_err(proptest::test_runner::TestCaseError::fail)?;
        tally.set(checked);
        Ok(())
    });
    match outcome {
        Ok(_) => Ok(tally.get()),
        Err(TestError::Fail(reason, minimal)) => {
            Err(Box::new(Failure { seed, minimal, reason: reason.message().to_owned() }))
        }
        Err(TestError::Abort(_)) => Ok(tally.get()),
    }
}

/// Checks `count` problems from `seed`, by all threads. Each task makes a strategy of its own.
///
/// # Errors
/// The first failure.
pub fn search_many<S: Strategy<Value = Scenario>>(
    seed: u64,
    count: u64,
    strategy: impl Fn() -> S + Sync,
    check: impl Fn(&Scenario) -> Result<Tally, String> + Sync,
) -> Result<Tally, Box<Failure>> {
    use rayon::prelude::*;
    (0..count)
        .into_par_iter()
        .map(|index| search_one(Seed::new(seed, index), &strategy(), &check))
        .try_reduce(Tally::default, |a, b| Ok(a.and(b)))
}

/// Share of `count` problems from `seed` that fail, without a search for smaller ones.
pub fn failing_share<S: Strategy<Value = Scenario>>(
    seed: u64,
    count: u64,
    strategy: impl Fn() -> S + Sync,
    check: impl Fn(&Scenario) -> Result<Tally, String> + Sync,
) -> f64 {
    use rayon::prelude::*;
    let fails = |index: &u64| {
        Seed::new(seed, *index).draw(&strategy()).is_some_and(|scenario| check(&scenario).is_err())
    };
    (0..count).into_par_iter().filter(fails).count() as f64 / count as f64
}
