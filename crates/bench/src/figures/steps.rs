//! The number of two-way steps of a problem, and of searches (paper, sections 3.1 and 7).

use crate::bench::Bench;
use crate::chart::{Axis, Chart, Series, Style};
use crate::figure::{Figure, Part, Report, verdict};
use crate::methods::Setting;
use crate::record::PROBLEM_SETS;
use crate::solve::Against;
use crate::summary::{Compared, on_scenes, table};
use crate::table::{Table, median, short};
use crate::targets::Targets;
use anyhow::Result;

pub struct Steps;

/// Upper ends of the classes of the histogram; the last class is open.
const CLASSES: [usize; 10] = [1, 2, 4, 8, 16, 32, 64, 128, 512, usize::MAX];

impl Figure for Steps {
    fn name(&self) -> &'static str {
        "steps"
    }

    fn title(&self) -> &'static str {
        "Steps per problem, and searches per step"
    }

    fn question(&self) -> &'static str {
        "The paper says that its method \"is able to converge within 64 steps most of the time\" \
         (section 7) with \"approximately one proximity search every three steps\" (section 3.1). All \
         recorded problems of all scenes, with either preset."
    }

    fn run(&self, bench: &Bench) -> Result<Report> {
        let scenes: Vec<&'static str> = bench.size.pick(
            PROBLEM_SETS.iter().map(|set| set.name).collect(),
            vec!["needle", "stack", "tube", "reef-knot", "sand", "needle-unaware", "stack-unaware"],
            vec!["needle", "needle-unaware"],
        );
        let settings = [Setting::of("fast")?, Setting::of("paper")?];
        let compared =
            on_scenes(bench, &scenes, bench.size.pick(10, 3, 2), &settings, 1, Against::Residuals)?;
        let classes = histogram(&compared);
        let mut counts = Table::new(["steps_up_to", "fast_problems", "paper_problems"]);
        for (class, [fast, paper]) in CLASSES.iter().zip(&classes) {
            counts.row([label(*class).into(), (*fast).into(), (*paper).into()]);
        }
        let series = |k: usize, name| {
            let shift = 0.2 * (2.0 * k as f64 - 1.0);
            let bars = classes.iter().enumerate().map(|(c, counts)| (c as f64 + shift, counts[k] as f64));
            Series::new(name, Style::Bars, bars)
        };
        let chart = Chart {
            title: "steps per problem".to_owned(),
            x: Axis::classes("two-way steps, up to", CLASSES.iter().map(|c| label(*c)).collect()),
            y: Axis::linear("problems"),
            series: vec![series(0, "fast"), series(1, "paper")],
            front: false,
        };
        let name = self.name().to_owned();
        Ok(Report {
            finding: finding(&compared),
            parts: vec![
                Part::Chart { name: name.clone(), chart },
                Part::table(
                    name.clone(),
                    "all recorded problems with either preset",
                    table(&compared, |_| true),
                ),
                Part::table(format!("{name}-histogram"), "number of problems by their steps", counts),
            ],
        })
    }
}

fn label(class: usize) -> String {
    if class == usize::MAX { "more".to_owned() } else { class.to_string() }
}

/// Steps of all problems with `fast` (0) or `paper` (1).
fn steps(compared: &[Compared], setting: usize) -> impl Iterator<Item = usize> + '_ {
    compared.iter().flat_map(|c| &c.solved).map(move |row| row[setting].steps)
}

fn histogram(compared: &[Compared]) -> Vec<[usize; 2]> {
    let mut counts = vec![[0; 2]; CLASSES.len()];
    for setting in 0..2 {
        for steps in steps(compared, setting) {
            let class = CLASSES.iter().position(|most| steps <= *most).unwrap_or(CLASSES.len() - 1);
            counts[class][setting] += 1;
        }
    }
    counts
}

fn finding(compared: &[Compared]) -> String {
    let (unaware, aware): (Vec<Compared>, Vec<Compared>) =
        compared.iter().cloned().partition(|c| Targets::of(c.scene) == Targets::Unaware);
    let text = |group: &[Compared], setting: usize, name: &str| {
        let steps: Vec<usize> = steps(group, setting).collect();
        let within = steps.iter().filter(|&&s| s <= 64).count();
        let middle = median(&steps.iter().map(|&s| s as f64).collect::<Vec<_>>());
        let searches: usize = group.iter().flat_map(|c| &c.solved).map(|row| row[setting].searches).sum();
        let total = steps.iter().sum::<usize>().max(1);
        let every = total as f64 / searches.max(1) as f64;
        format!(
            "`{name}` takes at most 64 steps in {within} of {} problems (median {}) and searches once in {} \
             steps",
            steps.len(),
            short(middle),
            short(every)
        )
    };
    let both = |group: &[Compared]| format!("{}; {}", text(group, 1, "paper"), text(group, 0, "fast"));
    let all: Vec<usize> = steps(compared, 1).collect();
    let most = 2 * all.iter().filter(|&&s| s <= 64).count() > all.len();
    format!(
        "{} for steps. Contact-unaware targets: {}. Contact-aware targets: {}. (The paper: most of the \
         time, once in three.)",
        verdict(most),
        both(&unaware),
        both(&aware)
    )
}
