//! Results in the documentation: the page docs/benchmarks.md, tables and charts in docs/benchmarks.
//!
//! They are written from a clean git tree only, so that the commit beside each result is the code that was
//! measured.

use crate::chart;
use crate::figure::{Figure, Part, Report};
use crate::files::write;
use crate::machine::WITH_CHANGES;
use crate::pages::{BENCHMARKS, FILMS, FOLDER, GALLERY, README, STABILITY};
use crate::{front, git, page};
use anyhow::{Context, Result, bail, ensure};
use std::fs;
use std::path::{Path, PathBuf};

/// The documentation in a repository.
#[derive(Debug)]
pub struct Docs {
    repository: PathBuf,
}

impl Docs {
    /// The documentation of the repository in `repository`.
    pub fn new(repository: &Path) -> Self {
        Self { repository: repository.to_owned() }
    }

    /// Refuses a tree with files that differ from the commit or are not tracked. Results that other figures
    /// have written do not count.
    ///
    /// # Errors
    /// If the tree is not clean, or is no git tree.
    pub fn ensure_clean(&self) -> Result<()> {
        let exclude =
            [BENCHMARKS, FILMS, FOLDER, GALLERY, README, STABILITY].map(|path| format!(":(exclude){path}"));
        let mut arguments = vec!["status", "--porcelain", "--", "."];
        arguments.extend(exclude.iter().map(String::as_str));
        let Some(changes) = git::output(&self.repository, &arguments) else {
            bail!("{} is no git tree: {BENCHMARKS} has to name the commit", self.repository.display());
        };
        ensure!(
            changes.is_empty(),
            "results are written from a clean git tree only, so that its commits are those of the code; \
             commit these files first, or measure with --quick:\n{changes}"
        );
        Ok(())
    }

    /// Writes a figure's results: on the page its text and tables, or its rows of the index and the tables as
    /// CSV; the charts as SVG. `order` has the names of all figures in the order of the index.
    ///
    /// # Errors
    /// If the tree is not clean, if something was measured in a tree that was not, if nothing was measured, or if a
    /// file cannot be written.
    pub fn publish(
        &self,
        figure: &dyn Figure,
        report: &Report,
        conditions: &str,
        order: &[&str],
    ) -> Result<()> {
        self.ensure_clean()?;
        ensure!(
            !conditions.contains(WITH_CHANGES),
            "{} is not written: measurements of {} come from a tree that was not clean ({conditions}); \
             remove them",
            figure.page(),
            figure.name()
        );
        let measured = report.parts.iter().any(|part| match part {
            Part::Table { table, .. } | Part::File { table, .. } => !table.is_empty(),
            Part::Chart { .. } => false,
        });
        ensure!(measured, "{} is not written: nothing of {} was measured", figure.page(), figure.name());
        let path = self.repository.join(figure.page());
        let page = fs::read_to_string(&path).with_context(|| format!("cannot read {}", path.display()))?;
        let page = if figure.on_page() {
            page::with_section(
                &page,
                figure.name(),
                &page::section(figure, report, conditions, "benchmarks/"),
            )
        } else {
            page::with_index_rows(&page, figure.name(), &page::index_rows(figure, report, conditions), order)
        };
        let page = page.with_context(|| path.display().to_string())?;
        let folder = self.repository.join(FOLDER);
        for part in &report.parts {
            match part {
                Part::Table { name, table, .. } if !figure.on_page() => {
                    write(&folder.join(format!("{name}.csv")), &table.csv())?;
                }
                Part::Table { .. } => {}
                Part::File { name, table, .. } => write(&folder.join(format!("{name}.csv")), &table.csv())?,
                Part::Chart { name, chart } => {
                    write(&folder.join(format!("{name}.svg")), &chart::svg(chart))?;
                }
            }
        }
        write(&path, &page)?;
        front::rewrite(&self.repository)
    }
}

#[cfg(test)]
mod tests;
