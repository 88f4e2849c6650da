//! Contact rows: one inequality per pair, linearized at the current positions x:
//! s(y) = c(x) + J (y - x) >= 0 [m].

use crate::coloring::Coloring;
use crate::friction::friction_row;
use crate::params::ContactForm;
use crate::{face, volume};
use bowknot_geometry::{PairKind, Point, Separation, Vector};
use bowknot_lcp::{FrictionRow, LcpProblem, Row, Schedule};
use bowknot_proximity::PairList;
use rayon::prelude::*;

/// The row of one pair with contact distance `delta` [m].
///
/// Gap form: c = n . (sum_k s_k beta_k x_k) - delta, s_k = +1 on side a and -1 on side b, gradients
/// s_k beta_k n. For half-spaces the plane is constant.
pub fn contact_row(
    form: ContactForm,
    kind: PairKind,
    vertices: [u32; 4],
    positions: &[Point],
    separation: &Separation,
    delta: f64,
) -> Row {
    let points = vertices.map(|v| positions[v as usize]);
    let (value, gradients) = match form {
        ContactForm::Volume => volume::row(kind, &points, separation, delta),
        ContactForm::Face => face::row(kind, &points, separation, delta),
        ContactForm::Gap => None,
    }
    .unwrap_or_else(|| {
        let gradients = separation.signed_weights(kind).map(|beta| separation.normal * beta);
        // The forward step can use no more than the slab. Where the normal is not that of the closest points,
        // the slab is narrower than the computed distance.
        (separation.distance.min(separation.width.max(0.0)) - delta, gradients)
    });
    let linear: f64 = gradients.iter().zip(&points).map(|(g, x)| g.dot(&x.coords)).sum();
    Row::new(vertices, gradients, value - linear)
}

/// Predicted gap [m] of a pair at `y` along its normal at the linearization point: the gap-form value
/// without the contact distance.
#[inline]
pub fn predicted_gap(
    kind: PairKind,
    vertices: &[u32; 4],
    separation: &Separation,
    positions: &[Point],
    y: &[Point],
) -> f64 {
    let beta = separation.signed_weights(kind);
    let mut change = 0.0;
    for k in 0..kind.vertex_count() {
        let v = vertices[k] as usize;
        change += beta[k] * separation.normal.dot(&(y[v] - positions[v]));
    }
    separation.distance.min(separation.width.max(0.0)) + change
}

/// Below this number of rows one thread builds all.
const MIN_PARALLEL: usize = 2048;
/// Rows that one parallel task builds.
const CHUNK: usize = 512;

/// A pair that gets a row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SelectedPair {
    /// Index of the pair in the pair list.
    pub pair: u32,
    /// The distance that its row asks for [m].
    pub delta: f64,
}

/// Contact rows in the order in which they are swept. They are refilled in every backward step and keep their
/// buffers.
///
/// Rows of one color share no movable vertex. The order is for convergence as much as for threads: in the
/// order of the pair list, or of clusters of 128 of its rows, few sweeps leave a bias along the mesh, and
/// three layers of cloth that stick to a slope creep 140 times as far.
#[derive(Clone, Debug, Default)]
pub struct ContactRows {
    /// Index of each row's pair in the pair list.
    pub pair: Vec<u32>,
    /// The rows.
    pub rows: Vec<Row>,
    /// Friction rows of the contacts that have friction, in the order of their normals' rows.
    pub friction: Vec<FrictionRow>,
    /// Index of the friction row of each row, or [`LcpProblem::NO_FRICTION`]. Empty: no contact has friction.
    pub friction_of: Vec<u32>,
    coloring: Coloring,
    /// The pairs in the order of the rows.
    ordered: Vec<SelectedPair>,
}

impl ContactRows {
    /// Fills in the rows of the `selected` pairs, which are in the order of the list. `movable[v]` tells
    /// which vertices a row may move; only they count for colors. Rows are not prepared yet, see
    /// [`bowknot_lcp::prepare_rows`].
    pub fn fill(
        &mut self,
        form: ContactForm,
        pairs: &PairList,
        separations: &[Separation],
        positions: &[Point],
        movable: &[bool],
        selected: &[SelectedPair],
    ) {
        self.order(pairs, movable, selected);
        self.pair.clear();
        self.pair.extend(self.ordered.iter().map(|selected| selected.pair));
        self.rows.resize(selected.len(), Row::new([0; 4], [Vector::zeros(); 4], 0.0));
        let all = pairs.pairs();
        let build = |(row, selected): (&mut Row, &SelectedPair)| {
            let p = selected.pair as usize;
            let (kind, vertices) = (pairs.kind(p), all[p].vertices);
            *row = contact_row(form, kind, vertices, positions, &separations[p], selected.delta);
        };
        if self.rows.len() < MIN_PARALLEL {
            self.rows.iter_mut().zip(&self.ordered).for_each(build);
        } else {
            let chunks = self.rows.par_chunks_mut(CHUNK).zip(self.ordered.par_chunks(CHUNK));
            chunks.for_each(|(rows, selected)| rows.iter_mut().zip(selected).for_each(build));
        }
    }

    /// Orders the selected pairs by color.
    fn order(&mut self, pairs: &PairList, movable: &[bool], selected: &[SelectedPair]) {
        let all = pairs.pairs();
        self.coloring.first_fit(movable.len(), selected.len(), |r| {
            let pair = selected[r].pair as usize;
            let vertices = all[pair].vertices.into_iter().take(pairs.kind(pair).vertex_count());
            vertices.filter(|&v| movable[v as usize])
        });
        self.ordered.clear();
        self.ordered.extend(self.coloring.order().iter().map(|&row| selected[row as usize]));
    }

    /// Adds friction rows to the rows of pairs whose entry in `coefficients` is above 0. Slip is measured
    /// from the positions `start`. Without entries, or if all are 0, there are no friction rows.
    pub fn fill_friction(
        &mut self,
        pairs: &PairList,
        separations: &[Separation],
        start: &[Point],
        coefficients: &[f64],
    ) {
        self.friction_of.clear();
        if coefficients.is_empty() {
            self.friction.clear();
            return;
        }
        let mut count = 0;
        self.friction_of.extend(self.pair.iter().map(|&p| {
            if coefficients[p as usize] > 0.0 {
                count += 1;
                count - 1
            } else {
                LcpProblem::NO_FRICTION
            }
        }));
        self.friction.resize(count as usize, BLANK);
        if count == 0 {
            self.friction_of.clear();
            return;
        }
        let rows = (&self.rows, &self.pair);
        let build = |row: usize| {
            let p = rows.1[row] as usize;
            let vertices = rows.0[row].vertices;
            friction_row(pairs.kind(p), vertices, start, &separations[p], coefficients[p], row as u32)
        };
        let rubbing = self.friction_of.iter().enumerate().filter(|(_, f)| **f != LcpProblem::NO_FRICTION);
        self.friction.iter_mut().zip(rubbing).for_each(|(friction, (row, _))| friction.normal = row as u32);
        if self.rows.len() < MIN_PARALLEL {
            self.friction.iter_mut().for_each(|friction| *friction = build(friction.normal as usize));
        } else {
            self.friction.par_chunks_mut(CHUNK).for_each(|friction| {
                friction.iter_mut().for_each(|friction| *friction = build(friction.normal as usize));
            });
        }
    }

    /// The order in which the rows are swept.
    pub fn schedule(&self) -> Schedule<'_> {
        Schedule::colored(self.coloring.starts())
    }

    /// Number of colors.
    pub fn color_count(&self) -> usize {
        self.coloring.color_count()
    }
}

/// A friction row that is not filled in yet.
const BLANK: FrictionRow = FrictionRow {
    tangents: [Vector::new(0.0, 0.0, 0.0); 2],
    coefficients: [0.0; 4],
    offsets: [0.0; 2],
    vertices: [0; 4],
    friction: 0.0,
    inverse_diagonal: f64::NAN,
    normal: 0,
};
