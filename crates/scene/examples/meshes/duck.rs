//! A rubber duck of tetrahedra.
//!
//! A lattice of tetrahedra is cut at the surface (after Labelle and Shewchuk 2007, "Isosurface Stuffing"):
//! lattice points near the surface are moved onto it, so that no cut leaves a sliver; tetrahedra that the
//! surface crosses are cut there, and what lies inside is divided into tetrahedra again.

use crate::parts::{bar, pair, part};
use bowknot_scene::geometry::{Point, Vector};
use bowknot_scene::io::Mesh;
use bowknot_scene::shapes::RoundCones;
use std::collections::BTreeMap;

/// Side of the lattice's cubes [m].
const SPACING: f64 = 0.0165;
/// Lattice points nearer to the surface than this share of the spacing are moved onto it.
const SNAP: f64 = 0.25;

/// The duck: 20 cm long, it looks along x, and its flat underside is near z = 0.
fn solid() -> RoundCones {
    let mut parts = vec![
        // Body.
        part([[-0.028, 0.0, 0.046], [0.03, 0.0, 0.045]], [0.046, 0.044], 0.02),
        bar([0.0, 0.014, 0.045], 0.044, 0.02),
        // Tail.
        part([[-0.055, 0.0, 0.055], [-0.09, 0.0, 0.082]], [0.028, 0.013], 0.025),
        // Neck and head.
        part([[0.034, 0.0, 0.075], [0.044, 0.0, 0.105]], [0.03, 0.029], 0.02),
        part([[0.044, 0.0, 0.116], [0.046, 0.0, 0.122]], [0.036, 0.036], 0.012),
        // Beak.
        bar([0.08, 0.007, 0.114], 0.014, 0.008),
    ];
    // Wings, and a flat underside that it sits on.
    parts.extend(pair([[0.0, 0.052, 0.054], [-0.045, 0.05, 0.066]], [0.019, 0.013], 0.012));
    parts.extend(pair([[-0.045, 0.022, 0.034], [0.048, 0.022, 0.034]], [0.034, 0.034], 0.01));
    RoundCones { parts }
}

/// The mesh: tetrahedra of positive volume.
pub fn tetrahedra() -> Mesh {
    let solid = solid();
    let mut lattice = Lattice::new(&solid);
    let mut mesh = Mesh::default();
    for tet in lattice.tets() {
        lattice.cut(&solid, tet, &mut mesh.tets);
    }
    mesh.positions = lattice.points;
    mesh.drop_unused_vertices();
    for tet in &mut mesh.tets {
        let [a, b, c, d] = tet.map(|v| mesh.positions[v as usize]);
        if (b - a).cross(&(c - a)).dot(&(d - a)) < 0.0 {
            tet.swap(2, 3);
        }
    }
    mesh
}

/// A body-centered cubic lattice.
struct Lattice {
    /// Corners of the cubes, then their centers, then where the surface cuts edges [m].
    points: Vec<Point>,
    /// Field at the corners and centers [m]; 0 for those on the surface.
    values: Vec<f64>,
    /// Cubes along each axis.
    cubes: [usize; 3],
    /// Where the surface cuts the edge of two points.
    cuts: BTreeMap<[u32; 2], u32>,
}

impl Lattice {
    fn new(solid: &RoundCones) -> Self {
        let (low, high) = solid.bounds();
        let cubes: [usize; 3] = std::array::from_fn(|c| ((high[c] - low[c]) / SPACING).ceil() as usize + 2);
        let mut points = Vec::new();
        for shift in [-1.0, -0.5] {
            let count = cubes.map(|n| if shift == -1.0 { n + 1 } else { n });
            for k in 0..count[2] {
                for j in 0..count[1] {
                    let row =
                        |i| low + (Vector::from([i, j, k].map(|n| n as f64)).add_scalar(shift)) * SPACING;
                    points.extend((0..count[0]).map(row));
                }
            }
        }
        let mut lattice = Self { values: vec![0.0; points.len()], points, cubes, cuts: BTreeMap::new() };
        for (point, value) in lattice.points.iter_mut().zip(&mut lattice.values) {
            let free = solid.field(point);
            *value = if free.abs() < SNAP * SPACING {
                *point = onto_surface(solid, *point);
                0.0
            } else {
                free
            };
        }
        lattice
    }

    fn corner(&self, [i, j, k]: [usize; 3]) -> u32 {
        let [nx, ny, _] = self.cubes;
        ((k * (ny + 1) + j) * (nx + 1) + i) as u32
    }

    fn center(&self, [i, j, k]: [usize; 3]) -> u32 {
        let [nx, ny, nz] = self.cubes;
        (((nx + 1) * (ny + 1) * (nz + 1)) + (k * ny + j) * nx + i) as u32
    }

    /// Four tetrahedra around each line between the centers of neighboring cubes.
    fn tets(&self) -> Vec<[u32; 4]> {
        let mut tets = Vec::new();
        for axis in 0..3 {
            let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
            for k in 0..self.cubes[2] {
                for j in 0..self.cubes[1] {
                    for i in 0..self.cubes[0] {
                        let mut next = [i, j, k];
                        next[axis] += 1;
                        if next[axis] == self.cubes[axis] {
                            continue;
                        }
                        // The face between the two cubes.
                        let face = [[0, 0], [1, 0], [1, 1], [0, 1]].map(|[s, t]| {
                            let mut at = next;
                            at[u] += s;
                            at[v] += t;
                            self.corner(at)
                        });
                        let centers = [self.center([i, j, k]), self.center(next)];
                        let side = |n: usize| [centers[0], centers[1], face[n], face[(n + 1) % 4]];
                        tets.extend((0..4).map(side));
                    }
                }
            }
        }
        tets
    }

    /// Adds what of a tetrahedron lies inside.
    fn cut(&mut self, solid: &RoundCones, tet: [u32; 4], tets: &mut Vec<[u32; 4]>) {
        let of_sign = |keep: &dyn Fn(f64) -> bool| -> Vec<u32> {
            tet.into_iter().filter(|v| keep(self.values[*v as usize])).collect()
        };
        let inside = of_sign(&|value| value < 0.0);
        let on = of_sign(&|value| value == 0.0);
        let outside = of_sign(&|value| value > 0.0);
        let mut cut = |a: u32, b: u32| self.cut_edge(solid, a, b);
        match (inside.as_slice(), on.as_slice(), outside.as_slice()) {
            ([], ..) => {}
            (_, _, []) => tets.push(tet),
            (&[a], ..) => {
                let rest = on.iter().copied().chain(outside.iter().map(|&v| cut(a, v))).collect::<Vec<_>>();
                tets.push([a, rest[0], rest[1], rest[2]]);
            }
            // A pyramid over a quadrilateral.
            (&[a, b], &[tip], &[out]) => {
                let base = [a, b, cut(b, out), cut(a, out)];
                tets.extend(halves(base).map(|[p, q, r]| [p, q, r, tip]));
            }
            (&[a, b], _, &[c, d]) => {
                let ends = [[a, cut(a, c), cut(a, d)], [b, cut(b, c), cut(b, d)]];
                tets.extend(prism(ends));
            }
            (&[a, b, c], _, &[out, ..]) => {
                let ends = [[a, b, c], [cut(a, out), cut(b, out), cut(c, out)]];
                tets.extend(prism(ends));
            }
            _ => {}
        }
    }

    /// The vertex where the surface cuts an edge.
    fn cut_edge(&mut self, solid: &RoundCones, a: u32, b: u32) -> u32 {
        let key = [a.min(b), a.max(b)];
        if let Some(&vertex) = self.cuts.get(&key) {
            return vertex;
        }
        let [mut p, mut q] = [a, b].map(|v| self.points[v as usize]);
        let sign = self.values[a as usize].signum();
        for _ in 0..40 {
            let middle = midpoint(&p, &q);
            if solid.field(&middle) * sign > 0.0 {
                p = middle;
            } else {
                q = middle;
            }
        }
        let vertex = self.points.len() as u32;
        self.points.push(p);
        self.cuts.insert(key, vertex);
        vertex
    }
}

fn midpoint(a: &Point, b: &Point) -> Point {
    a + (b - a) * 0.5
}

/// Both halves of a quadrilateral, cut from its smallest vertex, so that neighbors cut it alike.
fn halves([a, b, c, d]: [u32; 4]) -> [[u32; 3]; 2] {
    if a.min(c) < b.min(d) { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] }
}

/// A prism between two triangles as three tetrahedra. Each of its quadrilaterals is cut as [`halves`] cuts
/// it.
fn prism([mut a, mut b]: [[u32; 3]; 2]) -> [[u32; 4]; 3] {
    if b.iter().min() < a.iter().min() {
        std::mem::swap(&mut a, &mut b);
    }
    let first = (0..3).min_by_key(|&n| a[n]).unwrap_or(0);
    a.rotate_left(first);
    b.rotate_left(first);
    // The quadrilateral a1, a2, b2, b1 is opposite of the smallest vertex, a0.
    let between = if a[1].min(b[2]) < a[2].min(b[1]) {
        [[a[0], a[1], a[2], b[2]], [a[0], a[1], b[2], b[1]]]
    } else {
        [[a[0], a[1], a[2], b[1]], [a[0], a[2], b[2], b[1]]]
    };
    [between[0], between[1], [a[0], b[0], b[1], b[2]]]
}

/// The nearest point of the surface, about, from a point near it.
fn onto_surface(solid: &RoundCones, mut p: Point) -> Point {
    for _ in 0..4 {
        let gradient = crate::remesh::gradient(&|p: &Point| solid.field(p), &p);
        p -= gradient * (solid.field(&p) / gradient.norm_squared().max(0.01));
    }
    p
}
