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
/// The same with a thickness. Rows of pairs that pass each other near then save rounds: what passes near often ends
/// near, once other rows act.
const SLACK_SHARE_WITH_THICKNESS: f64 = 0.5;
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
/// From one round of a method to the next only the paths of some vertices change. What detection says of a pair
/// depends on x, which stays, and on the paths of its own vertices. So it is repeated for pairs with a vertex
/// whose path has changed, and for those that met or were refused in the last round; every other pair has been
/// found to stay apart on the very paths that it has now (detection of I-Cloth is incremental too). The candidates
/// are searched anew in each round.
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
    last: Round,
    /// Whether the path of a vertex differs from that of the last round.
    changed: Vec<bool>,
    /// The pairs that met or were refused in the last round.
    unsettled: HashSet<PairKey>,
}

/// What detection depends on, beside the model and `accept`.
#[derive(Debug, Default, PartialEq)]
struct Round {
    x: Vec<Point>,
    paths: Vec<Vector>,
    growth: f64,
    thickness: f64,
}

/// Kind and elements of a pair.
type PairKey = (PairKind, [u32; 2]);

/// What a round finds out of a pair that does not certainly stay apart.
enum Found {
    Impact(Impact),
    Refused(PairKey),
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
            last: Round::default(),
            changed: Vec::new(),
            unsettled: HashSet::new(),
        }
    }

    /// Finds out whose paths differ from those of the last round; if anything else differs, all count as changed.
    fn compare(&mut self, x: &[Point], paths: &[Vector], growth: f64) {
        let last = &mut self.last;
        let is_another = last.x != x || last.growth != growth || last.thickness != self.thickness;
        self.changed.clear();
        if is_another {
            self.changed.resize(paths.len(), true);
            last.x.clear();
            last.x.extend_from_slice(x);
            (last.growth, last.thickness) = (growth, self.thickness);
        } else {
            self.changed.extend(paths.iter().zip(&last.paths).map(|(now, before)| now != before));
        }
        last.paths.clear();
        last.paths.extend_from_slice(paths);
    }

    /// The impacts of vertices that move from `x` along `paths` [m] with a common path time, in the order of
    /// pair lists. Pairs that `accept` refuses are left out. `growth` bounds the growth of a gap that a row
    /// asks for [m]. Adds a search and its seconds to `outcome`; detection counts as evaluation. `scene` is the same
    /// in all calls.
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
        self.compare(x, paths, growth);
        let Self { thickness, search, pairs, separations, radii, ccd, changed, unsettled, .. } = self;
        let thickness = *thickness;
        radii.clear();
        radii.resize(x.len(), SEPARATION_SHARE.max(thickness) * scene.spacing().largest_delta());
        search.search_swept(scene.model(), x, paths, radii, pairs, separations);
        outcome.searches += 1;
        outcome.seconds.search += timer.elapsed().as_secs_f64();

        let timer = Instant::now();
        let slack_share = if thickness > 0.0 { SLACK_SHARE_WITH_THICKNESS } else { SLACK_SHARE };
        let mut found = Vec::new();
        for kind in PairKind::ALL {
            let range = pairs.range(kind);
            let of_kind = pairs.pairs()[range.clone()]
                .par_iter()
                .zip(&separations[range])
                .with_min_len(CHUNK)
                .filter_map(|(&pair, separation)| {
                    let moved = pair.vertices[..kind.vertex_count()].iter().any(|&v| changed[v as usize]);
                    let key = (kind, pair.elements);
                    if !moved && !unsettled.contains(&key) {
                        return None;
                    }
                    let delta = scene.spacing().of(scene.model(), kind, &pair).delta;
                    let rule = DeltaRule { delta, growth };
                    let gap = separation.distance;
                    let (delta, _) = rule.of(scene.model(), kind, &pair, scene.rest(), gap);
                    let impact = Impact { kind, pair, time: 0.0, delta };
                    if !accept(&impact) {
                        return Some(Found::Refused(key));
                    }
                    let min_separation = (SEPARATION_SHARE * delta).min(GAP_SHARE * gap);
                    let slackness = (slack_share * delta / gap).min(ccd.slackness);
                    let ccd = AdditiveCcd { slackness, ..*ccd };
                    let time = clearance(&ccd, scene, kind, &pair, x, paths, min_separation, 1.0).time;
                    let near = || end_distance(scene, kind, &pair, x, paths) < thickness * delta;
                    (time < 1.0 || (thickness > 0.0 && near()))
                        .then_some(Found::Impact(Impact { time, ..impact }))
                });
            found.par_extend(of_kind);
        }
        unsettled.clear();
        let mut impacts = Vec::new();
        for pair in found {
            match pair {
                Found::Impact(impact) => {
                    unsettled.insert((impact.kind, impact.pair.elements));
                    impacts.push(impact);
                }
                Found::Refused(key) => _ = unsettled.insert(key),
            }
        }
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
