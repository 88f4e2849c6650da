//! What a custom element is: an energy of the positions of a few vertices, with its derivatives.

use bowknot_geometry::{Point, Vector};
use nalgebra::Matrix3;
use std::fmt::Debug;
use std::sync::Arc;

/// The most vertices that a custom element may have.
pub const MAX_ELEMENT_VERTICES: usize = 16;

/// An energy V of the positions of a few vertices, from outside: a spring, a magnet, a triangle of your own
/// material.
///
/// Time steps minimize the sum of all energies. They need V, its gradient and its Hessian, which must fit
/// each other: [`check_derivatives`](super::check_derivatives) compares them by finite differences. The force
/// on a vertex is minus the gradient.
///
/// V may be any smooth function. Where it is not defined, as behind a barrier, let [`Self::energy`] return
/// `f64::INFINITY`: a line search then takes a shorter step. At the states that a time step passes through,
/// energy, gradient and Hessian must be finite; otherwise the step ends with
/// [`StepError::CustomElement`](crate::StepError::CustomElement).
///
/// A law may change from one time step to the next but not within one: replace the elements
/// ([`Dynamics::replace_elements`](crate::Dynamics::replace_elements)), or let them read a value that only
/// changes between time steps. Results have the same bits for any number of threads if each method is a
/// function of its arguments.
pub trait CustomElement: Debug + Send + Sync {
    /// Its vertices, by their numbers in the scene: 1 to [`MAX_ELEMENT_VERTICES`], each once and none of an
    /// obstacle. They must not change.
    fn vertices(&self) -> &[u32];

    /// V [J] at `x` [m], which has one entry per vertex of the element, in its order.
    fn energy(&self, x: &[Point]) -> f64;

    /// Sets the gradient of V [N] at `x` [m]; both have one entry per vertex. It is zero at the call.
    fn gradient(&self, x: &[Point], gradient: &mut [Vector]);

    /// Adds the blocks of the Hessian of V [N/m] at `x` [m] to a matrix that is zero at the call. Leave
    /// negative curvature in: it is taken away later.
    fn hessian(&self, x: &[Point], hessian: &mut ElementMatrix<'_>);

    /// Whether the Hessian is positive semidefinite wherever it is computed. If true, no time is spent on a
    /// decomposition that would take negative curvature away.
    fn is_positive_semidefinite(&self) -> bool {
        false
    }

    /// Whether V stays the same where all of its vertices move as a rigid body, as that of a spring between
    /// two vertices does. Time steps then conserve the linear and angular momentum of free bodies to
    /// rounding. An energy that depends on a place or a direction in space, such as that of a magnet, exerts
    /// outer forces: leave this false.
    fn is_invariant(&self) -> bool {
        false
    }
}

/// The Hessian of a custom element, in 3 x 3 blocks. Indices count the element's vertices from 0.
#[derive(Debug)]
pub struct ElementMatrix<'a> {
    count: usize,
    /// Blocks (a, b) at a * count + b.
    blocks: &'a mut [Matrix3<f64>],
}

impl<'a> ElementMatrix<'a> {
    /// A matrix for an element of `count` vertices over its blocks, row by row: an element that is made of another
    /// one, or a test of one, asks it for its Hessian with this.
    ///
    /// ```
    /// use bowknot_dynamics::ElementMatrix;
    /// use bowknot_dynamics::geometry::nalgebra::Matrix3;
    ///
    /// let mut blocks = [Matrix3::zeros(); 4];
    /// ElementMatrix::new(2, &mut blocks).add(0, 1, &Matrix3::from_fn(|row, column| (3 * row + column) as f64));
    /// assert_eq!((blocks[1][(0, 2)], blocks[2][(2, 0)]), (2.0, 2.0));
    /// ```
    ///
    /// # Panics
    /// There is not one block per pair of vertices.
    pub fn new(count: usize, blocks: &'a mut [Matrix3<f64>]) -> Self {
        assert_eq!(
            blocks.len(),
            count * count,
            "an element of {count} vertices has one block per pair of them"
        );
        Self { count, blocks }
    }

    /// Number of vertices.
    pub fn count(&self) -> usize {
        self.count
    }

    /// Adds the block of second derivatives by vertex `a` (rows) and vertex `b` (columns) [N/m], and its
    /// transpose to block (b, a) if they differ. So add each pair once.
    ///
    /// # Panics
    /// The element has no vertex `a` or `b`.
    pub fn add(&mut self, a: usize, b: usize, block: &Matrix3<f64>) {
        assert!(
            a < self.count && b < self.count,
            "an element of {} vertices has no block ({a}, {b})",
            self.count
        );
        self.blocks[a * self.count + b] += block;
        if a != b {
            self.blocks[b * self.count + a] += block.transpose();
        }
    }
}

/// Custom elements that are added, replaced and named in messages together.
#[derive(Clone, Debug)]
pub struct ElementGroup {
    /// Its name.
    pub name: String,
    /// The elements.
    pub elements: Vec<Arc<dyn CustomElement>>,
}

impl ElementGroup {
    /// A group of elements.
    pub fn new(name: impl Into<String>, elements: Vec<Arc<dyn CustomElement>>) -> Self {
        Self { name: name.into(), elements }
    }
}

/// Whether all numbers of vectors are finite.
fn all_finite(vectors: &[Vector]) -> bool {
    vectors.iter().all(|v| v.iter().all(|c| c.is_finite()))
}

/// Computes gradient [N] and Hessian [N/m] of an element, row by row.
///
/// # Errors
/// What is not finite.
pub(super) fn derivatives(
    element: &dyn CustomElement,
    x: &[Point],
    gradient: &mut [Vector],
    blocks: &mut [Matrix3<f64>],
) -> Result<(), Quantity> {
    gradient.fill(Vector::zeros());
    blocks.fill(Matrix3::zeros());
    element.gradient(x, gradient);
    if !all_finite(gradient) {
        return Err(Quantity::Gradient);
    }
    element.hessian(x, &mut ElementMatrix::new(x.len(), blocks));
    if !blocks.iter().all(|block| block.iter().all(|c| c.is_finite())) {
        return Err(Quantity::Hessian);
    }
    Ok(())
}

/// What an element computes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Quantity {
    Energy,
    Gradient,
    Hessian,
}

impl Quantity {
    pub const ALL: [Self; 3] = [Self::Energy, Self::Gradient, Self::Hessian];

    /// Its name, for messages.
    pub fn name(self) -> &'static str {
        match self {
            Self::Energy => "energy",
            Self::Gradient => "gradient",
            Self::Hessian => "Hessian",
        }
    }
}
