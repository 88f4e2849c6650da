//! How far prescribed motions lead: known before the first time step, so a run refuses them before it writes.

use crate::simulator::error::SimulationError;
use crate::simulator::{Simulator, time_of};
use bowknot_geometry::Point;
use bowknot_scene::world::ObstacleMotion;

impl Simulator {
    /// Refuses motions of obstacles, and of pins that hold from the beginning, that lead so far within
    /// `steps` time steps that rounding exceeds the minimum separation. The first time step on which they did
    /// would be refused otherwise. Costs little beside a time step: most vertices are looked at once.
    ///
    /// # Errors
    /// The time step and the body of the farthest vertex.
    pub fn check_motions(&self, steps: usize) -> Result<(), SimulationError> {
        let world = &self.world;
        for body in world.bodies.iter().filter(|body| body.kind.is_none()) {
            let range = body.vertices.start as usize..body.vertices.end as usize;
            let base = &world.base[range.clone()];
            let step = match &body.motion {
                ObstacleMotion::Rest => continue,
                ObstacleMotion::Rigid(motion) => {
                    let corners = corners(base.iter());
                    self.farthest(steps, |time| {
                        corners
                            .iter()
                            .map(|corner| motion.at(time).apply(corner))
                            .map(|p| size(&p))
                            .fold(0.0, f64::max)
                    })
                }
                ObstacleMotion::Sequence(sequence) => {
                    let sizes: Vec<f64> = sequence
                        .frames
                        .iter()
                        .map(|frame| frame.iter().map(size).fold(0.0, f64::max))
                        .collect();
                    let last = sizes.len().saturating_sub(1) as f64;
                    self.farthest(steps, |time| {
                        let place = ((time - sequence.start) * sequence.rate).clamp(0.0, last);
                        sizes[place.floor() as usize].max(sizes[place.ceil() as usize])
                    })
                }
                // Generated shapes stay near where they are, and what a program will do is not known.
                ObstacleMotion::Procedural(_) | ObstacleMotion::Placed(_) => continue,
            };
            let mut positions = world.positions.clone();
            body.motion.positions(base, time_of(step, self.dt), &mut positions[range]);
            self.check_at(step, &positions)?;
        }
        for pin in world.pins.iter().filter(|pin| pin.start <= 0.0) {
            let Some(motion) = &pin.motion else { continue };
            let corners = corners(pin.vertices.iter().map(|&v| &world.positions[v as usize]));
            let held = self.steps_until(pin.end, steps);
            let step = self.farthest(held, |time| {
                corners
                    .iter()
                    .map(|corner| motion.at(time).apply(corner))
                    .map(|p| size(&p))
                    .fold(0.0, f64::max)
            });
            let place = motion.at(time_of(step, self.dt));
            let mut positions = world.positions.clone();
            for &v in &pin.vertices {
                positions[v as usize] = place.apply(&world.positions[v as usize]);
            }
            self.check_at(step, &positions)?;
        }
        Ok(())
    }

    fn check_at(&self, step: usize, positions: &[Point]) -> Result<(), SimulationError> {
        let collide = &positions[..self.world.collision_vertices()];
        self.resolver
            .check_coordinates(collide)
            .map_err(|source| SimulationError::resolve(&self.world, step, source))
    }

    /// The time step, up to `steps`, at whose end a size is largest.
    fn farthest(&self, steps: usize, size: impl Fn(f64) -> f64) -> usize {
        let sizes = (0..=steps).map(|step| (step, size(time_of(step, self.dt))));
        sizes.fold((0, 0.0), |best, next| if next.1 > best.1 { next } else { best }).0
    }

    /// Time steps until a time [s], at most `steps`.
    fn steps_until(&self, end: f64, steps: usize) -> usize {
        ((end / self.dt).max(0.0) as usize).min(steps)
    }
}

fn size(point: &Point) -> f64 {
    point.coords.amax()
}

/// The corners of a bounding box, which enclose the points wherever a rigid motion leads them.
fn corners<'a>(mut points: impl Iterator<Item = &'a Point>) -> Vec<Point> {
    let Some(first) = points.next().copied() else { return Vec::new() };
    let (low, high) = points.fold((first, first), |(low, high), p| (low.inf(p), high.sup(p)));
    let of = |corner: usize, axis: usize| if corner >> axis & 1 == 0 { low[axis] } else { high[axis] };
    (0..8).map(|corner| Point::new(of(corner, 0), of(corner, 1), of(corner, 2))).collect()
}
