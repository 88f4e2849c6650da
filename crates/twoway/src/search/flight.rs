//! Free flight: steps in which no body comes near another or a half-space.
//!
//! **Between bodies** the boxes of the bodies decide, of x and of x + d, inflated by their search margins.
//! Two bodies are apart if their boxes are, along one axis at both ends of the step: the gap along that axis
//! is linear in the path time if all vertices go all the way, so it is as large in between. No pair of
//! vertices of different bodies is then within contact range during the step, and none needs to be looked at.
//!
//! **Within a body** distances do not change if all of its vertices are translated alike. So the trust
//! regions move along with the body, by the displacement of the center of its box, and only what a vertex
//! moves beyond that must stay in its ball. The list of candidates holds as it is: for pairs within bodies.
//! The others have wrong bounds ([`Flight::drift`]) until everything is searched again, which is due before
//! the first step that is no free flight.
//!
//! Whether a step is a free flight depends on x and d alone, not on the list or on earlier steps.

use super::regions::{Regions, longest_path};
use crate::scene::CollisionScene;
use crate::state::ResolveState;
use bowknot_geometry::{Aabb, Point, Vector};
use rayon::prelude::*;

/// Vertices that one task looks at.
const CHUNK: usize = 1024;

/// Share of the smallest trust region that translations of centers may use up by rounding, see
/// [`Flight::rounding`]. Paths stay within 1 - 2e-3 of their balls, so that as much is left.
const ROUNDING_SHARE: f64 = 1e-3;

/// How bodies move in a step, and how far centers of trust regions have been moved since the last search.
#[derive(Debug, Default)]
pub(super) struct Flight {
    /// Boxes of each body at x and at x + d, without margins [m].
    boxes: Vec<[Aabb; 2]>,
    /// By how much the centers of each body's trust regions move in a step [m].
    translations: Vec<Vector>,
    /// What vertices move beyond that [m]; 0 in bodies that do not collide with themselves.
    pub relative: Vec<Vector>,
    /// Whether bodies have moved relative to each other since all pairs were searched for.
    pub drift: bool,
    /// Bound of the rounding that translations have added to a distance within a body since then [m].
    pub rounding: f64,
}

impl Flight {
    /// Whether no body comes near another or a half-space while all vertices move from x by
    /// `displacement(vertex)` [m].
    pub fn is_free(
        &mut self,
        scene: &CollisionScene,
        x: &[Point],
        displacement: impl Fn(usize) -> Vector,
    ) -> bool {
        let model = scene.model();
        let (bodies, spacing) = (model.bodies(), scene.spacing());
        self.boxes.clear();
        self.boxes.resize(bodies.len(), [Aabb::EMPTY; 2]);
        for (v, (start, &body)) in x.iter().zip(model.vertex_body()).enumerate() {
            let [first, last] = &mut self.boxes[body as usize];
            *first = first.union(&Aabb { min: *start, max: *start });
            let end = start + displacement(v);
            *last = last.union(&Aabb { min: end, max: end });
        }
        let corners = self.boxes.iter().flatten().flat_map(|b| [b.min, b.max]).filter(|p| p.x.is_finite());
        let largest = corners.map(|p| p.coords.amax()).fold(0.0, f64::max);
        // Far above the rounding of sums of coordinates, and below any minimum separation.
        let slack = 8.0 * f64::EPSILON * largest;
        let margin = |body: usize| spacing.margin(body as u32) + slack;
        let apart = |a: usize, b: usize| {
            let least = margin(a) + margin(b);
            let gap = |k: usize, a: &Aabb, b: &Aabb| b.min[k] - a.max[k];
            let (a, b) = (&self.boxes[a], &self.boxes[b]);
            (0..3).any(|k| {
                (0..2).all(|end| gap(k, &a[end], &b[end]) > least)
                    || (0..2).all(|end| gap(k, &b[end], &a[end]) > least)
            })
        };
        let is_above = |body: usize| {
            model.half_spaces().iter().all(|half_space| {
                let n = &half_space.normal;
                self.boxes[body].iter().all(|bounds| {
                    let lowest = (0..3).map(|k| (n[k] * bounds.min[k]).min(n[k] * bounds.max[k]));
                    let is_empty = bounds.min.x > bounds.max.x;
                    is_empty || lowest.sum::<f64>() - half_space.offset > 2.0 * margin(body) + 4.0 * slack
                })
            })
        };
        (0..bodies.len()).all(|a| {
            let others = (a + 1..bodies.len()).filter(|&b| model.may_collide(a as u32, b as u32));
            (bodies[a].obstacle || is_above(a)) && others.into_iter().all(|b| apart(a, b))
        })
    }

    /// Whether a step along `displacements` [m] is a free flight in which the vertices of each body move
    /// almost alike: apart from the translation of their body by no more than in another step.
    pub fn plan(&mut self, scene: &CollisionScene, state: &ResolveState, displacements: &[Vector]) -> bool {
        if !self.is_free(scene, &state.x, |v| displacements[v]) {
            return false;
        }
        let model = scene.model();
        self.translations.clear();
        self.translations.extend(self.boxes.iter().zip(model.bodies()).map(|([first, last], body)| {
            let moves = !body.obstacle && body.self_collision && first.min.x.is_finite();
            let twice = (last.min - first.min) + (last.max - first.max);
            if moves { 0.5 * twice } else { Vector::zeros() }
        }));
        let translations = &self.translations;
        self.relative.resize(state.x.len(), Vector::zeros());
        let vertices = (&mut self.relative, displacements, model.vertex_body()).into_par_iter().enumerate();
        let keeps_up = |(v, (relative, d, &body)): (usize, (&mut Vector, &Vector, &u32))| {
            let filter = &model.bodies()[body as usize];
            let meets_itself = !filter.obstacle && filter.self_collision;
            *relative = if meets_itself { d - translations[body as usize] } else { Vector::zeros() };
            relative.norm() <= longest_path(scene, v)
        };
        // Without an early end: all entries are needed.
        vertices.with_min_len(CHUNK).map(keeps_up).reduce(|| true, |a, b| a & b)
    }

    /// Moves the trust regions along with their bodies, as [planned](Self::plan). `largest_coordinate` is
    /// that of the step [m].
    pub fn take(
        &mut self,
        scene: &CollisionScene,
        state: &ResolveState,
        displacements: &[Vector],
        largest_coordinate: f64,
        regions: &mut Regions,
    ) {
        let (model, translations) = (scene.model(), &self.translations);
        let vertices = (&mut regions.balls.centers, &state.x, displacements, model.vertex_body());
        let follow = |(center, x, d, &body): (&mut Point, &Point, &Vector, &u32)| {
            let filter = &model.bodies()[body as usize];
            if filter.obstacle || !filter.self_collision {
                // No list has pairs within these bodies, so their balls may be anywhere.
                *center = x + d;
                *d != Vector::zeros()
            } else {
                *center += translations[body as usize];
                translations[body as usize] != Vector::zeros()
            }
        };
        let vertices = vertices.into_par_iter().with_min_len(CHUNK);
        self.drift |= vertices.map(follow).reduce(|| false, |a, b| a | b);
        // Each center is rounded by at most half a unit in the last place per component, 0.87 units in
        // length, and a distance has two sides.
        self.rounding += 2.0 * f64::EPSILON * largest_coordinate;
    }

    /// Whether rounding has used up its share, so that everything must be searched again.
    pub fn is_spent(&self, smallest_radius: f64) -> bool {
        self.rounding > ROUNDING_SHARE * smallest_radius
    }

    /// Notes that all pairs have been searched for.
    pub fn settle(&mut self) {
        (self.drift, self.rounding) = (false, 0.0);
    }
}
