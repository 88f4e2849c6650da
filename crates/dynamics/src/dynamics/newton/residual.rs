//! Forces out of balance.

use super::bodies::Answer;
use super::state::Newton;
use crate::dynamics::info::Residual;
use crate::elements::filter::Filter;

impl Newton<'_> {
    /// The residual of the time step at the iterate over the nodes that are `counted`; contact forces are
    /// those of the springs there. Also the distance of each component [m]. The next target prepares the
    /// springs again.
    pub fn residual(&mut self, counted: &[bool]) -> Answer<(Residual, Vec<f64>)> {
        let filter = Filter::new(self.params.newton.hessian_filter, self.is_first);
        let iterate = self.bodies.iterate();
        self.repulsion.prepare(self.model, 1.0 / self.dt, self.free, &iterate, None);
        self.repulsion.linearize(&iterate, false);
        self.course.unprepared = true;
        let imbalance = self.bodies.out_of_balance(self.repulsion, counted, filter)?;
        let mut distances = Vec::with_capacity(imbalance.products.len());
        let (mut distance, mut vertex): (f64, _) = (0.0, None);
        for (component, product) in self.model.components.iter().zip(&imbalance.products) {
            let nodes = (component.start as usize..component.end as usize).filter(|&n| self.free[n]);
            let mass: f64 = nodes.map(|n| self.model.node_masses[n]).sum();
            // Near 0 rounding in single precision may make the product negative.
            let product = if *product < 0.0 { 0.0 } else { *product };
            let own = if mass > 0.0 { self.dt * (product / mass).sqrt() } else { 0.0 };
            // One that is not a number stays: such a step is not solved.
            if own > distance || own.is_nan() {
                distance = own;
                vertex = Some(self.model.node_vertex[component.start as usize]);
            }
            distances.push(own);
        }
        let force = imbalance.squared_force.sqrt();
        Ok((Residual { force, distance, vertex }, distances))
    }
}
