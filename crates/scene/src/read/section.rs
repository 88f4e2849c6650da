//! From TOML tables to structs, key by key, so that every problem is reported with its key.

use crate::error::{SceneProblem, nearest};
use crate::explain::explain;
use crate::fields::field_names;
use crate::source::Source;
use crate::values::{describe, join};
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::cell::RefCell;
use toml::{Table, Value};

/// What is wrong with a description, in the order in which it is read.
pub struct Problems<'a> {
    source: &'a Source,
    found: RefCell<Vec<SceneProblem>>,
}

impl<'a> Problems<'a> {
    pub fn new(source: &'a Source) -> Self {
        Self { source, found: RefCell::default() }
    }

    /// The whole description.
    pub fn root(&self) -> Section<'_> {
        Section { problems: self, table: self.source.table.clone(), path: String::new() }
    }

    pub fn into_found(self) -> Vec<SceneProblem> {
        self.found.into_inner()
    }
}

/// A table of a description. What is wrong with it goes to the problems of the whole.
pub struct Section<'a> {
    problems: &'a Problems<'a>,
    table: Table,
    /// Its path from the root, such as `solver.backward`; empty for the root.
    path: String,
}

impl Section<'_> {
    /// A `table` at a key.
    pub fn at(&self, key: &str, table: Table) -> Self {
        Self { problems: self.problems, table, path: join(&self.path, key) }
    }

    /// Reports the value of a key.
    pub fn fail(&self, key: &str, message: impl Into<String>) {
        self.fail_at(&join(&self.path, key), message);
    }

    /// Warns of the value of a key, which is used all the same.
    pub fn warn(&self, key: &str, message: impl Into<String>) {
        tracing::warn!("{}", self.problems.source.problem(&join(&self.path, key), message));
    }

    fn fail_at(&self, path: &str, message: impl Into<String>) {
        self.problems.found.borrow_mut().push(self.problems.source.problem(path, message));
    }

    pub fn keys(&self) -> impl Iterator<Item = &str> {
        self.table.keys().map(String::as_str)
    }

    pub fn get(&self, key: &str) -> Option<&Value> {
        self.table.get(key)
    }

    /// Takes the value of a key out.
    pub fn remove(&mut self, key: &str) -> Option<Value> {
        self.table.remove(key)
    }

    /// The table at a key, empty if there is none.
    pub fn table(&self, key: &str) -> Self {
        let table = match self.get(key) {
            None => Table::new(),
            Some(Value::Table(table)) => table.clone(),
            Some(other) => {
                self.fail(key, format!("must be a table, not {}", describe(other)));
                Table::new()
            }
        };
        self.at(key, table)
    }

    /// The tables of an array of tables.
    pub fn tables(&self, key: &str) -> Vec<Self> {
        let path = join(&self.path, key);
        let list = match self.get(key) {
            None => return Vec::new(),
            Some(Value::Array(list)) => list,
            Some(other) => {
                let message = format!("must be an array of tables, [[{path}]], not {}", describe(other));
                self.fail(key, message);
                return Vec::new();
            }
        };
        let table = |(index, element): (usize, &Value)| {
            let path = format!("{path}[{index}]");
            match element {
                Value::Table(table) => Some(Self { problems: self.problems, table: table.clone(), path }),
                other => {
                    self.fail_at(&path, format!("must be a table, not {}", describe(other)));
                    None
                }
            }
        };
        list.iter().enumerate().filter_map(table).collect()
    }

    /// Reports keys that are not among those known.
    pub fn check_keys(&self, known: &[&str]) {
        for key in self.keys().filter(|key| !known.contains(key)) {
            let message = match nearest(key, known.iter().copied()) {
                Some(meant) => format!("unknown key; did you mean {}?", join(&self.path, meant)),
                None => {
                    let mut sorted = known.to_vec();
                    sorted.sort_unstable();
                    format!("unknown key; known here: {}", sorted.join(", "))
                }
            };
            self.fail(key, message);
        }
    }

    /// Reads those keys that are fields of `T` over `base`, except for `nested` ones, which the caller reads.
    /// Other keys are left to [`Self::check_keys`].
    pub fn fields<T>(&self, base: &T, nested: &[&str]) -> T
    where
        T: Serialize + DeserializeOwned + Default + Clone,
    {
        // `base` may hold nested values that come in another form; they are dropped here and kept from
        // `base` by the callers, which set them.
        let mut merged = Table::try_from(base).unwrap_or_default();
        nested.iter().for_each(|key| {
            merged.remove(*key);
        });
        for &field in field_names::<T>() {
            let Some(value) = self.get(field).filter(|_| !nested.contains(&field)) else { continue };
            let mut alone = Table::new();
            alone.insert(field.to_owned(), value.clone());
            match T::deserialize(Value::Table(alone)) {
                Ok(_) => {
                    merged.insert(field.to_owned(), value.clone());
                }
                Err(error) => self.fail(field, explain(error.message(), value)),
            }
        }
        T::deserialize(Value::Table(merged)).unwrap_or_else(|_| base.clone())
    }

    /// Reads all keys as a `T`, over `base`, except for `nested` ones: unknown keys are problems.
    pub fn structure_over<T>(&self, base: &T, nested: &[&str]) -> T
    where
        T: Serialize + DeserializeOwned + Default + Clone,
    {
        self.check_keys(field_names::<T>());
        self.fields(base, nested)
    }

    /// Reads all keys as a `T`, over its defaults, except for `nested` ones: unknown keys are problems.
    pub fn structure<T>(&self, nested: &[&str]) -> T
    where
        T: Serialize + DeserializeOwned + Default + Clone,
    {
        self.structure_over(&T::default(), nested)
    }
}
