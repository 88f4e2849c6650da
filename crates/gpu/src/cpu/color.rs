//! Twin of `shader/color.wgsl`.

use crate::bound::Bound;
use crate::layout::{COLORS, Control, NONE, Row};
use bytemuck::{Pod, Zeroable};

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Params {
    pub capacity: u32,
}

pub fn bound(buffers: Bound<'_>) {
    color(
        buffers.params(),
        &buffers.read(0),
        &mut buffers.write(1),
        &mut buffers.write(2),
        &mut buffers.write(3),
        &mut buffers.write(4),
        &buffers.read::<Control>(5)[0],
    );
}

fn key_of(candidate: u32) -> u32 {
    candidate.wrapping_mul(0x9e37_79b1)
}

fn first_free(used: [u32; 4]) -> usize {
    let word = used.iter().position(|word| *word != u32::MAX);
    word.map_or(COLORS, |word| 32 * word + (!used[word]).trailing_zeros() as usize)
}

pub fn color(
    params: Params,
    displacements: &[[f32; 4]],
    rows: &mut [Row],
    in_use: &mut [[u32; 4]],
    claims: &mut [u32],
    waiting: &mut [u32],
    control: &Control,
) {
    let moving = |row: &Row| {
        let vertices = row.vertices.map(|v| v as usize);
        vertices.into_iter().filter(|v| displacements[*v][3] > 0.0)
    };
    let (mut count, mut here) = (control.waiting.min(params.capacity) as usize, 0);
    let mut next = params.capacity as usize;
    while count > 0 {
        for place in here..here + count {
            rows[waiting[place] as usize].vertices.iter().for_each(|v| claims[*v as usize] = NONE);
        }
        for place in here..here + count {
            let row = &rows[waiting[place] as usize];
            moving(row).for_each(|v| claims[v] = claims[v].min(key_of(row.candidate)));
        }
        let mut left = 0;
        for place in here..here + count {
            let row = &mut rows[waiting[place] as usize];
            let key = key_of(row.candidate);
            if moving(row).any(|v| claims[v] != key) {
                waiting[next + left] = waiting[place];
                left += 1;
                continue;
            }
            let used = moving(row).fold([0; 4], |used, v| [0, 1, 2, 3].map(|k| used[k] | in_use[v][k]));
            let color = first_free(used);
            row.color = color as u32;
            if color < COLORS {
                moving(row).for_each(|v| in_use[v][color / 32] |= 1 << (color % 32));
            }
        }
        (here, next, count) = (next, here, left);
    }
}
