//! Non-negative least squares over rows: the lambda >= 0 that minimizes |d + W J^T lambda| in the metric of
//! W^-1.
//!
//! That is a quadratic program with matrix A = J W J^T and bounds at 0. It is solved by modified
//! proportioning with reduced gradient projections (MPRGP; Dostal and Schoeberl, Computational Optimization
//! and Applications 30, 2005): conjugate gradients on the free multipliers, a projected gradient step where
//! one reaches its bound, and a step that frees multipliers where the bounds hold back too much. Rows are
//! scaled to a unit diagonal. Any lambda >= 0 gives an upper bound of the residual, and the method never
//! raises it: stopping early overestimates the residual.

use bowknot::geometry::Vector;

/// The solve stops when the projected gradient is this share of that at lambda = 0.
const TOLERANCE: f64 = 1e-8;
/// Largest ratio of the chopped to the free gradient; above it multipliers are freed from their bounds.
const PROPORTION: f64 = 1.0;

/// A row of J.
#[derive(Clone, Copy, Debug)]
pub struct Row {
    /// Its vertices; one may be named several times.
    pub vertices: [u32; 4],
    pub gradients: [Vector; 4],
}

impl Row {
    /// Its diagonal of J W J^T.
    fn diagonal(&self, weights: &[f64]) -> f64 {
        let of_place = |k: usize| {
            let same = (0..4).filter(|&other| self.vertices[other] == self.vertices[k]);
            let sum: Vector = same.map(|other| self.gradients[other]).sum();
            weights[self.vertices[k] as usize] * self.gradients[k].dot(&sum)
        };
        (0..4).map(of_place).sum()
    }
}

/// The residual d + W J^T lambda after at most `iterations`, each a product with A. `weights` are inverse
/// masses, 0 for vertices that cannot move; `wanted` is d.
pub fn residual(rows: &[Row], weights: &[f64], wanted: Vec<Vector>, iterations: usize) -> Vec<Vector> {
    let system = System::new(rows, weights);
    let mut product = vec![0.0; system.rows.len()];
    system.gather(&wanted, &mut product);
    let lambda = system.solve(product, iterations);
    let mut result = wanted;
    system.scatter(&lambda, &mut result);
    result
}

/// Rows that some vertex can violate, scaled.
struct System<'a> {
    rows: Vec<&'a Row>,
    /// 1/sqrt of each row's diagonal of J W J^T.
    scales: Vec<f64>,
    weights: &'a [f64],
}

impl<'a> System<'a> {
    fn new(rows: &'a [Row], weights: &'a [f64]) -> Self {
        let mut system = Self { rows: Vec::new(), scales: Vec::new(), weights };
        for row in rows {
            let diagonal = row.diagonal(weights);
            if diagonal > 0.0 {
                system.rows.push(row);
                system.scales.push(1.0 / diagonal.sqrt());
            }
        }
        system
    }

    /// J y, scaled.
    fn gather(&self, y: &[Vector], out: &mut [f64]) {
        for ((row, scale), out) in self.rows.iter().zip(&self.scales).zip(out) {
            let sum: f64 = (0..4).map(|k| row.gradients[k].dot(&y[row.vertices[k] as usize])).sum();
            *out = scale * sum;
        }
    }

    /// y += W J^T lambda, lambda scaled.
    fn scatter(&self, lambda: &[f64], y: &mut [Vector]) {
        for ((row, scale), lambda) in self.rows.iter().zip(&self.scales).zip(lambda) {
            if *lambda != 0.0 {
                for k in 0..4 {
                    let v = row.vertices[k] as usize;
                    y[v] += row.gradients[k] * (self.weights[v] * scale * lambda);
                }
            }
        }
    }

    fn multiply(&self, lambda: &[f64], space: &mut [Vector], out: &mut [f64]) {
        space.fill(Vector::zeros());
        self.scatter(lambda, space);
        self.gather(space, out);
    }

    /// Minimizes lambda A lambda/2 + q lambda over lambda >= 0.
    fn solve(&self, q: Vec<f64>, iterations: usize) -> Vec<f64> {
        let n = q.len();
        let mut space = vec![Vector::zeros(); self.weights.len()];
        let step = 1.0 / self.largest_eigenvalue(&mut space).max(f64::MIN_POSITIVE);
        let mut lambda = vec![0.0; n];
        let mut gradient = q;
        let goal = TOLERANCE * norm(&chopped(&lambda, &gradient));
        let mut direction = free(&lambda, &gradient);
        let mut product = vec![0.0; n];
        for _ in 0..iterations {
            let (loose, held) = (free(&lambda, &gradient), chopped(&lambda, &gradient));
            if (dot(&loose, &loose) + dot(&held, &held)).sqrt() <= goal {
                break;
            }
            let reduced: f64 = (0..n).map(|i| loose[i] * loose[i].min(lambda[i] / step)).sum();
            if dot(&held, &held) > PROPORTION * reduced {
                self.multiply(&held, &mut space, &mut product);
                let length = dot(&gradient, &held) / dot(&held, &product).max(f64::MIN_POSITIVE);
                add(&mut lambda, -length, &held);
                add(&mut gradient, -length, &product);
                direction = free(&lambda, &gradient);
                continue;
            }
            self.multiply(&direction, &mut space, &mut product);
            let curvature = dot(&direction, &product);
            if curvature <= f64::MIN_POSITIVE {
                // Along redundant rows J^T lambda does not change: nothing is gained.
                direction = loose;
                self.multiply(&direction, &mut space, &mut product);
            }
            let curvature = dot(&direction, &product).max(f64::MIN_POSITIVE);
            let length = dot(&gradient, &direction) / curvature;
            let longest = (0..n)
                .filter(|&i| direction[i] > 0.0)
                .map(|i| lambda[i] / direction[i])
                .fold(f64::INFINITY, f64::min);
            if length <= longest {
                add(&mut lambda, -length, &direction);
                lambda.iter_mut().for_each(|l| *l = l.max(0.0));
                add(&mut gradient, -length, &product);
                let loose = free(&lambda, &gradient);
                let share = dot(&loose, &product) / curvature;
                let previous = std::mem::replace(&mut direction, loose);
                add(&mut direction, -share, &previous);
            } else {
                add(&mut lambda, -longest, &direction);
                add(&mut gradient, -longest, &product);
                let loose = free(&lambda, &gradient);
                let before = lambda.clone();
                for i in 0..n {
                    lambda[i] = (lambda[i] - step * loose[i]).max(0.0);
                }
                let change: Vec<f64> = (0..n).map(|i| lambda[i] - before[i]).collect();
                self.multiply(&change, &mut space, &mut product);
                add(&mut gradient, 1.0, &product);
                direction = free(&lambda, &gradient);
            }
        }
        lambda
    }

    /// An upper estimate of A's largest eigenvalue, by the power method with a margin.
    fn largest_eigenvalue(&self, space: &mut [Vector]) -> f64 {
        let n = self.rows.len();
        let mut vector: Vec<f64> = (0..n).map(|i| 1.0 + 0.1 * ((i * 7919) % 13) as f64).collect();
        let mut product = vec![0.0; n];
        let mut value = 1.0;
        for _ in 0..30 {
            let length = norm(&vector).max(f64::MIN_POSITIVE);
            vector.iter_mut().for_each(|v| *v /= length);
            self.multiply(&vector, space, &mut product);
            value = norm(&product);
            std::mem::swap(&mut vector, &mut product);
        }
        1.2 * value
    }
}

/// The gradient where multipliers are off their bound.
fn free(lambda: &[f64], gradient: &[f64]) -> Vec<f64> {
    lambda.iter().zip(gradient).map(|(l, g)| if *l > 0.0 { *g } else { 0.0 }).collect()
}

/// The gradient where multipliers at their bound would rise.
fn chopped(lambda: &[f64], gradient: &[f64]) -> Vec<f64> {
    lambda.iter().zip(gradient).map(|(l, g)| if *l > 0.0 { 0.0 } else { g.min(0.0) }).collect()
}

fn add(to: &mut [f64], factor: f64, vector: &[f64]) {
    to.iter_mut().zip(vector).for_each(|(t, v)| *t += factor * v);
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn norm(a: &[f64]) -> f64 {
    dot(a, a).sqrt()
}
