//! Forces out of balance.

use super::state::Newton;
use crate::dynamics::info::Residual;
use crate::linear::system::System;
use bowknot_geometry::Vector;

impl Newton<'_> {
    /// The residual of the time step at `work.x` over the nodes that are `counted`; contact forces are the
    /// known forces of the springs.
    pub fn residual(&mut self, counted: &[bool]) -> Residual {
        let mut is_assembled = self.assemble();
        if is_assembled {
            self.differentiate_bodies();
        } else {
            self.linearize_bodies();
        }
        self.repulsion.subtract_known_forces(&mut self.work.gradient);
        let work = &mut *self.work;
        for node in 0..work.x.len() {
            let counts = work.free[node] && counted[node];
            work.right_side[node] = if counts { -work.gradient[node] } else { Vector::zeros() };
        }
        is_assembled = is_assembled && self.precondition_assembled();
        if !is_assembled {
            // Nothing but the matrix is missing if the backend has just failed.
            self.linearize_bodies();
        }
        let Self { model, step, work, .. } = self;
        if !is_assembled {
            let system = System {
                pattern: &model.pattern,
                values: &work.values,
                scalar: &step.scalar,
                springs: None,
                free: &work.free,
            };
            work.solver.precondition(&system, &work.x, &work.right_side, &mut work.step);
        }
        let mut largest: f64 = 0.0;
        for component in &model.components {
            let nodes = || (component.start as usize..component.end as usize).filter(|&n| work.free[n]);
            let mass: f64 = nodes().map(|n| model.node_masses[n]).sum();
            let product: f64 = nodes().map(|n| work.right_side[n].dot(&work.step[n])).sum();
            if mass > 0.0 {
                largest = largest.max(product / mass);
            }
        }
        let force = work.right_side.iter().map(Vector::norm_squared).sum::<f64>().sqrt();
        Residual { force, distance: step.dt * largest.sqrt() }
    }
}
