//! A sheet, for the tests of this crate and of `baselines`.

use bowknot_geometry::Point;

/// A square sheet of `cells` x `cells` squares of side `h` in the plane z = `height`.
pub fn sheet(cells: usize, h: f64, height: f64, x: &mut Vec<Point>, triangles: &mut Vec<[u32; 3]>) {
    let (base, n) = (x.len(), cells + 1);
    for k in 0..n * n {
        // A small warp avoids degenerate positions.
        let warp = 1e-3 * h * ((k * 37 % 11) as f64 - 5.0);
        x.push(Point::new((k % n) as f64 * h, (k / n) as f64 * h, height + warp));
    }
    let id = |i: usize, j: usize| (base + j * n + i) as u32;
    for j in 0..cells {
        for i in 0..cells {
            let [a, b, c, d] = [id(i, j), id(i + 1, j), id(i + 1, j + 1), id(i, j + 1)];
            triangles.extend(if (i + j) % 2 == 0 { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] });
        }
    }
}
