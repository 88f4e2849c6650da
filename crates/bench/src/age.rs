//! How old results are. Those that were measured before much of the solver changed are marked on their pages.

use crate::pages::{self, STALE};
use crate::{front, git};
use anyhow::{Context, Result};
use std::collections::HashMap;
use std::fs;
use std::path::Path;

/// Number of files of the solver that may have changed since a measurement before its results count as stale.
const MAX_FILES: usize = 20;

/// What is measured: the sources whose changes count.
const SOLVER: [&str; 9] = [
    "crates/bowknot/src",
    "crates/constraints/src",
    "crates/dynamics/src",
    "crates/geometry/src",
    "crates/lcp/src",
    "crates/proximity/src",
    "crates/scene/src",
    "crates/stepper/src",
    "crates/twoway/src",
];

/// Pages whose results name their commits.
const PAGES: [&str; 4] = [pages::BENCHMARKS, pages::GALLERY, pages::GPU_RESULTS, pages::STABILITY];

/// Marks stale results on all pages of the repository at `root`, takes the mark from others, and writes the rows of the
/// first section anew.
pub fn mark_pages(root: &Path) -> Result<()> {
    let mut ages = Ages { root, known: HashMap::new() };
    for page in PAGES {
        let path = root.join(page);
        let text = fs::read_to_string(&path).with_context(|| format!("cannot read {}", path.display()))?;
        let marked = marked(&text, &mut |commit| ages.is_stale(commit));
        if marked != text {
            fs::write(&path, marked).with_context(|| format!("cannot write {}", path.display()))?;
            println!("{page}");
        }
    }
    front::rewrite(root)
}

/// Which commits are stale, asked of git once each.
struct Ages<'a> {
    root: &'a Path,
    known: HashMap<String, bool>,
}

impl Ages<'_> {
    /// Whether more than [`MAX_FILES`] files of the solver differ from that commit. Of one that the history
    /// here does not have nobody can say.
    fn is_stale(&mut self, commit: &str) -> bool {
        *self.known.entry(commit.to_owned()).or_insert_with(|| {
            let mut arguments = vec!["diff", "--name-only", commit, "HEAD", "--"];
            arguments.extend(SOLVER);
            git::output(self.root, &arguments).is_some_and(|files| files.lines().count() > MAX_FILES)
        })
    }
}

/// The text with [`STALE`] after each list of commits of which one is stale, and after no other: "Commit 0123abc,
/// 4567def (*stale*)".
fn marked(text: &str, is_stale: &mut impl FnMut(&str) -> bool) -> String {
    let mut pieces = text.split("ommit ");
    let mut result = pieces.next().unwrap_or_default().to_owned();
    for piece in pieces {
        result.push_str("ommit ");
        let (mut commits, mut rest) = (Vec::new(), piece);
        loop {
            let length = rest.chars().take_while(|c| matches!(c, '0'..='9' | 'a'..='f')).count();
            if length < 7 {
                break;
            }
            commits.push(&rest[..length]);
            rest = &rest[length..];
            match rest.strip_prefix(", ") {
                Some(next) if next.starts_with(|c: char| c.is_ascii_hexdigit()) => rest = next,
                _ => break,
            }
        }
        let list = commits.join(", ");
        result.push_str(&list);
        if commits.into_iter().any(&mut *is_stale) {
            result.push_str(STALE);
        }
        let after = &piece[list.len()..];
        result.push_str(if list.is_empty() { after } else { after.strip_prefix(STALE).unwrap_or(after) });
    }
    result
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_with_a_stale_commit_are_marked() {
        let mut stale = |commit: &str| commit == "0123abc";
        let text = "Commit 0123abc, fed4567; 1 thread. Commit fed4567 (*stale*). the commit that was, commit 0123abc:";
        let expected = "Commit 0123abc, fed4567 (*stale*); 1 thread. Commit fed4567. the commit that was, \
                        commit 0123abc (*stale*):";
        assert_eq!(marked(text, &mut stale), expected);
        assert_eq!(marked(expected, &mut stale), expected);
    }

    #[test]
    fn pages_mark_what_is_stale() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
        // A packaged crate has no history, a shallow clone only a part of it.
        if git::output(&root, &["rev-parse", "--is-shallow-repository"]).as_deref() != Some("false") {
            println!("skipped: no history");
            return;
        }
        let mut ages = Ages { root: &root, known: HashMap::new() };
        for page in PAGES {
            let text = fs::read_to_string(root.join(page)).expect("a page");
            let marked = marked(&text, &mut |commit| ages.is_stale(commit));
            let unmarked: Vec<&str> =
                text.lines().zip(marked.lines()).filter(|(a, b)| a != b).map(|(a, _)| a).collect();
            assert!(
                unmarked.is_empty(),
                "{page}: more than {MAX_FILES} files of the solver have changed since these results; measure \
                 them, or mark them by `bowknot-bench age`:\n{}",
                unmarked.join("\n")
            );
        }
    }
}
