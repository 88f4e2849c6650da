//! Faults of triangle meshes.

use crate::point::{Point, Vector};
use crate::vertex_range::VertexOutOfRange;

/// The height of a triangle over its longest edge, relative to that edge, at which its area is of the size of
/// rounding errors: the computed normal may then have any direction.
const ZERO_HEIGHT: f64 = 4.0 * f64::EPSILON;

/// A fault of a mesh that may disturb a simulation.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MeshProblem {
    /// A coordinate is infinite or not a number.
    #[error("vertex {vertex} has a coordinate that is not finite: {}", place(position))]
    NonFinite {
        /// The vertex.
        vertex: u32,
        /// Its position [m].
        position: Point,
    },
    /// A triangle names a vertex that does not exist.
    #[error(transparent)]
    VertexOutOfRange(#[from] VertexOutOfRange),
    /// A triangle has zero area, exactly or within rounding, because of collinear, coincident or repeated
    /// vertices.
    #[error("triangle {triangle} (vertices {}, {}, {}) has zero area, at \
             {}", vertices[0], vertices[1], vertices[2], place(center))]
    ZeroArea {
        /// Which triangle.
        triangle: u32,
        /// Its vertices.
        vertices: [u32; 3],
        /// Its center [m].
        center: Point,
    },
    /// A triangle has the same three vertices as an earlier one, in any order.
    #[error("triangle {triangle} repeats triangle {first} (vertices {}, {}, {}), at \
             {}", vertices[0], vertices[1], vertices[2], place(center))]
    RepeatedTriangle {
        /// The later triangle.
        triangle: u32,
        /// The first triangle with these vertices.
        first: u32,
        /// Vertices of the later triangle.
        vertices: [u32; 3],
        /// Its center [m].
        center: Point,
    },
    /// No triangle uses a vertex.
    #[error("vertex {vertex} belongs to no triangle, at {}", place(position))]
    UnreferencedVertex {
        /// The vertex.
        vertex: u32,
        /// Its position [m].
        position: Point,
    },
}

/// All problems of a triangle mesh: by type in the order of [`MeshProblem`], then by index.
///
/// A triangle with vertices out of range or not finite is not checked further. O(n log n).
pub fn check_mesh(positions: &[Point], triangles: &[[u32; 3]]) -> Vec<MeshProblem> {
    let vertices = || positions.iter().enumerate().map(|(vertex, position)| (vertex as u32, *position));
    let mut problems: Vec<MeshProblem> = vertices()
        .filter(|(_, position)| !is_finite(position))
        .map(|(vertex, position)| MeshProblem::NonFinite { vertex, position })
        .collect();

    let mut referenced = vec![false; positions.len()];
    for (index, vertices) in triangles.iter().enumerate() {
        problems.extend(
            VertexOutOfRange::of("triangle", index, vertices, positions.len()).map(MeshProblem::from),
        );
        for &vertex in vertices {
            if let Some(seen) = referenced.get_mut(vertex as usize) {
                *seen = true;
            }
        }
    }

    // Triangles that can be checked, with their corners.
    let checked: Vec<(u32, [u32; 3], [Point; 3])> = triangles
        .iter()
        .enumerate()
        .filter(|(_, vs)| vs.iter().all(|&v| positions.get(v as usize).is_some_and(is_finite)))
        .map(|(t, vs)| (t as u32, *vs, vs.map(|v| positions[v as usize])))
        .collect();
    for &(triangle, vertices, corners) in checked.iter().filter(|(_, _, corners)| has_zero_area(corners)) {
        problems.push(MeshProblem::ZeroArea { triangle, vertices, center: center(&corners) });
    }
    problems.extend(repeated(&checked));

    let unreferenced = vertices().filter(|(vertex, _)| !referenced[*vertex as usize]);
    problems
        .extend(unreferenced.map(|(vertex, position)| MeshProblem::UnreferencedVertex { vertex, position }));
    problems
}

fn repeated(checked: &[(u32, [u32; 3], [Point; 3])]) -> Vec<MeshProblem> {
    let mut keyed: Vec<([u32; 3], usize)> = checked
        .iter()
        .enumerate()
        .map(|(place, &(_, mut vertices, _))| {
            vertices.sort_unstable();
            (vertices, place)
        })
        .collect();
    keyed.sort_unstable();
    let mut later: Vec<(usize, usize)> = keyed
        .chunk_by(|x, y| x.0 == y.0)
        .flat_map(|same| same[1..].iter().map(|&(_, place)| (place, same[0].1)))
        .collect();
    later.sort_unstable();
    later
        .into_iter()
        .map(|(place, first)| {
            let (triangle, vertices, corners) = checked[place];
            MeshProblem::RepeatedTriangle {
                triangle,
                first: checked[first].0,
                vertices,
                center: center(&corners),
            }
        })
        .collect()
}

fn is_finite(p: &Point) -> bool {
    p.iter().all(|x| x.is_finite())
}

fn has_zero_area([a, b, c]: &[Point; 3]) -> bool {
    let edges: [Vector; 3] = [b - a, c - b, a - c];
    let longest = edges.iter().fold(0.0, |longest: f64, e| longest.max(e.amax()));
    if longest == 0.0 {
        return true;
    }
    // Relative to the largest coordinate, so that no square leaves the range of `f64`.
    let [ab, bc, ca] = edges.map(|e| e / longest);
    let longest_squared = ab.norm_squared().max(bc.norm_squared()).max(ca.norm_squared());
    // Twice the area is the height times the longest edge.
    ab.cross(&ca).norm() <= ZERO_HEIGHT * longest_squared
}

/// The mean of the corners. Each is divided first, because the sum may overflow.
fn center(corners: &[Point; 3]) -> Point {
    Point::from(corners.iter().fold(Vector::zeros(), |sum, p| sum + p.coords / 3.0))
}

fn place(p: &Point) -> String {
    format!("({}, {}, {})", p.x, p.y, p.z)
}

#[cfg(test)]
mod tests;
