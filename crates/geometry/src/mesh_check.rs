//! What is wrong with a triangle mesh that someone hands in.

use crate::{Point, Vector};

/// The height of a triangle over its longest edge, as a part of that edge, at which its area cannot
/// be told from rounding: its computed normal may then point anywhere.
const ZERO_HEIGHT: f64 = 4.0 * f64::EPSILON;

/// Something in a mesh that simulating it would trip over.
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
    #[error("triangle {triangle} names vertex {vertex}, but there are only {vertex_count} vertices")]
    VertexOutOfRange {
        /// Which triangle.
        triangle: u32,
        /// The vertex it names.
        vertex: u32,
        /// How many vertices there are.
        vertex_count: usize,
    },
    /// A triangle has zero area, exactly or within rounding: collinear, coincident or repeated
    /// vertices.
    #[error("triangle {triangle} (vertices {}, {}, {}) has zero area, at {}", vertices[0], vertices[1], vertices[2], place(centre))]
    ZeroArea {
        /// Which triangle.
        triangle: u32,
        /// Its vertices.
        vertices: [u32; 3],
        /// Its centre [m].
        centre: Point,
    },
    /// A triangle has the same three vertices as an earlier one, in whatever order.
    #[error("triangle {triangle} repeats triangle {first} (vertices {}, {}, {}), at {}", vertices[0], vertices[1], vertices[2], place(centre))]
    RepeatedTriangle {
        /// The later triangle.
        triangle: u32,
        /// The first triangle with these vertices.
        first: u32,
        /// Vertices of the later triangle.
        vertices: [u32; 3],
        /// Its centre [m].
        centre: Point,
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

/// Every problem of a triangle mesh: by kind in the order of [`MeshProblem`], then by index.
///
/// A triangle with vertices out of range or not finite is not judged further. O(n log n).
pub fn check_mesh(positions: &[Point], triangles: &[[u32; 3]]) -> Vec<MeshProblem> {
    let vertices = || positions.iter().enumerate().map(|(vertex, position)| (vertex as u32, *position));
    let mut problems: Vec<MeshProblem> = vertices()
        .filter(|(_, position)| !is_finite(position))
        .map(|(vertex, position)| MeshProblem::NonFinite { vertex, position })
        .collect();

    let mut referenced = vec![false; positions.len()];
    for (triangle, &vertex) in triangles.iter().enumerate().flat_map(|(t, vs)| vs.iter().map(move |v| (t, v)))
    {
        match referenced.get_mut(vertex as usize) {
            Some(seen) => *seen = true,
            None => problems.push(MeshProblem::VertexOutOfRange {
                triangle: triangle as u32,
                vertex,
                vertex_count: positions.len(),
            }),
        }
    }

    // Triangles that can be judged, with their corners.
    let judged: Vec<(u32, [u32; 3], [Point; 3])> = triangles
        .iter()
        .enumerate()
        .filter(|(_, vs)| vs.iter().all(|&v| positions.get(v as usize).is_some_and(is_finite)))
        .map(|(t, vs)| (t as u32, *vs, vs.map(|v| positions[v as usize])))
        .collect();
    for &(triangle, vertices, corners) in judged.iter().filter(|(_, _, corners)| has_zero_area(corners)) {
        problems.push(MeshProblem::ZeroArea { triangle, vertices, centre: centre(&corners) });
    }
    problems.extend(repeated(&judged));

    let unreferenced = vertices().filter(|(vertex, _)| !referenced[*vertex as usize]);
    problems
        .extend(unreferenced.map(|(vertex, position)| MeshProblem::UnreferencedVertex { vertex, position }));
    problems
}

fn repeated(judged: &[(u32, [u32; 3], [Point; 3])]) -> Vec<MeshProblem> {
    let mut keyed: Vec<([u32; 3], usize)> = judged
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
            let (triangle, vertices, corners) = judged[place];
            MeshProblem::RepeatedTriangle {
                triangle,
                first: judged[first].0,
                vertices,
                centre: centre(&corners),
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

/// The mean of the corners; each is divided first, for the sum may overflow.
fn centre(corners: &[Point; 3]) -> Point {
    Point::from(corners.iter().fold(Vector::zeros(), |sum, p| sum + p.coords / 3.0))
}

fn place(p: &Point) -> String {
    format!("({}, {}, {})", p.x, p.y, p.z)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square() -> (Vec<Point>, Vec<[u32; 3]>) {
        let positions = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        (positions.map(|[x, y]| Point::new(x, y, 0.5)).to_vec(), vec![[0, 1, 2], [0, 2, 3]])
    }

    fn messages(positions: &[Point], triangles: &[[u32; 3]]) -> Vec<String> {
        check_mesh(positions, triangles).iter().map(ToString::to_string).collect()
    }

    #[test]
    fn a_good_mesh_has_no_problem() {
        let (positions, triangles) = square();
        assert_eq!(check_mesh(&positions, &triangles), []);
        // Neither far away, nor tiny, nor as a needle that is still a triangle.
        for (scale, shift) in [(1.0, 1e4), (1e-200, 0.0), (1e200, 0.0)] {
            let moved: Vec<Point> = positions.iter().map(|p| p.map(|x| x * scale + shift)).collect();
            assert_eq!(check_mesh(&moved, &triangles), []);
        }
        let needle: Vec<Point> = positions.iter().map(|p| Point::new(p.x, p.y * 1e-12, p.z)).collect();
        assert_eq!(check_mesh(&needle, &triangles), []);
    }

    #[test]
    fn every_problem_names_its_element_and_place() {
        let (mut positions, mut triangles) = square();
        positions.push(Point::new(2.0, 2.0, 0.5));
        positions.push(Point::new(f64::NAN, 0.0, 0.0));
        triangles.extend([[0, 2, 4], [3, 0, 2], [1, 1, 2], [0, 1, 9], [2, 3, 0]]);
        assert_eq!(
            messages(&positions, &triangles),
            [
                "vertex 5 has a coordinate that is not finite: (NaN, 0, 0)",
                "triangle 5 names vertex 9, but there are only 6 vertices",
                "triangle 2 (vertices 0, 2, 4) has zero area, at (1, 1, 0.5)",
                "triangle 4 (vertices 1, 1, 2) has zero area, at (1, 0.3333333333333333, 0.5)",
                "triangle 3 repeats triangle 1 (vertices 3, 0, 2), at (0.3333333333333333, 0.6666666666666666, 0.5)",
                "triangle 6 repeats triangle 1 (vertices 2, 3, 0), at (0.3333333333333333, 0.6666666666666666, 0.5)",
                "vertex 5 belongs to no triangle, at (NaN, 0, 0)",
            ]
        );
    }

    #[test]
    fn zero_area_is_found_where_rounding_hides_it() {
        // Collinear exactly in decimal, but not as stored.
        let line = [0.1, 0.2, 0.7].map(|t| Point::new(t, 3.0 * t, 0.3 * t));
        assert_eq!(messages(&line, &[[0, 1, 2]]).len(), 1);
        let point = [Point::new(1e4, 0.0, 1.0); 3];
        assert_eq!(messages(&point, &[[0, 1, 2]]).len(), 1);
    }
}
