//! Intersections of a state, by exact predicates.

use crate::body_pairs::by_bodies;
use crate::error::CheckError;
use crate::judge::Judge;
use crate::path::is_above;
use crate::primitives::{Scene, closest_points, gather, pairs};
use crate::report::{Intersection, PairClass, StateOptions, StateReport};
use crate::walk::Meeting;
use bowknot_geometry::{Point, Vector, intersection};
use rayon::prelude::*;

/// A pair that intersects.
type FoundPair = (PairClass, [u32; 2]);

impl Judge {
    /// Judges the state `x` [m], one point per vertex.
    ///
    /// Intersections are decided exactly, but for half-spaces: a vertex that is not certainly above one,
    /// given rounding, counts as touching it. So that one place is not counted several times, two edges
    /// of a mesh, or a vertex of one and a triangle, are listed only where no edge-triangle pair stands
    /// for them (all of those share a vertex). The result does not depend on the number of threads.
    ///
    /// # Errors
    /// A wrong number of points, or coordinates that are not finite.
    pub fn check_state(&self, x: &[Point], options: &StateOptions) -> Result<StateReport, CheckError> {
        self.check_state_with(&mut Scene::new(self), true, x, options)
    }

    /// [`Self::check_state`] with trees that are arranged anew, or kept in the order that they have.
    pub(super) fn check_state_with(
        &self,
        scene: &mut Scene<1>,
        arrange: bool,
        x: &[Point],
        options: &StateOptions,
    ) -> Result<StateReport, CheckError> {
        self.check_positions("state", x)?;
        // Distances alone look at vertices of triangles.
        if arrange {
            scene.arrange([x], options.distance);
        }
        scene.fit([x], options.distance, false);
        let Scene { edges, particles, strands, triangles, .. } = &*scene;
        let mut found = pairs(
            self,
            PairClass::EdgeTriangle,
            edges,
            triangles,
            &Meeting,
            |class, elements, [edge, triangle], found: &mut Vec<FoundPair>| {
                let point = |v: u32| &x[v as usize];
                let (e, t) = ([edge[0], edge[1]], [triangle[0], triangle[1], triangle[2]]);
                if intersection::edge_triangle(e.map(point), t.map(point)) {
                    found.push((class, elements));
                }
            },
        )
        .concat();
        let edge_triangle_count = found.len();
        let test = |class: PairClass, elements: [u32; 2], [a, b]: [&[u32]; 2], found: &mut Vec<FoundPair>| {
            if touch(x, a, b) {
                found.push((class, elements));
            }
        };
        let others = [
            pairs(self, PairClass::EdgeEdge, strands, strands, &Meeting, test),
            pairs(self, PairClass::VertexTriangle, particles, triangles, &Meeting, test),
            pairs(self, PairClass::VertexEdge, particles, strands, &Meeting, test),
            pairs(self, PairClass::VertexVertex, particles, particles, &Meeting, test),
        ];
        found.extend(others.into_iter().flatten().flatten());
        for &(class, elements) in &self.uncovered {
            let sides = self.sides(class, elements);
            let obstacles = sides.iter().all(|side| side.iter().all(|&v| self.obstacle[v as usize]));
            if !obstacles && self.may_meet(sides[0], sides[1]) {
                test(class, elements, sides, &mut found);
            }
        }
        found.par_extend(self.vertices.par_iter().filter(|&&v| self.meets_half_spaces(v)).flat_map_iter(
            |&v| {
                let below = move |h: &usize| !is_above(&self.half_spaces[*h], &x[v as usize]);
                (0..self.half_spaces.len())
                    .filter(below)
                    .map(move |h| (PairClass::VertexHalfSpace, [v, h as u32]))
            },
        ));
        found.par_sort_unstable();

        let listed = &found[..found.len().min(options.limit)];
        let intersections = listed.par_iter().map(|found| self.describe(x, found)).collect();
        let depths: Vec<([Option<u32>; 2], Option<f64>)> =
            found.par_iter().map(|found| (self.bodies_of(found), Some(self.depth(x, found)))).collect();
        let body_pairs = by_bodies(depths.into_iter(), |number| self.place_of(x, &found[number]));
        let nearest = if options.distance { self.nearest(x, scene) } else { None };
        let intersection_count = found.len();
        Ok(StateReport { intersections, intersection_count, edge_triangle_count, body_pairs, nearest })
    }

    fn describe(&self, x: &[Point], found: &FoundPair) -> Intersection {
        let &(class, elements) = found;
        let sides = self.sides(class, elements);
        let (place, depth) = (self.place_of(x, found), self.depth(x, found));
        let vertices = sides.map(<[u32]>::to_vec);
        Intersection { class, elements, vertices, bodies: self.side_bodies(sides), place, depth }
    }

    fn bodies_of(&self, &(class, elements): &FoundPair) -> [Option<u32>; 2] {
        self.side_bodies(self.sides(class, elements))
    }

    /// See [`Intersection::depth`].
    fn depth(&self, x: &[Point], &(class, elements): &FoundPair) -> f64 {
        match class {
            PairClass::EdgeTriangle => {
                let (edge, triangle) = points(x, self.sides(class, elements));
                let (normal, heights) = heights(&edge, &triangle);
                if heights[0] * heights[1] >= 0.0 {
                    return 0.0;
                }
                let nearer = heights[0].abs().min(heights[1].abs());
                // The length of a tiny normal may underflow.
                (nearer / normal.norm()).min((edge[1] - edge[0]).norm())
            }
            PairClass::VertexHalfSpace => {
                let (_, height) = self.half_space_places(elements, &x[elements[0] as usize]);
                (-height).max(0.0)
            }
            _ => 0.0,
        }
    }

    /// A point of the overlap, to rounding.
    fn place_of(&self, x: &[Point], &(class, elements): &FoundPair) -> Point {
        let sides = self.sides(class, elements);
        match class {
            PairClass::EdgeTriangle => {
                let (edge, triangle) = points(x, sides);
                crossing(edge, triangle)
            }
            PairClass::VertexHalfSpace => x[elements[0] as usize],
            _ => closest_points(class, &gather(x, sides)).0[0],
        }
    }
}

/// Whether two closed primitives, other than an edge and a triangle, share a point: exact.
fn touch(x: &[Point], a: &[u32], b: &[u32]) -> bool {
    let point = |v: u32| &x[v as usize];
    match (a, b) {
        (&[p], &[i, j, k]) => intersection::point_on_triangle(point(p), [i, j, k].map(point)),
        (&[i, j], &[k, l]) => intersection::edge_edge([i, j].map(point), [k, l].map(point)),
        (&[p], &[i, j]) => intersection::point_on_edge(point(p), [i, j].map(point)),
        (&[p], &[q]) => point(p) == point(q),
        _ => false,
    }
}

/// The points of an edge and of a triangle.
fn points(x: &[Point], [edge, triangle]: [&[u32]; 2]) -> ([Point; 2], [Point; 3]) {
    let point = |v: u32| x[v as usize];
    ([edge[0], edge[1]].map(point), [triangle[0], triangle[1], triangle[2]].map(point))
}

/// The normal of a triangle, as long as twice its area, and the products of it with the ends of an edge.
fn heights(edge: &[Point; 2], triangle: &[Point; 3]) -> (Vector, [f64; 2]) {
    let normal = (triangle[1] - triangle[0]).cross(&(triangle[2] - triangle[0]));
    (normal, edge.map(|p| normal.dot(&(p - triangle[0]))))
}

/// A point of the overlap of an edge and a triangle, to rounding: where the edge crosses the triangle's plane,
/// or if it runs along that, the best of the closest points of the edge with the triangle's edges and of its
/// ends with the triangle.
fn crossing(edge: [Point; 2], triangle: [Point; 3]) -> Point {
    let (_, heights) = heights(&edge, &triangle);
    let [p, q] = edge;
    if heights[0] * heights[1] < 0.0 {
        return p + (q - p) * (heights[0] / (heights[0] - heights[1]));
    }
    let [a, b, c] = triangle;
    let candidates = [
        (PairClass::VertexTriangle, [p, a, b, c]),
        (PairClass::VertexTriangle, [q, a, b, c]),
        (PairClass::EdgeEdge, [p, q, a, b]),
        (PairClass::EdgeEdge, [p, q, b, c]),
        (PairClass::EdgeEdge, [p, q, c, a]),
    ];
    let measured = candidates.map(|(class, points)| closest_points(class, &points));
    let best = measured.iter().fold(&measured[0], |best, next| if next.1 < best.1 { next } else { best });
    best.0[0]
}
