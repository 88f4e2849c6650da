//! Twin of `shader/color.wgsl`.

use crate::bound::Bound;
use crate::layout::{Bucket, COLORS, NONE, Row};
use bytemuck::{Pod, Zeroable};
use std::ops::Range;

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Params {
    pub first: u32,
    pub end: u32,
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
        &mut buffers.write(5),
        &mut buffers.write(6),
        &mut buffers.write(7),
    );
}

const FEWEST_SETTLED: usize = 64;

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
    buckets: &mut [Bucket],
    in_use: &mut [[u32; 4]],
    claims: &mut [u32],
    waiting: &mut [u32],
    order: &mut [u32],
    color_ends: &mut [u32],
) {
    let moving = |row: &Row| {
        let vertices = row.vertices.map(|v| v as usize);
        vertices.into_iter().filter(|v| displacements[*v][3] > 0.0)
    };
    for bucket in &mut buckets[params.first as usize..params.end as usize] {
        let [first, end] = [bucket.first, bucket.end].map(|place| place as usize);
        waiting[first..end].copy_from_slice(&order[first..end]);
        let (mut count, mut here, mut next) = (end - first, first, params.capacity as usize + first);
        let mut round = 0;
        while count > 0 {
            for place in here..here + count {
                rows[waiting[place] as usize].vertices.iter().for_each(|v| claims[*v as usize] = NONE);
            }
            for place in here..here + count {
                let row = &rows[waiting[place] as usize];
                moving(row).for_each(|v| claims[v] = claims[v].min(key_of(row.candidate)));
            }
            if round == 0 {
                for place in here..here + count {
                    moving(&rows[waiting[place] as usize]).for_each(|v| in_use[v] = [0; 4]);
                }
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
            let before = count;
            (here, next, count) = (next, here, left);
            round += 1;
            if FEWEST_SETTLED * (before - count) < before {
                break;
            }
        }
        waiting[here..here + count].iter().for_each(|r| rows[*r as usize].color = COLORS as u32);
        let uncolored = sort_by_color(bucket, rows, waiting, order, color_ends);
        bucket.most = split_masses(&order[uncolored], displacements, rows, claims);
    }
}

/// Returns the places of the rows without a color.
fn sort_by_color(
    bucket: &mut Bucket,
    rows: &[Row],
    waiting: &mut [u32],
    order: &mut [u32],
    color_ends: &mut [u32],
) -> Range<usize> {
    let [first, end] = [bucket.first, bucket.end].map(|place| place as usize);
    let mut places = [0; COLORS + 1];
    waiting[first..end].copy_from_slice(&order[first..end]);
    waiting[first..end].iter().for_each(|r| places[rows[*r as usize].color as usize] += 1);
    let (mut sum, mut color) = (first, 0);
    while color < COLORS && places[color] > 0 {
        let rows_of_color = std::mem::replace(&mut places[color], sum);
        sum += rows_of_color;
        color_ends[first + color] = sum as u32;
        color += 1;
    }
    bucket.colors = color as u32;
    places[COLORS] = sum;
    for &r in &waiting[first..end] {
        let place = &mut places[rows[r as usize].color as usize];
        order[*place] = r;
        *place += 1;
    }
    sum..end
}

/// The diagonals of the rows without a color. Returns how many of them a vertex has at most.
fn split_masses(uncolored: &[u32], displacements: &[[f32; 4]], rows: &mut [Row], claims: &mut [u32]) -> u32 {
    let parts = |row: &Row| {
        let all = row.vertices.map(|v| v as usize).into_iter().zip(row.weights);
        all.filter(|(v, weight)| displacements[*v][3] > 0.0 && *weight != 0.0)
    };
    for &r in uncolored {
        parts(&rows[r as usize]).for_each(|(v, _)| claims[v] = 0);
    }
    for &r in uncolored {
        parts(&rows[r as usize]).for_each(|(v, _)| claims[v] += 1);
    }
    let mut most = 0;
    for &r in uncolored {
        let row = &mut rows[r as usize];
        let mut diagonal = 0.0;
        for (v, weight) in parts(row) {
            most = most.max(claims[v]);
            diagonal += claims[v] as f32 * displacements[v][3] * weight * weight;
        }
        row.inverse_diagonal = if diagonal > 0.0 { 1.0 / diagonal } else { 0.0 };
    }
    most
}
