//! Surfaces with smooth normals, but for creases.
//!
//! Neighbouring triangles share a normal at a vertex unless they meet at a crease when the surface is at rest: a cuboid
//! keeps its edges, a sheet stays smooth however it folds, and nothing flickers from frame to frame.

use bowknot_geometry::{Point, UnionFind, Vector};

/// Cosine of the angle between two triangles' normals from which on their edge is a crease: 40 degrees.
const CREASE: f64 = 0.766;

/// Triangles whose corners are vertices with one normal each.
#[derive(Clone, Debug, Default)]
pub struct Surface {
    /// Vertex of the mesh that each split vertex stands for.
    pub sources: Vec<u32>,
    /// Triangles over the split vertices, in the order given.
    pub triangles: Vec<[u32; 3]>,
}

impl Surface {
    /// Splits the vertices at creases of the surface at rest. O(t log t) for t triangles.
    pub fn new(triangles: &[[u32; 3]], rest: &[Point]) -> Self {
        let normals: Vec<Vector> = triangles
            .iter()
            .map(|&t| {
                let n = normal(t, rest);
                n.try_normalize(0.0).unwrap_or_default()
            })
            .collect();

        // Corners, three a triangle, are joined across edges that are no creases.
        let mut joined = UnionFind::new(3 * triangles.len());
        let mut sides: Vec<([u32; 2], u32)> = Vec::with_capacity(3 * triangles.len());
        for (t, corners) in triangles.iter().enumerate() {
            for k in 0..3 {
                let (i, j) = (corners[k], corners[(k + 1) % 3]);
                sides.push(([i.min(j), i.max(j)], t as u32));
            }
        }
        sides.sort_unstable();
        for pair in sides.windows(2) {
            let ([edge, other], [s, t]) = ([pair[0].0, pair[1].0], [pair[0].1 as usize, pair[1].1 as usize]);
            if edge != other || normals[s].dot(&normals[t]) < CREASE {
                continue;
            }
            for vertex in edge {
                let corner = |t: usize| {
                    let k = triangles[t].iter().position(|&v| v == vertex).unwrap_or(0);
                    (3 * t + k) as u32
                };
                joined.join(corner(s), corner(t));
            }
        }

        let mut surface = Self::default();
        let mut split = vec![u32::MAX; 3 * triangles.len()];
        for (t, corners) in triangles.iter().enumerate() {
            let mut renumbered = [0; 3];
            for k in 0..3 {
                let set = joined.find((3 * t + k) as u32) as usize;
                if split[set] == u32::MAX {
                    split[set] = surface.sources.len() as u32;
                    surface.sources.push(corners[k]);
                }
                renumbered[k] = split[set];
            }
            surface.triangles.push(renumbered);
        }
        surface
    }

    /// Unit normals of the split vertices: those of their triangles, weighted by area.
    pub fn normals(&self, positions: &[Point]) -> Vec<Vector> {
        let mut normals = vec![Vector::zeros(); self.sources.len()];
        for &triangle in &self.triangles {
            let n = normal(triangle.map(|v| self.sources[v as usize]), positions);
            triangle.iter().for_each(|&v| normals[v as usize] += n);
        }
        normals.iter().map(|n| n.try_normalize(0.0).unwrap_or(Vector::z())).collect()
    }
}

/// Twice the area times the unit normal.
fn normal([i, j, k]: [u32; 3], positions: &[Point]) -> Vector {
    let [a, b, c] = [i, j, k].map(|v| positions[v as usize]);
    (b - a).cross(&(c - a))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two triangles that share an edge, the second turned up by an angle [deg].
    fn hinge(angle: f64) -> ([[u32; 3]; 2], Vec<Point>) {
        let (s, c) = angle.to_radians().sin_cos();
        let points = [[0.0, 0.0, 0.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [c, 0.0, s]].map(Point::from);
        ([[0, 1, 2], [1, 0, 3]], points.to_vec())
    }

    #[test]
    fn smooth_edges_share_normals_and_creases_do_not() {
        let (triangles, points) = hinge(30.0);
        let smooth = Surface::new(&triangles, &points);
        assert_eq!(smooth.sources, [0, 1, 2, 3]);
        let n = smooth.normals(&points);
        assert!((n[0] - n[1]).norm() < 1e-12);
        // Half way between the two triangles' normals.
        assert!((n[0].angle(&n[2]).to_degrees() - 15.0).abs() < 1e-9, "{n:?}");

        let (triangles, points) = hinge(90.0);
        let crease = Surface::new(&triangles, &points);
        assert_eq!(crease.sources, [0, 1, 2, 1, 0, 3]);
        let n = crease.normals(&points);
        assert!((n[0] - n[2]).norm() < 1e-12 && n[0].dot(&n[3]).abs() < 1e-12);
    }

    /// What is smooth at rest stays smooth however it folds.
    #[test]
    fn creases_are_those_at_rest() {
        let (triangles, flat) = hinge(0.0);
        let surface = Surface::new(&triangles, &flat);
        let (_, folded) = hinge(120.0);
        let n = surface.normals(&folded);
        assert!((n[0].angle(&n[2]).to_degrees() - 60.0).abs() < 1e-9);
    }

    #[test]
    fn a_cube_keeps_its_edges() {
        let points: Vec<Point> =
            (0..8).map(|k| Point::new(f64::from(k & 1), f64::from(k >> 1 & 1), f64::from(k >> 2))).collect();
        let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let triangles: Vec<[u32; 3]> =
            quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
        let surface = Surface::new(&triangles, &points);
        assert_eq!(surface.sources.len(), 24);
        for (n, &v) in surface.normals(&points).iter().zip(&surface.sources) {
            assert!((n.abs().max() - 1.0).abs() < 1e-12);
            assert!(n.dot(&(points[v as usize] - Point::new(0.5, 0.5, 0.5))) > 0.0, "it points outward");
        }
    }

    #[test]
    fn flat_triangles_get_a_normal() {
        let points = vec![Point::origin(); 3];
        let surface = Surface::new(&[[0, 1, 2]], &points);
        assert!(surface.normals(&points).iter().all(|n| (n.norm() - 1.0).abs() < 1e-12));
    }
}
