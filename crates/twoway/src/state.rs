//! What moves during a call.

use crate::call::CallInput;
use crate::error::ResolveError;
use crate::multipliers::PairMultipliers;
use crate::scene::CollisionScene;
use crate::validation::check_rows;
use bowknot_geometry::{PairKind, Point, Separation, Vector};
use bowknot_proximity::PairList;
use bowknot_stepper::Contacts;

/// The moving state of a call. The stages exchange data through it alone.
#[derive(Clone, Debug, Default)]
pub struct ResolveState {
    /// x^[k], where the call started [m].
    pub start: Vec<Point>,
    /// y^(0), where the dynamics wants to be [m].
    pub target: Vec<Point>,
    /// x^(l), free of intersections [m].
    pub x: Vec<Point>,
    /// x^(l-1) [m].
    pub previous: Vec<Point>,
    /// y^(l), the target as modified by the backward step [m].
    pub y: Vec<Point>,
    /// The candidate pairs in contact range, or all of them, and what belongs to them; see
    /// [`crate::Search::begin`].
    pub contacts: ContactSet,
    /// Number of two-way steps taken, l.
    pub step: usize,
    /// Largest remaining distance after the last forward step [m]; infinite before the first.
    pub remaining: f64,
    /// What was given for the call.
    pub call: CallInput,
}

/// The candidate pairs and what belongs to each of them, in the order of the list.
#[derive(Clone, Debug, Default)]
pub struct ContactSet {
    /// The pairs.
    pub pairs: PairList,
    /// Contact geometry at x^(l).
    pub separations: Vec<Separation>,
    /// Contact distance delta_p [m].
    pub deltas: Vec<f64>,
    /// Minimum separation xi_p [m].
    pub min_separations: Vec<f64>,
    /// Multiplier lambda_p of the pair's contact row [m, in units of relative mass].
    pub multipliers: Vec<f64>,
    /// Coefficient of friction mu of each pair [1]; empty without Coulomb friction.
    pub frictions: Vec<f64>,
    /// Friction multiplier of each pair, in space [m, in units of relative mass]; empty without Coulomb
    /// friction.
    pub friction_multipliers: Vec<Vector>,
}

impl ContactSet {
    /// The part that the forward step reads.
    pub fn as_contacts(&self) -> Contacts<'_> {
        Contacts {
            pairs: &self.pairs,
            separations: &self.separations,
            min_separations: &self.min_separations,
        }
    }

    /// What the pairs carry that press, with their contact geometry.
    pub fn pressing(&self) -> impl Iterator<Item = (PairMultipliers, &Separation)> {
        let of_kind = |kind: PairKind| self.pairs.range(kind).map(move |place| (kind, place));
        PairKind::ALL.into_iter().flat_map(of_kind).filter(|(_, place)| self.multipliers[*place] != 0.0).map(
            |(kind, place)| {
                let friction = self.friction_multipliers.get(place).copied().unwrap_or_else(Vector::zeros);
                let (elements, normal) = (self.pairs.pairs()[place].elements, self.multipliers[place]);
                (PairMultipliers { kind, elements, normal, friction }, &self.separations[place])
            },
        )
    }

    /// Whether any contact presses.
    pub fn any_presses(&self) -> bool {
        self.multipliers.iter().any(|&multiplier| multiplier > 0.0)
    }
}

impl ResolveState {
    /// Refuses so many pairs that rows could not be numbered.
    pub(crate) fn check_pairs(&self, scene: &CollisionScene) -> Result<(), ResolveError> {
        check_rows(self.contacts.pairs.len(), scene.model().topology().edges.len())
    }

    /// Starts a call at `positions` toward `target`.
    pub(crate) fn begin(&mut self, positions: &[Point], target: &[Point], call: CallInput) {
        for buffer in [&mut self.start, &mut self.x, &mut self.previous] {
            buffer.clear();
            buffer.extend_from_slice(positions);
        }
        for buffer in [&mut self.target, &mut self.y] {
            buffer.clear();
            buffer.extend_from_slice(target);
        }
        self.step = 0;
        self.remaining = f64::INFINITY;
        self.call = call;
    }

    /// Whether the method may move a vertex away from its target.
    #[inline]
    pub fn is_movable(&self, vertex: usize) -> bool {
        self.call.is_movable(vertex)
    }
}
