//! Closest points, rays and insides of a triangle mesh at given positions.
//!
//! The tree is that of the search: packed nodes of sixteen `f32` boxes, rounded outward, refitted to new
//! positions. What the boxes leave over is decided in `f64`: distances by
//! [`bowknot_geometry::distance::vertex_triangle`], hits and insides by exact predicates.

mod closest;
mod descend;
mod inside;
mod local_point;
mod ray;

use crate::frame::{self, LocalVertex};
use crate::tree::Tree;
use bowknot_geometry::{Point, Vector, VertexOutOfRange};
use descend::Placed;
use rayon::prelude::*;

pub use closest::SurfacePoint;
pub use ray::RayHit;

/// Below this number of points a thread does not share its work.
const MIN_POINTS: usize = 64;

/// Why a mesh is refused.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum MeshQueryError {
    /// A triangle names a vertex that does not exist.
    #[error(transparent)]
    Vertex(#[from] VertexOutOfRange),
    /// There are more or fewer positions than vertices.
    #[error("{given} positions for a mesh of {vertices} vertices")]
    PositionCount {
        /// Positions given.
        given: usize,
        /// Vertices of the mesh.
        vertices: usize,
    },
}

/// A triangle mesh at some positions, for queries: the closest point of the surface, the first triangle that a
/// ray meets, whether a point is inside.
///
/// Results depend on the input alone, not on earlier positions or the number of threads; of equals the triangle with
/// the smallest index is taken. Triangles with a vertex that is not finite or beyond 1e15 m are never found.
/// Exact decisions need coordinates that are zero or at least 1e-90 m, see [`bowknot_geometry::intersection`].
///
/// ```
/// use bowknot_proximity::geometry::{Point, Vector};
/// use bowknot_proximity::MeshQuery;
///
/// // A tetrahedron, seen from outside counterclockwise.
/// let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(Point::from);
/// let mut mesh = MeshQuery::new(&corners, &[[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])?;
///
/// let closest = mesh.closest_point(&Point::new(0.2, 0.3, -0.5), 1.0).expect("within 1 m");
/// assert_eq!((closest.triangle, closest.distance), (0, 0.5));
/// assert!(mesh.closest_point(&Point::new(0.2, 0.3, -0.5), 0.4).is_none());
///
/// let hit = mesh.cast_ray(&Point::new(0.2, 0.3, -0.5), &Vector::new(0.0, 0.0, 2.0), f64::INFINITY);
/// assert_eq!(hit.map(|hit| (hit.triangle, hit.t)), Some((0, 0.25)));
///
/// assert_eq!(mesh.is_inside(&Point::new(0.1, 0.1, 0.1)), Some(true));
/// mesh.refit(&corners.map(|p| p + Vector::x()))?;
/// assert_eq!(mesh.is_inside(&Point::new(0.1, 0.1, 0.1)), Some(false));
/// # Ok::<(), bowknot_proximity::MeshQueryError>(())
/// ```
#[derive(Debug, Default)]
pub struct MeshQuery {
    /// Vertices of triangles, ascending.
    used: Vec<u32>,
    is_closed: bool,
    /// Whether all used vertices have a place.
    is_placed: bool,
    positions: Vec<Point>,
    origin: Point,
    local: Vec<LocalVertex>,
    tree: Tree<3>,
}

impl MeshQuery {
    /// The mesh of `triangles` at `positions` [m], one per vertex, such as those of a
    /// [`bowknot_geometry::Topology`]. There may be none of either, and vertices that no triangle names.
    ///
    /// # Errors
    /// If a triangle names a vertex that does not exist.
    pub fn new(positions: &[Point], triangles: &[[u32; 3]]) -> Result<Self, MeshQueryError> {
        let absent = (0..).zip(triangles);
        let mut absent = absent.flat_map(|(t, v)| VertexOutOfRange::of("triangle", t, v, positions.len()));
        if let Some(error) = absent.next() {
            return Err(error.into());
        }
        let mut used = triangles.concat();
        used.sort_unstable();
        used.dedup();
        let mut mesh = Self { used, is_closed: is_closed(triangles), ..Self::default() };
        mesh.place(positions);
        let elements: Vec<(u32, [u32; 3])> = (0..).zip(triangles.iter().copied()).collect();
        mesh.tree.build(&elements, &mesh.local);
        mesh.tree.refit(&mesh.local, None);
        Ok(mesh)
    }

    /// Moves the vertices to other positions [m]. The tree is refitted, in linear time, and built again where its
    /// order has become stale.
    ///
    /// # Errors
    /// If there is another number of positions; the mesh then stays.
    pub fn refit(&mut self, positions: &[Point]) -> Result<(), MeshQueryError> {
        let (given, vertices) = (positions.len(), self.positions.len());
        if given != vertices {
            return Err(MeshQueryError::PositionCount { given, vertices });
        }
        self.place(positions);
        self.tree.refit(&self.local, None);
        self.tree.rebuild_stale(&self.local, None);
        Ok(())
    }

    /// Sets positions in both frames.
    fn place(&mut self, positions: &[Point]) {
        self.positions.clear();
        self.positions.extend_from_slice(positions);
        self.origin = frame::origin(positions, &self.used);
        let (origin, still) = (self.origin, Vector::zeros());
        let localize = |position: &Point| frame::localize(position, &still, 0.0, &origin);
        positions.par_iter().with_min_len(4096).map(localize).collect_into_vec(&mut self.local);
        self.is_placed = self.used.iter().all(|&v| !self.local[v as usize][0].is_nan());
    }

    fn placed(&self) -> Placed<'_> {
        Placed { tree: &self.tree, positions: &self.positions, origin: self.origin }
    }

    /// The point of the surface that is closest to `point`, if it is no farther away than `max_distance` [m],
    /// which may be infinite. `None` also for a point that is not finite or beyond 1e15 m.
    ///
    /// The triangle is the one of least computed distance, which is off by at most 8 rounding units (2^-53) of
    /// the largest coordinate difference between it and the point.
    pub fn closest_point(&self, point: &Point, max_distance: f64) -> Option<SurfacePoint> {
        closest::closest_point(self.placed(), point, max_distance)
    }

    /// [`Self::closest_point`] of many points, on all threads of the rayon pool.
    pub fn closest_points(&self, points: &[Point], max_distance: f64) -> Vec<Option<SurfacePoint>> {
        let closest = |point| self.closest_point(point, max_distance);
        points.par_iter().with_min_len(MIN_POINTS).map(closest).collect()
    }

    /// The first triangle that the ray `origin` + t `direction` meets for t from 0 to `max`, which may be
    /// infinite. Triangles are met from both sides; touching counts. `None` also for a direction of length 0
    /// and an origin or a direction that is not finite.
    ///
    /// **Watertight.** The ray is the segment from `origin` to a point beyond the mesh, rounded, which turns it
    /// by less than 1e-12. Which triangles this segment meets is decided exactly, so it passes through no edge or
    /// vertex between triangles. `t` is rounded, and decides which triangle is the first and whether it is within
    /// `max`: where two are met within rounding of each other, either may be taken, always the same one.
    pub fn cast_ray(&self, origin: &Point, direction: &Vector, max: f64) -> Option<RayHit> {
        ray::cast_ray(self.placed(), origin, direction, max)
    }

    /// Whether a closed surface contains the point or winds around it, decided exactly.
    ///
    /// `None` if the mesh is not [closed](Self::is_closed): the answer would depend on the direction in which one
    /// looks. Also `None` if the point or a vertex is not finite. Triangles may face outward or inward. Where
    /// closed parts of one orientation overlap, the inside is that of their union; a part of the other orientation
    /// inside another is a hole.
    pub fn is_inside(&self, point: &Point) -> Option<bool> {
        if self.is_closed && self.is_placed { inside::is_inside(self.placed(), point) } else { None }
    }

    /// Whether there are triangles, and each edge of one is passed as often in one direction as in the other: the
    /// mesh has no border, and its triangles are oriented consistently.
    pub fn is_closed(&self) -> bool {
        self.is_closed
    }
}

fn is_closed(triangles: &[[u32; 3]]) -> bool {
    let edges = triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
    let mut passages: Vec<([u32; 2], i32)> =
        edges.map(|[a, b]| if a < b { ([a, b], 1) } else { ([b, a], -1) }).collect();
    passages.sort_unstable();
    let mut edges = passages.chunk_by(|p, q| p.0 == q.0);
    !triangles.is_empty() && edges.all(|edge| edge.iter().map(|passage| passage.1).sum::<i32>() == 0)
}

#[cfg(test)]
mod tests;
