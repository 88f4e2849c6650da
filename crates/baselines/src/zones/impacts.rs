//! Finding impacts on straight paths.

use crate::Outcome;
use crate::ccd::AdditiveCcd;
use bowknot_twoway::CollisionScene;
use bowknot_twoway::constraints::DesiredDistance;
use bowknot_twoway::geometry::{PairKind, Point, Separation, Vector, distance};
use bowknot_twoway::proximity::{CollisionModel, Pair, PairList, ProximitySearch};
use rayon::prelude::*;
use std::time::Instant;

/// Share of its desired distance above which a pair counts as apart.
const FLOOR_SHARE: f64 = 0.1;
/// Share of the gap that a pair starts with above which it counts as apart, where that is less.
const GAP_SHARE: f64 = 0.5;
/// The detection may stop early by this share of the desired distance: a pair that ends at its desired distance must never
/// count as one that meets, however far apart it started.
const SLACK_SHARE: f64 = 0.5;
/// Pairs that one parallel task tests at least.
const CHUNK: usize = 256;

/// A pair that meets, or nearly, or ends too near.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Impact {
    /// Kind of the pair.
    pub kind: PairKind,
    /// The pair.
    pub pair: Pair,
    /// Until this time in [0, 1] the pair surely keeps apart; 1: all the way, but it ends nearer than its thickness.
    pub time: f64,
    /// Distance that it is to be separated to [m].
    pub desired: f64,
}

impl Impact {
    /// The vertices that take part.
    pub fn vertices(&self) -> &[u32] {
        &self.pair.vertices[..self.kind.vertex_count()]
    }
}

/// Finds impacts: candidates by swept boxes, then additive continuous detection. What it does not find keeps a tenth of its
/// desired distance on the whole way, or half of the gap that it started with.
#[derive(Debug)]
pub struct ImpactSearch {
    /// Share of its desired distance below which a pair that does not meet, but ends there, is found too; 0, the default:
    /// none is.
    pub thickness: f64,
    search: ProximitySearch,
    ccd: AdditiveCcd,
    pairs: PairList,
    separations: Vec<Separation>,
    radii: Vec<f64>,
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
        }
    }

    /// The impacts of vertices that go from `x` along `paths` [m] on a common clock, in the order of pair lists; pairs that
    /// `judged` refuses are left out. `growth` bounds by how much a gap is asked to grow [m]. Counts a search and its
    /// seconds (detection as evaluation).
    pub fn find(
        &mut self,
        scene: &CollisionScene,
        x: &[Point],
        paths: &[Vector],
        growth: f64,
        judged: impl Fn(&Impact) -> bool + Sync,
        outcome: &mut Outcome,
    ) -> Vec<Impact> {
        let clock = Instant::now();
        let Self { thickness, search, pairs, separations, radii, ccd } = self;
        let thickness = *thickness;
        radii.clear();
        radii.resize(x.len(), FLOOR_SHARE.max(thickness) * scene.spacing().largest_delta());
        search.search_swept(scene.model(), x, paths, radii, pairs, separations);
        outcome.searches += 1;
        outcome.seconds.search += clock.elapsed().as_secs_f64();

        let clock = Instant::now();
        let mut impacts = Vec::new();
        for kind in PairKind::ALL {
            let range = pairs.range(kind);
            let found = pairs.pairs()[range.clone()]
                .par_iter()
                .zip(&separations[range])
                .with_min_len(CHUNK)
                .filter_map(|(&pair, separation)| {
                    let delta = scene.spacing().of(scene.model(), kind, &pair).delta;
                    let rule = DesiredDistance { delta, growth };
                    let gap = separation.distance;
                    let (desired, _) = rule.of(scene.model(), kind, &pair, scene.rest(), gap);
                    let impact = Impact { kind, pair, time: 0.0, desired };
                    if !judged(&impact) {
                        return None;
                    }
                    let floor = (FLOOR_SHARE * desired).min(GAP_SHARE * gap);
                    let slackness = (SLACK_SHARE * desired / gap).min(ccd.slackness);
                    let ccd = AdditiveCcd { slackness, ..*ccd };
                    let time = clearance(&ccd, scene, kind, &pair, x, paths, floor);
                    let near = || end_distance(scene, kind, &pair, x, paths) < thickness * desired;
                    (time < 1.0 || (thickness > 0.0 && near())).then_some(Impact { time, ..impact })
                });
            impacts.par_extend(found);
        }
        outcome.seconds.evaluate += clock.elapsed().as_secs_f64();
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

fn clearance(
    ccd: &AdditiveCcd,
    scene: &CollisionScene,
    kind: PairKind,
    pair: &Pair,
    x: &[Point],
    paths: &[Vector],
    floor: f64,
) -> f64 {
    let vertices = pair.vertices.map(|v| v as usize);
    if kind == PairKind::VertexHalfSpace {
        let half_space = &scene.model().half_spaces()[pair.elements[1] as usize];
        return ccd.half_space_clearance(half_space, &x[vertices[0]], &paths[vertices[0]], floor).time;
    }
    ccd.clearance(kind, &vertices.map(|v| x[v]), &vertices.map(|v| paths[v]), floor, 1.0).time
}
