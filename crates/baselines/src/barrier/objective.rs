//! The objective of the log-barrier methods (paper, Eq. 7-8, with the inertia term in units of energy).
//!
//! E(x) = sum 1/2 m/dt^2 |x - y0|^2 + sum m_p(x) B(d_p(x) - xi_p) + sum 1/2 k_e max(|e| - L, 0)^2  [J]
//!
//! over the vertices that are not prescribed, the pairs nearer than the barrier's range and the edges beyond
//! their limit. m_p is the [`Mollifier`] of IPC, and 1 with Eq. 8. Gaps are measured from the minimum
//! separation xi_p that the forward step keeps, as in Codim-IPC with thickness (Li et al. 2021). Otherwise a
//! pair could reach its minimum separation, and the forward step instead of the barrier would hold it.
//! Without minimum separations this is Eq. 8.

use super::function::{Jet, barrier, squared_barrier};
use super::mollifier::{self, Mollifier};
use super::{BarrierForm, BarrierParams};
use crate::geometry;
use bowknot_errors::{Errors, ParamError};
use bowknot_twoway::constraints::EdgeLimits;
use bowknot_twoway::geometry::{PairKind, Point, Separation, Vector};
use bowknot_twoway::lcp::DistanceLimit;
use bowknot_twoway::{CollisionScene, ResolveState, Statistics};
use rayon::prelude::*;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// Smallest number of pairs of a parallel task.
const CHUNK: usize = 512;

/// A pair within the barrier's range.
#[derive(Clone, Copy, Debug)]
pub struct Contact {
    /// Kind of pair.
    pub kind: PairKind,
    /// Its vertices in [`PairKind`] order.
    pub vertices: [u32; 4],
    /// Contact geometry.
    pub separation: Separation,
    /// Barrier of its gap, without the mollifier.
    pub jet: Jet,
    /// The factor on the barrier.
    pub mollifier: Mollifier,
}

/// Gradient of the objective, and a block-diagonal matrix that majorizes the convex part of its Hessian.
#[derive(Clone, Debug, Default)]
pub struct Derivatives {
    /// dE/dx of each vertex [N]; 0 for prescribed ones.
    pub gradient: Vec<Vector>,
    /// A 3x3 block of each vertex [N/m].
    pub blocks: Vec<nalgebra::Matrix3<f64>>,
}

/// The objective of a call.
#[derive(Debug, Default)]
pub struct Objective {
    params: BarrierParams,
    strength: Strength,
    /// Range of the barrier over the contact distance of the pair.
    range_share: f64,
    edges: EdgeLimits,
}

/// Strength of the barrier as the bits of a number, shared by the stages of a method.
#[derive(Clone, Debug, Default)]
struct Strength(Arc<AtomicU64>);

impl Objective {
    /// An objective for the pairs of the scene.
    ///
    /// # Errors
    /// Parameters out of their range, see [`BarrierParams::validate_for`].
    pub fn new(scene: &CollisionScene, params: BarrierParams) -> Result<Self, Errors<ParamError>> {
        params.validate_for(scene)?;
        let objective = Self { params, ..Self::default() };
        objective.set_strength(objective.params.strength);
        Ok(objective)
    }

    /// Another objective of the same parameters, whose strength is always the same.
    pub fn sharing(&self) -> Self {
        Self { params: self.params.clone(), strength: self.strength.clone(), ..Self::default() }
    }

    /// Strength of the barrier, in the units of its form.
    pub fn strength(&self) -> f64 {
        f64::from_bits(self.strength.0.load(Ordering::Relaxed))
    }

    /// Changes the strength, here and in the objectives that share it.
    pub fn set_strength(&self, strength: f64) {
        self.strength.0.store(strength.to_bits(), Ordering::Relaxed);
    }

    /// The parameters.
    pub fn params(&self) -> &BarrierParams {
        &self.params
    }

    /// Starts a call from `state.x`: computes the limits of the edges (paper, Eq. 17).
    pub fn begin(&mut self, scene: &CollisionScene, state: &ResolveState) {
        self.range_share = self.params.range.map_or(1.0, |range| range / scene.lengths().delta);
        let constraints = &scene.params().contact;
        self.edges = EdgeLimits::default();
        if self.params.edge_stiffness > 0.0 && constraints.edges {
            let movable: Vec<bool> = state.call.prescribed().iter().map(|p| !p).collect();
            let limit = |edge: &[u32; 2]| scene.stretch_limit(scene.model().vertex_body()[edge[0] as usize]);
            self.edges = EdgeLimits::new(scene.model().topology(), scene.rest(), &movable, limit);
            self.edges.begin(&state.x, constraints.edge_reference);
        }
    }

    /// m/dt^2 of a vertex [kg/s^2].
    #[inline]
    pub fn inertia(&self, scene: &CollisionScene, state: &ResolveState, vertex: usize) -> f64 {
        self.mean_inertia(scene, state) * scene.relative_mass(vertex)
    }

    /// Mean of m/dt^2 [kg/s^2].
    #[inline]
    pub fn mean_inertia(&self, scene: &CollisionScene, state: &ResolveState) -> f64 {
        let dt = state.call.time_step().unwrap_or(self.params.time_step);
        scene.mean_mass() / (dt * dt)
    }

    /// The pairs within range at `state.x`, in the order of the list.
    pub fn contacts(&self, scene: &CollisionScene, state: &ResolveState) -> Vec<Contact> {
        self.gather(scene, state, &state.x, |_, p| state.contacts.separations[p])
    }

    /// The candidate pairs within range at `x`. They are all pairs within range if the list was made for a
    /// path through x.
    pub fn contacts_at(&self, scene: &CollisionScene, state: &ResolveState, x: &[Point]) -> Vec<Contact> {
        let half_spaces = scene.model().half_spaces();
        self.gather(scene, state, x, |kind, p| {
            let pair = &state.contacts.pairs.pairs()[p];
            geometry::separation(kind, &pair.vertices, pair.elements[1], x, half_spaces)
        })
    }

    fn gather(
        &self,
        scene: &CollisionScene,
        state: &ResolveState,
        x: &[Point],
        separation: impl Fn(PairKind, usize) -> Separation + Sync,
    ) -> Vec<Contact> {
        let candidates = &state.contacts;
        let (form, strength) = (self.params.form, self.strength());
        let contact = |p: usize| -> Option<Contact> {
            let (kind, pair) = (candidates.pairs.kind(p), &candidates.pairs.pairs()[p]);
            let vertices = pair.vertices;
            if !vertices[..kind.vertex_count()].iter().any(|&v| state.is_movable(v as usize)) {
                return None;
            }
            let separation = separation(kind, p);
            // First the range that is not lowered for neighbors, which is cheaper: almost all pairs are
            // farther apart.
            let largest = self.range_share * scene.spacing().of(scene.model(), kind, pair).delta;
            if separation.distance >= largest {
                return None;
            }
            let range = self.range_share * scene.delta(kind, pair);
            let min_separation = candidates.min_separations[p].min(0.9 * range);
            let gap = separation.distance - min_separation;
            let jet = match form {
                BarrierForm::Paper => barrier(strength, gap, range - min_separation),
                BarrierForm::Ipc => squared_barrier(strength, separation.distance, range, min_separation),
            };
            let mollifier = match (form, kind) {
                (BarrierForm::Ipc, PairKind::EdgeEdge) => {
                    let of = |x: &[Point]| vertices.map(|v| x[v as usize]);
                    Mollifier::of_edges(&of(x), &of(scene.rest()))
                }
                _ => Mollifier::NONE,
            };
            (jet.value > 0.0).then_some(Contact { kind, vertices, separation, jet, mollifier })
        };
        (0..candidates.pairs.len()).into_par_iter().with_min_len(CHUNK).filter_map(contact).collect()
    }

    /// E at `x` [J], given the pairs within range there.
    pub fn value(
        &self,
        scene: &CollisionScene,
        state: &ResolveState,
        x: &[Point],
        contacts: &[Contact],
    ) -> f64 {
        let mut energy = 0.0;
        for v in (0..x.len()).filter(|&v| state.is_movable(v)) {
            energy += 0.5 * self.inertia(scene, state, v) * (x[v] - state.target[v]).norm_squared();
        }
        energy += contacts.iter().map(|contact| contact.mollifier.value * contact.jet.value).sum::<f64>();
        let stretched = |ball: &DistanceLimit| self.overlong(ball, x).map_or(0.0, |(over, _, _)| over * over);
        energy + 0.5 * self.params.edge_stiffness * self.edges.balls.iter().map(stretched).sum::<f64>()
    }

    /// Gradient at `x` and blocks, given the pairs within range there.
    ///
    /// A pair adds B'' g g^T with g the gradient of its distance, s_k beta_k n by vertex k. With weights that
    /// sum to 1 on either side, (sum_k beta_k n.u_k)^2 <= 2 sum_k beta_k (n.u_k)^2: blocks 2 B'' beta_k n n^T
    /// majorize it, beta_k against half-spaces. The rest, B' times the distance's own Hessian, is left out:
    /// it only lowers the energy where that is positive semidefinite, as for two vertices. So are the
    /// derivatives of mollifiers.
    pub fn derivatives(
        &self,
        scene: &CollisionScene,
        state: &ResolveState,
        x: &[Point],
        contacts: &[Contact],
        derivatives: &mut Derivatives,
    ) {
        let Derivatives { gradient, blocks } = derivatives;
        gradient.clear();
        blocks.clear();
        for v in 0..x.len() {
            let inertia = self.inertia(scene, state, v);
            gradient.push(inertia * (x[v] - state.target[v]));
            blocks.push(nalgebra::Matrix3::from_diagonal_element(inertia));
        }
        for contact in contacts {
            let (n, count) = (contact.separation.normal, contact.kind.vertex_count());
            let signed = contact.separation.signed_weights(contact.kind);
            let sides = if contact.kind == PairKind::VertexHalfSpace { 1.0 } else { 2.0 };
            let outer = n * n.transpose();
            let share = contact.mollifier.value;
            for k in 0..count {
                let v = contact.vertices[k] as usize;
                gradient[v] += share * contact.jet.slope * signed[k] * n;
                blocks[v] += share * sides * contact.jet.curvature * signed[k].abs() * outer;
            }
            if contact.mollifier.fades() {
                let turn = mollifier::gradient(&contact.vertices.map(|v| x[v as usize]));
                let scale = contact.mollifier.slope * contact.jet.value;
                for k in 0..count {
                    gradient[contact.vertices[k] as usize] += scale * turn.fixed_rows::<3>(3 * k);
                }
            }
        }
        for ball in &self.edges.balls {
            if let Some((over, _, direction)) = self.overlong(ball, x) {
                let k = self.params.edge_stiffness;
                let [a, b] = ball.vertices.map(|v| v as usize);
                gradient[a] += k * over * direction;
                gradient[b] -= k * over * direction;
                // |e| turns with its direction as well: (1 - L/|e|)(I - n n^T) + n n^T <= I.
                for v in [a, b] {
                    blocks[v] += nalgebra::Matrix3::from_diagonal_element(2.0 * k);
                }
            }
        }
        for v in (0..x.len()).filter(|&v| !state.is_movable(v)) {
            gradient[v] = Vector::zeros();
            blocks[v] = nalgebra::Matrix3::identity();
        }
    }

    /// The edges beyond their limits at `x`: how far [m], 1 - L/|e|, and the direction from the second vertex
    /// to the first.
    pub fn long_edges<'a>(
        &'a self,
        x: &'a [Point],
    ) -> impl Iterator<Item = ([u32; 2], f64, f64, Vector)> + 'a {
        self.edges.balls.iter().filter_map(|ball| {
            self.overlong(ball, x).map(|(over, share, direction)| (ball.vertices, over, share, direction))
        })
    }

    /// Largest ratio of an edge's length to its length at the start of the call, and to its rest length; 0
    /// where edges have no penalty.
    pub fn stretch(&self, x: &[Point]) -> (f64, f64) {
        let stretch = self.edges.stretch(x);
        (stretch.to_start, stretch.to_rest)
    }

    /// Largest range of any pair's barrier [m].
    pub fn largest_range(&self, scene: &CollisionScene) -> f64 {
        self.range_share * scene.spacing().largest_delta()
    }

    /// Fills in the statistics at the end of a call.
    pub(super) fn report(
        &self,
        scene: &CollisionScene,
        state: &ResolveState,
        derivatives: &mut Derivatives,
        statistics: &mut Statistics,
    ) {
        let contacts = self.contacts(scene, state);
        self.derivatives(scene, state, &state.x, &contacts, derivatives);
        let movable = (0..state.x.len()).filter(|&v| state.is_movable(v));
        statistics.stationarity_m = movable
            .map(|v| derivatives.gradient[v].norm() / self.inertia(scene, state, v))
            .fold(0.0, f64::max);
        (statistics.max_step_stretch, statistics.max_stretch) = self.stretch(&state.x);
    }

    fn overlong(&self, ball: &DistanceLimit, x: &[Point]) -> Option<(f64, f64, Vector)> {
        let [a, b] = ball.vertices;
        let edge = x[a as usize] - x[b as usize];
        let length = edge.norm();
        let over = length - ball.limit;
        (over > 0.0).then(|| (over, over / length, edge / length))
    }
}
