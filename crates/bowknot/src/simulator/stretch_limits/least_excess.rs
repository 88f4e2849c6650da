//! Where edges exceed their limits least, in squares.
//!
//! With l_e the length of an edge and L_e its limit, the energy is E = sum_e max(0, l_e - L_e)^2 / (2 L_e).
//! It is convex, so all of its minima have the same excess l_e - L_e in each edge, which is 0 where the
//! limits can be met. A chain of edges that is held at both ends is stretched evenly. Nesterov's method with
//! restarts (O'Donoghue and Candes 2015), scaled by the diagonal, finds a minimum.

use bowknot_geometry::{Point, Vector};
use rayon::prelude::*;

/// Steps at most. An excess spreads over about as many edges as a third of them.
const MOST_STEPS: usize = 1000;

/// Longest step of a vertex at the end, in the mean limit. Smaller: the excess is distributed better, in more
/// steps.
const TOLERANCE: f64 = 1e-5;

/// Vertices that one thread takes at least.
const CHUNK: usize = 1024;

/// Edges with their limits, between vertices of which the first ones are free.
#[derive(Clone, Debug)]
pub(super) struct LimitedGraph {
    /// The other vertex of each edge of a free vertex, and the limit [m].
    neighbors: Vec<(u32, f64)>,
    /// Where those of each free vertex start, and the end.
    starts: Vec<u32>,
    /// Mean limit [m].
    scale: f64,
}

impl LimitedGraph {
    /// Of `edges` with limits above 0 [m] between vertices, of which those below `free` are free.
    pub fn new(edges: &[([u32; 2], f64)], free: usize) -> Self {
        let mut starts = vec![0; free + 1];
        let ends = || edges.iter().flat_map(|&([a, b], limit)| [(a, b, limit), (b, a, limit)]);
        let of_free = || ends().filter(|&(from, ..)| (from as usize) < free);
        of_free().for_each(|(from, ..)| starts[from as usize + 1] += 1);
        (0..free).for_each(|v| starts[v + 1] += starts[v]);
        let mut next = starts.clone();
        let mut neighbors = vec![(0, 0.0); starts[free] as usize];
        for (from, to, limit) in of_free() {
            neighbors[next[from as usize] as usize] = (to, limit);
            next[from as usize] += 1;
        }
        let scale = edges.iter().map(|(_, limit)| limit).sum::<f64>() / edges.len().max(1) as f64;
        Self { neighbors, starts, scale }
    }

    /// The other vertices of the edges of a free vertex, and the limits [m].
    pub fn neighbors(&self, v: u32) -> &[(u32, f64)] {
        &self.neighbors[self.starts[v as usize] as usize..self.starts[v as usize + 1] as usize]
    }

    /// The energy E at `points` [m]. Fixed parts, so that the sum does not depend on the threads.
    pub fn energy(&self, points: &[Point]) -> f64 {
        let free = self.starts.len() - 1;
        let of_vertex = |v: usize| -> f64 {
            let of_edge = |&(other, limit): &(u32, f64)| {
                let excess = (points[other as usize] - points[v]).norm() - limit;
                // An edge of two free vertices is met twice.
                let share = if (other as usize) < free { 0.25 } else { 0.5 };
                if excess > 0.0 { share * excess * excess / limit } else { 0.0 }
            };
            self.neighbors(v as u32).iter().map(of_edge).sum()
        };
        let parts = (0..free.div_ceil(CHUNK)).into_par_iter();
        let parts = parts.map(|part| (CHUNK * part..free.min(CHUNK * (part + 1))).map(of_vertex).sum());
        parts.collect::<Vec<f64>>().iter().sum()
    }

    /// Whether no edge of a free vertex exceeds its limit by more than a share of it, the `slack`, at `points`
    /// [m].
    pub fn are_met(&self, points: &[Point], slack: f64) -> bool {
        let is_met = |v: usize| {
            let within = |&(other, limit): &(u32, f64)| {
                (points[other as usize] - points[v]).norm() <= (1.0 + slack) * limit
            };
            self.neighbors(v as u32).iter().all(within)
        };
        (0..self.starts.len() - 1).into_par_iter().with_min_len(CHUNK).all(is_met)
    }

    /// Moves the free ones of the `points` to a minimum [m], or to where all limits are [met](Self::are_met). The
    /// way comes near the limits and does not arrive, so without slack that takes many steps.
    pub fn settle(&self, points: &mut [Point], slack: f64) {
        let free = self.starts.len() - 1;
        let mut last = points[..free].to_vec();
        let mut steps = vec![Vector::zeros(); free];
        let mut momentum = 1.0_f64;
        for _ in 0..MOST_STEPS {
            if self.are_met(points, slack) {
                return;
            }
            // Points are ahead of `last` by the momentum. A step from there. Fixed parts, so that the sum does not
            // depend on the threads.
            let parts = steps.par_chunks_mut(CHUNK).enumerate().map(|(part, steps)| {
                let (mut ahead, mut longest) = (0.0, 0.0_f64);
                for (v, step) in (CHUNK * part..).zip(steps) {
                    *step = self.step(v, points);
                    ahead += step.dot(&(points[v] + *step - last[v]));
                    longest = longest.max(step.norm_squared());
                }
                (ahead, longest)
            });
            let parts: Vec<(f64, f64)> = parts.collect();
            let longest = parts.iter().map(|(_, longest)| *longest).fold(0.0, f64::max);
            let goes_back = parts.iter().map(|(ahead, _)| ahead).sum::<f64>() < 0.0;
            let next = if goes_back { 1.0 } else { 0.5 * (1.0 + (1.0 + 4.0 * momentum * momentum).sqrt()) };
            let beta = if goes_back { 0.0 } else { (momentum - 1.0) / next };
            momentum = next;
            let moved = points[..free].par_iter_mut().zip(&mut last).zip(&steps).with_min_len(CHUNK);
            moved.for_each(|((x, last), s)| {
                let reached = *x + s;
                *x = reached + (reached - *last) * beta;
                *last = reached;
            });
            if longest <= (TOLERANCE * self.scale).powi(2) {
                break;
            }
        }
        points[..free].copy_from_slice(&last);
    }

    /// A step of a free vertex down the energy [m].
    fn step(&self, v: usize, points: &[Point]) -> Vector {
        let free = self.starts.len() - 1;
        let (mut pull, mut stiffness) = (Vector::zeros(), 0.0);
        for &(other, limit) in self.neighbors(v as u32) {
            let edge = points[other as usize] - points[v];
            let length = edge.norm();
            // |a - b|^2 <= 2 |a|^2 + 2 |b|^2.
            stiffness += if (other as usize) < free { 2.0 } else { 1.0 } / limit;
            if length > limit {
                pull += edge * ((length - limit) / (limit * length));
            }
        }
        pull / stiffness
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lengths(edges: &[([u32; 2], f64)], points: &[Point]) -> Vec<f64> {
        edges.iter().map(|([a, b], _)| (points[*a as usize] - points[*b as usize]).norm()).collect()
    }

    #[test]
    fn a_chain_between_held_ends_is_stretched_evenly() {
        let n = 50;
        let edges: Vec<([u32; 2], f64)> = (0..=n)
            .map(|k| ([if k == 0 { n } else { k - 1 }, if k == n { n + 1 } else { k }], 1.0))
            .collect();
        let mut points: Vec<Point> = (1..=n).map(|k| Point::new(f64::from(k), 0.1, 0.0)).collect();
        let total = f64::from(n + 1);
        points.extend([Point::origin(), Point::new(1.1 * total, 0.0, 0.0)]);
        LimitedGraph::new(&edges, n as usize).settle(&mut points, 0.0);
        for length in lengths(&edges, &points) {
            assert!((length - 1.1).abs() < 2e-3, "{length}");
        }
    }

    #[test]
    fn limits_that_can_be_met_are_met() {
        // A fan around a free vertex, which starts far away; one whose limits contradict each other keeps the
        // least excess.
        let held = [0.0_f64, 2.0, 4.0].map(|angle| Point::new(angle.cos(), angle.sin(), 0.0));
        let settled = |limit: f64| {
            let edges: Vec<([u32; 2], f64)> = (1..4).map(|v| ([0, v], limit)).collect();
            let mut points = vec![Point::new(5.0, -3.0, 2.0), held[0], held[1], held[2]];
            LimitedGraph::new(&edges, 1).settle(&mut points, 0.0);
            lengths(&edges, &points)
        };
        assert!(settled(1.01).iter().all(|length| *length <= 1.01 * (1.0 + 1e-4)));
        let tight = settled(0.9);
        assert!(tight.iter().all(|length| (0.95..1.05).contains(length)), "{tight:?}");
    }
}
