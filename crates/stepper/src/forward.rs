//! The forward step with everything that makes it safe.

use crate::error::ForwardError;
use crate::params::Bound;
use crate::rounding::Rounding;
use crate::stepper::{Contacts, Stepper};
use crate::trust_regions::TrustRegions;
use bowknot_errors::{Checks, Parameters};
use bowknot_geometry::{HalfSpace, PairKind, Point, Separation, Topology};
use bowknot_proximity::{CollisionModel, PairList, ProximitySearch, separate_all};
use rayon::prelude::*;

/// Smallest number of vertices or pairs in one parallel task.
const CHUNK: usize = 2048;

/// Largest coordinate, radius and minimum separation [m]. The search leaves out vertices beyond 1e15 m of its
/// origin.
const LARGEST: f64 = 1e14;
/// Smallest radius but 0, and smallest size of a scene in which roundings are bounded [m]: squares of
/// distances like these are far from underflow.
const SMALLEST: f64 = 1e-100;

/// Share of its radius beyond which a vertex does not move until the next search. Steps stay within a little
/// less of it ([`TrustRegions::limit`]), but for the rounding of a position. Over many steps these roundings
/// could add up.
const SPENT: f64 = 1.0 - 5e-4;

/// Largest deviation of the length of a half-space's normal from 1.
const NORMAL_TOLERANCE: f64 = 1e-6;

/// Settings of [`Forward`].
#[derive(Clone, Debug, PartialEq)]
pub struct ForwardOptions {
    /// The bound that limits the vertices of listed pairs. Default planes.
    pub bound: Bound,
    /// Share of a pair's gap that one step may use up, the paper's gamma: above 0, at most 0.99. Default 0.9.
    pub damping: f64,
    /// Minimum separation xi [m]: no step makes the gap of a pair smaller than it, but for rounding. Pairs
    /// that start nearer can only open. At least 32 units in the last place of the largest coordinate are
    /// kept (96 with the isotropic bound): pairs nearer than 9 (64) are frozen. Default 0.
    pub min_separation: f64,
}

impl Default for ForwardOptions {
    fn default() -> Self {
        Self { bound: Bound::Planes, damping: 0.9, min_separation: 0.0 }
    }
}

impl Parameters for ForwardOptions {
    fn check(&self, checks: &mut Checks) {
        let Self { bound: _, damping, min_separation } = *self;
        // Closer to 1, what a step leaves of a gap is of the size of the rounding of its share.
        checks.require(damping > 0.0 && damping <= 0.99, "damping", damping, "must be above 0, at most 0.99");
        let fits = (0.0..=LARGEST).contains(&min_separation);
        checks.require(fits, "min_separation", min_separation, format_args!("must be 0 to {LARGEST:e}"));
    }
}

/// What a step of [`Forward`] did.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ForwardReport {
    /// Largest remaining distance of a vertex to its target [m].
    pub remaining: f64,
    /// The vertex with the largest remaining distance; none if all have arrived.
    pub slowest: Option<u32>,
    /// Largest distance that a vertex has moved [m].
    pub largest_move: f64,
    /// Whether some vertex can go no farther before the next [`Forward::search`]: its trust region limits it.
    pub search_due: bool,
    /// Number of pairs that touch, so that their vertices do not move although they want to.
    pub frozen_pairs: usize,
    /// Number of vertices that do not move because their targets are not finite, or too far for floating
    /// point (about 1e154 m).
    pub not_finite: usize,
}

/// Moves the vertices of a model toward targets, each as far as is certainly safe: search, separating slabs,
/// trust regions, and steps, composed.
///
/// ```
/// use bowknot_stepper::geometry::{Point, Topology};
/// use bowknot_stepper::proximity::CollisionModel;
/// use bowknot_stepper::{Forward, ForwardOptions};
///
/// // Two triangles, the upper one of which is asked to go through the lower one and far beyond.
/// let corners = |z| [Point::new(0.0, 0.0, z), Point::new(1.0, 0.0, z), Point::new(0.0, 1.0, z)];
/// let start = [corners(0.0), corners(0.5)].concat();
/// let target = [corners(0.0), corners(-1e9)].concat();
/// let model = CollisionModel::single_body(Topology::builder(6).triangles([[0, 1, 2], [3, 4, 5]]).build()?);
///
/// let radii = [0.2; 6]; // how far a vertex may go before the next search [m]
/// let mut forward = Forward::new(model, start, &radii, ForwardOptions::default())?;
/// for _ in 0..40 {
///     let report = forward.advance(&target)?;
///     if report.search_due {
///         forward.search(&radii)?;
///     }
/// }
/// let height = forward.positions()[3].z;
/// assert!(0.0 < height && height < 1e-9, "the triangle has come near, and is not through: {height}");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # What is guaranteed
/// Let the start, given to [`Self::new`] or [`Self::restart`], be free of intersections. Then all positions
/// that [`Self::advance`] reaches are, and so are the straight paths between them, whatever the targets,
/// radii and minimum separations, and however many steps are made between two searches. The start is not
/// judged here (`bowknot-check` can). Surfaces that intersect at the start may pass through each other
/// further; pairs that touch there are frozen: their vertices do not move at all, not even apart.
///
/// Not covered are pairs that the model excludes: of primitives that share a vertex, of two obstacles, and of
/// bodies whose filters exclude each other.
///
/// # Why
/// Primitives come to intersect only if a pair meets of a kind that the search lists ([`PairKind`]). Such a
/// pair is listed or not.
/// - **Listed:** it stays on two sides of a slab. Its certified width is computed at the present positions
///   before each step, and both sides together use up a share below 1 of it, rounding included
///   ([`Stepper::limit_by_planes`]; with [`Bound::Isotropic`] the paper's Eq. 18-20,
///   [`Stepper::limit_by_distances`]).
/// - **Not listed:** a certified lower bound of its distance exceeded (rho_a + m) + (rho_b + m) when it was
///   searched for, where rho is the largest radius of the vertices of a side. Since then no vertex has left
///   the ball of its radius about the place where it was ([`TrustRegions`]). A point of a primitive is a
///   convex combination of its vertices, so it has moved by at most rho. What remains exceeds 2 m. The margin
///   m is half of the minimum separation and 4 units in the last place of the largest coordinate. A position
///   is off by at most 1.3 such units through rounding, and a vertex that has left 0.9995 of its ball does
///   not move until the next search, so that no more roundings add up.
///
/// Neither part is safe without the other: a vertex that leaves its ball meets pairs that nothing limits.
///
/// # Why it cannot be misused
/// One object has the positions, the list, and the balls for which the list is complete. Only this type
/// changes them: a search makes all of them together, and there is no state without a list. The loose calls
/// of [`Stepper`] leave this to the caller.
#[derive(Debug)]
pub struct Forward {
    model: CollisionModel,
    options: ForwardOptions,
    obstacle_vertices: Vec<u32>,
    search: ProximitySearch,
    stepper: Stepper,
    positions: Vec<Point>,
    /// For which the pairs are complete.
    trust_regions: TrustRegions,
    pairs: PairList,
    /// Contact geometry of the pairs at `positions` if `separated`, else where the last step began.
    separations: Vec<Separation>,
    separated: bool,
    min_separations: Vec<f64>,
    /// Radii of the search: those of the trust regions and the margin [m].
    search_radii: Vec<f64>,
    /// Shares of the way to the target that steps look at, and where they end [m].
    shares: Vec<f64>,
    ends: Vec<Point>,
}

impl Forward {
    /// Begins at `positions` [m], one per vertex of the model, which are free of intersections, and searches:
    /// see [`Self::search`] for the `radii`.
    ///
    /// # Errors
    /// Options out of range; a wrong number of entries; positions that are not finite or beyond 1e14 m; radii
    /// that are negative, not finite or beyond 1e14 m; a topology that is not as its builder makes it; a
    /// half-space without a unit normal.
    pub fn new(
        model: CollisionModel,
        positions: Vec<Point>,
        radii: &[f64],
        options: ForwardOptions,
    ) -> Result<Self, ForwardError> {
        options.validate().map_err(ForwardError::Options)?;
        check_model(&model)?;
        check_positions(&model, &positions)?;
        check_radii(&model, radii)?;
        let vertices = 0..positions.len() as u32;
        let mut stepper = Stepper::default();
        stepper.begin(positions.len());
        let mut forward = Self {
            obstacle_vertices: vertices.filter(|&v| model.is_obstacle(v)).collect(),
            search: ProximitySearch::new(&model),
            model,
            options,
            stepper,
            positions,
            trust_regions: TrustRegions::default(),
            pairs: PairList::default(),
            separations: Vec::new(),
            separated: false,
            min_separations: Vec::new(),
            search_radii: Vec::new(),
            shares: Vec::new(),
            ends: Vec::new(),
        };
        forward.list(radii);
        Ok(forward)
    }

    /// Lists the pairs anew, around the present positions: every pair that could meet while each vertex v
    /// moves by at most `radii[v]` [m]. Larger radii mean fewer searches and more pairs. A vertex with radius
    /// 0 does not move, whatever its target: obstacles that move need radii too.
    ///
    /// All minimum separations are those of the options again.
    ///
    /// # Errors
    /// As [`Self::new`] for the radii; positions that have got beyond 1e14 m. Nothing is changed then: the
    /// list that there was still holds.
    pub fn search(&mut self, radii: &[f64]) -> Result<(), ForwardError> {
        check_positions(&self.model, &self.positions)?;
        check_radii(&self.model, radii)?;
        self.list(radii);
        Ok(())
    }

    /// Begins anew at other positions [m], which are free of intersections, with the same model and options.
    ///
    /// # Errors
    /// As [`Self::new`] for positions and radii. Nothing is changed then.
    pub fn restart(&mut self, positions: &[Point], radii: &[f64]) -> Result<(), ForwardError> {
        check_positions(&self.model, positions)?;
        check_radii(&self.model, radii)?;
        self.positions.copy_from_slice(positions);
        self.list(radii);
        Ok(())
    }

    /// Makes one step toward `target` [m], one entry per vertex. A step goes no farther than the trust
    /// regions and uses up no more than a share of each gap: repeat it, with or without new searches.
    ///
    /// All vertices of an obstacle move by the same fraction of their displacements. A vertex whose target is
    /// not finite does not move, nor does the obstacle that it belongs to.
    ///
    /// # Errors
    /// Another number of targets than of vertices; a minimum separation that is negative or not a number.
    /// Nothing has moved then.
    pub fn advance(&mut self, target: &[Point]) -> Result<ForwardReport, ForwardError> {
        check_length("targets", target.len(), &self.model)?;
        if let Some(pair) = self.min_separations.iter().position(|xi| !(0.0..).contains(xi)) {
            return Err(ForwardError::MinSeparation { pair, min_separation: self.min_separations[pair] });
        }
        self.separate();
        let (not_finite, is_shortened) = self.shorten(target);

        let Self { model, options, stepper, positions, trust_regions, ends, .. } = self;
        stepper.set_target(positions, ends);
        let contacts = Contacts {
            pairs: &self.pairs,
            separations: &self.separations,
            min_separations: &self.min_separations,
        };
        let frozen_pairs = match options.bound {
            Bound::Planes => stepper.limit_by_planes(&contacts, options.damping),
            Bound::Isotropic => stepper.limit_by_distances(&contacts, options.damping),
        };
        let is_spent = stop_spent(stepper, positions, trust_regions);
        let is_limited = stepper.limit_by_trust_regions(positions, trust_regions);
        stepper.limit_by_bodies(model, &self.obstacle_vertices);
        let step = stepper.advance(positions);
        self.separated = false;

        let (remaining, slowest) = self.farthest(target);
        Ok(ForwardReport {
            remaining,
            slowest,
            largest_move: step.largest_move,
            search_due: is_spent || is_limited || is_shortened,
            frozen_pairs,
            not_finite,
        })
    }

    /// The model.
    pub fn model(&self) -> &CollisionModel {
        &self.model
    }

    /// Where the vertices are [m].
    pub fn positions(&self) -> &[Point] {
        &self.positions
    }

    /// The balls that the vertices stay in until the next search.
    pub fn trust_regions(&self) -> &TrustRegions {
        &self.trust_regions
    }

    /// The listed pairs, with their contact geometry at the present positions and their minimum separations:
    /// what constraints and contact forces are built from. Forces that act up to a gap need a list of all pairs
    /// within it: search again before, with radii whose sum over both sides is at least the gap.
    pub fn contacts(&mut self) -> Contacts<'_> {
        self.separate();
        let Self { pairs, separations, min_separations, .. } = self;
        Contacts { pairs, separations, min_separations }
    }

    /// The minimum separation of each listed pair [m], to be changed until the next search, such as for thick
    /// bodies: at least 0. Pairs that are not listed keep that of the options.
    pub fn min_separations_mut(&mut self) -> &mut [f64] {
        &mut self.min_separations
    }

    /// The model and the positions [m].
    pub fn into_parts(self) -> (CollisionModel, Vec<Point>) {
        (self.model, self.positions)
    }

    /// Lists the pairs for trust regions of these radii about the present positions.
    fn list(&mut self, radii: &[f64]) {
        self.trust_regions.centers.clone_from(&self.positions);
        self.trust_regions.radii.clear();
        self.trust_regions.radii.extend_from_slice(radii);
        let largest = |numbers: &mut dyn Iterator<Item = f64>| numbers.fold(SMALLEST, f64::max);
        let farthest = largest(&mut self.positions.iter().map(|x| x.coords.amax()));
        // Until the next search vertices are within one radius of the centers, and the ends that steps look
        // at within two of the vertices (`shorten`). Twice a way counts as a coordinate.
        let coordinate = farthest + 4.0 * largest(&mut radii.iter().copied());
        // Above what freezes a pair, by what rounding may take off its certified width: 10 units of a
        // difference of coordinates.
        let smallest = match self.options.bound {
            Bound::Planes => 2.0 * Rounding::smallest_min_separation(coordinate),
            Bound::Isotropic => 1.5 * Rounding::new(coordinate).touching(),
        };
        let min_separation = self.options.min_separation.max(smallest);
        let margin = 0.5 * min_separation + Rounding::new(coordinate).step;
        self.search_radii.clear();
        self.search_radii.extend(radii.iter().map(|radius| radius + margin));
        let Self { search, model, positions, search_radii, pairs, separations, .. } = self;
        search.search(model, positions, search_radii, pairs, separations);
        self.separated = true;
        self.min_separations.clear();
        self.min_separations.resize(self.pairs.len(), min_separation);
    }

    /// Makes the contact geometry that of the present positions.
    fn separate(&mut self) {
        if std::mem::replace(&mut self.separated, true) {
            return;
        }
        let Self { model, pairs, separations, positions, .. } = self;
        for kind in PairKind::ALL {
            let range = pairs.range(kind);
            let of_kind = pairs.pairs()[range.clone()].par_chunks(CHUNK);
            let separations = separations[range].par_chunks_mut(CHUNK);
            of_kind.zip(separations).for_each(|(pairs, separations)| {
                separate_all(model, kind, pairs, positions, separations);
            });
        }
    }

    /// Sets `ends`: the target, or where a vertex is on the way there after twice its radius. No step goes
    /// farther, and rounding counts in units of the largest coordinate: a target on the moon would freeze
    /// what is a micrometer apart. The vertices of an obstacle go the same share of their ways. Returns how
    /// many vertices do not go anywhere because their targets are not finite, and whether any way is
    /// shortened.
    fn shorten(&mut self, target: &[Point]) -> (usize, bool) {
        let Self { positions, shares, ends, trust_regions, .. } = self;
        let share = |(x, y, &radius): (&Point, &Point, &f64)| {
            let (length, longest) = ((y - x).norm(), 2.0 * radius);
            match length {
                _ if length <= longest => 1.0,
                _ if length < f64::INFINITY => longest / length,
                _ => f64::NAN,
            }
        };
        let ways = (&*positions, target, &trust_regions.radii).into_par_iter().with_min_len(CHUNK);
        ways.map(share).collect_into_vec(shares);
        let not_finite = shares.iter().filter(|share| share.is_nan()).count();
        let is_shortened = shares.iter().any(|&share| share < 1.0);

        // NaN, and with it an obstacle of which a target is not finite, becomes 0.
        let number = |share: f64| if share.is_nan() { 0.0 } else { share };
        let mut of_bodies = vec![1.0f64; self.model.bodies().len()];
        let bodies = self.model.vertex_body();
        for &v in &self.obstacle_vertices {
            let of_body = &mut of_bodies[bodies[v as usize] as usize];
            *of_body = of_body.min(number(shares[v as usize]));
        }
        self.obstacle_vertices
            .iter()
            .for_each(|&v| shares[v as usize] = of_bodies[bodies[v as usize] as usize]);

        let end = |(x, y, &share): (&Point, &Point, &f64)| match number(share) {
            1.0 => *y,
            0.0 => *x,
            share => x + share * (y - x),
        };
        let ways = (&*positions, target, &*shares).into_par_iter().with_min_len(CHUNK);
        ways.map(end).collect_into_vec(ends);
        (not_finite, is_shortened)
    }

    /// The largest distance of a vertex to its target [m], and the first vertex that has it. Targets that are
    /// not finite do not count.
    fn farthest(&self, target: &[Point]) -> (f64, Option<u32>) {
        let distances = self.positions.iter().zip(target).map(|(x, y)| (y - x).norm());
        let finite = distances.zip(0..).filter(|(distance, _)| distance.is_finite());
        finite.fold(
            (0.0, None),
            |best, (distance, v)| if distance > best.0 { (distance, Some(v)) } else { best },
        )
    }
}

/// Stops vertices that are so near the borders of their trust regions that rounding could take them out.
/// Returns whether there are any that want to move.
fn stop_spent(stepper: &Stepper, positions: &[Point], trust_regions: &TrustRegions) -> bool {
    let TrustRegions { centers, radii } = trust_regions;
    let is_spent = |(v, ((x, center), radius)): (usize, ((&Point, &Point), &f64))| {
        let usable = SPENT * radius;
        let is_spent =
            (x - center).norm_squared() > usable * usable && stepper.displacements()[v].amax() > 0.0;
        if is_spent {
            stepper.limit(v, 0.0);
        }
        is_spent
    };
    let vertices = positions.par_iter().zip(centers).zip(radii).enumerate().with_min_len(CHUNK);
    vertices.map(is_spent).reduce(|| false, |a, b| a | b)
}

fn check_length(what: &'static str, given: usize, model: &CollisionModel) -> Result<(), ForwardError> {
    let vertices = model.topology().vertex_count;
    if given == vertices { Ok(()) } else { Err(ForwardError::Length { what, given, vertices }) }
}

/// Refuses what the search would leave out.
fn check_model(model: &CollisionModel) -> Result<(), ForwardError> {
    let topology = model.topology();
    let edge = |&e: &u32| topology.edges.get(e as usize).copied();
    let strands: Option<Vec<_>> = topology.strand_edges.iter().map(edge).collect();
    let rebuilt = Topology::builder(topology.vertex_count)
        .triangles(topology.triangles.iter().copied())
        .strand_edges(strands.ok_or(ForwardError::Topology)?)
        .particles(topology.particles.iter().copied())
        .build();
    if rebuilt.as_ref().ok() != Some(topology) {
        return Err(ForwardError::Topology);
    }
    let is_sound = |half_space: &HalfSpace| {
        (half_space.normal.norm() - 1.0).abs() <= NORMAL_TOLERANCE && half_space.offset < f64::INFINITY
    };
    match model.half_spaces().iter().position(|half_space| !is_sound(half_space)) {
        Some(half_space) => Err(ForwardError::HalfSpace { half_space }),
        None => Ok(()),
    }
}

fn check_positions(model: &CollisionModel, positions: &[Point]) -> Result<(), ForwardError> {
    check_length("positions", positions.len(), model)?;
    let is_sound = |x: &Point| x.iter().all(|c| c.abs() <= LARGEST);
    match positions.iter().position(|x| !is_sound(x)) {
        Some(vertex) => Err(ForwardError::Position { vertex, position: positions[vertex].coords.into() }),
        None => Ok(()),
    }
}

fn check_radii(model: &CollisionModel, radii: &[f64]) -> Result<(), ForwardError> {
    check_length("radii", radii.len(), model)?;
    let is_sound = |radius: f64| radius == 0.0 || (SMALLEST..=LARGEST).contains(&radius);
    match radii.iter().position(|&radius| !is_sound(radius)) {
        Some(vertex) => Err(ForwardError::Radius { vertex, radius: radii[vertex] }),
        None => Ok(()),
    }
}
