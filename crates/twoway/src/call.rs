//! What is given for one call, checked.

use crate::error::ResolveError;
use crate::groups::Groups;
use crate::input::ResolveInput;
use crate::multipliers::PairMultipliers;
use crate::scene::CollisionScene;
use crate::validation::{check_finite, check_length, largest_coordinate};
use bowknot_constraints::FrictionModel;
use bowknot_geometry::{PairKind, Point};
use bowknot_lcp::DistanceLimit;
use bowknot_stepper::Rounding;

/// The input of one call, checked against the scene.
#[derive(Clone, Debug, Default)]
pub struct CallInput {
    prescribed: Vec<bool>,
    groups: Groups,
    time_step: Option<f64>,
    slip_start: Vec<Point>,
    known: Vec<bool>,
    carried: Vec<PairMultipliers>,
    yielding: Vec<DistanceLimit>,
    has_unknown: bool,
}

impl CallInput {
    /// Checks the input of a call that starts at `positions` toward `target`.
    ///
    /// # Errors
    /// Wrong lengths, non-finite numbers, a time step that is not above 0, and coordinates too large for the
    /// minimum separation.
    pub fn new(
        scene: &CollisionScene,
        positions: &[Point],
        target: &[Point],
        input: &ResolveInput<'_>,
    ) -> Result<Self, ResolveError> {
        let (model, vertices) = (scene.model(), scene.vertex_count());
        check_length("positions", positions.len(), vertices)?;
        check_length("target", target.len(), vertices)?;
        for (what, given) in [
            ("prescribed", input.prescribed.len()),
            ("groups", input.groups.len()),
            ("known", input.known.len()),
        ] {
            if given != 0 {
                check_length(what, given, vertices)?;
            }
        }
        if let Some(start) = input.start {
            check_length("start", start.len(), vertices)?;
            check_finite("the start", model, start)?;
        }
        if let Some(dt) = input.time_step.filter(|dt| !(dt.is_finite() && *dt > 0.0)) {
            return Err(ResolveError::TimeStep(dt));
        }
        check_finite("the position", model, positions)?;
        check_finite("the target", model, target)?;
        check_min_separation(scene, positions, target)?;

        let is_obstacle = |v: usize| model.is_obstacle(v as u32);
        let is_given = |v: usize| input.prescribed.get(v).copied().unwrap_or(false);
        let prescribed: Vec<bool> = (0..vertices).map(|v| is_obstacle(v) || is_given(v)).collect();
        let has_unknown =
            input.known.iter().zip(&prescribed).any(|(known, prescribed)| !known && !prescribed);
        let has_friction = scene.friction_model() != FrictionModel::None;
        let mut carried: Vec<PairMultipliers> =
            input.carried.iter().filter(|pair| pair.is_finite()).copied().collect();
        carried.sort_unstable_by_key(|pair| (pair.kind, pair.elements));
        let slip_start = if has_friction { input.start.unwrap_or(positions).to_vec() } else { Vec::new() };
        Ok(Self {
            groups: Groups::new(input.groups, &prescribed, is_obstacle),
            prescribed,
            time_step: input.time_step,
            slip_start,
            known: input.known.to_vec(),
            has_unknown,
            carried,
            yielding: input.yielding.iter().filter(|edge| edge.limit.is_finite()).copied().collect(),
        })
    }

    /// Which vertices are prescribed, obstacles included; one entry per vertex.
    pub fn prescribed(&self) -> &[bool] {
        &self.prescribed
    }

    /// Whether a vertex is prescribed.
    #[inline]
    pub fn is_prescribed(&self, vertex: usize) -> bool {
        self.prescribed[vertex]
    }

    /// Whether the method may move a vertex away from its target.
    #[inline]
    pub fn is_movable(&self, vertex: usize) -> bool {
        !self.prescribed[vertex]
    }

    /// Groups of pinned vertices that move together.
    pub fn groups(&self) -> &Groups {
        &self.groups
    }

    /// Whether the target knows contacts, but not those of some vertices that move: rows alone hold these.
    pub fn has_unknown(&self) -> bool {
        self.has_unknown
    }

    /// What pairs carry at the start, ascending by kind and elements.
    pub fn all_carried(&self) -> &[PairMultipliers] {
        &self.carried
    }

    /// What a pair carries at the start.
    pub fn carried(&self, kind: PairKind, elements: [u32; 2]) -> Option<&PairMultipliers> {
        let place = self.carried.binary_search_by_key(&(kind, elements), |pair| (pair.kind, pair.elements));
        place.ok().map(|place| &self.carried[place])
    }

    /// Edges that may be longer than their stretch limits, and how long [m].
    pub fn yielding(&self) -> &[DistanceLimit] {
        &self.yielding
    }

    /// Vertices whose contacts the target knows, one entry per vertex; empty: none.
    pub fn known(&self) -> &[bool] {
        &self.known
    }

    /// Whether the target knows the contacts of a vertex.
    #[inline]
    pub fn is_known(&self, vertex: usize) -> bool {
        self.known.get(vertex).copied().unwrap_or(false)
    }

    /// Time step that the call stands for [s].
    pub fn time_step(&self) -> Option<f64> {
        self.time_step
    }

    /// Positions at the start of the time step, from which friction measures slip [m]. Empty without
    /// friction.
    pub fn slip_start(&self) -> &[Point] {
        &self.slip_start
    }
}

/// Refuses coordinates so large that the smallest minimum separation of any pair is below their rounding.
pub(crate) fn check_min_separation(
    scene: &CollisionScene,
    positions: &[Point],
    target: &[Point],
) -> Result<(), ResolveError> {
    let thicknesses = scene.contact().bodies().iter().filter_map(|b| b.thickness).filter(|t| *t > 0.0);
    let of_scene = scene.lengths().min_separation;
    let smallest = thicknesses.fold(if of_scene > 0.0 { of_scene } else { f64::INFINITY }, f64::min);
    let min_separation = if smallest.is_finite() { smallest } else { 0.0 };
    let [of_start, of_target] = [positions, target].map(largest_coordinate);
    let (what, x, coordinate) = if of_target > of_start {
        ("the target", target, of_target)
    } else {
        ("the position", positions, of_start)
    };
    let needed = Rounding::smallest_min_separation(coordinate);
    if min_separation > 0.0 && min_separation < needed {
        let vertex = x.iter().position(|p| p.coords.amax() == coordinate).unwrap_or(0);
        return Err(ResolveError::MinSeparationBelowRounding {
            min_separation,
            what,
            coordinate,
            vertex,
            needed,
        });
    }
    Ok(())
}
