//! The potential of the bodies in double precision, beside which backends are checked.

use super::Dynamics;
use super::newton::backend::NewtonStep;
use super::newton::momentum::Inertia;
use super::newton::state::Step;
use crate::elements::set::Motion;
use crate::error::StepError;
use crate::linear::assembly::ElementModel;
use crate::linear::scalar::SplitForm;
use crate::model::DynamicsModel;
use crate::nodes::CHUNK;
use crate::params::DynamicsParams;
use bowknot_geometry::Vector;
use nalgebra::Matrix3;

/// The terms of the potential that are fixed in a time step, see [`NewtonStep`].
#[derive(Clone, Debug)]
pub struct StepTerms {
    start: Vec<Vector>,
    inertial: Vec<Vector>,
    rate: f64,
    row_sums: Vec<Matrix3<f64>>,
    gradient: Vec<Vector>,
    bending: SplitForm,
}

impl StepTerms {
    /// Those of a time step.
    pub(super) fn new(model: &DynamicsModel, params: &DynamicsParams, step: &Step) -> Self {
        let inertia = Inertia::new(params, step);
        let gradient = |node: usize| {
            inertia.gradient(model, step, node, &step.start[node]) + model.bending.product(node, &step.start)
        };
        let nodes = 0..step.start.len();
        Self {
            start: step.start.clone(),
            inertial: step.inertial.clone(),
            rate: inertia.rate,
            row_sums: nodes.clone().map(|node| inertia.of_nodes(model, node..node + 1)).collect(),
            gradient: nodes.map(gradient).collect(),
            bending: step.scalar.clone(),
        }
    }

    /// What a backend gets of them.
    pub fn as_step(&self) -> NewtonStep<'_> {
        NewtonStep {
            start: &self.start,
            inertial: &self.inertial,
            rate: self.rate,
            row_sums: &self.row_sums,
            gradient: &self.gradient,
            bending: &self.bending.in_pattern,
            scalars: self.bending.off_values(),
        }
    }
}

/// The potential of the bodies at a state, see [`NewtonStep`].
#[derive(Clone, Debug, Default)]
pub struct BodiesPotential {
    /// Energy of the quadratic terms, relative to the start of the time step [J].
    pub quadratic: f64,
    /// Energy of the elements [J].
    pub elements: f64,
    /// The gradient of the sum [N, N].
    pub gradient: Vec<Vector>,
}

impl Dynamics {
    /// The elements as backends get them, without patches.
    pub fn element_model(&self) -> ElementModel {
        self.model.describe(Vec::new())
    }

    /// The terms of the potential in the time step that was begun.
    ///
    /// # Errors
    /// No step was begun.
    pub fn step_terms(&self) -> Result<StepTerms, StepError> {
        let Some(step) = &self.step else { return Err(StepError::NotBegun) };
        Ok(StepTerms::new(&self.model, &self.params, step))
    }

    /// The potential of the bodies at positions `x` of nodes [m] in the time step that was begun. One thread computes it.
    ///
    /// # Errors
    /// No step was begun, or the length is wrong.
    pub fn bodies_potential(&self, x: &[Vector]) -> Result<BodiesPotential, StepError> {
        let Some(step) = &self.step else { return Err(StepError::NotBegun) };
        if x.len() != step.start.len() {
            return Err(StepError::Length { array: "x", given: x.len(), vertices: step.start.len() });
        }
        let terms = self.step_terms()?;
        let moved: Vec<Vector> = x.iter().zip(&step.start).map(|(x, start)| x - start).collect();
        let mut potential = BodiesPotential::default();
        for (node, d) in moved.iter().enumerate() {
            let row = self.model.pattern.row(node);
            let columns = &self.model.pattern.columns[row.clone()];
            let in_pattern = columns.iter().zip(&terms.bending.in_pattern[row]);
            let (columns, values) = terms.bending.off_pattern(node);
            let pairs = in_pattern.chain(columns.iter().zip(values));
            let bent: Vector = pairs.map(|(&j, &value)| (moved[j as usize] - d) * value).sum();
            let force = terms.row_sums[node] * d + bent;
            potential.quadratic += d.dot(&(force * 0.5 + terms.gradient[node]));
            potential.gradient.push(force + terms.gradient[node]);
        }
        let motion = Motion { x, start: &step.start, rate: terms.rate };
        for (chunk, gradient) in potential.gradient.chunks_mut(CHUNK).enumerate() {
            let nodes = chunk * CHUNK..chunk * CHUNK + gradient.len();
            for set in &self.model.element_sets {
                potential.elements += set.energy(chunk, motion);
                set.add_gradient(chunk, motion, nodes.clone(), gradient);
            }
        }
        Ok(potential)
    }
}

#[cfg(test)]
mod tests {
    use crate::body::Body;
    use crate::dynamics::Dynamics;
    use crate::material::ClothMaterial;
    use crate::model::DynamicsModel;
    use crate::params::DynamicsParams;
    use crate::test_support::grid_triangles;
    use bowknot_geometry::{Point, Vector};

    /// Newton's method ends where the gradient of the potential is zero, and the potential falls on the way there.
    #[test]
    fn time_steps_end_where_the_gradient_is_zero() {
        let rest: Vec<Point> =
            (0..20).map(|k| Point::new(0.1 * f64::from(k % 5), 0.1 * f64::from(k / 5), 0.0)).collect();
        let material = ClothMaterial {
            bend_stiffness: 1e-3,
            stretch_damping: 0.01,
            bend_damping: 0.02,
            ..ClothMaterial::cotton()
        };
        let body = Body::cloth("sheet", grid_triangles(4, 3, false), material);
        let model = DynamicsModel::new(rest.clone(), vec![body]).expect("valid");
        let mut params = DynamicsParams::default();
        params.newton.cg_tolerance = 1e-12;
        params.environment.air_drag = 0.5;
        params.environment.air_density = 1.2;
        params.environment.wind = Vector::new(2.0, -1.0, 0.5);
        let mut dynamics = Dynamics::new(model, params).expect("valid");
        let wave = |k: usize| Vector::new((k as f64 * 1.7).sin(), (k as f64 * 0.9).cos(), (k as f64).sin());
        let start: Vec<Point> = rest.iter().enumerate().map(|(k, x)| x + wave(k) * 0.02).collect();
        let velocities: Vec<Vector> = (0..20).map(|k| wave(k + 5)).collect();
        dynamics.begin_step(&start, &velocities, 0.01).expect("valid");
        let by_node = |dynamics: &Dynamics, x: &[Point]| -> Vec<Vector> {
            dynamics.model.node_vertex.iter().map(|v| x[*v as usize].coords).collect()
        };
        let at = |dynamics: &Dynamics, x: &[Point]| {
            let potential = dynamics.bodies_potential(&by_node(dynamics, x)).expect("begun");
            let largest = potential.gradient.iter().map(Vector::amax).fold(0.0, f64::max);
            (potential.quadratic + potential.elements, largest)
        };
        let (energy, largest) = at(&dynamics, &start);
        let mut x = start.clone();
        for _ in 0..20 {
            let mut y = x.clone();
            dynamics.newton_target(&x, &[false; 20], &rest, &mut y).expect("a target");
            x = y;
        }
        let (end, rest) = at(&dynamics, &x);
        assert!(rest < 1e-8 * largest && end < energy, "{rest:e} of {largest:e}, {end:e} of {energy:e}");
        assert!(dynamics.bodies_potential(&[]).is_err());
    }
}
