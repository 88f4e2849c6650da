//! The rows of impacts, collected over the rounds of a call.

use super::impacts::Impact;
use super::params::{ZoneGoal, ZoneParams, ZoneSolver};
use crate::rows::{AugmentedLagrangian, LinearSystem, solve_equations};
use bowknot_twoway::constraints::{Coloring, ContactForm, contact_row};
use bowknot_twoway::geometry::{PairKind, Point, Vector, separation};
use bowknot_twoway::lcp::{self, ConstraintSet, LcpState, Row, Schedule};
use bowknot_twoway::{CallInput, CollisionScene};
use std::collections::BTreeMap;

/// One row per pair, from its latest impact.
#[derive(Debug, Default)]
pub(crate) struct ImpactRows {
    /// Row and multiplier by kind and elements.
    rows: BTreeMap<(PairKind, [u32; 2]), (Row, f64)>,
    coloring: Coloring,
    descent: AugmentedLagrangian,
}

impl ImpactRows {
    pub(crate) fn clear(&mut self) {
        self.rows.clear();
    }

    /// Adds the row of an impact, or replaces the pair's row and keeps its multiplier. The row is linearized
    /// at the last time at which the pair is certain not to meet: n . (p - q)(y) >= contact distance with the
    /// normal n there. With the goal of a zero velocity, it is n . (p - q)(y) >= n . (p - q)(x).
    pub(crate) fn add(
        &mut self,
        scene: &CollisionScene,
        impact: &Impact,
        x: &[Point],
        paths: &[Vector],
        goal: ZoneGoal,
    ) {
        let kind = impact.kind;
        let mut vertices = impact.pair.vertices;
        let first = vertices[0];
        vertices[kind.vertex_count()..].fill(first);
        let at = |v: u32| x[v as usize] + impact.time * paths[v as usize];
        let points = vertices.map(at);
        let separation = match kind {
            PairKind::VertexHalfSpace => {
                let half_space = &scene.model().half_spaces()[impact.pair.elements[1] as usize];
                separation::separate_half_space(&points[0], half_space)
            }
            _ => separation::separate(kind, &points),
        };
        let row = contact_row(ContactForm::Gap, kind, [0, 1, 2, 3], &points, &separation, impact.delta);
        let mut row = Row { vertices, ..row };
        if goal == ZoneGoal::ZeroVelocity {
            let at_start = row.gradients.iter().zip(vertices).map(|(g, v)| g.dot(&x[v as usize].coords));
            row.offset = -at_start.sum::<f64>();
        }
        self.rows.entry((kind, impact.pair.elements)).or_insert((row, 0.0)).0 = row;
    }

    /// Moves `y` [m], one entry per vertex, from `free` to where the rows hold, as far as the solver
    /// converges.
    pub(crate) fn solve(
        &mut self,
        scene: &CollisionScene,
        call: &CallInput,
        params: &ZoneParams,
        free: &[Vector],
        y: &mut Vec<Vector>,
    ) -> Result<(), lcp::LcpError> {
        let weights: Vec<f64> = (0..free.len())
            .map(|v| if call.is_movable(v) { 1.0 / scene.relative_mass(v) } else { 0.0 })
            .collect();
        let list: Vec<(Row, f64)> = self.rows.values().copied().collect();
        self.coloring.first_fit(free.len(), list.len(), |r| {
            list[r].0.vertices.into_iter().filter(|&v| call.is_movable(v as usize))
        });
        let order = self.coloring.order();
        let mut rows: Vec<Row> = order.iter().map(|&r| list[r as usize].0).collect();
        let mut lambda: Vec<f64> = order.iter().map(|&r| list[r as usize].1).collect();
        lcp::prepare_rows(&mut rows, &weights)?;
        let schedule = Schedule::colored(self.coloring.starts());
        let system = lcp::LcpProblem::new(
            &weights,
            ConstraintSet::new(&rows, schedule),
            ConstraintSet::default(),
            ConstraintSet::default(),
        )?;
        y.clear();
        y.extend_from_slice(free);
        let mut state = LcpState { y, lambda: &mut lambda, ..LcpState::default() };
        lcp::apply_multipliers(&system, &mut state)?;
        match params.solver {
            ZoneSolver::GaussSeidel => {
                let tolerance = Some(params.tolerance * scene.lengths().edge);
                let params =
                    lcp::LcpParams { max_sweeps: params.max_sweeps, tolerance, ..lcp::LcpParams::default() };
                match lcp::solve_colored(&system, &mut state, &params) {
                    Ok(_) | Err(lcp::LcpError::NotConverged { .. }) => {}
                    Err(error) => return Err(error),
                }
            }
            // Distances may contradict each other. Gauss-Seidel then comes to a compromise, where conjugate
            // gradients diverge.
            ZoneSolver::LinearSystem if params.goal == ZoneGoal::Distance => {
                LinearSystem { sweeps: params.max_sweeps, projected: false }.sweep(&system, &mut state)?;
            }
            ZoneSolver::LinearSystem => {
                let tolerance = params.tolerance * scene.lengths().edge;
                solve_equations(&system, &mut state, tolerance, params.max_sweeps);
            }
            ZoneSolver::AugmentedLagrangian => {
                self.descent.iterations = params.max_sweeps as usize;
                self.descent.descend(&system, free, &mut state);
            }
        }
        let mut found = vec![0.0; rows.len()];
        order.iter().zip(&lambda).for_each(|(&r, &lambda)| found[r as usize] = lambda);
        self.rows.values_mut().zip(found).for_each(|(entry, lambda)| entry.1 = lambda);
        Ok(())
    }
}
