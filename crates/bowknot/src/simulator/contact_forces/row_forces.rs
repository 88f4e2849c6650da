//! What rows of the collision stage carry where the dynamics knows no contact: among grains that press on
//! nothing that deforms, and between them and obstacles.
//!
//! A call starts from what the last one ended with, also that of the last time step. So its few sweeps go on
//! where those before it ended, and a pile stands, whose weight they would not carry down from its top in one
//! time step.

use super::friction::{ContactForce, vertices_of};
use bowknot_constraints::Feature;
use bowknot_geometry::{PairKind, Vector};
use bowknot_twoway::{CollisionScene, PairMultipliers, Resolver};

/// Share of what rows carry that the next call starts from. 1: where rows contradict each other, multipliers
/// would grow from call to call without bound.
const KEPT: f64 = 0.95;

/// What rows carry.
#[derive(Clone, Debug, Default)]
pub(super) struct RowForces {
    multipliers: Vec<PairMultipliers>,
    /// Force of a multiplier of 1 m [N/m].
    scale: f64,
}

impl RowForces {
    /// Begins a stage of a time step with the contact forces at the end of the last one. In it an acceleration of 1 m/s²
    /// leads what is held at rest `held_way` [m] far. Vertices that are `solved` are those whose contacts the dynamics
    /// knows.
    pub fn begin_stage(
        &mut self,
        scene: &CollisionScene,
        carried: &[ContactForce],
        solved: &[bool],
        held_way: f64,
    ) {
        self.scale = scene.mean_mass() / held_way;
        let topology = scene.model().topology();
        let is_row = |force: &&ContactForce| {
            // The features of a checkpoint may be anything.
            let mut used = force.features.iter().flat_map(|feature| vertices_of(topology, feature));
            used.all(|&v| solved.get(v as usize) == Some(&false))
        };
        let multipliers =
            carried.iter().filter(is_row).filter_map(|ContactForce { features, normal, force }| {
                let (kind, elements) = pair(features)?;
                let pressure = normal.dot(force);
                let friction = (force - normal * pressure) / self.scale;
                Some(PairMultipliers { kind, elements, normal: pressure / self.scale, friction })
            });
        self.multipliers = multipliers.map(kept).collect();
    }

    /// What the next call starts from.
    pub fn multipliers(&self) -> &[PairMultipliers] {
        &self.multipliers
    }

    /// Records what the pairs carry that a call of the collision stage ended with.
    pub fn record(&mut self, resolver: &Resolver, solved: &[bool]) {
        self.multipliers.clear();
        self.multipliers.extend(pressing(resolver, solved).map(|(pair, _)| kept(pair)));
    }

    /// Forces of the pairs that press at the end of a time step.
    pub fn forces(&self, resolver: &Resolver, solved: &[bool]) -> Vec<ContactForce> {
        let force = |(pair, normal): (PairMultipliers, Vector)| {
            let force = (normal * pair.normal + pair.friction) * self.scale;
            ContactForce { features: features(pair.kind, pair.elements), normal, force }
        };
        // Those of two edges are not carried: grains have none.
        let of_grains = |(pair, _): &(PairMultipliers, Vector)| pair.kind != PairKind::EdgeEdge;
        pressing(resolver, solved).filter(of_grains).map(force).collect()
    }
}

fn kept(pair: PairMultipliers) -> PairMultipliers {
    PairMultipliers { normal: KEPT * pair.normal, friction: pair.friction * KEPT, ..pair }
}

/// What the pairs carry that press and that rows alone hold, and their normals.
fn pressing<'a>(
    resolver: &'a Resolver,
    solved: &'a [bool],
) -> impl Iterator<Item = (PairMultipliers, Vector)> + 'a {
    let topology = resolver.scene().model().topology();
    resolver.state().contacts.pressing().filter_map(move |(pair, separation)| {
        let features = features(pair.kind, pair.elements);
        let mut used = features.iter().flat_map(|feature| vertices_of(topology, feature));
        used.all(|&v| !solved[v as usize]).then_some((pair, separation.normal))
    })
}

/// The elements of a pair.
pub fn features(kind: PairKind, [a, b]: [u32; 2]) -> [Feature; 2] {
    match kind {
        PairKind::VertexVertex => [Feature::Vertex(a), Feature::Vertex(b)],
        PairKind::VertexEdge => [Feature::Vertex(a), Feature::Edge(b)],
        PairKind::VertexTriangle => [Feature::Vertex(a), Feature::Triangle(b)],
        PairKind::VertexHalfSpace => [Feature::Vertex(a), Feature::HalfSpace(b)],
        PairKind::EdgeEdge => [Feature::Edge(a), Feature::Edge(b)],
    }
}

/// The pair of such features.
fn pair(features: &[Feature; 2]) -> Option<(PairKind, [u32; 2])> {
    let [Feature::Vertex(a), other] = *features else { return None };
    Some(match other {
        Feature::Vertex(b) => (PairKind::VertexVertex, [a, b]),
        Feature::Edge(b) => (PairKind::VertexEdge, [a, b]),
        Feature::Triangle(b) => (PairKind::VertexTriangle, [a, b]),
        Feature::HalfSpace(b) => (PairKind::VertexHalfSpace, [a, b]),
    })
}
