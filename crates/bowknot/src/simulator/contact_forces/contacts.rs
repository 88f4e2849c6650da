//! The contacts that the dynamics knows of.
//!
//! After each collision stage the pairs within contact range are divided into contacts and neighbors
//! ([`Facing`](bowknot_constraints::Facing)). Each contact becomes a spring of the Newton system, whose force
//! follows from its gap. What a contact remembers is friction (`friction.rs`) and, near rest, its mean
//! (`averaging.rs`). Edges near their stretch limits are springs as well (`stretch_limits`).

use super::averaging::{ContactMean, Finds, FoundContacts, gap};
use super::crowding::share_stiffness;
use super::friction::{ContactForce, FrictionMemory};
use super::near_contacts::{MIN_PAIRS, NearContact, REACH, near_contacts, turned};
use super::newton_bodies::NewtonBodies;
use super::row_forces::RowForces;
use crate::simulator::custom_elements::joined_vertices;
use crate::simulator::stretch_limits::{HeldEdges, LimitedEdges, OverLimit};
use bowknot_constraints::{Feature, FrictionModel};
use bowknot_dynamics::{Dynamics, DynamicsModel, Held, RepulsionSpring, StepError, Touching};
use bowknot_geometry::{PairKind, Point, Vector};
use bowknot_scene::RepulsionParams;
use bowknot_scene::world::World;
use bowknot_twoway::lcp::DistanceLimit;
use bowknot_twoway::{CollisionScene, ContactSet, PairMultipliers, Resolver};
use rayon::prelude::*;
use rustc_hash::FxHashSet;
use serde::{Deserialize, Serialize};

/// What contacts remember from one time step to the next.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct CarriedContacts {
    /// The forces that they carry.
    pub forces: Vec<ContactForce>,
    /// Those near rest.
    pub means: Vec<ContactMean>,
    /// The edges that yield to prescribed vertices, with their limits [m].
    pub yielding: Vec<DistanceLimit>,
}

/// The contacts in force.
#[derive(Clone, Debug, Default)]
pub(crate) struct Contacts {
    stiffness: f64,
    /// Whether the dynamics knows contacts and their forces. Else springs are a mere repulsion, and rows hold all
    /// bodies apart.
    knows: bool,
    /// The contacts that were found last, with their features oriented. Springs of edges follow after theirs.
    found: FoundContacts,
    finds: Finds,
    /// At the end of the last time step. Its forces are those of so many springs, then of rows.
    carried: CarriedContacts,
    pressing: usize,
    rows: RowForces,
    memory: FrictionMemory,
    /// The edges that have a stretch limit.
    limited: LimitedEdges,
    held: HeldEdges,
    /// The vertices that custom elements join with others.
    joined: Vec<u32>,
    /// Which vertices Newton's method solves together with their contacts.
    newton: NewtonBodies,
    /// Of these, the vertices whose forces the residual of a time step counts.
    counted: Vec<bool>,
    /// Pairs that were in contact range at the start of the time step or after one of its collision stages,
    /// without those within a component.
    touching: Touching,
    /// The component of each vertex, see [`DynamicsModel::components_of_vertices`]. Without custom elements a
    /// component is part of one body.
    components: Vec<u32>,
}

impl Contacts {
    pub fn new(params: &RepulsionParams, world: &World, model: &DynamicsModel, resolver: &Resolver) -> Self {
        let (stiffness, knows) = (params.stiffness, params.knows_contacts(resolver.scene().friction_model()));
        let components = model.components_of_vertices();
        let joined = joined_vertices(model.element_groups());
        let mut contacts = Self { stiffness, knows, components, joined, ..Self::default() };
        contacts.leave_out(world, resolver, &[]);
        contacts
    }

    /// Leaves out the contacts of bodies `asleep`, one entry per body or none at all, which are obstacles of
    /// the `resolver`. Contacts must be found anew.
    pub fn leave_out(&mut self, world: &World, resolver: &Resolver, asleep: &[bool]) {
        self.limited = LimitedEdges::new(resolver.scene(), world);
        self.held = HeldEdges::default();
        self.newton = NewtonBodies::new(world, asleep, &self.joined);
        self.counted = self.newton.flags().to_vec();
        self.found = FoundContacts::default();
    }

    /// The springs.
    pub fn springs(&self) -> &[RepulsionSpring] {
        &self.found.springs
    }

    /// Pairs that have been in contact range since the time step began.
    pub fn touching(&self) -> &Touching {
        &self.touching
    }

    /// What contacts remember of the last time step.
    pub fn carried(&self) -> &CarriedContacts {
        &self.carried
    }

    /// Number of contacts that carried a force at the end of the last time step.
    pub fn pressing(&self) -> usize {
        self.pressing
    }

    /// What rows alone carry where the dynamics knows contacts.
    pub fn row_multipliers(&self) -> &[PairMultipliers] {
        if self.knows { self.rows.multipliers() } else { &[] }
    }

    /// Continues with what is carried. It may be that of a checkpoint, with any numbers in it.
    pub fn resume(&mut self, carried: CarriedContacts) {
        self.carried = carried;
    }

    /// Begins a time step at the positions `start`, in which nothing touches yet. See [`Self::begin_stage`].
    pub fn begin_step(&mut self, resolver: &Resolver, prescribed: &[bool], start: &[Point], held_way: f64) {
        self.touching = Touching::default();
        self.begin_stage(resolver, prescribed, start, held_way);
    }

    /// Begins a stage of a time step at the positions `start`, in which an acceleration of 1 m/s² leads what is held at
    /// rest `held_way` [m] far. It finds the contacts from positions and what is carried alone, so that a resumed run
    /// finds the same.
    pub fn begin_stage(&mut self, resolver: &Resolver, prescribed: &[bool], start: &[Point], held_way: f64) {
        let (rest, before) = (resolver.scene().rest(), &self.carried.yielding);
        if self.held.begin_step(self.limited.edges(), [rest, start], prescribed, before) {
            self.limited.set_limits(self.held.limits());
        }
        self.record_pairs_in_range(resolver);
        self.newton.begin_step(&self.touching);
        let CarriedContacts { forces, means, .. } = &self.carried;
        let vertices = resolver.state().x.len() as u32;
        let exists = |mean: &&ContactMean| mean.spring.vertices.iter().all(|&vertex| vertex < vertices);
        let is_known = |mean: &&ContactMean| exists(mean) && self.newton.include_any(&mean.spring.vertices);
        let means: Vec<ContactMean> = means.iter().filter(is_known).copied().collect();
        self.finds.begin_step(&means, vertices as usize);
        self.found = FoundContacts::from_means(&means);
        self.counted.copy_from_slice(self.newton.flags());
        self.memory = FrictionMemory::new(resolver.scene(), forces);
        self.rows.begin_stage(resolver.scene(), forces, self.newton.flags(), held_way);
        self.find(resolver, start);
    }

    /// Updates the limits of edges to where the prescribed vertices are after a collision stage, `x` [m], see
    /// [`HeldEdges::go_on`].
    pub fn update_limits(&mut self, resolver: &Resolver, x: &[Point]) {
        if self.held.go_on(resolver.scene().rest(), x) {
            self.limited.set_limits(self.held.limits());
        }
    }

    /// The edges that yield, see [`HeldEdges`], with their limits [m].
    pub fn yielding(&self) -> &[DistanceLimit] {
        self.limited.yielding()
    }

    /// What prescribed vertices ask for at `x` [m] beyond the limits of edges.
    pub fn over(&self, x: &[Point]) -> Option<OverLimit> {
        self.held.over(x)
    }

    /// The component of a vertex; obstacles and vertices that do not exist have the same.
    pub fn component(&self, vertex: u32) -> u32 {
        self.components.get(vertex as usize).copied().unwrap_or(u32::MAX)
    }

    /// The contacts with the `forces` of the springs [N] that push: features, spring, force.
    pub fn pushes<'a>(
        &'a self,
        forces: &'a [Vector],
    ) -> impl Iterator<Item = (&'a [Feature; 2], &'a RepulsionSpring, &'a Vector)> {
        let of_contacts = self.found.features.iter().zip(&self.found.springs).zip(forces);
        let of_contacts = of_contacts.map(|((features, spring), force)| (features, spring, force));
        of_contacts.filter(|(_, _, force)| **force != Vector::zeros())
    }

    /// Ends a time step from the positions `start` with the `forces` of the springs [N], and those of the
    /// rows.
    pub fn end_step(&mut self, forces: &[Vector], resolver: &Resolver, start: &[Point]) {
        let force = |(features, spring, force): (&[Feature; 2], &RepulsionSpring, &Vector)| ContactForce {
            features: *features,
            normal: spring.normal,
            force: *force,
        };
        let mut forces: Vec<ContactForce> = self.pushes(forces).map(force).filter(|_| self.knows).collect();
        self.pressing = forces.len();
        forces.extend(self.rows.forces(resolver, self.newton.flags()));
        let means = match self.knows {
            true => self.found.means(&self.finds, [start, &resolver.state().x]),
            false => Vec::new(),
        };
        self.carried = CarriedContacts { forces, means, yielding: self.limited.yielding().to_vec() };
    }

    /// Adds the pairs in contact range to [`Self::touching`], which joins components, and what holds them.
    /// Pairs within a component do neither.
    pub fn record_pairs_in_range(&mut self, resolver: &Resolver) {
        let (scene, contacts) = (resolver.scene(), &resolver.state().contacts);
        let Self { touching, components, newton, .. } = self;
        let pairs = contacts.pairs.pairs();
        let within_component = |used: &[u32]| {
            let first = components[used[0] as usize];
            used.len() > 1 && used[1..].iter().all(|&v| components[v as usize] == first)
        };
        let record = |kind: PairKind| {
            let places = contacts.pairs.range(kind).into_par_iter().with_min_len(MIN_PAIRS);
            let in_range = places
                .map(|p| (p, &pairs[p].vertices[..kind.vertex_count()]))
                .filter(|(p, used)| {
                    !within_component(used)
                        && contacts.separations[*p].distance < scene.contact_range(kind, &pairs[*p])
                })
                .collect::<Vec<_>>();
            let is_half_space = kind == PairKind::VertexHalfSpace;
            // Meshes have pairs with many normals near each contact, of which few push.
            let pushes = |place: &usize| is_half_space || contacts.multipliers[*place] != 0.0;
            let held = in_range.par_iter().filter(|(place, _)| pushes(place)).filter_map(|&(place, used)| {
                let vertex = *used.iter().find(|v| newton.moves(**v))?;
                let held = is_half_space || !used.iter().all(|&v| newton.moves(v));
                let rough = is_rough(scene, contacts, kind, place);
                let normal = || {
                    let separation = &contacts.separations[place];
                    let features = scene.features(kind, &pairs[place], separation);
                    turned(resolver, newton, features, &separation.normal)
                };
                held.then(|| Held { vertex, normal: normal(), rough })
            });
            touching.held.par_extend(held);
            let joined = in_range.par_iter();
            touching
                .pairs
                .par_extend(joined.flat_map_iter(|(_, used)| used[1..].iter().map(|&v| [used[0], v])));
        };
        // One way to the threads for all loops.
        rayon::scope(|_| PairKind::ALL.into_iter().for_each(record));
    }

    /// Records what rows alone carry after a call of the collision stage. If the dynamics knows no contacts
    /// they hold all bodies, and the residual does not count the vertices where they press.
    pub fn record_rows(&mut self, resolver: &Resolver) {
        self.rows.record(resolver, self.newton.flags());
        if self.knows {
            return;
        }
        let contacts = &resolver.state().contacts;
        self.counted.copy_from_slice(self.newton.flags());
        for kind in PairKind::ALL {
            for p in contacts.pairs.range(kind).filter(|&p| contacts.multipliers[p] != 0.0) {
                let used = &contacts.pairs.pairs()[p].vertices[..kind.vertex_count()];
                used.iter().for_each(|&v| self.counted[v as usize] = false);
            }
        }
    }

    /// Finds the contacts at the present state of the collision stage, in the order of its candidate pairs.
    /// `start` are positions at the start of the time step.
    pub fn find(&mut self, resolver: &Resolver, start: &[Point]) {
        if self.stiffness == 0.0 {
            return;
        }
        let (scene, state) = (resolver.scene(), resolver.state());
        let mut near = near_contacts(resolver, &self.newton);
        // Pairs with the same features are one contact.
        let mut known = FxHashSet::default();
        near.retain(|contact| known.insert(contact.features));
        if scene.friction_model() == FrictionModel::Filter {
            // Friction follows from how deep the target is, of which a repulsion would leave a part only.
            near.retain(|contact| !is_rough(scene, &state.contacts, contact.kind, contact.place));
        }
        let of_contacts = near.par_iter().with_min_len(MIN_PAIRS);
        let spring = |contact: &NearContact| contact.spring(resolver, &self.newton, self.stiffness);
        let mut found = FoundContacts {
            features: near.iter().map(|contact| contact.features).collect(),
            springs: of_contacts.map(spring).collect(),
            distances: near
                .iter()
                .map(|contact| state.contacts.separations[contact.place].distance)
                .collect(),
        };
        let shares: Vec<f64> = near.iter().map(|contact| contact.share).collect();
        share_stiffness(&mut found.springs, &shares, &found.distances, self.newton.flags());
        if !self.knows {
            for (spring, contact) in found.springs.iter_mut().zip(&near) {
                *spring = contact.repulsion(*spring);
            }
            self.found = found;
            return;
        }
        let go_on = found.average(&self.found, &self.finds, self.stiffness, [start, &state.x]);
        for (spring, features) in found.springs.iter_mut().zip(&found.features) {
            spring.friction_ratio = self.memory.of(scene, features);
        }
        let held: Vec<_> = found.springs.iter().filter_map(|spring| self.held_by(spring)).collect();
        self.touching.held.extend(held);
        // For contacts that are new or have turned, the gap between the same points at the start may be
        // smaller than the one that the collision stage has reached.
        let all = found.springs.par_iter_mut().zip(&found.distances).zip(&go_on).with_min_len(MIN_PAIRS);
        all.for_each(|((spring, distance), goes_on)| {
            let at_start = gap(spring, start);
            let reached = distance.min(spring.reach / REACH);
            spring.start_gap = if *goes_on { at_start } else { at_start.max(reached) };
        });
        self.finds.add();
        found.springs.extend(self.limited.taut_springs(&state.x, start, self.stiffness));
        self.found = found;
    }

    /// What a contact with an obstacle or a half-space holds.
    fn held_by(&self, spring: &RepulsionSpring) -> Option<Held> {
        let RepulsionSpring { vertices, weights, normal, friction, .. } = *spring;
        let moving = |k: &usize| weights[*k] != 0.0 && self.newton.moves(vertices[*k]);
        let held = (0..4).filter(moving).map(|k| weights[k]).sum::<f64>().abs() > 0.5;
        held.then(|| {
            (0..4).find(moving).map(|k| Held { vertex: vertices[k], normal, rough: friction > 0.0 })
        })?
    }

    /// Whether the residual of a time step counts the forces on each vertex: those of bodies that Newton's
    /// method solves together with their contacts, except vertices that only rows hold, of which it does not
    /// know.
    pub fn counted(&self) -> &[bool] {
        &self.counted
    }

    /// Which of so many vertices have contacts that the dynamics knows; none if it knows no contacts.
    pub fn known(&self, count: usize) -> &[bool] {
        if self.knows { &self.newton.flags()[..count] } else { &[] }
    }

    /// Gives the springs to the dynamics.
    pub fn apply(&self, dynamics: &mut Dynamics) -> Result<(), StepError> {
        if self.stiffness == 0.0 { Ok(()) } else { dynamics.set_repulsion(&self.found.springs) }
    }
}

/// Whether there is friction between the sides of a candidate pair. The velocity filter has none in the rows.
fn is_rough(scene: &CollisionScene, contacts: &ContactSet, kind: PairKind, place: usize) -> bool {
    let friction = match scene.friction_model() {
        FrictionModel::Filter => {
            Some(scene.contact().friction_of_pair(scene.model(), kind, &contacts.pairs.pairs()[place]))
        }
        _ => contacts.frictions.get(place).copied(),
    };
    friction.is_some_and(|friction| friction > 0.0)
}
