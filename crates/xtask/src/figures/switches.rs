//! What each part of `fast` is worth: the preset with one switch thrown.

use super::command::{Bench, Outcome, Size, Variant};
use super::scenes::{Lengths, recorded};
use super::table::{Table, short};

/// What is said of a switch, and the keys that throw it.
const SWITCHES: [(&str, &[&str]); 15] = [
    ("`fast`", &[]),
    ("volume form", &["contact.form=volume"]),
    ("linear edges", &["contact.edge_form=linear"]),
    ("edges limited from the start of the call", &["contact.edge_reference=start"]),
    ("isotropic bound", &["contact.bound=isotropic"]),
    ("one budget for all", &["contact.budget=uniform", "contact.budget_min=1", "contact.budget_max=2"]),
    ("no floor", &["contact.floor=0"]),
    ("no swept search", &["contact.swept_travel=inf"]),
    ("rows from 4 delta", &["contact.range=4"]),
    ("1 sweep", &["solver.sweeps=1"]),
    ("no further sweeps", &["solver.polish_sweeps=8"]),
    ("no proximal term", &["solver.edge_proximal=0", "solver.contact_proximal=0"]),
    ("no coarse correction", &["solver.coarse_correction=false"]),
    ("all rows swept", &["solver.active_rows=false"]),
    ("no rule for balance", &["solver.stop.imbalance=1e9"]),
];

pub fn section(bench: &Bench) -> Result<String, String> {
    let (count, repeats, limit) = if bench.size == Size::Full { (3, 1, 6) } else { (1, 1, 2) };
    let lengths = Lengths::Paper;
    let variants: Vec<Variant> =
        SWITCHES.iter().map(|(name, keys)| variant(name, keys, limit, lengths)).collect();
    let scenes = recorded(bench, lengths, count)?;
    let mut header = vec!["variant".to_owned()];
    let mut columns = Vec::new();
    for scene in &scenes {
        header.extend([format!("{}: steps", scene.name), "CPU s".to_owned(), "to target, mm".to_owned()]);
        columns.push(bench.replay(&scene.states, &variants, repeats)?);
    }
    let header: Vec<&str> = header.iter().map(String::as_str).collect();
    let mut table = Table::new(&header);
    for (v, variant) in variants.iter().enumerate() {
        let cells = columns.iter().flat_map(|outcomes| cells(&outcomes[v]));
        table.row(std::iter::once(variant.name.clone()).chain(cells));
    }
    Ok(format!(
        "`fast` with one switch thrown, on {count} problems of each scene, contact distance 1 mm; means. A star: not all calls\n\
         met the stopping rule within {limit} s and the limit on steps. The volume form and the gap form are the first two\n\
         rows. A switch that helps here may be needed elsewhere: these are few problems.\n\n{}",
        table.markdown()
    ))
}

fn variant(name: &str, keys: &[&str], limit: u32, lengths: Lengths) -> Variant {
    let sets: Vec<&str> = keys.iter().flat_map(|key| ["--set", key]).collect();
    Variant::new(name, &format!("--max-seconds {limit}")).with(lengths.options()).with(&sets)
}

fn cells(outcomes: &[Outcome]) -> [String; 3] {
    let mean = |value: fn(&Outcome) -> f64| outcomes.iter().map(value).sum::<f64>() / outcomes.len() as f64;
    let star = if outcomes.iter().all(|o| o.converged) { "" } else { "\\*" };
    [
        format!("{}{star}", short(mean(|o| o.steps))),
        short(mean(|o| o.cpu_seconds)),
        short(mean(|o| o.distance_mm)),
    ]
}
