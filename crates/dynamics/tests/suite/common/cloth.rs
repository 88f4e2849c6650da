//! A model of one body of cloth, for tests, examples and benches.

use bowknot_dynamics::{Body, ClothMaterial, DynamicsModel};
use bowknot_geometry::Point;

/// One cloth body over all positions.
pub fn cloth_model(positions: &[Point], triangles: Vec<[u32; 3]>, material: ClothMaterial) -> DynamicsModel {
    let body = Body::cloth("sheet", triangles, material);
    match DynamicsModel::new(positions.to_vec(), vec![body]) {
        Ok(model) => model,
        Err(errors) => panic!("a valid sheet: {errors:?}"),
    }
}
