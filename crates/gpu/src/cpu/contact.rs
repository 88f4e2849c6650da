//! Twin of `shader/shared/contact.wgsl`.

use super::pair::{pair_of, signed_weights};
use crate::layout::{Candidate, Kind, NONE, Separation};

const ON_BORDER: f32 = 1e-6;

#[derive(Clone, Copy, Debug)]
pub struct Contact {
    pub is_shared: bool,
    pub vertices: [u32; 3],
}

pub fn contact_of(
    candidate: Candidate,
    separation: &Separation,
    edges: &[[u32; 2]],
    triangles: &[[u32; 4]],
) -> Contact {
    let pair = pair_of(candidate, edges, triangles);
    let weights = signed_weights(&pair, separation);
    let (mut sides, mut counts) = ([[NONE; 2]; 2], [0; 2]);
    for k in (0..pair.count).filter(|k| weights[*k].abs() > ON_BORDER) {
        let side = usize::from(k >= pair.side_a);
        // Features with more vertices are not told apart.
        sides[side][usize::from(counts[side] == 1)] = pair.vertices[k];
        counts[side] += 1;
    }
    let is_shared = pair.kind != Kind::VertexHalfSpace as u32
        && counts[0] + counts[1] <= 3
        && counts.iter().all(|count| *count > 0);
    sides.iter_mut().for_each(|side| side.sort_unstable());
    let [a, b] = sides;
    let swaps = counts[0] == 2 || (counts[1] == 1 && b[0] < a[0]);
    let vertices = if swaps { [b[0], a[0], a[1]] } else { [a[0], b[0], b[1]] };
    Contact { is_shared, vertices }
}

pub fn place_of(contact: &Contact, mask: u32) -> usize {
    let [x, y, z] = contact.vertices;
    let mut hash = x.wrapping_mul(0x9e37_79b1)
        ^ y.wrapping_mul(0x85eb_ca6b).wrapping_add(0x7feb_352d)
        ^ z.wrapping_mul(0xc2b2_ae35);
    hash = (hash ^ (hash >> 15)).wrapping_mul(0x2c1b_3c6d);
    hash = (hash ^ (hash >> 12)).wrapping_mul(0x297a_2d39);
    ((hash ^ (hash >> 15)) & mask) as usize
}
