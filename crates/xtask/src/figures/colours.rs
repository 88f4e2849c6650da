//! How many colours the sweeps need.

use super::command::{Bench, Size};
use super::scenes::{Lengths, recorded};
use super::table::{Table, mean_max, short};

pub fn section(bench: &Bench) -> Result<String, String> {
    let count = if bench.size == Size::Full { 6 } else { 2 };
    let mut table =
        Table::new(&["problems", "preset", "contact rows", "contact colours", "edge rows", "edge colours"]);
    let mut contacts: f64 = 0.0;
    let mut edges: f64 = 0.0;
    for scene in recorded(bench, Lengths::Default, count)? {
        // Lines of preset, contact rows and colours, edge rows and colours.
        let text = bench.example("bowknot", "colours", &scene.states)?;
        for preset in ["fast", "paper"] {
            let lines: Vec<Vec<&str>> = text
                .lines()
                .map(|line| line.split_whitespace().collect())
                .filter(|words: &Vec<&str>| words.first() == Some(&preset))
                .collect();
            let column = |k: usize| -> Vec<f64> {
                lines.iter().filter_map(|words| words.get(k)?.parse().ok()).collect()
            };
            contacts = column(2).into_iter().fold(contacts, f64::max);
            edges = column(4).into_iter().fold(edges, f64::max);
            let name = format!("{}, {}", scene.name, lines.len());
            table.row([name, preset.to_owned()].into_iter().chain((1..=4).map(|k| mean_max(&column(k)))));
        }
    }
    Ok(format!(
        "`cargo run --release -p bowknot --example colours -- STATES.npz...` on the recorded problems, first backward step,\n\
         default lengths; mean (max). The paper needs 50-300 colours for contacts and 9-15 for edges. First fit has 256\n\
         colours; a row that finds none of them free is a colour of its own, swept alone.\n\n{}\nThe most are \
         {} for contacts and {} for edges.\n",
        table.markdown(),
        short(contacts),
        short(edges)
    ))
}
