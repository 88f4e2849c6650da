//! From TOML tables to structs, key by key, so that every problem is reported with its key.

use crate::error::{SceneProblem, nearest};
use crate::explain::explain;
use crate::fields::field_names;
use crate::source::Source;
use crate::values::{describe, join};
use serde::Serialize;
use serde::de::DeserializeOwned;
use toml::{Table, Value};

/// Reads tables and collects what is wrong with them.
pub(crate) struct Reader<'a> {
    source: &'a Source,
    pub problems: Vec<SceneProblem>,
}

impl<'a> Reader<'a> {
    pub fn new(source: &'a Source) -> Self {
        Self { source, problems: Vec::new() }
    }

    pub fn fail(&mut self, key: &str, message: impl Into<String>) {
        self.problems.push(self.source.problem(key, message));
    }

    /// Warns of the value of a key, which is used all the same.
    pub fn warn(&self, key: &str, message: impl Into<String>) {
        tracing::warn!("{}", self.source.problem(key, message));
    }

    /// The table at a key, empty if there is none.
    pub fn table(&mut self, parent: &Table, path: &str, key: &str) -> Table {
        match parent.get(key) {
            None => Table::new(),
            Some(Value::Table(table)) => table.clone(),
            Some(other) => {
                let message = format!("must be a table, not {}", describe(other));
                self.fail(&join(path, key), message);
                Table::new()
            }
        }
    }

    /// The tables of an array of tables, with the path of each.
    pub fn tables(&mut self, parent: &Table, path: &str, key: &str) -> Vec<(Table, String)> {
        let path = join(path, key);
        match parent.get(key) {
            None => Vec::new(),
            Some(Value::Array(list)) => {
                let mut tables = Vec::new();
                for (index, element) in list.iter().enumerate() {
                    let path = format!("{path}[{index}]");
                    match element {
                        Value::Table(table) => tables.push((table.clone(), path)),
                        other => self.fail(&path, format!("must be a table, not {}", describe(other))),
                    }
                }
                tables
            }
            Some(other) => {
                let message = format!("must be an array of tables, [[{path}]], not {}", describe(other));
                self.fail(&path, message);
                Vec::new()
            }
        }
    }

    /// Reports keys of a table that are not among those known.
    pub fn check_keys(&mut self, table: &Table, path: &str, known: &[&str]) {
        for key in table.keys().filter(|key| !known.contains(&key.as_str())) {
            let message = match nearest(key, known.iter().copied()) {
                Some(meant) => format!("unknown key; did you mean {}?", join(path, meant)),
                None => {
                    let mut sorted = known.to_vec();
                    sorted.sort_unstable();
                    format!("unknown key; known here: {}", sorted.join(", "))
                }
            };
            self.fail(&join(path, key), message);
        }
    }

    /// Reads those keys of `table` that are fields of `T` over `base`, except for `nested` ones, which
    /// the caller reads. Other keys are left to [`Self::check_keys`].
    pub fn fields<T>(&mut self, base: &T, table: &Table, path: &str, nested: &[&str]) -> T
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
            let Some(value) = table.get(field).filter(|_| !nested.contains(&field)) else { continue };
            let mut alone = Table::new();
            alone.insert(field.to_owned(), value.clone());
            match T::deserialize(Value::Table(alone)) {
                Ok(_) => {
                    merged.insert(field.to_owned(), value.clone());
                }
                Err(error) => {
                    self.fail(&join(path, field), explain(error.message(), value));
                }
            }
        }
        T::deserialize(Value::Table(merged)).unwrap_or_else(|_| base.clone())
    }

    /// Reads a whole table as a `T`: unknown keys are problems.
    pub fn structure<T>(&mut self, table: &Table, path: &str, nested: &[&str]) -> T
    where
        T: Serialize + DeserializeOwned + Default + Clone,
    {
        self.check_keys(table, path, field_names::<T>());
        self.fields(&T::default(), table, path, nested)
    }

    /// Reads a whole table as a `T`, over `base`: unknown keys are problems.
    pub fn structure_over<T>(&mut self, base: &T, table: &Table, path: &str) -> T
    where
        T: Serialize + DeserializeOwned + Default + Clone,
    {
        self.check_keys(table, path, field_names::<T>());
        self.fields(base, table, path, &[])
    }
}
