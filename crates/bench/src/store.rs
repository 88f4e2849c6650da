//! Measurements that are kept, one file each, so that a run that was stopped can continue.

use anyhow::{Context, Result};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use std::cell::RefCell;
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// Measurements below a folder.
#[derive(Debug)]
pub struct Store {
    folder: PathBuf,
    commit: String,
    /// Commits of the measurements asked for since [`Store::take_commits`].
    commits: RefCell<BTreeSet<String>>,
    /// The same of reference solutions, which do not depend on the solver that is measured.
    references: RefCell<BTreeSet<String>>,
}

#[derive(Serialize, Deserialize)]
struct Cell<T> {
    /// The commit that was measured.
    commit: String,
    value: T,
}

impl Store {
    pub fn new(folder: &Path, commit: &str) -> Self {
        Self {
            folder: folder.to_owned(),
            commit: commit.to_owned(),
            commits: RefCell::default(),
            references: RefCell::default(),
        }
    }

    /// The measurement of that key if there is one.
    pub fn find<T: DeserializeOwned>(&self, key: &str) -> Option<T> {
        let text = fs::read_to_string(self.path(key)).ok()?;
        let cell: Cell<T> = serde_json::from_str(&text).ok()?;
        self.commits_of(key).borrow_mut().insert(cell.commit);
        Some(cell.value)
    }

    /// The measurement of that key: the kept one, or one that is made now and kept.
    pub fn measured<T: Serialize + DeserializeOwned>(
        &self,
        key: &str,
        measure: impl FnOnce() -> Result<T>,
    ) -> Result<T> {
        if let Some(value) = self.find(key) {
            return Ok(value);
        }
        let value = measure()?;
        let path = self.path(key);
        if let Some(parent) = path.parent() {
            fs::create_dir_all(parent).with_context(|| format!("cannot create {}", parent.display()))?;
        }
        let cell = Cell { commit: self.commit.clone(), value };
        let text = serde_json::to_string(&cell)?;
        // Written under another name first, so that a run that is killed leaves no incomplete file.
        let partial = path.with_extension("partial");
        fs::write(&partial, text).with_context(|| format!("cannot write {}", partial.display()))?;
        fs::rename(&partial, &path).with_context(|| format!("cannot write {}", path.display()))?;
        self.commits_of(key).borrow_mut().insert(self.commit.clone());
        Ok(cell.value)
    }

    /// Notes in a folder that this commit measures in it.
    pub fn note_commit(&self, folder: &Path) -> Result<()> {
        fs::create_dir_all(folder).with_context(|| format!("cannot create {}", folder.display()))?;
        let mut commits = noted(folder)?;
        if !commits.contains(&self.commit) {
            commits.push(self.commit.clone());
        }
        let path = folder.join(COMMITS);
        fs::write(&path, commits.join("\n")).with_context(|| format!("cannot write {}", path.display()))
    }

    /// Counts the commits that measured in a folder among those asked for.
    pub fn use_commits(&self, folder: &Path) -> Result<()> {
        self.commits.borrow_mut().extend(noted(folder)?);
        Ok(())
    }

    /// The commits of the measurements asked for since the last call.
    pub fn take_commits(&self) -> Vec<String> {
        std::mem::take(&mut *self.commits.borrow_mut()).into_iter().collect()
    }

    /// The commits of the reference solutions asked for since the last call.
    pub fn take_references(&self) -> Vec<String> {
        std::mem::take(&mut *self.references.borrow_mut()).into_iter().collect()
    }

    fn commits_of(&self, key: &str) -> &RefCell<BTreeSet<String>> {
        if key.starts_with(REFERENCE) { &self.references } else { &self.commits }
    }

    /// Keys are paths with `/`; characters that file names should not have become `_`.
    fn path(&self, key: &str) -> PathBuf {
        let plain = |c: char| if c.is_ascii_alphanumeric() || "/.-=+".contains(c) { c } else { '_' };
        self.folder.join(format!("{}.json", key.chars().map(plain).collect::<String>()))
    }
}

/// Keys of reference solutions begin so.
pub const REFERENCE: &str = "reference/";

/// The file in a folder that names the commits which have measured in it, one per line.
const COMMITS: &str = "commits.txt";

fn noted(folder: &Path) -> Result<Vec<String>> {
    let path = folder.join(COMMITS);
    if !path.exists() {
        return Ok(Vec::new());
    }
    let text = fs::read_to_string(&path).with_context(|| format!("cannot read {}", path.display()))?;
    Ok(text.lines().map(str::to_owned).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn measurements_are_made_once() {
        let folder = tempfile::tempdir().unwrap_or_else(|error| panic!("{error}"));
        let store = Store::new(folder.path(), "first");
        let once = store.measured("a/b c", || Ok(1.5)).expect("written");
        assert_eq!((once, store.take_commits()), (1.5, vec!["first".to_owned()]));
        let later = Store::new(folder.path(), "second");
        let again = later.measured("a/b c", || panic!("measured again")).expect("read");
        assert_eq!((1.5, vec!["first".to_owned()]), (again, later.take_commits()));
        // References do not age with the solver.
        later.measured("reference/a", || Ok(1)).expect("written");
        let named = (later.take_commits(), later.take_references());
        assert_eq!(named, (Vec::new(), vec!["second".to_owned()]));
        // A file that holds something else is measured anew.
        assert_eq!(later.measured("a/b c", || Ok("text".to_owned())).expect("written"), "text");
    }
}
