//! The first section of docs/benchmarks.md: what Bowknot was compared with, in at most eight rows, of which the README
//! shows three.
//!
//! Rows are read from the tables in docs/benchmarks. One that the page calls stale, or that is not there, gives no row:
//! no figure is carried forward.

use crate::age::MARK;
use crate::docs::FOLDER;
use crate::files::write;
use crate::page;
use crate::pages::{BENCHMARKS, README};
use crate::table::{Table, geometric_mean, largest, smallest, times};
use anyhow::{Context, Result};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

/// The block of the page.
const NAME: &str = "front";
/// Scenes whose charts it shows.
const CHARTS: [&str; 6] = ["needle", "stack", "tube", "bow-knot", "reef-knot", "dress"];

/// Writes the section, and the rows of the README, anew from the tables of the repository at `root`.
///
/// # Errors
/// If a page lacks its block, or a table is not what the figures write.
pub fn rewrite(root: &Path) -> Result<()> {
    for (path, text) in rewritten(root)? {
        let path = root.join(path);
        if fs::read_to_string(&path).is_ok_and(|before| before != text) {
            write(&path, &text)?;
        }
    }
    Ok(())
}

/// The two pages as they are to be.
fn rewritten(root: &Path) -> Result<[(&'static str, String); 2]> {
    let read =
        |page: &str| fs::read_to_string(root.join(page)).with_context(|| format!("cannot read {page}"));
    let (page, readme) = (read(BENCHMARKS)?, read(README)?);
    let published = Published { root, page: &page };
    let comparisons = comparisons(&published)?;
    let section = section(&published, &comparisons);
    let rows = readme_rows(&comparisons);
    Ok([
        (BENCHMARKS, page::with_section(&page, NAME, &section)?),
        (README, page::with_section(&readme, NAME, &rows)?),
    ])
}

/// One row of the section.
struct Comparison {
    with: String,
    on: String,
    time: String,
    error: String,
    intersections: String,
    origin: String,
    /// Whether the README shows it.
    in_readme: bool,
}

/// What is published.
struct Published<'a> {
    root: &'a Path,
    page: &'a str,
}

/// A row of a published table, by column.
type Row = BTreeMap<String, String>;

/// A published table.
struct Source {
    rows: Vec<Row>,
    /// Its file, its command and the commit that was measured.
    origin: String,
}

impl Published<'_> {
    /// The line of the page that links a file and says how it was measured; none if it is stale.
    fn line(&self, file: &str) -> Option<&str> {
        let link = format!("(benchmarks/{file})");
        self.page
            .lines()
            .find(|line| line.contains(&link) && line.contains("Commit "))
            .filter(|line| !line.contains(MARK))
    }

    fn table(&self, name: &str) -> Result<Option<Source>> {
        let file = format!("{name}.csv");
        let Some(line) = self.line(&file) else { return Ok(None) };
        let path = self.root.join(FOLDER).join(&file);
        let mut reader =
            csv::Reader::from_path(&path).with_context(|| format!("cannot read {}", path.display()))?;
        let rows = reader
            .deserialize()
            .collect::<Result<Vec<Row>, _>>()
            .with_context(|| path.display().to_string())?;
        let commit =
            line.split_once("Commit ").map_or("", |(_, rest)| rest.split(';').next().unwrap_or(rest));
        let partly = if line.contains("Out of time") { ", not all measured" } else { "" };
        Ok(Some(Source { rows, origin: format!("[{name}](benchmarks/{file}), {commit}{partly}") }))
    }
}

fn number(row: &Row, column: &str) -> Result<f64> {
    let text = row.get(column).with_context(|| format!("no column {column}"))?;
    text.parse().with_context(|| format!("{column}: {text:?} is no number"))
}

fn comparisons(published: &Published) -> Result<Vec<Comparison>> {
    let all =
        [stage(published)?, paper(published)?, newton(published)?, rapier(published)?, layers(published)?];
    Ok(all.into_iter().flatten().collect())
}

const COLUMNS: [&str; 5] = [
    "compared with",
    "on",
    "its time over Bowknot's",
    "its error over Bowknot's",
    "results that intersect: its, Bowknot's",
];

impl Comparison {
    fn cells(&self) -> [&str; 5] {
        [&self.with, &self.on, &self.time, &self.error, &self.intersections]
    }
}

fn section(published: &Published, comparisons: &[Comparison]) -> String {
    let mut table = Table::new(COLUMNS.into_iter().chain(["table, commit"]));
    for row in comparisons {
        table.row(row.cells().into_iter().chain([row.origin.as_str()]).map(Into::into));
    }
    let mut text = format!("## In short\n\n{}\n\n{}", page::wrap(TEXT), table.markdown());
    let charts: Vec<String> = CHARTS
        .iter()
        .map(|scene| (scene, format!("collision-error-unaware-{scene}.svg")))
        .filter(|(_, file)| published.line(file).is_some())
        .map(|(scene, file)| format!("![{scene}](benchmarks/{file})"))
        .collect();
    if !charts.is_empty() {
        let charts = charts.join("\n");
        text += &format!(
            "\nError against CPU time of all methods and settings; lines are the fronts:\n\n{charts}\n"
        );
    }
    text
}

fn readme_rows(comparisons: &[Comparison]) -> String {
    let mut table = Table::new(COLUMNS);
    comparisons.iter().filter(|row| row.in_readme).for_each(|row| table.row(row.cells().map(Into::into)));
    table.markdown()
}

const TEXT: &str = "Above 1 Bowknot is better. Each row is read from its table: geometric means, with the smallest and largest in \
                    parentheses; CPU time of one thread unless a row says otherwise. What is stale gives no row. \
                    *Recorded problems*: the collision stage alone, without edge limits, so that all methods solve the same \
                    problem; contact-unaware targets, then contact-aware ones; each method ends after 4 s. *Error*: the distance to the \
                    solution of a separate solver. Methods that keep less than the contact distance are faster for that reason; what each \
                    lacks stands in the second table.";

/// `paper`, the barrier of IPC, and of all other methods that solved every problem the most accurate and the fastest.
fn stage(published: &Published) -> Result<Vec<Comparison>> {
    let Some(source) = published.table("contacts-alone-ratios")? else { return Ok(Vec::new()) };
    // Rows of their own, with their variants.
    let known = ["fast", "quick", "paper", "IPC"];
    let names = source.rows.iter().map(|row| row["method"].as_str());
    let others: BTreeSet<&str> =
        names.filter(|name| !known.iter().any(|known| name.starts_with(known))).collect();
    // Geometric mean over both kinds of targets.
    let mean = |name: &str, column: &str| -> Result<f64> {
        let rows = source.rows.iter().filter(|row| row["method"] == name);
        let values: Vec<f64> = rows.map(|row| number(row, column)).collect::<Result<_>>()?;
        Ok(geometric_mean(&values))
    };
    let least = |column: &str| -> Result<Option<&str>> {
        let mut best: Option<(f64, &str)> = None;
        for &name in &others {
            let failed = source.rows.iter().any(|row| row["method"] == name && row["failed"] != "0");
            let value = mean(name, column)?;
            if !failed && best.is_none_or(|(least, _)| value < least) {
                best = Some((value, name));
            }
        }
        Ok(best.map(|(_, name)| name))
    };
    let mut shown = vec![
        ("paper".to_owned(), "`paper`: the method with the paper's settings".to_owned()),
        ("IPC".to_owned(), "IPC: barrier, continuous detection, direct solver".to_owned()),
    ];
    for (column, word) in [("error_ratio", "most accurate"), ("cpu_ratio", "fastest")] {
        if let Some(name) = least(column)? {
            shown.push((name.to_owned(), format!("the {word} of {} other methods: {name}", others.len())));
        }
    }
    let mut result = Vec::new();
    for (name, words) in shown {
        let rows: Vec<&Row> = source.rows.iter().filter(|row| row["method"] == name).collect();
        let spread = |quantity: &str| -> Result<String> {
            let of = |row: &&Row| -> Result<String> {
                let [mean, low, high] =
                    ["", "_min", "_max"].map(|end| number(row, &format!("{quantity}_ratio{end}")));
                Ok(format!("{} ({} to {})", times(mean?), times(low?), times(high?)))
            };
            Ok(rows.iter().map(of).collect::<Result<Vec<_>>>()?.join("; "))
        };
        let count = |name: &str, column: &str| -> Result<f64> {
            source.rows.iter().filter(|row| row["method"] == name).map(|row| number(row, column)).sum()
        };
        let intersections =
            format!("{}, {}", count(&name, "intersections")?, count("fast", "intersections")?);
        let on = format!("recorded problems ({})", count(&name, "problems")?);
        result.push(Comparison {
            with: words,
            on,
            time: spread("cpu")?,
            error: spread("error")?,
            intersections,
            origin: source.origin.clone(),
            in_readme: name == "paper",
        });
    }
    Ok(result)
}

/// The paper's seconds on a GPU.
fn paper(published: &Published) -> Result<Vec<Comparison>> {
    let Some(source) = published.table("table-2-full")? else { return Ok(Vec::new()) };
    let (mut ratios, mut intersections, mut ended) = (Vec::new(), 0.0, 0);
    for row in &source.rows {
        ratios.push(number(row, "paper_gpu_collision_s")? / number(row, "collision_s")?);
        intersections += number(row, "intersections")?;
        ended += usize::from(row["time_steps"] == row["all_time_steps"]);
    }
    Ok(vec![Comparison {
        with: "the paper's program on a GeForce GTX 2080 Ti, as published".to_owned(),
        on: format!(
            "collision stage, {} scenes of its Table 2 at its size, {ended} of them to their end",
            ratios.len()
        ),
        time: spread(&ratios),
        error: "-".to_owned(),
        intersections: format!("-, {intersections}"),
        origin: source.origin,
        in_readme: true,
    }])
}

fn spread(ratios: &[f64]) -> String {
    format!("{} ({} to {})", times(geometric_mean(ratios)), times(smallest(ratios)), times(largest(ratios)))
}

/// Whole simulations by another program in several settings: time by its settings, frames that intersect.
fn simulations(source: Source, program: &str, words: &str, on: &str) -> Result<Comparison> {
    let mut by_setting: BTreeMap<&str, Vec<f64>> = BTreeMap::new();
    let (mut theirs, mut ours) = ([0.0; 2], [0.0; 2]);
    for row in &source.rows {
        let intersects = number(row, "intersecting_frames")?;
        let counts = if row["solver"].starts_with(program) {
            by_setting.entry(&row["solver"]).or_default().push(number(row, "ratio")?);
            &mut theirs
        } else {
            &mut ours
        };
        counts[0] += f64::from(u8::from(intersects > 0.0));
        counts[1] += 1.0;
    }
    let settings: Vec<f64> = by_setting.values().map(|ratios| geometric_mean(ratios)).collect();
    Ok(Comparison {
        with: words.to_owned(),
        on: on.to_owned(),
        time: format!(
            "{} to {} by setting ({})",
            times(smallest(&settings)),
            times(largest(&settings)),
            settings.len()
        ),
        error: "-".to_owned(),
        intersections: format!("{} of {} runs, {} of {}", theirs[0], theirs[1], ours[0], ours[1]),
        origin: source.origin,
        in_readme: true,
    })
}

fn newton(published: &Published) -> Result<Vec<Comparison>> {
    let Some(source) = published.table("peers-cloth")? else { return Ok(Vec::new()) };
    Ok(vec![simulations(
        source,
        "Newton",
        "NVIDIA Newton, VBD on the CPU",
        "falls of cloth, whole time steps",
    )?])
}

fn rapier(published: &Published) -> Result<Vec<Comparison>> {
    let Some(source) = published.table("peers-soft")? else { return Ok(Vec::new()) };
    Ok(vec![simulations(source, "rapier", "rapier, soft bodies", "cloth and solids, whole time steps")?])
}

/// The 50 layers of offset geometric contact, wall time per simulated second.
fn layers(published: &Published) -> Result<Vec<Comparison>> {
    let Some(source) = published.table("peers-layers")? else { return Ok(Vec::new()) };
    let of = |start: &str| -> Result<f64> {
        let row = source.rows.iter().find(|row| row["program"].starts_with(start));
        number(row.with_context(|| format!("no row {start}"))?, "wall_s_per_s")
    };
    let ours = of("Bowknot")?;
    let (cpu, gpu) = (of("OGC, as published: AMD")? / ours, of("OGC, as published: NVIDIA")? / ours);
    Ok(vec![Comparison {
        with: "offset geometric contact, as published".to_owned(),
        on: "50 layers of cloth, wall time per simulated second".to_owned(),
        time: format!("{} on 16 cores, {} on an RTX 4090", times(cpu), times(gpu)),
        error: "-".to_owned(),
        intersections: "-".to_owned(),
        origin: source.origin,
        in_readme: false,
    }])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::files::write;

    const PAGE: &str = "<!-- begin front -->\n<!-- end front -->\n\
        | [contacts-alone-ratios.csv](benchmarks/contacts-alone-ratios.csv) | Commit 0123abc; 1 thread |\n\
        | [peers-cloth.csv](benchmarks/peers-cloth.csv) | Commit 4567abc (*stale*); 1 thread |\n";

    #[test]
    fn rows_come_from_tables_that_are_not_stale() {
        let folder = tempfile::tempdir().expect("a folder");
        let mut table = "targets,method,cpu_ratio,cpu_ratio_min,cpu_ratio_max,error_ratio,error_ratio_min,\
                         error_ratio_max,problems,failed,intersections\n"
            .to_owned();
        for (method, cpu, error, failed) in [
            ("fast", 1, 1, 0),
            ("quick", 1, 2, 0),
            ("paper", 4, 3, 0),
            ("IPC", 9, 8, 0),
            ("A", 2, 5, 0),
            ("B", 5, 2, 0),
            ("C", 1, 1, 1),
        ] {
            for targets in ["unaware", "aware"] {
                table += &format!("{targets},{method},{cpu},1,9,{error},1,9,6,{failed},0\n");
            }
        }
        write(&folder.path().join(FOLDER).join("contacts-alone-ratios.csv"), &table).expect("a file");
        write(&folder.path().join(BENCHMARKS), PAGE).expect("a file");
        write(&folder.path().join(README), "<!-- begin front -->\n<!-- end front -->\n").expect("a file");
        rewrite(folder.path()).expect("sound tables");
        let read = |page: &str| fs::read_to_string(folder.path().join(page)).expect("a page");
        let page = read(BENCHMARKS);
        assert!(page.contains("| `paper`: the method with the paper's settings | recorded problems (12) | 4.00x (1.00x to 9.00x); 4.00x"), "{page}");
        // One that failed is neither.
        assert!(
            page.contains("most accurate of 3 other methods: B")
                && page.contains("fastest of 3 other methods: A"),
            "{page}"
        );
        assert!(
            page.contains("[contacts-alone-ratios](benchmarks/contacts-alone-ratios.csv), 0123abc"),
            "{page}"
        );
        assert!(!page.contains("Newton") && !page.contains("svg"), "{page}");
        assert!(read(README).contains("| `paper`") && !read(README).contains("IPC"), "{}", read(README));
        rewrite(folder.path()).expect("sound tables");
        assert_eq!(read(BENCHMARKS), page);
    }

    #[test]
    fn pages_have_what_the_tables_say() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
        for (page, text) in rewritten(&root).expect("sound tables") {
            let before = fs::read_to_string(root.join(page)).expect("a page");
            assert!(
                before == text,
                "block {NAME} of {page} is not what the tables say; `bowknot-bench age` rewrites it"
            );
        }
    }
}
