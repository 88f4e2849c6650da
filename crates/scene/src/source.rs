//! Where each value of a scene description came from: the file's lines and the assignments.

use crate::error::{SceneError, SceneProblem, nearest};
use crate::origin::{Origin, Origins};
use crate::values::describe;
use bowknot_errors::counted;
use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};
use toml::de::{DeTable, DeValue};
use toml::{Spanned, Table, Value};

/// A parsed description with the origin of its values.
#[derive(Debug, Default)]
pub(crate) struct Source {
    pub table: Table,
    file: Option<PathBuf>,
    lines: HashMap<String, usize>,
    sets: HashSet<String>,
}

impl Source {
    /// Parses the text of a scene file.
    pub fn parse(text: &str, file: &Path) -> Result<Self, SceneError> {
        let syntax = |error: toml::de::Error| {
            let (line, column) = line_column(text, error.span().map_or(0, |s| s.start));
            SceneError::Syntax { file: file.to_owned(), line, column, message: error.message().to_owned() }
        };
        let table: Table = text.parse().map_err(syntax)?;
        let spanned = DeTable::parse(text).map_err(syntax)?;
        let mut lines = HashMap::new();
        record_table(spanned.get_ref(), "", text, &mut lines);
        Ok(Self { table, file: Some(file.to_owned()), lines, sets: HashSet::new() })
    }

    /// A description made in code.
    pub fn from_table(table: Table) -> Self {
        Self { table, ..Self::default() }
    }

    /// Where the value of a key, or of the innermost table around it, came from.
    pub fn origin(&self, key: &str) -> Origin {
        let mut key = key;
        loop {
            if self.sets.contains(key) {
                return Origin::Set;
            }
            if let (Some(file), Some(&line)) = (&self.file, self.lines.get(key)) {
                return Origin::File(file.clone(), Some(line));
            }
            match key.rfind(['.', '[']) {
                Some(end) => key = &key[..end],
                None => break,
            }
        }
        self.file.as_ref().map_or(Origin::Code, |file| Origin::File(file.clone(), None))
    }

    /// Where the keys of the file stand.
    pub fn origins(&self) -> Origins {
        Origins::new(self.file.clone().unwrap_or_default(), self.lines.clone())
    }

    /// A problem with the value of a key.
    pub fn problem(&self, key: &str, message: impl Into<String>) -> SceneProblem {
        SceneProblem { origin: self.origin(key), key: key.to_owned(), message: message.into() }
    }

    /// Applies `KEY.PATH=VALUE`. VALUE is TOML; what is not is taken as a string. A part of the path
    /// that selects from an array (`body`, `obstacle`, `pin`) is an index from 0 or a `name`.
    pub fn set(&mut self, assignment: &str) -> Result<(), SceneProblem> {
        let fault =
            |key: &str, message: String| SceneProblem { origin: Origin::Set, key: key.to_owned(), message };
        let Some((path, text)) = assignment.split_once('=') else {
            return Err(fault(assignment, "an assignment has the form KEY.PATH=VALUE".to_owned()));
        };
        let (path, text) = (path.trim(), text.trim());
        let parts: Vec<&str> = path.split('.').map(str::trim).collect();
        if parts.iter().any(|part| part.is_empty()) {
            return Err(fault(path, "a key path has the form table.key".to_owned()));
        }
        // A value is parsed as the right side of an assignment, on one line.
        let value = match format!("value = {text}").parse::<Table>() {
            Ok(mut table) if table.len() == 1 => {
                table.remove("value").unwrap_or_else(|| Value::String(text.to_owned()))
            }
            _ => Value::String(text.to_owned()),
        };
        let mut key = String::new();
        let mut table = &mut self.table;
        let mut rest = parts.as_slice();
        while let [part, tail @ ..] = rest {
            if !key.is_empty() {
                key.push('.');
            }
            key.push_str(part);
            if tail.is_empty() {
                table.insert((*part).to_owned(), value);
                break;
            }
            let entry = table.entry((*part).to_owned()).or_insert_with(|| Value::Table(Table::new()));
            match entry {
                Value::Table(inner) => {
                    table = inner;
                    rest = tail;
                }
                Value::Array(list) => {
                    let index = select(list, tail[0]).map_err(|message| fault(&key, message))?;
                    key.push_str(&format!("[{index}]"));
                    let element = &mut list[index];
                    if tail.len() == 1 {
                        *element = value;
                        break;
                    }
                    let Value::Table(inner) = element else {
                        return Err(fault(&key, format!("is {}, not a table", describe(element))));
                    };
                    table = inner;
                    rest = &tail[1..];
                }
                // A value such as `material = "cotton"` becomes a table, which keeps what it said.
                other => {
                    let kept = match (*part, &*other) {
                        ("material", Value::String(_)) => Some("base"),
                        ("shape", Value::String(_)) => Some("type"),
                        _ => None,
                    };
                    let kept = kept.map(|key| (key.to_owned(), other.clone()));
                    *other = Value::Table(kept.into_iter().collect());
                    let Value::Table(inner) = other else { break };
                    table = inner;
                    rest = tail;
                }
            }
        }
        self.sets.insert(key);
        Ok(())
    }
}

fn select(list: &[Value], part: &str) -> Result<usize, String> {
    let names: Vec<&str> = list.iter().filter_map(|v| v.get("name").and_then(Value::as_str)).collect();
    let found = match part.parse::<usize>() {
        Ok(index) => (index < list.len()).then_some(index),
        Err(_) => list.iter().position(|v| v.get("name").and_then(Value::as_str) == Some(part)),
    };
    found.ok_or_else(|| {
        let hint =
            nearest(part, names.iter().copied()).map_or(String::new(), |n| format!("; did you mean {n}?"));
        format!(
            "has no entry {part}; it has {}, by index from 0 or by name{hint}",
            counted(list.len(), "entry", "entries")
        )
    })
}

fn record_table(table: &DeTable<'_>, path: &str, text: &str, lines: &mut HashMap<String, usize>) {
    for (key, value) in table {
        let name = key.get_ref();
        let path = if path.is_empty() { name.to_string() } else { format!("{path}.{name}") };
        lines.insert(path.clone(), line_column(text, key.span().start).0);
        record_value(value, &path, text, lines);
    }
}

fn record_value(value: &Spanned<DeValue<'_>>, path: &str, text: &str, lines: &mut HashMap<String, usize>) {
    match value.get_ref() {
        DeValue::Table(table) => record_table(table, path, text, lines),
        DeValue::Array(list) => {
            // Of a mesh given by arrays there may be millions of numbers; their problems are the array's.
            let tables = list.iter().enumerate().filter(|(_, element)| element.get_ref().is_table());
            for (index, element) in tables {
                let path = format!("{path}[{index}]");
                lines.insert(path.clone(), line_column(text, element.span().start).0);
                record_value(element, &path, text, lines);
            }
        }
        _ => {}
    }
}

fn line_column(text: &str, offset: usize) -> (usize, usize) {
    let before = text.get(..offset).unwrap_or(text);
    let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
    (before.matches('\n').count() + 1, before[line_start..].chars().count() + 1)
}
