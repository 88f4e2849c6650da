//! What moves during a call.

use bowknot_geometry::{Point, Separation, Vector};
use bowknot_proximity::PairList;
use bowknot_stepper::Contacts;

/// The moving state of a call; its stages read and write nothing else of each other.
#[derive(Clone, Debug, Default)]
pub struct State {
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
    /// Listed pairs and what belongs to them.
    pub contacts: ContactSet,
    /// Two-way steps taken so far, l.
    pub step: usize,
    /// Largest distance that the last forward step left to travel [m]; infinite before the first.
    pub remaining: f64,
    /// Time step that the call stands for [s].
    pub time_step: Option<f64>,
    /// Positions at the start of the time step, which friction measures slip from [m]; empty without friction.
    pub slip_start: Vec<Point>,
}

/// The listed pairs and what belongs to each of them, in the list's order.
#[derive(Clone, Debug, Default)]
pub struct ContactSet {
    /// The pairs.
    pub pairs: PairList,
    /// Contact geometry at x^(l).
    pub separations: Vec<Separation>,
    /// Desired distance delta_p [m].
    pub desired: Vec<f64>,
    /// Gap floor xi_p [m].
    pub floors: Vec<f64>,
    /// Multiplier lambda_p of the pair's contact row [m, in units of relative mass].
    pub multipliers: Vec<f64>,
    /// Coefficient of friction mu of each pair [1]; empty without Coulomb friction.
    pub frictions: Vec<f64>,
    /// Friction multiplier of each pair, in space [m, in units of relative mass]; empty likewise.
    pub friction_multipliers: Vec<Vector>,
}

impl ContactSet {
    /// The part that the forward step reads.
    pub fn as_contacts(&self) -> Contacts<'_> {
        Contacts { pairs: &self.pairs, separations: &self.separations, floors: &self.floors }
    }
}

impl State {
    /// Starts a call at `positions` toward `target`.
    pub(crate) fn begin(&mut self, positions: &[Point], target: &[Point], time_step: Option<f64>) {
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
        self.time_step = time_step;
    }
}
