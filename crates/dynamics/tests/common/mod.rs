//! Meshes shared by tests, examples and benches.
#![allow(dead_code, reason = "each user needs some of it")]

use bowknot_dynamics::{Body, ClothMaterial, DynamicsModel};
use bowknot_geometry::Point;

/// How a sheet's cells are split.
#[derive(Clone, Copy, Debug)]
pub enum Diagonals {
    /// All the same way.
    Parallel,
    /// Alternating.
    Alternating,
}

/// A `width` x `height` sheet [m] in the xy plane, corner at the origin, of `columns` x `rows` cells:
/// positions and triangles. Vertex (i, j) has index i + j * (columns + 1).
pub fn sheet(
    width: f64,
    height: f64,
    columns: usize,
    rows: usize,
    diagonals: Diagonals,
) -> (Vec<Point>, Vec<[u32; 3]>) {
    let mut positions = Vec::new();
    for j in 0..=rows {
        for i in 0..=columns {
            positions.push(Point::new(
                width * i as f64 / columns as f64,
                height * j as f64 / rows as f64,
                0.0,
            ));
        }
    }
    let index = |i: usize, j: usize| (i + j * (columns + 1)) as u32;
    let mut triangles = Vec::new();
    for j in 0..rows {
        for i in 0..columns {
            let (a, b, c, d) = (index(i, j), index(i + 1, j), index(i + 1, j + 1), index(i, j + 1));
            if matches!(diagonals, Diagonals::Parallel) || (i + j) % 2 == 0 {
                triangles.extend([[a, b, c], [a, c, d]]);
            } else {
                triangles.extend([[a, b, d], [b, c, d]]);
            }
        }
    }
    (positions, triangles)
}

/// The same of near-equilateral triangles: every second row is shifted by half a cell.
pub fn staggered_sheet(width: f64, height: f64, columns: usize, rows: usize) -> (Vec<Point>, Vec<[u32; 3]>) {
    let (mut positions, _) = sheet(width, height, columns, rows, Diagonals::Alternating);
    let cell = width / columns as f64;
    for j in (1..=rows).step_by(2) {
        // Inner vertices move half a cell; both ends stay, so the outline is the same.
        for i in 1..columns {
            positions[i + j * (columns + 1)].x -= 0.5 * cell;
        }
    }
    let index = |i: usize, j: usize| (i + j * (columns + 1)) as u32;
    let mut triangles = Vec::new();
    for j in 0..rows {
        for i in 0..columns {
            let (a, b, c, d) = (index(i, j), index(i + 1, j), index(i + 1, j + 1), index(i, j + 1));
            if j % 2 == 0 {
                triangles.extend([[a, b, c], [a, c, d]]);
            } else {
                triangles.extend([[a, b, d], [b, c, d]]);
            }
        }
    }
    (positions, triangles)
}

/// One cloth body over all positions.
pub fn cloth_model(positions: &[Point], triangles: Vec<[u32; 3]>, material: ClothMaterial) -> DynamicsModel {
    let body = Body::cloth("sheet", triangles, material);
    match DynamicsModel::new(positions.to_vec(), vec![body]) {
        Ok(model) => model,
        Err(errors) => panic!("a valid sheet: {errors:?}"),
    }
}
