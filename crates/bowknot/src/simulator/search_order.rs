//! The order in which a collision backend keeps what it searches in.

use super::Simulator;
use super::error::SimulationError;
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
}

impl Simulator {
    /// Every so many time steps, orders what the backend searches in by the present positions: grains mix.
    pub(super) fn order_search(&mut self) -> Result<(), SimulationError> {
        if !self.backend.is_ordered() {
            return Ok(());
        }
        let count = self.world.collision_vertices();
        let order = &mut self.search_order;
        if self.step > 0 && self.step.is_multiple_of(STEPS_OF_AN_ORDER) {
            order.adopt(&self.positions[..count]);
        }
        if order.is_new {
            let by =
                if order.positions.is_empty() { &self.world.positions[..count] } else { &order.positions };
            let ordered = self.backend.order(self.resolver.scene(), by);
            ordered.map_err(|source| SimulationError::backend(&self.world, self.step, source))?;
            order.is_new = false;
        }
        Ok(())
    }
}
