//! Matrices that the backend assembles. The gradient stays on the CPU, in double precision.

use super::state::{Newton, negate_forces};
use crate::elements::filter::Filter;
use crate::linear::accuracy::{CgInfo, Limits};
use crate::linear::assembly::{AssemblySprings, AssemblyState};
use bowknot_geometry::Vector;
use nalgebra::Matrix3;

impl Newton<'_> {
    /// Lets the backend assemble the matrix of the bodies at `work.x`. Returns false if the CPU must.
    pub fn assemble(&mut self) -> bool {
        let Self { model, params, step, work, .. } = self;
        let Some(assembler) = work.solver.assembler() else { return false };
        let rate = 1.0 / step.dt;
        if step.row_sums.is_empty() {
            let per_mass = rate * rate + params.environment.air_drag * rate;
            step.row_sums
                .extend(model.node_masses.iter().map(|mass| Matrix3::from_diagonal_element(mass * per_mass)));
            if let Some(drag) = &step.drag {
                step.row_sums.iter_mut().zip(&drag.matrix).for_each(|(sum, matrix)| *sum += matrix * rate);
            }
        }
        let filter = Filter::new(params.newton.hessian_filter, step.last_target.is_none());
        let (_, _, scalars) = step.scalar.off_rows();
        let assembled = assembler.assemble(&AssemblyState {
            free: &work.free,
            positions: &work.x,
            start: &step.start,
            rate,
            absolute: filter == Filter::Absolute,
            row_sums: &step.row_sums,
            bending: &step.scalar.in_pattern,
            scalars,
        });
        assembled.map_err(|error| work.solver.fail(&error)).is_ok()
    }

    /// Reads the diagonal blocks of that matrix into `work.values`. Returns false if the CPU must compute them.
    pub fn read_diagonal(&mut self) -> bool {
        self.work.cache.has_matrix = false;
        let Some(assembler) = self.work.solver.assembler() else { return false };
        let read = assembler.diagonal(&mut self.work.values.diagonal);
        read.map_err(|error| self.work.solver.fail(&error)).is_ok()
    }

    /// Solves the system whose matrix the backend has assembled, with `guesses` as
    /// [`crate::linear::solver::LinearSolver`] has them. Returns None if the CPU must solve.
    pub fn solve_assembled(&mut self, guesses: usize, limits: Limits) -> Option<CgInfo> {
        if !self.work.assembled {
            return None;
        }
        let Self { repulsion, step, work, .. } = self;
        let linear = repulsion.linear();
        let springs = if linear.is_empty() {
            AssemblySprings::default()
        } else {
            AssemblySprings { springs: linear.all(), starts: linear.starts(), entries: linear.all_entries() }
        };
        // b = -(g + H p) over free nodes, with p the imposed displacements of the prescribed nodes.
        let imposes = work.imposed.iter().any(|p| *p != Vector::zeros());
        let assembler = work.solver.assembler()?;
        let mut prepared = assembler.precondition(&springs);
        work.right_side.fill(Vector::zeros());
        if imposes {
            prepared = prepared.and_then(|()| assembler.multiply(&work.imposed, &mut work.right_side));
        }
        if let Err(error) = prepared {
            work.solver.fail(&error);
            return None;
        }
        negate_forces(&mut work.right_side, &work.gradient, &work.free);
        let [inertia, last] = &work.guesses;
        let guesses: &[&[Vector]] = &[last.as_slice(), inertia.as_slice()][2 - guesses..];
        work.solver.solve_assembled(
            &work.free,
            &step.row_sums,
            &work.right_side,
            guesses,
            limits,
            &mut work.step,
        )
    }

    /// Sets `work.step` to the preconditioner of the matrix without springs times `work.right_side`. Returns false if
    /// the CPU must.
    pub fn precondition_assembled(&mut self) -> bool {
        let Some(assembler) = self.work.solver.assembler() else { return false };
        let applied = assembler
            .precondition(&AssemblySprings::default())
            .and_then(|()| assembler.apply_preconditioner(&self.work.right_side, &mut self.work.step));
        applied.map_err(|error| self.work.solver.fail(&error)).is_ok()
    }
}
