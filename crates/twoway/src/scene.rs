//! What is fixed for a scene, and every length that parameters leave to the mesh.

use crate::bodies::{ContactData, ContactTable};
use crate::error::ResolveError;
use crate::params::Params;
use crate::spacing::{MIN_SEPARATION_MARGIN, Spacing};
use crate::validation::{check_finite, check_length, check_rows};
use bowknot_constraints::{DeltaRule, Facing, Feature, FrictionModel, STRETCH_LIMIT};
use bowknot_errors::{Checks, Parameters};
use bowknot_geometry::{BodyFilter, HalfSpace, Identity, PairKind, Point, Separation, Vector};
use bowknot_proximity::{CollisionModel, Pair};

/// The lengths of a scene: those that parameters state, and the others from the mesh [m].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lengths {
    /// Mean rest length of the deformable edges, h.
    pub edge: f64,
    /// Contact distance of contacts, delta.
    pub delta: f64,
    /// Minimum separation, xi.
    pub min_separation: f64,
    /// Distance within which pairs become rows.
    pub contact_range: f64,
    /// Speed at which pairs are separated that start closer than delta [m/s].
    pub separation_speed: f64,
}

/// What is fixed for a scene: collision model, rest positions, masses, lengths, parameters.
#[derive(Clone, Debug)]
pub struct CollisionScene {
    model: CollisionModel,
    rest: Vec<Point>,
    relative_masses: Vec<f64>,
    mean_mass: f64,
    local_edges: Vec<f64>,
    obstacle_vertices: Vec<u32>,
    contact: ContactTable,
    lengths: Lengths,
    spacing: Spacing,
    params: Params,
    /// Tells contacts from pairs that are only close.
    facing: Facing,
    identity: Identity,
}

impl CollisionScene {
    /// Checks the input and derives the lengths.
    ///
    /// # Errors
    /// See [`crate::Resolver::new`].
    pub fn new(
        model: CollisionModel,
        rest: &[Point],
        masses: &[f64],
        contact: ContactData,
        params: Params,
    ) -> Result<Self, ResolveError> {
        params.validate().map_err(ResolveError::Params)?;
        let vertices = model.topology().vertex_count;
        check_rows(0, model.topology().edges.len())?;
        check_length("rest positions", rest.len(), vertices)?;
        check_length("masses", masses.len(), vertices)?;
        check_finite("the rest position", &model, rest)?;
        let obstacle = obstacle_flags(&model);
        let mut total = 0.0;
        for (vertex, &mass) in masses.iter().enumerate().filter(|(v, _)| !obstacle[*v]) {
            if !(mass.is_finite() && mass > 0.0) {
                return Err(ResolveError::Mass { vertex, body: model.vertex_body()[vertex], mass });
            }
            total += mass;
        }
        let deformable = obstacle.iter().filter(|is_obstacle| !**is_obstacle).count();
        let mean = total / deformable.max(1) as f64;
        let relative_masses =
            masses.iter().zip(&obstacle).map(|(m, fixed)| if *fixed { 0.0 } else { m / mean }).collect();
        let obstacle_vertices = (0..vertices as u32).filter(|&v| obstacle[v as usize]).collect();
        let contact = ContactTable::new(&model, contact)?;
        let (edge, local_edges) = edge_lengths(&model, &contact, &params, rest, &obstacle);
        let lengths = lengths(&params, edge);
        let spacing =
            Spacing::new(&model, &contact, params.contact.range, lengths.delta, lengths.min_separation);
        Ok(Self {
            facing: Facing::new(model.topology()),
            model,
            rest: rest.to_vec(),
            relative_masses,
            mean_mass: mean,
            local_edges,
            obstacle_vertices,
            contact,
            lengths,
            spacing,
            params,
            identity: Identity::unique(),
        })
    }

    /// Topology, bodies, filters, half-spaces.
    pub fn model(&self) -> &CollisionModel {
        &self.model
    }

    /// Tells the scene from all others but its clones, whatever the filters of their bodies:
    /// [`CollisionModel::identity`] tells these.
    pub fn identity(&self) -> Identity {
        self.identity
    }

    /// Number of vertices.
    pub fn vertex_count(&self) -> usize {
        self.rest.len()
    }

    /// Rest positions [m].
    pub fn rest(&self) -> &[Point] {
        &self.rest
    }

    /// Mass of a vertex relative to the mean mass of the deformable vertices, m^; 0 for obstacles.
    #[inline]
    pub fn relative_mass(&self, vertex: usize) -> f64 {
        self.relative_masses[vertex]
    }

    /// Mean mass of the deformable vertices [kg]: the unit of relative masses.
    pub fn mean_mass(&self) -> f64 {
        self.mean_mass
    }

    /// Mean rest length of the edges at a vertex [m]; the mean edge length of the scene if it has none or
    /// belongs to an obstacle.
    #[inline]
    pub fn local_edge(&self, vertex: usize) -> f64 {
        self.local_edges[vertex]
    }

    /// Vertices of obstacles, ascending.
    pub fn obstacle_vertices(&self) -> &[u32] {
        &self.obstacle_vertices
    }

    /// Contact data of bodies and half-spaces.
    pub fn contact(&self) -> &ContactTable {
        &self.contact
    }

    /// Lengths in force.
    pub fn lengths(&self) -> &Lengths {
        &self.lengths
    }

    /// Distance to its target at which a vertex has arrived [m].
    pub fn arrival_distance(&self) -> f64 {
        self.params.solver.stop.distance * self.lengths.edge
    }

    /// Contact distances and minimum separations of the pairs.
    pub fn spacing(&self) -> &Spacing {
        &self.spacing
    }

    /// Parameters as given.
    pub fn params(&self) -> &Params {
        &self.params
    }

    /// The features that the closest points of a pair lie on, of side a and side b.
    pub fn features(&self, kind: PairKind, pair: &Pair, separation: &Separation) -> [Feature; 2] {
        Facing::features(self.model.topology(), kind, pair, separation)
    }

    /// Whether two features are a contact or only close, see [`Facing`]. `normal` points from the second to
    /// the first.
    pub fn is_contact(
        &self,
        features: [Feature; 2],
        normal: &Vector,
        positions: &[Point],
        tolerance: f64,
    ) -> bool {
        self.facing.is_contact(self.model.topology(), features, normal, positions, tolerance)
    }

    /// How much of a contact two features are, see
    /// [`Facing::contact_share`](bowknot_constraints::Facing::contact_share).
    pub fn contact_share(&self, features: [Feature; 2], normal: &Vector, positions: &[Point]) -> f64 {
        self.facing.contact_share(self.model.topology(), features, normal, positions)
    }

    /// The direction in the normal cones of both `features` that is closest to `normal`, or the normal of the
    /// `rigid` side where that is flat, see [`Facing::turned`](bowknot_constraints::Facing::turned).
    pub fn turned(
        &self,
        features: [Feature; 2],
        normal: &Vector,
        positions: &[Point],
        rigid: Option<usize>,
    ) -> Vector {
        self.facing.turned(self.model.topology(), features, normal, positions, rigid)
    }

    /// Largest ratio of an edge's length to its reference length in a body; infinite for no limit.
    pub fn stretch_limit(&self, body: u32) -> f64 {
        let own = self.contact.bodies()[body as usize].stretch_limit;
        own.or(self.params.contact.stretch_limit).unwrap_or(STRETCH_LIMIT)
    }

    /// The distance that a pair is separated to in the end, however close it starts [m].
    pub fn delta(&self, kind: PairKind, pair: &Pair) -> f64 {
        let delta = self.spacing.of(&self.model, kind, pair).delta;
        let rule = DeltaRule { delta, growth: f64::INFINITY };
        rule.without_growth_limit(&self.model, kind, pair, &self.rest).0
    }

    /// The minimum separation of a pair in the end, however close it starts [m].
    pub fn min_separation(&self, kind: PairKind, pair: &Pair) -> f64 {
        let delta = self.delta(kind, pair);
        match self.spacing.of(&self.model, kind, pair).min_separation {
            None => self.lengths.min_separation.min(0.1 * delta),
            Some(guaranteed) => guaranteed.min(delta / MIN_SEPARATION_MARGIN),
        }
    }

    /// Distance within which a pair is a candidate, whatever moves [m].
    pub fn contact_range(&self, kind: PairKind, pair: &Pair) -> f64 {
        self.spacing.contact_range(&self.model, kind, pair)
    }

    /// How friction acts; none where no body has any.
    pub fn friction_model(&self) -> FrictionModel {
        if self.contact.frictional() { self.params.contact.friction_model } else { FrictionModel::None }
    }

    /// Changes the filters of bodies and the half-spaces, see [`crate::Resolver::set_filters`].
    ///
    /// # Errors
    /// [`ResolveError::Contact`] if there is another number of entries than of bodies or half-spaces;
    /// [`ResolveError::Mass`] if a body would be deformable whose vertices have no mass. The scene is then
    /// unchanged.
    pub(crate) fn set_filters(
        &mut self,
        filters: &[BodyFilter],
        half_spaces: &[HalfSpace],
    ) -> Result<(), ResolveError> {
        let mut checks = Checks::default();
        for (what, given, count) in [
            ("filters.len()", filters.len(), self.model.bodies().len()),
            ("half_spaces.len()", half_spaces.len(), self.model.half_spaces().len()),
        ] {
            checks.require(given == count, what, given, format!("must be {count}, as the model has"));
        }
        checks.finish().map_err(ResolveError::Contact)?;
        for (vertex, &body) in self.model.vertex_body().iter().enumerate() {
            let mass = self.relative_masses[vertex];
            if !filters[body as usize].obstacle && mass == 0.0 {
                return Err(ResolveError::Mass { vertex, body, mass });
            }
        }
        self.model.set_filters(filters, half_spaces);
        let vertices = 0..self.rest.len() as u32;
        self.obstacle_vertices = vertices.filter(|&v| self.model.is_obstacle(v)).collect();
        Ok(())
    }
}

/// Which vertices belong to obstacles.
fn obstacle_flags(model: &CollisionModel) -> Vec<bool> {
    (0..model.topology().vertex_count as u32).map(|v| model.is_obstacle(v)).collect()
}

/// Edge length of a particle, in its body's delta: the length scale on which grains roll over each other.
const PARTICLE_EDGE: f64 = 2.5;

/// Mean rest length of the edges of all deformable bodies, and of the edges at each vertex. Particles count
/// with the delta of their body, or that of the scene if it is stated. A scene of particles without either
/// takes a hundredth of its diagonal.
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
        if let Some(delta) = contact.bodies()[body].delta.or(params.contact.delta) {
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
    // The mesh of an obstacle says nothing about how far what it meets can move.
    let local = sums
        .iter()
        .enumerate()
        .map(|(v, &(sum, n))| if n > 0 && sum > 0.0 && !obstacle[v] { sum / f64::from(n) } else { mean })
        .collect();
    (mean, local)
}

fn lengths(params: &Params, edge: f64) -> Lengths {
    let delta = params.contact.delta.unwrap_or(0.1 * edge);
    Lengths {
        edge,
        delta,
        min_separation: params.contact.min_separation.unwrap_or(0.1 * delta),
        contact_range: params.contact.range * delta,
        separation_speed: params.contact.separation_speed.unwrap_or(20.0 * delta),
    }
}
