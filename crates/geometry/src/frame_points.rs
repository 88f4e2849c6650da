//! Points that show how the edges of a rod are turned about themselves.
//!
//! A rod resists twist, so each of its edges has a material frame: the tangent t, a director d1 across it, and
//! d2 = t x d1. A *frame point* beside the middle of the edge, at half of its length, shows where d1 points.

use crate::point::{Point, Vector};
use std::collections::VecDeque;

/// Appends a frame point of each edge to the positions; the edges with their frame points. Directors are transported
/// from edge to edge without twist, from an edge of each connected part on (Bishop, "There is more than one way to
/// frame a curve", 1975).
pub fn add_frame_points(positions: &mut Vec<Point>, edges: &[[u32; 2]]) -> Vec<[u32; 3]> {
    let mut around = vec![Vec::new(); positions.len()];
    for (index, edge) in edges.iter().enumerate() {
        edge.iter().for_each(|&v| around[v as usize].push(index));
    }
    let tangent = |edge: [u32; 2]| unit(positions[edge[1] as usize] - positions[edge[0] as usize]);
    let mut directors: Vec<Option<Vector>> = vec![None; edges.len()];
    let mut queue = VecDeque::new();
    for first in 0..edges.len() {
        if directors[first].is_none() {
            directors[first] = Some(across(&tangent(edges[first])));
            queue.push_back(first);
        }
        while let Some(index) = queue.pop_front() {
            let (t, d) = (tangent(edges[index]), directors[index].unwrap_or_else(Vector::zeros));
            for &next in edges[index].iter().flat_map(|&v| &around[v as usize]) {
                if directors[next].is_none() {
                    // Edges may be listed against each other; the director does not depend on the direction.
                    let shared = edges[index].iter().find(|v| edges[next].contains(v));
                    let end = |edge: [u32; 2], sign: f64| if Some(&edge[1]) == shared { sign } else { -sign };
                    let (from, to) =
                        (t * end(edges[index], 1.0), tangent(edges[next]) * end(edges[next], -1.0));
                    directors[next] = Some(transported(&d, &from, &to));
                    queue.push_back(next);
                }
            }
        }
    }
    let first = positions.len() as u32;
    for (edge, director) in edges.iter().zip(directors) {
        let [a, b] = edge.map(|v| positions[v as usize]);
        positions.push(a + (b - a) * 0.5 + director.unwrap_or_else(Vector::zeros) * (0.5 * (b - a).norm()));
    }
    edges.iter().zip(first..).map(|(&[a, b], p)| [a, b, p]).collect()
}

/// Where the frame point `p` of an edge goes as its ends move `from` somewhere `to` somewhere else, without a turn
/// about the edge: its place along the edge and its distance from it stay.
pub fn carried_frame_point(from: [&Point; 2], to: [&Point; 2], p: &Point) -> Point {
    let [old, new] = [from, to].map(|[a, b]| b - a);
    let [middle, place] = [from, to].map(|[a, b]| a + (b - a) * 0.5);
    place + transported(&(p - middle), &unit(old), &unit(new))
}

/// The vector `v` turned by the smallest rotation that takes the unit vector `from` to `to`.
pub fn transported(v: &Vector, from: &Vector, to: &Vector) -> Vector {
    let (axis, cosine) = (from.cross(to), from.dot(to));
    if cosine <= -1.0 + 1e-12 {
        // Any axis across turns it by half a turn.
        let axis = across(from);
        return axis * (2.0 * axis.dot(v)) - v;
    }
    v * cosine + axis.cross(v) + axis * (axis.dot(v) / (1.0 + cosine))
}

fn unit(v: Vector) -> Vector {
    let length = v.norm();
    if length > 0.0 { v / length } else { Vector::x() }
}

/// A unit vector across the unit vector `t`.
fn across(t: &Vector) -> Vector {
    unit(t.cross(&Vector::ith(t.iamin(), 1.0)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A helix of 40 edges.
    fn helix() -> (Vec<Point>, Vec<[u32; 2]>) {
        let at = |k: u32| {
            let angle = 0.4 * f64::from(k);
            Point::new(angle.cos(), angle.sin(), 0.1 * angle)
        };
        ((0..=40).map(at).collect(), (0..40).map(|k| [k, k + 1]).collect())
    }

    #[test]
    fn frame_points_stand_across_their_edges_and_do_not_twist() {
        let (mut x, edges) = helix();
        // One against the others: its director is that of the path.
        let mut listed = edges.clone();
        listed[7].reverse();
        let frames = add_frame_points(&mut x, &listed);
        assert_eq!((frames.len(), x.len(), frames[3]), (40, 81, [3, 4, 44]));
        let parts = |k: usize| {
            let [a, b] = edges[k].map(|v| x[v as usize]);
            (unit(b - a), b - a, x[frames[k][2] as usize] - (a + (b - a) * 0.5))
        };
        for k in 0..40 {
            let (t, edge, d) = parts(k);
            assert!(d.dot(&t).abs() < 1e-12 && (d.norm() - 0.5 * edge.norm()).abs() < 1e-12);
            if k > 0 {
                let (t0, _, d0) = parts(k - 1);
                assert!((transported(&unit(d0), &t0, &t) - unit(d)).norm() < 1e-12, "{k}");
            }
        }
    }

    #[test]
    fn a_frame_point_follows_its_edge() {
        let [a, b, p] = [Point::origin(), Point::new(2.0, 0.0, 0.0), Point::new(1.0, 0.0, 1.0)];
        let [c, d] = [Point::new(0.0, 0.0, 1.0), Point::new(0.0, 3.0, 1.0)];
        let carried = carried_frame_point([&a, &b], [&c, &d], &p);
        assert!((carried - Point::new(0.0, 1.5, 2.0)).norm() < 1e-14);
        // Half a turn has no smallest rotation: one of them.
        let back = carried_frame_point([&a, &b], [&b, &a], &p);
        assert!(
            ((back - Point::new(1.0, 0.0, 0.0)).norm() - 1.0).abs() < 1e-14 && (back.x - 1.0).abs() < 1e-14
        );
    }
}
