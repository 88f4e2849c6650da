//! Twin of `shader/domain.wgsl`.

use crate::assembly::Frame;
use crate::bound::Bound;
use crate::layout::NONE;
use crate::linear::{CHILDREN, DOMAIN_UNKNOWNS, DOMAIN_WORDS};
use bytemuck::{Pod, Zeroable};

/// Added to the diagonal, relative to it.
const SHIFT: f32 = 4e-6;

/// A pivot of at most this share of its diagonal entry counts as zero.
const ZERO_PIVOT: f32 = 1e-6;

type Matrix = [[f32; DOMAIN_UNKNOWNS]; DOMAIN_UNKNOWNS];

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Params {
    pub domains: u32,
    pub first: u32,
    pub first_inverse: u32,
    pub first_part: u32,
    pub parts: u32,
    pub springs: u32,
}

pub fn bound(buffers: Bound<'_>) {
    let level = Level {
        params: buffers.params(),
        tables: &buffers.read(0),
        couplings: &buffers.read(1),
        touching: &buffers.read(2),
        pressed: &buffers.read(3),
        frames: &buffers.read(4),
    };
    domain(&level, &mut buffers.write(5));
}

pub struct Level<'a> {
    pub params: Params,
    pub tables: &'a [u32],
    pub couplings: &'a [f32],
    pub touching: &'a [u32],
    pub pressed: &'a [f32],
    pub frames: &'a [Frame],
}

impl Level<'_> {
    fn matrix(&self, d: usize) -> Box<Matrix> {
        let mut matrix = Box::new([[0.0; DOMAIN_UNKNOWNS]; DOMAIN_UNKNOWNS]);
        let first = self.params.first as usize + d;
        for a in 0..CHILDREN {
            for b in a..CHILDREN {
                let block = self.tables[64 * first + CHILDREN * a + b];
                if block != NONE {
                    let block = &self.couplings[36 * block as usize..][..36];
                    for (k, number) in block.iter().enumerate() {
                        matrix[6 * a + k / 6][6 * b + k % 6] = *number;
                    }
                }
            }
        }
        if self.params.springs == 1 {
            for chunk in self.touching[first]..self.touching[first + 1] {
                let pressed = &self.pressed[DOMAIN_WORDS * chunk as usize..][..DOMAIN_WORDS];
                for (r, row) in matrix.iter_mut().enumerate() {
                    let columns = 6 * (r / 6)..DOMAIN_UNKNOWNS;
                    columns.for_each(|c| row[c] += pressed[DOMAIN_UNKNOWNS * r + c]);
                }
            }
        }
        for r in 0..DOMAIN_UNKNOWNS {
            (0..r).for_each(|c| matrix[r][c] = matrix[c][r]);
        }
        let groups = CHILDREN * d..(CHILDREN * (d + 1)).min(self.params.parts as usize);
        for (t, group) in groups.enumerate() {
            let stiffness = (0..6).fold(0.0, |sum, k| sum + matrix[6 * t + k][6 * t + k]);
            let [xx, xy, xz, yy, yz, zz] = self.frames[self.params.first_part as usize + group].held;
            for (r, row) in [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]].iter().enumerate() {
                for (k, held) in row.iter().enumerate() {
                    matrix[6 * t + 3 + r][6 * t + 3 + k] += stiffness * held;
                }
            }
        }
        matrix
    }
}

/// Gauss-Jordan elimination in place, without exchanges of rows.
fn invert(matrix: &mut Matrix) {
    let diagonal: [f32; DOMAIN_UNKNOWNS] = std::array::from_fn(|k| {
        matrix[k][k] *= 1.0 + SHIFT;
        matrix[k][k]
    });
    for k in 0..DOMAIN_UNKNOWNS {
        let pivot_row = matrix[k];
        let pivot = pivot_row[k];
        for (t, row) in matrix.iter_mut().enumerate() {
            if pivot > ZERO_PIVOT * diagonal[k] {
                if t == k {
                    *row = pivot_row.map(|number| number / pivot);
                    row[k] = 1.0 / pivot;
                } else {
                    let factor = row[k] / pivot;
                    row.iter_mut().zip(&pivot_row).for_each(|(number, other)| *number -= factor * other);
                    row[k] = -factor;
                }
            } else {
                if t == k {
                    *row = [0.0; DOMAIN_UNKNOWNS];
                }
                row[k] = 0.0;
            }
        }
    }
}

pub fn domain(level: &Level<'_>, inverses: &mut [f32]) {
    let params = &level.params;
    for d in 0..params.domains as usize {
        let mut matrix = level.matrix(d);
        invert(&mut matrix);
        let out = &mut inverses[DOMAIN_WORDS * (params.first_inverse as usize + d)..];
        for t in 0..DOMAIN_UNKNOWNS {
            for j in 0..DOMAIN_UNKNOWNS {
                out[DOMAIN_UNKNOWNS * t + j] = 0.5 * (matrix[t][j] + matrix[j][t]);
            }
        }
    }
}
