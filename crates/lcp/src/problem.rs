//! The borrowed view of a problem: rows, their schedules, inverse weights, and the moving state.
//!
//! The problem is the projection of node positions y_free onto constraints, in the metric of the
//! weights (inverse weights w, 0 for a node that cannot move):
//!
//! ```text
//! y = y_free + W (J^T lambda + forces of ball rows + friction)
//! row:       s = b + sum_k g_k . y_k,   0 <= lambda <= upper,   lambda complementary to s
//! ball row:  |y_a - y_b| <= L
//! friction:  |lambda_t| <= mu lambda_n, opposing the slip
//! ```

use crate::{Error, Vector};
use nalgebra::Vector2;
use rayon::prelude::*;

/// A linear inequality over up to four nodes: s = offset + sum_k gradients\[k\] . y\[vertices\[k\]\] >= 0.
///
/// 136 bytes, read once a sweep from front to back. One struct a row, because a sweep needs all of it and
/// an active list skips rows; one array a field was 3 % slower even without skipping.
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

    /// Computes the inverse diagonal, adding up the gradients of a node that stands in several
    /// places. Call it again whenever gradients or weights change.
    ///
    /// # Errors
    /// [`Error::UnknownNode`], with row 0, if a node has no weight.
    #[inline]
    pub fn prepare(&mut self, weights: &[f64]) -> Result<(), Error> {
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

/// A limit on the distance of two nodes: |y_a - y_b| <= limit. Its multiplier is a vector.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct BallRow {
    /// The nodes a and b.
    pub vertices: [u32; 2],
    /// Largest distance.
    pub limit: f64,
}

/// Friction of one contact: the slip sum_k coefficients\[k\] y\[vertices\[k\]\] along two tangents is
/// opposed by a multiplier bounded by `friction` times that of row `normal`.
///
/// Because inverse weights are one number a node, both tangents have the same diagonal and do not
/// couple, so that projecting onto the disc solves the pair exactly.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct FrictionRow {
    /// Two orthonormal tangents.
    pub tangents: [Vector; 2],
    /// Factor of each node's position in the slip (barycentric weights, one side negative).
    pub coefficients: [f64; 4],
    /// Slip along each tangent at y = 0: minus the slip of the start of the step, as a rule.
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
    /// [`Error::UnknownNode`], with row 0, if a node has no weight.
    #[inline]
    pub fn prepare(&mut self, weights: &[f64]) -> Result<(), Error> {
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
    pub fn slip(&self, y: &[Vector]) -> Vector2<f64> {
        let point = self.point(y);
        Vector2::new(
            self.offsets[0] + self.tangents[0].dot(&point),
            self.offsets[1] + self.tangents[1].dot(&point),
        )
    }

    /// sum_k coefficients\[k\] y\[vertices\[k\]\], whose motion is the slip.
    pub(crate) fn point(&self, y: &[Vector]) -> Vector {
        (0..4).fold(Vector::zeros(), |sum, k| sum + self.coefficients[k] * y[self.vertices[k] as usize])
    }

    /// The multipliers as a vector.
    #[inline(always)]
    pub fn direction(&self, multipliers: Vector2<f64>) -> Vector {
        self.tangents[0] * multipliers.x + self.tangents[1] * multipliers.y
    }
}

fn check_nodes<T: AnyRow>(row: &T, nodes: usize) -> Result<(), Error> {
    match row.nodes().iter().find(|&&v| v as usize >= nodes) {
        Some(&node) => Err(Error::UnknownNode { family: T::NAME, row: 0, node, nodes }),
        None => Ok(()),
    }
}

/// 1/x, and 0 for what cannot be inverted: such a row moves nothing. The smallest normal number
/// keeps the result finite; a gradient that small is no direction.
pub(crate) fn invert(diagonal: f64) -> f64 {
    if diagonal >= f64::MIN_POSITIVE { 1.0 / diagonal } else { 0.0 }
}

/// Computes the inverse diagonals of all rows, see [`Row::prepare`].
///
/// # Errors
/// [`Error::UnknownNode`] if a node has no weight.
pub fn prepare_rows(rows: &mut [Row], weights: &[f64]) -> Result<(), Error> {
    prepare_all(rows, |row| row.prepare(weights))
}

/// Computes the inverse diagonals of all friction rows, see [`FrictionRow::prepare`].
///
/// # Errors
/// [`Error::UnknownNode`] if a node has no weight.
pub fn prepare_friction(rows: &mut [FrictionRow], weights: &[f64]) -> Result<(), Error> {
    prepare_all(rows, |row| row.prepare(weights))
}

fn prepare_all<T: Send>(
    rows: &mut [T],
    prepare: impl Fn(&mut T) -> Result<(), Error> + Sync,
) -> Result<(), Error> {
    // Chunks rather than single rows: passing a `Result` from row to row costs more than the row does.
    const CHUNK: usize = 1024;
    rows.par_chunks_mut(CHUNK).enumerate().try_for_each(|(chunk, rows)| {
        for (index, item) in rows.iter_mut().enumerate() {
            prepare(item).map_err(|error| match error {
                Error::UnknownNode { family, node, nodes, .. } => {
                    Error::UnknownNode { family, row: CHUNK * chunk + index, node, nodes }
                }
                other => other,
            })?;
        }
        Ok(())
    })
}

/// Which rows are swept, in which order, and which of them are independent.
///
/// Colour c holds the places `starts[c]..starts[c + 1]` of `order`, or of the rows themselves
/// where `order` is `None`. No two rows of a colour may share a node that can move
/// ([`crate::validate_colours`] checks it): a colour is swept in parallel. Rows that `order` leaves
/// out are not swept: that is how inactive rows cost nothing. Rows stored by colour, and in spatial order
/// within it, with a rising `order`, are read fastest and keep each thread to its part of the nodes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Schedule<'a> {
    /// Indices of the rows to sweep; `None`: all, as stored.
    pub order: Option<&'a [u32]>,
    /// Where each colour starts, and the end; empty: no colours, always one row after the other.
    pub starts: &'a [u32],
}

impl<'a> Schedule<'a> {
    /// All rows, as stored, one after the other.
    pub const SERIAL: Schedule<'static> = Schedule { order: None, starts: &[] };

    /// All rows, stored by colour.
    pub fn coloured(starts: &'a [u32]) -> Self {
        Self { order: None, starts }
    }

    /// The rows of `order`, colour c in `order[starts[c]..starts[c + 1]]`.
    pub fn active(order: &'a [u32], starts: &'a [u32]) -> Self {
        Self { order: Some(order), starts }
    }

    /// Row at a place of the order.
    #[inline]
    pub(crate) fn row(&self, place: usize) -> usize {
        match self.order {
            Some(order) => order[place] as usize,
            None => place,
        }
    }
}

/// Rows of one family with their schedule.
#[derive(Clone, Copy, Debug)]
pub struct Family<'a, T> {
    /// The rows.
    pub rows: &'a [T],
    /// How they are swept.
    pub schedule: Schedule<'a>,
}

impl<'a, T> Family<'a, T> {
    /// Rows with their schedule.
    pub fn new(rows: &'a [T], schedule: Schedule<'a>) -> Self {
        Self { rows, schedule }
    }

    /// Rows swept one after the other.
    pub fn serial(rows: &'a [T]) -> Self {
        Self { rows, schedule: Schedule::SERIAL }
    }

    /// How many rows a sweep visits.
    pub fn swept(&self) -> usize {
        self.schedule.order.map_or(self.rows.len(), <[u32]>::len)
    }
}

impl<T> Default for Family<'_, T> {
    fn default() -> Self {
        Self { rows: &[], schedule: Schedule::SERIAL }
    }
}

/// What the three kinds of rows have in common.
pub(crate) trait AnyRow: Copy {
    const NAME: &'static str;
    fn nodes(&self) -> &[u32];
    fn prepared(&self) -> bool {
        true
    }
}

impl AnyRow for Row {
    const NAME: &'static str = "row";
    fn nodes(&self) -> &[u32] {
        &self.vertices
    }
    fn prepared(&self) -> bool {
        !self.inverse_diagonal.is_nan()
    }
}

impl AnyRow for BallRow {
    const NAME: &'static str = "ball row";
    fn nodes(&self) -> &[u32] {
        &self.vertices
    }
}

impl AnyRow for FrictionRow {
    const NAME: &'static str = "friction row";
    fn nodes(&self) -> &[u32] {
        &self.vertices
    }
    fn prepared(&self) -> bool {
        !self.inverse_diagonal.is_nan()
    }
}

/// A checked problem: every index is in range, every row prepared, every weight finite.
///
/// A sweep visits the ball rows first, then the rows, then friction, so that the rows (contacts)
/// are those left least violated. [`Problem::attach_friction`] brings each friction row to its normal's row.
#[derive(Clone, Copy, Debug)]
pub struct Problem<'a> {
    weights: &'a [f64],
    rows: Family<'a, Row>,
    balls: Family<'a, BallRow>,
    friction: Family<'a, FrictionRow>,
    /// Friction row of each row, or nothing.
    attached: &'a [u32],
}

impl<'a> Problem<'a> {
    /// The entry of [`Self::attach_friction`] for a row without friction.
    pub const NO_FRICTION: u32 = u32::MAX;

    /// Checks and keeps the parts. `weights[i]` >= 0 is the inverse weight of node i. Cost: one pass
    /// over the indices; colours are not checked, see [`crate::validate_colours`].
    ///
    /// # Errors
    /// What the first fault is: [`Error::Weight`], [`Error::UnknownNode`], [`Error::UnknownNormal`],
    /// [`Error::NotPrepared`], [`Error::Starts`], [`Error::Order`].
    pub fn new(
        weights: &'a [f64],
        rows: Family<'a, Row>,
        balls: Family<'a, BallRow>,
        friction: Family<'a, FrictionRow>,
    ) -> Result<Self, Error> {
        if let Some(node) = weights.iter().position(|w| !(w.is_finite() && *w >= 0.0)) {
            return Err(Error::Weight { node, value: weights[node] });
        }
        check_family(&rows, weights.len())?;
        check_family(&balls, weights.len())?;
        check_family(&friction, weights.len())?;
        match friction.rows.iter().position(|f| f.normal as usize >= rows.rows.len()) {
            Some(row) => {
                let normal = friction.rows[row].normal;
                Err(Error::UnknownNormal { row, normal, rows: rows.rows.len() })
            }
            None => Ok(Self { weights, rows, balls, friction, attached: &[] }),
        }
    }

    /// Makes Gauss-Seidel sweeps visit each friction row right after its normal's row, in place of all friction rows
    /// after all rows: the rows of one contact are solved together. `friction_of` names the friction row of each row, or
    /// [`Self::NO_FRICTION`]; the schedule of the friction rows is then that of their normals. Colours stay valid,
    /// because a friction row has the nodes of its normal's row.
    ///
    /// # Errors
    /// [`Error::Length`]; [`Error::Attached`] for a friction row that does not exist, has another normal, or moves a node
    /// that its normal's row does not have.
    pub fn attach_friction(mut self, friction_of: &'a [u32]) -> Result<Self, Error> {
        let rows = self.rows.rows;
        if friction_of.len() != rows.len() {
            return Err(Error::Length {
                what: "friction_of",
                given: friction_of.len(),
                expected: rows.len(),
            });
        }
        for (row, &friction) in friction_of.iter().enumerate().filter(|(_, f)| **f != Self::NO_FRICTION) {
            let fits = self.friction.rows.get(friction as usize).is_some_and(|f| {
                let nodes = &rows[row].vertices;
                let moved = |v: &&u32| self.weights[**v as usize] != 0.0;
                f.normal as usize == row && f.vertices.iter().filter(moved).all(|v| nodes.contains(v))
            });
            if !fits {
                return Err(Error::Attached { row, friction });
            }
        }
        self.attached = friction_of;
        Ok(self)
    }

    /// What [`Self::attach_friction`] was given; empty: friction rows have their own schedule.
    pub fn attached(&self) -> &'a [u32] {
        self.attached
    }

    /// Inverse weights, one a node.
    pub fn weights(&self) -> &'a [f64] {
        self.weights
    }

    /// The rows.
    pub fn rows(&self) -> Family<'a, Row> {
        self.rows
    }

    /// The ball rows.
    pub fn balls(&self) -> Family<'a, BallRow> {
        self.balls
    }

    /// The friction rows.
    pub fn friction(&self) -> Family<'a, FrictionRow> {
        self.friction
    }
}

fn check_family<T: AnyRow>(family: &Family<'_, T>, nodes: usize) -> Result<(), Error> {
    let (name, count) = (T::NAME, family.rows.len());
    for (row, item) in family.rows.iter().enumerate() {
        if let Some(&node) = item.nodes().iter().find(|&&v| v as usize >= nodes) {
            return Err(Error::UnknownNode { family: name, row, node, nodes });
        }
        if !item.prepared() {
            return Err(Error::NotPrepared { family: name, row });
        }
    }
    let Schedule { order, starts } = family.schedule;
    if let Some(&index) = order.unwrap_or_default().iter().find(|&&r| r as usize >= count) {
        return Err(Error::Order { family: name, index, rows: count });
    }
    let expected = family.swept();
    let rising = starts.windows(2).all(|w| w[0] <= w[1]);
    let spans = starts.first() == Some(&0) && starts.last().map(|&end| end as usize) == Some(expected);
    if starts.is_empty() || (rising && spans) {
        Ok(())
    } else {
        Err(Error::Starts { family: name, expected })
    }
}

/// The moving part of a problem. The solvers keep `y` consistent with the multipliers:
/// y = y_free + what the multipliers do ([`crate::apply_multipliers`]).
#[derive(Debug, Default)]
pub struct State<'a> {
    /// Node positions.
    pub y: &'a mut [Vector],
    /// Multiplier of each row.
    pub lambda: &'a mut [f64],
    /// Multiplier of each ball row: node a is pulled by -f, node b by +f, so that f points from b to
    /// a where the limit acts; its norm is the scalar multiplier.
    pub forces: &'a mut [Vector],
    /// Multipliers of each friction row along its tangents.
    pub friction: &'a mut [Vector2<f64>],
}

impl State<'_> {
    /// Refuses arrays that do not fit the problem.
    pub(crate) fn check(&self, problem: &Problem<'_>) -> Result<(), Error> {
        let check = |what, given: usize, expected: usize| match given == expected {
            true => Ok(()),
            false => Err(Error::Length { what, given, expected }),
        };
        check("y", self.y.len(), problem.weights.len())?;
        check("lambda", self.lambda.len(), problem.rows.rows.len())?;
        check("forces", self.forces.len(), problem.balls.rows.len())?;
        check("friction", self.friction.len(), problem.friction.rows.len())
    }

    /// The same state, borrowed anew.
    pub fn reborrow(&mut self) -> State<'_> {
        State { y: self.y, lambda: self.lambda, forces: self.forces, friction: self.friction }
    }
}
