//! Meshes of degenerate features, as text of files: spikes, wedges, steps, notches, grounds of slivers.

use std::f64::consts::TAU;
use std::fmt::Write;

/// A mesh of tetrahedra.
#[derive(Clone, Debug, Default)]
pub struct Solid {
    /// Points [m].
    pub points: Vec<[f64; 3]>,
    /// Vertices of each tetrahedron.
    pub tets: Vec<[u32; 4]>,
}

impl Solid {
    /// A cone that stands on its tip: with few sides and a small radius, a spike.
    pub fn spike(sides: u32, radius: f64, height: f64) -> Self {
        let rim = (0..sides).map(|k| {
            let angle = TAU * f64::from(k) / f64::from(sides);
            [radius * angle.cos(), radius * angle.sin(), height]
        });
        Self {
            points: [[0.0; 3], [0.0, 0.0, height]].into_iter().chain(rim).collect(),
            tets: (0..sides).map(|k| [0, 1, 2 + k, 2 + (k + 1) % sides]).collect(),
        }
    }

    /// A triangular prism along y that stands on a sharp edge.
    pub fn wedge(cells: u32, width: f64, height: f64, length: f64) -> Self {
        let mut solid = Self::default();
        for k in 0..=cells {
            let y = length * (f64::from(k) / f64::from(cells) - 0.5);
            let section = [[0.0, 0.0], [0.5 * width, height], [-0.5 * width, height]];
            solid.points.extend(section.map(|[x, z]| [x, y, z]));
        }
        for k in 0..cells {
            let [a, b, c] = [3 * k, 3 * k + 1, 3 * k + 2];
            let [d, e, f] = [a + 3, b + 3, c + 3];
            solid.tets.extend([[a, b, c, d], [b, c, d, e], [c, d, e, f]]);
        }
        solid
    }

    /// The text of a file `.t`, with every tetrahedron of positive volume.
    pub fn text(&self) -> String {
        let mut text = String::new();
        for (index, [x, y, z]) in self.points.iter().enumerate() {
            // Writing to a string does not fail.
            let _ = writeln!(text, "Vertex {index} {x:?} {y:?} {z:?}");
        }
        for (index, &tet) in self.tets.iter().enumerate() {
            let [a, b, c, d] = if self.volume(tet) > 0.0 { tet } else { [tet[0], tet[2], tet[1], tet[3]] };
            let _ = writeln!(text, "Tet {index} {a} {b} {c} {d}");
        }
        text
    }

    fn volume(&self, tet: [u32; 4]) -> f64 {
        use bowknot_geometry::Vector;
        let [a, b, c, d] = tet.map(|v| Vector::from(self.points[v as usize]));
        (b - a).cross(&(c - a)).dot(&(d - a)) / 6.0
    }
}

/// Triangles and strands of an OBJ file.
#[derive(Clone, Debug, Default)]
pub struct Surface {
    /// Points [m].
    pub points: Vec<[f64; 3]>,
    /// Vertices of each face or strand, and the letter of its line.
    pub elements: Vec<(char, Vec<usize>)>,
}

impl Surface {
    /// A strip along y with this profile in (x, z): a step, a notch, a row of edges.
    pub fn extruded(profile: &[[f64; 2]], cells: usize, length: f64) -> Self {
        let mut surface = Self::default();
        for j in 0..=cells {
            let y = length * (j as f64 / cells as f64 - 0.5);
            surface.points.extend(profile.iter().map(|&[x, z]| [x, y, z]));
        }
        let n = profile.len();
        for j in 0..cells {
            for i in 0..n - 1 {
                let a = j * n + i;
                surface.elements.extend([('f', vec![a, a + 1, a + n + 1]), ('f', vec![a, a + n + 1, a + n])]);
            }
        }
        surface
    }

    /// A flat ground whose columns are `thin` and wide in turn, with diagonals in turn: needles between its
    /// inner edges.
    pub fn slivers(columns: usize, thin: f64, width: f64) -> Self {
        let mut xs = vec![0.0];
        for k in 0..columns {
            xs.push(xs[k] + if k % 2 == 0 { thin } else { width / columns as f64 });
        }
        let half = 0.5 * xs[columns];
        let profile: Vec<[f64; 2]> = xs.iter().map(|x| [x - half, 0.0]).collect();
        Self::extruded(&profile, 3, width)
    }

    /// A closed box about the origin.
    pub fn closed_box(size: f64) -> Self {
        let half = 0.5 * size;
        let corner = |k: usize| [0, 1, 2].map(|axis| if k >> axis & 1 == 0 { -half } else { half });
        let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let faces = quads.iter().flat_map(|&[a, b, c, d]| [vec![a, b, c], vec![a, c, d]]);
        Self { points: (0..8).map(corner).collect(), elements: faces.map(|face| ('f', face)).collect() }
    }

    /// Triangles of a micrometer on a square lattice in the plane z = 0: points, since scenes take no
    /// obstacle without triangles or strands.
    pub fn points(count: usize, spacing: f64) -> Self {
        const SIZE: f64 = 1e-6;
        let mut surface = Self::default();
        for (k, [x, y, _]) in lattice(count, spacing).into_iter().enumerate() {
            surface.points.extend([[x, y, 0.0], [x + SIZE, y, 0.0], [x, y + SIZE, 0.0]]);
            surface.elements.push(('f', vec![3 * k, 3 * k + 1, 3 * k + 2]));
        }
        surface
    }

    /// Upright segments on a square lattice, from z = -`height` to 0.
    pub fn needles(count: usize, spacing: f64, height: f64) -> Self {
        let tops = lattice(count, spacing);
        let feet = tops.iter().map(|&[x, y, _]| [x, y, -height]);
        let elements = (0..tops.len()).map(|k| ('l', vec![k, tops.len() + k]));
        Self { elements: elements.collect(), points: tops.iter().copied().chain(feet).collect() }
    }

    /// The text of an OBJ file.
    pub fn text(&self) -> String {
        let mut text = String::new();
        for [x, y, z] in &self.points {
            let _ = writeln!(text, "v {x:?} {y:?} {z:?}");
        }
        for (letter, vertices) in &self.elements {
            let numbers: Vec<String> = vertices.iter().map(|v| (v + 1).to_string()).collect();
            let _ = writeln!(text, "{letter} {}", numbers.join(" "));
        }
        text
    }
}

/// Places of a square lattice of `count` x `count` in the plane z = 0, about the origin.
fn lattice(count: usize, spacing: f64) -> Vec<[f64; 3]> {
    let half = 0.5 * spacing * (count - 1) as f64;
    let place = |k: usize| [spacing * (k % count) as f64 - half, spacing * (k / count) as f64 - half, 0.0];
    (0..count * count).map(place).collect()
}
