//! What is fixed about a scene, and every length that parameters leave to the mesh.

use crate::waiting::set_groups;
use crate::{Call, ContactTable, Params, ResolveError, Spacing};
use bowknot_constraints::{DesiredDistance, Facing, Feature, FrictionModel, STRETCH_LIMIT};
use bowknot_geometry::{PairKind, Point, Separation, Vector};
use bowknot_proximity::{CollisionModel, Pair};
use bowknot_stepper::Rounding;

/// Lengths in force: stated ones as they are, the others from the mesh [m].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lengths {
    /// Mean rest length of the deformable edges, h.
    pub edge: f64,
    /// Desired distance of contacts, delta.
    pub delta: f64,
    /// Gap floor, xi.
    pub floor: f64,
    /// Distance within which pairs become rows.
    pub contact_range: f64,
    /// Speed at which tight pairs are separated [m/s].
    pub separation_speed: f64,
}

/// What is fixed about a scene: collision model, rest positions, masses, lengths, parameters.
#[derive(Clone, Debug)]
pub struct Problem {
    /// Topology, bodies, filters, half-spaces.
    pub model: CollisionModel,
    /// Rest positions [m].
    pub rest: Vec<Point>,
    /// Mass of each vertex relative to the mean mass of deformable vertices; 0 for obstacles.
    pub relative_mass: Vec<f64>,
    /// Mean rest length of the edges at each vertex [m]; the mean edge length where there is none.
    pub local_edge: Vec<f64>,
    /// Vertices of obstacles, ascending.
    pub obstacle_vertices: Vec<u32>,
    /// What bodies and half-spaces bring into their contacts.
    pub contact: ContactTable,
    /// Mean mass of the deformable vertices [kg]: the unit of relative masses.
    pub mean_mass: f64,
    /// Lengths in force.
    pub lengths: Lengths,
    /// Desired distances and floors of the pairs.
    pub spacing: Spacing,
    /// Parameters as given.
    pub params: Params,
    /// Vertices that are prescribed in the present call: obstacles and pins.
    pub prescribed: Vec<bool>,
    /// Groups of pinned vertices that go as one in the present call: group of each vertex, counted from 0;
    /// [`crate::Call::NO_GROUP`] for none. Empty: no groups.
    pub groups: Vec<u32>,
    /// Tells contacts from pairs that are merely near.
    pub facing: Facing,
    /// How many groups there are.
    pub group_count: usize,
    /// The caller's names of the groups, ascending.
    pub group_names: Vec<u32>,
}

impl Problem {
    /// Checks the input and fills in the lengths.
    ///
    /// # Errors
    /// See [`crate::Resolver::new`].
    pub fn new(
        model: CollisionModel,
        rest: &[Point],
        masses: &[f64],
        params: Params,
    ) -> Result<Self, ResolveError> {
        params.validate().map_err(ResolveError::Params)?;
        let vertices = model.topology().vertex_count;
        for (what, given) in [("rest positions", rest.len()), ("masses", masses.len())] {
            if given != vertices {
                return Err(ResolveError::Length { what, given, vertices });
            }
        }
        check_finite("the rest position", &model, rest)?;
        let prescribed: Vec<bool> = (0..vertices as u32).map(|v| model.is_obstacle(v)).collect();
        let mut total = 0.0;
        for (vertex, &mass) in masses.iter().enumerate().filter(|(v, _)| !prescribed[*v]) {
            if !(mass.is_finite() && mass > 0.0) {
                return Err(ResolveError::Mass { vertex, body: model.vertex_body()[vertex], mass });
            }
            total += mass;
        }
        let deformable = prescribed.iter().filter(|p| !**p).count();
        let mean = total / deformable.max(1) as f64;
        let relative_mass =
            masses.iter().zip(&prescribed).map(|(m, fixed)| if *fixed { 0.0 } else { m / mean }).collect();
        let obstacle_vertices = (0..vertices as u32).filter(|&v| prescribed[v as usize]).collect();
        let contact = ContactTable::new(&model);
        let (edge, local_edge) = edge_lengths(&model, &contact, &params, rest, &prescribed);
        let lengths = lengths(&params, edge);
        let spacing = Spacing::new(&model, &contact, &params, lengths.delta, lengths.floor);
        Ok(Self {
            mean_mass: mean,
            spacing,
            facing: Facing::new(model.topology()),
            groups: Vec::new(),
            group_count: 0,
            group_names: Vec::new(),
            model,
            contact,
            rest: rest.to_vec(),
            relative_mass,
            local_edge,
            obstacle_vertices,
            lengths,
            params,
            prescribed,
        })
    }

    /// The features that the closest points of a pair lie on, of side a and side b.
    pub fn features(&self, kind: PairKind, pair: &Pair, separation: &Separation) -> [Feature; 2] {
        Facing::features(self.model.topology(), kind, pair, separation)
    }

    /// Whether two features touch that are `normal` apart, from the second to the first, or are merely near: see [`Facing`].
    pub fn is_contact(
        &self,
        features: [Feature; 2],
        normal: &Vector,
        positions: &[Point],
        tolerance: f64,
    ) -> bool {
        self.facing.is_contact(self.model.topology(), features, normal, positions, tolerance)
    }

    /// The direction in the normal cones of both `features` that is nearest to `normal`, see [`Facing::turned`](bowknot_constraints::Facing::turned).
    pub fn turned(&self, features: [Feature; 2], normal: &Vector, positions: &[Point]) -> Vector {
        self.facing.turned(self.model.topology(), features, normal, positions)
    }

    /// Starts a call: checks its input, and takes over what it prescribes.
    ///
    /// # Errors
    /// Wrong lengths, non-finite numbers and coordinates too large for the floor.
    pub fn begin(
        &mut self,
        positions: &[Point],
        target: &[Point],
        call: &Call<'_>,
    ) -> Result<(), ResolveError> {
        let vertices = self.rest.len();
        for (what, given) in [("positions", positions.len()), ("target", target.len())] {
            if given != vertices {
                return Err(ResolveError::Length { what, given, vertices });
            }
        }
        for (what, given) in [("prescribed", call.prescribed.len()), ("groups", call.groups.len())] {
            if given != 0 && given != vertices {
                return Err(ResolveError::Length { what, given, vertices });
            }
        }
        if let Some(start) = call.start {
            if start.len() != vertices {
                return Err(ResolveError::Length { what: "start", given: start.len(), vertices });
            }
            check_finite("the start", &self.model, start)?;
        }
        check_finite("the position", &self.model, positions)?;
        check_finite("the target", &self.model, target)?;
        check_floor(self, positions, target)?;
        for v in 0..vertices {
            self.prescribed[v] =
                self.model.is_obstacle(v as u32) || call.prescribed.get(v).copied().unwrap_or(false);
        }
        set_groups(self, call.groups);
        Ok(())
    }

    /// Derives the lengths anew from the contact data.
    pub(crate) fn contact_changed(&mut self) {
        let obstacle: Vec<bool> = (0..self.rest.len() as u32).map(|v| self.model.is_obstacle(v)).collect();
        let (edge, local_edge) =
            edge_lengths(&self.model, &self.contact, &self.params, &self.rest, &obstacle);
        self.local_edge = local_edge;
        self.lengths = lengths(&self.params, edge);
        let Lengths { delta, floor, .. } = self.lengths;
        self.spacing = Spacing::new(&self.model, &self.contact, &self.params, delta, floor);
    }

    /// Largest ratio of an edge's length to its reference; infinite for no limit.
    pub fn stretch_limit(&self, body: u32) -> f64 {
        let own = self.contact.bodies()[body as usize].stretch_limit;
        own.or(self.params.constraints.stretch_limit).unwrap_or(STRETCH_LIMIT)
    }

    /// The distance that a pair is separated to in the end, however tight it starts [m].
    pub fn desired_distance(&self, kind: PairKind, pair: &Pair) -> f64 {
        let delta = self.spacing.of(&self.model, kind, pair).delta;
        let rule = DesiredDistance { delta, growth: f64::INFINITY };
        rule.at_ease(&self.model, kind, pair, &self.rest).0
    }

    /// Distance within which a pair is listed, whatever moves [m].
    pub fn contact_range(&self, kind: PairKind, pair: &Pair) -> f64 {
        self.spacing.contact_range(&self.model, kind, pair)
    }

    /// How friction acts; none where no body has any.
    pub fn friction_model(&self) -> FrictionModel {
        match self.contact.frictional() {
            true => self.params.constraints.friction_model,
            false => FrictionModel::None,
        }
    }

    /// Whether the present call may move a vertex on its own account.
    #[inline]
    pub fn movable(&self, vertex: usize) -> bool {
        !self.prescribed[vertex]
    }
}

/// Refuses positions that are not finite.
fn check_finite(what: &'static str, model: &CollisionModel, positions: &[Point]) -> Result<(), ResolveError> {
    match positions.iter().position(|p| !p.iter().all(|c| c.is_finite())) {
        Some(vertex) => Err(ResolveError::NonFinite { what, vertex, body: model.vertex_body()[vertex] }),
        None => Ok(()),
    }
}

fn check_floor(problem: &Problem, positions: &[Point], target: &[Point]) -> Result<(), ResolveError> {
    let thicknesses = problem.contact.bodies().iter().filter_map(|b| b.thickness).filter(|t| *t > 0.0);
    let scene = problem.lengths.floor;
    let floor = thicknesses.fold(if scene > 0.0 { scene } else { f64::INFINITY }, f64::min);
    let floor = if floor.is_finite() { floor } else { 0.0 };
    let largest = |p: &Point| p.coords.amax();
    let (vertex, coordinate) = positions
        .iter()
        .enumerate()
        .chain(target.iter().enumerate())
        .map(|(v, p)| (v, largest(p)))
        .fold((0, 0.0), |best, next| if next.1 > best.1 { next } else { best });
    let needed = Rounding::smallest_floor(coordinate);
    if floor > 0.0 && floor < needed {
        return Err(ResolveError::FloorBelowRounding { floor, coordinate, vertex, needed });
    }
    Ok(())
}

/// What a particle has for an edge length, in its body's delta: one that grains roll over each other within.
const PARTICLE_EDGE: f64 = 2.5;

/// Mean rest edge length of the deformable bodies, and of the edges at each vertex. Particles count by their body's
/// delta, or the scene's where it is stated; a scene of particles without either takes a hundredth of its diagonal.
fn edge_lengths(
    model: &CollisionModel,
    contact: &ContactTable,
    params: &Params,
    rest: &[Point],
    obstacle: &[bool],
) -> (f64, Vec<f64>) {
    let mut sums = vec![(0.0f64, 0u32); rest.len()];
    let (mut total, mut count) = (0.0, 0u32);
    for &[a, b] in &model.topology().edges {
        let (a, b) = (a as usize, b as usize);
        let length = (rest[a] - rest[b]).norm();
        for v in [a, b] {
            sums[v].0 += length;
            sums[v].1 += 1;
        }
        if !obstacle[a] {
            total += length;
            count += 1;
        }
    }
    for &v in model.topology().particles.iter().filter(|v| !obstacle[**v as usize]) {
        let body = model.vertex_body()[v as usize] as usize;
        if let Some(delta) = contact.bodies()[body].delta.or(params.constraints.delta) {
            sums[v as usize] = (PARTICLE_EDGE * delta, 1);
            total += PARTICLE_EDGE * delta;
            count += 1;
        }
    }
    let mean = if count > 0 && total > 0.0 {
        total / f64::from(count)
    } else {
        let low = rest.iter().fold(Point::origin(), |m, p| m.inf(p));
        let high = rest.iter().fold(Point::origin(), |m, p| m.sup(p));
        let diagonal = (high - low).norm();
        if diagonal > 0.0 { 0.01 * diagonal } else { 0.01 }
    };
    // An obstacle's own edges may be far larger than the cloth that it meets; its travel is budgeted by
    // the finer of the two.
    let local = sums
        .iter()
        .enumerate()
        .map(|(v, &(sum, n))| {
            let own = if n > 0 && sum > 0.0 { sum / f64::from(n) } else { mean };
            if obstacle[v] { own.min(mean) } else { own }
        })
        .collect();
    (mean, local)
}

fn lengths(params: &Params, edge: f64) -> Lengths {
    let delta = params.constraints.delta.unwrap_or(0.1 * edge);
    Lengths {
        edge,
        delta,
        floor: params.stepper.floor.unwrap_or(0.1 * delta),
        contact_range: params.constraints.range * delta,
        separation_speed: params.constraints.separation_speed.unwrap_or(20.0 * delta),
    }
}
