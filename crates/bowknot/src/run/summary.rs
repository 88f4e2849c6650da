//! What a run adds up to: `summary.json`.

use crate::simulator::StepStatistics;
use bowknot_scene::world::SceneInfo;
use serde::Serialize;
use serde_json::{Map, Value};

/// What a run adds up to; it serialises to `summary.json`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Summary {
    /// Name of the scene.
    pub scene: String,
    /// Counts.
    #[serde(flatten)]
    pub info: SceneInfo,
    /// Time steps made.
    pub frames: usize,
    /// Threads at work.
    pub threads: usize,
    /// "cpu".
    pub backend: String,
    /// Means over the time steps, in the form of [`StepStatistics`]: flags become the share of time steps
    /// where they held.
    pub mean: Value,
    /// Largest values, likewise.
    pub max: Value,
    /// Smallest gap of all time steps [m]; none if no pair was ever listed.
    pub min_gap_m: Option<f64>,
    /// Largest memory resident so far [bytes]; none where the system does not tell.
    pub peak_memory_bytes: Option<u64>,
    /// Intersections found in accepted states and on the paths between them; none if not checked.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub intersections: Option<usize>,
}

/// Sums and maxima of the statistics of time steps.
#[derive(Clone, Debug, Default)]
pub(super) struct Totals {
    steps: usize,
    sum: Value,
    count: Value,
    max: Value,
    min_gap: Option<f64>,
}

impl Totals {
    pub fn add(&mut self, statistics: &StepStatistics) {
        // Which time step it is, and when, have no mean.
        let Ok(Value::Object(mut values)) = serde_json::to_value(statistics) else { return };
        values.remove("step");
        values.remove("time");
        values.remove("slowest_body");
        let values = Value::Object(values);
        self.steps += 1;
        merge(&mut self.sum, &values, &|sum, x| sum + x);
        merge(&mut self.max, &values, &f64::max);
        merge(&mut self.count, &map(&values, &|_| 1.0), &|sum, x| sum + x);
        self.min_gap = match (self.min_gap, statistics.min_gap_m) {
            (Some(a), Some(b)) => Some(a.min(b)),
            (a, b) => a.or(b),
        };
    }

    pub fn steps(&self) -> usize {
        self.steps
    }

    pub fn mean(&self) -> Value {
        let mut mean = self.sum.clone();
        merge(&mut mean, &self.count, &|sum, count| sum / count);
        mean
    }

    pub fn max(&self) -> Value {
        self.max.clone()
    }

    pub fn min_gap(&self) -> Option<f64> {
        self.min_gap
    }
}

/// The number that a leaf stands for; flags count as 0 and 1, null and text as nothing.
fn number(value: &Value) -> Option<f64> {
    match value {
        Value::Bool(flag) => Some(f64::from(u8::from(*flag))),
        other => other.as_f64(),
    }
}

/// Applies `f` to every number.
fn map(value: &Value, f: &impl Fn(f64) -> f64) -> Value {
    match value {
        Value::Object(fields) => {
            Value::Object(fields.iter().map(|(key, value)| (key.clone(), map(value, f))).collect())
        }
        Value::Array(list) => Value::Array(list.iter().map(|value| map(value, f)).collect()),
        leaf => number(leaf).map_or(Value::Null, |x| Value::from(f(x))),
    }
}

/// Combines every number of `b` into the number at the same place of `a`; where `a` has none it takes
/// that of `b`.
fn merge(a: &mut Value, b: &Value, f: &impl Fn(f64, f64) -> f64) {
    match b {
        Value::Object(fields) => {
            if !a.is_object() {
                *a = Value::Object(Map::new());
            }
            for (key, value) in fields {
                merge(&mut a[key.as_str()], value, f);
            }
        }
        Value::Array(list) => {
            if !a.is_array() {
                *a = Value::Array(vec![Value::Null; list.len()]);
            }
            for (index, value) in list.iter().enumerate() {
                merge(&mut a[index], value, f);
            }
        }
        leaf => {
            if let Some(x) = number(leaf) {
                *a = Value::from(number(a).map_or(x, |y| f(y, x)));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn means_and_maxima_skip_what_is_missing() {
        let step = |pairs, converged, min_gap_m, z| StepStatistics {
            pairs,
            converged,
            min_gap_m,
            momentum: [0.0, 0.0, z],
            ..StepStatistics::default()
        };
        let mut totals = Totals::default();
        totals.add(&step(10, true, None, -3.0));
        totals.add(&step(20, false, Some(0.002), -1.0));
        totals.add(&step(60, false, Some(0.001), -2.0));
        let (mean, max) = (totals.mean(), totals.max());
        assert_eq!(mean["pairs"], 30.0);
        assert_eq!(mean["converged"], 1.0 / 3.0);
        assert_eq!(mean["min_gap_m"], 0.0015);
        assert_eq!(mean["momentum"][2], -2.0);
        assert_eq!(max["pairs"], 60.0);
        assert_eq!(max["momentum"][2], -1.0);
        assert_eq!(totals.min_gap(), Some(0.001));
        assert_eq!(totals.steps(), 3);
        assert!(mean.get("step").is_none());
    }
}
