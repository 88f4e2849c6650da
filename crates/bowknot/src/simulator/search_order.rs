//! The order in which a collision backend keeps what it searches in.

use super::backend::{BackendError, CollisionBackend};
use bowknot_geometry::Point;

/// Time steps for which a backend keeps the order. To order anew costs as much as a search or two on the
/// host; in as many time steps things move past a few neighbors.
const STEPS_OF_AN_ORDER: usize = 64;

/// By which positions a backend orders what it searches in.
#[derive(Debug, Default)]
pub(crate) struct SearchOrder {
    /// See [`super::Checkpoint::order`].
    pub positions: Vec<Point>,
    /// Whether the backend does not know them yet.
    is_new: bool,
}

impl SearchOrder {
    /// Notes that the backend is another one.
    pub fn tell_again(&mut self) {
        self.is_new = !self.positions.is_empty();
    }

    /// Goes on with the order of a checkpoint.
    pub fn adopt(&mut self, positions: &[Point]) {
        self.positions = positions.to_vec();
        self.is_new = true;
    }

    /// Tells a backend the order before a time step, after so many steps, if it does not know it. Every so many time steps
    /// that is the order of the present `positions` [m]: grains mix. Before, it is that of `home`, the positions that the scene
    /// begins with [m].
    pub fn tell(
        &mut self,
        backend: &mut dyn CollisionBackend,
        steps: usize,
        [home, positions]: [&[Point]; 2],
    ) -> Result<(), BackendError> {
        if !backend.is_ordered() {
            return Ok(());
        }
        if steps > 0 && steps.is_multiple_of(STEPS_OF_AN_ORDER) {
            self.adopt(positions);
        }
        if std::mem::take(&mut self.is_new) {
            backend.order(if self.positions.is_empty() { home } else { &self.positions })?;
        }
        Ok(())
    }
}
