//! Normals of surfaces: smooth, except at creases.
//!
//! Neighboring triangles share a normal at a vertex unless their edge is a crease of the surface at rest. So
//! a cuboid keeps its edges, a sheet stays smooth however it folds, and nothing flickers from frame to frame.

use bowknot_geometry::{Point, UnionFind, Vector};

/// Cosine of the angle between the normals of two triangles above which their edge is a crease: 40 degrees.
const CREASE: f64 = 0.766;

/// Triangles over vertices that are split at creases, so that each has one normal.
#[derive(Clone, Debug, Default)]
pub struct Surface {
    /// For each split vertex, the vertex of the mesh that it comes from.
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

        // The corners, three per triangle, are joined across edges that are not creases.
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

    /// Unit normals of the split vertices: the mean of the normals of their triangles, weighted by area.
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
mod tests;
