//! Pins that hold edges over their stretch limits, with the names of a scene.

use bowknot_scene::world::World;
use serde::{Deserialize, Serialize};
use std::fmt;

/// Pins that hold edges of a body over their stretch limits. These edges are longer then.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct HeldApart {
    /// Name of the body.
    pub body: String,
    /// Length that the edge that yields most must have, in its limit [1].
    pub excess: f64,
    /// The two held vertices that are too far apart, if it takes two alone.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pair: Option<HeldPair>,
}

/// Two vertices that are held farther apart than the edges between them may be long.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct HeldPair {
    /// Their numbers in the mesh.
    pub vertices: [u32; 2],
    /// Their distance [m].
    pub distance_m: f64,
    /// What the limits of the edges between them allow [m].
    pub allowed_m: f64,
}

/// What prescribed vertices ask for beyond the limits of edges; vertices are numbered as in the scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct OverLimit {
    /// The edge that yields most.
    pub edge: [u32; 2],
    /// Its new length in its limit [1].
    pub excess: f64,
    /// Two prescribed vertices that are too far apart, if it takes two alone.
    pub pair: Option<HeldPair>,
}

impl HeldApart {
    pub(crate) fn new(world: &World, over: &OverLimit) -> Option<Self> {
        let body = &world.bodies[*world.collision.vertex_body().get(over.edge[0] as usize)? as usize];
        let named =
            |pair: HeldPair| HeldPair { vertices: pair.vertices.map(|v| body.mesh_number(v)), ..pair };
        Some(Self { body: body.name.clone(), excess: over.excess, pair: over.pair.map(named) })
    }
}

impl fmt::Display for HeldApart {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { body, excess, pair } = self;
        match pair {
            Some(HeldPair { vertices: [a, b], distance_m, allowed_m }) => {
                let [distance, allowed] = [distance_m, allowed_m].map(|m| 1e3 * m);
                write!(
                    f,
                    "vertices {a} and {b} of {body} are held {distance:.1} mm apart, edges allow \
                     {allowed:.1} mm"
                )
            }
            None => write!(f, "pins hold edges of {body} at {excess:.3} times their stretch limit"),
        }
    }
}
