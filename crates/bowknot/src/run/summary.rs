//! The summary of a run: `summary.json`.

use super::backends::CPU;
use crate::simulator::{HeldApart, StepStatistics, Unsolved, WaitingElements};
use bowknot_scene::world::SceneInfo;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};
use std::collections::BTreeMap;

/// The summary of a run; it serializes to `summary.json`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
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
    /// What resolved the collisions: "cpu", or "gpu: " and the device.
    pub backend: String,
    /// What computed the dynamics, likewise.
    #[serde(default = "cpu")]
    pub dynamics_backend: String,
    /// Means over the time steps; none without a time step.
    pub mean: Option<StepNumbers>,
    /// Largest values over the time steps; none without a time step.
    pub max: Option<StepNumbers>,
    /// Smallest gap of all time steps [m]; none if there never was a candidate pair.
    pub min_gap_m: Option<f64>,
    /// The time step with the most two-way steps, if a step was so slow that it tells what it waited for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub slowest_step: Option<SlowStep>,
    /// Time steps that ended unsolved, see [`StepStatistics::solved`].
    #[serde(default)]
    pub unsolved_steps: usize,
    /// The first of them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub first_unsolved: Option<UnsolvedStep>,
    /// The obstacles that waited to appear, by name.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub waits_to_appear: BTreeMap<String, WaitToAppear>,
    /// Time steps in which pins held edges over their stretch limits, see [`StepStatistics::held_apart`].
    #[serde(default, skip_serializing_if = "is_zero")]
    pub held_apart_steps: usize,
    /// That of them in which they asked for most.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub most_held_apart: Option<HeldApartStep>,
    /// Largest resident memory so far [bytes]; none where the system does not report it.
    pub peak_memory_bytes: Option<u64>,
    /// Intersections found in accepted states and on the paths between them; none if not checked.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub intersections: Option<usize>,
}

/// What computed the dynamics of runs whose summary does not say it.
fn cpu() -> String {
    CPU.to_owned()
}

/// A slow time step.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SlowStep {
    /// Its index, from 1.
    pub step: usize,
    /// Two-way steps.
    pub two_way_steps: usize,
    /// What held back the vertices that had farthest to go.
    pub waits: Vec<WaitingElements>,
}

/// A time step that ended unsolved.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct UnsolvedStep {
    /// Its index, from 1.
    pub step: usize,
    /// Residual at its end [m].
    pub residual_m: f64,
    /// Tolerance of the residual [m]; 0 if there is none.
    pub tolerance_m: f64,
    /// The bodies and the place where forces are out of balance, if known.
    #[serde(flatten)]
    pub at: Option<Unsolved>,
}

/// How an obstacle waited to appear.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct WaitToAppear {
    /// Time steps that it waited.
    pub steps: usize,
    /// What was in its place at first, in words.
    pub in_the_way: String,
}

/// A time step in which pins held edges over their stretch limits.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct HeldApartStep {
    /// Its index, from 1.
    pub step: usize,
    /// Where, and by how much.
    #[serde(flatten)]
    pub at: HeldApart,
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde asks for it")]
fn is_zero(count: &usize) -> bool {
    *count == 0
}

/// The numbers of [`StepStatistics`], combined over time steps. Each is none if no time step has it; flags
/// count as 0 and 1. The fields are in alphabetical order, as in the file.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[expect(missing_docs, reason = "the fields are documented in StepStatistics")]
#[serde(default)]
pub struct StepNumbers {
    pub active_rows: Option<f64>,
    pub asleep_vertices: Option<f64>,
    pub center_of_mass: [Option<f64>; 3],
    pub cg_iterations: Option<f64>,
    pub collision_energy_j: Option<f64>,
    pub contact_rows: Option<f64>,
    pub converged: Option<f64>,
    pub cpu_seconds: Option<f64>,
    pub edge_rows: Option<f64>,
    pub energy: EnergyNumbers,
    pub friction_rows: Option<f64>,
    pub frozen_pairs: Option<f64>,
    pub injected_energy_j: Option<f64>,
    pub interior_solves: Option<f64>,
    pub inverted_tets: Option<f64>,
    pub max_speed: Option<f64>,
    pub max_step_stretch: Option<f64>,
    pub max_stretch: Option<f64>,
    pub min_gap_m: Option<f64>,
    pub momentum: [Option<f64>; 3],
    pub newton_iterations: Option<f64>,
    pub pairs: Option<f64>,
    pub prescribed_lag_m: Option<f64>,
    pub pressing_contacts: Option<f64>,
    pub remaining_m: Option<f64>,
    pub remaining_r: Option<f64>,
    pub repulsion_springs: Option<f64>,
    pub residual_m: Option<f64>,
    pub residual_n: Option<f64>,
    pub searches: Option<f64>,
    pub seconds: SecondsNumbers,
    pub skipped: SkippedNumbers,
    pub solved: Option<f64>,
    pub stationarity_m: Option<f64>,
    pub tolerance_m: Option<f64>,
    pub two_way_steps: Option<f64>,
    pub waiting: BTreeMap<String, Option<f64>>,
}

/// The numbers of [`crate::simulator::Energy`].
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[expect(missing_docs, reason = "the fields are documented in Energy")]
#[serde(default)]
pub struct EnergyNumbers {
    pub elastic: Option<f64>,
    pub kinetic: Option<f64>,
    pub potential: Option<f64>,
}

/// The numbers of [`crate::simulator::StepSeconds`].
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[expect(missing_docs, reason = "the fields are documented in StepSeconds")]
#[serde(default)]
pub struct SecondsNumbers {
    pub backward: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub device: Option<f64>,
    pub dynamics: Option<f64>,
    pub evaluate: Option<f64>,
    pub forward: Option<f64>,
    pub other: Option<f64>,
    pub search: Option<f64>,
    pub total: Option<f64>,
}

/// The numbers of [`crate::twoway::Skipped`].
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[expect(missing_docs, reason = "the fields are documented in Skipped")]
#[serde(default)]
pub struct SkippedNumbers {
    pub evaluations: Option<f64>,
    pub rows: Option<f64>,
    pub searches: Option<f64>,
}

/// Sums and maxima of the statistics of time steps.
#[derive(Clone, Debug, Default)]
pub(super) struct Totals {
    steps: usize,
    sum: Value,
    count: Value,
    max: Value,
    min_gap: Option<f64>,
    slowest: Option<SlowStep>,
    unsolved_steps: usize,
    first_unsolved: Option<UnsolvedStep>,
    waits_to_appear: BTreeMap<String, WaitToAppear>,
    held_apart_steps: usize,
    most_held_apart: Option<HeldApartStep>,
}

impl Totals {
    pub fn add(&mut self, statistics: &StepStatistics) {
        // The index, the time, names, places and what was waited for have no mean.
        let Ok(Value::Object(mut values)) = serde_json::to_value(statistics) else { return };
        values.remove("step");
        values.remove("time");
        values.remove("slowest_body");
        values.remove("waits");
        values.remove("unsolved");
        values.remove("absent");
        for (name, wait) in &statistics.absent {
            if let Some(in_the_way) = wait {
                let first = || WaitToAppear { steps: 0, in_the_way: in_the_way.clone() };
                self.waits_to_appear.entry(name.clone()).or_insert_with(first).steps += 1;
            }
        }
        values.remove("held_apart");
        if let Some(at) = &statistics.held_apart {
            self.held_apart_steps += 1;
            if self.most_held_apart.as_ref().is_none_or(|most| at.excess > most.at.excess) {
                self.most_held_apart = Some(HeldApartStep { step: statistics.step, at: at.clone() });
            }
        }
        if !statistics.solved {
            self.unsolved_steps += 1;
            let StepStatistics { step, residual_m, tolerance_m, .. } = *statistics;
            let at = statistics.unsolved.clone();
            self.first_unsolved.get_or_insert(UnsolvedStep { step, residual_m, tolerance_m, at });
        }
        let slowest = self.slowest.as_ref().map_or(0, |slowest| slowest.two_way_steps);
        if !statistics.waits.is_empty() && statistics.two_way_steps > slowest {
            let StepStatistics { step, two_way_steps, .. } = *statistics;
            self.slowest = Some(SlowStep { step, two_way_steps, waits: statistics.waits.clone() });
        }
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

    pub fn mean(&self) -> serde_json::Result<Option<StepNumbers>> {
        let mut mean = self.sum.clone();
        merge(&mut mean, &self.count, &|sum, count| sum / count);
        serde_json::from_value(mean)
    }

    pub fn max(&self) -> serde_json::Result<Option<StepNumbers>> {
        serde_json::from_value(self.max.clone())
    }

    pub fn slowest(&self) -> Option<&SlowStep> {
        self.slowest.as_ref()
    }

    pub fn unsolved_steps(&self) -> usize {
        self.unsolved_steps
    }

    pub fn first_unsolved(&self) -> Option<&UnsolvedStep> {
        self.first_unsolved.as_ref()
    }

    pub fn waits_to_appear(&self) -> &BTreeMap<String, WaitToAppear> {
        &self.waits_to_appear
    }

    pub fn held_apart_steps(&self) -> usize {
        self.held_apart_steps
    }

    pub fn most_held_apart(&self) -> Option<&HeldApartStep> {
        self.most_held_apart.as_ref()
    }

    pub fn min_gap(&self) -> Option<f64> {
        self.min_gap
    }
}

/// The number of a leaf: flags are 0 and 1; null and text are none.
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

/// Combines every number of `b` with the number at the same place of `a`. Where `a` has no number, it takes
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
        let mean = totals.mean().unwrap().unwrap();
        let max = totals.max().unwrap().unwrap();
        assert_eq!(mean.pairs, Some(30.0));
        assert_eq!(mean.converged, Some(1.0 / 3.0));
        assert_eq!(mean.min_gap_m, Some(0.0015));
        assert_eq!(mean.momentum[2], Some(-2.0));
        assert_eq!(max.pairs, Some(60.0));
        assert_eq!(max.momentum[2], Some(-1.0));
        assert_eq!(totals.min_gap(), Some(0.001));
        assert_eq!(totals.steps(), 3);
        assert_eq!(Totals::default().mean().unwrap(), None);
    }

    #[test]
    fn the_first_unsolved_step_is_kept_and_all_are_counted() {
        let step = |step, residual_m, solved: bool| {
            let unsolved = (!solved)
                .then(|| Unsolved { bodies: vec!["strip".to_owned(), "left".to_owned()], place_m: [9.0; 3] });
            let tolerance_m = 0.1;
            StepStatistics { step, residual_m, tolerance_m, solved, unsolved, ..StepStatistics::default() }
        };
        let mut totals = Totals::default();
        totals.add(&step(1, 0.1, true));
        assert_eq!((totals.unsolved_steps(), totals.first_unsolved()), (0, None));
        [step(2, 0.2, false), step(3, 0.4, false), step(4, 0.0, true)].iter().for_each(|s| totals.add(s));
        assert_eq!(totals.unsolved_steps(), 2);
        let first = totals.first_unsolved().unwrap();
        assert_eq!(
            serde_json::to_string(first).unwrap(),
            r#"{"step":2,"residual_m":0.2,"tolerance_m":0.1,"bodies":["strip","left"],"place_m":[9.0,9.0,9.0]}"#
        );
        let read: UnsolvedStep = serde_json::from_str(&serde_json::to_string(first).unwrap()).unwrap();
        assert_eq!(&read, first);
        let mean = totals.mean().unwrap().unwrap();
        assert_eq!((mean.solved, totals.max().unwrap().unwrap().residual_m), (Some(0.5), Some(0.4)));
        let nowhere = UnsolvedStep { step: 7, ..UnsolvedStep::default() };
        let text = serde_json::to_string(&nowhere).unwrap();
        assert_eq!(text, r#"{"step":7,"residual_m":0.0,"tolerance_m":0.0}"#);
        assert_eq!(serde_json::from_str::<UnsolvedStep>(&text).unwrap(), nowhere);
    }

    /// Statistics of earlier versions do not say whether a time step was solved.
    #[test]
    fn lines_without_the_flag_are_not_called_unsolved() {
        let mut line = serde_json::to_value(StepStatistics::default()).unwrap();
        let fields = line.as_object_mut().unwrap();
        assert!(fields.remove("solved").is_some() && fields.remove("tolerance_m").is_some());
        let mut totals = Totals::default();
        totals.add(&serde_json::from_value(line).unwrap());
        assert_eq!(totals.unsolved_steps(), 0);
    }

    /// A resumed run reads the statistics of its first part back.
    #[test]
    fn statistics_that_are_read_have_the_same_bits() {
        // Fast parsers round this number to its neighbor.
        let statistics =
            StepStatistics { max_step_stretch: 1.310_944_399_681_963_9, ..StepStatistics::default() };
        let read: StepStatistics =
            serde_json::from_str(&serde_json::to_string(&statistics).unwrap()).unwrap();
        assert_eq!(read.max_step_stretch.to_bits(), statistics.max_step_stretch.to_bits());
    }

    /// Reading the combined statistics into the struct loses no key, changes no number and keeps the order.
    #[test]
    fn the_struct_has_every_number_of_the_statistics() {
        let mut totals = Totals::default();
        let statistics = StepStatistics {
            pairs: 3,
            max_speed: f64::NAN,
            waiting: BTreeMap::from([("pin[0] of flag".to_owned(), 0.1)]),
            ..StepStatistics::default()
        };
        totals.add(&statistics);
        totals.add(&StepStatistics { converged: true, ..statistics });
        let typed = serde_json::to_string_pretty(&totals.max().unwrap()).unwrap();
        assert_eq!(typed, serde_json::to_string_pretty(&totals.max).unwrap());
        let read: Option<StepNumbers> = serde_json::from_str(&typed).unwrap();
        assert_eq!(read, totals.max().unwrap());
    }
}
