//! Prescribed entities that lag behind their keyframes, because going on would cut through something.

use crate::scene::CollisionScene;
use crate::state::ResolveState;
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// How far a prescribed entity lags behind its keyframe.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct Lag {
    /// The entity.
    pub entity: PrescribedEntity,
    /// Distance of its farthest vertex from the vertex's keyframe [m].
    pub distance_m: f64,
}

/// Something that follows keyframes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum PrescribedEntity {
    /// An obstacle: its body.
    Obstacle(u32),
    /// A group of pinned vertices, as named in [`crate::ResolveInput::groups`].
    Group(u32),
    /// The pinned vertices of a body that are in no group.
    Pins(u32),
}

/// The entities that lag by more than the distance at which vertices have arrived, in the order of
/// [`PrescribedEntity`].
pub(crate) fn lags(scene: &CollisionScene, state: &ResolveState) -> Vec<Lag> {
    let tolerance = scene.arrival_distance();
    let mut lags = BTreeMap::new();
    for v in (0..state.x.len()).filter(|&v| state.call.is_prescribed(v)) {
        let distance = (state.target[v] - state.x[v]).norm();
        if distance > tolerance {
            let body = scene.model().vertex_body()[v];
            let entity = if scene.model().is_obstacle(v as u32) {
                PrescribedEntity::Obstacle(body)
            } else {
                let name = state.call.groups().name_of(v);
                name.map_or(PrescribedEntity::Pins(body), PrescribedEntity::Group)
            };
            let largest = lags.entry(entity).or_insert(0.0f64);
            *largest = largest.max(distance);
        }
    }
    lags.into_iter().map(|(entity, distance_m)| Lag { entity, distance_m }).collect()
}
