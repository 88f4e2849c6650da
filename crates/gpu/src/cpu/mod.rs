//! The CPU twins of the kernels: the same arithmetic in `f32` and the same loops, one thread after the other.
//!
//! A twin is a function over slices; its `bound` takes them from the buffers of a dispatch. Kernels and twins differ by
//! rounding alone, since a shader compiler may fuse and reorder operations.

pub mod accumulate;
pub mod advance;
pub mod aim;
pub mod assemble;
pub mod attempt;
pub mod balance;
pub mod begin;
pub mod bend;
pub mod bend_energy;
pub mod bend_gradient;
pub mod boxes;
pub mod build;
pub mod climb;
pub mod closest;
pub mod coarsen;
pub mod color;
pub mod combine;
pub mod contact;
pub mod copy;
pub mod correlate;
pub mod count;
pub mod couple;
pub mod cover;
pub mod curve_edges;
pub mod damped_tetrahedron;
pub mod decide;
pub mod descend;
pub mod diagonal;
pub mod divide;
pub mod domain;
pub mod eigen;
pub mod elements;
pub mod energies;
pub mod enlist;
pub mod facing;
pub mod factor;
pub mod frame;
pub mod gather;
pub mod gather_gradient;
pub mod gradients;
pub mod groups;
pub mod guess;
pub mod impose;
pub mod inherit;
pub mod invert;
pub mod join;
pub mod keep;
pub mod limit;
pub mod limit_groups;
pub mod list;
pub mod list_near;
pub mod logarithm;
pub mod membrane;
pub mod membrane_energy;
pub mod membrane_gradient;
pub mod merge;
pub mod momenta;
pub mod multiply;
pub mod near;
pub mod near_planes;
pub mod negate;
pub mod newton;
pub mod node_energy;
pub mod normal;
pub mod pair;
pub mod parts;
pub mod pick;
pub mod place;
pub mod plan;
pub mod press;
pub mod products;
pub mod recall;
pub mod redirect;
pub mod refit;
pub mod regrid;
pub mod release;
pub mod relieve;
pub mod rescale;
pub mod residuals;
pub mod residue;
pub mod restart;
pub mod resume;
pub mod rigid;
pub mod separate;
pub mod settle;
pub mod slack;
pub mod slip;
pub mod solid;
pub mod sort;
pub mod space;
pub mod start_buckets;
pub mod store;
pub mod strand;
pub mod strand_energy;
pub mod strand_gradient;
pub mod strand_product;
pub mod stretch;
pub mod subtract_known;
pub mod sum;
pub mod sum_energy;
pub mod summarize;
pub mod sweep_edges;
pub mod sweep_rows;
pub mod terms;
pub mod tetrahedron;
pub mod tetrahedron_energy;
pub mod tetrahedron_gradient;
pub mod total;
pub mod translate;
pub mod traverse;
pub mod triangle;

use crate::layout::Vertex;

type V3 = [f32; 3];

pub fn dot(a: V3, b: V3) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub fn added(a: V3, b: V3) -> V3 {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

pub fn subtracted(a: V3, b: V3) -> V3 {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

pub fn scaled(a: V3, factor: f32) -> V3 {
    a.map(|x| x * factor)
}

pub fn divided(a: V3, divisor: f32) -> V3 {
    a.map(|x| x / divisor)
}

pub fn negated(a: V3) -> V3 {
    a.map(|x| -x)
}

pub fn crossed(a: V3, b: V3) -> V3 {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Largest absolute coordinate.
pub fn largest(a: V3) -> f32 {
    a[0].abs().max(a[1].abs()).max(a[2].abs())
}

pub fn to_f32(a: [i32; 3]) -> V3 {
    a.map(|x| x as f32)
}

/// Rounded toward zero.
pub fn truncated(a: V3) -> [i32; 3] {
    a.map(|x| x as i32)
}

/// Difference of two positions.
pub fn difference(a: [i32; 4], b: [i32; 4]) -> V3 {
    to_f32([0, 1, 2].map(|k| a[k].wrapping_sub(b[k])))
}

/// Whether two elements, given by one vertex of each, may form a pair.
pub fn may_collide(a: &Vertex, b: &Vertex) -> bool {
    if a.flags & b.flags & Vertex::OBSTACLE != 0 {
        return false;
    }
    if a.body == b.body {
        return a.flags & Vertex::SELF_COLLIDES != 0;
    }
    a.groups & b.mask != 0 && b.groups & a.mask != 0
}
