//! A block of tetrahedra, for tests and examples.

use bowknot_geometry::Point;

/// A box with its corner at the origin, of `cells` cubes along each axis, each of six tets around its
/// diagonal: positions and tets. Vertex (i, j, k) has index i + (cells[0] + 1) * (j + (cells[1] + 1) * k).
pub fn block(size: [f64; 3], cells: [usize; 3]) -> (Vec<Point>, Vec<[u32; 4]>) {
    filled(size, cells, |_| 0)
}

/// The same with cubes that are mirrored along axes, the bits of `mirrors`.
pub fn filled(
    size: [f64; 3],
    cells: [usize; 3],
    mirrors: impl Fn([usize; 3]) -> usize,
) -> (Vec<Point>, Vec<[u32; 4]>) {
    let index = |i: usize, j: usize, k: usize| (i + (cells[0] + 1) * (j + (cells[1] + 1) * k)) as u32;
    let at = |axis: usize, k: usize| size[axis] * k as f64 / cells[axis] as f64;
    let (mut positions, mut tets) = (Vec::new(), Vec::new());
    for k in 0..=cells[2] {
        for j in 0..=cells[1] {
            for i in 0..=cells[0] {
                positions.push(Point::new(at(0, i), at(1, j), at(2, k)));
                if i < cells[0] && j < cells[1] && k < cells[2] {
                    let mirror = mirrors([i, j, k]);
                    let corner = |c: usize| {
                        let c = c ^ mirror;
                        index(i + (c & 1), j + (c >> 1 & 1), k + (c >> 2))
                    };
                    for [a, b] in [[1, 3], [3, 2], [2, 6], [6, 4], [4, 5], [5, 1]] {
                        // Each mirror turns the tets inside out.
                        let [a, b] = if mirror.count_ones().is_multiple_of(2) { [a, b] } else { [b, a] };
                        tets.push([corner(0), corner(a), corner(b), corner(7)]);
                    }
                }
            }
        }
    }
    (positions, tets)
}
