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

/// A box of `cells` cubes a side, each six tets around its diagonal, corner at the origin: positions and tets.
/// Vertex (i, j, k) has index i + (cells[0] + 1) * (j + (cells[1] + 1) * k).
pub fn block(size: [f64; 3], cells: [usize; 3]) -> (Vec<Point>, Vec<[u32; 4]>) {
    let index = |i: usize, j: usize, k: usize| (i + (cells[0] + 1) * (j + (cells[1] + 1) * k)) as u32;
    let at = |axis: usize, k: usize| size[axis] * k as f64 / cells[axis] as f64;
    let (mut positions, mut tets) = (Vec::new(), Vec::new());
    for k in 0..=cells[2] {
        for j in 0..=cells[1] {
            for i in 0..=cells[0] {
                positions.push(Point::new(at(0, i), at(1, j), at(2, k)));
                if i < cells[0] && j < cells[1] && k < cells[2] {
                    let corner = |c: usize| index(i + (c & 1), j + (c >> 1 & 1), k + (c >> 2));
                    for [a, b] in [[1, 3], [3, 2], [2, 6], [6, 4], [4, 5], [5, 1]] {
                        tets.push([corner(0), corner(a), corner(b), corner(7)]);
                    }
                }
            }
        }
    }
    (positions, tets)
}

/// `count` strands of `nodes` vertices that hang down over `length` [m], roots on a square grid of `spacing` [m]:
/// positions and edges; the root of strand s is vertex s * nodes.
pub fn strands(count: usize, nodes: usize, length: f64, spacing: f64) -> (Vec<Point>, Vec<[u32; 2]>) {
    let side = (count as f64).sqrt().ceil() as usize;
    let (mut positions, mut edges) = (Vec::new(), Vec::new());
    for s in 0..count {
        for k in 0..nodes {
            let down = length * k as f64 / (nodes - 1) as f64;
            positions.push(Point::new(spacing * (s % side) as f64, spacing * (s / side) as f64, -down));
            if k > 0 {
                let v = (s * nodes + k) as u32;
                edges.push([v - 1, v]);
            }
        }
    }
    (positions, edges)
}
