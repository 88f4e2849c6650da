//! CCD of listed pairs.

use super::{AdditiveCcd, Clearance};
use bowknot_twoway::geometry::{PairKind, Vector};
use bowknot_twoway::{CollisionScene, ResolveState};

/// How far the listed pair `p` stays farther apart than its floor while its vertices move from x along `paths` [m].
pub(super) fn clearance(
    ccd: &AdditiveCcd,
    scene: &CollisionScene,
    state: &ResolveState,
    paths: &[Vector],
    p: usize,
    until: f64,
) -> Clearance {
    let (kind, pair) = (state.contacts.pairs.kind(p), &state.contacts.pairs.pairs()[p]);
    let floor = state.contacts.min_separations[p];
    if kind == PairKind::VertexHalfSpace {
        let [vertex, half_space] = pair.elements.map(|e| e as usize);
        let half_space = &scene.model().half_spaces()[half_space];
        return ccd.half_space_clearance(half_space, &state.x[vertex], &paths[vertex], floor);
    }
    let x = pair.vertices.map(|v| state.x[v as usize]);
    ccd.clearance(kind, &x, &pair.vertices.map(|v| paths[v as usize]), floor, until)
}
