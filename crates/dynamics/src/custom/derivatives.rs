//! Compares the derivatives of a custom element with finite differences, for the tests of those who write
//! one.
//!
//! Differences are central, (f(x + h) - f(x - h)) / 2h. Their error has a part that grows with h and one, of
//! rounding, that grows with 1/h. So each entry is compared with the differences of several h, and the
//! nearest counts.

use super::element::{CustomElement, MAX_ELEMENT_VERTICES, Quantity, derivatives};
use bowknot_geometry::{Point, Vector};
use nalgebra::{Matrix3, Rotation3};

/// Steps of differences, as shares of the size of the element.
const STEPS: [f64; 4] = [1e-3, 1e-4, 1e-5, 1e-6];

/// Largest error of a derivative that is accepted, as a share of the largest entry. Differences are accurate
/// to 1e-8 or so; mistakes in a formula are larger than this.
const TOLERANCE: f64 = 1e-5;

/// Largest change of the energy by a rigid motion that is accepted, and largest negative eigenvalue, where an
/// element says that it has none; both as shares of what is usual.
const ROUNDING: f64 = 1e-9;

/// Gradients count as at least this share of the Hessian times the size: at rest they vanish.
const SMALL: f64 = 1e-3;

/// How far the derivatives of an element are from finite differences, all relative [1].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DerivativeErrors {
    /// Largest difference between an entry of the gradient and that of the energy, over the largest entry.
    pub gradient: f64,
    /// Likewise between the Hessian and the gradient.
    pub hessian: f64,
    /// Largest difference between two entries of the Hessian that mirror each other, over the largest entry.
    pub asymmetry: f64,
    /// Largest change of the energy by a rigid motion of its vertices, over the usual size of the energy.
    /// Rounding, about 1e-15, means that [`CustomElement::is_invariant`] may be true.
    pub rigid_motion: f64,
    /// Smallest eigenvalue of the Hessian, over the largest entry. If it is never below rounding,
    /// [`CustomElement::is_positive_semidefinite`] may be true.
    pub smallest_eigenvalue: f64,
}

/// What is wrong with an element. Vertices count those of the element from 0.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DerivativeProblem {
    /// Another number of positions than of vertices, or an element without vertices or with too many.
    #[error("{given} positions for {vertices} vertices; an element has 1 to {MAX_ELEMENT_VERTICES} vertices")]
    Count {
        /// Positions given.
        given: usize,
        /// Vertices of the element.
        vertices: usize,
    },
    /// Something is not finite.
    #[error("the {quantity} is not finite")]
    NonFinite {
        /// "energy", "gradient" or "Hessian".
        quantity: &'static str,
    },
    /// An entry of the gradient is not the slope of the energy.
    #[error(
        "the gradient by {} of vertex {vertex} is {given:e} N, but differences of the energy are {expected:e} \
         N",
        axis_name(*.axis)
    )]
    Gradient {
        /// The vertex.
        vertex: usize,
        /// The axis: 0 for x, 1 for y, 2 for z.
        axis: usize,
        /// The entry [N].
        given: f64,
        /// The finite difference that is nearest to it [N].
        expected: f64,
    },
    /// An entry of the Hessian is not the slope of the gradient.
    #[error(
        "the Hessian by {} of vertex {} and {} of vertex {} is {given:e} N/m, but differences of the \
         gradient are {expected:e} N/m",
        axis_name(.axes[0]), .vertices[0], axis_name(.axes[1]), .vertices[1]
    )]
    Hessian {
        /// The vertices of the row and of the column.
        vertices: [usize; 2],
        /// Their axes: 0 for x, 1 for y, 2 for z.
        axes: [usize; 2],
        /// The entry [N/m].
        given: f64,
        /// The finite difference that is nearest to it [N/m].
        expected: f64,
    },
    /// A block of the Hessian on the diagonal is not symmetric.
    #[error("the Hessian by vertex {vertex} alone is not symmetric")]
    Asymmetric {
        /// The vertex.
        vertex: usize,
    },
    /// The element says that rigid motions do not change its energy, but they do.
    #[error("is_invariant is true, but rigid motions change the energy, by {change:e} of its usual size")]
    NotInvariant {
        /// See [`DerivativeErrors::rigid_motion`].
        change: f64,
    },
    /// The element says that its Hessian is positive semidefinite, but it is not.
    #[error(
        "is_positive_semidefinite is true, but the Hessian has an eigenvalue of {eigenvalue:e} times its \
         largest entry"
    )]
    Indefinite {
        /// See [`DerivativeErrors::smallest_eigenvalue`].
        eigenvalue: f64,
    },
}

fn axis_name(axis: usize) -> char {
    ['x', 'y', 'z'].get(axis).copied().unwrap_or('?')
}

/// Compares gradient and Hessian of an element at `x` [m], one entry per vertex of it, with central finite
/// differences, and what it says of itself with what it does there. Meant for tests: call it at several
/// states, but not at a kink of the law.
///
/// # Errors
/// What is wrong, with the entry that is farthest off.
pub fn check_derivatives(
    element: &dyn CustomElement,
    x: &[Point],
) -> Result<DerivativeErrors, DerivativeProblem> {
    let count = element.vertices().len();
    if x.len() != count || !(1..=MAX_ELEMENT_VERTICES).contains(&count) {
        return Err(DerivativeProblem::Count { given: x.len(), vertices: count });
    }
    let here = State::at(element, x)?;
    let size = size(x);
    let largest = |vectors: &[Vector]| vectors.iter().map(Vector::amax).fold(0.0, f64::max);
    let stiffness = here.blocks.iter().map(Matrix3::amax).fold(0.0, f64::max);
    let force = largest(&here.gradient).max(SMALL * stiffness * size);
    let stiffness = stiffness.max(SMALL * force / size);
    let energy = here.energy.abs().max(force * size);
    // Where all derivatives are zero, any difference is too large.
    let relative = |error: f64, scale: f64| if error > 0.0 { error / scale } else { 0.0 };

    let (gradient, problem) = compare(count, |k, h| {
        let [plus, minus] = [h, -h].map(|h| element.energy(&moved(x, k, h * size)));
        (vec![(plus - minus) / (2.0 * h * size)], vec![here.gradient[k / 3][k % 3]])
    });
    let gradient = relative(gradient, force);
    if gradient > TOLERANCE {
        let Difference { column, given, expected, .. } = problem;
        return Err(DerivativeProblem::Gradient { vertex: column / 3, axis: column % 3, given, expected });
    }
    let (hessian, problem) = compare(count, |k, h| {
        let [plus, minus] = [h, -h].map(|h| {
            let mut gradient = vec![Vector::zeros(); count];
            element.gradient(&moved(x, k, h * size), &mut gradient);
            gradient
        });
        let slopes =
            (0..3 * count).map(|row| (plus[row / 3][row % 3] - minus[row / 3][row % 3]) / (2.0 * h * size));
        (slopes.collect(), (0..3 * count).map(|row| here.entry(row, k)).collect())
    });
    let hessian = relative(hessian, stiffness);
    if hessian > TOLERANCE {
        let Difference { row, column, given, expected } = problem;
        let (vertices, axes) = ([row / 3, column / 3], [row % 3, column % 3]);
        return Err(DerivativeProblem::Hessian { vertices, axes, given, expected });
    }
    let mut asymmetry: f64 = 0.0;
    for vertex in 0..count {
        let block = here.blocks[vertex * count + vertex];
        let own = relative((block - block.transpose()).amax(), stiffness);
        if own > TOLERANCE {
            return Err(DerivativeProblem::Asymmetric { vertex });
        }
        asymmetry = asymmetry.max(own);
    }
    let change = |x: Vec<Point>| {
        let change = (element.energy(&x) - here.energy).abs();
        if change.is_nan() { f64::INFINITY } else { change }
    };
    let rigid_motion = relative(rigid_motions(x, size).map(change).fold(0.0, f64::max), energy);
    if element.is_invariant() && rigid_motion > ROUNDING {
        return Err(DerivativeProblem::NotInvariant { change: rigid_motion });
    }
    let dense =
        nalgebra::DMatrix::from_fn(3 * count, 3 * count, |i, j| 0.5 * (here.entry(i, j) + here.entry(j, i)));
    let smallest_eigenvalue = dense.symmetric_eigenvalues().min();
    let smallest_eigenvalue = if stiffness > 0.0 { smallest_eigenvalue / stiffness } else { 0.0 };
    if element.is_positive_semidefinite() && smallest_eigenvalue < -ROUNDING {
        return Err(DerivativeProblem::Indefinite { eigenvalue: smallest_eigenvalue });
    }
    Ok(DerivativeErrors { gradient, hessian, asymmetry, rigid_motion, smallest_eigenvalue })
}

/// Energy and derivatives at a state.
struct State {
    energy: f64,
    gradient: Vec<Vector>,
    blocks: Vec<Matrix3<f64>>,
}

impl State {
    fn at(element: &dyn CustomElement, x: &[Point]) -> Result<Self, DerivativeProblem> {
        let not_finite = |quantity: Quantity| DerivativeProblem::NonFinite { quantity: quantity.name() };
        let count = x.len();
        let mut state = Self {
            energy: element.energy(x),
            gradient: vec![Vector::zeros(); count],
            blocks: vec![Matrix3::zeros(); count * count],
        };
        if !state.energy.is_finite() {
            return Err(not_finite(Quantity::Energy));
        }
        derivatives(element, x, &mut state.gradient, &mut state.blocks).map_err(not_finite)?;
        Ok(state)
    }

    /// An entry of the Hessian.
    fn entry(&self, row: usize, column: usize) -> f64 {
        self.blocks[row / 3 * self.gradient.len() + column / 3][(row % 3, column % 3)]
    }
}

/// An entry of a derivative beside the difference that is nearest to it.
#[derive(Clone, Copy, Default)]
struct Difference {
    row: usize,
    column: usize,
    given: f64,
    expected: f64,
}

/// The largest error of entries, and where it is. `column` gives, for a coordinate and a step, the
/// differences and the entries that they are compared with.
fn compare(count: usize, column: impl Fn(usize, f64) -> (Vec<f64>, Vec<f64>)) -> (f64, Difference) {
    let (mut largest, mut worst) = (0.0, Difference::default());
    for k in 0..3 * count {
        let columns = STEPS.map(|h| column(k, h));
        for row in 0..columns[0].1.len() {
            let given = columns[0].1[row];
            let errors =
                columns.iter().map(|(differences, _)| ((differences[row] - given).abs(), differences[row]));
            // What is not a number is not near.
            let (error, expected) = errors
                .fold((f64::INFINITY, f64::NAN), |best, next| if next.0 < best.0 { next } else { best });
            if error > largest {
                (largest, worst) = (error, Difference { row, column: k, given, expected });
            }
        }
    }
    (largest, worst)
}

/// The positions with a coordinate changed.
fn moved(x: &[Point], coordinate: usize, by: f64) -> Vec<Point> {
    let mut x = x.to_vec();
    x[coordinate / 3][coordinate % 3] += by;
    x
}

/// The largest distance between two vertices [m]; that from the origin of a single one, 1 if it is there.
fn size(x: &[Point]) -> f64 {
    let distances = x.iter().enumerate().flat_map(|(k, a)| x[..k].iter().map(move |b| (a - b).norm()));
    let spread = distances.fold(0.0, f64::max);
    let far = x.iter().map(|x| x.coords.norm()).fold(0.0, f64::max);
    [spread, far].into_iter().find(|size| *size > 0.0).unwrap_or(1.0)
}

/// The positions after some rigid motions.
fn rigid_motions(x: &[Point], size: f64) -> impl Iterator<Item = Vec<Point>> {
    let center = x[0];
    let shift = |vector: [f64; 3]| (Vector::zeros(), Vector::from(vector) * size);
    let turn = |vector: [f64; 3]| (Vector::from(vector), Vector::zeros());
    let motions = [
        shift([0.4, 0.0, 0.0]),
        shift([0.0, 0.3, 0.0]),
        shift([0.0, 0.0, -0.5]),
        turn([0.7, 0.0, 0.0]),
        turn([0.0, -0.6, 0.0]),
        turn([0.0, 0.0, 0.8]),
        (Vector::new(0.3, 1.1, -0.4), Vector::new(-0.2, 0.6, 0.1) * size),
    ];
    let displace = move |(turn, shift): (Vector, Vector)| {
        let rotation = Rotation3::new(turn);
        x.iter().map(|x| center + rotation * (x - center) + shift).collect()
    };
    motions.into_iter().map(displace)
}

#[cfg(test)]
mod tests;
