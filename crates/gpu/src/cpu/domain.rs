//! Twin of `shader/domain.wgsl`.

use super::groups::{M3, V3, between, moments, place, times_spin};
use super::{divided, scaled};
use crate::assembly::Frame;
use crate::bound::Bound;
use crate::layout::NONE;
use crate::linear::{CHILDREN, DOMAIN_UNKNOWNS, DOMAIN_WORDS, Spring};
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
    pub width: u32,
    pub springs: u32,
    pub quantum: f32,
}

pub fn bound(buffers: Bound<'_>) {
    let level = Level {
        params: buffers.params(),
        tables: &buffers.read(0),
        couplings: &buffers.read(1),
        springs: &buffers.read(2),
        touching: &buffers.read(3),
        places: &buffers.read(4),
        positions: &buffers.read(5),
        frames: &buffers.read(6),
    };
    domain(&level, &mut buffers.write(7));
}

pub struct Level<'a> {
    pub params: Params,
    pub tables: &'a [u32],
    pub couplings: &'a [f32],
    pub springs: &'a [Spring],
    pub touching: &'a [u32],
    pub places: &'a [u32],
    pub positions: &'a [[i32; 4]],
    pub frames: &'a [Frame],
}

impl Level<'_> {
    /// The group of this level that a node is in.
    fn group_of(&self, node: u32) -> u32 {
        let place = self.places[node as usize];
        if place == NONE { NONE } else { place / self.params.width }
    }

    fn arm(&self, node: u32, group: usize) -> V3 {
        let frame = &self.frames[self.params.first_part as usize + group];
        let at = place(self.positions[node as usize]);
        divided(between(frame.center, at, self.params.quantum), frame.size)
    }

    /// Adds the springs of a domain to the block of the groups a and b.
    fn press(&self, d: usize, a: usize, b: usize, matrix: &mut Matrix) {
        let (ga, gb) = (CHILDREN * d + a, CHILDREN * d + b);
        let first = self.params.first as usize + d;
        for &index in &self.touching[self.touching[first] as usize..self.touching[first + 1] as usize] {
            let spring = &self.springs[index as usize];
            let h: M3 = spring.hessian.map(|[x, y, z, _]| [x, y, z]);
            let of_group = |group: usize| {
                (0..4).filter(move |&m| {
                    spring.weights[m] != 0.0 && self.group_of(spring.nodes[m]) == group as u32
                })
            };
            for m in of_group(ga) {
                let arm = self.arm(spring.nodes[m], ga);
                for n in of_group(gb) {
                    let other = self.arm(spring.nodes[n], gb);
                    let weight = spring.weights[m] * spring.weights[n];
                    let shift = h.map(|column| scaled(column, weight));
                    let spin = times_spin(&shift, other);
                    let (turned_shift, turned_spin) = (moments(arm, &shift), moments(arm, &spin));
                    for r in 0..3 {
                        for k in 0..3 {
                            matrix[6 * a + r][6 * b + k] += shift[k][r];
                            matrix[6 * a + r][6 * b + k + 3] += spin[k][r];
                            matrix[6 * a + r + 3][6 * b + k] += turned_shift[k][r];
                            matrix[6 * a + r + 3][6 * b + k + 3] += turned_spin[k][r];
                        }
                    }
                }
            }
        }
    }

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
                if self.params.springs == 1 {
                    self.press(d, a, b, &mut matrix);
                }
            }
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
        for r in 0..DOMAIN_UNKNOWNS {
            (0..r).for_each(|c| matrix[r][c] = matrix[c][r]);
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
