//! Twin of `shader/combine.wgsl`.

use super::newton::{is_positive, padded, xyz};
use super::sum::sum_of_parts;
use super::{added, scaled, subtracted};
use crate::bound::Bound;
use crate::newton::Solve;
use bytemuck::{Pod, Zeroable};

const MIN_CONJUGATE: f32 = 1e-5;

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Params {
    pub nodes: u32,
    pub count: u32,
    pub workgroups: u32,
    pub first: u32,
}

pub fn bound(buffers: Bound<'_>) {
    let guesses = Guesses {
        image: &buffers.read(0),
        second: &buffers.read(1),
        second_image: &buffers.read(2),
        right_side: &buffers.read(3),
        sums: &buffers.read(4),
        solve: &buffers.read::<Solve>(5)[0],
    };
    combine(buffers.params(), &guesses, &mut buffers.write(6), &mut buffers.write(7));
}

pub struct Guesses<'a> {
    pub image: &'a [[f32; 4]],
    pub second: &'a [[f32; 4]],
    pub second_image: &'a [[f32; 4]],
    pub right_side: &'a [[f32; 4]],
    pub sums: &'a [f32],
    pub solve: &'a Solve,
}

impl Guesses<'_> {
    fn product(&self, params: &Params, column: usize) -> f32 {
        let parts = (0..params.workgroups as usize)
            .map(|group| self.sums[params.first as usize + 8 * group + column])
            .collect::<Vec<_>>();
        sum_of_parts(&parts)
    }

    /// How far to go along both guesses.
    fn lengths(&self, params: &Params) -> [f32; 2] {
        let [curvature, slope, mixed, other_curvature, other_slope] =
            [0, 1, 2, 3, 4].map(|column| self.product(params, column));
        let (mut along, mut along_other, mut share) = (0.0, 0.0, 0.0);
        if is_positive(self.solve.scale) {
            if is_positive(curvature) {
                along = slope / curvature;
                share = -mixed / curvature;
            }
            if params.count == 2 {
                let conjugate = other_curvature + share * mixed;
                if is_positive(conjugate) && conjugate > MIN_CONJUGATE * other_curvature {
                    along_other = (other_slope + share * slope) / conjugate;
                    along += along_other * share;
                }
            }
        }
        [along, along_other]
    }
}

pub fn combine(params: Params, guesses: &Guesses<'_>, direction: &mut [[f32; 4]], step: &mut [[f32; 4]]) {
    let [along, along_other] = guesses.lengths(&params);
    for i in 0..params.nodes as usize {
        let mut p = scaled(xyz(direction[i]), along);
        let mut q = scaled(xyz(guesses.image[i]), along);
        if params.count == 2 {
            p = added(p, scaled(xyz(guesses.second[i]), along_other));
            q = added(q, scaled(xyz(guesses.second_image[i]), along_other));
        }
        step[i] = padded(p);
        let b = guesses.right_side[i];
        let r = if b[3] == 1.0 { scaled(subtracted(xyz(b), q), guesses.solve.factor) } else { [0.0; 3] };
        direction[i] = padded(r);
    }
}
