//! The velocity filter for friction (Bridson, Fedkiw and Anderson 2002; paper, section 6.3).
//!
//! The target comes from dynamics without friction. Where it would bring a candidate pair closer than its
//! contact distance, the depth estimates the normal impulse: that which moves the target out by the depth. The slip
//! since the start of the time step shrinks by mu times the depth, at most to zero. The target takes both impulses,
//! where there is friction; collision handling removes what depth is left, and all of it elsewhere.
//!
//! The filter is here and not in the dynamics because only the resolver has the pairs, their closest points
//! and normals. It costs one pass over the pairs per call. It is only as accurate as the depths: a vertex of
//! several pairs takes the mean of their changes, and impulses that contacts pass on to each other are not
//! counted.

use crate::scene::CollisionScene;
use crate::state::ResolveState;
use bowknot_constraints::predicted_gap;
use bowknot_geometry::{PairKind, Vector};

/// Changes `state.target`, and `state.y` with it. Needs the pairs at `state.x`.
pub(crate) fn apply_filter(scene: &CollisionScene, state: &mut ResolveState) {
    let contacts = &state.contacts;
    let mut changes = vec![(Vector::zeros(), 0u32); state.x.len()];
    for kind in PairKind::ALL {
        for p in contacts.pairs.range(kind) {
            let pair = &contacts.pairs.pairs()[p];
            let separation = &contacts.separations[p];
            let gap = predicted_gap(kind, &pair.vertices, separation, &state.x, &state.target);
            let depth = contacts.deltas[p] - gap;
            if depth <= 0.0 {
                continue;
            }
            let friction = scene.contact().friction_of_pair(scene.model(), kind, pair);
            let beta = separation.signed_weights(kind);
            let mut motion = Vector::zeros();
            let mut diagonal = 0.0;
            for (&v, beta) in pair.vertices[..kind.vertex_count()].iter().zip(beta) {
                let v = v as usize;
                motion += beta * (state.target[v] - state.call.slip_start()[v]);
                diagonal += beta * beta * inverse_mass(scene, state, v);
            }
            let slip = motion - separation.normal * separation.normal.dot(&motion);
            let length = slip.norm();
            if friction == 0.0 || diagonal == 0.0 {
                continue;
            }
            let lost = if length > 0.0 { (friction * depth / length).min(1.0) } else { 0.0 };
            let impulse = (separation.normal * depth - slip * lost) / diagonal;
            for (&v, beta) in pair.vertices[..kind.vertex_count()].iter().zip(beta) {
                let (sum, count) = &mut changes[v as usize];
                *sum += beta * inverse_mass(scene, state, v as usize) * impulse;
                *count += u32::from(beta != 0.0);
            }
        }
    }
    for (v, (sum, count)) in changes.into_iter().enumerate().filter(|(_, (_, count))| *count > 0) {
        let change = sum / f64::from(count);
        state.target[v] += change;
        state.y[v] += change;
    }
}

fn inverse_mass(scene: &CollisionScene, state: &ResolveState, vertex: usize) -> f64 {
    if state.is_movable(vertex) { 1.0 / scene.relative_mass(vertex) } else { 0.0 }
}
