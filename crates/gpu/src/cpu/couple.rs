//! Twin of `shader/couple.wgsl`.

use super::groups::{M3, V3, between, difference, moments, place, sum, times_spin};
use super::{divided, subtracted};
use crate::assembly::Frame;
use crate::bound::Bound;
use crate::layout::NONE;
use crate::linear::{BLOCK_WORDS, PatchSlot, SLICE};
use bytemuck::{Pod, Zeroable};

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Params {
    pub pairs: u32,
    pub first: u32,
    pub width: u32,
    pub first_frame: u32,
    pub quantum: f32,
}

pub fn bound(buffers: Bound<'_>) {
    let system = System {
        params: buffers.params(),
        pairs: &buffers.read(0),
        slices: &buffers.read(1),
        words: &buffers.read(2),
        slots: &buffers.read(3),
        places: &buffers.read(4),
        positions: &buffers.read(5),
        frames: &buffers.read(6),
    };
    couple(&system, &mut buffers.write(7));
}

pub struct System<'a> {
    pub params: Params,
    pub pairs: &'a [[u32; 2]],
    pub slices: &'a [[u32; 4]],
    pub words: &'a [u32],
    pub slots: &'a [PatchSlot],
    pub places: &'a [u32],
    pub positions: &'a [[i32; 4]],
    pub frames: &'a [Frame],
}

/// A row of H times the motions of the second group.
struct Row {
    shift: M3,
    spin: M3,
}

impl System<'_> {
    fn arm_of(&self, node: u32, frame: &Frame) -> V3 {
        let at = place(self.positions[node as usize]);
        divided(between(frame.center, at, self.params.quantum), frame.size)
    }

    fn add(&self, row: &mut Row, [a, b]: [u32; 2], j: u32, h: &M3, arm: V3, frame: &Frame) {
        let place = self.places[j as usize];
        let is_in_b = place != NONE && place / self.params.width == b;
        if a != b {
            if is_in_b {
                row.shift = sum(&row.shift, h);
                row.spin = sum(&row.spin, &times_spin(h, self.arm_of(j, frame)));
            }
        } else if is_in_b {
            row.spin = sum(&row.spin, &times_spin(h, subtracted(self.arm_of(j, frame), arm)));
        } else {
            row.shift = difference(&row.shift, h);
            row.spin = difference(&row.spin, &times_spin(h, arm));
        }
    }

    fn row(&self, i: u32, pair: [u32; 2], arm: V3, frame: &Frame) -> Row {
        let number = |at: usize| f32::from_bits(self.words[at]);
        let [first, blocks, scalars, _] = self.slices[i as usize / SLICE];
        let mut at = first as usize + i as usize % SLICE;
        let mut row = Row { shift: [[0.0; 3]; 3], spin: [[0.0; 3]; 3] };
        for k in 0..blocks {
            let h = [0, 1, 2].map(|c| [0, 1, 2].map(|r| number(at + (1 + 3 * c + r) * SLICE)));
            if k > 0 {
                self.add(&mut row, pair, self.words[at], &h, arm, frame);
            } else if pair[0] == pair[1] {
                row = Row { shift: h, spin: times_spin(&h, arm) };
            }
            at += BLOCK_WORDS * SLICE;
        }
        for _ in 0..scalars {
            let q = number(at + SLICE);
            let h = [[q, 0.0, 0.0], [0.0, q, 0.0], [0.0, 0.0, q]];
            self.add(&mut row, pair, self.words[at], &h, arm, frame);
            at += 2 * SLICE;
        }
        row
    }
}

pub fn couple(system: &System<'_>, couplings: &mut [f32]) {
    let params = &system.params;
    let (first, width) = (params.first as usize, params.width as usize);
    for t in first..first + params.pairs as usize {
        let pair = system.pairs[t];
        let [own, frame] = pair.map(|g| system.frames[(params.first_frame + g) as usize]);
        let mut total = [[[0.0; 3]; 3]; 4];
        let group = &system.slots[width * pair[0] as usize..][..width];
        for slot in group.iter().filter(|slot| slot.node != NONE) {
            let arm = system.arm_of(slot.node, &own);
            let Row { shift, spin } = system.row(slot.node, pair, arm, &frame);
            let turned = [moments(arm, &shift), moments(arm, &spin)];
            for (total, part) in total.iter_mut().zip([shift, spin, turned[0], turned[1]]) {
                *total = sum(total, &part);
            }
        }
        for (k, number) in couplings[36 * t..36 * t + 36].iter_mut().enumerate() {
            let (r, c) = (k / 6, k % 6);
            *number = total[2 * (r / 3) + c / 3][c % 3][r % 3];
        }
    }
}
