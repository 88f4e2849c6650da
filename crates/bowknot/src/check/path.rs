//! Straight paths: every vertex moves from x0 to x1 linearly, all on one clock.
//!
//! Trees over the boxes at both ends list the pairs whose moving boxes may meet; [`Sweep`] then
//! certifies each, or calls it a hit.

use super::primitives::{Scene, closest_points, gather, pair_kind};
use super::sweep::Sweep;
use super::{CheckError, Judge, PairClass, PathHit, PathOptions, PathReport};
use bowknot_geometry::{HalfSpace, Point};
use rayon::prelude::*;

/// Relative bound of the rounding of n . x - o: at most four roundings a term, doubled.
const PLANE_ROUNDING: f64 = 4.0 * f64::EPSILON;

/// A pair that was looked at; `hit` is `None` if it is certified.
struct Look {
    class: PairClass,
    elements: [u32; 2],
    hit: Option<f64>,
}

impl Judge {
    /// Judges the straight path from `x0` to `x1` [m], one point a vertex.
    ///
    /// A clear report is certain: no pair touches at any time, in exact arithmetic over the given
    /// coordinates. A hit may be a near miss closer than rounding can tell, about 1e-16 of the pair's
    /// extent and motion. The result does not depend on the number of threads.
    ///
    /// # Errors
    /// A wrong number of points, or coordinates that are not finite.
    pub fn check_path(
        &self,
        x0: &[Point],
        x1: &[Point],
        options: &PathOptions,
    ) -> Result<PathReport, CheckError> {
        self.check_positions("start of the path", x0)?;
        self.check_positions("end of the path", x1)?;
        let scene = Scene::new(self, [x0, x1], options.skip_unmoved);
        let mut looks = scene.all_pairs(
            |a, b| a.meets(b),
            |class, elements, sides, looks| {
                let (start, end) = (gather(x0, sides), gather(x1, sides));
                let hit = Sweep::new(pair_kind(class), &start, &end).hit();
                looks.push(Look { class, elements, hit });
            },
        );
        looks.par_extend(self.half_space_looks(x0, x1, options.skip_unmoved));

        let candidates = looks.len();
        looks.retain(|look| look.hit.is_some());
        looks.par_sort_unstable_by_key(|look| (look.class, look.elements));
        let hit_count = looks.len();
        let hits = looks.iter().take(options.limit).map(|look| self.describe_hit(x0, x1, look)).collect();
        Ok(PathReport { hits, hit_count, candidates })
    }

    /// Vertices that are not certainly above a half-space at either end; between the ends a vertex
    /// cannot be lower than at both.
    fn half_space_looks(&self, x0: &[Point], x1: &[Point], skip_unmoved: bool) -> Vec<Look> {
        let vertices = self
            .vertices
            .par_iter()
            .filter(|&&v| self.meets_half_spaces(v) && !(skip_unmoved && x0[v as usize] == x1[v as usize]));
        let look = |v: u32, h: usize| {
            let above = |x: &[Point]| is_above(&self.half_spaces[h], &x[v as usize]);
            let hit = match (above(x0), above(x1)) {
                (true, true) => return None,
                (true, false) => {
                    let height = |x: &[Point]| self.half_spaces[h].signed_distance(&x[v as usize]);
                    let (start, end) = (height(x0), height(x1));
                    (start / (start - end)).clamp(0.0, 1.0)
                }
                (false, _) => 0.0,
            };
            Some(Look { class: PairClass::VertexHalfSpace, elements: [v, h as u32], hit: Some(hit) })
        };
        vertices.flat_map_iter(|&v| (0..self.half_spaces.len()).filter_map(move |h| look(v, h))).collect()
    }

    fn describe_hit(&self, x0: &[Point], x1: &[Point], look: &Look) -> PathHit {
        let &Look { class, elements, hit } = look;
        let time = hit.unwrap_or(0.0);
        let sides = self.sides(class, elements);
        let (start, end) = (gather(x0, sides), gather(x1, sides));
        let at_time = Sweep::new(pair_kind(class), &start, &end).points(time);
        let places = match class {
            PairClass::VertexHalfSpace => self.half_space_places(elements, &at_time[0]).0,
            _ => closest_points(class, &at_time).0,
        };
        let vertices = sides.map(<[u32]>::to_vec);
        PathHit { class, elements, vertices, bodies: self.side_bodies(sides), time, places }
    }

    /// A vertex and its foot on the plane of a half-space, and its height.
    pub(super) fn half_space_places(&self, [_, h]: [u32; 2], point: &Point) -> ([Point; 2], f64) {
        let half_space = &self.half_spaces[h as usize];
        let height = half_space.signed_distance(point);
        ([*point, point - half_space.normal * height], height)
    }
}

/// Whether a point is above a half-space: certain if true.
pub(super) fn is_above(half_space: &HalfSpace, point: &Point) -> bool {
    let magnitude = half_space.normal.abs().dot(&point.coords.abs()) + half_space.offset.abs();
    half_space.signed_distance(point) > PLANE_ROUNDING * magnitude + f64::MIN_POSITIVE
}
