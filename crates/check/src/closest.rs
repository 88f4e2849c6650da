//! The judge's own closest points of two primitives.
//!
//! Every candidate is a pair of points of the two primitives, to rounding: a vertex of one with the other,
//! and the common normal of both where its feet lie inside. The nearest candidate wins, so that a degenerate
//! or nearly parallel pair, whose common normal means nothing, still has the right distance from its vertices
//! and edges. What is found here is reported or taken for a guess; no verdict rests on it.

use bowknot_geometry::{PairKind, Point, Vector};

/// Closest points of two primitives.
#[derive(Clone, Copy, Debug)]
pub(super) struct Closest {
    /// The closest point of side b [m].
    on_b: Point,
    /// From there to the closest point of side a [m].
    pub offset: Vector,
}

impl Closest {
    /// The distance [m].
    pub fn distance(&self) -> f64 {
        self.offset.norm()
    }

    /// The closest point of either side [m].
    pub fn places(&self) -> [Point; 2] {
        [self.on_b + self.offset, self.on_b]
    }

    fn of(on_a: Point, on_b: Point) -> Self {
        Self { on_b, offset: on_a - on_b }
    }

    /// The same pair with the sides exchanged.
    fn exchanged(self) -> Self {
        Self { on_b: self.on_b + self.offset, offset: -self.offset }
    }

    fn nearer(self, other: Self) -> Self {
        if other.offset.norm_squared() < self.offset.norm_squared() { other } else { self }
    }
}

/// Closest points of a pair, its vertices in the order of [`PairKind`]. A half-space has no vertices here:
/// the first vertex is then compared with itself.
pub(super) fn closest(kind: PairKind, x: &[Point; 4]) -> Closest {
    match kind {
        PairKind::VertexTriangle => vertex_triangle(x[0], [x[1], x[2], x[3]]),
        PairKind::EdgeEdge => edge_edge([x[0], x[1]], [x[2], x[3]]),
        PairKind::VertexEdge => vertex_edge(x[0], [x[1], x[2]]),
        PairKind::VertexVertex => Closest::of(x[0], x[1]),
        PairKind::VertexHalfSpace => Closest::of(x[0], x[0]),
    }
}

/// The normal of the triangle, or of both edges, toward side a. None for other pairs.
pub(super) fn common_normal(kind: PairKind, x: &[Point; 4]) -> Option<Vector> {
    let normal = match kind {
        PairKind::VertexTriangle => triangle_normal([x[1], x[2], x[3]]),
        PairKind::EdgeEdge => perpendicular(x[1] - x[0], x[3] - x[2]),
        _ => return None,
    };
    let side = normal.dot(&(x[0] - x[kind.side_a()]));
    Some(if side < 0.0 { -normal } else { normal })
}

/// Directions from each edge of a pair to each vertex of the other side, perpendicular to the edge to
/// rounding: good guesses where the gap is so small against the edges that the offset of the closest points
/// is mostly rounding.
pub(super) fn across_edges(kind: PairKind, x: &[Point; 4]) -> impl Iterator<Item = Vector> {
    let combinations: &[(usize, [usize; 2])] = match kind {
        PairKind::VertexEdge => &[(0, [1, 2])],
        PairKind::VertexTriangle => &[(0, [1, 2]), (0, [2, 3]), (0, [3, 1])],
        PairKind::EdgeEdge => &[(0, [2, 3]), (1, [2, 3]), (2, [0, 1]), (3, [0, 1])],
        PairKind::VertexVertex | PairKind::VertexHalfSpace => &[],
    };
    combinations.iter().map(move |&(vertex, [i, j])| {
        let along = x[j] - x[i];
        let toward = along.cross(&(x[vertex] - x[i]).cross(&along));
        if vertex < kind.side_a() { toward } else { -toward }
    })
}

/// The normal of a triangle, of any length. It is computed at the corner across from the longest edge: the
/// two long edges of a sliver are nearly parallel.
fn triangle_normal([a, b, c]: [Point; 3]) -> Vector {
    let corners = [[a, b, c], [b, c, a], [c, a, b]];
    let across = |[_, q, r]: &[Point; 3]| (r - q).norm_squared();
    let best = corners.iter().reduce(|best, next| if across(next) > across(best) { next } else { best });
    let [p, q, r] = *best.unwrap_or(&corners[0]);
    perpendicular(q - p, r - p)
}

/// A vector along the cross product of two others, of any length; zero if they are parallel to rounding. If
/// they are nearly parallel, the computed product is mostly rounding along them. That of one and of the rest
/// of the other across it is perpendicular to both within rounding (Gram and Schmidt's method, once
/// repeated).
fn perpendicular(a: Vector, b: Vector) -> Vector {
    if a.norm_squared() < b.norm_squared() {
        return -perpendicular(b, a);
    }
    let Some(along) = a.try_normalize(0.0) else { return Vector::zeros() };
    let across = b - along * along.dot(&b);
    let across = across - along * along.dot(&across);
    along.cross(&across)
}

fn vertex_edge(p: Point, [a, b]: [Point; 2]) -> Closest {
    let along = b - a;
    let length_squared = along.norm_squared();
    let share = if length_squared > 0.0 { along.dot(&(p - a)) / length_squared } else { 0.0 };
    if share <= 0.0 {
        Closest::of(p, a)
    } else if share >= 1.0 {
        Closest::of(p, b)
    } else {
        let offset = (p - a) - along * share;
        Closest { on_b: p - offset, offset }
    }
}

fn vertex_triangle(p: Point, [a, b, c]: [Point; 3]) -> Closest {
    let edges = [[a, b], [b, c], [c, a]];
    let nearest = edges.map(|edge| vertex_edge(p, edge)).into_iter().reduce(Closest::nearer);
    let nearest = nearest.unwrap_or(Closest::of(p, a));
    let normal = triangle_normal([a, b, c]);
    let inside = edges.iter().all(|[i, j]| (j - i).cross(&(p - i)).dot(&normal) >= 0.0);
    let norm_squared = normal.norm_squared();
    if !(inside && norm_squared > 0.0) {
        return nearest;
    }
    let offset = normal * (normal.dot(&(p - a)) / norm_squared);
    nearest.nearer(Closest { on_b: p - offset, offset })
}

fn edge_edge(first: [Point; 2], second: [Point; 2]) -> Closest {
    let ends = [
        vertex_edge(first[0], second),
        vertex_edge(first[1], second),
        vertex_edge(second[0], first).exchanged(),
        vertex_edge(second[1], first).exchanged(),
    ];
    let nearest = ends.into_iter().reduce(Closest::nearer).unwrap_or(ends[0]);
    let (d, e) = (first[1] - first[0], second[1] - second[0]);
    let normal = perpendicular(d, e);
    let (norm_squared, area) = (normal.norm_squared(), d.cross(&e).dot(&normal));
    if norm_squared <= 0.0 || area == 0.0 {
        return nearest;
    }
    // Where the common normal meets either edge, as shares of their lengths.
    let between = second[0] - first[0];
    let on_first = between.cross(&e).dot(&normal) / area;
    let on_second = between.cross(&d).dot(&normal) / area;
    if !((0.0..=1.0).contains(&on_first) && (0.0..=1.0).contains(&on_second)) {
        return nearest;
    }
    let offset = -normal * (normal.dot(&between) / norm_squared);
    nearest.nearer(Closest { on_b: second[0] + e * on_second, offset })
}

#[cfg(test)]
mod tests;
