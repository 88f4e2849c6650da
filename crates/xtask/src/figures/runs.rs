//! Figures of whole runs: the large needle, time by stage, memory, free flight, threads.

use super::command::{Bench, Run};
use super::machine::Machine;
use super::scenes::{Lengths, drape, needle as needle_spec, recorded, sphere, tiny};
use super::table::{Table, largest, mean, mean_max, percent, short, smallest, verdict};

/// Stages of a time step, as `stats.jsonl` names them.
const STAGES: [&str; 6] = ["search", "evaluate", "backward", "forward", "dynamics", "other"];
/// Those that collisions are to blame for.
const COLLISION: [&str; 4] = ["search", "evaluate", "backward", "forward"];

/// The needle of the paper's size, over the whole run.
pub fn needle(bench: &Bench) -> Result<String, String> {
    let run = bench.run(&needle_spec(bench.size))?;
    let steps = run.each(&["two_way_steps"]);
    let mut table = Table::new(&["", "here", "prototype"]);
    let mut row = |name: &str, here: String, prototype: &str| {
        table.row([name.to_owned(), here, prototype.to_owned()]);
    };
    row("two-way steps a time step", mean_max(&steps), "18 (33)");
    row("searches a time step", mean_max(&run.each(&["searches"])), "");
    row("CPU seconds a time step", mean_max(&run.each(&["cpu_seconds"])), "");
    row("not travelled, mm, largest", short(1e3 * largest(&run.each(&["remaining_m"]))), "under 0.05");
    row("stretch against rest, largest", short(largest(&run.each(&["max_stretch"]))), "under 1.14");
    row("stretch in a time step, largest", short(largest(&run.each(&["max_step_stretch"]))), "under 1.14");
    row("gap, mm, smallest", short(1e3 * smallest(&run.each(&["min_gap_m"]))), "above 0.7");
    let converged = run.sum(&["converged"]);
    row("time steps that met the rule", format!("{converged} of {}", run.steps.len()), "");
    let last = (steps.len() / 2).max(1);
    let (first, second) = steps.split_at(steps.len() - last);
    Ok(format!(
        "`bowknot run needle`, {} vertices, dt = 1/20 s, {} time steps.\n\n{}\n{} steps in the mean, {} than the prototype's 18. \
         The first half of the run, with the impact, takes {}, the second {}.\n",
        short(run.of("vertices")),
        run.steps.len(),
        table.markdown(),
        short(mean(&steps)),
        if mean(&steps) > 18.0 { "more" } else { "not more" },
        mean_max(first),
        mean_max(second)
    ))
}

/// Shares of wall time.
pub fn stages(bench: &Bench) -> Result<String, String> {
    let mut header = vec!["run", "wall s a time step"];
    header.extend(STAGES);
    let mut table = Table::new(&header);
    let mut runs = vec![("needle", bench.run(&needle_spec(bench.size))?)];
    let scenes = recorded(bench, Lengths::Default, 1)?;
    runs.extend(scenes.into_iter().filter(|s| s.name != "needle").map(|s| (s.name, s.run)));
    runs.push(("drape", bench.run(&drape(bench.size))?));
    let mut heaviest = Vec::new();
    for (name, run) in &runs {
        let total = run.sum(&["seconds", "total"]);
        let shares = STAGES.map(|stage| run.sum(&["seconds", stage]) / total);
        let (stage, share) =
            STAGES.iter().zip(shares).max_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or((&"", 0.0));
        heaviest.push(format!("{name} {stage} ({})", percent(share)));
        let name = format!("{name}, {} vertices", short(run.of("vertices")));
        let cells = [name, short(total / run.steps.len() as f64)];
        table.row(cells.into_iter().chain(shares.map(percent)));
    }
    Ok(format!(
        "Shares of whole runs, without `--check`, default lengths; search was 56-86 % in the prototype. *Evaluate* is the\n\
         distances of listed pairs between searches; those of fresh pairs belong to *search*.\n\n{}\nThe most goes to: {}.\n",
        table.markdown(),
        heaviest.join(", ")
    ))
}

/// Peak memory per vertex.
pub fn memory(bench: &Bench) -> Result<String, String> {
    let base = bench.run(&tiny())?.of("peak_memory_bytes");
    let mut runs = vec![("needle", bench.run(&needle_spec(bench.size))?)];
    let scenes = recorded(bench, Lengths::Default, 1)?;
    runs.extend(scenes.into_iter().filter(|s| s.name == "stack").map(|s| (s.name, s.run)));
    runs.push(("sphere", bench.run(&sphere(bench.size, 2))?));
    let header =
        ["run", "peak, MB", "less that of a tiny run", "kB a surface vertex", "pairs a vertex", "goal"];
    let mut table = Table::new(&header);
    let mut verdicts = Vec::new();
    let mut points = Vec::new();
    for (name, run) in &runs {
        let (peak, vertices) = (run.of("peak_memory_bytes"), run.of("vertices"));
        let each = (peak - base) / vertices / 1e3;
        let pairs = largest(&run.each(&["pairs"])) / vertices;
        table.row([
            format!("{name}, {} vertices", short(vertices)),
            short(peak / 1e6),
            short((peak - base) / 1e6),
            short(each),
            short(pairs),
            "under 3, aim 1.5".to_owned(),
        ]);
        verdicts.push(format!("{name} {}", verdict(-each, -3.0, -1.5)));
        points.push((pairs, each));
    }
    // Of the runs with the fewest and the most pairs.
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (few, many) = (points[0], points[points.len() - 1]);
    let bytes_per_pair = 1e3 * (many.1 - few.1) / (many.0 - few.0);
    Ok(format!(
        "Largest resident memory of a run without `--check`, default radii, less the {} MB of a run of a handful of vertices;\n\
         dynamics and its solver included. *Pairs*: most listed after a search.\n\n{}\nPer vertex, {}. From the run with\n\
         the fewest pairs to that with the most, each pair adds {} bytes; the rest, some {} kB, comes with the vertices.\n",
        short(base / 1e6),
        table.markdown(),
        verdicts.join("; "),
        short(bytes_per_pair),
        short(few.1 - 1e-3 * bytes_per_pair * few.0)
    ))
}

/// What collisions cost where there are none.
pub fn free_flight(bench: &Bench) -> Result<String, String> {
    let run = bench.run(&sphere(bench.size, 2))?;
    let rows = run.each(&["contact_rows"]);
    let flying = rows.iter().take_while(|&&count| count == 0.0).count();
    if flying < 2 {
        return Err("the sheet does not fly".to_owned());
    }
    // The first time step sets up its buffers.
    let of = |path: &[&str]| run.each(path)[1..flying].to_vec();
    let total: f64 = of(&["seconds", "total"]).iter().sum();
    let mut table = Table::new(&["stage", "ms a time step", "share"]);
    let mut collision = 0.0;
    for stage in STAGES {
        let seconds: f64 = of(&["seconds", stage]).iter().sum();
        if COLLISION.contains(&stage) {
            collision += seconds;
        }
        let each = 1e3 * seconds / (flying - 1) as f64;
        table.row([stage.to_owned(), short(each), percent(seconds / total)]);
    }
    let share = collision / total;
    table.row(["all of collisions".to_owned(), short(1e3 * collision / (flying - 1) as f64), percent(share)]);
    Ok(format!(
        "`bowknot run sphere`, {} vertices, time steps 2 to {flying}, before the sheet meets the ball. Goal: a share of collisions\n\
         under 10 %, aim 2 %.\n\n{}\n{}: {}. A time step takes {} two-way steps and {} searches, mean (max), with {} pairs \
         listed.\n",
        short(run.of("vertices")),
        table.markdown(),
        percent(share),
        verdict(-share, -0.1, -0.02),
        mean_max(&of(&["two_way_steps"])),
        mean_max(&of(&["searches"])),
        short(largest(&of(&["pairs"])))
    ))
}

/// Wall time of two threads against one.
pub fn threads(bench: &Bench) -> Result<String, String> {
    let (one, two) = (sphere(bench.size, 1), sphere(bench.size, 2));
    let load = Machine::load();
    // In turns, and of each time step the faster of two: another process may have been in the way.
    let mut runs: [Vec<Run>; 2] = [vec![bench.run(&one)?], vec![bench.run(&two)?]];
    runs[0].push(bench.run_again(&one)?);
    runs[1].push(bench.run_again(&two)?);
    let rows = runs[0][0].each(&["contact_rows"]);
    let fastest = |runs: &[Run], stage: &str, contact: bool| -> f64 {
        let all: Vec<Vec<f64>> = runs.iter().map(|run| run.each(&["seconds", stage])).collect();
        let counts = |k: usize| (rows[k] > 0.0) == contact && k > 0;
        (0..rows.len())
            .filter(|&k| counts(k))
            .map(|k| all.iter().map(|s| s[k]).fold(f64::INFINITY, f64::min))
            .sum()
    };
    let mut table = Table::new(&["", "1 thread, s", "2 threads, s", "ratio"]);
    let mut row = |name: &str, stage: &str, contact: bool| {
        let (a, b) = (fastest(&runs[0], stage, contact), fastest(&runs[1], stage, contact));
        table.row([name.to_owned(), short(a), short(b), short(a / b)]);
        a / b
    };
    row("whole steps in flight", "total", false);
    let whole = row("whole steps in contact", "total", true);
    for stage in ["search", "backward", "forward", "dynamics", "other"] {
        row(&format!("in contact: {stage}"), stage, true);
    }
    let energies = |run: &Run| run.each(&["energy", "elastic"]);
    let same = energies(&runs[0][0]) == energies(&runs[1][0]);
    let counted = rows.iter().filter(|&&count| count > 0.0).count();
    Ok(format!(
        "`bowknot run sphere`, {} vertices: wall seconds of {counted} time steps in contact, of each the faster of two runs. Goal for whole\n\
         steps: 1.6, aim 1.9. {}\n\n{}\n{}: {}. The load average was {load} at the start of these runs; above 1 or so, two\n\
         threads find no second core and the ratio says little.\n",
        short(runs[0][0].of("vertices")),
        if same { "Energies agree to the last bit." } else { "**Energies differ between the runs.**" },
        table.markdown(),
        short(whole),
        verdict(whole, 1.6, 1.9)
    ))
}
