//! Checks what a scene says about contacts beside the parameters of the collision stage.

use crate::body::{BodySpec, ObstacleSpec};
use crate::description::Scene;
use crate::error::{SceneProblem, nearest};
use crate::source::Source;
use crate::values::join;
use std::collections::BTreeSet;

type Faults = Vec<(&'static str, String)>;

/// Contact keys of a body.
pub(super) fn validate_body(body: &BodySpec, faults: &mut Faults) {
    at_least_0("friction", Some(body.friction), faults);
    at_least_0("thickness", body.thickness, faults);
    if let Some(delta) = body.delta
        && !(delta.is_finite() && delta > 0.0)
    {
        faults.push(("delta", format!("{delta} must be finite and above 0")));
    }
    if let Some(limit) = body.stretch_limit
        && (limit.is_nan() || limit <= 1.0)
    {
        faults.push(("stretch_limit", format!("{limit} must be above 1, or inf for no limit")));
    }
}

/// Contact keys of an obstacle.
pub(super) fn validate_obstacle(obstacle: &ObstacleSpec, faults: &mut Faults) {
    at_least_0("friction", Some(obstacle.friction), faults);
    at_least_0("thickness", obstacle.thickness, faults);
}

fn at_least_0(key: &'static str, value: Option<f64>, faults: &mut Faults) {
    if let Some(value) = value
        && !(value.is_finite() && value >= 0.0)
    {
        faults.push((key, format!("{value} must be finite and at least 0")));
    }
}

/// The pairs with friction of their own: names exist, no pair is named twice.
pub(super) fn validate_pairs(scene: &Scene, source: &Source, problems: &mut Vec<SceneProblem>) {
    let names: Vec<&str> = scene.bodies.iter().map(|b| b.name.as_str()).collect();
    let obstacles: Vec<&str> = scene.obstacles.iter().map(|o| o.name.as_str()).collect();
    let all = || names.iter().chain(&obstacles).copied();
    let mut seen = BTreeSet::new();
    for (index, pair) in scene.friction_pairs.iter().enumerate() {
        let path = format!("contact.friction_pairs[{index}]");
        let mut faults = Vec::new();
        at_least_0("friction", Some(pair.friction), &mut faults);
        for name in &pair.bodies {
            if !all().any(|known| known == name) {
                let hint = nearest(name, all()).map_or_else(String::new, |n| format!("; did you mean {n}?"));
                faults.push(("bodies", format!("no body or obstacle {name:?}{hint}")));
            }
        }
        if pair.bodies.iter().all(|name| obstacles.contains(&name.as_str())) {
            faults.push(("bodies", "two obstacles never touch; one of the two must be a body".to_owned()));
        }
        let mut sides = pair.bodies.clone();
        sides.sort_unstable();
        if !seen.insert(sides) {
            faults.push(("bodies", "the pair is named by an entry above already".to_owned()));
        }
        problems.extend(faults.into_iter().map(|(key, message)| source.problem(&join(&path, key), message)));
    }
}
