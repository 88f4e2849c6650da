//! The page docs/benchmarks.md: sections of the figures that it shows, and an index of the other figures'
//! files. Blocks between markers are replaced, all other text is kept.

use crate::figure::{Figure, Part, Report};
use anyhow::{Result, bail};

/// Longest line of text [characters].
const LINE: usize = 110;
/// Name of the block with the index.
const INDEX: &str = "index";

/// The section of a figure: text, tables, charts, conditions. `charts` is where charts and files are, seen
/// from the file with the section: empty if beside it, else a folder with a slash at its end.
pub fn section(figure: &dyn Figure, report: &Report, conditions: &str, charts: &str) -> String {
    let mut text = format!(
        "## {}\n\n{}\n\n{}\n",
        figure.title(),
        wrap(figure.question()),
        wrap(&format!("**Result:** {}", report.finding))
    );
    for part in &report.parts {
        let part = match part {
            Part::Table { shows, table, .. } if shows.is_empty() => table.markdown().trim_end().to_owned(),
            Part::Table { shows, table, .. } => {
                format!("{}:\n\n{}", wrap(shows), table.markdown().trim_end())
            }
            Part::File { name, shows, .. } => format!("[{name}.csv]({charts}{name}.csv): {shows}."),
            Part::Chart { name, chart } => format!("![{}]({charts}{name}.svg)", chart.title),
        };
        text.push_str(&format!("\n{part}\n"));
    }
    text.push_str(&format!("\n`{}`. {conditions}\n", command(figure.name())));
    text
}

/// The rows of a figure in the index, one per table. The first row links the figure's charts.
pub fn index_rows(figure: &dyn Figure, report: &Report, conditions: &str) -> Vec<String> {
    let charts: Vec<String> = report
        .parts
        .iter()
        .filter_map(|part| match part {
            Part::Chart { name, .. } => {
                let short = name.strip_prefix(figure.name()).unwrap_or(name).trim_start_matches('-');
                let short = if short.is_empty() { "chart" } else { short };
                Some(format!("[{short}](benchmarks/{name}.svg)"))
            }
            Part::Table { .. } | Part::File { .. } => None,
        })
        .collect();
    let mut charts = charts.join(", ");
    let tables = report.parts.iter().filter_map(|part| match part {
        Part::Table { name, shows, .. } | Part::File { name, shows, .. } => Some((name, shows)),
        Part::Chart { .. } => None,
    });
    tables
        .map(|(name, shows)| {
            let charts = std::mem::take(&mut charts);
            let command = command(figure.name());
            format!(
                "| [{name}.csv](benchmarks/{name}.csv) | {shows} | {charts} | `{command}` | {conditions} |"
            )
        })
        .collect()
}

fn command(figure: &str) -> String {
    format!("bowknot-bench {figure}")
}

/// The page with another section `name`.
///
/// # Errors
/// If the markers of the section are not both there.
pub fn with_section(page: &str, name: &str, section: &str) -> Result<String> {
    let [from, to] = block(page, name)?;
    Ok(format!("{}{section}{}", &page[..from], &page[to..]))
}

/// The page with other rows of a figure in its index, at the figure's place in `order`.
///
/// # Errors
/// If the markers of the index are not both there.
pub fn with_index_rows(page: &str, figure: &str, rows: &[String], order: &[&str]) -> Result<String> {
    let place = |name: &str| order.iter().position(|other| *other == name).unwrap_or(order.len());
    let figure_of = |row: &str| -> Option<String> {
        let (_, rest) = row.split_once("`bowknot-bench ")?;
        rest.split_once('`').map(|(name, _)| name.to_owned())
    };
    let [from, to] = block(page, INDEX)?;
    let mut lines: Vec<&str> =
        page[from..to].lines().filter(|line| figure_of(line).as_deref() != Some(figure)).collect();
    let next = lines.iter().position(|line| figure_of(line).is_some_and(|name| place(&name) > place(figure)));
    let next = next.unwrap_or(lines.len());
    lines.splice(next..next, rows.iter().map(String::as_str));
    with_section(page, INDEX, &(lines.join("\n") + "\n"))
}

/// Where the text between the markers of a block begins and ends.
fn block(page: &str, name: &str) -> Result<[usize; 2]> {
    let [begin, end] = ["begin", "end"].map(|word| format!("<!-- {word} {name} -->\n"));
    let Some(from) = page.find(&begin).map(|at| at + begin.len()) else {
        bail!("there is no line {:?}", begin.trim_end());
    };
    let Some(length) = page[from..].find(&end) else {
        bail!("there is no line {:?} after {:?}", end.trim_end(), begin.trim_end());
    };
    Ok([from, from + length])
}

/// Breaks lines; keeps paragraphs.
pub fn wrap(text: &str) -> String {
    let mut lines: Vec<String> = Vec::new();
    for paragraph in text.split("\n\n") {
        let mut line = String::new();
        for word in paragraph.split_whitespace() {
            if !line.is_empty() && line.len() + 1 + word.len() > LINE {
                lines.push(std::mem::take(&mut line));
            }
            if !line.is_empty() {
                line.push(' ');
            }
            line.push_str(word);
        }
        lines.push(line);
        lines.push(String::new());
    }
    lines.join("\n").trim_end().to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sections_are_replaced_between_their_markers() {
        let page = "# Page\n\n<!-- begin a -->\nold\n<!-- end a -->\n\nend\n";
        let expected = "# Page\n\n<!-- begin a -->\nnew\n<!-- end a -->\n\nend\n";
        assert_eq!(with_section(page, "a", "new\n").expect("sound markers"), expected);
        assert!(with_section(page, "b", "new\n").is_err());
        assert!(with_section("<!-- begin a -->\n", "a", "new\n").is_err());
    }

    #[test]
    fn rows_of_the_index_are_replaced_and_in_order() {
        let row = |name: &str, shows: &str| format!("| {shows} | `bowknot-bench {name}` |");
        let mut page =
            "<!-- begin index -->\n| shows | command |\n|---|---|\n<!-- end index -->\n".to_owned();
        for (name, shows) in [("b", "old"), ("c", "C"), ("a", "A"), ("b", "B")] {
            page =
                with_index_rows(&page, name, &[row(name, shows)], &["a", "b", "c"]).expect("sound markers");
        }
        let rows: Vec<&str> = page.lines().skip(3).take(3).collect();
        assert_eq!(rows, [row("a", "A"), row("b", "B"), row("c", "C")]);
    }

    #[test]
    fn lines_are_wrapped_and_paragraphs_kept() {
        let long = "word ".repeat(30);
        let text = wrap(&format!("{long}\n\nsecond"));
        assert!(text.lines().all(|line| line.len() <= LINE) && text.ends_with("word\n\nsecond"), "{text}");
    }
}
