//! Twin of `shader/guess.wgsl`.

use super::newton::{is_free, padded};
use super::{difference, scaled};
use crate::bound::Bound;
use bytemuck::{Pod, Zeroable};

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Params {
    pub nodes: u32,
    pub count: u32,
    pub quantum: f32,
}

pub fn bound(buffers: Bound<'_>) {
    let places = Places {
        iterate: &buffers.read(0),
        inertial: &buffers.read(1),
        last: &buffers.read(2),
        free: &buffers.read(3),
    };
    guess(buffers.params(), &places, &mut buffers.write(4), &mut buffers.write(5));
}

pub struct Places<'a> {
    pub iterate: &'a [[i32; 4]],
    pub inertial: &'a [[i32; 4]],
    pub last: &'a [[i32; 4]],
    pub free: &'a [u32],
}

pub fn guess(params: Params, places: &Places<'_>, direction: &mut [[f32; 4]], second: &mut [[f32; 4]]) {
    for i in 0..params.nodes as usize {
        let way = |end: &[[i32; 4]]| {
            if is_free(places.free, i) {
                padded(scaled(difference(end[i], places.iterate[i]), params.quantum))
            } else {
                [0.0; 4]
            }
        };
        if params.count == 2 {
            direction[i] = way(places.last);
            second[i] = way(places.inertial);
        } else {
            direction[i] = way(places.inertial);
        }
    }
}
