//! Volumes of solids in a state.

use crate::model::volume;
use crate::{BodyShape, DynamicsModel};
use bowknot_geometry::Point;
use rayon::prelude::*;

impl DynamicsModel {
    /// Signed volume [m^3] of all tets at positions `x` [m].
    pub fn volume(&self, x: &[Point]) -> f64 {
        self.solids().flat_map(|(_, tets)| tets).map(|tet| volume(&tet.map(|v| x[v as usize].coords))).sum()
    }

    /// Tets of negative or no volume at positions `x` [m]: body and tet of each, ascending.
    pub fn inverted_tets(&self, x: &[Point]) -> Vec<[usize; 2]> {
        let mut inverted = Vec::new();
        for (body, tets) in self.solids() {
            let found = tets.par_iter().enumerate().with_min_len(1024).filter_map(|(index, tet)| {
                (volume(&tet.map(|v| x[v as usize].coords)) <= 0.0).then_some([body, index])
            });
            inverted.par_extend(found);
        }
        inverted
    }

    /// Tets of each solid, with the index of its body.
    fn solids(&self) -> impl Iterator<Item = (usize, &[[u32; 4]])> {
        self.bodies().iter().enumerate().filter_map(|(index, body)| match &body.shape {
            BodyShape::Solid { tets, .. } => Some((index, tets.as_slice())),
            _ => None,
        })
    }
}
