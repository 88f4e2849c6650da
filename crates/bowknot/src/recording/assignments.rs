//! Parameters of the two-way method as assignments to keys of a scene.

use bowknot_twoway::Params;
use toml::{Table, Value};

/// Assignments as `--set` takes them, with which [`bowknot_scene::twoway_params`] gives these parameters: a
/// preset, if it is not the default, and each key that differs from it. None if there are no such
/// assignments.
pub fn assignments(params: &Params) -> Option<Vec<String>> {
    let presets = [("fast", Params::fast()), ("quick", Params::quick()), ("paper", Params::paper())];
    let of_preset = |(name, base): (&str, Params)| {
        let mut sets = Vec::new();
        if base != Params::default() {
            sets.push(format!("contact.preset=\"{name}\""));
        }
        differences("", &Table::try_from(base).ok()?, &Table::try_from(params).ok()?, &mut sets);
        let same = bowknot_scene::twoway_params(&sets).is_ok_and(|read| read == *params);
        same.then_some(sets)
    };
    presets.into_iter().filter_map(of_preset).min_by_key(Vec::len)
}

/// Appends an assignment for every key of `table` that `base` does not have, or with another value.
fn differences(path: &str, base: &Table, table: &Table, sets: &mut Vec<String>) {
    for (key, value) in table {
        match (base.get(key), value) {
            (Some(other), value) if other == value => {}
            (Some(Value::Table(base)), Value::Table(table)) => {
                differences(&format!("{path}{key}."), base, table, sets);
            }
            (_, value) => sets.push(format!("{path}{key}={value}")),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn assignments_give_the_parameters_back() {
        let given: [&[&str]; 5] = [
            &[],
            &["contact.preset=\"paper\""],
            &["contact.preset=\"quick\"", "contact.delta=0.001"],
            &["solver.stop.max_steps=7", "solver.backward.sweeps=12", "contact.friction_model=\"filter\""],
            &["solver.stop.rule=\"clock\"", "solver.forward.damping=0.5"],
        ];
        for sets in given {
            let params = bowknot_scene::twoway_params(sets).expect("parameters");
            let found = assignments(&params).unwrap_or_else(|| panic!("none for {sets:?}"));
            assert_eq!(bowknot_scene::twoway_params(&found).expect("parameters"), params, "{found:?}");
            assert!(found.len() <= sets.len() + 1, "{found:?} for {sets:?}");
        }
    }
}
