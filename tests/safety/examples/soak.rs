//! Draws problems for minutes or hours and judges each accepted step: `cargo xtask soak` runs it.
//!
//! A failure ends it: it prints the smallest case that it finds, and how to draw it again.

#![allow(clippy::print_stdout, clippy::print_stderr, reason = "a report is what it is for")]

use bowknot_safety::search::{Failure, Seed, search_one};
use bowknot_safety::{Scenario, Tally, check, scenario};
use std::process::ExitCode;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{Sender, channel};
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

const USAGE: &str = "\
Usage: cargo xtask soak [--minutes N] [--seed S] [--jobs J] [--generated]
       cargo xtask soak --replay SEED [--generated]

--minutes N    how long [default: 10]
--seed S       seed of all problems [default: from the clock]
--jobs J       number of problems at a time, on a thread each [default: 1]
--generated    large generated states only, instead of mostly small pieces
--replay SEED  draw, check and shrink one problem again, by the seed that its failure printed";

/// How often the counts are printed.
const INTERVAL: Duration = Duration::from_secs(60);

struct Options {
    minutes: f64,
    seed: u64,
    jobs: usize,
    generated: bool,
    replay: Option<Seed>,
}

impl Options {
    fn parse(arguments: &[String]) -> Result<Self, String> {
        let clock = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |time| time.as_nanos() as u64);
        let mut options = Self { minutes: 10.0, seed: clock, jobs: 1, generated: false, replay: None };
        let mut rest = arguments.iter().map(String::as_str);
        while let Some(name) = rest.next() {
            if name == "--generated" {
                options.generated = true;
                continue;
            }
            let value = rest.next().ok_or_else(|| format!("{name}: a value is missing, or it is unknown"))?;
            let wrong = || format!("{name}: cannot read {value}");
            match name {
                "--minutes" => {
                    let minutes =
                        value.parse().ok().filter(|minutes: &f64| minutes.is_finite() && *minutes > 0.0);
                    options.minutes = minutes.ok_or_else(wrong)?;
                }
                "--seed" => options.seed = value.parse().map_err(|_| wrong())?,
                "--jobs" => {
                    options.jobs = value.parse().ok().filter(|&jobs| jobs > 0).ok_or_else(wrong)?;
                }
                "--replay" => options.replay = Some(Seed::parse(value).ok_or_else(wrong)?),
                _ => return Err(format!("unknown argument {name}")),
            }
        }
        Ok(options)
    }

    fn search(&self, seed: Seed) -> Result<Tally, Box<Failure>> {
        if self.generated {
            search_one(seed, &scenario::generated(), check)
        } else {
            search_one(seed, &scenario::any(), check)
        }
    }

    fn draw(&self, seed: Seed) -> Option<Scenario> {
        if self.generated { seed.draw(&scenario::generated()) } else { seed.draw(&scenario::any()) }
    }
}

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let options = match Options::parse(&arguments) {
        Ok(options) => options,
        Err(message) => {
            eprintln!("{message}\n\n{USAGE}");
            return ExitCode::from(2);
        }
    };
    // Only the smallest case counts, not the panics on the way to it.
    std::panic::set_hook(Box::new(|_| {}));
    match options.replay {
        Some(seed) => replay(&options, seed),
        None => soak(&options),
    }
}

fn replay(options: &Options, seed: Seed) -> ExitCode {
    println!("as drawn: {:#?}", options.draw(seed));
    match options.search(seed) {
        Ok(tally) => {
            println!("no failure: {tally:?}");
            ExitCode::SUCCESS
        }
        Err(failure) => {
            println!("{failure}");
            ExitCode::FAILURE
        }
    }
}

fn soak(options: &Options) -> ExitCode {
    println!("seed {}, {} jobs, {} minutes", options.seed, options.jobs, options.minutes);
    let start = Instant::now();
    let end = start + Duration::from_secs_f64(60.0 * options.minutes);
    let (next, stop) = (AtomicU64::new(0), AtomicBool::new(false));
    let (mut total, mut failed) = (Tally::default(), None);
    std::thread::scope(|scope| {
        let (sender, results) = channel();
        for _ in 0..options.jobs {
            let (sender, next, stop) = (sender.clone(), &next, &stop);
            scope.spawn(move || work(options, end, next, stop, &sender));
        }
        drop(sender);
        let mut printed = start;
        for result in results {
            match result {
                Ok(tally) => total = total.and(tally),
                Err(failure) => {
                    stop.store(true, Ordering::Relaxed);
                    failed.get_or_insert(failure);
                }
            }
            if printed.elapsed() > INTERVAL {
                printed = Instant::now();
                print(&total, start);
            }
        }
    });
    print(&total, start);
    let Some(failure) = failed else {
        println!("no failure");
        return ExitCode::SUCCESS;
    };
    let generated = if options.generated { " --generated" } else { "" };
    println!("{failure}\nreplay: cargo xtask soak --replay {}{generated}", failure.seed);
    ExitCode::FAILURE
}

/// Checks one problem after the other on a single thread, until the end or a failure.
fn work(
    options: &Options,
    end: Instant,
    next: &AtomicU64,
    stop: &AtomicBool,
    results: &Sender<Result<Tally, Box<Failure>>>,
) {
    let Ok(pool) = rayon::ThreadPoolBuilder::new().num_threads(1).build() else { return };
    while Instant::now() < end && !stop.load(Ordering::Relaxed) {
        let seed = Seed::new(options.seed, next.fetch_add(1, Ordering::Relaxed));
        // Sending fails only once the receiver is gone.
        let _ = results.send(pool.install(|| options.search(seed)));
    }
}

fn print(total: &Tally, start: Instant) {
    let Tally { cases, unusable, refused, moved, steps } = total;
    println!(
        "{:.0} s: {cases} cases ({unusable} intersect at the start, {refused} refused), {moved} moved, \
         {steps} accepted steps judged",
        start.elapsed().as_secs_f64()
    );
}
