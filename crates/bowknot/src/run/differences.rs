//! What differs between the scene of a run and the one that shall continue it.

use bowknot_errors::counted;
use toml::{Table, Value};

/// Largest number of differences that are named.
const MAX_NAMED: usize = 8;

/// The keys in which two resolved scenes differ, each with both values; none if a run of the first can be
/// continued with the second. The name, the number of frames and what is written may differ.
pub(super) fn differences(there: &str, here: &str) -> Option<String> {
    let (Some(there), Some(here)) = (parse(there), parse(here)) else {
        return Some("scene.toml, which is not TOML".to_owned());
    };
    let mut found = Vec::new();
    compare_tables(&there, &here, "", &mut found);
    if found.is_empty() {
        return None;
    }
    let rest = found.len().saturating_sub(MAX_NAMED);
    found.truncate(MAX_NAMED);
    let rest = if rest > 0 { format!(", and {rest} more") } else { String::new() };
    Some(format!("{}{rest}", found.join(", ")))
}

/// The scene without what may differ.
fn parse(text: &str) -> Option<Table> {
    let mut table: Table = text.parse().ok()?;
    table.remove("output");
    if let Some(Value::Table(simulation)) = table.get_mut("simulation") {
        simulation.remove("frames");
        simulation.remove("name");
    }
    Some(table)
}

fn compare(there: &Value, here: &Value, path: &str, found: &mut Vec<String>) {
    match (there, here) {
        (Value::Table(there), Value::Table(here)) => compare_tables(there, here, path, found),
        (Value::Array(there), Value::Array(here))
            if there.len() == here.len() && there.iter().any(Value::is_table) =>
        {
            for (index, (there, here)) in there.iter().zip(here).enumerate() {
                compare(there, here, &format!("{path}[{index}]"), found);
            }
        }
        _ if there != here => found.push(format!("{path} ({} there, {} here)", shown(there), shown(here))),
        _ => {}
    }
}

fn compare_tables(there: &Table, here: &Table, path: &str, found: &mut Vec<String>) {
    let join = |key: &str| if path.is_empty() { key.to_owned() } else { format!("{path}.{key}") };
    for (key, value) in there {
        match here.get(key) {
            Some(other) => compare(value, other, &join(key), found),
            None => found.push(format!("{} ({} there, not given here)", join(key), shown(value))),
        }
    }
    for (key, value) in here.iter().filter(|(key, _)| !there.contains_key(*key)) {
        found.push(format!("{} (not given there, {} here)", join(key), shown(value)));
    }
}

/// A value on one line, long ones by their size.
fn shown(value: &Value) -> String {
    match value {
        Value::Table(table) => format!("a table of {}", counted(table.len(), "key", "keys")),
        Value::Array(list) if list.len() > 4 => format!("{} entries", list.len()),
        _ => value.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_difference_is_named_with_both_values() {
        let scene = |name: &str, delta: f64, pin: &str| {
            format!(
                "{pin}\n[simulation]\nname = \"{name}\"\nframes = 3\n[contact]\ndelta = \
                 {delta}\n[[body]]\nscale = {delta}"
            )
        };
        assert_eq!(differences(&scene("a", 0.5, ""), &scene("b", 0.5, "")), None);
        let found = differences(&scene("a", 0.5, ""), &scene("b", 0.25, "pin = [1]")).expect("differences");
        assert_eq!(
            found,
            "body[0].scale (0.5 there, 0.25 here), contact.delta (0.5 there, 0.25 here), \
             pin (not given there, [1] here)"
        );
        let many: String = (0..12).map(|i| format!("k{i:02} = 1\n")).collect();
        let found = differences(&many, "").expect("differences");
        assert!(
            found.starts_with("k00 (1 there, not given here), ") && found.ends_with(", and 4 more"),
            "{found}"
        );
    }
}
