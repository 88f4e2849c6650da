//! `stats.jsonl` as columns.

use bowknot_io::IoError;
use serde_json::{Map, Value};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// Longest path of a key that is kept. A damaged file could repeat a long one for each of its numbers.
const MAX_KEY: usize = 200;

/// Every number of every time step, by the path of its key: `energy.kinetic`, `momentum.2`.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Columns {
    pub(super) rows: usize,
    /// Lines that are no JSON object.
    pub(super) damaged: usize,
    /// Keys of few rows that were left out, because their columns would take more memory than the file
    /// justifies.
    pub(super) rare: usize,
    /// Rows that have a number, ascending, and the number.
    values: BTreeMap<String, Vec<(usize, f64)>>,
}

impl Columns {
    /// Reads the file; one that is missing has no rows.
    pub(super) fn read(path: &Path) -> Result<Self, IoError> {
        match fs::read(path) {
            Ok(bytes) => Ok(Self::parse(&String::from_utf8_lossy(&bytes))),
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(Self::default()),
            Err(source) => Err(IoError::system("read", path, source)),
        }
    }

    pub(super) fn parse(text: &str) -> Self {
        let mut columns = Self::default();
        for line in text.lines().filter(|line| !line.trim().is_empty()) {
            match object(line) {
                Some(fields) => {
                    fields.iter().for_each(|(key, value)| columns.add(key, value));
                    columns.rows += 1;
                }
                None => columns.damaged += 1,
            }
        }
        columns.drop_rare(text.len());
        columns
    }

    /// Drops the columns of the fewest numbers until there are no more places for numbers than bytes in the
    /// file. A sound file has ten bytes for each.
    fn drop_rare(&mut self, bytes: usize) {
        let fitting = bytes.max(1 << 16) / self.rows.max(1);
        if self.values.len() <= fitting {
            return;
        }
        let mut lengths: Vec<usize> = self.values.values().map(Vec::len).collect();
        lengths.sort_unstable_by(|a, b| b.cmp(a));
        let fewest = lengths[fitting];
        let before = self.values.len();
        self.values.retain(|_, column| column.len() > fewest);
        self.rare += before - self.values.len();
    }

    fn add(&mut self, key: &str, value: &Value) {
        if key.len() > MAX_KEY {
            self.rare += 1;
            return;
        }
        match value {
            Value::Object(fields) => fields.iter().for_each(|(k, v)| self.add(&format!("{key}.{k}"), v)),
            Value::Array(list) => {
                list.iter().enumerate().for_each(|(k, v)| self.add(&format!("{key}.{k}"), v));
            }
            Value::Number(_) | Value::Bool(_) => {
                let number = match value {
                    Value::Bool(flag) => Some(f64::from(u8::from(*flag))),
                    other => other.as_f64().filter(|x| x.is_finite()).map(short),
                };
                let Some(number) = number else { return };
                let column = self.values.entry(key.to_owned()).or_default();
                // A key may be there twice, as "a.b" and as "b" of "a".
                if column.last().is_none_or(|(row, _)| *row < self.rows) {
                    column.push((self.rows, number));
                }
            }
            // Words cannot be plotted.
            Value::String(_) | Value::Null => {}
        }
    }

    /// The time at the end of a time step [s], if it was recorded.
    pub(super) fn time(&self, step: usize) -> Option<f64> {
        let (row, _) = self.values.get("step")?.iter().rfind(|(_, s)| *s == step as f64)?;
        let times = self.values.get("time")?;
        times.binary_search_by_key(row, |(row, _)| *row).ok().map(|place| times[place].1)
    }

    /// Key to list of numbers and nulls; columns of nothing are left out.
    pub(super) fn to_json(&self) -> Value {
        let full = |column: &Vec<(usize, f64)>| {
            let mut values = vec![Value::Null; self.rows];
            column.iter().for_each(|&(row, number)| values[row] = Value::from(number));
            Value::from(values)
        };
        Value::Object(self.values.iter().map(|(key, column)| (key.clone(), full(column))).collect())
    }
}

/// A line as an object. Some writers of JSON put NaN and Infinity, which are none: they become null.
fn object(line: &str) -> Option<Map<String, Value>> {
    let parse = |text: &str| serde_json::from_str::<Map<String, Value>>(text).ok();
    parse(line).or_else(|| {
        parse(&line.replace("-Infinity", "null").replace("Infinity", "null").replace("NaN", "null"))
    })
}

/// Seven significant digits: more than a plot shows, a third of the bytes.
fn short(value: f64) -> f64 {
    format!("{value:.6e}").parse().unwrap_or(value)
}
