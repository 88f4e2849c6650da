//! CCD of a pair of primitives.

use super::additive::{AdditiveCcd, Clearance};
use bowknot_twoway::geometry::{PairKind, Point, Vector};
use bowknot_twoway::proximity::Pair;
use bowknot_twoway::{CollisionScene, ResolveState};

/// How far a pair keeps `min_separation` [m] while its vertices move from `x` along `paths` [m].
#[expect(clippy::too_many_arguments, reason = "a pair, its motion and its limits")]
pub(crate) fn clearance(
    ccd: &AdditiveCcd,
    scene: &CollisionScene,
    kind: PairKind,
    pair: &Pair,
    x: &[Point],
    paths: &[Vector],
    min_separation: f64,
    until: f64,
) -> Clearance {
    let vertices = pair.vertices.map(|v| v as usize);
    if kind == PairKind::VertexHalfSpace {
        let half_space = &scene.model().half_spaces()[pair.elements[1] as usize];
        return ccd.half_space_clearance(half_space, &x[vertices[0]], &paths[vertices[0]], min_separation);
    }
    ccd.clearance(kind, &vertices.map(|v| x[v]), &vertices.map(|v| paths[v]), min_separation, until)
}

/// The same for the candidate pair `p` of a state, with its own minimum separation.
pub(super) fn candidate_clearance(
    ccd: &AdditiveCcd,
    scene: &CollisionScene,
    state: &ResolveState,
    paths: &[Vector],
    p: usize,
    until: f64,
) -> Clearance {
    let contacts = &state.contacts;
    let (kind, pair) = (contacts.pairs.kind(p), &contacts.pairs.pairs()[p]);
    clearance(ccd, scene, kind, pair, &state.x, paths, contacts.min_separations[p], until)
}
