//! Positions of nodes as integers, so that differences of near positions keep their digits in single
//! precision.

use bowknot_geometry::Vector;

/// Largest coordinate of what moves on a grid; that of the state that the grid is made for is half of it.
/// Differences of two fit into 32 bits, and so do differences of these.
const REACH: f64 = (1u32 << 29) as f64;

/// A grid about the nodes of a state.
#[derive(Clone, Copy, Debug)]
pub struct StateGrid {
    center: Vector,
    /// A power of two [m].
    pub quantum: f64,
}

impl StateGrid {
    /// The finest grid that reaches all positions.
    pub fn around<'a>(positions: impl Iterator<Item = &'a Vector> + Clone) -> Self {
        let low = positions.clone().fold(Vector::repeat(f64::INFINITY), |low, x| low.inf(x));
        let high = positions.fold(Vector::repeat(f64::NEG_INFINITY), |high, x| high.sup(x));
        let center = 0.5 * (low + high);
        let reach = (high - low).amax();
        if !(reach.is_finite() && center.iter().all(|c| c.is_finite())) {
            return Self { center: Vector::zeros(), quantum: 1.0 };
        }
        let mut quantum = 1.0;
        while quantum * REACH < reach {
            quantum *= 2.0;
        }
        // Steps of less than 1e-18 m are finer than any state.
        while 0.5 * quantum * REACH >= reach && quantum > 1e-18 {
            quantum *= 0.5;
        }
        Self { center, quantum }
    }

    /// A grid around the positions, so coarse that a box of this side fits as well [m].
    pub fn with_room<'a>(positions: impl Iterator<Item = &'a Vector> + Clone, side: f64) -> Self {
        let mut grid = Self::around(positions);
        while grid.quantum * REACH < side {
            grid.quantum *= 2.0;
        }
        grid
    }

    /// How far a position is from the center, over what the grid reaches at most: positions up to 1 are on
    /// the grid.
    pub fn reach(&self, x: &Vector) -> f64 {
        (x - self.center).amax() / (self.quantum * (REACH - 1.0))
    }

    /// The position of a point of the grid [m], exact.
    pub fn position(&self, point: [i32; 4]) -> Vector {
        Vector::from_fn(|k, _| self.center[k] + f64::from(point[k]) * self.quantum)
    }

    pub fn place(&self, x: &Vector) -> [i32; 4] {
        let round = |k: usize| ((x[k] - self.center[k]) / self.quantum).round() as i32;
        [round(0), round(1), round(2), 0]
    }
}

#[cfg(test)]
mod tests {
    use super::StateGrid;
    use bowknot_geometry::Vector;

    #[test]
    fn differences_are_right_to_half_a_quantum_wherever_the_state_is() {
        for (center, size) in [(0.0, 1.0), (1e6, 0.01), (-3.0, 500.0), (2.0, 0.0)] {
            let points =
                [Vector::new(center, center - size, center), Vector::new(center + size, center, center)];
            let grid = StateGrid::around(points.iter());
            assert!(grid.quantum <= size / f64::from(1 << 28) || size == 0.0, "{size}");
            let [a, b] = points.map(|x| grid.place(&x));
            for k in 0..3 {
                let way = f64::from(b[k] - a[k]) * grid.quantum;
                assert!((way - (points[1] - points[0])[k]).abs() <= grid.quantum, "{center} {size}");
            }
        }
        assert!(StateGrid::around([Vector::repeat(f64::NAN)].iter()).quantum == 1.0);
    }
}
