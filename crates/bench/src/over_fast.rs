//! Methods against `fast`, over several scenes.

use crate::summary::{Compared, Summary, ratios};
use crate::table::{geometric_mean, largest, smallest};

/// A method against `fast`: ratios as geometric mean, smallest and largest over the scenes; counts over all
/// problems.
pub struct OverFast {
    pub name: String,
    pub cpu: [f64; 3],
    pub error: [f64; 3],
    pub problems: usize,
    /// Problems of scenes that have reference solutions.
    pub referenced: usize,
    pub failed: usize,
    pub met: usize,
    pub intersections: usize,
}

/// Methods with their own parameters against `fast`.
pub fn against_fast(compared: &[Compared], methods: &[&str]) -> Vec<OverFast> {
    let over_fast = |name: &str| {
        let count = |value: fn(&Summary) -> usize| {
            compared.iter().filter_map(|c| c.find(name, "")).map(value).sum::<usize>()
        };
        let spread = |ratios: Vec<f64>| [geometric_mean, smallest, largest].map(|of| of(&ratios));
        let (method, fast) = ((name, ""), ("fast", ""));
        OverFast {
            name: name.to_owned(),
            cpu: spread(ratios(compared, method, fast, |s, _| s.cpu)),
            error: spread(ratios(compared, method, fast, |s, referenced| s.error(referenced))),
            problems: count(|s| s.problems),
            referenced: count(|s| if s.distance_to_reference.is_some() { s.problems } else { 0 }),
            failed: count(|s| s.failed),
            met: count(|s| s.met),
            intersections: count(|s| s.intersections),
        }
    };
    methods.iter().copied().map(over_fast).collect()
}
