//! Whole simulations: samples of the motion, counts and times, and distances between simulations.

use crate::bench::Bench;
use anyhow::Result;
use bowknot::check::StateOptions;
use bowknot::geometry::Point;
use bowknot::{Scene, Simulator};
use serde::{Deserialize, Serialize};

/// The motion at one time.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Sample {
    /// Time [s].
    pub time: f64,
    /// Kinetic, elastic and potential energy [J].
    pub energy: f64,
    pub elastic: f64,
    /// Center of mass [m].
    pub center: [f64; 3],
    /// Mean ratio of edge lengths to those at the start.
    pub stretch: f64,
    /// Smallest gap of candidate pairs [m]; none if there are none.
    pub gap: Option<f64>,
    /// Intersecting pairs, by exact predicates.
    pub intersections: usize,
    /// Positions of the deformable vertices that collide [m].
    pub positions: Vec<[f64; 3]>,
}

/// A simulation.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct Simulation {
    pub samples: Vec<Sample>,
    /// Two-way steps of each time step.
    pub steps: Vec<usize>,
    pub searches: Vec<usize>,
    pub contact_rows: Vec<usize>,
    /// Wall seconds of the collision stage.
    pub collision: Vec<f64>,
    /// Wall seconds of the dynamics.
    pub dynamics: Vec<f64>,
    pub cpu: Vec<f64>,
    /// Number of time steps whose collision problems all met their stopping rule.
    pub met: usize,
    /// Largest stretch against rest.
    pub max_stretch: f64,
    /// Smallest gap [m].
    pub min_gap: Option<f64>,
}

/// Runs a scene for `frames` time steps once and keeps the result under `key`. `samples` states are sampled
/// evenly; the last one is the end.
pub fn simulate(
    bench: &Bench,
    key: &str,
    scene: &Scene,
    frames: usize,
    samples: usize,
) -> Result<Simulation> {
    bench.store.measured(&format!("simulate/{key}"), || run(scene, frames, samples))
}

/// As [`simulate`], but the result is not kept.
pub fn run(scene: &Scene, frames: usize, samples: usize) -> Result<Simulation> {
    let mut simulator = Simulator::new(scene)?;
    let judge = simulator.judge();
    let (collide, deformable) =
        (simulator.world().collision_vertices(), simulator.world().deformable_vertices);
    let topology = simulator.world().collision.topology();
    let edges: Vec<[usize; 2]> =
        topology.edges.iter().map(|e| e.map(|v| v as usize)).filter(|e| e[0] < deformable).collect();
    let lengths = |x: &[Point]| edges.iter().map(|[a, b]| (x[*a] - x[*b]).norm()).collect::<Vec<f64>>();
    let rest = lengths(simulator.positions());
    let mut result = Simulation::default();
    for frame in 1..=frames {
        let s = simulator.step()?;
        result.steps.push(s.two_way_steps);
        result.searches.push(s.searches);
        result.contact_rows.push(s.contact_rows);
        let t = &s.seconds;
        result.collision.push(t.search + t.evaluate + t.backward + t.forward);
        result.dynamics.push(t.dynamics);
        result.cpu.push(s.cpu_seconds);
        result.met += usize::from(s.converged);
        result.max_stretch = result.max_stretch.max(s.max_stretch);
        result.min_gap = result.min_gap.into_iter().chain(s.min_gap_m).reduce(f64::min);
        if (frame * samples) / frames > ((frame - 1) * samples) / frames {
            let x = simulator.positions();
            let options = StateOptions { limit: 0, distance: false };
            let ratios = lengths(x).into_iter().zip(&rest).map(|(now, rest)| now / rest);
            result.samples.push(Sample {
                time: s.time,
                energy: s.energy.kinetic + s.energy.elastic + s.energy.potential,
                elastic: s.energy.elastic,
                center: s.center_of_mass,
                stretch: ratios.sum::<f64>() / rest.len().max(1) as f64,
                gap: s.min_gap_m,
                intersections: judge.check_state(&x[..collide], &options)?.intersection_count,
                positions: x[..deformable].iter().map(|p| [p.x, p.y, p.z]).collect(),
            });
        }
    }
    Ok(result)
}

impl Simulation {
    /// CPU seconds of all time steps.
    pub fn cpu_seconds(&self) -> f64 {
        self.cpu.iter().sum()
    }

    /// Intersections of all samples.
    pub fn intersections(&self) -> usize {
        self.samples.iter().map(|s| s.intersections).sum()
    }
}

/// Distances of two simulations of one scene, root mean square over their samples.
#[derive(Clone, Copy, Debug)]
pub struct Distances {
    /// Of the energies [J].
    pub energy: f64,
    /// Of the centers of mass [m].
    pub center: f64,
    /// Of the mean stretches [1].
    pub stretch: f64,
    /// Of the positions, over all vertices [m].
    pub positions: f64,
    /// Of the last positions [m].
    pub last: f64,
}

impl Distances {
    /// Between simulations with samples at the same times.
    pub fn between(a: &Simulation, b: &Simulation) -> Self {
        let pairs = || a.samples.iter().zip(&b.samples);
        let root = |square: &dyn Fn(&Sample, &Sample) -> f64| {
            let squares: Vec<f64> = pairs().map(|(a, b)| square(a, b)).collect();
            (squares.iter().sum::<f64>() / squares.len().max(1) as f64).sqrt()
        };
        let between = |a: &[f64; 3], b: &[f64; 3]| (0..3).map(|k| (a[k] - b[k]).powi(2)).sum::<f64>();
        let positions = |a: &Sample, b: &Sample| {
            let sum: f64 = a.positions.iter().zip(&b.positions).map(|(a, b)| between(a, b)).sum();
            sum / a.positions.len().max(1) as f64
        };
        Self {
            energy: root(&|a, b| (a.energy - b.energy).powi(2)),
            center: root(&|a, b| between(&a.center, &b.center)),
            stretch: root(&|a, b| (a.stretch - b.stretch).powi(2)),
            positions: root(&positions),
            last: pairs().next_back().map_or(f64::NAN, |(a, b)| positions(a, b).sqrt()),
        }
    }
}
