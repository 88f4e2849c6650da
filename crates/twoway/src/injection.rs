//! The energy that separating contacts injects.

use crate::search::evaluate;
use crate::{Problem, State};
use bowknot_geometry::PairKind;

/// A bound on the kinetic energy [J] that bringing contacts to their desired distance adds in a call.
///
/// Over the call a contact opens by at most s = desired distance - gap at the start, which the separation speed limits
/// to speed times dt; its vertices leave with at most s/dt of it along the normal, beside the motion that the target has.
/// A vertex of several contacts takes the largest s: the sum of 1/2 m (s/dt)^2 over the vertices of contacts that
/// press bounds what a scene at rest can gain. Contacts at their desired distance inject nothing.
pub(crate) fn injected_energy(problem: &Problem, state: &State) -> f64 {
    let Some(dt) = state.time_step else { return 0.0 };
    let contacts = &state.contacts;
    let mut growth = vec![0.0f64; state.x.len()];
    for kind in PairKind::ALL {
        for p in contacts.pairs.range(kind).filter(|&p| contacts.multipliers[p] > 0.0) {
            let pair = &contacts.pairs.pairs()[p];
            let half_spaces = problem.model.half_spaces();
            let at_start = evaluate(kind, &pair.vertices, pair.elements[1], &state.start, half_spaces);
            let asked = contacts.desired[p] - at_start.distance;
            for &v in &pair.vertices[..kind.vertex_count()] {
                growth[v as usize] = growth[v as usize].max(asked);
            }
        }
    }
    let energy = |v: usize| 0.5 * problem.relative_mass[v] * (growth[v] / dt).powi(2);
    let movable = (0..growth.len()).filter(|&v| problem.movable(v));
    problem.mean_mass * movable.map(energy).sum::<f64>()
}
