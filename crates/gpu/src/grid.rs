//! The grid on which positions lie: integers in place of floating point.
//!
//! A position is three integers, multiples of a quantum, a power of two, relative to an origin. On a grid
//! - differences of positions are exact, and so are boxes and their tests: nothing is rounded outward;
//! - a step is a sum of integers, the same on every device, whatever order a compiler gives to additions;
//! - every state is a state in `f64` too, bit by bit, and can be judged exactly.
//!
//! With single precision in place of it, coordinates would have a rounding error of 2^-24 of their distance
//! from the origin; here it is 2^-30 of the size of the scene, and a difference of near positions, converted
//! to `f32`, keeps 24 bits of its own.

use crate::parallel::{all, folded};
use bowknot_geometry::{Point, Vector};

/// A position in quanta.
pub type GridPoint = [i32; 3];

/// Coordinates stay below this: differences then stay below 2^30.
const MAX_COORDINATE: f64 = (1 << 29) as f64;

/// Largest exponent of a quantum, and the smallest: all multiples of them below 2^31 are numbers in `f64`
/// and, as lengths, in `f32`.
const EXPONENTS: std::ops::RangeInclusive<i32> = -60..=30;

/// A grid of positions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grid {
    /// Position of the integer zero [m], a multiple of the quantum.
    origin: Point,
    /// Length of the integer one [m], a power of two.
    quantum: f64,
}

/// Why there is no grid.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum GridError {
    /// A coordinate is not finite.
    #[error("the position of vertex {vertex} is not finite")]
    NotFinite {
        /// The vertex.
        vertex: usize,
    },
    /// The scene is too large for the smallest length that must be resolved.
    #[error(
        "a scene of {extent:.3e} m has a grid of {quantum:.3e} m, which is too coarse for gaps of {smallest:.3e} m: \
         use the CPU or a larger minimum separation, or remove what is far away"
    )]
    TooCoarse {
        /// Size of the scene [m].
        extent: f64,
        /// The quantum that it needs [m].
        quantum: f64,
        /// The smallest length that must be resolved [m].
        smallest: f64,
    },
}

impl Grid {
    /// How many quanta the smallest length has at least.
    const RESOLUTION: f64 = 256.0;

    /// How many it has where the scene is small enough. More would leave less room for what moves.
    const WANTED_RESOLUTION: f64 = 16384.0;

    /// A grid that has room for `positions` [m] with `room` [m] around them. It resolves lengths of
    /// `smallest` [m] by 16384 quanta, or by fewer in a large scene, but by 256 at least.
    ///
    /// # Errors
    /// A position that is not finite; a scene too large for `smallest`.
    pub fn around(positions: &[Point], room: f64, smallest: f64) -> Result<Self, GridError> {
        if let Some(vertex) = positions.iter().position(|x| !x.iter().all(|c| c.is_finite())) {
            return Err(GridError::NotFinite { vertex });
        }
        let (size, middle) = bounds([positions]);
        let half = 0.5 * size.amax() + room;
        // The finest grid that has the room, and the coarsest with the wanted resolution.
        let exponent = |length: f64| length.log2().floor().clamp(-1e9, 1e9) as i32;
        let exponent =
            (exponent(half / MAX_COORDINATE) + 1).max(exponent(smallest / Self::WANTED_RESOLUTION));
        let quantum = 2f64.powi(exponent.clamp(*EXPONENTS.start(), *EXPONENTS.end()));
        let too_coarse = GridError::TooCoarse { extent: 2.0 * half, quantum, smallest };
        if !(half / quantum < MAX_COORDINATE && Self::RESOLUTION * quantum <= smallest) {
            return Err(too_coarse);
        }
        let origin = Point::from(middle.map(|c| (c / quantum).round() * quantum));
        // Far from the origin of the scene's own coordinates the quanta are no numbers in `f64`.
        let largest = origin.coords.amax() + half;
        if largest / quantum >= 2f64.powi(53) { Err(too_coarse) } else { Ok(Self { origin, quantum }) }
    }

    /// A grid with the same quantum around other positions [m]; None if they need more room than there is.
    pub fn around_others(&self, positions: &[Point]) -> Option<Self> {
        let (_, middle) = bounds([positions]);
        let origin = Point::from(middle.map(|c| (c / self.quantum).round() * self.quantum));
        let other = Self { origin, ..*self };
        all(positions, |x| other.nearest(x).is_some()).then_some(other)
    }

    /// The grid for a call in which vertices move from `positions` to `ends` [m] at the farthest: this one if
    /// it has room, else one that is shifted to there, else a coarser one of both kinds that still resolves
    /// `smallest` [m]. Shifts are multiples of an eighth of the width, so that the same grid serves for a
    /// while. None if none has room.
    pub fn for_motion(&self, positions: &[Point], ends: &[Point], smallest: f64) -> Option<Self> {
        let (_, middle) = bounds([positions, ends]);
        let has_room = |grid: &Self| grid.has_room(positions) && all(ends, |x| grid.nearest(x).is_some());
        let mut quantum = self.quantum;
        while Self::RESOLUTION * quantum <= smallest {
            let home = self.origin.coords.map(|c| (c / quantum).round() * quantum);
            let unit = 0.25 * MAX_COORDINATE * quantum;
            let shift = (middle - home).map(|c| (c / unit).round() * unit);
            for origin in [home, home + shift] {
                let grid = Self { origin: Point::from(origin), quantum };
                let is_number = origin.amax() / quantum < 2f64.powi(52);
                if is_number && has_room(&grid) {
                    return Some(grid);
                }
            }
            quantum *= 2.0;
        }
        None
    }

    /// Length of the integer one [m].
    pub fn quantum(&self) -> f64 {
        self.quantum
    }

    /// The nearest position of the grid; None outside of it.
    pub fn nearest(&self, x: &Point) -> Option<GridPoint> {
        let scaled = (x - self.origin) / self.quantum;
        let inside = scaled.iter().all(|c| c.abs() < MAX_COORDINATE);
        inside.then(|| [0, 1, 2].map(|k| scaled[k].round_ties_even() as i32))
    }

    /// Whether all positions [m] are so far from the border that half of the grid's width is free around
    /// them.
    pub fn has_room(&self, positions: &[Point]) -> bool {
        let scaled = |x: &Point| ((x - self.origin) / self.quantum).amax();
        // What is not a number has no room.
        all(positions, |x| scaled(x) < 0.5 * MAX_COORDINATE)
    }

    /// The position of the grid that is nearest; outside of the grid each coordinate is moved to its border.
    /// The origin takes the place of coordinates that are no numbers.
    pub(crate) fn nearest_inside(&self, x: &Point) -> GridPoint {
        let scaled = (x - self.origin) / self.quantum;
        [0, 1, 2]
            .map(|k| scaled[k].round_ties_even().clamp(1.0 - MAX_COORDINATE, MAX_COORDINATE - 1.0) as i32)
    }

    /// The position [m], exactly.
    pub(crate) fn position(&self, x: GridPoint) -> Point {
        // Both terms are multiples of the quantum below 2^53 of it: the sum is exact.
        self.origin + Vector::from(x.map(f64::from)) * self.quantum
    }

    /// A length [m] in quanta.
    pub(crate) fn length(&self, length: f64) -> f32 {
        (length / self.quantum) as f32
    }
}

/// Size and middle of the box around the positions [m]; zeros if there are none.
fn bounds<const N: usize>(parts: [&[Point]; N]) -> (Vector, Vector) {
    let Some(first) = parts.iter().find_map(|part| part.first()) else {
        return (Vector::zeros(), Vector::zeros());
    };
    let join = |[l, h]: [Vector; 2], [low, high]: [Vector; 2]| [l.inf(&low), h.sup(&high)];
    let boxes = parts.map(|part| folded(part, [first.coords; 2], |x| [x.coords; 2], join));
    let [low, high] = boxes.into_iter().fold([first.coords; 2], join);
    (high - low, (low + high) * 0.5)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn positions_of_the_grid_come_back_to_the_bit() {
        let mut random = fastrand::Rng::with_seed(1);
        for (scale, offset) in [(1e-3, 0.0), (1.0, 5.0), (1e3, -2e4)] {
            let mut coordinate = || offset + scale * (random.f64() - 0.5);
            let points: Vec<Point> =
                (0..100).map(|_| Point::new(coordinate(), coordinate(), coordinate())).collect();
            let grid = Grid::around(&points, scale, 1e-5 * scale).expect("fine enough");
            for x in &points {
                let on_grid = grid.nearest(x).expect("inside");
                let back = grid.position(on_grid);
                assert!((back - x).amax() <= 0.5 * grid.quantum());
                assert_eq!(grid.nearest(&back), Some(on_grid));
                let next = grid.position([on_grid[0] + 1, on_grid[1], on_grid[2]]);
                assert_eq!((next - back).x, grid.quantum());
            }
            let resolution = 1e-5 * scale / grid.quantum();
            assert!((256.0..32768.0).contains(&resolution), "{scale} {resolution}");
            assert!(grid.has_room(&points));
            let far = Point::from(points[0].coords + Vector::repeat(0.6 * MAX_COORDINATE * grid.quantum()));
            assert!(!grid.has_room(&[far]) && grid.nearest(&far).is_some());
            let smallest = 1e-5 * scale;
            assert_eq!(grid.for_motion(&points, &points, smallest), Some(grid));
            let on_grid = |grid: &Grid, x: &Point| grid.nearest(x).map(|there| grid.position(there));
            for times in [1.5, 40.0, 1e5] {
                let way = Vector::new(times, -0.2, 3.0 * times) * (MAX_COORDINATE * grid.quantum());
                let moved: Vec<Point> = points.iter().map(|x| x + way).collect();
                let shifted = grid.for_motion(&moved, &moved, smallest).expect("as much room as before");
                assert!(shifted.has_room(&moved) && shifted.quantum() == grid.quantum());
                // The points of one grid are those of the other.
                let there = on_grid(&shifted, &moved[0]).expect("inside");
                assert_eq!((there - grid.origin).map(|c| (c / grid.quantum()).fract()), Vector::zeros());
            }
            // A long way needs a coarser grid, whose points are among those of the finer one.
            let ends: Vec<Point> =
                points.iter().map(|x| x + Vector::x() * (3.0 * MAX_COORDINATE * grid.quantum())).collect();
            let coarser = grid.for_motion(&points, &ends, smallest).expect("a coarser one");
            let ratio = coarser.quantum() / grid.quantum();
            assert!((2.0..=8.0).contains(&ratio), "{ratio}");
            let there = on_grid(&coarser, &points[0]).expect("inside");
            assert_eq!(on_grid(&grid, &there), Some(there));
            let far = [Point::new(1e300, 0.0, 0.0)];
            assert_eq!(grid.for_motion(&points, &far, smallest), None);
        }
    }

    #[test]
    fn scenes_that_do_not_fit_are_refused() {
        let far = [Point::origin(), Point::new(1e4, 0.0, 0.0)];
        assert!(matches!(Grid::around(&far, 1.0, 1e-5), Err(GridError::TooCoarse { .. })));
        assert!(Grid::around(&far, 1.0, 1e-2).is_ok());
        let shifted = far.map(|x| x + Vector::repeat(1e13));
        assert!(matches!(Grid::around(&shifted, 1.0, 1e-2), Err(GridError::TooCoarse { .. })));
        let broken = [Point::origin(), Point::new(f64::NAN, 0.0, 0.0)];
        assert_eq!(Grid::around(&broken, 1.0, 1.0), Err(GridError::NotFinite { vertex: 1 }));
        let grid = Grid::around(&far, 1.0, 1e-2).expect("fine enough");
        assert_eq!(grid.nearest(&Point::new(9e4, 0.0, 0.0)), None);
    }
}
