//! Twin of `shader/strand_gradient.wgsl`.

use super::elements::length;
use super::gradients::{Places, write};
use super::{added, dot, scaled, subtracted};
use crate::assembly::Strand;
use crate::bound::Bound;

pub fn bound(buffers: Bound<'_>) {
    write(buffers, gradient);
}

fn gradient(strand: &Strand, places: &Places<'_>) -> [[f32; 3]; 3] {
    let w = strand.jump(|a, b| places.way(a, b));
    let size = length(w);
    let mut force = scaled(strand.along(w, size), size - strand.rest);
    if strand.damping > 0.0 && places.params.rate > 0.0 {
        let factor = strand.damping * places.params.rate;
        let turned = strand.jump(|a, b| places.moved(a, b));
        let viscous = if strand.is_edge() {
            scaled(w, 0.5 * factor * dot(turned, subtracted(scaled(w, 2.0), turned)))
        } else {
            scaled(turned, factor)
        };
        force = added(force, viscous);
    }
    force = scaled(force, strand.stiffness);
    strand.weights().map(|weight| scaled(force, weight))
}
