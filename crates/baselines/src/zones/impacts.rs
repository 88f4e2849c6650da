//! Detection of impacts on straight paths.

use crate::Outcome;
use crate::ccd::{AdditiveCcd, clearance};
use bowknot_twoway::CollisionScene;
use bowknot_twoway::constraints::DeltaRule;
use bowknot_twoway::geometry::{PairKind, Point, Separation, Vector, distance};
use bowknot_twoway::proximity::{CollisionModel, Pair, PairList, ProximitySearch};
use rayon::prelude::*;
use std::collections::HashSet;
use std::time::Instant;

/// A pair counts as apart above this share of its contact distance, ..
const SEPARATION_SHARE: f64 = 0.1;
/// .. or above this share of its gap at the start, if that is less.
const GAP_SHARE: f64 = 0.5;
/// Detection may stop early by this share of the contact distance: pairs that pass each other at twice the
/// distance that they must keep do not count as meeting, however far apart they started.
const SLACK_SHARE: f64 = 0.1;
/// Smallest number of pairs of a parallel task.
const CHUNK: usize = 256;

/// A pair that meets or nearly meets, or that ends too near.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Impact {
    /// Kind of the pair.
    pub kind: PairKind,
    /// The pair.
    pub pair: Pair,
    /// Until this time in [0, 1] the pair is certain to stay apart. 1: all the way, but it ends nearer than
    /// its thickness.
    pub time: f64,
    /// Contact distance of the pair [m].
    pub delta: f64,
}

impl Impact {
    /// The vertices of the pair.
    pub fn vertices(&self) -> &[u32] {
        &self.pair.vertices[..self.kind.vertex_count()]
    }
}

/// Finds impacts: candidates by swept boxes, then additive continuous detection. A pair that it does not find
/// keeps a tenth of its contact distance on the whole way, or half of its gap at the start.
///
/// From one round of a call to the next only the paths of some vertices change. What detection says of a pair
/// depends on x, which stays, and on the paths of its own vertices. So it is repeated for pairs with a vertex
/// whose path has changed, and for those that met in the last round; every other pair has been found to stay
/// apart on the very paths that it has now (detection of I-Cloth is incremental too).
#[derive(Debug)]
pub struct ImpactSearch {
    /// A pair that does not meet, but ends at less than this share of its contact distance, is found too. 0,
    /// the default: no such pair is.
    pub thickness: f64,
    search: ProximitySearch,
    ccd: AdditiveCcd,
    pairs: PairList,
    separations: Vec<Separation>,
    radii: Vec<f64>,
    /// The paths of the last round; none before the first round of a call.
    last_paths: Vec<Vector>,
    /// Whether the path of a vertex differs from that of the last round.
    changed: Vec<bool>,
    /// The pairs that met in the last round, by kind and elements.
    met: HashSet<(PairKind, [u32; 2])>,
}

impl ImpactSearch {
    /// A search over the primitives of `model`.
    pub fn new(model: &CollisionModel) -> Self {
        Self {
            thickness: 0.0,
            search: ProximitySearch::new(model),
            ccd: AdditiveCcd::default(),
            pairs: PairList::default(),
            separations: Vec::new(),
            radii: Vec::new(),
            last_paths: Vec::new(),
            changed: Vec::new(),
            met: HashSet::new(),
        }
    }

    /// Begins a call: the next round tests all pairs.
    pub fn begin(&mut self) {
        self.last_paths.clear();
        self.met.clear();
    }

    /// Finds out whose paths differ from those of the last round.
    fn compare(&mut self, paths: &[Vector]) {
        self.changed.clear();
        if self.last_paths.is_empty() {
            self.changed.resize(paths.len(), true);
        } else {
            self.changed.extend(paths.iter().zip(&self.last_paths).map(|(now, last)| now != last));
        }
        self.last_paths.clear();
        self.last_paths.extend_from_slice(paths);
    }

    /// The impacts of vertices that move from `x` along `paths` [m] with a common path time, in the order of
    /// pair lists. Pairs that `accept` refuses are left out. `growth` bounds the growth of a gap that a row
    /// asks for [m]. Adds a search and its seconds to `outcome`; detection counts as evaluation.
    ///
    /// Between two calls of [`ImpactSearch::begin`], the scene, `x`, `growth` and the thickness must be the
    /// same, and a pair that `accept` refuses must be refused in all later rounds too.
    pub fn find(
        &mut self,
        scene: &CollisionScene,
        x: &[Point],
        paths: &[Vector],
        growth: f64,
        accept: impl Fn(&Impact) -> bool + Sync,
        outcome: &mut Outcome,
    ) -> Vec<Impact> {
        let timer = Instant::now();
        self.compare(paths);
        let Self { thickness, search, pairs, separations, radii, ccd, changed, met, .. } = self;
        let thickness = *thickness;
        radii.clear();
        radii.resize(x.len(), SEPARATION_SHARE.max(thickness) * scene.spacing().largest_delta());
        search.search_swept(scene.model(), x, paths, radii, pairs, separations);
        outcome.searches += 1;
        outcome.seconds.search += timer.elapsed().as_secs_f64();

        let timer = Instant::now();
        let mut impacts: Vec<Impact> = Vec::new();
        for kind in PairKind::ALL {
            let range = pairs.range(kind);
            let found = pairs.pairs()[range.clone()]
                .par_iter()
                .zip(&separations[range])
                .with_min_len(CHUNK)
                .filter_map(|(&pair, separation)| {
                    let moved = pair.vertices[..kind.vertex_count()].iter().any(|&v| changed[v as usize]);
                    if !moved && !met.contains(&(kind, pair.elements)) {
                        return None;
                    }
                    let delta = scene.spacing().of(scene.model(), kind, &pair).delta;
                    let rule = DeltaRule { delta, growth };
                    let gap = separation.distance;
                    let (delta, _) = rule.of(scene.model(), kind, &pair, scene.rest(), gap);
                    let impact = Impact { kind, pair, time: 0.0, delta };
                    if !accept(&impact) {
                        return None;
                    }
                    let min_separation = (SEPARATION_SHARE * delta).min(GAP_SHARE * gap);
                    let slackness = (SLACK_SHARE * delta / gap).min(ccd.slackness);
                    let ccd = AdditiveCcd { slackness, ..*ccd };
                    let time = clearance(&ccd, scene, kind, &pair, x, paths, min_separation, 1.0).time;
                    let near = || end_distance(scene, kind, &pair, x, paths) < thickness * delta;
                    (time < 1.0 || (thickness > 0.0 && near())).then_some(Impact { time, ..impact })
                });
            impacts.par_extend(found);
        }
        met.clear();
        met.extend(impacts.iter().map(|impact| (impact.kind, impact.pair.elements)));
        outcome.seconds.evaluate += timer.elapsed().as_secs_f64();
        impacts
    }
}

/// Distance of a pair at the end of its paths [m].
fn end_distance(scene: &CollisionScene, kind: PairKind, pair: &Pair, x: &[Point], paths: &[Vector]) -> f64 {
    let at = |v: u32| x[v as usize] + paths[v as usize];
    match kind {
        PairKind::VertexHalfSpace => {
            scene.model().half_spaces()[pair.elements[1] as usize].signed_distance(&at(pair.vertices[0]))
        }
        _ => distance::closest(kind, &pair.vertices.map(at)).distance,
    }
}
