//! The proximity search.

use crate::{CollisionModel, PairList};
use bowknot_geometry::{Point, Separation, Vector};

/// Finds pairs; keeps its trees and buffers between calls.
#[derive(Debug, Default)]
pub struct ProximitySearch {}

impl ProximitySearch {
    /// A search over the primitives of `model`; every call must pass the same model.
    pub fn new(model: &CollisionModel) -> Self {
        let _ = model;
        Self {}
    }

    /// Lists every pair that may collide whose certified lower bound of the distance is at most
    /// max over side a of `radii` + max over side b of `radii` (half-spaces: the vertex's radius).
    ///
    /// `radii` [m], one a vertex, finite and >= 0. `separations` gets each listed pair's contact
    /// geometry at `positions`, in the order of `pairs`. The result depends on the input alone,
    /// never on the number of threads.
    pub fn search(
        &mut self,
        model: &CollisionModel,
        positions: &[Point],
        radii: &[f64],
        pairs: &mut PairList,
        separations: &mut Vec<Separation>,
    ) {
        let _ = (model, positions, radii, pairs, separations);
        todo!()
    }

    /// As [`Self::search`], for vertices that move from x to x + u on a common clock: lists every
    /// pair whose boxes, moving linearly and inflated by their radii, meet at one and the same time
    /// in [0, 1]. Contact geometry is at the start, `positions`.
    pub fn search_swept(
        &mut self,
        model: &CollisionModel,
        positions: &[Point],
        displacements: &[Vector],
        radii: &[f64],
        pairs: &mut PairList,
        separations: &mut Vec<Separation>,
    ) {
        let _ = (model, positions, displacements, radii, pairs, separations);
        todo!()
    }
}
