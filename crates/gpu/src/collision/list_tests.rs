//! Places in lists: sums of numbers, by the kernels and their twins.
#![allow(clippy::unwrap_used)] // helpers of tests are outside the functions that the lint knows as tests

use super::buffers::words;
use crate::adapter::Adapter;
use crate::engine::{ComparingEngine, DeviceEngine, Engine};
use crate::kernels;
use crate::kernels::scan_counts::{CANDIDATES, CONTACT_ROWS};
use crate::layout::{Bucket, Control, NONE};
use crate::recording::Recording;

fn engine() -> ComparingEngine {
    let adapter = Adapter::choose(None).unwrap_or_else(|error| panic!("{error}"));
    ComparingEngine::new(DeviceEngine::open(&adapter).unwrap())
}

/// Places of so many entries of each row in a list of `capacity`, by kernels and twins, which must agree.
fn places(counts: &[u32], capacity: u32, list: u32, control: Control) -> (Vec<u32>, Control) {
    let mut engine = engine();
    let rows = counts.len();
    let block_count = rows.div_ceil(kernels::SCAN_COUNTS.workgroup);
    let starts = engine.buffer("starts", rows + 1).unwrap();
    let blocks = engine.buffer("blocks", block_count).unwrap();
    let kept = engine.buffer("control", words::<Control>(1)).unwrap();
    let mut recording = Recording::default();
    recording.write(starts, counts);
    recording.write(kept, &[control]);
    let params = kernels::scan_counts::Params { rows: rows as u32, list };
    recording.dispatch(&kernels::SCAN_COUNTS, &[starts, blocks, kept], params, rows);
    let params = kernels::scan_blocks::Params { blocks: block_count as u32, capacity, list };
    recording.dispatch(&kernels::SCAN_BLOCKS, &[blocks, kept], params, 1);
    let params = kernels::scan_places::Params { rows: rows as u32, list };
    recording.dispatch(&kernels::SCAN_PLACES, &[blocks, starts, kept], params, rows);
    let read = engine.run(&recording, &[(starts, rows + 1), (kept, words::<Control>(1))]).unwrap();
    assert_eq!(engine.differences(), []);
    (read[0].clone(), bytemuck::cast_slice(&read[1])[0])
}

/// A total that wraps could be less than the list holds: pairs would be missing, and nothing would tell.
#[test]
fn numbers_of_candidates_beyond_32_bits_overflow_the_list() {
    // The sum is 2^32 + 300: within a block, over blocks, and over rounds of blocks.
    for (rows, count) in [(200, 1 << 25), (600, 1 << 23), (300 * kernels::SCAN_COUNTS.workgroup, 1 << 17)] {
        let mut counts = vec![count; rows];
        let sum = |counts: &[u32]| counts.iter().map(|count| u64::from(*count)).sum::<u64>();
        counts[0] = ((1u64 << 32) + 300).saturating_sub(sum(&counts[1..])).max(7) as u32;
        assert!(sum(&counts) >= (1 << 32) + 300 && (sum(&counts) as u32) < u32::MAX);
        let control = Control { changed: 1, ..Control::default() };
        let (starts, control) = places(&counts, 1000, CANDIDATES, control);
        assert_eq!((control.candidates, control.overflow), (u32::MAX, 1), "{rows} rows");
        assert!(starts.is_sorted() && starts[rows] == u32::MAX);
    }
}

/// Rows of a list have one number per candidate; what lies beyond the candidates is not looked at.
#[test]
fn numbers_beyond_the_candidates_are_not_added() {
    for candidates in [0, 1, 255, 256, 1000, 3000] {
        let counts: Vec<u32> = (0..3000).map(|c| u32::from(c % 3 == 0)).collect();
        let control = Control { candidates, ..Control::default() };
        let (starts, control) = places(&counts, 3000, CONTACT_ROWS, control);
        let used = candidates as usize;
        assert_eq!((control.rows, control.overflow), (candidates.div_ceil(3), 0));
        assert!((0..=used).all(|c| starts[c] == (c as u32).div_ceil(3)), "{candidates}");
        assert!((used + 1..counts.len()).all(|c| starts[c] == counts[c]), "{candidates}");
    }
}

#[test]
fn one_workgroup_adds_any_number_of_blocks_and_buckets() {
    let mut random = fastrand::Rng::with_seed(7);
    for count in [1, 255, 256, 257, 2049, 70_001] {
        let numbers: Vec<u32> = (0..count).map(|_| random.u32(..1000)).collect();
        let mut sum = 0;
        let ends: Vec<u32> = numbers
            .iter()
            .map(|number| {
                sum += number;
                sum
            })
            .collect();
        let mut engine = engine();
        let [blocks, tally] = [0; 2].map(|_| engine.buffer("numbers", count).unwrap());
        let control = engine.buffer("control", words::<Control>(1)).unwrap();
        let buckets = engine.buffer("buckets", words::<Bucket>(count)).unwrap();
        let mut recording = Recording::default();
        recording.write(blocks, &numbers);
        recording.write(tally, &numbers);
        recording.write(control, &[Control { changed: 1, ..Control::default() }]);
        let params = kernels::scan_blocks::Params { blocks: count as u32, capacity: NONE, list: CANDIDATES };
        recording.dispatch(&kernels::SCAN_BLOCKS, &[blocks, control], params, 1);
        let params = kernels::scan_buckets::Params { buckets: count as u32 };
        recording.dispatch(&kernels::SCAN_BUCKETS, &[tally, buckets], params, 1);
        let wanted = [(blocks, count), (control, words::<Control>(1)), (buckets, words::<Bucket>(count))];
        let read = engine.run(&recording, &wanted).unwrap();
        assert_eq!(engine.differences(), []);
        let starts: Vec<u32> = ends.iter().zip(&numbers).map(|(end, number)| end - number).collect();
        assert_eq!(read[0], starts);
        assert_eq!(bytemuck::cast_slice::<u32, Control>(&read[1])[0].candidates, sum);
        let buckets: &[Bucket] = bytemuck::cast_slice(&read[2]);
        assert!(
            buckets
                .iter()
                .zip(starts.iter().zip(&ends))
                .all(|(b, (start, end))| (b.first, b.end) == (*start, *end))
        );
    }
}
