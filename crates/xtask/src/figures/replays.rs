//! The presets against each other on recorded collision problems.

use super::command::{Bench, Outcome, Size, Variant};
use super::scenes::{CPU_GOAL, Lengths, Recorded, recorded};
use super::table::{Table, largest, mean, mean_max, short, smallest, verdict};

pub fn presets(bench: &Bench) -> Result<String, String> {
    let mut text = String::from(
        "`fast` ran each scene with `--record`; `resolve` then solved some of the recorded problems, spread evenly over the\n\
         time steps in contact, by either preset, `paper` with its own limit on steps. Columns: two-way steps, mean (max);\n\
         searches and CPU seconds, means; calls that met their stopping rule; RMS distance to the target, mean; distance not\n\
         travelled, largest; stretch against the *start of the call*, largest; gap, smallest. `fast` limits edges against rest,\n\
         `paper` against the start: an edge that was short may exceed 1.1 by the first and not by the second. A smaller distance\n\
         to the target at a larger stretch is not a better result.\n\n",
    );
    for (lengths, title) in [
        (Lengths::Paper, "With the paper's contact distance, 1 mm (`--set contact.delta=0.001`):"),
        (
            Lengths::Default,
            "With default lengths, a contact distance of a tenth of an edge, 2 mm: easier for both, for `paper` above all.",
        ),
    ] {
        text.push_str(&format!("{title}\n\n{}\n", compare(bench, lengths)?));
    }
    Ok(text)
}

fn compare(bench: &Bench, lengths: Lengths) -> Result<String, String> {
    let (count, repeats, limit) = if bench.size == Size::Full { (6, 3, 60) } else { (2, 1, 5) };
    let scenes = recorded(bench, lengths, count)?;
    let options = lengths.options();
    let mut variants = vec![
        Variant::new("fast", &format!("--preset fast --max-seconds {limit}")).with(options),
        Variant::new("paper", &format!("--preset paper --max-seconds {limit}")).with(options),
    ];
    if lengths == Lengths::Paper {
        let gap = format!("--preset paper --max-seconds {limit} --set contact.form=gap");
        variants.push(Variant::new("paper, gap form", &gap).with(options));
    }
    let mut details = Table::new(&[
        "problems",
        "preset",
        "steps",
        "searches",
        "CPU s",
        "met rule",
        "to target, mm",
        "not travelled, mm",
        "stretch",
        "gap, mm",
    ]);
    let mut ratios = Table::new(&[
        "`paper` / `fast`",
        "steps, totals",
        "steps, geometric mean",
        "goal",
        "CPU, totals",
        "CPU, geometric mean",
        "goal",
        "prototype's steps",
    ]);
    let mut verdicts = Vec::new();
    let mut ended: [Vec<(Outcome, Outcome)>; 2] = Default::default();
    for scene in &scenes {
        let outcomes = bench.replay(&scene.states, &variants, repeats)?;
        for (variant, outcomes) in variants.iter().zip(&outcomes) {
            let name = format!("{}, {} vertices, {}", scene.name, short(scene.vertices), scene.states.len());
            details.row(detail(&name, &variant.name, outcomes));
        }
        let (fast, paper) = (&outcomes[0], &outcomes[1]);
        let steps = ratio(paper, fast, |o| o.steps);
        let cpu = ratio(paper, fast, |o| o.cpu_seconds);
        ratios.row(ratio_row(scene, &steps, &cpu));
        for (&paper, &fast) in paper.iter().zip(fast) {
            ended[usize::from(paper.converged)].push((paper, fast));
        }
        verdicts.push(format!(
            "{}: steps {}, CPU {}",
            scene.name,
            verdict(steps.totals, scene.goal.0, scene.goal.1),
            verdict(cpu.totals, CPU_GOAL.0, CPU_GOAL.1)
        ));
    }
    let [limited, met] = ended.map(|pairs| pairs.into_iter().unzip::<_, _, Vec<_>, Vec<_>>());
    Ok(format!(
        "{}\n{}\nBy totals, {}. {} {}\n",
        details.markdown(),
        ratios.markdown(),
        verdicts.join("; "),
        told("`paper` ran into its limit", &limited, scenes.len() * count),
        told("It met its rule", &met, scenes.len() * count)
    ))
}

/// What the two presets took where `paper` ended in one way. Mostly the totals are made by problems in which gaps close
/// up until nothing moves and `paper`, without a floor, spends all the steps it has.
fn told(how: &str, (paper, fast): &(Vec<Outcome>, Vec<Outcome>), of: usize) -> String {
    if paper.is_empty() {
        return format!("{how} in none of {of} problems.");
    }
    let mean = |outcomes: &[Outcome], value: fn(&Outcome) -> f64| {
        short(outcomes.iter().map(value).sum::<f64>() / outcomes.len() as f64)
    };
    let gaps: Vec<f64> = paper.iter().map(|o| o.gap_mm).collect();
    format!(
        "{how} in {} of {of} problems, with {} steps in the mean where `fast` took {}, {} CPU seconds against {}, and a smallest \
         gap of {} mm.",
        paper.len(),
        mean(paper, |o| o.steps),
        mean(fast, |o| o.steps),
        mean(paper, |o| o.cpu_seconds),
        mean(fast, |o| o.cpu_seconds),
        short(smallest(&gaps))
    )
}

fn detail(problems: &str, variant: &str, outcomes: &[Outcome]) -> Vec<String> {
    let of = |value: fn(&Outcome) -> f64| outcomes.iter().map(value).collect::<Vec<f64>>();
    let converged = outcomes.iter().filter(|o| o.converged).count();
    vec![
        problems.to_owned(),
        variant.to_owned(),
        mean_max(&of(|o| o.steps)),
        short(mean(&of(|o| o.searches))),
        short(mean(&of(|o| o.cpu_seconds))),
        format!("{converged} of {}", outcomes.len()),
        short(mean(&of(|o| o.distance_mm))),
        short(largest(&of(|o| o.remaining_mm))),
        short(largest(&of(|o| o.stretch))),
        short(smallest(&of(|o| o.gap_mm))),
    ]
}

/// How much more one variant takes than another.
struct Ratio {
    /// Of the sums over all problems.
    totals: f64,
    /// Of the ratios, problem by problem.
    geometric: f64,
}

fn ratio(more: &[Outcome], less: &[Outcome], value: fn(&Outcome) -> f64) -> Ratio {
    let total = |outcomes: &[Outcome]| outcomes.iter().map(value).sum::<f64>();
    let logs: Vec<f64> = more.iter().zip(less).map(|(a, b)| (value(a) / value(b)).ln()).collect();
    Ratio { totals: total(more) / total(less), geometric: mean(&logs).exp() }
}

fn ratio_row(scene: &Recorded, steps: &Ratio, cpu: &Ratio) -> Vec<String> {
    let times = |value: f64| format!("{}x", short(value));
    let goal = |(at_least, aim): (f64, f64)| format!("{at_least}x, aim {aim}x");
    vec![
        scene.name.to_owned(),
        times(steps.totals),
        times(steps.geometric),
        goal(scene.goal),
        times(cpu.totals),
        times(cpu.geometric),
        goal(CPU_GOAL),
        format!("{} / {}", scene.prototype.0, scene.prototype.1),
    ]
}
