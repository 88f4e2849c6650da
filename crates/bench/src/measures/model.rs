//! The model of a step p in the method of multipliers: the augmented objective with linear constraints,
//!
//! sum m/2 |x + p - y|^2 + sum max(0, lambda - rho (c + g . p))^2 / (2 rho) + barriers and edges to second order.
//!
//! It is convex and piecewise quadratic, and is minimized by Newton's method with conjugate gradients. Which
//! constraints press changes along the step; to find that out costs little here, as nothing is measured.

use bowknot::geometry::Vector;
use bowknot::geometry::nalgebra::Matrix3;

/// Reduction of the gradient, largest number of Newton steps, and of halvings of each.
const REDUCTION: f64 = 0.05;
const NEWTON_STEPS: usize = 30;
const HALVINGS: usize = 12;
/// Reduction of the residual of a linear system, and the largest number of iterations.
const CG_REDUCTION: f64 = 0.01;
const CG_ITERATIONS: usize = 1000;

/// A linear constraint.
pub struct Linear {
    pub vertices: [u32; 4],
    /// Derivatives of its value by the positions.
    pub gradients: [Vector; 4],
    /// lambda - rho c at p = 0.
    pub excess: f64,
    /// First and second derivative of the barrier by the value.
    pub barrier: [f64; 2],
    /// Force over length of a stretched edge: its stiffness across.
    pub across: f64,
}

/// The model.
pub struct Model<'a> {
    pub masses: &'a [f64],
    /// x - y.
    pub away: Vec<Vector>,
    pub linear: Vec<Linear>,
    pub rho: f64,
}

impl Linear {
    /// By how much a step changes the value.
    fn change(&self, step: &[Vector]) -> f64 {
        (0..4).map(|k| self.gradients[k].dot(&step[self.vertices[k] as usize])).sum()
    }

    /// Adds the gradients times `factor`.
    fn add(&self, factor: f64, to: &mut [Vector]) {
        for (v, g) in self.vertices.iter().zip(&self.gradients) {
            to[*v as usize] += g * factor;
        }
    }

    /// Adds the product of the stiffness across an edge with a step.
    fn add_across(&self, step: &[Vector], to: &mut [Vector]) {
        if self.across > 0.0 {
            let [a, b] = [self.vertices[0] as usize, self.vertices[1] as usize];
            let (between, along) = (step[a] - step[b], self.gradients[1]);
            let across = (between - along * along.dot(&between)) * self.across;
            to[a] += across;
            to[b] -= across;
        }
    }
}

impl Model<'_> {
    /// The gradient at a step.
    pub fn gradient(&self, step: &[Vector]) -> Vec<Vector> {
        let inertia = self.away.iter().zip(self.masses).zip(step);
        let mut gradient: Vec<Vector> = inertia.map(|((away, m), p)| (away + p) * *m).collect();
        for linear in &self.linear {
            let change = linear.change(step);
            let [slope, curvature] = linear.barrier;
            let pull = slope + curvature * change - (linear.excess - self.rho * change).max(0.0);
            if pull != 0.0 {
                linear.add(pull, &mut gradient);
            }
            linear.add_across(step, &mut gradient);
        }
        gradient
    }

    /// Moves the step to the minimum.
    pub fn minimize(&self, step: &mut Vec<Vector>) {
        let mut gradient = self.gradient(step);
        let goal = REDUCTION * REDUCTION * self.squared(&gradient);
        for _ in 0..NEWTON_STEPS {
            let direction = self.solve(step, &gradient);
            // The slope along the direction rises from below 0; where it is 0 the model is least.
            let at = |length: f64| -> Vec<Vector> {
                step.iter().zip(&direction).map(|(p, d)| p + d * length).collect()
            };
            let [mut low, mut high] = [0.0, 1.0];
            let mut length = 1.0;
            for _ in 0..HALVINGS {
                let slope = dot(&self.gradient(&at(length)), &direction);
                if slope > 0.0 {
                    high = length;
                } else {
                    low = length;
                }
                if low == 1.0 {
                    break;
                }
                length = 0.5 * (low + high);
            }
            *step = at(length);
            gradient = self.gradient(step);
            if self.squared(&gradient) <= goal {
                break;
            }
        }
    }

    /// Sum of squares of a gradient over mass.
    fn squared(&self, gradient: &[Vector]) -> f64 {
        gradient.iter().zip(self.masses).map(|(g, m)| g.norm_squared() / m).sum()
    }

    /// Solves for the Newton direction at a step by conjugate gradients with block-Jacobi.
    fn solve(&self, step: &[Vector], gradient: &[Vector]) -> Vec<Vector> {
        let stiffness = |linear: &Linear| {
            let presses = linear.excess > self.rho * linear.change(step);
            linear.barrier[1] + if presses { self.rho } else { 0.0 }
        };
        let all = self.linear.iter().map(|linear| (linear, stiffness(linear)));
        let stiff: Vec<(&Linear, f64)> =
            all.filter(|(linear, stiffness)| *stiffness > 0.0 || linear.across > 0.0).collect();
        let mut blocks: Vec<Matrix3<f64>> =
            self.masses.iter().map(|&m| Matrix3::from_diagonal_element(m)).collect();
        for (linear, stiffness) in &stiff {
            for (v, g) in linear.vertices.iter().zip(&linear.gradients) {
                blocks[*v as usize] += *stiffness * g * g.transpose();
            }
            if linear.across > 0.0 {
                let along = linear.gradients[1];
                let block = linear.across * (Matrix3::identity() - along * along.transpose());
                blocks[linear.vertices[0] as usize] += block;
                blocks[linear.vertices[1] as usize] += block;
            }
        }
        let inverses: Vec<Matrix3<f64>> =
            blocks.into_iter().map(|block| block.try_inverse().unwrap_or_else(Matrix3::zeros)).collect();
        let multiply = |p: &[Vector]| -> Vec<Vector> {
            let mut product: Vec<Vector> = p.iter().zip(self.masses).map(|(p, m)| p * *m).collect();
            for (linear, stiffness) in &stiff {
                linear.add(*stiffness * linear.change(p), &mut product);
                linear.add_across(p, &mut product);
            }
            product
        };
        let precondition = |r: &[Vector]| -> Vec<Vector> {
            r.iter().zip(&inverses).map(|(r, inverse)| inverse * r).collect()
        };
        let mut direction = vec![Vector::zeros(); gradient.len()];
        let mut r: Vec<Vector> = gradient.iter().map(|g| -g).collect();
        let mut z = precondition(&r);
        let mut p = z.clone();
        let mut rz = dot(&r, &z);
        let goal = CG_REDUCTION * CG_REDUCTION * rz;
        for _ in 0..CG_ITERATIONS {
            if rz.is_nan() || rz <= goal {
                break;
            }
            let q = multiply(&p);
            let length = rz / dot(&p, &q);
            for v in 0..r.len() {
                direction[v] += p[v] * length;
                r[v] -= q[v] * length;
            }
            z = precondition(&r);
            let next = dot(&r, &z);
            let share = next / rz;
            rz = next;
            for v in 0..r.len() {
                p[v] = z[v] + p[v] * share;
            }
        }
        direction
    }
}

fn dot(a: &[Vector], b: &[Vector]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.dot(b)).sum()
}
