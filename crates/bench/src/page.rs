//! The page of results: a section for each figure between markers, each written by its own run.

use crate::figures::{self, Figure, Part, Section};
use anyhow::{Context, Result, bail};
use std::fs;
use std::path::Path;

/// What stands before the first section of a new page.
const HEAD: &str = "# Benchmarks\n\n\
    `cargo run --release -p bowknot-bench -- NAME` measures a figure and rewrites its section here, texts included: edit\n\
    `crates/bench/src/figures`, not this file. `list` names all, `all --quick` is a look at all of them, and leaves this page alone.\n";

/// The section of a figure.
pub fn section(figure: &dyn Figure, section: &Section, conditions: &str) -> String {
    let mut text =
        format!("## {}\n\n{}\n\n**{}**\n", figure.title(), wrap(figure.question()), wrap(&section.finding));
    for part in &section.parts {
        let part = match part {
            Part::Table { caption, table, .. } => {
                format!("{}\n\n{}", wrap(caption), table.markdown()).trim().to_owned()
            }
            Part::Chart { name, chart } => format!("![{}](benchmarks/{name}.svg)", chart.title),
            Part::Data { .. } => continue,
        };
        text.push_str(&format!("\n{part}\n"));
    }
    text.push_str(&format!("\n`bowknot-bench {}`. {conditions}\n", figure.name()));
    text
}

/// Puts the section of figure `name` into the page, in the order of [`figures::ALL`].
pub fn rewrite(path: &Path, name: &str, section: &str) -> Result<()> {
    let page = match fs::read_to_string(path) {
        Ok(page) => page,
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => HEAD.to_owned(),
        Err(error) => return Err(error).with_context(|| format!("cannot read {}", path.display())),
    };
    let order: Vec<&str> = figures::ALL.iter().map(|figure| figure.name()).collect();
    let page = replaced(&page, name, section, &order).with_context(|| path.display().to_string())?;
    fs::write(path, page).with_context(|| format!("cannot write {}", path.display()))
}

fn replaced(page: &str, name: &str, section: &str, order: &[&str]) -> Result<String> {
    let begin = |name: &str| format!("<!-- begin {name} -->\n");
    let end = |name: &str| format!("<!-- end {name} -->\n");
    let block = format!("{}{section}{}", begin(name), end(name));
    if let Some(from) = page.find(&begin(name)) {
        let Some(length) = page[from..].find(&end(name)) else {
            bail!("section {name} begins but has no line {:?}", end(name).trim_end());
        };
        let to = from + length + end(name).len();
        return Ok(format!("{}{block}{}", &page[..from], &page[to..]));
    }
    // Before the first later figure that is there, or else at the end.
    let place = order.iter().position(|n| *n == name).map_or(order.len(), |k| k + 1);
    let next = order[place..].iter().find_map(|later| page.find(&begin(later)));
    Ok(match next {
        Some(at) => format!("{}{block}\n{}", &page[..at], &page[at..]),
        None => format!("{}\n\n{block}", page.trim_end()),
    })
}

/// Lines of at most 120 characters.
fn wrap(text: &str) -> String {
    let mut lines: Vec<String> = Vec::new();
    for paragraph in text.split("\n\n") {
        let mut line = String::new();
        for word in paragraph.split_whitespace() {
            if !line.is_empty() && line.len() + 1 + word.len() > 120 {
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
    fn sections_are_put_in_order_and_replaced() {
        let order = ["a", "b", "c"];
        let mut page = "# Page\n".to_owned();
        for (name, text) in [("b", "old\n"), ("c", "C\n"), ("a", "A\n"), ("b", "B\n")] {
            page = replaced(&page, name, text, &order).expect("sound markers");
        }
        let block = |name: &str, text: &str| format!("<!-- begin {name} -->\n{text}\n<!-- end {name} -->\n");
        assert_eq!(page, format!("# Page\n\n{}\n{}\n{}", block("a", "A"), block("b", "B"), block("c", "C")));
        assert!(replaced("<!-- begin a -->\n", "a", "", &order).is_err());
    }

    #[test]
    fn lines_are_wrapped_and_paragraphs_kept() {
        let long = "word ".repeat(30);
        let text = wrap(&format!("{long}\n\nsecond"));
        assert!(text.lines().all(|line| line.len() <= 120) && text.ends_with("word\n\nsecond"), "{text}");
    }
}
