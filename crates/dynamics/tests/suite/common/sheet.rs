//! A plane sheet, for tests, examples and benches.

use bowknot_geometry::Point;

/// A sheet of `width` x `height` [m] in the xy plane with its corner at the origin, of `columns` x `rows`
/// cells: positions, and triangles with alternating diagonals. Vertex (i, j) has index i + j * (columns + 1).
pub fn sheet(width: f64, height: f64, columns: usize, rows: usize) -> (Vec<Point>, Vec<[u32; 3]>) {
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
            if (i + j) % 2 == 0 {
                triangles.extend([[a, b, c], [a, c, d]]);
            } else {
                triangles.extend([[a, b, d], [b, c, d]]);
            }
        }
    }
    (positions, triangles)
}
