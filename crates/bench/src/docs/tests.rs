//! Publishing into a temporary repository.

use super::*;
use crate::bench::Bench;
use crate::table::Table;
use tempfile::TempDir;

struct Example {
    on_page: bool,
}

impl Figure for Example {
    fn name(&self) -> &'static str {
        if self.on_page { "shown" } else { "indexed" }
    }

    fn title(&self) -> &'static str {
        "An example"
    }

    fn question(&self) -> &'static str {
        "How much?"
    }

    fn on_page(&self) -> bool {
        self.on_page
    }

    fn run(&self, _: &Bench) -> Result<Report> {
        let mut table = Table::new(["method", "cpu_s"]);
        table.row(["fast".into(), 1.25.into()]);
        Ok(report(table))
    }
}

fn report(table: Table) -> Report {
    Report { finding: "So much.".to_owned(), parts: vec![Part::table("indexed", "times", table)] }
}

fn example() -> Report {
    let mut table = Table::new(["method", "cpu_s"]);
    table.row(["fast".into(), 1.25.into()]);
    report(table)
}

const FRONT: &str = "<!-- begin front -->\n<!-- end front -->\n";
const EMPTY_PAGE: &str = "# Benchmarks\n\n<!-- begin front -->\n<!-- end front -->\n\n<!-- begin shown -->\n<!-- end shown -->\n\n\
    <!-- begin index -->\n| table | shows |\n|---|---|\n<!-- end index -->\n";

/// A repository with one commit that holds a source file and a page without results.
fn repository() -> TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    write(&folder.path().join("crates/code.rs"), "fn main() {}\n").expect("a file");
    write(&folder.path().join(BENCHMARKS), EMPTY_PAGE).expect("a file");
    write(&folder.path().join(README), FRONT).expect("a file");
    for arguments in [
        &["init", "--quiet"][..],
        &["add", "."],
        &["-c", "user.name=test", "-c", "user.email=test@localhost", "commit", "--quiet", "-m", "first"],
    ] {
        git::output(folder.path(), arguments).expect("git works");
    }
    folder
}

fn publish(folder: &TempDir, on_page: bool, conditions: &str) -> Result<()> {
    Docs::new(folder.path()).publish(&Example { on_page }, &example(), conditions, &["shown", "indexed"])
}

#[test]
fn results_are_written_from_a_clean_tree() {
    let folder = repository();
    publish(&folder, true, "Commit abc.").expect("published");
    // The page has changed now; results that figures wrote do not count.
    publish(&folder, false, "Commit abc.").expect("published");
    let read = |path: &str| fs::read_to_string(folder.path().join(path)).expect("a file");
    let page = read(BENCHMARKS);
    assert!(page.contains("## An example") && page.contains("| fast | 1.25 |"), "{page}");
    assert!(page.contains("| [indexed.csv](benchmarks/indexed.csv) | times |"), "{page}");
    assert_eq!(read("docs/benchmarks/indexed.csv"), "method,cpu_s\nfast,1.25\n");
}

#[test]
fn nothing_is_written_from_a_dirty_tree() {
    for (path, text) in [("crates/code.rs", "fn main() { loop {} }\n"), ("crates/new.rs", "")] {
        let folder = repository();
        write(&folder.path().join(path), text).expect("a file");
        for on_page in [true, false] {
            let refused = publish(&folder, on_page, "Commit abc.").expect_err("the tree is dirty");
            assert!(refused.to_string().contains(path), "{refused}");
        }
        assert_eq!(fs::read_to_string(folder.path().join(BENCHMARKS)).expect("a file"), EMPTY_PAGE);
        assert!(!folder.path().join(FOLDER).exists());
    }
}

#[test]
fn empty_tables_are_not_published() {
    let folder = repository();
    let empty = report(Table::new(["method", "cpu_s"]));
    let order = ["shown", "indexed"];
    let refused = Docs::new(folder.path()).publish(&Example { on_page: true }, &empty, "Commit abc.", &order);
    assert!(refused.expect_err("nothing was measured").to_string().contains("nothing of shown"));
}

#[test]
fn measurements_of_a_dirty_tree_are_not_published() {
    let folder = repository();
    let refused = publish(&folder, true, "Commit abc, def with changes.").expect_err("measured with changes");
    assert!(refused.to_string().contains("not clean"), "{refused}");
    let no_repository = tempfile::tempdir().expect("a folder");
    assert!(publish(&no_repository, true, "Commit abc.").is_err());
}
