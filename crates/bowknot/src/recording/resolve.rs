//! Solves a recorded collision problem again.

use crate::recording::filters::default_filter;
use crate::recording::states::States;
use bowknot_geometry::Topology;
use bowknot_proximity::{BodyFilter, CollisionModel};
use bowknot_twoway::{ContactData, Params, ResolveError, ResolveInput, Resolver};
use std::collections::BTreeMap;

impl States {
    /// The collision model of the problem: a body is an obstacle if all its vertices are. Which bodies
    /// collide is what [`Self::filters`] says.
    ///
    /// # Errors
    /// A mesh that is none, a body with obstacle and deformable vertices; in words.
    pub fn collision_model(&self) -> Result<CollisionModel, String> {
        let topology = Topology::builder(self.x.len())
            .triangles(self.triangles.iter().copied())
            .strand_edges(self.strands.iter().copied())
            .particles(self.particles.iter().copied())
            .build()
            .map_err(|errors| first_of(&errors))?;
        let mut obstacle: BTreeMap<u32, bool> = BTreeMap::new();
        for (vertex, (&body, &flag)) in self.body.iter().zip(&self.obstacle).enumerate() {
            if *obstacle.entry(body).or_insert(flag) != flag {
                return Err(format!(
                    "array O: body {body} has obstacle and deformable vertices (vertex {vertex} differs from \
                     its first)"
                ));
            }
        }
        let count = obstacle.keys().next_back().map_or(0, |&body| body as usize + 1);
        let filter = |body: u32| {
            let obstacle = obstacle.get(&body) == Some(&true);
            let given = self.filters.get(body as usize);
            given.map_or(default_filter(obstacle), |&given| BodyFilter { obstacle, ..given })
        };
        let filters = (0..count as u32).map(filter).collect();
        CollisionModel::new(topology, self.body.clone(), filters, self.half_spaces.clone())
            .map_err(|error| error.to_string())
    }

    /// The two-way method for the problem, over its [`Self::collision_model`].
    ///
    /// # Errors
    /// As [`Resolver::with_contact`].
    pub fn resolver(&self, model: CollisionModel, params: Params) -> Result<Resolver, ResolveError> {
        let contact = ContactData {
            bodies: self.body_contacts.clone(),
            half_spaces: self.half_space_contacts.clone(),
            pairs: self.pair_frictions.clone(),
        };
        Resolver::with_contact(model, &self.rest, &self.masses, contact, params)
    }

    /// The call that the problem stands for.
    pub fn input(&self) -> ResolveInput<'_> {
        ResolveInput {
            prescribed: &self.fixed,
            time_step: self.time_step,
            start: (!self.start.is_empty()).then_some(&self.start),
            groups: &self.groups,
            known: &self.known,
            carried: &self.carried,
            yielding: &self.yielding,
            max_steps: None,
        }
    }
}

fn first_of(errors: &[impl ToString]) -> String {
    let first = errors.first().map(ToString::to_string).unwrap_or_default();
    if errors.len() > 1 { format!("{first}; and {} more", errors.len() - 1) } else { first }
}
