//! Measures a figure, keeps its results in the run's folder, and publishes those of a full run.

use crate::bench::{Bench, Size};
use crate::chart;
use crate::docs::Docs;
use crate::figure::{Figure, Part};
use crate::files::write;
use crate::machine::Machine;
use crate::page;
use anyhow::{Context, Result};

/// Measures a figure: tables as CSV, charts as SVG, all of it as `report.md`. A full run publishes it in
/// `docs`; `order` has the names of all figures in the order of the page.
pub fn measure(bench: &Bench, docs: &Docs, figure: &dyn Figure, order: &[&str]) -> Result<()> {
    bench.begin_figure();
    let load = Machine::load();
    println!("{}: {}", figure.name(), figure.title());
    let report = figure.run(bench).with_context(|| format!("figure {}", figure.name()))?;
    let folder = bench.out().join(figure.name());
    for part in &report.parts {
        match part {
            Part::Table { name, table, .. } | Part::File { name, table, .. } => {
                write(&folder.join(format!("{name}.csv")), &table.csv())?
            }
            Part::Chart { name, chart } => write(&folder.join(format!("{name}.svg")), &chart::svg(chart))?,
        }
    }
    println!("  {}\n  {:.0} s, {}", report.finding, bench.figure_seconds(), folder.display());
    let conditions = bench.conditions(&load);
    write(&folder.join("report.md"), &page::section(figure, &report, &conditions, ""))?;
    if bench.size == Size::Full && bench.cases.is_none() {
        docs.publish(figure, &report, &conditions, order)?;
    }
    Ok(())
}
