//! Twin of `shader/strand_product.wgsl`.

use super::newton::{padded, xyz};
use super::{added, dot, scaled, subtracted};
use crate::assembly::{Curvature, Strand};
use crate::bound::Bound;
use crate::linear::Progress;
use bytemuck::{Pod, Zeroable};

type V3 = [f32; 3];

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Params {
    pub rows: u32,
}

pub fn bound(buffers: Bound<'_>) {
    let params: Params = buffers.params();
    let hessian = Hessian { strands: &buffers.read(0), curvatures: &buffers.read(1) };
    strand_product(
        params,
        &hessian,
        &buffers.read(2),
        &buffers.read(3),
        &mut buffers.write(4),
        &buffers.write::<Progress>(5)[0],
    );
}

/// The Hessian of strands.
pub struct Hessian<'a> {
    pub strands: &'a [Strand],
    pub curvatures: &'a [Curvature],
}

impl Hessian<'_> {
    fn product(&self, e: usize, direction: &[[f32; 4]]) -> V3 {
        let at = |node: u32| xyz(direction[node as usize]);
        let w = self.strands[e].jump(|a, b| subtracted(at(b), at(a)));
        let Curvature { along, axial, across } = self.curvatures[e];
        added(scaled(w, across), scaled(along, axial * dot(along, w)))
    }
}

pub fn strand_product(
    params: Params,
    hessian: &Hessian<'_>,
    rows: &[u32],
    direction: &[[f32; 4]],
    image: &mut [[f32; 4]],
    progress: &Progress,
) {
    if progress.moving == 0 {
        return;
    }
    for row in rows.chunks_exact(3).take(params.rows as usize) {
        let mut sum = [0.0; 3];
        for &entry in &rows[row[1] as usize..row[2] as usize] {
            let (e, place) = (entry as usize / 3, entry as usize % 3);
            let weight = hessian.strands[e].weights()[place];
            sum = added(sum, scaled(hessian.product(e, direction), weight));
        }
        image[row[0] as usize] = padded(sum);
    }
}
