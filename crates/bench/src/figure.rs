//! What a figure is, and what it reports: a finding, tables and charts.

use crate::bench::Bench;
use crate::chart::Chart;
use crate::pages;
use crate::table::Table;
use anyhow::Result;

/// A figure or table.
pub trait Figure: Sync {
    /// What the command calls it.
    fn name(&self) -> &'static str;
    /// Its heading.
    fn title(&self) -> &'static str;
    /// The question that it answers, and how it is measured.
    fn question(&self) -> &'static str;
    /// Whether its page shows its text and its tables. The index of docs/benchmarks.md lists the files of all
    /// other figures.
    fn on_page(&self) -> bool {
        false
    }
    /// The page that publishes it, from the root of the repository.
    fn page(&self) -> &'static str {
        pages::BENCHMARKS
    }
    /// Measures it.
    ///
    /// # Errors
    /// If a scene, a solve or a file fails.
    fn run(&self, bench: &Bench) -> Result<Report>;
}

/// What a figure found.
#[derive(Clone, Debug, Default)]
pub struct Report {
    /// One or two sentences: whether the paper's finding is reproduced, with the ratio; if it is not, why.
    pub finding: String,
    pub parts: Vec<Part>,
}

/// A part of a report.
#[derive(Clone, Debug)]
pub enum Part {
    /// A table, NAME.csv; `shows` says in one line what is in it, and may be empty for figures on the page.
    Table { name: String, shows: String, table: Table },
    /// A table that the page links as NAME.csv and does not show; `shows` says in one line what is in it.
    File { name: String, shows: String, table: Table },
    /// A chart, NAME.svg.
    Chart { name: String, chart: Chart },
}

impl Part {
    pub fn table(name: impl Into<String>, shows: impl Into<String>, table: Table) -> Self {
        Self::Table { name: name.into(), shows: shows.into(), table }
    }

    pub fn file(name: impl Into<String>, shows: impl Into<String>, table: Table) -> Self {
        Self::File { name: name.into(), shows: shows.into(), table }
    }
}

/// The first words of a finding that compares with the paper's.
pub fn verdict(reproduced: bool) -> &'static str {
    if reproduced { "The paper's finding is reproduced" } else { "The paper's finding is not reproduced" }
}
