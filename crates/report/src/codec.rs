//! Positions as bytes: quantized to 16 bits a coordinate, predicted, deflated, base64.
//!
//! A coordinate is a multiple of 1/65535 of the edge of the body's box, so that an error is at most half of
//! that. Of a frame, what a *predictor* misses is kept: the base is nothing, the frame before, or the two
//! before carried on in a straight line; and where it pays the miss of the vertex before is subtracted, since
//! neighbors miss alike. Low and high bytes lie apart, so that the high ones, mostly 0, deflate to almost
//! nothing. `assets/app/data.js` is the inverse.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use bowknot_geometry::{Point, Vector};
use flate2::Compression;
use flate2::write::ZlibEncoder;
use std::io::Write;

/// Largest quantized coordinate.
const LEVELS: f64 = 65535.0;
/// Bit of a mode that tells that the miss of the vertex before is subtracted; the bits below count the frames
/// that the base is made of.
const NEIGHBOR: u8 = 4;

/// The grid of a body.
#[derive(Clone, Copy, Debug)]
pub(super) struct Grid {
    low: Point,
    /// Distance between two levels of each axis [m].
    pub(super) step: Vector,
}

impl Grid {
    pub(super) fn new(low: Point, high: Point) -> Self {
        Self { low, step: (high - low) / LEVELS }
    }

    /// Largest distance between a point of the box and what becomes of it [m].
    pub(super) fn error(&self) -> f64 {
        0.5 * self.step.norm()
    }

    pub(super) fn quantize(&self, p: &Point) -> [u16; 3] {
        std::array::from_fn(|k| {
            let step = self.step[k];
            // A saturating cast: points of the box are within the levels but for rounding.
            if step > 0.0 { ((p[k] - self.low[k]) / step).round() as u16 } else { 0 }
        })
    }

    #[cfg(test)]
    pub(super) fn point(&self, q: [u16; 3]) -> Point {
        self.low + Vector::from_fn(|k, _| f64::from(q[k]) * self.step[k])
    }
}

/// Encodes the frames of one body in order.
#[derive(Clone, Debug, Default)]
pub(super) struct Predictor {
    /// The last frame and the one before.
    past: [Vec<[u16; 3]>; 2],
    frames: usize,
}

impl Predictor {
    /// Appends a frame: a byte that names the mode, then for each axis the low and the high bytes of all
    /// vertices.
    pub(super) fn encode(&mut self, frame: Vec<[u16; 3]>, bytes: &mut Vec<u8>) {
        let orders = self.frames.min(2) as u8;
        let modes = (0..=orders).flat_map(|order| [order, order | NEIGHBOR]);
        let cost = |mode: u8| -> u64 { (0..3).map(|axis| self.cost(&frame, axis, mode)).sum() };
        let mode = modes.min_by_key(|&mode| cost(mode)).unwrap_or(0);
        bytes.push(mode);
        for axis in 0..3 {
            let misses: Vec<u16> = self.misses(&frame, axis, mode).collect();
            bytes.extend(misses.iter().map(|&m| m as u8));
            bytes.extend(misses.iter().map(|&m| (m >> 8) as u8));
        }
        self.past.swap(0, 1);
        self.past[0] = frame;
        self.frames += 1;
    }

    /// Bits that the misses take, about.
    fn cost(&self, frame: &[[u16; 3]], axis: usize, mode: u8) -> u64 {
        self.misses(frame, axis, mode).map(|m| u64::from(16 - m.leading_zeros())).sum()
    }

    /// What the predictor misses, modulo 2^16, small magnitudes as small numbers whatever their sign.
    fn misses<'a>(&'a self, frame: &'a [[u16; 3]], axis: usize, mode: u8) -> impl Iterator<Item = u16> + 'a {
        let mut before = 0u16;
        frame.iter().enumerate().map(move |(vertex, q)| {
            let past = |k: usize| self.past[k][vertex][axis];
            let base = match mode & !NEIGHBOR {
                0 => 0,
                1 => past(0),
                _ => past(0).wrapping_mul(2).wrapping_sub(past(1)),
            };
            let miss = q[axis].wrapping_sub(base);
            let kept = if mode & NEIGHBOR != 0 { miss.wrapping_sub(before) } else { miss };
            before = miss;
            zigzag(kept)
        })
    }
}

/// 0, -1, 1, -2, .. as 0, 1, 2, 3, ..
fn zigzag(value: u16) -> u16 {
    (value << 1) ^ (((value as i16) >> 15) as u16)
}

/// Indices as the differences to those before, low bytes first, each of the four bytes apart.
pub(super) fn encode_indices<const N: usize>(rows: &[[u32; N]]) -> Vec<u8> {
    let mut before = 0u32;
    let differences: Vec<u32> = rows
        .iter()
        .flatten()
        .map(|&index| {
            let difference = index.wrapping_sub(before);
            before = index;
            (difference << 1) ^ (((difference as i32) >> 31) as u32)
        })
        .collect();
    (0..4).flat_map(|byte| differences.iter().map(move |d| (d >> (8 * byte)) as u8)).collect()
}

/// Deflates (zlib, so that damage is noticed) and writes as base64.
pub(super) fn pack(bytes: &[u8]) -> String {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::new(7));
    // Writing to memory does not fail.
    let deflated = encoder.write_all(bytes).and_then(|()| encoder.finish()).unwrap_or_default();
    STANDARD.encode(deflated)
}
