//! The gradient descent of I-Cloth (Tang et al. 2018): one step length per zone, by backtracking.
//!
//! A zone is a set of vertices that rows connect. Its first length is a thousandth of its number of vertices.
//! A step tries the last length over 0.7, and multiplies it by 0.7 until the function falls by half of what
//! its gradient promises, or changes by next to nothing. The constants are those of XRTailor, an open implementation of the method.

use bowknot_twoway::geometry::{UnionFind, Vector};
use bowknot_twoway::lcp::LcpProblem;

/// First length, for each vertex of the zone.
const FIRST: f64 = 1e-3;
/// Factor on the length of a step that is too long.
const SHORTER: f64 = 0.7;
/// Share of the promised decrease that a step must reach.
const DECREASE: f64 = 0.5;
/// A zone is done where its length is smaller.
const LEAST_LENGTH: f64 = 1e-12;
/// A step is taken as it is where the function changes by less [m^2, in units of relative mass].
const LEAST_CHANGE: f64 = 1e-10;

/// The zones of a system, and their steps.
#[derive(Clone, Debug, Default)]
pub(super) struct ZoneDescent {
    /// Zone of each vertex; none for those without rows and those that cannot move.
    of: Vec<Option<u32>>,
    zones: Vec<Zone>,
    gradient: Vec<Vector>,
    /// Where the present lengths lead to.
    pub(super) y: Vec<Vector>,
}

#[derive(Clone, Copy, Debug)]
struct Zone {
    length: f64,
    /// Value before the step, and square of the gradient.
    before: f64,
    slope: f64,
    state: State,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum State {
    Searching,
    Found,
    Done,
}

impl ZoneDescent {
    /// Finds the zones, and moves vertices in none of them to y'.
    pub(super) fn begin(&mut self, system: &LcpProblem<'_>, free: &[Vector], y: &mut [Vector]) {
        let weights = system.weights();
        let mut sets = UnionFind::new(weights.len());
        let mut has_row = vec![false; weights.len()];
        let mut connect = |vertices: &[u32]| {
            let mut free = vertices.iter().copied().filter(|&v| weights[v as usize] != 0.0);
            if let Some(first) = free.next() {
                has_row[first as usize] = true;
                free.for_each(|v| {
                    has_row[v as usize] = true;
                    sets.join(first, v);
                });
            }
        };
        system.rows().rows.iter().for_each(|row| connect(&row.vertices));
        system.distance_limits().rows.iter().for_each(|ball| connect(&ball.vertices));
        let mut numbers = vec![u32::MAX; weights.len()];
        self.of.clear();
        self.zones.clear();
        for (v, has_row) in has_row.into_iter().enumerate() {
            if !has_row {
                self.of.push(None);
                y[v] = free[v];
                continue;
            }
            let number = &mut numbers[sets.find(v as u32) as usize];
            if *number == u32::MAX {
                *number = self.zones.len() as u32;
                self.zones.push(Zone { length: 0.0, before: 0.0, slope: 0.0, state: State::Found });
            }
            self.zones[*number as usize].length += FIRST;
            self.of.push(Some(*number));
        }
    }

    /// Sets the gradient at `y`; `gather` calls a function with each vertex and its forces.
    pub(super) fn set_gradient(
        &mut self,
        system: &LcpProblem<'_>,
        free: &[Vector],
        y: &[Vector],
        gather: impl FnOnce(&mut [Vector], &(dyn Fn(usize, &mut Vector, Vector) + Sync)),
    ) {
        let weights = system.weights();
        self.gradient.resize(y.len(), Vector::zeros());
        gather(&mut self.gradient, &|v, gradient, pull| {
            let w = weights[v];
            *gradient = if w == 0.0 { Vector::zeros() } else { (y[v] - free[v]) / w - pull };
        });
        self.zones.iter_mut().for_each(|zone| zone.slope = 0.0);
        for (gradient, zone) in self.gradient.iter().zip(&self.of) {
            if let Some(zone) = zone {
                self.zones[*zone as usize].slope += gradient.norm_squared();
            }
        }
    }

    /// 1/2 sum m |y - y'|^2 of each zone.
    pub(super) fn inertia(&self, system: &LcpProblem<'_>, free: &[Vector], y: &[Vector]) -> Vec<f64> {
        let mut values = vec![0.0; self.zones.len()];
        for (v, zone) in self.of.iter().enumerate() {
            if let Some(zone) = zone {
                values[*zone as usize] += 0.5 * (y[v] - free[v]).norm_squared() / system.weights()[v];
            }
        }
        values
    }

    /// Adds to the value of the zone of a row.
    pub(super) fn add(&self, values: &mut [f64], vertices: &[u32], value: f64) {
        if let Some(zone) = vertices.iter().find_map(|&v| self.of[v as usize]) {
            values[zone as usize] += value;
        }
    }

    /// Starts a step from where the zones have these values.
    pub(super) fn begin_search(&mut self, before: Vec<f64>) {
        for (zone, before) in self.zones.iter_mut().zip(before) {
            zone.before = before;
            if zone.state == State::Found {
                zone.state = State::Searching;
                // The first length of a step is that of the last one, and longer.
                zone.length /= SHORTER * SHORTER;
            }
        }
    }

    /// Shortens the steps of the zones that have found none; false if there are none.
    pub(super) fn shorten(&mut self, from: &[Vector]) -> bool {
        let mut any = false;
        for zone in self.zones.iter_mut().filter(|zone| zone.state == State::Searching) {
            zone.length *= SHORTER;
            any = true;
        }
        self.y.clear();
        self.y.extend(from.iter().zip(&self.gradient).zip(&self.of).map(|((y, gradient), zone)| {
            let zone = zone.map(|zone| self.zones[zone as usize]);
            match zone {
                Some(Zone { length, state: State::Searching | State::Found, .. }) => y - length * gradient,
                _ => *y,
            }
        }));
        any
    }

    /// Decides by the values after the steps.
    pub(super) fn judge(&mut self, after: Vec<f64>) {
        for (zone, after) in self.zones.iter_mut().zip(after) {
            if zone.state != State::Searching {
                continue;
            }
            let falls = after < zone.before - DECREASE * zone.length * zone.slope;
            if zone.length < LEAST_LENGTH {
                zone.state = State::Done;
            } else if falls || (zone.before - after).abs() < LEAST_CHANGE {
                zone.state = State::Found;
            }
        }
    }

    /// Moves `y`; returns the number of zones that are not done.
    pub(super) fn take_step(&mut self, y: &mut [Vector]) -> usize {
        for ((y, gradient), zone) in y.iter_mut().zip(&self.gradient).zip(&self.of) {
            if let Some(zone) = zone.map(|zone| self.zones[zone as usize])
                && zone.state == State::Found
            {
                *y -= zone.length * gradient;
            }
        }
        self.zones.iter().filter(|zone| zone.state == State::Found).count()
    }
}
