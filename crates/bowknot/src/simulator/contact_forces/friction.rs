//! Friction that contacts carry from one time step to the next.
//!
//! Friction that holds depends on the past: a body at rest on a slope is held by forces that no slip within
//! the time step explains. So a contact begins a time step with the ratio of friction to pressure that it
//! ended the last one with. One that is new, as a vertex has slid to another triangle, takes the ratio of its
//! vertices against the same body.

use bowknot_constraints::Feature;
use bowknot_geometry::{Topology, Vector};
use bowknot_twoway::CollisionScene;
use rustc_hash::FxHashMap;
use serde::{Deserialize, Serialize};

/// The force that a contact carries.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ContactForce {
    /// The two features in contact.
    pub features: [Feature; 2],
    /// Unit normal, towards the first feature [1].
    pub normal: Vector,
    /// The force on the first feature, friction included [N].
    pub force: Vector,
}

/// A vertex, and a body that touches it; half-spaces count down from `u32::MAX`.
type Side = (u32, u32);

/// Ratios of friction to pressure at the start of a time step.
#[derive(Clone, Debug, Default)]
pub(super) struct FrictionMemory {
    /// By features, on the first one.
    of_contacts: FxHashMap<[Feature; 2], Vector>,
    /// By vertex and body, on the vertex.
    of_sides: FxHashMap<Side, Vector>,
}

impl FrictionMemory {
    pub fn new(scene: &CollisionScene, carried: &[ContactForce]) -> Self {
        let mut of_contacts = FxHashMap::default();
        // Pressure and friction [N].
        let mut sums: FxHashMap<Side, (f64, Vector)> = FxHashMap::default();
        for ContactForce { features, normal, force } in carried {
            let pressure = normal.dot(force);
            let rubbing = force - normal * pressure;
            if pressure <= 0.0 || rubbing == Vector::zeros() {
                continue;
            }
            of_contacts.insert(*features, rubbing / pressure);
            for_each_side(scene, features, |side, share, sign| {
                let sum = sums.entry(side).or_default();
                sum.0 += share * pressure;
                sum.1 += rubbing * (share * sign);
            });
        }
        let ratio = |(side, (pressure, rubbing)): (Side, (f64, Vector))| (side, rubbing / pressure);
        Self { of_contacts, of_sides: sums.into_iter().map(ratio).collect() }
    }

    /// The ratio that a contact begins with, on its first feature.
    pub fn of(&self, scene: &CollisionScene, features: &[Feature; 2]) -> Vector {
        if let Some(ratio) = self.of_contacts.get(features) {
            return *ratio;
        }
        let (mut sum, mut known) = (Vector::zeros(), 0.0);
        if !self.of_sides.is_empty() {
            for_each_side(scene, features, |side, share, sign| {
                if let Some(ratio) = self.of_sides.get(&side) {
                    sum += ratio * (share * sign);
                    known += share;
                }
            });
        }
        if known > 0.0 { sum / known } else { sum }
    }
}

/// Calls `visit` with the vertices of both features and the bodies against them, the share of each vertex in
/// its feature, and the sign of a force on the first feature there. The features of a checkpoint may be
/// anything.
fn for_each_side(scene: &CollisionScene, features: &[Feature; 2], mut visit: impl FnMut(Side, f64, f64)) {
    let (model, topology) = (scene.model(), scene.model().topology());
    let body = |feature: &Feature| match feature {
        Feature::HalfSpace(half_space) => Some(u32::MAX - half_space),
        _ => model.vertex_body().get(*vertices_of(topology, feature).first()? as usize).copied(),
    };
    for (own, other, sign) in [(0, 1, 1.0), (1, 0, -1.0)] {
        let Some(against) = body(&features[other]) else { continue };
        let of_feature = vertices_of(topology, &features[own]);
        let share = 1.0 / of_feature.len().max(1) as f64;
        of_feature.iter().for_each(|&vertex| visit((vertex, against), share, sign));
    }
}

/// The vertices of a feature; none of a half-space.
pub(crate) fn vertices_of<'a>(topology: &'a Topology, feature: &'a Feature) -> &'a [u32] {
    match feature {
        Feature::Vertex(vertex) => std::slice::from_ref(vertex),
        Feature::Edge(edge) => topology.edges.get(*edge as usize).map_or(&[], |edge| edge),
        Feature::Triangle(triangle) => topology.triangles.get(*triangle as usize).map_or(&[], |t| t),
        Feature::HalfSpace(_) => &[],
    }
}
