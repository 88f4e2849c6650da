//! Lists the pairs that may meet while vertices move.

use bowknot_twoway::geometry::Vector;
use bowknot_twoway::stepper::Rounding;
use bowknot_twoway::{CollisionScene, Coverage, ResolveState, Search, Statistics};

/// In which order vertices may go their ways.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Clocks {
    /// All on one clock: each is at the same fraction of its way.
    Common,
    /// Each on a clock of its own.
    Own,
}

/// Makes `state.contacts` hold every pair that may meet while vertices move from x along `paths` [m]; the present list is
/// kept where it holds them anyway. Contact geometry stays that at x.
///
/// Tubes around the paths are as wide as contacts are seen from, so that pairs in contact range keep their multipliers.
#[derive(Debug, Default)]
pub(crate) struct PathSearch {
    displacements: Vec<Vector>,
    deviations: Vec<f64>,
}

impl PathSearch {
    /// `nearest` is the distance [m] below which pairs must be listed on the way, beyond those that may meet.
    pub(crate) fn list(
        &mut self,
        scene: &CollisionScene,
        state: &mut ResolveState,
        search: &mut dyn Search,
        paths: &[Vector],
        clocks: Clocks,
        nearest: f64,
        statistics: &mut Statistics,
    ) {
        let largest = state.x.iter().zip(paths).map(|(x, p)| x.coords.amax() + p.amax()).fold(0.0, f64::max);
        let rounding = Rounding::new(largest).frozen;
        let within = match search.coverage() {
            Coverage::TrustRegions(trust_regions) => {
                (0..paths.len()).all(|v| trust_regions.limit(v, &state.x[v], &paths[v]) >= 1.0)
            }
            Coverage::Distance(covered) => {
                let longest = paths.iter().map(Vector::norm).fold(0.0, f64::max);
                2.0 * (longest * (1.0 + 1e-12) + rounding)
                    < covered - scene.spacing().largest_min_separation().max(nearest)
            }
        };
        if within {
            return;
        }
        let share = match clocks {
            Clocks::Common => 1.0,
            // Halfway along, all of the path is within half of its length.
            Clocks::Own => 0.5,
        };
        let bodies = scene.model().vertex_body();
        self.displacements.clear();
        self.displacements.extend(paths.iter().map(|p| share * p));
        self.deviations.clear();
        self.deviations.extend(paths.iter().zip(bodies).map(|(p, body)| {
            let strayed = if clocks == Clocks::Own { 0.5 * p.norm() * (1.0 + 1e-12) } else { 0.0 };
            strayed + scene.spacing().margin(*body) + rounding
        }));
        search.update_swept(scene, state, &self.displacements, &self.deviations, statistics);
    }
}
