//! What a collision problem fails of.

use crate::recording::states::States;
use bowknot_check::{Judge, MotionJudge, PathOptions, StateOptions};
use bowknot_geometry::Point;
use bowknot_twoway::{AcceptedState, Params, ResolveError, Resolver};
use std::mem::Discriminant;
use std::ops::ControlFlow;
use std::panic::{self, AssertUnwindSafe};

/// What a collision problem fails of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Failure {
    /// Its start x intersects.
    Intersects,
    /// The scene or the call is refused, with an error of this kind.
    Refused(Discriminant<ResolveError>),
    /// The call panics.
    Panics,
    /// The call accepts a step whose path or end intersects.
    Unsafe,
    /// The call ends before the stopping rule is met: at a limit of steps or seconds, or without progress.
    NotConverged,
}

impl States {
    /// What the problem fails of, and where [m], if there is a place; none if it does not fail. With
    /// `judged`, the judge looks at every accepted step. `give_up` is asked after each step, and ends the
    /// call without a failure.
    ///
    /// A panic is caught; the hook of the program is called first. Arrays of the wrong length are no failure.
    pub fn failure(
        &self,
        params: &Params,
        judged: bool,
        give_up: &dyn Fn() -> bool,
    ) -> Option<(Failure, Option<Point>)> {
        let model = self.collision_model().ok().filter(|_| self.is_consistent())?;
        let judge = Judge::from_model(&model);
        if let Some(place) = intersection(&judge, &self.x) {
            return Some((Failure::Intersects, Some(place)));
        }
        let refused = |error: &ResolveError| {
            let place = match *error {
                ResolveError::NonFinite { vertex, .. }
                | ResolveError::Mass { vertex, .. }
                | ResolveError::MinSeparationBelowRounding { vertex, .. } => self.x.get(vertex).copied(),
                _ => None,
            };
            (Failure::Refused(std::mem::discriminant(error)), place)
        };
        let mut resolver = match self.resolver(model, params.clone()) {
            Ok(resolver) => resolver,
            Err(error) => return Some(refused(&error)),
        };
        let (mut judge, mut hit, mut given_up) = (judged.then(|| MotionJudge::new(judge)), None, false);
        let mut x = self.x.clone();
        let mut watch = |accepted: &AcceptedState<'_>| {
            hit = judge.as_mut().and_then(|judge| unsafe_place(judge, accepted));
            given_up = give_up();
            if hit.is_some() || given_up { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        };
        let call = || resolver.resolve_with(&mut x, &self.y, &self.input(), &mut watch);
        let result = panic::catch_unwind(AssertUnwindSafe(call));
        match result {
            Err(_) => Some((Failure::Panics, None)),
            Ok(Err(error)) => Some(refused(&error)),
            Ok(Ok(_)) if hit.is_some() => Some((Failure::Unsafe, hit)),
            Ok(Ok(statistics)) if !statistics.converged && !given_up => {
                Some((Failure::NotConverged, farthest(&resolver)))
            }
            Ok(Ok(_)) => None,
        }
    }
}

impl States {
    /// Whether all arrays that are there have an entry for each vertex, body or half-space.
    fn is_consistent(&self) -> bool {
        let n = self.x.len();
        let bodies = self.body.iter().max().map_or(0, |&b| b as usize + 1);
        let optional = |length: usize, count: usize| length == 0 || length == count;
        [self.y.len(), self.rest.len(), self.masses.len(), self.obstacle.len(), self.body.len()]
            .iter()
            .all(|&length| length == n)
            && [self.fixed.len(), self.groups.len(), self.start.len()]
                .iter()
                .all(|&length| optional(length, n))
            && [self.body_contacts.len(), self.filters.len()].iter().all(|&length| optional(length, bodies))
            && optional(self.half_space_contacts.len(), self.half_spaces.len())
    }
}

/// Where a state intersects first. A state that cannot be judged is no intersection.
fn intersection(judge: &Judge, x: &[Point]) -> Option<Point> {
    let report = judge.check_state(x, &StateOptions { limit: 1, distance: false }).ok()?;
    report.intersections.first().map(|intersection| intersection.place)
}

/// Where an accepted step intersects, on its way or at its end.
fn unsafe_place(judge: &mut MotionJudge, accepted: &AcceptedState<'_>) -> Option<Point> {
    let options = PathOptions { limit: 1, ..PathOptions::default() };
    let path = judge.check_path(accepted.previous, accepted.positions, &options).ok()?;
    path.hits.first().map(|hit| hit.places[0]).or_else(|| intersection(judge.judge(), accepted.positions))
}

/// The vertex that ended farthest from its modified target.
fn farthest(resolver: &Resolver) -> Option<Point> {
    let state = resolver.state();
    let gaps = state.x.iter().zip(&state.y).map(|(x, y)| (*x, (y - x).norm()));
    gaps.max_by(|a, b| a.1.total_cmp(&b.1)).map(|(x, _)| x)
}

#[cfg(test)]
mod tests {
    use super::*;
    use bowknot_check::Parts;

    #[test]
    fn a_step_is_unsafe_if_its_path_or_its_end_intersects() {
        let parts = Parts { vertex_count: 4, triangles: &[[0, 1, 2]], particles: &[3], ..Parts::default() };
        let mut judge = MotionJudge::new(Judge::new(&parts).expect("valid parts"));
        let state =
            |z: f64| [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.2, 0.2, z]].map(Point::from);
        let mut place = |from: f64, to: f64| {
            let (previous, positions) = (state(from), state(to));
            let accepted =
                AcceptedState { step: 0, previous: &previous, positions: &positions, target: &positions };
            unsafe_place(&mut judge, &accepted)
        };
        assert_eq!(place(0.5, 0.1), None);
        for (from, to) in [(0.5, -0.5), (0.5, 0.0)] {
            let place = place(from, to).expect("it meets the triangle");
            assert!((place - Point::new(0.2, 0.2, 0.0)).norm() < 1e-3, "{place}");
        }
    }
}
