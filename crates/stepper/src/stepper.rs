//! The forward step (paper, Eq. 3, 18-20), with separating planes in place of the isotropic bound.
//!
//! For a pair with unit normal n and certified slab width w, side *a* may close at most a share of G = gamma
//! max(0, w - xi), where xi is the pair's minimum separation, and side *b* the rest. Each side then stays in
//! its own half-space. Half-spaces are convex, so no straight path of any vertex crosses, whatever the
//! speeds, and a smaller alpha is always safe too. The isotropic bound is the paper's: no vertex moves by
//! more than half of the smallest distance of its pairs.
//!
//! *Divide and Truncate* (Chen et al. 2026, arXiv 2604.15513) limits displacements by planes between near pairs
//! as well. Here the width of the slab is certified with rounding, both sides keep a minimum separation, and
//! a pair closer than rounding can resolve is frozen.

use crate::rounding::Rounding;
use crate::trust_regions::TrustRegions;
use bowknot_geometry::{PairKind, Point, Separation, Vector};
use bowknot_proximity::{CollisionModel, PairList};
use rayon::prelude::*;
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};

/// Smallest number of elements in one parallel task.
const CHUNK: usize = 2048;

/// The candidate pairs with their contact geometry at the current positions.
#[derive(Clone, Copy, Debug)]
pub struct Contacts<'a> {
    /// The pairs.
    pub pairs: &'a PairList,
    /// Contact geometry of each pair.
    pub separations: &'a [Separation],
    /// Minimum separation of each pair, xi [m]: no step makes its gap smaller.
    pub min_separations: &'a [f64],
}

/// What a step did.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StepReport {
    /// Largest remaining fraction r of any vertex [1].
    pub remaining_fraction: f64,
    /// Largest remaining distance |(1 - alpha) (y - x)| of any vertex [m].
    pub remaining: f64,
    /// The vertex with the largest remaining distance.
    pub slowest: Option<u32>,
    /// Largest |alpha (y - x)| [m].
    pub largest_move: f64,
    /// Largest remaining distance of a vertex that no pair holds back [m]. The caller knows which vertices
    /// these are; [`Stepper::advance`] leaves it 0, and the next one as well.
    pub unhindered: f64,
    /// Largest remaining distance of a prescribed vertex that no pair holds back [m]; [`Stepper::advance`] leaves
    /// it 0.
    pub unhindered_lag: f64,
}

/// Workspace of the forward step: wanted displacements, step sizes, remaining fractions. For solvers that
/// keep lists of pairs of their own; [`Forward`](crate::Forward) composes a search with these calls.
///
/// # Loose calls
/// Alone, none of these calls makes a step safe. [`Self::begin`], [`Self::set_target`], limits and
/// [`Self::advance`], in this order, are a safe step from positions without intersections if
/// - the list of pairs has every pair that could meet while each vertex stays in its ball, such as what a
///   search within the radii of the balls finds;
/// - all listed pairs limit the step, by [`Self::limit_by_planes`] or [`Self::limit_by_distances`], with
///   their separations at the positions that it starts from;
/// - [`Self::limit_by_trust_regions`], with the balls of that search, limits the step too (or, with one
///   distance for all pairs that are not listed, [`Self::limit_by_non_candidates`]);
/// - nothing but further limits follows before [`Self::advance`], which gets the same positions.
///
/// The others keep shapes ([`Self::limit_by_bodies`], [`Self::limit_by_groups`]) or choose lengths
/// ([`Self::cap_travel`], [`Self::limit_travel`]). [`Self::limit_by_moving_planes`] has conditions of its
/// own.
#[derive(Debug, Default)]
pub struct Stepper {
    /// d = y - x [m].
    displacements: Vec<Vector>,
    /// Bits of alpha. Nonnegative floats are ordered as their bits are, so an atomic minimum of bits is a
    /// minimum of the numbers, and it gives the same result in any order.
    alphas: Vec<AtomicU64>,
    /// Largest alpha of each vertex, whatever its pairs: planes are shared as if it went that far.
    caps: Vec<f64>,
    /// The paper's r of each vertex.
    remaining_fractions: Vec<f64>,
    /// Group of each vertex, [`Self::NO_GROUP`] for none. Empty: no groups.
    groups: Vec<u32>,
    /// Smallest step size of each obstacle or group, while they are limited.
    smallest: Vec<f64>,
    rounding: Option<Rounding>,
    /// Largest coordinate of positions and targets, at least twice the longest displacement [m].
    largest_coordinate: f64,
}

/// Where vertices are in a long step: along their paths, all at the same path time t in [0, 1], and not far
/// from there.
#[derive(Clone, Copy, Debug)]
pub struct Tubes<'a> {
    /// The path of each vertex [m].
    pub paths: &'a [Vector],
    /// How far each vertex may deviate from its path [m]. Empty: not at all.
    pub radii: &'a [f64],
}

impl Tubes<'_> {
    #[inline]
    fn radius(&self, vertex: u32) -> f64 {
        if self.radii.is_empty() { 0.0 } else { self.radii[vertex as usize] }
    }
}

impl Stepper {
    /// Group of a vertex that is in none.
    pub const NO_GROUP: u32 = u32::MAX;

    /// Starts a call: all remaining fractions are 1, and there are no groups.
    pub fn begin(&mut self, vertex_count: usize) {
        self.groups.clear();
        self.remaining_fractions.clear();
        self.remaining_fractions.resize(vertex_count, 1.0);
        self.alphas.clear();
        self.alphas.resize_with(vertex_count, || AtomicU64::new(1.0f64.to_bits()));
    }

    /// Sets the group of each vertex, one entry per vertex, [`Self::NO_GROUP`] for none. All vertices of a
    /// group move by the same fraction of their displacements, see [`Self::limit_by_groups`]; pairs within a
    /// group are then limited by their relative motion alone.
    pub fn set_groups(&mut self, groups: &[u32]) {
        self.groups.clear();
        self.groups.extend_from_slice(groups);
    }

    /// Starts a step from `positions` toward `target`. A vertex whose target is not finite does not move;
    /// returns the number of these vertices: all of them if there are fewer or more targets than positions. A
    /// call is begun here if [`Self::begin`] has not begun one for so many vertices.
    pub fn set_target(&mut self, positions: &[Point], target: &[Point]) -> usize {
        if positions.len() != target.len() {
            self.set_target(positions, positions);
            return positions.len();
        }
        if self.alphas.len() != positions.len() {
            self.begin(positions.len());
        }
        self.displacements.resize(positions.len(), Vector::zeros());
        self.caps.resize(positions.len(), 1.0);
        let vertices =
            (&mut self.displacements, &mut self.alphas, &mut self.caps, positions, target).into_par_iter();
        let set = |(d, alpha, cap, x, y): (&mut Vector, &mut AtomicU64, &mut f64, &Point, &Point)| {
            *alpha.get_mut() = 1.0f64.to_bits();
            *cap = 1.0;
            *d = y - x;
            if d.iter().all(|c| c.is_finite()) {
                return (x.coords.amax().max(y.coords.amax()).max(2.0 * d.norm()), 0);
            }
            *d = Vector::zeros();
            (x.coords.amax(), 1)
        };
        // A maximum and a count: the order does not matter.
        let (largest, not_finite) =
            vertices.with_min_len(CHUNK).map(set).reduce(|| (0.0f64, 0), |a, b| (a.0.max(b.0), a.1 + b.1));
        self.rounding = Some(Rounding::new(largest));
        self.largest_coordinate = largest;
        not_finite
    }

    /// Lets no vertex travel farther than `longest(vertex)` [m]. Call it before the pairs limit the step:
    /// they then share their gaps between the travels that remain. `obstacle_vertices` and the groups, of
    /// which there are `group_count`, still move as one, see [`Self::limit_by_bodies`].
    pub fn cap_travel(
        &mut self,
        model: &CollisionModel,
        obstacle_vertices: &[u32],
        group_count: usize,
        longest: impl Fn(usize) -> f64 + Sync,
    ) {
        let vertices = (0..self.displacements.len()).into_par_iter().with_min_len(CHUNK);
        vertices.for_each(|v| self.limit_travel(v, longest(v)));
        self.limit_by_bodies(model, obstacle_vertices);
        self.limit_by_groups(group_count);
        let caps = self.caps.par_iter_mut().zip(&mut self.alphas).with_min_len(CHUNK);
        caps.for_each(|(cap, alpha)| *cap = f64::from_bits(*alpha.get_mut()));
    }

    /// Lets a vertex travel by at most `longest` [m].
    #[inline]
    pub fn limit_travel(&self, vertex: usize, longest: f64) {
        self.limit_length(vertex, longest);
    }

    /// Largest step size of a vertex, whatever its pairs: 1, or what [`Self::cap_travel`] has left.
    #[inline]
    pub fn cap(&self, vertex: usize) -> f64 {
        self.caps[vertex]
    }

    /// Wanted displacements d = y - x of this step [m].
    pub fn displacements(&self) -> &[Vector] {
        &self.displacements
    }

    /// Step size alpha of a vertex as limited so far.
    #[inline]
    pub fn alpha(&self, vertex: usize) -> f64 {
        f64::from_bits(self.alphas[vertex].load(Ordering::Relaxed))
    }

    /// Lowers the step size of a vertex to at most `alpha`.
    #[inline]
    pub fn limit(&self, vertex: usize, alpha: f64) {
        // NaN becomes 0: its bits would compare as larger than those of every number, and the limit would be
        // lost.
        let alpha = if alpha >= 0.0 { alpha } else { 0.0 };
        let bits = alpha.to_bits();
        if self.alphas[vertex].load(Ordering::Relaxed) > bits {
            self.alphas[vertex].fetch_min(bits, Ordering::Relaxed);
        }
    }

    fn rounding(&self) -> Rounding {
        // Without a target nothing may move at all.
        self.rounding.unwrap_or(Rounding { step: f64::INFINITY, frozen: f64::INFINITY })
    }

    /// Limits the vertices of every pair by the pair's slab. Returns the number of frozen pairs: those for
    /// which no direction certifies a gap above rounding.
    ///
    /// Alone it does not make a step safe: vertices still pass through what the list does not have, see
    /// [`Self::limit_by_trust_regions`]. Separations must be those at the positions of the target's start.
    pub fn limit_by_planes(&self, contacts: &Contacts<'_>, damping: f64) -> usize {
        let frozen = AtomicUsize::new(0);
        for kind in PairKind::ALL {
            contacts.pairs.range(kind).into_par_iter().with_min_len(CHUNK).for_each(|p| {
                let vertices = &contacts.pairs.pairs()[p].vertices;
                let (separation, min_separation) = (&contacts.separations[p], contacts.min_separations[p]);
                if self.limit_by_plane(kind, vertices, separation, min_separation, damping) {
                    frozen.fetch_add(1, Ordering::Relaxed);
                }
            });
        }
        frozen.into_inner()
    }

    /// Limits the vertices of one pair by its slab, see [`Self::limit_by_planes`]. Returns whether the pair
    /// is frozen.
    #[inline]
    pub fn limit_by_plane(
        &self,
        kind: PairKind,
        vertices: &[u32; 4],
        separation: &Separation,
        min_separation: f64,
        damping: f64,
    ) -> bool {
        self.visit_plane_limits(kind, vertices, separation, min_separation, damping, |v, alpha| {
            self.limit(v, alpha);
        })
    }

    /// Calls `limit` with every vertex that the slab of a pair limits, and the step size that it allows; see
    /// [`Self::limit_by_planes`]. Returns whether the pair is frozen.
    #[inline]
    pub fn visit_plane_limits(
        &self,
        kind: PairKind,
        vertices: &[u32; 4],
        separation: &Separation,
        min_separation: f64,
        damping: f64,
        limit: impl FnMut(usize, f64),
    ) -> bool {
        let rounding = self.rounding();
        if separation.width <= rounding.frozen {
            return self.freeze(kind, vertices, limit);
        }
        let allowed = (damping * (separation.width - min_separation) - 2.0 * rounding.step).max(0.0);
        self.share_gap(kind, vertices, &separation.normal, allowed, limit);
        false
    }

    /// As [`Self::limit_by_planes`], for vertices that move in their `tubes`, all at the same path time.
    /// Alone it does not make a step safe: the list must have what could meet on these paths, and a vertex
    /// that the limits keep from staying in its tube makes the others' limits wrong. A pair whose slab stays
    /// open while it moves along is not limited, so that motion common to both sides is free.
    ///
    /// Let the slab move by t f. Side *a* closes it by at most t max over a of -n.(u_i - f) plus its tube,
    /// side *b* by at most t max over b of n.(u_j - f) plus its own. In the sum f cancels; the sum is linear
    /// in t, so it is largest at an end.
    pub fn limit_by_moving_planes(&self, contacts: &Contacts<'_>, tubes: &Tubes<'_>, damping: f64) -> usize {
        let frozen = AtomicUsize::new(0);
        for kind in PairKind::ALL {
            contacts.pairs.range(kind).into_par_iter().with_min_len(CHUNK).for_each(|p| {
                let vertices = &contacts.pairs.pairs()[p].vertices;
                let (separation, min_separation) = (&contacts.separations[p], contacts.min_separations[p]);
                if self.limit_by_moving_plane(kind, vertices, separation, min_separation, tubes, damping) {
                    frozen.fetch_add(1, Ordering::Relaxed);
                }
            });
        }
        frozen.into_inner()
    }

    /// Limits the vertices of one pair, see [`Self::limit_by_moving_planes`]. Returns whether the pair is
    /// frozen.
    #[inline]
    pub fn limit_by_moving_plane(
        &self,
        kind: PairKind,
        vertices: &[u32; 4],
        separation: &Separation,
        min_separation: f64,
        tubes: &Tubes<'_>,
        damping: f64,
    ) -> bool {
        !self.stays_open(kind, vertices, separation, min_separation, tubes, damping)
            && self.limit_by_plane(kind, vertices, separation, min_separation, damping)
    }

    /// Whether the slab of a pair stays open while it moves along with the vertices, see
    /// [`Self::limit_by_moving_planes`].
    #[inline]
    pub fn stays_open(
        &self,
        kind: PairKind,
        vertices: &[u32; 4],
        separation: &Separation,
        min_separation: f64,
        tubes: &Tubes<'_>,
        damping: f64,
    ) -> bool {
        let (count, side_a) = (kind.vertex_count(), kind.side_a());
        let side = |places: std::ops::Range<usize>, sign: f64| {
            let mut closing = f64::NEG_INFINITY;
            let mut radius = 0.0f64;
            for &v in &vertices[places] {
                closing = closing.max(sign * separation.normal.dot(&tubes.paths[v as usize]));
                radius = radius.max(tubes.radius(v));
            }
            (closing, radius)
        };
        let (closing_a, tube_a) = side(0..side_a, -1.0);
        // A half-space does not move.
        let (closing_b, tube_b) = if side_a < count { side(side_a..count, 1.0) } else { (0.0, 0.0) };
        let closing = (closing_a + closing_b).max(0.0) + tube_a + tube_b;
        let rounding = self.rounding();
        let allowed = damping * (separation.width - min_separation) - 2.0 * rounding.step;
        separation.width > rounding.frozen && closing <= allowed
    }

    /// Largest coordinate of positions and targets of this step, at least twice the longest displacement [m]:
    /// what the bounds of [`Rounding`] hold for.
    pub fn largest_coordinate(&self) -> f64 {
        self.largest_coordinate
    }

    /// Lets both sides of a pair together close its gap by at most `allowed` [m] along the unit normal `n`.
    #[inline]
    fn share_gap(
        &self,
        kind: PairKind,
        vertices: &[u32; 4],
        n: &Vector,
        allowed: f64,
        mut limit: impl FnMut(usize, f64),
    ) {
        let (count, side_a) = (kind.vertex_count(), kind.side_a());
        if let Some(&group) = self.groups.get(vertices[0] as usize)
            && group != Self::NO_GROUP
            && vertices[..count].iter().all(|&v| self.groups[v as usize] == group)
        {
            return self.limit_within_group(&vertices[..count], side_a, n, allowed, limit);
        }
        let mut closing = [0.0f64; 4];
        let mut speeds = [0.0f64; 2];
        for k in 0..count {
            let v = vertices[k] as usize;
            let along = n.dot(&self.displacements[v]) * self.caps[v];
            closing[k] = if k < side_a { -along } else { along };
            let side = usize::from(k >= side_a);
            speeds[side] = speeds[side].max(closing[k]);
        }
        let total = speeds[0] + speeds[1];
        if total <= allowed {
            return;
        }
        for k in 0..count {
            if closing[k] > 0.0 {
                let (v, share) = (vertices[k] as usize, speeds[usize::from(k >= side_a)] / total);
                limit(v, (allowed * share / closing[k]).min(1.0) * self.caps[v]);
            }
        }
    }

    /// Limits a pair whose vertices move by the same fraction. If the slab moves with the pair, only the
    /// difference of both sides' motion closes it, and that is linear in the fraction (see
    /// [`Self::limit_by_moving_planes`]). Common motion is free.
    fn limit_within_group(
        &self,
        vertices: &[u32],
        side_a: usize,
        n: &Vector,
        allowed: f64,
        mut limit: impl FnMut(usize, f64),
    ) {
        let largest = |side: &[u32], sign: f64| {
            let along = side.iter().map(|&v| sign * n.dot(&self.displacements[v as usize]));
            along.fold(f64::NEG_INFINITY, f64::max)
        };
        // A half-space does not move.
        let other = if side_a < vertices.len() { largest(&vertices[side_a..], 1.0) } else { 0.0 };
        let closing = largest(&vertices[..side_a], -1.0) + other;
        if closing > allowed {
            vertices.iter().for_each(|&v| limit(v as usize, allowed / closing));
        }
    }

    /// Stops all vertices of a pair. Returns whether any of them wanted to move.
    fn freeze(&self, kind: PairKind, vertices: &[u32; 4], mut limit: impl FnMut(usize, f64)) -> bool {
        let mut moving = false;
        for &v in &vertices[..kind.vertex_count()] {
            if self.displacements[v as usize] != Vector::zeros() {
                moving = true;
                limit(v as usize, 0.0);
            }
        }
        moving
    }

    /// Limits the vertices of every pair to half of the pair's certified distance, whatever the direction
    /// (paper, Eq. 18-20). Returns the number of frozen pairs. Alone it does not make a step safe, as
    /// [`Self::limit_by_planes`].
    pub fn limit_by_distances(&self, contacts: &Contacts<'_>, damping: f64) -> usize {
        let rounding = self.rounding();
        let frozen = AtomicUsize::new(0);
        for kind in PairKind::ALL {
            contacts.pairs.range(kind).into_par_iter().with_min_len(CHUNK).for_each(|p| {
                let vertices = &contacts.pairs.pairs()[p].vertices;
                let width = contacts.separations[p].width;
                if width <= rounding.touching() {
                    if self.freeze(kind, vertices, |v, alpha| self.limit(v, alpha)) {
                        frozen.fetch_add(1, Ordering::Relaxed);
                    }
                    return;
                }
                let room = (0.5 * damping * (width - contacts.min_separations[p]) - rounding.step).max(0.0);
                vertices[..kind.vertex_count()].iter().for_each(|&v| self.limit_length(v as usize, room));
            });
        }
        frozen.into_inner()
    }

    /// Limits the move of every vertex to half of `distance` [m], a lower bound of the distances of all pairs
    /// that are no candidates: the paper's D^(l). It limits none of the candidates, and the distance is that
    /// of the search less what vertices have moved since.
    pub fn limit_by_non_candidates(&self, distance: f64, damping: f64) {
        let room = (0.5 * damping * distance - self.rounding().step).max(0.0);
        (0..self.displacements.len())
            .into_par_iter()
            .with_min_len(CHUNK)
            .for_each(|v| self.limit_length(v, room));
    }

    #[inline]
    fn limit_length(&self, vertex: usize, room: f64) {
        let length = self.displacements[vertex].norm();
        if length > room {
            self.limit(vertex, (room / length).min(1.0));
        }
    }

    /// Keeps every vertex in its trust region. Returns whether a trust region, rather than a pair or a cap,
    /// limits some vertex: then the pairs should be searched again.
    ///
    /// It makes the list complete of which the trust regions are, and limits none of its pairs. Over many
    /// steps with one list, roundings of positions may add up to more than the margin of the search.
    pub fn limit_by_trust_regions(&self, positions: &[Point], trust_regions: &TrustRegions) -> bool {
        (0..positions.len())
            .into_par_iter()
            .with_min_len(CHUNK)
            .map(|v| {
                let alpha = trust_regions.limit(v, &positions[v], &self.displacements[v]);
                let limited = alpha < self.alpha(v);
                self.limit(v, alpha);
                limited
            })
            .reduce(|| false, |a, b| a | b)
    }

    /// Makes every obstacle move as one: all its vertices take the smallest step size among them. Returns
    /// the smallest step size of all obstacles. It keeps their shapes and guards against nothing.
    pub fn limit_by_bodies(&mut self, model: &CollisionModel, obstacle_vertices: &[u32]) -> f64 {
        if obstacle_vertices.is_empty() {
            return 1.0;
        }
        let mut smallest = std::mem::take(&mut self.smallest);
        smallest.clear();
        smallest.resize(model.bodies().len(), 1.0);
        for &v in obstacle_vertices {
            let body = model.vertex_body()[v as usize] as usize;
            smallest[body] = smallest[body].min(self.alpha(v as usize));
        }
        for &v in obstacle_vertices {
            self.limit(v as usize, smallest[model.vertex_body()[v as usize] as usize]);
        }
        let of_all = smallest.iter().copied().fold(1.0, f64::min);
        self.smallest = smallest;
        of_all
    }

    /// Makes every group move as one, as [`Self::limit_by_bodies`] does with obstacles. `group_count` is one
    /// more than the largest group.
    pub fn limit_by_groups(&mut self, group_count: usize) {
        if self.groups.is_empty() || group_count == 0 {
            return;
        }
        let mut smallest = std::mem::take(&mut self.smallest);
        smallest.clear();
        smallest.resize(group_count, 1.0);
        let members = || (0..self.groups.len()).filter(|&v| self.groups[v] != Self::NO_GROUP);
        for v in members() {
            let alpha = &mut smallest[self.groups[v] as usize];
            *alpha = alpha.min(self.alpha(v));
        }
        members().for_each(|v| self.limit(v, smallest[self.groups[v] as usize]));
        self.smallest = smallest;
    }

    /// Takes the step x <- x + alpha d. The result is y up to rounding where alpha = 1, and exactly x where
    /// alpha = 0. It is as safe as the limits that were set: without any, it goes to the target. Vertices that
    /// have no target stay where they are.
    pub fn advance(&mut self, positions: &mut [Point]) -> StepReport {
        let chunks = (
            self.alphas.par_chunks_mut(CHUNK),
            self.displacements.par_chunks(CHUNK),
            self.remaining_fractions.par_chunks_mut(CHUNK),
            positions.par_chunks_mut(CHUNK),
        );
        let advance = |(chunk, (alphas, displacements, fractions, positions)): (usize, _)| {
            advance_chunk(chunk * CHUNK, alphas, displacements, fractions, positions)
        };
        chunks.into_par_iter().enumerate().map(advance).reduce(StepReport::default, join)
    }

    /// Remaining fraction r of each vertex: the product of (1 - alpha) over the steps of a call (paper, Eq.
    /// 20).
    pub fn remaining_fractions(&self) -> &[f64] {
        &self.remaining_fractions
    }
}

/// Takes the step of the vertices from `first` on.
fn advance_chunk(
    first: usize,
    alphas: &mut [AtomicU64],
    displacements: &[Vector],
    remaining_fractions: &mut [f64],
    positions: &mut [Point],
) -> StepReport {
    let mut report = StepReport::default();
    for k in 0..positions.len().min(alphas.len()).min(displacements.len()) {
        let alpha = f64::from_bits(*alphas[k].get_mut());
        let d = displacements[k];
        if alpha > 0.0 {
            positions[k] += alpha * d;
        }
        remaining_fractions[k] *= 1.0 - alpha;
        let length = d.norm();
        let remaining = (1.0 - alpha) * length;
        report.remaining_fraction = report.remaining_fraction.max(remaining_fractions[k]);
        report.largest_move = report.largest_move.max(alpha * length);
        if remaining > report.remaining {
            report.remaining = remaining;
            report.slowest = Some((first + k) as u32);
        }
    }
    report
}

/// The report of two ranges of vertices, of which `a` is the first. Of equally slow vertices the first
/// counts.
fn join(a: StepReport, b: StepReport) -> StepReport {
    let slowest = if b.remaining > a.remaining { b } else { a };
    StepReport {
        remaining_fraction: a.remaining_fraction.max(b.remaining_fraction),
        largest_move: a.largest_move.max(b.largest_move),
        ..slowest
    }
}
