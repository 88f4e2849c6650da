//! Repulsion of surfaces that are near at the start of a time step.

use crate::scene::{BodyKind, RepulsionParams};
use crate::world::World;
use bowknot_constraints::FrictionModel;
use bowknot_dynamics::{Dynamics, RepulsionSpring, StepError};
use bowknot_geometry::PairKind;
use bowknot_twoway::{ContactSet, Resolver};

/// Who repels whom.
#[derive(Debug, Default)]
pub(super) struct Repulsion {
    stiffness: f64,
    /// What each vertex that collides is part of.
    kinds: Vec<Option<BodyKind>>,
    springs: Vec<RepulsionSpring>,
}

impl Repulsion {
    pub fn new(params: &RepulsionParams, world: &World, resolver: &Resolver) -> Self {
        let mut kinds = vec![None; world.collision_vertices()];
        for body in &world.bodies {
            kinds[body.vertices.start as usize..body.vertices.end as usize].fill(body.kind);
        }
        // The velocity filter takes friction from how deep the target is; springs would leave nothing of that.
        let filtered = resolver.problem().friction_model() == FrictionModel::Filter;
        Self { stiffness: if filtered { 0.0 } else { params.stiffness }, kinds, springs: Vec::new() }
    }

    /// The springs in force.
    pub fn springs(&self) -> &[RepulsionSpring] {
        &self.springs
    }

    /// Makes a spring of every pair in contact range. All of these are listed, in an order of their own, so that the
    /// springs depend on the state alone and a restart has the same.
    pub fn find(&mut self, resolver: &Resolver, contacts: &ContactSet) {
        self.springs.clear();
        if self.stiffness == 0.0 {
            return;
        }
        let problem = resolver.problem();
        for kind in PairKind::ALL {
            for index in contacts.pairs.range(kind) {
                let (separation, pair) = (&contacts.separations[index], &contacts.pairs.pairs()[index]);
                let used = &pair.vertices[..kind.vertex_count()];
                // A distance that is no number repels nothing.
                let near = separation.distance < problem.contact_range(kind, pair);
                if !near || !self.is_elastic(used) {
                    continue;
                }
                let plane = (kind == PairKind::VertexHalfSpace)
                    .then(|| &problem.model.half_spaces()[pair.elements[1] as usize]);
                let weights = separation.signed_weights(kind);
                let mut vertices = pair.vertices;
                (0..4).filter(|&k| weights[k] == 0.0).for_each(|k| vertices[k] = pair.vertices[0]);
                self.springs.push(RepulsionSpring {
                    vertices,
                    weights,
                    normal: separation.normal,
                    offset: plane.map_or(0.0, |plane| plane.offset),
                    // What is nearer than it should be is opened by the collision stage, at its own speed.
                    desired: problem.desired_distance(kind, pair).min(separation.distance),
                    stiffness: self.stiffness,
                    friction: contacts.frictions.get(index).copied().unwrap_or(0.0),
                });
            }
        }
    }

    /// Whether a contact deforms something, and no strand: these are a hundred times stiffer along than across, and the
    /// solver for them knows no springs.
    fn is_elastic(&self, vertices: &[u32]) -> bool {
        let kinds = || vertices.iter().filter_map(|&v| self.kinds[v as usize]);
        kinds().any(|kind| matches!(kind, BodyKind::Cloth | BodyKind::Solid))
            && kinds().all(|kind| kind != BodyKind::Strands)
    }

    /// Hands the springs to the dynamics.
    pub fn apply(&self, dynamics: &mut Dynamics) -> Result<(), StepError> {
        if self.stiffness == 0.0 { Ok(()) } else { dynamics.set_repulsion(&self.springs) }
    }
}
