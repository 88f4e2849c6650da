//! Mutations as data: one file each, in a small part of TOML that needs no library.
//!
//! ```toml
//! file = "crates/stepper/src/stepper.rs"
//! why = "What goes wrong with it."
//! old = '''
//! whole lines, as they stand in the file, once
//! '''
//! new = '''
//! what replaces them
//! '''
//! ```

use std::fs;
use std::path::{Path, PathBuf};

/// A change of a few lines that makes the method unsafe.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Mutation {
    /// Name of its file, without the ending.
    pub name: String,
    /// The file that it changes, below the workspace's root.
    pub file: String,
    /// Why it is dangerous.
    pub why: String,
    /// The lines that it replaces, as they stand in the file.
    pub old: String,
    /// The lines that replace them.
    pub new: String,
}

/// The folder of the mutations.
pub fn folder(root: &Path) -> PathBuf {
    root.join("tests").join("safety").join("mutations")
}

/// Reads all mutations, by name.
///
/// # Errors
/// The first file that cannot be read.
pub fn read_all(root: &Path) -> Result<Vec<Mutation>, String> {
    let folder = folder(root);
    let entries = fs::read_dir(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    let mut paths: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).collect();
    paths.sort();
    let read = |path: PathBuf| {
        let text = fs::read_to_string(&path).map_err(|error| format!("{}: {error}", path.display()))?;
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        parse(&name, &text).map_err(|fault| format!("{}: {fault}", path.display()))
    };
    paths.into_iter().filter(|path| path.extension().is_some_and(|e| e == "toml")).map(read).collect()
}

/// Reads the text of one mutation.
fn parse(name: &str, text: &str) -> Result<Mutation, String> {
    let mut mutation = Mutation { name: name.to_owned(), ..Mutation::default() };
    let mut lines = text.lines();
    while let Some(line) = lines.next() {
        if line.is_empty() || line.starts_with('#') {
            continue;
        }
        let (key, value) = line.split_once(" = ").ok_or_else(|| format!("no `key = value`: {line}"))?;
        let field = match key {
            "file" => &mut mutation.file,
            "why" => &mut mutation.why,
            "old" => &mut mutation.old,
            "new" => &mut mutation.new,
            _ => return Err(format!("unknown key {key}")),
        };
        if value == "'''" {
            for line in lines.by_ref().take_while(|line| *line != "'''") {
                field.push_str(line);
                field.push('\n');
            }
        } else {
            let quoted = value.strip_prefix('"').and_then(|rest| rest.strip_suffix('"'));
            let plain = quoted.filter(|text| !text.contains(['"', '\\']));
            *field = plain.ok_or_else(|| format!("{key}: not a plain string: {value}"))?.to_owned();
        }
    }
    let Mutation { file, why, old, new, .. } = &mutation;
    for (key, value) in [("file", file), ("why", why), ("old", old)] {
        if value.is_empty() {
            return Err(format!("{key} is missing"));
        }
    }
    if old == new {
        return Err("old and new are the same".to_owned());
    }
    Ok(mutation)
}

impl Mutation {
    /// The text of its file with the change.
    ///
    /// # Errors
    /// The lines are not in the text exactly once.
    pub fn apply(&self, text: &str) -> Result<String, String> {
        match text.matches(&self.old).count() {
            1 => Ok(text.replacen(&self.old, &self.new, 1)),
            count => Err(format!(
                "{}: its old lines are {count} times in {}, not once; bring the mutation up to date with the \
                 code",
                self.name, self.file
            )),
        }
    }

    /// As [`Self::apply`], to its file below `root`.
    ///
    /// # Errors
    /// As [`Self::apply`], or the file cannot be read.
    pub fn apply_below(&self, root: &Path) -> Result<String, String> {
        let path = root.join(&self.file);
        let text = fs::read_to_string(&path).map_err(|error| format!("{}: {error}", path.display()))?;
        self.apply(&text)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::workspace::root;

    /// Without this, a mutation would silently stop to test anything once its code has changed.
    #[test]
    fn every_mutation_still_matches_the_code() {
        let mutations = read_all(&root()).unwrap_or_else(|fault| panic!("{fault}"));
        assert!(mutations.len() >= 10, "only {} mutations", mutations.len());
        let faults: Vec<String> = mutations.iter().filter_map(|m| m.apply_below(&root()).err()).collect();
        assert!(faults.is_empty(), "{}", faults.join("\n"));
    }

    #[test]
    fn mutations_are_read_and_applied() {
        let text = "# a comment\nfile = \"a.rs\"\nwhy = \"because\"\nold = '''\n  one\ntwo\n'''\nnew = \
                    '''\n  three\n'''\n";
        let mutation = parse("name", text).unwrap_or_else(|fault| panic!("{fault}"));
        assert_eq!((mutation.file.as_str(), mutation.why.as_str()), ("a.rs", "because"));
        assert_eq!(mutation.apply("zero\n  one\ntwo\nfour\n"), Ok("zero\n  three\nfour\n".to_owned()));
        for wrong in ["", "  one\ntwo\n  one\ntwo\n"] {
            assert!(
                mutation.apply(wrong).is_err_and(|fault| fault.contains("bring the mutation up to date"))
            );
        }
    }

    #[test]
    fn faults_of_the_data_are_named() {
        for (text, says) in [
            ("file = \"a\"\n", "why is missing"),
            ("files = \"a\"\n", "unknown key files"),
            ("file = a\n", "not a plain string"),
            ("file\n", "no `key = value`"),
        ] {
            let fault = parse("name", text).err().unwrap_or_default();
            assert!(fault.contains(says), "{text:?}: {fault}");
        }
    }
}
