//! What presses on what at the end of a time step: contacts one by one, and what they add up to.

use crate::simulator::contact_forces::{ContactForce, features, vertices_of};
use bowknot_constraints::Feature;
use bowknot_geometry::{Closest, CollisionModel, PairKind, Point, Separation, Vector, distance};
use bowknot_twoway::{ContactSide, PairMultipliers, Resolver};
use serde::{Deserialize, Serialize};

/// A contact that carries a force.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Contact {
    /// The bodies or half-spaces of the two sides, by index in the world.
    pub sides: [ContactSide; 2],
    /// The vertices of both sides, those of the first side first; if there are fewer than four, the first one
    /// again.
    pub vertices: [u32; 4],
    /// Weights of the closest points in the vertices [1]: positive and with a sum of 1 on the first side,
    /// negative on the second; 0 where there is no further vertex.
    pub weights: [f64; 4],
    /// The closest points of the two sides [m].
    pub points: [Point; 2],
    /// Unit normal, toward the first side [1].
    pub normal: Vector,
    /// Distance of the closest points along the normal [m].
    pub gap: f64,
    /// Force on the first side [N]; that on the second side is opposite.
    pub force: Vector,
}

impl Contact {
    /// The part of the force along the normal [N].
    pub fn normal_force(&self) -> f64 {
        self.force.dot(&self.normal)
    }

    /// The part of the force across the normal, on the first side [N].
    pub fn friction(&self) -> Vector {
        self.force - self.normal * self.normal_force()
    }

    /// The contacts that press at the end of a call of the collision stage by itself, as the bodies and the
    /// masses of its scene count them. The call stands for a time step of `time_step` [s] from its start to its
    /// target: the forces are those that, beside those of the dynamics, lead to where the call ended. They are
    /// as accurate as the call, see [`Statistics::converged`](bowknot_twoway::Statistics::converged); forces of
    /// stretch limits are not among them, nor is friction under the velocity filter.
    pub fn of_call(resolver: &Resolver, time_step: f64) -> Vec<Self> {
        let (scene, state) = (resolver.scene(), resolver.state());
        let scale = scene.mean_mass() / (time_step * time_step);
        let contact = |(pair, separation): (PairMultipliers, &Separation)| {
            let normal = separation.normal;
            let force = (normal * pair.normal + pair.friction) * scale;
            let carried = ContactForce { features: features(pair.kind, pair.elements), normal, force };
            Self::new(scene.model(), &state.x, &carried)
        };
        state.contacts.pressing().filter_map(contact).collect()
    }

    /// A contact at positions of all vertices [m]; none of features that do not exist.
    pub(crate) fn new(model: &CollisionModel, positions: &[Point], carried: &ContactForce) -> Option<Self> {
        let ContactForce { features, normal, force } = *carried;
        let topology = model.topology();
        let [a, b] = [&features[0], &features[1]].map(|feature| vertices_of(topology, feature));
        let kind = match (a.len(), b.len(), features[1]) {
            (1, 0, Feature::HalfSpace(_)) => PairKind::VertexHalfSpace,
            (1, 1, _) => PairKind::VertexVertex,
            (1, 2, _) => PairKind::VertexEdge,
            (1, 3, _) => PairKind::VertexTriangle,
            (2, 2, _) => PairKind::EdgeEdge,
            _ => return None,
        };
        let mut vertices = [*a.first()?; 4];
        a.iter().chain(b).zip(&mut vertices).for_each(|(v, place)| *place = *v);
        let of = |v: u32| positions.get(v as usize).copied();
        let places = [of(vertices[0])?, of(vertices[1])?, of(vertices[2])?, of(vertices[3])?];
        let Closest { weights, .. } = distance::closest(kind, &places);
        let sum = |range: std::ops::Range<usize>| {
            Point::from(range.map(|k| places[k].coords * weights[k]).sum::<Vector>())
        };
        let on_first = sum(0..a.len());
        let on_second = match features[1] {
            Feature::HalfSpace(h) => {
                let plane = model.half_spaces().get(h as usize)?;
                on_first - plane.normal * plane.signed_distance(&on_first)
            }
            _ => sum(a.len()..a.len() + b.len()),
        };
        let body = |vertices: &[u32]| Some(*model.vertex_body().get(*vertices.first()? as usize)?);
        let side = |feature: Feature, vertices: &[u32]| match feature {
            Feature::HalfSpace(h) => Some(ContactSide::HalfSpace(h)),
            _ => body(vertices).map(ContactSide::Body),
        };
        let signed = |k: usize| match k {
            k if k < a.len() => weights[k],
            k if k < a.len() + b.len() => -weights[k],
            _ => 0.0,
        };
        Some(Self {
            sides: [side(features[0], a)?, side(features[1], b)?],
            vertices,
            weights: [0, 1, 2, 3].map(signed),
            points: [on_first, on_second],
            normal,
            gap: normal.dot(&(on_first - on_second)),
            force,
        })
    }
}

/// A force, and its torque about a point, both in the axes of the scene, whatever the pose of a body.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Wrench {
    /// The force [N].
    pub force: Vector,
    /// The torque about the point [N m].
    pub torque: Vector,
}

impl Wrench {
    /// What contacts exert on a side about a point: those of which `counts` holds of this side and the other.
    pub(crate) fn of_contacts(
        contacts: &[Contact],
        about: &Point,
        counts: impl Fn(ContactSide, ContactSide) -> bool,
    ) -> Self {
        let forces = contacts.iter().flat_map(|contact| {
            let ([a, b], [p, q]) = (contact.sides, contact.points);
            [(counts(a, b), p, contact.force), (counts(b, a), q, -contact.force)]
        });
        Self::about(about, forces.filter(|(counts, ..)| *counts).map(|(_, place, force)| (place, force)))
    }

    /// What forces at points add up to about a point.
    pub(crate) fn about(point: &Point, forces: impl Iterator<Item = (Point, Vector)>) -> Self {
        forces.fold(Self::default(), |sum, (place, force)| Self {
            force: sum.force + force,
            torque: sum.torque + (place - point).cross(&force),
        })
    }
}
