//! Twin of `shader/invert.wgsl`.

use crate::bound::Bound;
use crate::layout::NONE;
use crate::linear::{PatchSlot, Spring};
use bytemuck::{Pod, Zeroable};

/// Smallest pivot as a share of the trace.
const MIN_PIVOT: f32 = 2e-7;

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Params {
    pub slots: u32,
    pub springs: u32,
}

pub fn bound(buffers: Bound<'_>) {
    invert(buffers.params(), &buffers.read(0), &buffers.read(1), &buffers.read(2), &mut buffers.write(3));
}

pub fn invert(
    params: Params,
    diagonal: &[f32],
    springs: &[Spring],
    spring_words: &[u32],
    slots: &mut [PatchSlot],
) {
    let used = slots.iter_mut().take(params.slots as usize);
    for slot in used.filter(|slot| slot.node != NONE) {
        let i = slot.node as usize;
        let mut m = [0, 1, 2, 3, 4, 5].map(|k| diagonal[6 * i + k]);
        if params.springs > 0 {
            let entries = spring_words[i] as usize..spring_words[i + 1] as usize;
            for entry in spring_words[entries].chunks_exact(2) {
                let weight = f32::from_bits(entry[1]);
                let [x, y, z] = springs[entry[0] as usize].hessian;
                let squared = weight * weight;
                for (sum, number) in m.iter_mut().zip([x[0], x[1], x[2], y[1], y[2], z[2]]) {
                    *sum += squared * number;
                }
            }
        }
        let trace = m[0] + m[3] + m[5];
        let unit = 1.0 / trace;
        let m = m.map(|number| number * unit);
        let first = m[0].max(MIN_PIVOT);
        let (xy, xz) = (m[1] / first, m[2] / first);
        let second = (m[3] - xy * m[1]).max(MIN_PIVOT);
        let rest = m[4] - xy * m[2];
        let yz = rest / second;
        let third = (m[5] - xz * m[2] - yz * rest).max(MIN_PIVOT);
        slot.factors = [xy, xz, yz, unit / first, unit / second, unit / third];
    }
}
