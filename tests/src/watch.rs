//! Judges every step of whatever moves a case.

use crate::Case;
use bowknot::check::{Judge, PathOptions, StateOptions};
use bowknot_geometry::Point;

/// Watches the steps of one case; keeps the first fault.
#[derive(Debug)]
pub struct Watch {
    judge: Judge,
    /// Steps seen so far.
    pub steps: usize,
    /// Largest distance that any vertex moved in any step [m].
    pub largest_move: f64,
    /// What was wrong with the first bad step.
    pub fault: Option<String>,
}

impl Watch {
    /// A watch over a case.
    pub fn new(case: &Case) -> Self {
        Self { judge: Judge::from_model(&case.model), steps: 0, largest_move: 0.0, fault: None }
    }

    /// Judges the straight path from `previous` to `positions`, and the state reached; whether both are
    /// free of intersections and an obstacle, if any, moved as one.
    pub fn step(&mut self, previous: &[Point], positions: &[Point]) -> bool {
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

    /// Lets `step(x, y)`, which returns the next positions, move a case toward `targets`, until it stands
    /// still, does wrong, or has taken `max_steps` steps. Returns the last positions.
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
            let good = self.step(&positions, &next);
            positions = next;
            if still || !good {
                break;
            }
        }
        positions
    }
}
