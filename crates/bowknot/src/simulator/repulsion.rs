//! Repulsion of surfaces that are near at the start of a time step.

use crate::scene::{Origin, Problem, RepulsionParams, SceneError};
use bowknot_dynamics::{Dynamics, RepulsionSpring, StepError};
use bowknot_geometry::{HalfSpace, PairKind};
use bowknot_twoway::{ContactSet, Resolver};

/// Default range, in the distance that contacts are separated to.
const RANGE: f64 = 1.5;

/// Who repels whom.
#[derive(Debug, Default)]
pub(super) struct Repulsion {
    stiffness: f64,
    range: f64,
    half_spaces: Vec<HalfSpace>,
    springs: Vec<RepulsionSpring>,
}

impl Repulsion {
    pub fn new(params: &RepulsionParams, resolver: &Resolver) -> Result<Self, SceneError> {
        let lengths = &resolver.problem().lengths;
        let range = params.range.unwrap_or(RANGE * lengths.delta);
        if params.stiffness > 0.0 && range > lengths.contact_range {
            let message = format!(
                "{range:.3e} m must be at most {:.3e} m, contact.range times delta: nothing further away is looked at",
                lengths.contact_range
            );
            let key = "solver.repulsion.range".to_owned();
            return Err(SceneError::Invalid(vec![Problem { origin: Origin::Code, key, message }]));
        }
        let half_spaces = resolver.problem().model.half_spaces().to_vec();
        Ok(Self { stiffness: params.stiffness, range, half_spaces, springs: Vec::new() })
    }

    /// The springs in force.
    pub fn springs(&self) -> &[RepulsionSpring] {
        &self.springs
    }

    /// Makes a spring of every pair in range. All of these are listed, in an order of their own, so that the springs
    /// depend on the state alone and a restart has the same.
    pub fn find(&mut self, contacts: &ContactSet) {
        self.springs.clear();
        if self.stiffness == 0.0 {
            return;
        }
        for kind in PairKind::ALL {
            for index in contacts.pairs.range(kind) {
                let separation = &contacts.separations[index];
                // A distance that is no number repels nothing.
                let near = separation.distance < self.range;
                if !near {
                    continue;
                }
                let pair = &contacts.pairs.pairs()[index];
                let plane =
                    (kind == PairKind::VertexHalfSpace).then(|| &self.half_spaces[pair.elements[1] as usize]);
                let weights = separation.signed_weights(kind);
                let mut vertices = pair.vertices;
                (0..4).filter(|&k| weights[k] == 0.0).for_each(|k| vertices[k] = pair.vertices[0]);
                self.springs.push(RepulsionSpring {
                    vertices,
                    weights,
                    normal: separation.normal,
                    offset: plane.map_or(0.0, |plane| plane.offset),
                    desired: self.range,
                    stiffness: self.stiffness,
                });
            }
        }
    }

    /// Hands the springs to the dynamics.
    pub fn apply(&self, dynamics: &mut Dynamics) -> Result<(), StepError> {
        if self.stiffness == 0.0 { Ok(()) } else { dynamics.set_repulsion(&self.springs) }
    }
}
