//! Straight paths: every vertex moves from x0 to x1 linearly, all in one path time.
//!
//! Trees over the boxes at both ends list the pairs whose moving boxes may meet; [`Sweep`] then
//! certifies each, or calls it a hit.

use crate::body_pairs::by_bodies;
use crate::error::CheckError;
use crate::judge::Judge;
use crate::primitives::{Scene, closest_points, gather};
use crate::report::{PairClass, PathHit, PathOptions, PathReport};
use crate::sweep::Sweep;
use crate::walk::Meeting;
use bowknot_geometry::{HalfSpace, Point};
use rayon::prelude::*;

/// Relative bound of the rounding of n . x - o: at most four roundings a term, doubled.
const PLANE_ROUNDING: f64 = 4.0 * f64::EPSILON;

/// A pair that is not certified to stay apart, and until when it is.
struct Hit {
    class: PairClass,
    elements: [u32; 2],
    time: f64,
}

/// The pairs that were looked at.
#[derive(Default)]
struct Looks {
    count: usize,
    hits: Vec<Hit>,
}

impl Judge {
    /// Judges the straight path from `x0` to `x1` [m], one point per vertex.
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
        self.check_path_with(&mut Scene::new(self), true, x0, x1, options)
    }

    /// [`Self::check_path`] with trees that are arranged anew, or kept in the order that they have.
    pub(super) fn check_path_with(
        &self,
        scene: &mut Scene<2>,
        arrange: bool,
        x0: &[Point],
        x1: &[Point],
        options: &PathOptions,
    ) -> Result<PathReport, CheckError> {
        self.check_positions("start of the path", x0)?;
        self.check_positions("end of the path", x1)?;
        if arrange {
            scene.arrange([x0, x1], true);
        }
        scene.fit([x0, x1], true, options.skip_unmoved);
        let looks = scene.all_pairs(self, &Meeting, |class, elements, sides, looks: &mut Looks| {
            let (start, end) = (gather(x0, sides), gather(x1, sides));
            looks.count += 1;
            if let Some(time) = Sweep::new(class.kind(), &start, &end).hit() {
                looks.hits.push(Hit { class, elements, time });
            }
        });
        let below = self.half_space_hits(x0, x1, options.skip_unmoved);

        let candidates = looks.iter().map(|looks| looks.count).sum::<usize>() + below.len();
        let mut hits: Vec<Hit> = looks.into_iter().flat_map(|looks| looks.hits).chain(below).collect();
        hits.par_sort_unstable_by_key(|hit| (hit.class, hit.elements));
        let hit_count = hits.len();
        let bodies = |hit: &Hit| self.side_bodies(self.sides(hit.class, hit.elements));
        let place = |number: usize| self.describe_hit(x0, x1, &hits[number]).places[0];
        let body_pairs = by_bodies(hits.iter().map(|hit| (bodies(hit), None)), place);
        let listed = &hits[..hit_count.min(options.limit)];
        let hits = listed.par_iter().map(|hit| self.describe_hit(x0, x1, hit)).collect();
        Ok(PathReport { hits, hit_count, body_pairs, candidates })
    }

    /// Vertices that are not certainly above a half-space at either end; between the ends a vertex
    /// cannot be lower than at both.
    fn half_space_hits(&self, x0: &[Point], x1: &[Point], skip_unmoved: bool) -> Vec<Hit> {
        let vertices = self
            .vertices
            .par_iter()
            .filter(|&&v| self.meets_half_spaces(v) && !(skip_unmoved && x0[v as usize] == x1[v as usize]));
        let look = |v: u32, h: usize| {
            let above = |x: &[Point]| is_above(&self.half_spaces[h], &x[v as usize]);
            let time = match (above(x0), above(x1)) {
                (true, true) => return None,
                (true, false) => {
                    let height = |x: &[Point]| self.half_spaces[h].signed_distance(&x[v as usize]);
                    let (start, end) = (height(x0), height(x1));
                    (start / (start - end)).clamp(0.0, 1.0)
                }
                (false, _) => 0.0,
            };
            Some(Hit { class: PairClass::VertexHalfSpace, elements: [v, h as u32], time })
        };
        vertices.flat_map_iter(|&v| (0..self.half_spaces.len()).filter_map(move |h| look(v, h))).collect()
    }

    fn describe_hit(&self, x0: &[Point], x1: &[Point], hit: &Hit) -> PathHit {
        let &Hit { class, elements, time } = hit;
        let sides = self.sides(class, elements);
        let (start, end) = (gather(x0, sides), gather(x1, sides));
        let at_time = Sweep::new(class.kind(), &start, &end).points(time);
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
    if half_space.is_empty() {
        return true;
    }
    let magnitude = half_space.normal.abs().dot(&point.coords.abs()) + half_space.offset.abs();
    half_space.signed_distance(point) > PLANE_ROUNDING * magnitude + f64::MIN_POSITIVE
}
