//! Names of primitives.

use std::collections::HashSet;

/// The attribute by which our stages say that a body is an obstacle.
pub(super) const OBSTACLE: &str = "bowknot:obstacle";

/// Names of bodies that USD allows, all different.
pub(super) fn identifiers<'a>(names: impl Iterator<Item = &'a str>) -> Vec<String> {
    // `cloth_strands` may be the name of another body, or that of the strands of `cloth`.
    let clashes = |id: &String, taken: &[String]| {
        let kin =
            |a: &str, b: &str| ["", "_strands", "_particles"].iter().any(|end| a == format!("{b}{end}"));
        taken.iter().any(|other| kin(id, other) || kin(other, id))
    };
    let mut taken: Vec<String> = Vec::new();
    for name in names {
        let unique = numbered(&allowed(name), |id| clashes(id, &taken));
        taken.push(unique);
    }
    taken
}

/// Names of the children of one primitive that USD allows, all different.
pub(super) fn children<'a>(names: impl Iterator<Item = &'a str>) -> Vec<String> {
    let mut taken = HashSet::new();
    let mut unique = |name| {
        let id = numbered(&allowed(name), |id| taken.contains(id));
        taken.insert(id.clone());
        id
    };
    names.map(&mut unique).collect()
}

/// The name with underscores in the place of what USD does not allow.
fn allowed(name: &str) -> String {
    let mut id: String =
        name.chars().map(|c| if c.is_ascii_alphanumeric() || c == '_' { c } else { '_' }).collect();
    if id.is_empty() || id.starts_with(|c: char| c.is_ascii_digit()) {
        id.insert(0, '_');
    }
    id
}

/// The name, with the first number that makes it free if it is not.
fn numbered(id: &str, is_taken: impl Fn(&String) -> bool) -> String {
    let mut unique = id.to_owned();
    let mut number = 2;
    while is_taken(&unique) {
        unique = format!("{id}_{number}");
        number += 1;
    }
    unique
}
