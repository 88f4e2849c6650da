//! What an element is: a part of a body over a few nodes, with an energy and its derivatives.

use super::filter::Filter;
use crate::linear::assembly::ElementModel;
use bowknot_geometry::Vector;
use nalgebra::Matrix3;

/// Energy [J] of an element, its gradient [N] and its Hessian [N/m] over the element's nodes.
pub(crate) struct Linearization<const N: usize> {
    pub energy: f64,
    pub gradient: [Vector; N],
    /// Blocks (a, b) for a <= b; the others are their transposes and are not filled in.
    pub hessian: [[Matrix3<f64>; N]; N],
}

impl Linearization<3> {
    /// From the gradients by nodes 1 and 2 and the blocks (1, 1), (1, 2) and (2, 2). Translations store no
    /// energy: the rows of node 0 are minus the sum of the others.
    pub fn of_translations(energy: f64, [f1, f2]: [Vector; 2], [h11, h12, h22]: [Matrix3<f64>; 3]) -> Self {
        let (h01, h02) = (-(h11 + h12.transpose()), -(h12 + h22));
        let (zero, h00) = (Matrix3::zeros(), -(h01 + h02));
        Self {
            energy,
            gradient: [-(f1 + f2), f1, f2],
            hessian: [[h00, h01, h02], [zero, h11, h12], [zero, zero, h22]],
        }
    }
}

/// Number of elements that [`Element::linearize_batch`] takes.
pub(crate) const BATCH: usize = 8;

/// An element over N nodes.
pub(crate) trait Element<const N: usize>: Send + Sync {
    /// The nodes of the element.
    fn nodes(&self) -> [u32; N];

    /// Elastic energy [J] at `x` [m], plus the dissipation potential since `start` if that is given.
    fn energy(&self, x: &[Vector; N], start: Option<Start<'_, N>>) -> f64;

    /// What [`Self::linearize_in`] needs to know of a state, and is computed faster for four elements at
    /// once; `()` if there is nothing like that.
    type Frame: Default;

    /// The frames of four elements at `x`. The frame of each depends on that element alone.
    fn frames(_elements: [&Self; 4], _x: &[[Vector; N]; 4]) -> [Self::Frame; 4] {
        std::array::from_fn(|_| Self::Frame::default())
    }

    /// [`Self::energy`] with gradient and filtered Hessian; `frame` is that at `x`.
    fn linearize_in(
        &self,
        frame: &Self::Frame,
        x: &[Vector; N],
        start: Option<Start<'_, N>>,
        filter: Filter,
    ) -> Linearization<N>;

    /// Calls `visit` with the index of each of the `elements` and with [`Self::linearize_in`] at `x` and `start`
    /// and the `rate` of [`Start`], 0 without damping; in any order. What it is called with for an element depends
    /// on that element alone.
    fn linearize_batch(
        elements: [&Self; BATCH],
        x: &[[Vector; N]; BATCH],
        start: &[[Vector; N]; BATCH],
        rate: f64,
        filter: Filter,
        visit: &mut impl FnMut(usize, &Linearization<N>),
    ) {
        for first in (0..BATCH).step_by(4) {
            let four = std::array::from_fn(|k| elements[first + k]);
            let frames = Self::frames(four, &std::array::from_fn(|k| x[first + k]));
            for (k, frame) in (first..).zip(&frames) {
                let start = (rate > 0.0).then_some(Start { x: &start[k], rate });
                visit(k, &elements[k].linearize_in(frame, &x[k], start, filter));
            }
        }
    }

    /// The gradient of [`Self::energy`] [N], up to rounding that of [`Self::linearize_in`].
    fn gradient(&self, x: &[Vector; N], start: Option<Start<'_, N>>) -> [Vector; N];

    /// Adds the element to a description of the model, unless the CPU alone computes such elements.
    fn describe(&self, _model: &mut ElementModel) {}

    /// [`Self::linearize_in`] with the frame at `x`.
    #[cfg(test)]
    fn linearize(&self, x: &[Vector; N], start: Option<Start<'_, N>>, filter: Filter) -> Linearization<N> {
        let [frame, ..] = Self::frames([self; 4], &[*x; 4]);
        self.linearize_in(&frame, x, start, filter)
    }
}

/// Positions of an element's nodes at the start of the step [m], for damping.
#[derive(Clone, Copy)]
pub(crate) struct Start<'a, const N: usize> {
    pub x: &'a [Vector; N],
    /// 1 / dt [1/s].
    pub rate: f64,
}
