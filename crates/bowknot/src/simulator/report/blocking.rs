//! What a slow time step waited for, with the names of a scene.

use bowknot_geometry::PairKind;
use bowknot_scene::world::World;
use bowknot_twoway::{Wait, WaitReason};
use serde::{Deserialize, Serialize};
use std::fmt;

/// A vertex that had far to go in a slow time step, and what held it back.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct WaitingElements {
    /// The two elements of which one stops the other, or the vertex alone; vertices are numbered as in their
    /// mesh.
    pub elements: Vec<String>,
    /// Names of the bodies of these elements.
    pub bodies: Vec<String>,
    /// Place of the vertex [m].
    pub place_m: [f64; 3],
    /// Distance of the two elements [m].
    pub gap_m: Option<f64>,
    /// Distance that the vertex had left to its target [m].
    pub remaining_m: f64,
    /// Why it did not go on.
    pub reason: WaitReason,
}

impl WaitingElements {
    pub(crate) fn new(world: &World, wait: &Wait) -> Self {
        let (mut elements, mut bodies) = (Vec::new(), Vec::new());
        match &wait.pair {
            Some(pair) => {
                let (a, b) = pair.vertices[..pair.kind.vertex_count()].split_at(pair.kind.side_a());
                let [kind_a, kind_b] = kinds(pair.kind);
                let mut add = |kind: &str, side: &[u32]| {
                    elements.push(element_words(world, kind, side));
                    bodies.push(side.first().map_or("", |v| world.body_name(*v as usize)).to_owned());
                };
                add(kind_a, a);
                if pair.kind == PairKind::VertexHalfSpace {
                    let name = world.half_space_names.get(pair.elements[1] as usize).cloned();
                    let name = name.unwrap_or_default();
                    elements.push(format!("half-space {name}"));
                    bodies.push(name);
                } else {
                    add(kind_b, b);
                }
            }
            None => {
                elements.push(element_words(world, "vertex", &[wait.vertex]));
                bodies.push(world.name_of(wait.body).to_owned());
            }
        }
        let (place_m, remaining_m, reason) = (wait.place, wait.remaining_m, wait.reason);
        Self { elements, bodies, place_m, gap_m: wait.pair.map(|pair| pair.gap_m), remaining_m, reason }
    }

    /// The bodies, the place and the gap, for a line of progress.
    pub fn short(&self) -> String {
        let bodies = match &self.bodies[..] {
            [a, b] if a == b => format!("{a} and itself"),
            names => names.join(" and "),
        };
        let [x, y, z] = self.place_m;
        let gap = self.gap_m.map_or_else(String::new, |gap| format!(", {:.2} mm apart", 1e3 * gap));
        format!("{bodies} at ({x:.3}, {y:.3}, {z:.3}){gap}")
    }
}

impl fmt::Display for WaitingElements {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [x, y, z] = self.place_m;
        write!(f, "{} at ({x:.6}, {y:.6}, {z:.6}) m", self.elements.join(" and "))?;
        if let Some(gap) = self.gap_m {
            write!(f, ", {gap:.3e} m apart")?;
        }
        write!(f, ", {:.3e} m short of the target: ", self.remaining_m)?;
        f.write_str(match self.reason {
            WaitReason::Planes => "the planes between them stop it",
            WaitReason::Group => "they stop what moves as one",
            WaitReason::Frozen => "the gap is too small for a certificate, so that they do not move",
            WaitReason::FartherPair => "a pair farther than contact range stops it",
            WaitReason::TrustRegion => "it reached the end of its trust region",
        })
    }
}

/// What the sides of a pair are called.
fn kinds(kind: PairKind) -> [&'static str; 2] {
    match kind {
        PairKind::VertexVertex => ["vertex", "vertex"],
        PairKind::VertexEdge => ["vertex", "edge"],
        PairKind::VertexTriangle => ["vertex", "triangle"],
        PairKind::EdgeEdge => ["edge", "edge"],
        PairKind::VertexHalfSpace => ["vertex", "half-space"],
    }
}

/// An element of a body in words, with the numbers that its vertices have in the body's mesh.
pub(crate) fn element_words(world: &World, kind: &str, vertices: &[u32]) -> String {
    let Some(&first) = vertices.first() else { return kind.to_owned() };
    let body = world.collision.vertex_body().get(first as usize).copied().unwrap_or(u32::MAX);
    let number = |v: &u32| world.bodies.get(body as usize).map_or(*v, |b| b.mesh_number(*v)).to_string();
    let element = match vertices {
        [vertex] => format!("{kind} {}", number(vertex)),
        list => format!("{kind} (vertices {})", list.iter().map(number).collect::<Vec<_>>().join(", ")),
    };
    format!("{element} of {}", world.name_of(body))
}
