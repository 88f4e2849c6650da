//! A check of every step that moves the vertices of a case.

use crate::Case;
use bowknot_check::{Judge, PathOptions, StateOptions};
use bowknot_geometry::Point;

/// Checks the steps of one case and keeps the first fault.
#[derive(Debug)]
pub struct StepChecker {
    judge: Judge,
    /// Number of steps checked.
    pub steps: usize,
    /// Largest distance that a vertex moved in a step [m].
    pub largest_move: f64,
    /// The first fault: a step that intersects or cannot be checked.
    pub fault: Option<String>,
}

impl StepChecker {
    /// A checker of the steps of a case.
    pub fn new(case: &Case) -> Self {
        Self { judge: Judge::from_model(&case.model), steps: 0, largest_move: 0.0, fault: None }
    }

    /// Checks the straight path from `previous` to `positions` and the state at its end. Returns whether both
    /// are free of intersections and every obstacle moved rigidly.
    pub fn check_step(&mut self, previous: &[Point], positions: &[Point]) -> bool {
        let path = self.judge.check_path(previous, positions, &PathOptions { limit: 1, skip_unmoved: true });
        let state = self.judge.check_state(positions, &StateOptions { limit: 1, distance: false });
        let fault = match (&path, &state) {
            (Err(error), _) | (_, Err(error)) => Some(error.to_string()),
            (Ok(path), Ok(state)) => {
                let hit = path.hits.first().map(|hit| format!("{hit} ({} in all)", path.hit_count));
                let crossing =
                    state.intersections.first().map(|i| format!("{i} ({} in all)", state.intersection_count));
                hit.or(crossing)
            }
        };
        if let Some(fault) = fault {
            self.fault.get_or_insert(format!("step {}: {fault}", self.steps));
        }
        self.steps += 1;
        let moves = previous.iter().zip(positions).map(|(p, q)| (q - p).norm());
        self.largest_move = moves.fold(self.largest_move, f64::max);
        self.fault.is_none()
    }

    /// Moves a case toward `targets` by `step(x, y)`, which returns the next positions, until nothing moves,
    /// a step has a fault, or `max_steps` steps are done. Returns the last positions.
    pub fn follow(
        &mut self,
        case: &Case,
        targets: &[Point],
        max_steps: usize,
        mut step: impl FnMut(&[Point], &[Point]) -> Vec<Point>,
    ) -> Vec<Point> {
        let mut positions = case.positions.clone();
        for _ in 0..max_steps {
            let next = step(&positions, targets);
            let still = next == positions;
            let good = self.check_step(&positions, &next);
            positions = next;
            if still || !good {
                break;
            }
        }
        positions
    }
}
