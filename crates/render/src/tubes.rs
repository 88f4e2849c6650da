//! Strands as tubes with round ends.
//!
//! Edges are joined into chains at the vertices where exactly two of them meet. A frame is transported along
//! each chain without twist, so that neighboring rings of a tube do not turn against each other (parallel
//! transport by double reflection: Wang, Jüttler, Zheng and Liu, "Computation of Rotation Minimizing Frames",
//! ACM Transactions on Graphics 27, 2008).

use bowknot_geometry::{Point, Vector};
use std::f64::consts::TAU;

/// Number of rings that round off an end, beyond the last point of the chain.
const CAP_RINGS: usize = 2;

/// A vertex of a tube.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TubeVertex {
    /// Its position [m].
    pub position: Point,
    /// Outward unit normal.
    pub normal: Vector,
    /// The vertex of the strand that it belongs to.
    pub source: u32,
}

/// The tubes of all strands; their triangles are the same in all frames.
#[derive(Clone, Debug, Default)]
pub struct Tubes {
    chains: Vec<Chain>,
    sides: usize,
    /// Triangles over the result of [`Self::vertices`], facing outward.
    pub triangles: Vec<[u32; 3]>,
}

/// A sequence of vertices joined by edges.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Chain {
    vertices: Vec<u32>,
    /// Whether an edge joins the last vertex to the first.
    closed: bool,
}

impl Tubes {
    /// Joins edges into chains and triangulates their tubes, which have rings of `sides` vertices, at least
    /// 3.
    pub fn new(edges: &[[u32; 2]], sides: usize) -> Self {
        let mut tubes = Self { chains: chains(edges), sides: sides.max(3), triangles: Vec::new() };
        let sides = tubes.sides as u32;
        let mut first = 0;
        for chain in &tubes.chains {
            let rings =
                if chain.closed { chain.vertices.len() } else { chain.vertices.len() + 2 * CAP_RINGS } as u32;
            let joints = if chain.closed { rings } else { rings - 1 };
            for r in 0..joints {
                let (low, high) = (first + r * sides, first + (r + 1) % rings * sides);
                for k in 0..sides {
                    let next = (k + 1) % sides;
                    tubes.triangles.push([low + k, low + next, high + next]);
                    tubes.triangles.push([low + k, high + next, high + k]);
                }
            }
            first += rings * sides;
        }
        tubes
    }

    /// The vertices of tubes with this radius [m] around the strands.
    pub fn vertices(&self, positions: &[Point], radius: f64) -> Vec<TubeVertex> {
        let mut out = Vec::new();
        for chain in &self.chains {
            let points: Vec<Point> = chain.vertices.iter().map(|&v| positions[v as usize]).collect();
            let tangents = tangents(&points, chain.closed);
            let frames = frames(&points, &tangents, chain.closed);
            let mut ring = |center: Point, along: Vector, width: f64, index: usize| {
                let (t, u) = (tangents[index], frames[index]);
                let v = t.cross(&u);
                for k in 0..self.sides {
                    let (s, c) = (TAU * k as f64 / self.sides as f64).sin_cos();
                    let radial = (u * c + v * s) * width;
                    out.push(TubeVertex {
                        position: center + radial * radius,
                        normal: (radial + along).normalize(),
                        source: chain.vertices[index],
                    });
                }
            };
            // An end is half a ball: its rings stand at growing angles, and the outermost is almost a point.
            let cap = |k: usize| {
                let (s, c) = (TAU / 4.0 * k as f64 / CAP_RINGS as f64).sin_cos();
                (s, c.max(1e-3))
            };
            let last = points.len() - 1;
            if !chain.closed {
                for k in (1..=CAP_RINGS).rev() {
                    let (out_by, width) = cap(k);
                    ring(points[0] - tangents[0] * (out_by * radius), -tangents[0] * out_by, width, 0);
                }
            }
            for (index, point) in points.iter().enumerate() {
                ring(*point, Vector::zeros(), 1.0, index);
            }
            if !chain.closed {
                for k in 1..=CAP_RINGS {
                    let (out_by, width) = cap(k);
                    ring(
                        points[last] + tangents[last] * (out_by * radius),
                        tangents[last] * out_by,
                        width,
                        last,
                    );
                }
            }
        }
        out
    }
}

/// Chains of edges, in the order of their first edges. A chain ends at a vertex where the number of edges is
/// not two.
fn chains(edges: &[[u32; 2]]) -> Vec<Chain> {
    let count = edges.iter().flatten().max().map_or(0, |&v| v as usize + 1);
    let mut at: Vec<Vec<u32>> = vec![Vec::new(); count];
    for (e, ends) in edges.iter().enumerate() {
        ends.iter().for_each(|&v| at[v as usize].push(e as u32));
    }
    let mut used = vec![false; edges.len()];
    let mut chains = Vec::new();
    let mut walk = |start: u32, edge: usize, used: &mut Vec<bool>| {
        let mut vertices = vec![start];
        let (mut here, mut edge) = (start, edge);
        loop {
            used[edge] = true;
            let [i, j] = edges[edge];
            here = if i == here { j } else { i };
            if here == start {
                chains.push(Chain { vertices, closed: true });
                return;
            }
            vertices.push(here);
            let onward = at[here as usize].iter().find(|&&e| !used[e as usize]);
            match onward {
                Some(&e) if at[here as usize].len() == 2 => edge = e as usize,
                _ => {
                    chains.push(Chain { vertices, closed: false });
                    return;
                }
            }
        }
    };
    // Chains with ends come first; the remaining edges form loops.
    for (e, &[i, j]) in edges.iter().enumerate() {
        for start in [i, j] {
            if !used[e] && i != j && at[start as usize].len() != 2 {
                walk(start, e, &mut used);
            }
        }
    }
    for (e, &[i, j]) in edges.iter().enumerate() {
        if !used[e] && i != j {
            walk(i, e, &mut used);
        }
    }
    chains
}

/// Unit tangents at the points of a chain.
fn tangents(points: &[Point], closed: bool) -> Vec<Vector> {
    let n = points.len();
    let mut last = Vector::x();
    (0..n)
        .map(|k| {
            let (before, after) = if closed {
                ((k + n - 1) % n, (k + 1) % n)
            } else {
                (k.saturating_sub(1), (k + 1).min(n - 1))
            };
            // The sum of the unit directions of both edges, so that the ring halves the angle between them.
            let unit = |a: usize, b: usize| (points[b] - points[a]).try_normalize(0.0).unwrap_or_default();
            let sum = unit(before, k) + unit(k, after);
            last = sum.try_normalize(1e-9).unwrap_or(last);
            last
        })
        .collect()
}

/// Unit vectors perpendicular to the tangents, transported without twist. Around a loop, the angle between
/// the first vector and its transport is spread evenly over all points.
fn frames(points: &[Point], tangents: &[Vector], closed: bool) -> Vec<Vector> {
    let across = |t: &Vector| {
        let axis = if t.z.abs() < 0.9 { Vector::z() } else { Vector::x() };
        (axis - t * t.dot(&axis)).normalize()
    };
    let mut frames = vec![across(&tangents[0])];
    for k in 1..points.len() {
        frames.push(transport(&frames[k - 1], &points[k - 1], &points[k], &tangents[k - 1], &tangents[k]));
    }
    if closed {
        let n = points.len();
        let back = transport(&frames[n - 1], &points[n - 1], &points[0], &tangents[n - 1], &tangents[0]);
        let (u, t) = (frames[0], tangents[0]);
        let turn = back.dot(&t.cross(&u)).atan2(back.dot(&u));
        for k in 0..n {
            let (s, c) = (-turn * k as f64 / n as f64).sin_cos();
            frames[k] = frames[k] * c + tangents[k].cross(&frames[k]) * s;
        }
    }
    frames
}

/// One step of the double reflection method.
fn transport(u: &Vector, from: &Point, to: &Point, t0: &Vector, t1: &Vector) -> Vector {
    let reflect = |v: &Vector, normal: &Vector| {
        let square = normal.norm_squared();
        if square > 0.0 { v - normal * (2.0 * normal.dot(v) / square) } else { *v }
    };
    let step = to - from;
    let (left, tangent) = (reflect(u, &step), reflect(t0, &step));
    let moved = reflect(&left, &(t1 - tangent));
    // Rounding and repeated points may leave it not perpendicular to the tangent.
    let perpendicular = moved - t1 * t1.dot(&moved);
    perpendicular.try_normalize(1e-9).unwrap_or_else(|| {
        let axis = if t1.z.abs() < 0.9 { Vector::z() } else { Vector::x() };
        (axis - t1 * t1.dot(&axis)).normalize()
    })
}

#[cfg(test)]
mod tests;
