//! A model of one body of cloth, for tests, examples and benches.

use bowknot_dynamics::{Body, ClothMaterial, DynamicsModel};
use bowknot_geometry::Point;

/// A model of one body of cloth over all positions.
pub fn cloth_model(positions: &[Point], triangles: Vec<[u32; 3]>, material: ClothMaterial) -> DynamicsModel {
    let body = Body::cloth("sheet", triangles, material);
    DynamicsModel::new(positions.to_vec(), vec![body]).expect("a valid sheet")
}
