//! Runs every stage on a device and by its twin, from the same buffers, and notes where they differ.

use super::device::DeviceEngine;
use super::traits::Engine;
use super::twin::TwinEngine;
use crate::error::GpuError;
use crate::recording::{BufferId, Command, Dispatch, Recording};
use crate::stages::Access;
use bowknot_dynamics::DeviceWork;
use std::collections::BTreeMap;

/// Bindings whose content depends on the order of the threads; no result does.
const UNORDERED: [(&str, usize); 3] = [("sort_rows", 3), ("color_rows", 5), ("color_rows", 6)];

/// Largest relative difference of two floating-point numbers, and, relative to the largest number of a
/// buffer, the largest absolute one: rounding, which sums and differences of a stage amplify.
const RELATIVE: f32 = 1e-4;
const ABSOLUTE: f32 = 4e-6;

/// Stages that amplify rounding, and the relative difference of their numbers: inverses of matrices do by
/// their condition number.
const AMPLIFYING: [(&str, f32); 2] = [("invert_domains", 0.05), ("factor_diagonal", 0.05)];

/// Stages that write displacements or widths of slabs, in steps of the grid, the smallest of these numbers
/// that are meant, and by how many steps they may differ: where large terms cancel, what is left is their
/// rounding. GPUs fuse products with sums, and divide by reciprocals.
const STEPS_OF_THE_GRID: [(&str, f32, f32); 4] = [
    ("separate", 1e3, 128.0),
    ("sweep_rows", 0.0, 0.5),
    ("sweep_edges", 0.0, 0.5),
    ("coarse_rescale", 0.0, 0.5),
];

/// Largest share of the words of a stage that differ on hardware although it computes the same: where a number is
/// compared with a threshold, rounding decides. On an H200 7e-4 of the words of `advance_vertices` do, and 2e-5 of
/// `separate`.
const MOST_DIFFERENT: f64 = 2e-3;

/// Bindings with what is left of forces that cancel: their rounding, where inertia leads bodies where they go.
const CANCELING: [(&str, usize); 1] = [("combine_guesses", 6)];

/// Integers above this can be coordinates, which may be rounded differently; the others are equal.
const SMALLEST_COORDINATE: u32 = 1 << 16;

/// A word that a kernel computes in another way than its twin.
#[derive(Clone, Debug, PartialEq)]
pub struct Difference {
    /// The stage.
    pub stage: &'static str,
    /// Which dispatch it was, from 0.
    pub dispatch: usize,
    /// The buffer, by its place among those of the stage.
    pub binding: usize,
    /// The word.
    pub word: usize,
    /// Its bits by the twin.
    pub twin: u32,
    /// Its bits by the device.
    pub device: u32,
}

/// Runs stages twice, and goes on with the results of the twins. A driver that computes something else than
/// the twins, by more than rounding, is told by the stage that does so.
#[derive(Debug)]
pub struct ComparingEngine {
    device: DeviceEngine,
    twin: TwinEngine,
    dispatches: usize,
    /// Words that were compared, by stage.
    words: BTreeMap<&'static str, usize>,
    differences: Vec<Difference>,
}

impl ComparingEngine {
    /// Compares that device with the twins.
    pub fn new(device: DeviceEngine) -> Self {
        Self {
            device,
            twin: TwinEngine::new(),
            dispatches: 0,
            words: BTreeMap::new(),
            differences: Vec::new(),
        }
    }

    /// Words that were compared.
    pub fn words_compared(&self) -> usize {
        self.words.values().sum()
    }

    /// Those that differed by more than rounding.
    pub fn differences(&self) -> &[Difference] {
        &self.differences
    }

    /// The differences that arithmetic of another kind does not explain. On a software driver, which rounds as the
    /// twins do, those are all; on others, those in stages of whose words more than 0.2 % differ, but for what is
    /// left of forces that cancel.
    pub fn faults(&self) -> Vec<Difference> {
        if self.device.is_software() {
            return self.differences.clone();
        }
        let is_meant =
            |difference: &&Difference| !CANCELING.contains(&(difference.stage, difference.binding));
        let mut counts = BTreeMap::new();
        for difference in self.differences.iter().filter(is_meant) {
            *counts.entry(difference.stage).or_insert(0) += 1;
        }
        let is_fault = |difference: &&Difference| {
            let words = self.words[difference.stage] as f64;
            f64::from(counts[difference.stage]) > MOST_DIFFERENT * words
        };
        self.differences.iter().filter(is_meant).filter(is_fault).cloned().collect()
    }

    fn dispatch(&mut self, dispatch: &Dispatch) -> Result<(), GpuError> {
        let mut alone = Recording::default();
        alone.commands.push(Command::Dispatch(dispatch.clone()));
        let is_written = |(_, access): &(usize, &Access)| **access == Access::Write;
        let written = dispatch.stage.bindings.iter().enumerate().filter(is_written).map(|(k, _)| k);
        let written: Vec<usize> = written.collect();
        let read: Vec<(BufferId, usize)> =
            written.iter().map(|&k| (dispatch.buffers[k], self.twin.words(dispatch.buffers[k]))).collect();
        let results = self.device.run(&alone, &read)?;
        self.twin.dispatch(dispatch);
        let mut corrections = Recording::default();
        for ((&binding, device), (buffer, _)) in written.iter().zip(&results).zip(&read) {
            let twin = self.twin.content(*buffer);
            *self.words.entry(dispatch.stage.name).or_insert(0) += twin.len();
            if *twin == *device {
                continue;
            }
            corrections.write(*buffer, &twin);
            if !UNORDERED.contains(&(dispatch.stage.name, binding)) {
                let name = dispatch.stage.name;
                let amplifies = AMPLIFYING.iter().find(|(stage, _)| *stage == name);
                let relative = amplifies.map_or(RELATIVE, |(_, relative)| *relative);
                let steps = STEPS_OF_THE_GRID.iter().find(|(stage, ..)| *stage == name);
                let is_rounding = |word: usize| {
                    let [x, y] = [twin[word], device[word]].map(f32::from_bits);
                    steps.is_some_and(|(_, least, most)| x.abs() >= *least && (x - y).abs() <= *most)
                };
                let differing = differing(&twin, device, relative).filter(|&word| !is_rounding(word));
                let differences = differing.map(|word| Difference {
                    stage: name,
                    dispatch: self.dispatches,
                    binding,
                    word,
                    twin: twin[word],
                    device: device[word],
                });
                self.differences.extend(differences);
            }
        }
        self.device.run(&corrections, &[])?;
        self.dispatches += 1;
        Ok(())
    }
}

impl Engine for ComparingEngine {
    fn buffer(&mut self, label: &'static str, words: usize) -> Result<BufferId, GpuError> {
        let buffer = self.device.buffer(label, words)?;
        let twin = self.twin.buffer(label, words)?;
        debug_assert_eq!(buffer, twin);
        Ok(buffer)
    }

    fn free(&mut self, buffer: BufferId) {
        self.device.free(buffer);
        self.twin.free(buffer);
    }

    fn clear(&mut self) {
        self.device.clear();
        self.twin.clear();
    }

    fn words(&self, buffer: BufferId) -> usize {
        self.twin.words(buffer)
    }

    fn most_words(&self) -> usize {
        self.device.most_words()
    }

    fn work(&self) -> DeviceWork {
        self.twin.work()
    }

    fn run(&mut self, recording: &Recording, read: &[(BufferId, usize)]) -> Result<Vec<Vec<u32>>, GpuError> {
        for command in &recording.commands {
            match command {
                Command::Dispatch(dispatch) => self.dispatch(dispatch)?,
                Command::Write { buffer, words } => {
                    self.twin.write(*buffer, words);
                    let mut write = Recording::default();
                    write.commands.push(command.clone());
                    self.device.run(&write, &[])?;
                    debug_assert!(words.len() <= self.words(*buffer));
                }
            }
        }
        self.twin.run(&Recording::default(), read)
    }
}

/// The words that differ by more than rounding.
fn differing<'a>(twin: &'a [u32], device: &'a [u32], relative: f32) -> impl Iterator<Item = usize> + 'a {
    let size = |word: &u32| {
        let number = f32::from_bits(*word).abs();
        // A bit pattern beyond all lengths is no length: a mark, or what is not a number.
        if number < 1e20 { number } else { 0.0 }
    };
    let largest = twin.iter().map(size).fold(0.0, f32::max);
    (0..twin.len()).filter(move |&word| !agree(twin[word], device[word], largest, relative))
}

fn agree(a: u32, b: u32, largest: f32, relative: f32) -> bool {
    if a == b {
        return true;
    }
    let [x, y] = [a, b].map(f32::from_bits);
    // Small integers are tiny as floating-point numbers, and so are coordinates.
    if x.abs().max(y.abs()) > 1e-30 {
        return (x - y).abs() <= relative * x.abs().max(y.abs()) + relative / RELATIVE * ABSOLUTE * largest;
    }
    if x == y {
        // Zeros of both signs.
        return x == 0.0 && (a | b) == 1 << 31;
    }
    let [i, j] = [a, b].map(|bits| bits as i32);
    let magnitude = i.unsigned_abs().max(j.unsigned_abs());
    magnitude >= SMALLEST_COORDINATE && i.abs_diff(j) <= 1 + magnitude / (1 << 20)
}

#[cfg(test)]
mod tests {
    use super::RELATIVE;

    fn agree(a: u32, b: u32, largest: f32) -> bool {
        super::agree(a, b, largest, RELATIVE)
    }

    #[test]
    fn rounding_agrees_and_other_counts_do_not() {
        let bits = f32::to_bits;
        assert!(agree(bits(1.0), bits(1.00001), 1.0) && agree(bits(0.0), bits(-1e-6), 1.0));
        assert!(!agree(bits(1.0), bits(1.001), 1.0) && !agree(bits(1.0), bits(f32::NAN), 1.0));
        assert!(agree(bits(0.0), bits(-0.0), 1.0) && agree(100_000_000, 100_000_001, 1.0));
        assert!(!agree(4, 5, 1.0) && !agree(14_000, 14_001, 1.0) && !agree(0, 1, 1.0));
    }
}
