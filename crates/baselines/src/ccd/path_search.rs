//! Finds the candidate pairs that may meet while vertices move.

use bowknot_twoway::geometry::Vector;
use bowknot_twoway::proximity::{PairList, ProximitySearch};
use bowknot_twoway::stepper::Rounding;
use bowknot_twoway::{CollisionScene, Coverage, ResolveState, Search, Statistics};
use std::time::Instant;

/// The times at which vertices are along their paths.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum PathTime {
    /// One path time: all vertices are at the same fraction of their paths.
    Common,
    /// A path time per vertex: each vertex may be at another fraction.
    PerVertex,
}

/// Fills `state.contacts` with every pair that may meet while vertices move from x along `paths` [m]. The
/// present list is kept if it has all of them. Contact geometry stays that at x.
///
/// Tubes around the paths are as wide as the contact range, so that pairs within it keep their multipliers.
#[derive(Debug, Default)]
pub(crate) struct PathSearch {
    /// Made by the first search.
    search: Option<ProximitySearch>,
    /// Pairs that come nearer than this on the way become candidates too [m].
    pub nearest: f64,
    displacements: Vec<Vector>,
    radii: Vec<f64>,
}

impl PathSearch {
    /// Lists the pairs for paths at a `path_time`.
    pub(crate) fn list(
        &mut self,
        scene: &CollisionScene,
        state: &mut ResolveState,
        search: &mut impl Search,
        paths: &[Vector],
        path_time: PathTime,
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
                    < covered - scene.spacing().largest_min_separation().max(self.nearest)
            }
        };
        if within {
            return;
        }
        let share = match path_time {
            PathTime::Common => 1.0,
            // The whole path is within half of its length of its middle.
            PathTime::PerVertex => 0.5,
        };
        let (bodies, spacing) = (scene.model().vertex_body(), scene.spacing());
        self.displacements.clear();
        self.displacements.extend(paths.iter().map(|p| share * p));
        self.radii.clear();
        self.radii.extend(paths.iter().zip(bodies).map(|(p, body)| {
            let deviation =
                if path_time == PathTime::PerVertex { 0.5 * p.norm() * (1.0 + 1e-12) } else { 0.0 };
            // Pairs that are no candidates must not come closer than minimum separations.
            deviation + spacing.margin(*body) + rounding + spacing.min_separation_margin(*body)
        }));
        let timer = Instant::now();
        let own = self.search.get_or_insert_with(|| ProximitySearch::new(scene.model()));
        let (mut pairs, mut separations) = (PairList::default(), Vec::new());
        own.search_swept(
            scene.model(),
            &state.x,
            &self.displacements,
            &self.radii,
            &mut pairs,
            &mut separations,
        );
        state.replace_pairs(scene, pairs, separations, statistics);
        search.request();
        statistics.searches += 1;
        statistics.seconds.search += timer.elapsed().as_secs_f64();
    }
}
