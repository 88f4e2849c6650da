//! Strands as tubes with round ends.
//!
//! Edges are joined into chains at vertices where two of them meet. Along a chain a frame is carried without twist
//! (parallel transport by double reflection: Wang, Jüttler, Zheng and Liu, "Computation of Rotation Minimizing Frames",
//! ACM Transactions on Graphics 27, 2008), so that the rings of a tube do not turn against each other.

use bowknot_geometry::{Point, Vector};
use std::f64::consts::TAU;

/// Rings that round an end off, beyond the last point of the chain.
const CAP_RINGS: usize = 2;

/// A vertex of a tube.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TubeVertex {
    /// Where it is [m].
    pub position: Point,
    /// Outward, a unit vector.
    pub normal: Vector,
    /// Vertex of the strand that it belongs to.
    pub source: u32,
}

/// The tubes of all strands; their triangles are the same in all frames.
#[derive(Clone, Debug, Default)]
pub struct Tubes {
    chains: Vec<Chain>,
    sides: usize,
    /// Triangles over the vertices that [`Self::vertices`] gives, outward.
    pub triangles: Vec<[u32; 3]>,
}

/// A sequence of vertices joined by edges.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Chain {
    vertices: Vec<u32>,
    /// Whether the last vertex is joined to the first.
    closed: bool,
}

impl Tubes {
    /// Joins edges into chains and lays triangles over their rings of `sides` vertices, at least 3.
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

    /// The vertices of tubes of this radius [m] about the strands.
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
            // An end is half a ball: rings at growing angles beyond the last, the outermost all but a point.
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

/// Chains of edges: they end where other than two edges meet. In the order of their first edges.
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
    // From the ends first; what is left are loops.
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
            // Directions of both edges, each a unit: the ring halves the angle between them.
            let unit = |a: usize, b: usize| (points[b] - points[a]).try_normalize(0.0).unwrap_or_default();
            let sum = unit(before, k) + unit(k, after);
            last = sum.try_normalize(1e-9).unwrap_or(last);
            last
        })
        .collect()
}

/// Unit vectors across the tangents, carried along without twist; around a loop the rest of the turn is spread evenly.
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
    // Rounding and repeated points may leave it askew.
    let askew = moved - t1 * t1.dot(&moved);
    askew.try_normalize(1e-9).unwrap_or_else(|| {
        let axis = if t1.z.abs() < 0.9 { Vector::z() } else { Vector::x() };
        (axis - t1 * t1.dot(&axis)).normalize()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edges_are_joined_into_chains() {
        // A path of three edges given out of order, a fork at 5, a loop.
        let edges = [[2, 3], [0, 1], [2, 1], [4, 5], [5, 6], [5, 7], [8, 9], [9, 10], [10, 8]];
        let found = chains(&edges);
        let open = |vertices: &[u32]| Chain { vertices: vertices.to_vec(), closed: false };
        assert_eq!(
            found,
            [
                open(&[3, 2, 1, 0]),
                open(&[4, 5]),
                open(&[5, 6]),
                open(&[5, 7]),
                Chain { vertices: vec![8, 9, 10], closed: true }
            ]
        );
    }

    fn helix() -> Vec<Point> {
        (0..40).map(|k| f64::from(k) * 0.3).map(|a| Point::new(a.cos(), a.sin(), 0.1 * a)).collect()
    }

    #[test]
    fn rings_lie_on_the_tube_and_do_not_twist() {
        let points = helix();
        let edges: Vec<[u32; 2]> = (1..points.len() as u32).map(|k| [k - 1, k]).collect();
        let (sides, radius) = (8, 0.05);
        let tubes = Tubes::new(&edges, sides);
        let vertices = tubes.vertices(&points, radius);
        assert_eq!(vertices.len(), (points.len() + 2 * CAP_RINGS) * sides);
        for v in &vertices {
            let distance = (v.position - points[v.source as usize]).norm();
            assert!((distance - radius).abs() < 1e-6 * radius + 2e-6, "{distance}");
            assert!((v.normal.norm() - 1.0).abs() < 1e-12);
        }
        // Neighbouring rings face each other: the way from a vertex to the same one of the next ring runs along the strand.
        let body = &vertices[CAP_RINGS * sides..(points.len() + CAP_RINGS) * sides];
        for k in 0..body.len() - sides {
            let (a, b) = (&body[k], &body[k + sides]);
            let along = points[b.source as usize] - points[a.source as usize];
            assert!((b.position - a.position).angle(&along) < 0.1);
        }
    }

    /// A closed surface: every edge has two triangles with opposite windings, and the volume is that of the tube.
    fn check_closed(tubes: &Tubes, vertices: &[TubeVertex], volume: f64) {
        let mut seen = std::collections::BTreeMap::new();
        let mut measured = 0.0;
        for &[i, j, k] in &tubes.triangles {
            for side in [[i, j], [j, k], [k, i]] {
                assert!(seen.insert(side, ()).is_none(), "{side:?} twice in the same direction");
            }
            let [a, b, c] = [i, j, k].map(|v| vertices[v as usize].position.coords);
            measured += a.dot(&b.cross(&c)) / 6.0;
        }
        let open = seen.keys().filter(|[a, b]| !seen.contains_key(&[*b, *a])).count();
        // The two outermost rings of each open chain bound a hole of a thousandth of the radius.
        let ends = tubes.chains.iter().filter(|c| !c.closed).count();
        assert_eq!(open, 2 * ends * tubes.sides);
        assert!((measured / volume - 1.0).abs() < 0.03, "{measured} m3 for {volume} m3");
    }

    #[test]
    fn tubes_are_closed_and_face_outward() {
        let radius = 0.1;
        let straight: Vec<Point> = (0..5).map(|k| Point::new(f64::from(k), 0.3, 0.0)).collect();
        let tubes = Tubes::new(&[[0, 1], [1, 2], [2, 3], [3, 4]], 32);
        let area = TAU / 2.0 * radius * radius;
        // Half a ball at each end, coarsely: two thirds of a radius each, less what two rings miss.
        check_closed(&tubes, &tubes.vertices(&straight, radius), area * (4.0 + 2.0 * radius * 0.6));

        let n = 60;
        let ring: Vec<Point> = (0..n)
            .map(|k| (TAU * f64::from(k) / f64::from(n)).sin_cos())
            .map(|(s, c)| Point::new(c, s, 0.2 * c))
            .collect();
        let edges: Vec<[u32; 2]> = (0..n as u32).map(|k| [k, (k + 1) % n as u32]).collect();
        let tubes = Tubes::new(&edges, 16);
        let length: f64 = edges.iter().map(|&[a, b]| (ring[a as usize] - ring[b as usize]).norm()).sum();
        check_closed(&tubes, &tubes.vertices(&ring, radius), area * 0.974 * length);
    }

    #[test]
    fn repeated_points_do_no_harm() {
        let points = [[0.0, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, 0.0]].map(Point::from);
        let tubes = Tubes::new(&[[0, 1], [1, 2], [2, 3], [3, 3]], 6);
        assert!(tubes.vertices(&points, 0.1).iter().all(|v| v.position.iter().all(|c| c.is_finite())));
    }
}
