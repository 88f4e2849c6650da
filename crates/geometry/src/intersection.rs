//! Exact intersection tests on `robust`'s predicates.
//!
//! All sets are closed: touching counts as intersecting. A degenerate element is the set that it spans: an
//! edge of zero length is a point, a triangle of zero area is the union of its edges. The answers are those
//! of exact arithmetic on the coordinates as they are stored, with no tolerance.
//!
//! **Range.** The predicates (Shewchuk 1997) are exact as long as nothing overflows or underflows: every
//! coordinate must be finite and zero or of magnitude between 1e-90 and 1e100. (A nonzero coordinate of at
//! least 2^-300 is a multiple of 2^-352, so are the differences; products of three of them are multiples of
//! 2^-1056, above the smallest subnormal 2^-1074. Products of three differences below 2^334 stay below
//! 2^1005, which leaves room for sums and for splitting.)

use crate::point::Point;
use robust::{Coord, Coord3D};

/// Whether the closed segment `edge` and the closed triangle `triangle` share a point, decided exactly.
/// Touching and coplanar overlap count as intersecting.
pub fn edge_triangle(edge: [&Point; 2], triangle: [&Point; 3]) -> bool {
    let [p, q] = edge;
    let [a, b, c] = triangle;
    let (p_side, q_side) = (side(a, b, c, p), side(a, b, c, q));
    if p_side * q_side > 0 {
        return false;
    }
    if p_side != 0 || q_side != 0 {
        // The triangle has area, and the edge crosses or touches its plane in one point. This point is in the
        // triangle unless the line of the edge passes two sides of the triangle differently.
        return same_sign([side(p, q, a, b), side(p, q, b, c), side(p, q, c, a)]);
    }
    match projection([a, b, c]) {
        // All five points lie in the plane of the triangle, on which the projection is one-to-one. An edge
        // with an end outside can only enter across a side.
        Some(axis) => {
            in_triangle(axis, p, triangle)
                || [[a, b], [b, c], [c, a]].iter().any(|&side| edges_cross(axis, edge, side))
        }
        None => [[a, b], [b, c], [c, a]].iter().any(|&side| edge_edge(edge, side)),
    }
}

/// Whether two closed triangles share a point, decided exactly: whether an edge of one meets the other.
pub fn triangle_triangle(a: [&Point; 3], b: [&Point; 3]) -> bool {
    let meets = |[p, q, r]: [&Point; 3], triangle| {
        [[p, q], [q, r], [r, p]].iter().any(|&edge| edge_triangle(edge, triangle))
    };
    meets(a, b) || meets(b, a)
}

/// Whether two closed segments share a point, decided exactly.
pub fn edge_edge(edge_a: [&Point; 2], edge_b: [&Point; 2]) -> bool {
    let ([a0, a1], [b0, b1]) = (edge_a, edge_b);
    if side(a0, a1, b0, b1) != 0 {
        return false;
    }
    let triples = [[a0, a1, b0], [a0, a1, b1], [b0, b1, a0], [b0, b1, a1]];
    match triples.iter().find_map(|&triple| projection(triple)) {
        Some(axis) => edges_cross(axis, edge_a, edge_b),
        // All four points lie on one line (or are one point): the segments share a point if their boxes do.
        None => boxes_overlap(edge_a, edge_b),
    }
}

/// Whether a point lies on a closed triangle, decided exactly.
pub fn point_on_triangle(point: &Point, triangle: [&Point; 3]) -> bool {
    let [a, b, c] = triangle;
    if side(a, b, c, point) != 0 {
        return false;
    }
    match projection(triangle) {
        Some(axis) => in_triangle(axis, point, triangle),
        None => [[a, b], [b, c], [c, a]].iter().any(|&edge| point_on_edge(point, edge)),
    }
}

/// How the ray from a point upward, along z, crosses a triangle: 1 where it leaves through the front (from which
/// the vertices go counterclockwise), -1 where it enters through the front, 0 where it does not meet the
/// triangle. Decided exactly.
///
/// The sum over all triangles of a closed mesh is the winding number of the surface around a point that is not
/// on it. The ray is moved aside by an infinitesimal (e, e^2, 0), as in "Simulation of simplicity" (Edelsbrunner
/// and Muecke 1990): so it never passes through an edge, and crosses one of two triangles that share one. The
/// point must not lie on the triangle.
pub fn upward_crossing(point: &Point, [a, b, c]: [&Point; 3]) -> i8 {
    let turns = [moved_turn(a, b, point), moved_turn(b, c, point), moved_turn(c, a, point)];
    let is_beside = turns[0] == 0 || turns[1] != turns[0] || turns[2] != turns[0];
    if !is_beside && side(a, b, c, point) == turns[0] { turns[0] } else { 0 }
}

/// Sign of the turn from a over b to p, seen from above, with p moved by (e, e^2). Zero only for an edge that
/// projects to a point.
fn moved_turn(a: &Point, b: &Point, p: &Point) -> i8 {
    let by = |x: f64, y: f64| i8::from(x > y) - i8::from(x < y);
    // The derivatives of the area by the coordinates of p: a.y - b.y, then b.x - a.x.
    [turn(2, a, b, p), by(a.y, b.y), by(b.x, a.x)].into_iter().find(|&sign| sign != 0).unwrap_or(0)
}

/// Whether a point lies on a closed segment, decided exactly.
pub fn point_on_edge(point: &Point, edge: [&Point; 2]) -> bool {
    boxes_overlap([point, point], edge) && are_collinear([edge[0], edge[1], point])
}

/// Whether three points lie on one line, decided exactly: whether a triangle has zero area.
pub fn are_collinear(points: [&Point; 3]) -> bool {
    projection(points).is_none()
}

/// Sign of the volume of a tetrahedron; zero where its points are coplanar.
fn side(a: &Point, b: &Point, c: &Point, d: &Point) -> i8 {
    let coord = |p: &Point| Coord3D { x: p.x, y: p.y, z: p.z };
    sign(robust::orient3d(coord(a), coord(b), coord(c), coord(d)))
}

/// Sign of the area of a triangle projected along an axis.
fn turn(axis: usize, a: &Point, b: &Point, c: &Point) -> i8 {
    let coord = |p: &Point| Coord { x: p[(axis + 1) % 3], y: p[(axis + 2) % 3] };
    sign(robust::orient2d(coord(a), coord(b), coord(c)))
}

fn sign(x: f64) -> i8 {
    i8::from(x > 0.0) - i8::from(x < 0.0)
}

/// An axis along which the projection of the triangle has nonzero area; `None` if the points are collinear.
/// (The three areas are the coordinates of the cross product of its edges.)
fn projection([a, b, c]: [&Point; 3]) -> Option<usize> {
    (0..3).find(|&axis| turn(axis, a, b, c) != 0)
}

/// Whether no two signs are opposite.
fn same_sign(signs: [i8; 3]) -> bool {
    signs.iter().all(|&s| s >= 0) || signs.iter().all(|&s| s <= 0)
}

/// Whether a point of the plane of a triangle lies in the triangle, projected along an axis with nonzero
/// area.
fn in_triangle(axis: usize, p: &Point, [a, b, c]: [&Point; 3]) -> bool {
    same_sign([turn(axis, a, b, p), turn(axis, b, c, p), turn(axis, c, a, p)])
}

/// Whether two coplanar segments share a point, projected along an axis that does not lie in their plane.
fn edges_cross(axis: usize, [a0, a1]: [&Point; 2], [b0, b1]: [&Point; 2]) -> bool {
    let (b0_turn, b1_turn) = (turn(axis, a0, a1, b0), turn(axis, a0, a1, b1));
    let (a0_turn, a1_turn) = (turn(axis, b0, b1, a0), turn(axis, b0, b1, a1));
    if [b0_turn, b1_turn, a0_turn, a1_turn] == [0; 4] {
        // On one line, or points.
        return boxes_overlap([a0, a1], [b0, b1]);
    }
    // Each segment intersects the line of the other, and the lines are not parallel: for parallel lines, and
    // for an edge that is a point beside the line of the other, two of the signs are equal and not 0.
    b0_turn * b1_turn <= 0 && a0_turn * a1_turn <= 0
}

/// Whether the closed boxes of two segments share a point.
fn boxes_overlap([a0, a1]: [&Point; 2], [b0, b1]: [&Point; 2]) -> bool {
    (0..3).all(|k| a0[k].min(a1[k]) <= b0[k].max(b1[k]) && b0[k].min(b1[k]) <= a0[k].max(a1[k]))
}

#[cfg(test)]
mod tests;
