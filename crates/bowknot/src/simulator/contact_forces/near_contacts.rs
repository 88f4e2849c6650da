//! Which pairs in contact range are contacts, and the spring of each.

use super::friction::vertices_of;
use super::newton_bodies::NewtonBodies;
use bowknot_constraints::Feature;
use bowknot_dynamics::{RepulsionSpring, SpringKind};
use bowknot_geometry::{PairKind, Point, Vector};
use bowknot_twoway::{GUARDED_FLOOR, Resolver};
use rayon::prelude::*;

/// Gap at which the force of a contact vanishes, in the contact distance of the pair. Bodies rest below it.
pub(super) const REACH: f64 = 1.2;

/// Reach of a repulsion, in the contact distance of the pair: the paper's D_min, up to which its search knows all pairs.
const REPULSION_REACH: f64 = 2.0;

/// Gap at which the force becomes infinite, in the way from the minimum separation to the contact distance.
const FLOOR: f64 = 0.4;

/// Height from which down on a pair is a contact even if its features do not face each other, in the way from
/// the minimum separation to the contact distance. It is a whole one where the rows of the collision stage
/// guard it: what a row holds the dynamics must know, else it closes the pair in each iteration anew. Higher:
/// tilted normals push bodies that slide.
const DEEP: f64 = 0.45;

/// Sine of the angle between two edges below which they count as nearly parallel.
const PARALLEL: f64 = 0.1;

/// Pairs that one thread looks at, at least.
pub(super) const MIN_PAIRS: usize = 1024;

/// A pair that is a contact.
#[derive(Clone, Copy, Debug)]
pub(super) struct NearContact {
    /// Features of its sides, a vertex before an edge, and the sign that its normal takes with that.
    pub features: [Feature; 2],
    sign: f64,
    /// How much of a contact it is [1].
    pub share: f64,
    /// Contact distance and minimum separation of the pair [m].
    delta: f64,
    least: f64,
    pub kind: PairKind,
    /// Its place in the list of pairs.
    pub place: usize,
}

impl NearContact {
    /// The spring of a contact, without what follows from the start of the time step: gap and friction.
    pub fn spring(&self, resolver: &Resolver, newton: &NewtonBodies, stiffness: f64) -> RepulsionSpring {
        let Self { features, sign, delta, least, kind, place, .. } = *self;
        let (scene, state) = (resolver.scene(), resolver.state());
        let contacts = &state.contacts;
        let (separation, pair) = (&contacts.separations[place], &contacts.pairs.pairs()[place]);
        let normal = turned(resolver, newton, features, &(separation.normal * sign));
        let plane = (kind == PairKind::VertexHalfSpace)
            .then(|| scene.model().half_spaces()[pair.elements[1] as usize]);
        let offset = plane.map_or(0.0, |plane| plane.offset);
        let weights = separation.signed_weights(kind).map(|weight| weight * sign);
        let mut vertices = pair.vertices;
        (0..4).filter(|&k| weights[k] == 0.0).for_each(|k| vertices[k] = pair.vertices[0]);
        let floor = least + FLOOR * (delta - least);
        RepulsionSpring {
            kind: SpringKind::Contact,
            vertices,
            weights,
            normal,
            offset,
            reach: REACH * delta,
            floor,
            start_gap: 0.0,
            stiffness,
            friction: contacts.frictions.get(place).copied().unwrap_or(0.0),
            friction_ratio: Vector::zeros(),
        }
    }

    /// Its `spring` as a mere repulsion (paper, section 6.2).
    pub fn repulsion(&self, spring: RepulsionSpring) -> RepulsionSpring {
        let reach = REPULSION_REACH * self.delta;
        RepulsionSpring { kind: SpringKind::Repulsion, reach, friction: 0.0, ..spring }
    }
}

/// The pairs in contact range that are contacts and deform something.
pub(super) fn near_contacts(resolver: &Resolver, newton: &NewtonBodies) -> Vec<NearContact> {
    let (scene, state) = (resolver.scene(), resolver.state());
    let contacts = &state.contacts;
    let of_kind = |kind: PairKind| {
        let contact = move |place: usize| {
            let (separation, pair) = (&contacts.separations[place], &contacts.pairs.pairs()[place]);
            // A pair whose distance is not a number gets no spring.
            let near = separation.distance < scene.contact_range(kind, pair);
            if !near || !newton.include_any(&pair.vertices[..kind.vertex_count()]) {
                return None;
            }
            let (features, sign) = oriented(scene.features(kind, pair, separation));
            let facing = scene.contact_share(features, &(separation.normal * sign), &state.x)
                * crossing(&features, &pair.vertices, &state.x);
            let (delta, least) = (scene.delta(kind, pair), scene.min_separation(kind, pair));
            let share = facing.max(guarded((separation.distance - least) / (delta - least)));
            (share > 0.0).then_some(NearContact { features, sign, share, delta, least, kind, place })
        };
        contacts.pairs.range(kind).into_par_iter().with_min_len(MIN_PAIRS).filter_map(contact)
    };
    let mut found = Vec::new();
    // One way to the threads for all loops.
    rayon::scope(|_| PairKind::ALL.into_iter().for_each(|kind| found.par_extend(of_kind(kind))));
    found
}

/// The normal of a contact. One outside of the cones of its features is turned to their border: a tilted one
/// would push sliding bodies aside.
pub(super) fn turned(
    resolver: &Resolver,
    newton: &NewtonBodies,
    features: [Feature; 2],
    normal: &Vector,
) -> Vector {
    let (scene, x) = (resolver.scene(), &resolver.state().x);
    let topology = scene.model().topology();
    let moves = |feature: &Feature| vertices_of(topology, feature).iter().any(|&v| newton.moves(v));
    let rigid = features.iter().position(|feature| !moves(feature));
    scene.turned(features, normal, x, rigid)
}

/// How far two edges are from parallel [1]: 1 if they cross at a sine of [`PARALLEL`] or more, and for other
/// features. The closest points of parallel edges are anywhere along them, and their vertices are contacts.
fn crossing(features: &[Feature; 2], vertices: &[u32; 4], x: &[Point]) -> f64 {
    if !matches!(features, [Feature::Edge(_), Feature::Edge(_)]) {
        return 1.0;
    }
    let edge = |k: usize| x[vertices[k] as usize] - x[vertices[k + 1] as usize];
    let (first, second) = (edge(0), edge(2));
    let product = PARALLEL * first.norm() * second.norm();
    if product > 0.0 { (first.cross(&second).norm() / product).min(1.0).powi(2) } else { 0.0 }
}

/// How much of a contact a pair at a height above the minimum separation is, see [`DEEP`], however its
/// features face each other [1].
fn guarded(height: f64) -> f64 {
    ((DEEP - height) / (DEEP - GUARDED_FLOOR)).clamp(0.0, 1.0)
}

/// Features with a vertex before an edge, so that pairs of different kinds at the same features are one
/// contact, and the sign that the normal takes.
fn oriented(features: [Feature; 2]) -> ([Feature; 2], f64) {
    match features {
        [edge @ Feature::Edge(_), vertex @ Feature::Vertex(_)] => ([vertex, edge], -1.0),
        _ => (features, 1.0),
    }
}
