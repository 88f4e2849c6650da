//! The constraints: linear inequalities, limits on distances, and friction.

use crate::error::LcpError;
use crate::vector::{TangentVector, Vector};
use rayon::prelude::*;
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

/// A linear inequality over up to four nodes: s = offset + sum_k gradients\[k\] . y\[vertices\[k\]\] >= 0.
///
/// A row has 136 bytes; a sweep reads the rows once from front to back. They are stored as an array of
/// structs, because a sweep needs every field and an active list skips rows. One array per field is 3 %
/// slower even without skipping.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Row {
    /// Derivative of the value by each node's position.
    pub gradients: [Vector; 4],
    /// The nodes. Unused places repeat one of the row's own nodes, with a zero gradient.
    pub vertices: [u32; 4],
    /// Value at y = 0.
    pub offset: f64,
    /// Largest multiplier; infinite for a hard row.
    pub upper: f64,
    /// 1 / sum over nodes of w |gradient|^2, 0 if no node can move. [`prepare_rows`] fills it.
    pub inverse_diagonal: f64,
}

impl Row {
    /// A hard row, to be prepared with [`Row::prepare`] or [`prepare_rows`].
    pub fn new(vertices: [u32; 4], gradients: [Vector; 4], offset: f64) -> Self {
        Self { gradients, vertices, offset, upper: f64::INFINITY, inverse_diagonal: f64::NAN }
    }

    /// Computes the inverse diagonal. The gradients of a node that the row names several times are added up.
    /// Call it again whenever gradients or weights change.
    ///
    /// # Errors
    /// [`LcpError::UnknownNode`], with index 0, if a node has no weight.
    #[inline]
    pub fn prepare(&mut self, weights: &[f64]) -> Result<(), LcpError> {
        check_nodes(self, weights.len())?;
        self.inverse_diagonal = invert(self.diagonal(|node| weights[node as usize]));
        Ok(())
    }

    /// Sum over nodes of weight |gradient|^2.
    #[inline]
    pub(crate) fn diagonal(&self, weight: impl Fn(u32) -> f64) -> f64 {
        let [a, b, c, d] = self.vertices;
        let distinct = (a != b) & (a != c) & (a != d) & (b != c) & (b != d) & (c != d);
        let mut diagonal = 0.0;
        for k in 0..4 {
            let mut square = self.gradients[k].norm_squared();
            if !distinct {
                // |sum of a node's gradients|^2 is a sum over the pairs of its places.
                for j in 0..k {
                    if self.vertices[j] == self.vertices[k] {
                        square += 2.0 * self.gradients[k].dot(&self.gradients[j]);
                    }
                }
            }
            diagonal += weight(self.vertices[k]) * square;
        }
        diagonal
    }

    /// The row's value s at the positions `y`.
    ///
    /// # Panics
    /// If a node is out of range.
    #[inline]
    pub fn value(&self, y: &[Vector]) -> f64 {
        (0..4).fold(self.offset, |s, k| s + self.gradients[k].dot(&y[self.vertices[k] as usize]))
    }
}

/// A limit on the distance between two nodes: |y_a - y_b| <= limit. Its multiplier is a vector.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[repr(C)]
pub struct DistanceLimit {
    /// The nodes a and b.
    pub vertices: [u32; 2],
    /// Largest distance.
    pub limit: f64,
}

/// Friction of one contact. A multiplier opposes the slip, which is sum_k coefficients\[k\]
/// y\[vertices\[k\]\] along two tangents. It is bounded by `friction` times the multiplier of row `normal`.
///
/// The inverse weight of a node is one number. So both tangents have the same diagonal and do not couple, and
/// projecting onto the disc solves the two components exactly.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct FrictionRow {
    /// Two orthonormal tangents.
    pub tangents: [Vector; 2],
    /// Factor of each node's position in the slip: barycentric weights, negative on one side.
    pub coefficients: [f64; 4],
    /// Slip along each tangent at y = 0; usually minus the slip at the start of the step.
    pub offsets: [f64; 2],
    /// The nodes. Unused places repeat one of the row's own nodes, with coefficient 0.
    pub vertices: [u32; 4],
    /// Coefficient of friction mu.
    pub friction: f64,
    /// 1 / sum over nodes of w coefficient^2, 0 if no node can move. [`prepare_friction`] fills it.
    pub inverse_diagonal: f64,
    /// Index of the normal's row.
    pub normal: u32,
}

impl FrictionRow {
    /// Computes the inverse diagonal, as [`Row::prepare`].
    ///
    /// # Errors
    /// [`LcpError::UnknownNode`], with index 0, if a node has no weight.
    #[inline]
    pub fn prepare(&mut self, weights: &[f64]) -> Result<(), LcpError> {
        check_nodes(self, weights.len())?;
        self.inverse_diagonal = invert(self.diagonal(|node| weights[node as usize]));
        Ok(())
    }

    /// Sum over nodes of weight coefficient^2.
    pub(crate) fn diagonal(&self, weight: impl Fn(u32) -> f64) -> f64 {
        let mut diagonal = 0.0;
        for k in 0..4 {
            let mut square = self.coefficients[k] * self.coefficients[k];
            for j in 0..k {
                if self.vertices[j] == self.vertices[k] {
                    square += 2.0 * self.coefficients[k] * self.coefficients[j];
                }
            }
            diagonal += weight(self.vertices[k]) * square;
        }
        diagonal
    }

    /// The slip along both tangents at the positions `y`.
    ///
    /// # Panics
    /// If a node is out of range.
    #[inline]
    pub fn slip(&self, y: &[Vector]) -> TangentVector {
        let point = self.point(y);
        TangentVector::new(
            self.offsets[0] + self.tangents[0].dot(&point),
            self.offsets[1] + self.tangents[1].dot(&point),
        )
    }

    /// sum_k coefficients\[k\] y\[vertices\[k\]\]; its motion is the slip.
    pub(crate) fn point(&self, y: &[Vector]) -> Vector {
        (0..4).fold(Vector::zeros(), |sum, k| sum + self.coefficients[k] * y[self.vertices[k] as usize])
    }

    /// The multipliers as a vector.
    #[inline(always)]
    pub fn direction(&self, multipliers: TangentVector) -> Vector {
        self.tangents[0] * multipliers.x + self.tangents[1] * multipliers.y
    }
}

fn check_nodes<T: Constraint>(item: &T, nodes: usize) -> Result<(), LcpError> {
    match item.nodes().iter().find(|&&v| v as usize >= nodes) {
        Some(&node) => Err(LcpError::UnknownNode { constraint: T::NAME, index: 0, node, nodes }),
        None => Ok(()),
    }
}

/// 1 / diagonal, and 0 where that would not be finite: such a row moves nothing. A gradient so small that its
/// diagonal is not a normal number gives no direction.
pub(crate) fn invert(diagonal: f64) -> f64 {
    if diagonal >= f64::MIN_POSITIVE { 1.0 / diagonal } else { 0.0 }
}

/// Computes the inverse diagonals of all rows, see [`Row::prepare`].
///
/// # Errors
/// [`LcpError::UnknownNode`] if a node has no weight.
pub fn prepare_rows(rows: &mut [Row], weights: &[f64]) -> Result<(), LcpError> {
    prepare_all(rows, |row| row.prepare(weights))
}

/// Computes the inverse diagonals of all friction rows, see [`FrictionRow::prepare`].
///
/// # Errors
/// [`LcpError::UnknownNode`] if a node has no weight.
pub fn prepare_friction(rows: &mut [FrictionRow], weights: &[f64]) -> Result<(), LcpError> {
    prepare_all(rows, |row| row.prepare(weights))
}

fn prepare_all<T: Send>(
    rows: &mut [T],
    prepare: impl Fn(&mut T) -> Result<(), LcpError> + Sync,
) -> Result<(), LcpError> {
    // In chunks: returning a `Result` from every row costs more than the row itself.
    const CHUNK: usize = 1024;
    rows.par_chunks_mut(CHUNK).enumerate().try_for_each(|(chunk, rows)| {
        for (index, item) in rows.iter_mut().enumerate() {
            prepare(item).map_err(|error| match error {
                LcpError::UnknownNode { constraint, node, nodes, .. } => {
                    LcpError::UnknownNode { constraint, index: CHUNK * chunk + index, node, nodes }
                }
                other => other,
            })?;
        }
        Ok(())
    })
}

/// What the three types of constraints have in common.
pub(crate) trait Constraint: Copy {
    /// Name in messages.
    const NAME: &'static str;
    /// The nodes, as stored.
    fn nodes(&self) -> &[u32];
    /// Whether the inverse diagonal, if there is one, was computed.
    fn prepared(&self) -> bool {
        true
    }
}

impl Constraint for Row {
    const NAME: &'static str = "row";
    fn nodes(&self) -> &[u32] {
        &self.vertices
    }
    fn prepared(&self) -> bool {
        !self.inverse_diagonal.is_nan()
    }
}

impl Constraint for DistanceLimit {
    const NAME: &'static str = "distance limit";
    fn nodes(&self) -> &[u32] {
        &self.vertices
    }
}

impl Constraint for FrictionRow {
    const NAME: &'static str = "friction row";
    fn nodes(&self) -> &[u32] {
        &self.vertices
    }
    fn prepared(&self) -> bool {
        !self.inverse_diagonal.is_nan()
    }
}
