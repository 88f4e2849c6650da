//! Twin of `shader/separate.wgsl`, which states the bound of the rounding.

use super::closest::{Closest, edge_edge, vertex_edge, vertex_triangle};
use super::pair::pair_of;
use super::{crossed, difference, divided, dot, largest, negated};
use crate::bound::Bound;
use crate::layout::{Candidate, Control, Kind, Plane, Separation};
use bytemuck::{Pod, Zeroable};

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Params {
    pub capacity: u32,
    pub after_search: u32,
}

const WIDTH_ROUNDING: f32 = 3.814_697_3e-6;
const MIN_WIDTH_RATIO: f32 = 0.9;
const POINT_ROUNDING: f32 = 1.0;

pub fn bound(buffers: Bound<'_>) {
    separate(
        buffers.params(),
        &buffers.read(0),
        &buffers.read(1),
        &buffers.read(2),
        &buffers.read(3),
        &buffers.read(4),
        &mut buffers.write(5),
        &buffers.read::<Control>(6)[0],
    );
}

fn width_along(n: [f32; 3], differences: &[[f32; 3]], slack: f32) -> f32 {
    let mut width = dot(n, differences[0]);
    for d in &differences[1..] {
        width = width.min(dot(n, *d));
    }
    width - slack
}

fn separate_plane(position: [i32; 4], plane: &Plane) -> Separation {
    let offset = difference(position, [plane.point[0], plane.point[1], plane.point[2], 0]);
    let height = dot(plane.normal, offset);
    let width = height - plane.rounding * largest(offset) - POINT_ROUNDING;
    Separation {
        normal: plane.normal,
        width,
        weights: [0.0; 2],
        distance: height,
        min_separation: 0.0,
        ..Separation::default()
    }
}

pub fn separate(
    params: Params,
    positions: &[[i32; 4]],
    edges: &[[u32; 2]],
    triangles: &[[u32; 4]],
    planes: &[Plane],
    candidates: &[Candidate],
    separations: &mut [Separation],
    control: &Control,
) {
    if params.after_search != 0 && control.changed == 0 {
        return;
    }
    let count = control.candidates.min(params.capacity) as usize;
    for c in 0..count {
        separations[c] = separate_pair(candidates[c], positions, edges, triangles, planes);
    }
}

fn sine_between(a: [f32; 3], b: [f32; 3]) -> f32 {
    let unit = |v: [f32; 3]| divided(v, dot(v, v).sqrt().max(1.0));
    let product = crossed(unit(a), unit(b));
    dot(product, product).sqrt()
}

fn separate_pair(
    candidate: Candidate,
    positions: &[[i32; 4]],
    edges: &[[u32; 2]],
    triangles: &[[u32; 4]],
    planes: &[Plane],
) -> Separation {
    let pair = pair_of(candidate, edges, triangles);
    let x = pair.vertices.map(|v| positions[v as usize]);
    if pair.kind == Kind::VertexHalfSpace as u32 {
        return separate_plane(x[0], &planes[candidate.b as usize]);
    }
    let mut d = [[0.0; 3]; 4];
    let count;
    let closest;
    let mut other = [0.0; 3];
    let mut sine = 0.0;
    if pair.kind == Kind::EdgeEdge as u32 {
        d = [difference(x[0], x[2]), difference(x[0], x[3]), difference(x[1], x[2]), difference(x[1], x[3])];
        count = 4;
        let along = difference(x[1], x[0]);
        closest = edge_edge(along, negated(d[0]), negated(d[1]));
        let across = difference(x[3], x[2]);
        other = crossed(along, across);
        sine = sine_between(along, across);
    } else {
        d[0] = difference(x[0], x[1]);
        if pair.kind == Kind::VertexVertex as u32 {
            count = 1;
            closest = Closest { offset: d[0], weights: [1.0, 0.0, 0.0] };
        } else {
            d[1] = difference(x[0], x[2]);
            if pair.kind == Kind::VertexEdge as u32 {
                count = 2;
                closest = vertex_edge(negated(d[0]), negated(d[1]));
            } else {
                d[2] = difference(x[0], x[3]);
                count = 3;
                closest = vertex_triangle(negated(d[0]), negated(d[1]), negated(d[2]));
                other = crossed(difference(x[2], x[1]), difference(x[3], x[1]));
            }
        }
    }
    let differences = &d[..count];
    let slack = WIDTH_ROUNDING * differences.iter().fold(0.0, |m: f32, d| m.max(largest(*d)));

    let distance = dot(closest.offset, closest.offset).sqrt();
    let [first, second, third] = closest.weights;
    let weights = if pair.kind == Kind::EdgeEdge as u32 { [first, third] } else { [second, third] };
    let mut separation = Separation {
        normal: [0.0, 0.0, 1.0],
        width: -1.0,
        weights,
        distance,
        min_separation: 0.0,
        sine,
        ..Separation::default()
    };
    if distance > 0.0 {
        separation.normal = divided(closest.offset, distance);
        separation.width = width_along(separation.normal, differences, slack);
    }
    if separation.width < MIN_WIDTH_RATIO * distance || distance <= 0.0 {
        let scale = largest(other);
        if scale > 0.0 {
            other = divided(other, scale);
            other = divided(other, dot(other, other).sqrt());
            for normal in [other, negated(other)] {
                let width = width_along(normal, differences, slack);
                if width > separation.width {
                    separation.normal = normal;
                    separation.width = width;
                }
            }
        }
    }
    separation
}
