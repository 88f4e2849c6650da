//! All that a program has changed, as data.

use bowknot_geometry::{Point, Vector};
use bowknot_scene::world::{ObstacleMotion, Pin};
use bowknot_scene::{Motion, Scene};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// All that a program has changed since the simulation began with its scene; the default is nothing. A
/// simulation of the same scene that is restored from a checkpoint with it goes on with the same changes.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Driven {
    /// The scene with its bodies, materials and frictions as they are now; none while they are those of the
    /// scene that the simulation began with. Its pins do not count.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub scene: Option<Box<Scene>>,
    /// The pins; none while they are those of the scene.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pins: Option<Vec<Pin>>,
    /// By pin that code leads: where its vertices were when that began, which poses displace [m].
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub grips: BTreeMap<String, Vec<Point>>,
    /// By obstacle that code leads.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub obstacles: BTreeMap<String, ObstacleDrive>,
    /// Gravity [m/s^2]; none: that of the scene.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub gravity: Option<Vector>,
    /// Wind [m/s]; none: that of the scene.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub wind: Option<Vector>,
    /// Forces on all vertices of the world [N]; empty: none.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub external_forces: Vec<Vector>,
    /// By group of custom elements: the vertices of each. Their code is in no checkpoint; the caller adds it
    /// before one is restored.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub elements: BTreeMap<String, Vec<Vec<u32>>>,
    /// Bodies that wake before the next time step; empty: none.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub pushed: Vec<bool>,
}

/// How code leads an obstacle, in place of what the scene says.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ObstacleDrive {
    /// To places of its vertices [m].
    Places(Vec<Point>),
    /// By keyframes and spin, over the time of the simulation.
    Motion(Motion),
}

impl ObstacleDrive {
    /// The motion of the world's obstacle.
    pub(crate) fn motion(&self) -> ObstacleMotion {
        match self {
            Self::Places(places) => ObstacleMotion::Placed(places.as_slice().into()),
            Self::Motion(motion) => ObstacleMotion::Rigid(motion.clone()),
        }
    }
}
