//! The search of methods whose forward steps use CCD: one per step, along the paths of all vertices.

use crate::geometry::separation;
use bowknot_twoway::geometry::{PairKind, Vector};
use bowknot_twoway::proximity::{PairList, ProximitySearch};
use bowknot_twoway::stepper::Rounding;
use bowknot_twoway::{CollisionScene, Coverage, ResolveState, Search, Statistics};
use rayon::prelude::*;
use std::time::Instant;

/// Smallest number of pairs of a parallel task.
const CHUNK: usize = 512;

/// The times at which vertices are along their paths.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum PathTime {
    /// One path time: all vertices are at the same fraction of their paths.
    Common,
    /// A path time per vertex: each vertex may be at another fraction.
    PerVertex,
}

/// A [`Search`] along paths. Before the first step it searches at x. Each forward step then lists the pairs
/// that may meet on its paths, in tubes as wide as the contact range: wherever the vertices end, these are
/// all pairs in range there too, and the next update only computes their geometry anew.
#[derive(Debug)]
pub struct SweptSearch {
    search: ProximitySearch,
    /// Whether the pairs of the state are those of the last paths.
    is_listed: bool,
    displacements: Vec<Vector>,
    radii: Vec<f64>,
}

impl SweptSearch {
    /// A search over the primitives of the scene.
    pub fn new(scene: &CollisionScene) -> Self {
        Self {
            search: ProximitySearch::new(scene.model()),
            is_listed: false,
            displacements: Vec::new(),
            radii: Vec::new(),
        }
    }

    /// Fills `state.contacts` with every pair that may meet while vertices move from x along `paths` [m].
    /// Contact geometry is that at x.
    pub(crate) fn list(
        &mut self,
        scene: &CollisionScene,
        state: &mut ResolveState,
        paths: &[Vector],
        path_time: PathTime,
        statistics: &mut Statistics,
    ) {
        let largest = state.x.iter().zip(paths).map(|(x, p)| x.coords.amax() + p.amax()).fold(0.0, f64::max);
        let rounding = Rounding::new(largest).frozen;
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
        let (mut pairs, mut separations) = (PairList::default(), Vec::new());
        self.search.search_swept(
            scene.model(),
            &state.x,
            &self.displacements,
            &self.radii,
            &mut pairs,
            &mut separations,
        );
        state.replace_pairs(scene, pairs, separations, statistics);
        self.is_listed = true;
        statistics.searches += 1;
        statistics.seconds.search += timer.elapsed().as_secs_f64();
    }
}

impl Search for SweptSearch {
    fn begin(&mut self, _: &CollisionScene, state: &mut ResolveState, _: bool) {
        self.is_listed = false;
        state.contacts = Default::default();
    }

    fn update(&mut self, scene: &CollisionScene, state: &mut ResolveState, statistics: &mut Statistics) {
        if !self.is_listed {
            let still = vec![Vector::zeros(); state.x.len()];
            return self.list(scene, state, &still, PathTime::Common, statistics);
        }
        let timer = Instant::now();
        let (contacts, x) = (&mut state.contacts, &state.x);
        for kind in PairKind::ALL {
            let range = contacts.pairs.range(kind);
            let pairs = contacts.pairs.pairs()[range.clone()].par_iter().with_min_len(CHUNK);
            pairs.zip(&mut contacts.separations[range]).for_each(|(pair, place)| {
                *place = separation(kind, &pair.vertices, pair.elements[1], x, scene.model().half_spaces());
            });
        }
        statistics.seconds.evaluate += timer.elapsed().as_secs_f64();
    }

    fn finish(&mut self, scene: &CollisionScene, state: &mut ResolveState, statistics: &mut Statistics) {
        self.update(scene, state, statistics);
        statistics.pairs = state.contacts.pairs.len();
    }

    fn request(&mut self) {
        self.is_listed = false;
    }

    fn coverage(&self) -> Coverage<'_> {
        // The pairs are those of paths, whatever their length.
        Coverage::Distance(0.0)
    }
}
