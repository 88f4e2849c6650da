//! CCD of candidate pairs.

use super::additive::{AdditiveCcd, Clearance};
use bowknot_twoway::geometry::{PairKind, Vector};
use bowknot_twoway::{CollisionScene, ResolveState};

/// How far the candidate pair `p` keeps its minimum separation while its vertices move from x along `paths`
/// [m].
pub(super) fn clearance(
    ccd: &AdditiveCcd,
    scene: &CollisionScene,
    state: &ResolveState,
    paths: &[Vector],
    p: usize,
    until: f64,
) -> Clearance {
    let (kind, pair) = (state.contacts.pairs.kind(p), &state.contacts.pairs.pairs()[p]);
    let min_separation = state.contacts.min_separations[p];
    if kind == PairKind::VertexHalfSpace {
        let [vertex, half_space] = pair.elements.map(|e| e as usize);
        let half_space = &scene.model().half_spaces()[half_space];
        return ccd.half_space_clearance(half_space, &state.x[vertex], &paths[vertex], min_separation);
    }
    let x = pair.vertices.map(|v| state.x[v as usize]);
    ccd.clearance(kind, &x, &pair.vertices.map(|v| paths[v as usize]), min_separation, until)
}
