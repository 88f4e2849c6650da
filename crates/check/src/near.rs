//! All pairs nearer than a distance.

use crate::error::CheckError;
use crate::judge::Judge;
use crate::primitives::{Scene, closest_points, gather};
use crate::report::{NearPair, PairClass};
use crate::tree::{LeafBoxes, MovingBox};
use crate::walk::Keep;
use bowknot_geometry::Point;

/// Boxes this much farther apart than asked for, relatively, are still looked into: covers the rounding of
/// their distance.
const SLACK: f64 = 1.0 + 1e-9;

/// Boxes at most so far apart [m].
struct Within(f64);

impl Keep<1> for Within {
    // Boxes of a leaf are to be asked for one by one.
    const NARROWS: bool = true;

    #[inline]
    fn keep(&self, a: &MovingBox<1>, b: &MovingBox<1>) -> bool {
        a.distance_squared(b).sqrt() <= self.0 * SLACK
    }

    fn kept(&self, _: &MovingBox<1>, _: &LeafBoxes<1>) -> u32 {
        u32::MAX
    }
}

impl Judge {
    /// All judged pairs that are at most `distance` [m] apart in the state `x` [m], but edge-triangle pairs, ordered
    /// by class and elements. Distances are exact to rounding; the sides of a pair are given by [`Self::sides`].
    ///
    /// # Errors
    /// A wrong number of points, or coordinates that are not finite.
    pub fn pairs_within(&self, x: &[Point], distance: f64) -> Result<Vec<NearPair>, CheckError> {
        self.check_positions("state", x)?;
        let mut scene = Scene::new(self);
        scene.arrange([x], true);
        scene.fit([x], true, false);
        let mut near = scene
            .all_pairs(self, &Within(distance), |class, elements, sides, near: &mut Vec<NearPair>| {
                let (places, apart) = closest_points(class, &gather(x, sides));
                if apart <= distance {
                    near.push(NearPair { class, elements, places, distance: apart });
                }
            })
            .concat();
        for &v in self.vertices.iter().filter(|&&v| self.meets_half_spaces(v)) {
            for plane in
                (0..self.half_spaces.len() as u32).filter(|&h| !self.half_spaces[h as usize].is_empty())
            {
                let (places, apart) = self.measured(PairClass::VertexHalfSpace, [v, plane], x);
                if apart <= distance {
                    let class = PairClass::VertexHalfSpace;
                    near.push(NearPair { class, elements: [v, plane], places, distance: apart });
                }
            }
        }
        near.sort_unstable_by_key(|pair| (pair.class, pair.elements));
        Ok(near)
    }

    /// Closest points of either side of a pair in the state `x`, and their distance [m]; negative only below a
    /// half-space.
    ///
    /// # Panics
    /// If the elements or the state are not of this judge.
    pub fn measured(&self, class: PairClass, elements: [u32; 2], x: &[Point]) -> ([Point; 2], f64) {
        match class {
            PairClass::VertexHalfSpace => self.half_space_places(elements, &x[elements[0] as usize]),
            _ => closest_points(class, &gather(x, self.sides(class, elements))),
        }
    }
}
