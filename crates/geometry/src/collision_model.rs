//! The fixed data of a scene's collisions: topology, bodies with their filters, half-spaces.

use crate::half_space::HalfSpace;
use crate::identity::Identity;
use crate::topology::Topology;
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

/// Which bodies a body collides with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct BodyFilter {
    /// Whether the body is an obstacle. Obstacles have no degrees of freedom; two obstacles never form a
    /// pair.
    pub obstacle: bool,
    /// Bits of the collision groups that the body is in.
    pub groups: u32,
    /// Bits of the groups that it collides with. Two bodies collide if the mask of each has a group of the
    /// other.
    pub mask: u32,
    /// Whether the body collides with itself.
    pub self_collision: bool,
}

impl BodyFilter {
    /// A deformable body that collides with everything, itself included.
    pub const DEFORMABLE: Self = Self { obstacle: false, groups: 1, mask: u32::MAX, self_collision: true };
    /// An obstacle that collides with every deformable body.
    pub const OBSTACLE: Self = Self { obstacle: true, groups: 1, mask: u32::MAX, self_collision: false };

    /// The filter while the body is not there: it collides with nothing.
    #[must_use]
    pub fn absent(self) -> Self {
        Self { groups: 0, mask: 0, self_collision: false, ..self }
    }
}

/// Why a [`CollisionModel`] cannot be built.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ModelError {
    /// `vertex_body` has another length than the topology has vertices.
    #[error("vertex_body has {given} entries for {vertices} vertices")]
    BodyCount {
        /// Entries given.
        given: usize,
        /// Vertices of the topology.
        vertices: usize,
    },
    /// A vertex names a body that does not exist.
    #[error("vertex {vertex} names body {body}, but there are only {bodies} bodies")]
    UnknownBody {
        /// The vertex.
        vertex: usize,
        /// The body it names.
        body: u32,
        /// How many bodies there are.
        bodies: usize,
    },
    /// An edge or triangle has vertices of two bodies.
    #[error("{element} {index} joins vertices of bodies {first} and {second}")]
    MixedElement {
        /// "edge" or "triangle".
        element: &'static str,
        /// Which of them.
        index: usize,
        /// One body.
        first: u32,
        /// The other body.
        second: u32,
    },
}

/// The fixed data of a scene's collisions.
#[derive(Clone, Debug, Default)]
pub struct CollisionModel {
    topology: Topology,
    vertex_body: Vec<u32>,
    vertex_component: Vec<u32>,
    bodies: Vec<BodyFilter>,
    half_spaces: Vec<HalfSpace>,
    identity: Identity,
}

impl CollisionModel {
    /// A model of the given parts, which are checked. `vertex_body[i]` is the body of vertex i.
    ///
    /// # Errors
    /// The first inconsistency, see [`ModelError`].
    pub fn new(
        topology: Topology,
        vertex_body: Vec<u32>,
        bodies: Vec<BodyFilter>,
        half_spaces: Vec<HalfSpace>,
    ) -> Result<Self, ModelError> {
        if vertex_body.len() != topology.vertex_count {
            return Err(ModelError::BodyCount { given: vertex_body.len(), vertices: topology.vertex_count });
        }
        if let Some((vertex, &body)) =
            vertex_body.iter().enumerate().find(|(_, b)| **b as usize >= bodies.len())
        {
            return Err(ModelError::UnknownBody { vertex, body, bodies: bodies.len() });
        }
        let mixed = |element: &'static str, index: usize, vertices: &[u32]| {
            let first = vertex_body[vertices[0] as usize];
            let second = vertices.iter().map(|&v| vertex_body[v as usize]).find(|&b| b != first)?;
            Some(ModelError::MixedElement { element, index, first, second })
        };
        let edges = topology.edges.iter().enumerate().find_map(|(i, e)| mixed("edge", i, e));
        let triangles = topology.triangles.iter().enumerate().find_map(|(i, t)| mixed("triangle", i, t));
        match edges.or(triangles) {
            Some(error) => Err(error),
            None => {
                let vertex_component = topology.connected_components().of_vertex;
                let identity = Identity::unique();
                Ok(Self { topology, vertex_body, vertex_component, bodies, half_spaces, identity })
            }
        }
    }

    /// One self-colliding deformable body.
    pub fn single_body(topology: Topology) -> Self {
        let vertex_body = vec![0; topology.vertex_count];
        let vertex_component = topology.connected_components().of_vertex;
        let bodies = vec![BodyFilter::DEFORMABLE];
        let identity = Identity::unique();
        Self { topology, vertex_body, vertex_component, bodies, half_spaces: Vec::new(), identity }
    }

    /// Changes the filters of the bodies and the half-spaces, one entry per body and per half-space. Nothing
    /// else changes.
    ///
    /// # Panics
    /// If there is another number of entries than of bodies or half-spaces.
    pub fn set_filters(&mut self, bodies: &[BodyFilter], half_spaces: &[HalfSpace]) {
        self.bodies.copy_from_slice(bodies);
        self.half_spaces.copy_from_slice(half_spaces);
        self.identity = Identity::unique();
    }

    /// Tells the model, with its present filters, from all others: its clones have the same identity, and
    /// [`Self::set_filters`] gives it a new one.
    pub fn identity(&self) -> Identity {
        self.identity
    }

    /// Vertices, edges and triangles.
    pub fn topology(&self) -> &Topology {
        &self.topology
    }

    /// Body of each vertex.
    pub fn vertex_body(&self) -> &[u32] {
        &self.vertex_body
    }

    /// Connected component of each vertex, a part of its body.
    pub fn vertex_component(&self) -> &[u32] {
        &self.vertex_component
    }

    /// Filter of each body.
    pub fn bodies(&self) -> &[BodyFilter] {
        &self.bodies
    }

    /// Analytic half-spaces; they collide with every deformable vertex.
    pub fn half_spaces(&self) -> &[HalfSpace] {
        &self.half_spaces
    }

    /// Whether a vertex belongs to an obstacle.
    #[inline]
    pub fn is_obstacle(&self, vertex: u32) -> bool {
        self.bodies[self.vertex_body[vertex as usize] as usize].obstacle
    }

    /// Whether primitives of two bodies may form a pair.
    #[inline]
    pub fn may_collide(&self, body_a: u32, body_b: u32) -> bool {
        let (a, b) = (&self.bodies[body_a as usize], &self.bodies[body_b as usize]);
        if a.obstacle && b.obstacle {
            return false;
        }
        if body_a == body_b { a.self_collision } else { a.groups & b.mask != 0 && b.groups & a.mask != 0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_model_keeps_its_identity_until_its_filters_change() {
        let triangle = || Topology::builder(3).triangles([[0, 1, 2]]).build().unwrap();
        let mut model = CollisionModel::single_body(triangle());
        let copy = model.clone();
        assert_eq!(model.identity(), copy.identity());
        assert_ne!(model.identity(), CollisionModel::single_body(triangle()).identity());
        assert_ne!(model.identity(), CollisionModel::default().identity());
        model.set_filters(&[BodyFilter::OBSTACLE], &[]);
        assert_ne!(model.identity(), copy.identity());
    }
}
