//! Contact rows: one inequality per pair, linearized at the current positions x:
//! s(y) = c(x) + J (y - x) >= 0 [m].

use crate::coloring::Coloring;
use crate::friction::friction_row;
use crate::params::ContactForm;
use crate::{face, volume};
use bowknot_geometry::{PairKind, Point, Separation};
use bowknot_lcp::{FrictionRow, LcpProblem, Row};
use bowknot_proximity::PairList;

/// The row of one pair with desired distance `desired` [m].
///
/// Gap form: c = n . (sum_k s_k beta_k x_k) - desired, s_k = +1 on side a and -1 on side b, gradients
/// s_k beta_k n. For half-spaces the plane is constant.
pub fn contact_row(
    form: ContactForm,
    kind: PairKind,
    vertices: [u32; 4],
    positions: &[Point],
    separation: &Separation,
    desired: f64,
) -> Row {
    let points = vertices.map(|v| positions[v as usize]);
    let (value, gradients) = match form {
        ContactForm::Volume => volume::row(kind, &points, separation, desired),
        ContactForm::Face => face::row(kind, &points, separation, desired),
        ContactForm::Gap => None,
    }
    .unwrap_or_else(|| {
        let gradients = separation.signed_weights(kind).map(|beta| separation.normal * beta);
        // The forward step can use no more than the slab. Where the normal is not that of the closest points,
        // the slab is narrower than the computed distance.
        (separation.distance.min(separation.width.max(0.0)) - desired, gradients)
    });
    let linear: f64 = gradients.iter().zip(&points).map(|(g, x)| g.dot(&x.coords)).sum();
    Row::new(vertices, gradients, value - linear)
}

/// Predicted gap [m] of a pair at `y` along its normal at the linearization point: the gap-form value
/// without the desired distance.
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

/// Contact rows in color order. They are refilled in every backward step and keep their buffers.
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
    selected: Vec<u32>,
}

impl ContactRows {
    /// Fills in the rows of the pairs that `keep` accepts, ordered by color. `movable[v]` tells which
    /// vertices a row may move; only they count for colors.
    pub fn fill(
        &mut self,
        form: ContactForm,
        pairs: &PairList,
        separations: &[Separation],
        desired: &[f64],
        positions: &[Point],
        movable: &[bool],
        keep: impl Fn(usize, PairKind) -> bool,
    ) {
        self.selected.clear();
        for kind in PairKind::ALL {
            self.selected.extend(pairs.range(kind).filter(|&p| keep(p, kind)).map(|p| p as u32));
        }
        let all = pairs.pairs();
        let selected = &self.selected;
        self.coloring.first_fit(movable.len(), selected.len(), |r| {
            let pair = selected[r] as usize;
            let kind = pairs.kind(pair);
            all[pair].vertices.into_iter().take(kind.vertex_count()).filter(|&v| movable[v as usize])
        });
        self.pair.clear();
        self.pair.extend(self.coloring.order().iter().map(|&r| selected[r as usize]));
        self.rows.clear();
        self.rows.extend(self.pair.iter().map(|&p| {
            let p = p as usize;
            contact_row(form, pairs.kind(p), all[p].vertices, positions, &separations[p], desired[p])
        }));
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
        self.friction.clear();
        self.friction_of.clear();
        if coefficients.is_empty() {
            return;
        }
        for (row, &p) in self.pair.iter().enumerate() {
            let p = p as usize;
            if coefficients[p] > 0.0 {
                self.friction_of.push(self.friction.len() as u32);
                let vertices = self.rows[row].vertices;
                let (kind, separation) = (pairs.kind(p), &separations[p]);
                let friction = friction_row(kind, vertices, start, separation, coefficients[p], row as u32);
                self.friction.push(friction);
            } else {
                self.friction_of.push(LcpProblem::NO_FRICTION);
            }
        }
        if self.friction.is_empty() {
            self.friction_of.clear();
        }
    }

    /// Where each color starts, and the end.
    pub fn color_starts(&self) -> &[u32] {
        self.coloring.starts()
    }

    /// Number of colors.
    pub fn color_count(&self) -> usize {
        self.coloring.color_count()
    }
}
