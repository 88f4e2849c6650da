//! The first section of docs/benchmarks.md: what Bowknot was compared with, in at most eight rows, which the README
//! shows without their details.
//!
//! Rows are read from the tables in docs/benchmarks. One that the page calls stale, or that is not there, gives no row:
//! no figure is carried forward.

use crate::files::write;
use crate::page;
use crate::pages::{BENCHMARKS, FOLDER, README, STALE};
use crate::table::{Table, geometric_mean, largest, smallest, spread, times};
use anyhow::{Context, Result, ensure};
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
            .filter(|line| !line.contains(STALE))
    }

    /// A table that has these columns of text; none if it is stale or not there.
    fn table(&self, name: &str, columns: &[&str]) -> Result<Option<Source>> {
        let file = format!("{name}.csv");
        let Some(line) = self.line(&file) else { return Ok(None) };
        let path = self.root.join(FOLDER).join(&file);
        let mut reader =
            csv::Reader::from_path(&path).with_context(|| format!("cannot read {}", path.display()))?;
        let rows: Result<Vec<Row>, _> = reader.deserialize().collect();
        let rows = rows.with_context(|| path.display().to_string())?;
        for column in columns {
            ensure!(rows.iter().all(|row| row.contains_key(*column)), "{file}: no column {column}");
        }
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
    "intersections: its, Bowknot's",
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
            "\nWith edge limits: error against CPU time of all methods and settings; lines are the fronts:\n\n{charts}\n"
        );
    }
    text
}

/// The rows of the README, of each cell what comes before parentheses and details.
fn readme_rows(comparisons: &[Comparison]) -> String {
    let brief = |text: &str| {
        let parts = text.split("; ").map(|part| part.split(" (").next().unwrap_or(part));
        parts.collect::<Vec<_>>().join("; ")
    };
    let mut table = Table::new(COLUMNS);
    for row in comparisons {
        table.row(row.cells().map(|cell| brief(cell).into()));
    }
    table.markdown()
}

const TEXT: &str = "Above 1 Bowknot, with the preset `fast`, is better. Each row is read from its table: geometric \
                    means, with the smallest and largest in parentheses; CPU time of one thread unless a row says \
                    otherwise. Tables that are older than the present solver give no row.\n\n\
                    *Recorded problems*: the collision stage alone, without edge limits and friction. Targets are \
                    *unaware* of contacts, *repelled* as in the paper's section 6.2, or *aware* of contacts as those \
                    of `fast` are. The methods are those of `crates/baselines`. A solve that has *not ended* after 4 s \
                    is stopped: it would take longer, and its error is that of an unfinished result. *Error*: the \
                    distance to the solution of a separate solver where it found one, else the residuals. Impact \
                    zones, rigid ones too, keep no contact distance, barriers less of it where something presses, \
                    Bowknot half of it in sharp folds.";

/// `paper`, the barrier of IPC, and of all other methods that failed on no problem the most accurate and the fastest.
fn stage(published: &Published) -> Result<Vec<Comparison>> {
    let Some(source) = published.table("contacts-alone-ratios", &["targets", "method", "failed"])? else {
        return Ok(Vec::new());
    };
    // Rows of their own, with their variants.
    let known = ["fast", "quick", "paper", "IPC"];
    let names = source.rows.iter().map(|row| row["method"].as_str());
    let others: BTreeSet<&str> =
        names.filter(|name| !known.iter().any(|known| name.starts_with(known))).collect();
    let fails = |name: &str| source.rows.iter().any(|row| row["method"] == name && row["failed"] != "0");
    let sound: Vec<&str> = others.iter().copied().filter(|name| !fails(name)).collect();
    // Geometric mean over all kinds of targets.
    let mean = |name: &str, column: &str| -> Result<f64> {
        let rows = source.rows.iter().filter(|row| row["method"] == name);
        let values: Vec<f64> = rows.map(|row| number(row, column)).collect::<Result<_>>()?;
        Ok(geometric_mean(&values))
    };
    let least = |column: &str| -> Result<Option<&str>> {
        let mut best: Option<(f64, &str)> = None;
        for &name in &sound {
            let value = mean(name, column)?;
            if best.is_none_or(|(least, _)| value < least) {
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
            shown.push((
                name.to_owned(),
                format!(
                    "the {word} of the {} of {} other methods and variants that failed nowhere: {name}",
                    sound.len(),
                    others.len()
                ),
            ));
        }
    }
    let mut result = Vec::new();
    for (name, words) in shown {
        let rows: Vec<&Row> = source.rows.iter().filter(|row| row["method"] == name).collect();
        let ratios = |quantity: &str| -> Result<String> {
            let of = |row: &&Row| -> Result<String> {
                let [mean, low, high] =
                    ["", "_min", "_max"].map(|end| number(row, &format!("{quantity}_ratio{end}")));
                Ok(spread([mean?, low?, high?]))
            };
            let cells = rows.iter().map(|row| Ok(format!("{} {}", row["targets"], of(row)?)));
            Ok(cells.collect::<Result<Vec<_>>>()?.join("; "))
        };
        let count = |name: &str, column: &str| -> Result<f64> {
            source.rows.iter().filter(|row| row["method"] == name).map(|row| number(row, column)).sum()
        };
        let intersections =
            format!("{}, {}", count(&name, "intersections")?, count("fast", "intersections")?);
        let problems = count(&name, "problems")?;
        let (referenced, open) = (count(&name, "referenced")?, problems - count(&name, "met_rule")?);
        let on = format!("{problems} recorded problems, {referenced} with a reference, {open} not ended");
        result.push(Comparison {
            with: words,
            on,
            time: ratios("cpu")?,
            error: ratios("error")?,
            intersections,
            origin: source.origin.clone(),
        });
    }
    Ok(result)
}

/// The paper's seconds on a GPU.
fn paper(published: &Published) -> Result<Vec<Comparison>> {
    let Some(source) = published.table("table-2-full", &["time_steps", "all_time_steps"])? else {
        return Ok(Vec::new());
    };
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
        time: spread([geometric_mean, smallest, largest].map(|of| of(&ratios))),
        error: "-".to_owned(),
        intersections: format!("-, {intersections}"),
        origin: source.origin,
    }])
}

/// Falls that end before half of the way are none that can be compared [%].
const LEAST_FALL: f64 = 50.0;

/// Whole simulations by another program in several settings: time by its settings, runs that intersect.
fn simulations(source: Source, program: &str, words: &str, on: &str) -> Result<Comparison> {
    let mut by_setting: BTreeMap<&str, Vec<f64>> = BTreeMap::new();
    let (mut theirs, mut ours) = ([0.0; 2], [0.0; 2]);
    for row in &source.rows {
        if row.contains_key("fell_percent") && number(row, "fell_percent")? < LEAST_FALL {
            continue;
        }
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
    // Settings that ran in fewer scenes would compare scenes.
    let most = by_setting.values().map(Vec::len).max().unwrap_or(0);
    let in_all = by_setting.values().filter(|ratios| ratios.len() == most);
    let settings: Vec<f64> = in_all.map(|ratios| geometric_mean(ratios)).collect();
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
    })
}

fn newton(published: &Published) -> Result<Vec<Comparison>> {
    let Some(source) = published.table("peers-cloth", &["solver"])? else { return Ok(Vec::new()) };
    Ok(vec![simulations(
        source,
        "Newton",
        "NVIDIA Newton, VBD on the CPU",
        "falls of cloth that reach the obstacle, whole time steps",
    )?])
}

fn rapier(published: &Published) -> Result<Vec<Comparison>> {
    let Some(source) = published.table("peers-soft", &["solver"])? else { return Ok(Vec::new()) };
    Ok(vec![simulations(source, "rapier", "rapier, soft bodies", "cloth and solids, whole time steps")?])
}

/// The 50 layers of offset geometric contact, wall time per simulated second.
fn layers(published: &Published) -> Result<Vec<Comparison>> {
    let Some(source) = published.table("peers-layers", &["program"])? else { return Ok(Vec::new()) };
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
    }])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::files::write;

    const OLD: &str =
        "| [peers-cloth.csv](benchmarks/peers-cloth.csv) | Commit 4567abc (*stale*); 1 thread |\n";

    /// A repository whose page names these tables as measured just now.
    fn repository(tables: &[(&str, &str)]) -> tempfile::TempDir {
        let folder = tempfile::tempdir().expect("a folder");
        let empty = "<!-- begin front -->\n<!-- end front -->\n";
        let mut page = format!("{empty}{OLD}");
        for (name, table) in tables {
            page += &format!("| [{name}.csv](benchmarks/{name}.csv) | Commit 0123abc; 1 thread |\n");
            write(&folder.path().join(FOLDER).join(format!("{name}.csv")), table).expect("a file");
        }
        write(&folder.path().join(BENCHMARKS), &page).expect("a file");
        write(&folder.path().join(README), empty).expect("a file");
        folder
    }

    fn read(folder: &tempfile::TempDir, page: &str) -> String {
        fs::read_to_string(folder.path().join(page)).expect("a page")
    }

    #[test]
    fn methods_come_from_tables_that_are_not_stale() {
        let mut table = "targets,method,cpu_ratio,cpu_ratio_min,cpu_ratio_max,error_ratio,error_ratio_min,\
                         error_ratio_max,problems,referenced,failed,met_rule,intersections\n"
            .to_owned();
        for (method, cpu, error, failed) in [
            ("fast", 1, 1, 0),
            ("quick", 1, 2, 0),
            ("paper", 4, 3, 0),
            ("\"paper, other\"", 1, 1, 0),
            ("IPC", 9, 8, 0),
            ("A", 2, 5, 0),
            ("B", 5, 2, 0),
            ("C", 1, 1, 1),
        ] {
            for targets in ["unaware", "aware"] {
                table += &format!("{targets},{method},{cpu},1,9,{error},1,9,6,5,{failed},4,0\n");
            }
        }
        let folder = repository(&[("contacts-alone-ratios", &table)]);
        rewrite(folder.path()).expect("sound tables");
        let page = read(&folder, BENCHMARKS);
        let on = "12 recorded problems, 10 with a reference, 4 not ended";
        let ratios = "unaware 4.00x (1.00x to 9.00x); aware 4.00x (1.00x to 9.00x)";
        let paper = format!("| `paper`: the method with the paper's settings | {on} | {ratios} |");
        assert!(page.contains(&paper), "{page}");
        // One that failed is neither, and a variant of `paper` is no other method.
        for (word, name) in [("most accurate", "B"), ("fastest", "A")] {
            let words =
                format!("{word} of the 2 of 3 other methods and variants that failed nowhere: {name}");
            assert!(page.contains(&words), "{page}");
        }
        assert!(
            page.contains("[contacts-alone-ratios](benchmarks/contacts-alone-ratios.csv), 0123abc"),
            "{page}"
        );
        assert!(!page.contains("Newton") && !page.contains("svg"), "{page}");
        let readme = read(&folder, README);
        assert!(
            readme.contains("| unaware 4.00x; aware 4.00x | unaware 3.00x; aware 3.00x | 0, 0 |")
                && readme.contains("| IPC"),
            "{readme}"
        );
        rewrite(folder.path()).expect("sound tables");
        assert_eq!(read(&folder, BENCHMARKS), page);
    }

    #[test]
    fn programs_come_from_their_tables() {
        let full = "scene,time_steps,all_time_steps,collision_s,paper_gpu_collision_s,intersections\n\
                    a,9,9,0.2,0.1,0\nb,3,9,0.4,0.8,0\n";
        let soft = "scene,solver,ratio,intersecting_frames,fell_percent\nball,Bowknot,,0,100\n\
                    ball,rapier,2.0,3,100\nball,\"rapier, fast\",0.5,0,100\nball,\"rapier, stuck\",0.1,0,12\n";
        let layers = "program,wall_s_per_s\nBowknot,100\n\"OGC, as published: AMD Ryzen\",50\n\
                      \"OGC, as published: NVIDIA RTX\",1\n";
        let folder = repository(&[("table-2-full", full), ("peers-soft", soft), ("peers-layers", layers)]);
        rewrite(folder.path()).expect("sound tables");
        let page = read(&folder, BENCHMARKS);
        for row in [
            "2 scenes of its Table 2 at its size, 1 of them to their end | 1.00x (0.500x to 2.00x) |",
            "| 0.500x to 2.00x by setting (2) | - | 1 of 2 runs, 0 of 1 |",
            "| 0.500x on 16 cores, 0.0100x on an RTX 4090 |",
        ] {
            assert!(page.contains(row), "{row}: {page}");
        }
        let folder = repository(&[("peers-soft", "scene,ratio\nball,1\n")]);
        assert!(rewrite(folder.path()).expect_err("no solver").to_string().contains("no column solver"));
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
