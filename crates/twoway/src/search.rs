//! The default search stage: it searches when a vertex has used up its trust region, and otherwise only
//! refreshes the contact geometry.

use crate::scene::CollisionScene;
use crate::spacing::MIN_SEPARATION_MARGIN;
use crate::stages::{Coverage, Search};
use crate::state::ResolveState;
use crate::statistics::Statistics;
use bowknot_constraints::{DesiredDistance, FrictionModel};
use bowknot_geometry::{PairKind, Separation, Vector, separation};
use bowknot_proximity::{PairList, ProximitySearch};
use bowknot_stepper::{TrustRegionRule, TrustRegions};
use rayon::prelude::*;
use std::time::Instant;

/// Smallest number of pairs in one parallel task.
const CHUNK: usize = 1024;

/// The default [`Search`].
#[derive(Debug)]
pub struct TrustRegionSearch {
    search: ProximitySearch,
    rule: TrustRegionRule,
    trust_regions: TrustRegions,
    /// Search radius of each vertex: that of its trust region plus half of the range within which pairs
    /// matter.
    radii: Vec<f64>,
    /// The paper's D^(l), for the rule `uniform`.
    covered_distance: f64,
    /// Whether the next update searches.
    requested: bool,
    /// The previous list, from which the data of pairs are carried over.
    old: PairList,
    moved: Vec<bool>,
}

impl TrustRegionSearch {
    /// A search over the primitives of the scene.
    pub fn new(scene: &CollisionScene) -> Self {
        Self {
            search: ProximitySearch::new(scene.model()),
            rule: scene.params().solver.forward.trust_region,
            trust_regions: TrustRegions::default(),
            radii: Vec::new(),
            covered_distance: 0.0,
            requested: true,
            old: PairList::default(),
            moved: Vec::new(),
        }
    }

    fn set_trust_regions(&mut self, scene: &CollisionScene, state: &ResolveState) {
        let params = &scene.params().solver.forward;
        self.trust_regions.centers.clone_from(&state.x);
        self.trust_regions.radii.clear();
        match params.trust_region {
            TrustRegionRule::PerVertex => {
                let (low, high) = (params.trust_region_min, params.trust_region_max);
                self.trust_regions.radii.extend(state.x.iter().zip(&state.y).enumerate().map(
                    |(v, (x, y))| {
                        let (wanted, h) = (TrustRegions::radius_for((y - x).norm()), scene.local_edge(v));
                        // A prescribed vertex that is at its target, such as one of an obstacle at rest, does
                        // not move.
                        if wanted == 0.0 && state.call.is_prescribed(v) {
                            0.0
                        } else {
                            wanted.clamp(low * h, high * h)
                        }
                    },
                ));
                let bodies = scene.model().vertex_body();
                let margin = |body: &u32| scene.spacing().margin(*body);
                self.radii.clear();
                self.radii
                    .extend(self.trust_regions.radii.iter().zip(bodies).map(|(r, body)| r + margin(body)));
            }
            TrustRegionRule::Uniform => {
                let radius = params.trust_region_max * scene.spacing().largest_delta();
                self.covered_distance = 2.0 * radius;
                self.trust_regions.radii.resize(state.x.len(), radius);
                self.radii.clear();
                self.radii.extend_from_slice(&self.trust_regions.radii);
            }
        }
    }

    /// Carries the data of pairs over to the new list, and initializes those of new pairs.
    fn inherit(&mut self, scene: &CollisionScene, state: &mut ResolveState, statistics: &mut Statistics) {
        let contacts = &mut state.contacts;
        let inherited = contacts.pairs.match_with(&self.old);
        let growth = state.call.time_step().map_or(f64::INFINITY, |dt| scene.lengths().separation_speed * dt);
        let model = scene.model();
        let (pairs, separations) = (&contacts.pairs, &contacts.separations);
        let (old_desired, old_multipliers) = (&contacts.desired, &contacts.multipliers);
        let old_min_separations = &contacts.min_separations;
        let values: Vec<Inherited> = inherited
            .par_iter()
            .enumerate()
            .with_min_len(CHUNK)
            .map(|(p, &old)| match old_desired.get(old as usize) {
                Some(&desired) => Inherited {
                    desired,
                    min_separation: old_min_separations[old as usize],
                    multiplier: old_multipliers[old as usize],
                    lowered: false,
                },
                None => {
                    let (kind, pair) = (pairs.kind(p), &pairs.pairs()[p]);
                    let spacing = scene.spacing().of(model, kind, pair);
                    let rule = DesiredDistance { delta: spacing.delta, growth };
                    let separation = &separations[p];
                    let (desired, lowered) = rule.of(model, kind, pair, scene.rest(), separation.distance);
                    let min_separation = match spacing.min_separation {
                        None => scene.lengths().min_separation.min(0.1 * desired),
                        Some(guaranteed) => {
                            // The rest distance of neighbors bounds their minimum separation. A pair that
                            // starts closer has its own gap as minimum separation, which grows from call to
                            // call.
                            let (unlimited, _) = rule.without_growth_limit(model, kind, pair, scene.rest());
                            guaranteed.min(unlimited / MIN_SEPARATION_MARGIN).min(separation.width.max(0.0))
                        }
                    };
                    Inherited { desired, min_separation, multiplier: 0.0, lowered }
                }
            })
            .collect();
        statistics.lowered_pairs += values.iter().filter(|v| v.lowered).count();
        contacts.desired.clear();
        contacts.desired.extend(values.iter().map(|v| v.desired));
        contacts.multipliers.clear();
        contacts.multipliers.extend(values.iter().map(|v| v.multiplier));
        if scene.friction_model() == FrictionModel::Coulomb {
            let old = std::mem::take(&mut contacts.friction_multipliers);
            contacts.friction_multipliers.extend(
                inherited.iter().map(|&p| old.get(p as usize).copied().unwrap_or_else(Vector::zeros)),
            );
            contacts.frictions.clear();
            for kind in PairKind::ALL {
                let list = &contacts.pairs.pairs()[contacts.pairs.range(kind)];
                let friction = |pair| scene.contact().friction_of_pair(model, kind, pair);
                contacts.frictions.extend(list.iter().map(friction));
            }
        }
        contacts.min_separations.clear();
        contacts.min_separations.extend(values.iter().map(|v| v.min_separation));
    }

    fn evaluate_moved(
        &mut self,
        scene: &CollisionScene,
        state: &mut ResolveState,
        statistics: &mut Statistics,
    ) {
        self.moved.clear();
        self.moved.extend(state.x.iter().zip(&state.previous).map(|(a, b)| a != b));
        let (moved, x) = (&self.moved, &state.x);
        let pairs = &state.contacts.pairs;
        let half_spaces = scene.model().half_spaces();
        let mut reused = 0;
        for kind in PairKind::ALL {
            let range = pairs.range(kind);
            let list = &pairs.pairs()[range.clone()];
            reused += state.contacts.separations[range]
                .par_iter_mut()
                .zip(list)
                .with_min_len(CHUNK)
                .map(|(slot, pair)| {
                    let count = kind.vertex_count();
                    if !pair.vertices[..count].iter().any(|&v| moved[v as usize]) {
                        return 1usize;
                    }
                    *slot = evaluate(kind, &pair.vertices, pair.elements[1], x, half_spaces);
                    0
                })
                .sum::<usize>();
        }
        statistics.skipped.evaluations += reused;
    }
}

/// The data of a pair that are carried over from search to search.
struct Inherited {
    desired: f64,
    min_separation: f64,
    multiplier: f64,
    lowered: bool,
}

/// Contact geometry of a pair at `x`.
pub(crate) fn evaluate(
    kind: PairKind,
    vertices: &[u32; 4],
    half_space: u32,
    x: &[bowknot_geometry::Point],
    half_spaces: &[bowknot_geometry::HalfSpace],
) -> Separation {
    match kind {
        PairKind::VertexHalfSpace => {
            separation::separate_half_space(&x[vertices[0] as usize], &half_spaces[half_space as usize])
        }
        _ => separation::separate(kind, &vertices.map(|v| x[v as usize])),
    }
}

impl Search for TrustRegionSearch {
    fn begin(&mut self, _: &CollisionScene, state: &mut ResolveState) {
        self.requested = true;
        self.old = PairList::default();
        state.contacts.pairs = PairList::default();
        state.contacts.desired.clear();
        state.contacts.multipliers.clear();
        state.contacts.frictions.clear();
        state.contacts.friction_multipliers.clear();
    }

    fn update(&mut self, scene: &CollisionScene, state: &mut ResolveState, statistics: &mut Statistics) {
        let params = &scene.params().solver.forward;
        if params.trust_region == TrustRegionRule::Uniform && !self.requested {
            let moved = state.x.iter().zip(&state.previous).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
            self.covered_distance -= 2.0 * moved * (1.0 + 1e-12);
            self.requested =
                self.covered_distance < 2.0 * params.trust_region_min * scene.spacing().largest_delta();
        }
        if !self.requested {
            statistics.skipped.searches += 1;
            return self.refresh(scene, state, statistics);
        }
        let timer = Instant::now();
        self.set_trust_regions(scene, state);
        std::mem::swap(&mut self.old, &mut state.contacts.pairs);
        let contacts = &mut state.contacts;
        self.search.search(
            scene.model(),
            &state.x,
            &self.radii,
            &mut contacts.pairs,
            &mut contacts.separations,
        );
        self.inherit(scene, state, statistics);
        self.requested = false;
        statistics.searches += 1;
        statistics.seconds.search += timer.elapsed().as_secs_f64();
    }

    fn update_swept(
        &mut self,
        scene: &CollisionScene,
        state: &mut ResolveState,
        displacements: &[Vector],
        deviations: &[f64],
        statistics: &mut Statistics,
    ) {
        let timer = Instant::now();
        // No margin for contacts that are still farther: the next update searches again and finds them. But a
        // margin for minimum separations: pairs that are no candidates must not come closer.
        self.radii.clear();
        let bodies = scene.model().vertex_body();
        let margin = |body: &u32| scene.spacing().min_separation_margin(*body);
        self.radii.extend(deviations.iter().zip(bodies).map(|(d, body)| d + margin(body)));
        std::mem::swap(&mut self.old, &mut state.contacts.pairs);
        let contacts = &mut state.contacts;
        self.search.search_swept(
            scene.model(),
            &state.x,
            displacements,
            &self.radii,
            &mut contacts.pairs,
            &mut contacts.separations,
        );
        self.inherit(scene, state, statistics);
        self.requested = true;
        statistics.searches += 1;
        statistics.seconds.search += timer.elapsed().as_secs_f64();
    }

    fn refresh(&mut self, scene: &CollisionScene, state: &mut ResolveState, statistics: &mut Statistics) {
        let timer = Instant::now();
        self.evaluate_moved(scene, state, statistics);
        statistics.seconds.evaluate += timer.elapsed().as_secs_f64();
    }

    fn request(&mut self) {
        self.requested = true;
    }

    fn coverage(&self) -> Coverage<'_> {
        match self.rule {
            TrustRegionRule::PerVertex => Coverage::TrustRegions(&self.trust_regions),
            TrustRegionRule::Uniform => Coverage::Distance(self.covered_distance),
        }
    }
}
