//! The energy that separating contacts injects.

use crate::scene::CollisionScene;
use crate::state::ResolveState;
use bowknot_geometry::PairKind;
use bowknot_proximity::separate_one;

/// A bound of the kinetic energy [J] that a call adds by separating contacts to their contact distance.
///
/// In a call a contact opens by at most s = contact distance - gap at the start, and the separation speed
/// limits s to speed times dt. The vertices of the contact gain at most the speed s/dt along the normal, in
/// addition to the motion of the target. A vertex of several contacts counts with the largest s. The sum of
/// 1/2 m (s/dt)^2 over the vertices of pressing contacts bounds what a scene at rest can gain. Contacts at
/// their contact distance add nothing.
pub(crate) fn injected_energy(scene: &CollisionScene, state: &ResolveState) -> f64 {
    let Some(dt) = state.call.time_step() else { return 0.0 };
    let contacts = &state.contacts;
    let mut growth = vec![0.0f64; state.x.len()];
    for kind in PairKind::ALL {
        for p in contacts.pairs.range(kind).filter(|&p| contacts.multipliers[p] > 0.0) {
            let pair = &contacts.pairs.pairs()[p];
            let at_start = separate_one(scene.model(), kind, pair, &state.start);
            let asked = contacts.deltas[p] - at_start.distance;
            for &v in &pair.vertices[..kind.vertex_count()] {
                growth[v as usize] = growth[v as usize].max(asked);
            }
        }
    }
    let energy = |v: usize| 0.5 * scene.relative_mass(v) * (growth[v] / dt).powi(2);
    let movable = (0..growth.len()).filter(|&v| state.is_movable(v));
    scene.mean_mass() * movable.map(energy).sum::<f64>()
}
