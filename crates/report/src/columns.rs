//! `stats.jsonl` as columns.

use bowknot_io::IoError;
use serde_json::{Map, Value};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// Every number of every time step, by the path of its key: `energy.kinetic`, `momentum.2`.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Columns {
    pub(super) rows: usize,
    /// Lines that are no JSON object.
    pub(super) damaged: usize,
    values: BTreeMap<String, Vec<Option<f64>>>,
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
        let rows = columns.rows;
        columns.values.values_mut().for_each(|column| column.resize(rows, None));
        columns
    }

    fn add(&mut self, key: &str, value: &Value) {
        match value {
            Value::Object(fields) => fields.iter().for_each(|(k, v)| self.add(&format!("{key}.{k}"), v)),
            Value::Array(list) => {
                list.iter().enumerate().for_each(|(k, v)| self.add(&format!("{key}.{k}"), v));
            }
            Value::Number(_) | Value::Bool(_) | Value::Null => {
                let number = match value {
                    Value::Bool(flag) => Some(f64::from(u8::from(*flag))),
                    other => other.as_f64().filter(|x| x.is_finite()).map(short),
                };
                let column = self.values.entry(key.to_owned()).or_default();
                // Rows before that had no such key.
                column.resize(self.rows, None);
                column.push(number);
            }
            // Words cannot be plotted.
            Value::String(_) => {}
        }
    }

    /// The time at the end of a time step [s], if it was recorded.
    pub(super) fn time(&self, step: usize) -> Option<f64> {
        let steps = self.values.get("step")?;
        let row = steps.iter().rposition(|&s| s == Some(step as f64))?;
        self.values.get("time")?.get(row).copied().flatten()
    }

    /// Key to list of numbers and nulls; columns of nothing are left out.
    pub(super) fn to_json(&self) -> Value {
        let filled = self.values.iter().filter(|(_, column)| column.iter().any(Option::is_some));
        Value::Object(filled.map(|(key, column)| (key.clone(), Value::from(column.clone()))).collect())
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
