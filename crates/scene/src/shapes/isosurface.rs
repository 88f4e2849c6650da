//! Meshes of implicit surfaces: surface nets, then evened out on the surface.
//!
//! Surface nets (Gibson 1998, "Constrained Elastic Surface Nets") put a vertex into each cell of a grid that
//! the surface crosses and a quadrilateral across each such edge of the grid. Here a cell has a vertex for
//! each sheet of the surface in it (Nielson 2004, "Dual Marching Cubes"), so that sheets near one another are
//! not joined. The vertices are then moved towards the middle of their neighbors along the surface, and edges
//! flipped to Delaunay's, which leaves triangles of nearly equal size.

use super::mesh::TriangleMesh;
use bowknot_geometry::{Point, Vector};
use rayon::prelude::*;
use std::collections::BTreeMap;

/// The zero set of a field that is negative inside and nowhere steeper than 1.
pub(super) struct Isosurface<F> {
    pub field: F,
    /// A box that contains the surface [m].
    pub low: Point,
    pub high: Point,
}

/// Nodes along the side of a block that is evaluated or skipped as a whole.
const BLOCK: usize = 8;
/// Rounds of evening out.
const ROUNDS: usize = 12;
/// Grids tried until one separates all sheets of the surface.
const TRIALS: u32 = 8;

/// A closed mesh with outward triangles. Rarely two sheets share an edge all the same; a finer grid is
/// taken then.
pub(super) fn mesh<F: Fn(&Point) -> f64 + Sync>(surface: &Isosurface<F>, spacing: f64) -> TriangleMesh {
    let mut mesh = TriangleMesh::default();
    for trial in 0..TRIALS {
        mesh = Grid::new(surface, spacing * 0.9f64.powi(trial as i32)).nets();
        if is_closed_manifold(&mesh) {
            break;
        }
    }
    for round in 0..ROUNDS {
        even_out(surface, &mut mesh, spacing);
        if round % 3 == 2 {
            flip(&mut mesh);
        }
    }
    mesh
}

struct Grid {
    low: Point,
    spacing: f64,
    /// Nodes along each axis.
    nodes: [usize; 3],
    values: Vec<f64>,
}

impl Grid {
    fn new<F: Fn(&Point) -> f64 + Sync>(surface: &Isosurface<F>, spacing: f64) -> Self {
        let low = surface.low - Vector::repeat(1.5 * spacing);
        let size = surface.high - low;
        let blocks: [usize; 3] =
            std::array::from_fn(|c| ((size[c] / spacing + 2.0) / BLOCK as f64).ceil() as usize);
        let nodes = blocks.map(|n| n * BLOCK);
        let mut grid = Self { low, spacing, nodes, values: vec![0.0; nodes.iter().product()] };
        let count = blocks.iter().product::<usize>();
        let corner = |block: usize| {
            [block % blocks[0], block / blocks[0] % blocks[1], block / (blocks[0] * blocks[1])]
                .map(|b| b * BLOCK)
        };
        let evaluated: Vec<Vec<f64>> = (0..count)
            .into_par_iter()
            .map(|block| {
                let [i, j, k] = corner(block);
                let half = 0.5 * (BLOCK - 1) as f64 * spacing;
                let middle = grid.position([i, j, k]) + Vector::repeat(half);
                let value = (surface.field)(&middle);
                // A field of slope 1 at most keeps its sign this far.
                if value.abs() > 1.001 * half * 3.0f64.sqrt() {
                    return vec![value];
                }
                (0..BLOCK.pow(3))
                    .map(|n| [i + n % BLOCK, j + n / BLOCK % BLOCK, k + n / (BLOCK * BLOCK)])
                    .map(|node| (surface.field)(&grid.position(node)))
                    .collect()
            })
            .collect();
        for (block, values) in evaluated.iter().enumerate() {
            let [i, j, k] = corner(block);
            for n in 0..BLOCK.pow(3) {
                let at = grid.index([i + n % BLOCK, j + n / BLOCK % BLOCK, k + n / (BLOCK * BLOCK)]);
                grid.values[at] = if values.len() == 1 { values[0] } else { values[n] };
            }
        }
        grid
    }

    fn index(&self, [i, j, k]: [usize; 3]) -> usize {
        (k * self.nodes[1] + j) * self.nodes[0] + i
    }

    fn position(&self, node: [usize; 3]) -> Point {
        self.low + Vector::from(node.map(|n| n as f64)) * self.spacing
    }

    fn inside(&self, node: [usize; 3]) -> bool {
        self.values[self.index(node)] < 0.0
    }

    fn nets(&self) -> TriangleMesh {
        let mut mesh = TriangleMesh::default();
        // Vertices of the cells that the surface crosses, by the edge of the cell.
        let mut slot_of = vec![u32::MAX; self.values.len()];
        let mut slots: Vec<[u32; 12]> = Vec::new();
        let cells = self.nodes.map(|n| n - 1);
        for k in 0..cells[2] {
            for j in 0..cells[1] {
                for i in 0..cells[0] {
                    if let Some(slot) = self.vertices([i, j, k], &mut mesh.positions) {
                        slot_of[self.index([i, j, k])] = slots.len() as u32;
                        slots.push(slot);
                    }
                }
            }
        }
        for k in 1..cells[2] {
            for j in 1..cells[1] {
                for i in 1..cells[0] {
                    let node = [i, j, k];
                    for axis in 0..3 {
                        let mut next = node;
                        next[axis] += 1;
                        if self.inside(node) == self.inside(next) {
                            continue;
                        }
                        // The four cells around the edge, counter-clockwise seen against the axis.
                        let corners = [(0, 0), (1, 0), (1, 1), (0, 1)].map(|(u, v)| {
                            let mut cell = node;
                            cell[(axis + 1) % 3] -= u;
                            cell[(axis + 2) % 3] -= v;
                            slots[slot_of[self.index(cell)] as usize][4 * axis + u + 2 * v]
                        });
                        let [a, b, c, d] = corners;
                        let [a, b, c, d] = if self.inside(node) { [a, b, c, d] } else { [a, d, c, b] };
                        let x = |v: u32| mesh.positions[v as usize];
                        let halves = if (x(a) - x(c)).norm() <= (x(b) - x(d)).norm() {
                            [[a, b, c], [a, c, d]]
                        } else {
                            [[a, b, d], [b, c, d]]
                        };
                        mesh.triangles.extend(halves);
                    }
                }
            }
        }
        mesh
    }

    /// Adds a vertex for each sheet of the surface in a cell, the mean of where it crosses the cell's
    /// edges, and tells for each edge which vertex that is. Edge `4 a + u + 2 v` runs along axis a at
    /// the lower (0) or upper (1) side in the two axes after a.
    fn vertices(&self, [i, j, k]: [usize; 3], positions: &mut Vec<Point>) -> Option<[u32; 12]> {
        let corner = |c: usize| [i + (c & 1), j + (c >> 1 & 1), k + (c >> 2)];
        let inside: [bool; 8] = std::array::from_fn(|c| self.inside(corner(c)));
        if inside.iter().all(|c| *c == inside[0]) {
            return None;
        }
        let bit = |axis: usize| 1 << (axis % 3);
        // Corners at the ends of an edge.
        let ends = |edge: usize| {
            let (axis, u, v) = (edge / 4, edge & 1, edge >> 1 & 1);
            let from = u * bit(axis + 1) + v * bit(axis + 2);
            [from, from + bit(axis)]
        };
        let crossed: [bool; 12] = std::array::from_fn(|e| inside[ends(e)[0]] != inside[ends(e)[1]]);
        // Edges are of one sheet if the surface runs from one to the other across a face. Where a face is
        // crossed four times, the surface cuts off its two inner corners.
        let mut sheet: [usize; 12] = std::array::from_fn(|e| e);
        let join = |sheet: &mut [usize; 12], a: usize, b: usize| {
            let (from, to) = (sheet[a].max(sheet[b]), sheet[a].min(sheet[b]));
            sheet.iter_mut().filter(|s| **s == from).for_each(|s| *s = to);
        };
        for axis in 0..3 {
            for side in [0, bit(axis)] {
                let on_face = |e: &usize| ends(*e).iter().all(|c| c & bit(axis) == side);
                let edges: Vec<usize> = (0..12).filter(|e| crossed[*e] && on_face(e)).collect();
                for (n, &a) in edges.iter().enumerate() {
                    for &b in &edges[n + 1..] {
                        let shared = ends(a).into_iter().find(|c| ends(b).contains(c));
                        if edges.len() == 2 || shared.is_some_and(|c| inside[c]) {
                            join(&mut sheet, a, b);
                        }
                    }
                }
            }
        }
        let mut slot = [u32::MAX; 12];
        for first in (0..12).filter(|&e| crossed[e] && sheet[e] == e) {
            let (mut sum, mut count) = (Vector::zeros(), 0.0);
            for e in (first..12).filter(|&e| crossed[e] && sheet[e] == first) {
                let [a, b] = ends(e).map(corner);
                let (f, g) = (self.values[self.index(a)], self.values[self.index(b)]);
                let (a, b) = (self.position(a), self.position(b));
                sum += a.coords + (b - a) * (f / (f - g));
                count += 1.0;
                slot[e] = positions.len() as u32;
            }
            positions.push(Point::from(sum / count));
        }
        Some(slot)
    }
}

/// Moves each vertex halfway to the middle of its neighbors, along the surface, and onto it.
fn even_out<F: Fn(&Point) -> f64 + Sync>(surface: &Isosurface<F>, mesh: &mut TriangleMesh, spacing: f64) {
    let mut sums = vec![(Vector::zeros(), 0.0); mesh.positions.len()];
    for &[a, b, c] in &mesh.triangles {
        // On a closed mesh every neighbor comes twice, from the triangles at either side.
        for (v, p, q) in [(a, b, c), (b, c, a), (c, a, b)] {
            let sum = &mut sums[v as usize];
            sum.0 += mesh.positions[p as usize].coords + mesh.positions[q as usize].coords;
            sum.1 += 2.0;
        }
    }
    mesh.positions.par_iter_mut().zip(sums).for_each(|(x, (sum, count))| {
        if count > 0.0 {
            let step = 0.5 * (sum / count - x.coords);
            let normal = gradient(&surface.field, x, spacing);
            let normal = normal.try_normalize(1e-9).unwrap_or_else(Vector::zeros);
            *x += step - normal * normal.dot(&step);
        }
        for _ in 0..2 {
            let slope = gradient(&surface.field, x, spacing);
            let step = slope * ((surface.field)(x) / slope.norm_squared().max(0.01));
            *x -= step * (spacing / step.norm().max(spacing));
        }
    });
}

/// Gradient by differences to the corners of a small tetrahedron.
fn gradient(field: &impl Fn(&Point) -> f64, x: &Point, spacing: f64) -> Vector {
    let h = 1e-3 * spacing;
    let corners = [[1.0, -1.0, -1.0], [-1.0, -1.0, 1.0], [-1.0, 1.0, -1.0], [1.0, 1.0, 1.0]];
    corners.iter().map(|&corner| Vector::from(corner)).map(|c| c * field(&(x + c * h))).sum::<Vector>()
        / (4.0 * h)
}

/// Flips edges whose opposite angles add up to more than half a turn; a triangle takes part in one flip.
fn flip(mesh: &mut TriangleMesh) {
    let mut sides: BTreeMap<[u32; 2], [u32; 2]> = BTreeMap::new();
    for (t, &[a, b, c]) in mesh.triangles.iter().enumerate() {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            let side = sides.entry([from.min(to), from.max(to)]).or_insert([u32::MAX; 2]);
            side[usize::from(from > to)] = t as u32;
        }
    }
    let mut used = vec![false; mesh.triangles.len()];
    let mut made: Vec<[u32; 2]> = Vec::new();
    for (&[a, b], &[left, right]) in &sides {
        if left == u32::MAX || right == u32::MAX || used[left as usize] || used[right as usize] {
            continue;
        }
        let opposite = |t: u32| mesh.triangles[t as usize].into_iter().find(|v| *v != a && *v != b);
        let (Some(c), Some(d)) = (opposite(left), opposite(right)) else { continue };
        let cotangent = |at: u32| {
            let x = |v: u32| mesh.positions[v as usize];
            let (p, q) = (x(a) - x(at), x(b) - x(at));
            p.dot(&q) / p.cross(&q).norm().max(f64::MIN_POSITIVE)
        };
        let new = [c.min(d), c.max(d)];
        if cotangent(c) + cotangent(d) >= -1e-6 || sides.contains_key(&new) || made.contains(&new) {
            continue;
        }
        mesh.triangles[left as usize] = [a, d, c];
        mesh.triangles[right as usize] = [d, b, c];
        (used[left as usize], used[right as usize]) = (true, true);
        made.push(new);
    }
}

/// Whether every edge lies between two triangles of opposite direction, and the triangles of every vertex
/// go around it once.
fn is_closed_manifold(mesh: &TriangleMesh) -> bool {
    // For each vertex, which neighbor follows which.
    let mut around: Vec<BTreeMap<u32, u32>> = vec![BTreeMap::new(); mesh.positions.len()];
    for &[a, b, c] in &mesh.triangles {
        for (v, p, q) in [(a, b, c), (b, c, a), (c, a, b)] {
            if around[v as usize].insert(p, q).is_some() {
                return false;
            }
        }
    }
    around.iter().all(|next| {
        let Some((&first, _)) = next.first_key_value() else { return false };
        let (mut at, mut steps) = (first, 0);
        while let Some(&q) = next.get(&at) {
            (at, steps) = (q, steps + 1);
            if at == first || steps > next.len() {
                break;
            }
        }
        at == first && steps == next.len()
    })
}
