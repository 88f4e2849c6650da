//! The contacts that the dynamics knows of: which pairs they are, and the forces that they carry.
//!
//! After each collision stage the pairs within contact range are divided into contacts and neighbors
//! ([`Facing`](bowknot_constraints::Facing)). A contact keeps the force that it carried: that of its spring
//! in the Newton system plus that of its row in the collision stage. Where a contact point has slid to
//! another feature, the force on its vertex passes to the new contact. Forces are part of the state between
//! two time steps, and of checkpoints. Edges at their stretch limits are springs like contacts.

use super::relaxation::relax_force;
use super::solved::solved_vertices;
use super::taut::LimitedEdges;
use bowknot_constraints::{Feature, FrictionModel};
use bowknot_dynamics::{Dynamics, DynamicsModel, RepulsionSpring, StepError, Touching};
use bowknot_geometry::{PairKind, Point, Vector};
use bowknot_scene::RepulsionParams;
use bowknot_scene::world::World;
use bowknot_twoway::{CollisionScene, Resolver};
use rayon::prelude::*;
use rustc_hash::{FxBuildHasher, FxHashMap, FxHashSet};
use std::collections::hash_map::Entry;

/// The contacts in force.
#[derive(Clone, Debug, Default)]
pub(super) struct Contacts {
    stiffness: f64,
    springs: Vec<RepulsionSpring>,
    /// Features of each spring's sides, [`oriented`]. A taut edge has itself as both.
    features: Vec<[Feature; 2]>,
    /// Contact forces of a checkpoint, until the first time step after it finds their contacts.
    resumed: Option<Vec<ContactForce>>,
    /// The edges that have a stretch limit.
    limited: LimitedEdges,
    /// Which vertices of the world belong to bodies that Newton's method solves together with their contacts.
    solved: Vec<bool>,
    /// Of these, the vertices whose forces the residual of a time step counts.
    counted: Vec<bool>,
    /// Pairs that were in contact range at the start of the time step or after one of its collision stages, without those
    /// within a component.
    touching: Touching,
    /// The component of each vertex, see [`DynamicsModel::components_of_vertices`]. A component is part of one body.
    components: Vec<u32>,
}

/// The force that a contact carries.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactForce {
    /// The two features in contact.
    pub features: [Feature; 2],
    /// Unit normal, towards the first feature [1].
    pub normal: Vector,
    /// The force on the first feature, friction included [N].
    pub force: Vector,
}

impl Contacts {
    pub fn new(params: &RepulsionParams, world: &World, model: &DynamicsModel, resolver: &Resolver) -> Self {
        // The velocity filter computes friction from the depth of the target, which springs would remove.
        let filtered = resolver.scene().friction_model() == FrictionModel::Filter;
        let stiffness = if filtered { 0.0 } else { params.stiffness };
        let components = model.components_of_vertices();
        let mut contacts = Self { stiffness, components, ..Self::default() };
        contacts.leave_out(world, resolver, &[]);
        contacts
    }

    /// Leaves out the contacts of bodies `asleep`, one entry per body or none at all, which are obstacles of
    /// the `resolver`. Contacts must be found anew.
    pub fn leave_out(&mut self, world: &World, resolver: &Resolver, asleep: &[bool]) {
        self.limited = LimitedEdges::new(resolver.scene(), world);
        self.solved.clear();
        self.solved.resize(world.positions.len(), false);
        solved_vertices(world, asleep).for_each(|v| self.solved[v] = true);
        self.counted.clone_from(&self.solved);
        self.springs.clear();
        self.features.clear();
    }

    /// The contacts.
    pub fn springs(&self) -> &[RepulsionSpring] {
        &self.springs
    }

    /// Pairs that have been in contact range since the time step began.
    pub fn touching(&self) -> &Touching {
        &self.touching
    }

    /// Continues with the forces of a checkpoint.
    pub fn resume(&mut self, carried: &[ContactForce]) {
        self.resumed = Some(carried.to_vec());
    }

    /// Begins a time step at the positions `start`. It forgets the pairs of the last time step that are out
    /// of contact range, and finds the contacts from positions and forces alone, so that a resumed run finds
    /// the same.
    pub fn begin_step(&mut self, resolver: &Resolver, start: &[Point], dt: f64) {
        self.touching = Touching::default();
        self.note_touching(resolver);
        let carried = self.carried();
        self.resumed = None;
        self.find(resolver, &carried, start, dt);
    }

    /// Adds the pairs in contact range to [`Self::touching`], which joins components and holds them: a pair within a
    /// component does neither.
    pub fn note_touching(&mut self, resolver: &Resolver) {
        let (scene, contacts) = (resolver.scene(), &resolver.state().contacts);
        let (pairs, touching, components) = (contacts.pairs.pairs(), &mut self.touching, &self.components);
        let within_component = |used: &[u32]| {
            let first = components[used[0] as usize];
            used.len() > 1 && used[1..].iter().all(|&v| components[v as usize] == first)
        };
        let note = |kind: PairKind| {
            let places = contacts.pairs.range(kind).into_par_iter().with_min_len(MIN_PAIRS);
            let in_range = places
                .map(|p| (p, &pairs[p].vertices[..kind.vertex_count()]))
                .filter(|(p, used)| {
                    !within_component(used)
                        && contacts.separations[*p].distance < scene.contact_range(kind, &pairs[*p])
                })
                .map(|(_, used)| used);
            if kind == PairKind::VertexHalfSpace {
                touching.held.par_extend(in_range.map(|used| used[0]));
            } else {
                let joined = in_range.flat_map_iter(|used| used[1..].iter().map(|&v| [used[0], v]));
                touching.pairs.par_extend(joined);
            }
        };
        // One way to the threads for all loops.
        rayon::scope(|_| PairKind::ALL.into_iter().for_each(note));
    }

    /// The forces that the contacts carry.
    pub fn carried(&self) -> Vec<ContactForce> {
        let of_springs = || self.springs.iter().map(|spring| spring.force);
        self.resumed.clone().unwrap_or_else(|| self.with_forces(of_springs()))
    }

    /// The contacts with other forces, by spring [N].
    fn with_forces(&self, forces: impl Iterator<Item = Vector>) -> Vec<ContactForce> {
        let of_springs = self.features.iter().zip(&self.springs).zip(forces);
        of_springs
            .map(|((features, spring), force)| ContactForce {
                features: *features,
                normal: spring.normal,
                force,
            })
            .collect()
    }

    /// Moves the `forces` of the springs, by spring [N], back towards what they carried.
    pub fn relax(&self, forces: &mut [Vector]) {
        for (force, spring) in forces.iter_mut().zip(&self.springs) {
            relax_force(force, &spring.force);
        }
    }

    /// The forces after the dynamics and the collision stage: `forces` of the springs, by spring [N], and
    /// those of active rows.
    pub fn carried_after(&mut self, forces: &[Vector], resolver: &Resolver, dt: f64) -> Vec<ContactForce> {
        let (scene, contacts) = (resolver.scene(), &resolver.state().contacts);
        let mut carried = self.with_forces(forces.iter().copied());
        let unit = scene.mean_mass() / (dt * dt);
        self.counted.clone_from(&self.solved);
        for kind in PairKind::ALL {
            for p in contacts.pairs.range(kind) {
                let (lambda, separation) = (contacts.multipliers[p], &contacts.separations[p]);
                if lambda == 0.0 {
                    continue;
                }
                let pair = &contacts.pairs.pairs()[p];
                let rubbing = contacts.friction_multipliers.get(p).copied().unwrap_or_else(Vector::zeros);
                let force = (separation.normal * lambda + rubbing) * unit;
                let used = &pair.vertices[..kind.vertex_count()];
                if self.stiffness > 0.0 && self.is_elastic(used) {
                    let (features, sign) = oriented(scene.features(kind, pair, separation));
                    let (normal, force) = (separation.normal * sign, force * sign);
                    carried.push(ContactForce { features, normal, force });
                } else {
                    used.iter().for_each(|&v| self.counted[v as usize] = false);
                }
            }
        }
        carried
    }

    /// Finds the contacts at the present state of the collision stage, in the order of its candidate pairs,
    /// and gives them the forces of the contacts before. `start` are positions at the start of the time step.
    pub fn find(&mut self, resolver: &Resolver, carried: &[ContactForce], start: &[Point], dt: f64) {
        self.springs.clear();
        self.features.clear();
        if self.stiffness == 0.0 {
            return;
        }
        let scene = resolver.scene();
        let with_force = carried.iter().filter(|c| c.force != Vector::zeros());
        let mut loaded = FxHashSet::with_capacity_and_hasher(carried.len(), FxBuildHasher);
        loaded.extend(with_force.map(|c| c.features));
        let mut index = Index::default();
        self.add(resolver, start, dt, &mut index, |features, _| {
            Some(if loaded.contains(features) { LOADED_TOLERANCE } else { CONE_TOLERANCE })
        });
        let orphans = self.orphans(scene, carried, &index);
        if !orphans.is_empty() {
            self.add(resolver, start, dt, &mut index, |features, normal| {
                let pressure = orphans.get(&side(scene, features)?)?;
                (normal.dot(pressure) > 0.0).then_some(LOADED_TOLERANCE)
            });
        }
        let moved = moved_edges(resolver, carried, &index);
        for (features, spring) in self.limited.taut(&resolver.state().x, start, self.stiffness, &loaded) {
            index.insert(features, self.springs.len());
            self.features.push(features);
            self.springs.push(spring);
        }
        self.hand_on(scene, carried, &index, &moved);
    }

    /// Adds the pairs in range that are contacts within a tolerance, by features and normal, and not in the
    /// `index` yet: of those with the same features the first one.
    fn add(
        &mut self,
        resolver: &Resolver,
        start: &[Point],
        dt: f64,
        index: &mut Index,
        tolerance: impl Fn(&[Feature; 2], &Vector) -> Option<f64> + Sync,
    ) {
        let mut found = self.near_contacts(resolver, &tolerance);
        index.reserve(found.len());
        found.retain(|contact| {
            let Entry::Vacant(entry) = index.entry(contact.features) else { return false };
            entry.insert(self.features.len());
            self.features.push(contact.features);
            true
        });
        let spring = |contact: &NearContact| self.spring(resolver, contact, start, dt);
        let springs: Vec<RepulsionSpring> = found.par_iter().with_min_len(MIN_PAIRS).map(spring).collect();
        self.springs.extend(springs);
    }

    /// The pairs in contact range that are contacts within a tolerance, by features and normal, and deform
    /// something.
    fn near_contacts(
        &self,
        resolver: &Resolver,
        tolerance: &(impl Fn(&[Feature; 2], &Vector) -> Option<f64> + Sync),
    ) -> Vec<NearContact> {
        let (scene, state) = (resolver.scene(), resolver.state());
        let contacts = &state.contacts;
        let of_kind = |kind: PairKind| {
            let contact = move |place: usize| {
                let (separation, pair) = (&contacts.separations[place], &contacts.pairs.pairs()[place]);
                // A pair whose distance is not a number gets no spring.
                let near = separation.distance < scene.contact_range(kind, pair);
                if !near || !self.is_elastic(&pair.vertices[..kind.vertex_count()]) {
                    return None;
                }
                let (features, sign) = oriented(scene.features(kind, pair, separation));
                let normal = separation.normal * sign;
                let tolerance = tolerance(&features, &normal)?;
                let is_contact = scene.is_contact(features, &normal, &state.x, tolerance);
                is_contact.then_some(NearContact { features, sign, tolerance, kind, place })
            };
            contacts.pairs.range(kind).into_par_iter().with_min_len(MIN_PAIRS).filter_map(contact)
        };
        let mut found = Vec::new();
        // One way to the threads for all loops.
        rayon::scope(|_| PairKind::ALL.into_iter().for_each(|kind| found.par_extend(of_kind(kind))));
        found
    }

    /// The spring of a contact, without a force.
    fn spring(
        &self,
        resolver: &Resolver,
        &NearContact { features, sign, tolerance, kind, place }: &NearContact,
        start: &[Point],
        dt: f64,
    ) -> RepulsionSpring {
        let (scene, state) = (resolver.scene(), resolver.state());
        let contacts = &state.contacts;
        let (separation, pair) = (&contacts.separations[place], &contacts.pairs.pairs()[place]);
        let mut normal = separation.normal * sign;
        // A normal outside of the cones is turned to their border: a tilted one would push sliding
        // bodies aside.
        if tolerance > CONE_TOLERANCE {
            normal = scene.turned(features, &normal, &state.x);
        }
        let plane = (kind == PairKind::VertexHalfSpace)
            .then(|| scene.model().half_spaces()[pair.elements[1] as usize]);
        let offset = plane.map_or(0.0, |plane| plane.offset);
        let weights = separation.signed_weights(kind).map(|weight| weight * sign);
        let mut vertices = pair.vertices;
        (0..4).filter(|&k| weights[k] == 0.0).for_each(|k| vertices[k] = pair.vertices[0]);
        let sides: Vector = (0..4).map(|k| start[vertices[k] as usize].coords * weights[k]).sum();
        let (desired, distance) = (scene.desired_distance(kind, pair), separation.distance);
        // For contacts that are new or have turned, the gap between the same points at the start may
        // be smaller than the one that the collision stage has reached.
        let first = (normal.dot(&sides) - offset).max(distance.min(desired));
        let growth = scene.lengths().separation_speed * dt;
        RepulsionSpring {
            vertices,
            weights,
            normal,
            offset,
            desired: desired_gap(desired, first, growth, dt),
            stiffness: self.stiffness,
            friction: contacts.frictions.get(place).copied().unwrap_or(0.0),
            force: Vector::zeros(),
        }
    }

    /// The sides whose contacts carried a force and are gone, if no other contact that carried one holds
    /// them, with their normal forces [N].
    fn orphans(
        &self,
        scene: &CollisionScene,
        carried: &[ContactForce],
        index: &Index,
    ) -> FxHashMap<Side, Vector> {
        let mut orphans = lost_by_side(scene, carried, index);
        for (features, spring) in self.features.iter().zip(&self.springs) {
            if let Some(side) = side(scene, features)
                && orphans.get(&side).is_some_and(|pressure| spring.normal.dot(pressure) > 0.0)
            {
                orphans.remove(&side);
            }
        }
        orphans
    }

    /// Gives the springs the forces of the contacts before. A force goes to the contact of the same features.
    /// That of two edges goes to the feature that their closest points have moved to, or to a contact that
    /// one of the edges has now. That of a vertex against a body goes to the contact of the vertex whose
    /// normal is closest to the former one, because another contact of the vertex may be ahead of it.
    fn hand_on(
        &mut self,
        scene: &CollisionScene,
        carried: &[ContactForce],
        index: &Index,
        moved: &MovedEdges,
    ) {
        let mut of_vertices: FxHashMap<Side, Vec<ContactForce>> = FxHashMap::default();
        let mut of_edges: Vec<ContactForce> = Vec::new();
        let mut at_edge: FxHashMap<u32, usize> = FxHashMap::default();
        for contact in carried.iter().filter(|c| c.force != Vector::zeros()) {
            let ContactForce { features, force, .. } = contact;
            if let Some(&spring) = index.get(features) {
                self.springs[spring].force += force;
            } else if let Some(&(spring, sign)) = moved.get(features) {
                self.springs[spring].force += force * sign;
            } else if let Some(side) = side(scene, features) {
                of_vertices.entry(side).or_default().push(*contact);
            } else if let [Feature::Edge(a), Feature::Edge(b)] = features
                && a != b
            {
                at_edge.insert(*a, of_edges.len());
                at_edge.insert(*b, of_edges.len());
                of_edges.push(*contact);
            }
        }
        if of_vertices.is_empty() && of_edges.is_empty() {
            return;
        }
        let mut at_side: FxHashMap<Side, Vec<usize>> = FxHashMap::default();
        for (spring, features) in self.features.iter().enumerate() {
            if let Some(side) = side(scene, features)
                && of_vertices.contains_key(&side)
            {
                at_side.entry(side).or_default().push(spring);
            }
            if let [Feature::Edge(a), Feature::Edge(b)] = features
                && a != b
                && let Some(&left) = at_edge.get(a).or_else(|| at_edge.get(b))
                && self.springs[spring].normal.dot(&of_edges[left].normal) > 0.0
            {
                self.springs[spring].force += std::mem::take(&mut of_edges[left].force);
            }
        }
        for (side, springs) in &at_side {
            for lost in &of_vertices[side] {
                let agrees = |spring: usize| self.springs[spring].normal.dot(&lost.normal);
                let most = springs.iter().map(|&s| agrees(s)).fold(0.0, f64::max);
                let nearest = |s: &usize| most > 0.0 && agrees(*s) >= NEAREST * most;
                let nearest: Vec<usize> = springs.iter().copied().filter(nearest).collect();
                nearest.iter().for_each(|&s| self.springs[s].force += lost.force / nearest.len() as f64);
            }
        }
    }

    /// Whether the residual of a time step counts the forces on each vertex: those of bodies that Newton's
    /// method solves together with their contacts, except vertices that only rows hold, of which it does not
    /// know.
    pub fn counted(&self) -> &[bool] {
        &self.counted
    }

    /// Removes contacts that the vertices will have passed at the end of the time step if they move by
    /// `motion` [m], faces excepted. An edge ahead of a vertex, on the surface on which it slides, must not
    /// stop it.
    pub fn anticipate(&mut self, motion: &mut [Vector]) {
        let approach = |spring: &RepulsionSpring, motion: &[Vector]| {
            let used = (0..4).filter(|&k| spring.weights[k] != 0.0);
            used.map(|k| motion[spring.vertices[k] as usize] * spring.weights[k]).sum::<Vector>()
        };
        let is_face =
            |features: &[Feature; 2]| matches!(features[1], Feature::Triangle(_) | Feature::HalfSpace(_));
        for (features, spring) in self.features.iter().zip(&self.springs) {
            if !is_face(features) {
                continue;
            }
            // The gap is at least the desired one, or opens to it no faster than the separation speed.
            let closing = -approach(spring, motion).dot(&spring.normal);
            if closing > 0.0 {
                motion[spring.vertices[0] as usize] += spring.normal * closing;
            }
        }
        let passed: Vec<bool> = self
            .features
            .iter()
            .zip(&self.springs)
            .map(|(features, spring)| {
                let start = spring.normal * spring.desired;
                let way = approach(spring, motion);
                let length = way.norm_squared();
                // A contact that carries a force is not ahead.
                if is_face(features) || spring.force != Vector::zeros() || length == 0.0 {
                    return false;
                }
                let nearest = (-start.dot(&way) / length).clamp(0.0, 1.0);
                let [nearest, end] = [nearest, 1.0].map(|t| (start + way * t).norm());
                nearest > PASSING * spring.desired && end >= (1.0 - 1e-9) * spring.desired
            })
            .collect();
        let mut keep = passed.iter().map(|passed| !passed);
        self.springs.retain(|_| keep.next().unwrap_or(true));
        let mut keep = passed.iter().map(|passed| !passed);
        self.features.retain(|_| keep.next().unwrap_or(true));
    }

    /// Whether a contact deforms something.
    fn is_elastic(&self, vertices: &[u32]) -> bool {
        vertices.iter().any(|&v| self.solved[v as usize])
    }

    /// Gives the springs to the dynamics.
    pub fn apply(&self, dynamics: &mut Dynamics) -> Result<(), StepError> {
        if self.stiffness == 0.0 { Ok(()) } else { dynamics.set_repulsion(&self.springs) }
    }
}

/// Gap that contacts of the dynamics approach in time, in the desired distance of the collision stage, so
/// that the collision stage changes nothing at rest.
const SLACK: f64 = 1.05;

/// Time in which they approach it [s].
const OPENING_TIME: f64 = 0.05;

/// Sine of the angle by which normals may leave their cones. A body that slides by 1 cm on a plane tilted by
/// this angle rises by 0.02 mm; more would disturb a stiff body.
const CONE_TOLERANCE: f64 = 2e-3;

/// The same for contacts that carry a force, so that they do not come and go when surfaces tremble.
const LOADED_TOLERANCE: f64 = 0.2;

/// Gap that a contact should have at the end of a time step [m]. It starts with `distance`, the collision
/// stage asks for `desired`, and it opens by `growth` per step at most.
fn desired_gap(desired: f64, distance: f64, growth: f64, dt: f64) -> f64 {
    let most = SLACK * desired;
    let opened = distance + (most - distance) * (dt / OPENING_TIME).min(1.0);
    desired.min(distance + growth).max(opened).min(most)
}

/// Share of the largest cosine between normals above which another one counts as equal: those of a flat
/// surface.
const NEAREST: f64 = 0.999;

/// Share of the desired distance that a vertex must keep from a feature to count as passing it.
const PASSING: f64 = 0.5;

/// Pairs that one thread looks at, at least.
const MIN_PAIRS: usize = 1024;

/// A pair that is a contact.
#[derive(Clone, Copy, Debug)]
struct NearContact {
    /// Features of its sides, [`oriented`], and the sign that goes with it.
    features: [Feature; 2],
    sign: f64,
    /// Sine of the angle by which its normal may leave the cones.
    tolerance: f64,
    kind: PairKind,
    /// Its place in the list of pairs.
    place: usize,
}

/// Indices of springs by their features.
type Index = FxHashMap<[Feature; 2], usize>;

/// A vertex, and a body that it is in contact with; half-spaces count from the end.
type Side = (u32, u32);

/// Springs that have taken over from two edges, with the sign of the force in them.
type MovedEdges = FxHashMap<[Feature; 2], (usize, f64)>;

/// The vertex of a contact, and the body on the other side.
fn side(scene: &CollisionScene, features: &[Feature; 2]) -> Option<Side> {
    let body = |vertex: u32| scene.model().vertex_body().get(vertex as usize).copied();
    let topology = scene.model().topology();
    let Feature::Vertex(vertex) = features[0] else { return None };
    // Features of a checkpoint may be anything.
    let other = match features[1] {
        Feature::Vertex(v) => body(v)?,
        Feature::Edge(e) => body(topology.edges.get(e as usize)?[0])?,
        Feature::Triangle(t) => body(topology.triangles.get(t as usize)?[0])?,
        Feature::HalfSpace(h) => u32::MAX - h,
    };
    Some((vertex, other))
}

/// Normal forces of vertices that no spring of the same features carries on, by side [N].
fn lost_by_side(scene: &CollisionScene, carried: &[ContactForce], index: &Index) -> FxHashMap<Side, Vector> {
    let mut lost = FxHashMap::default();
    for ContactForce { features, normal, force } in carried {
        if *force != Vector::zeros()
            && !index.contains_key(features)
            && let Some(side) = side(scene, features)
        {
            *lost.entry(side).or_insert_with(Vector::zeros) += normal * normal.dot(force);
        }
    }
    lost
}

/// Pairs of edges that carried a force and whose closest points are now at an end of one: the contact that
/// replaces them.
fn moved_edges(resolver: &Resolver, carried: &[ContactForce], index: &Index) -> MovedEdges {
    let is_lost = |features: &[Feature; 2]| {
        matches!(features, [Feature::Edge(a), Feature::Edge(b)] if a != b) && !index.contains_key(features)
    };
    let lost: FxHashSet<[Feature; 2]> = carried.iter().map(|c| c.features).filter(is_lost).collect();
    let mut moved = MovedEdges::default();
    if lost.is_empty() {
        return moved;
    }
    let (scene, contacts) = (resolver.scene(), &resolver.state().contacts);
    for p in contacts.pairs.range(PairKind::EdgeEdge) {
        let pair = &contacts.pairs.pairs()[p];
        let [a, b] = pair.elements;
        let before = [Feature::Edge(a), Feature::Edge(b)];
        if lost.contains(&before) {
            let features = scene.features(PairKind::EdgeEdge, pair, &contacts.separations[p]);
            let (features, sign) = oriented(features);
            if let Some(&spring) = index.get(&features) {
                moved.insert(before, (spring, sign));
            }
        }
    }
    moved
}

/// Features with a vertex before an edge, so that pairs of different kinds at the same features are one
/// contact, and the sign that normal and force take.
fn oriented(features: [Feature; 2]) -> ([Feature; 2], f64) {
    match features {
        [edge @ Feature::Edge(_), vertex @ Feature::Vertex(_)] => ([vertex, edge], -1.0),
        _ => (features, 1.0),
    }
}
