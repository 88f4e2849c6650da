//! What the host does in a time step on a device: the twins take the place of the device, and their time is left out.

use crate::bench::Bench;
use crate::figure::{Figure, Part, Report};
use crate::table::{Table, short};
use crate::timed::{Seconds, TimedBackend, taken, timed};
use anyhow::Result;
use bowknot::gpu::{BufferId, ConjugateGradients, Device, Engine, GpuError, Recording, TwinEngine};
use bowknot::{Scene, Simulator};
use std::sync::{Arc, Mutex};

pub struct GpuHost;

/// Scene, its scale, settings, and the time steps of the CPU before those that are measured, which lead into contact.
const SCENES: [(&str, f64, &[&str], usize); 3] = [
    ("drape", 0.7, &["body.0.velocity=[0,0,-4]"], 7),
    ("drape", 3.0, &["body.0.velocity=[0,0,-4]"], 7),
    ("bow-knot", 1.0, &[], 60),
];

/// Time steps that are measured, after one in which the scene is prepared.
const STEPS: usize = 3;

impl Figure for GpuHost {
    fn name(&self) -> &'static str {
        "gpu-host"
    }

    fn title(&self) -> &'static str {
        "Work of the host in time steps on a GPU"
    }

    fn question(&self) -> &'static str {
        "Milliseconds of the host per time step if collisions and dynamics are computed on a device. Twins of the kernels take its \
         place, and the time in which they compute, or copy what the host writes and reads, is left out. `resolve_ms`: calls of the collision stage, contacts at their ends included. `judge_ms`: \
         the judge that looks for intersections at the end of a time step. `dynamics_ms`: Newton's method, contacts as \
         springs, and the energy that collisions put in. `other_ms`: pins, statistics, and the rest. `cpu_ms`: of all threads."
    }

    fn run(&self, bench: &Bench) -> Result<Report> {
        let mut table = Table::new([
            "scene",
            "vertices",
            "contact_rows",
            "newton_iterations",
            "two_way_steps",
            "resolve_ms",
            "judge_ms",
            "dynamics_ms",
            "other_ms",
            "host_ms",
            "cpu_ms",
        ]);
        let mut largest = 0.0_f64;
        for &(name, scale, sets, lead) in &SCENES[..bench.size.pick(SCENES.len(), 1, 1)] {
            if !bench.has_time() {
                break;
            }
            let scale = bench.size.pick(scale, scale, 0.3);
            let scene = Scene::builtin(name, scale)?
                .with_sets(&sets.iter().map(|&set| set.to_owned()).collect::<Vec<_>>())?;
            let host = Host::of(&scene, lead)?;
            let per_step = |seconds: f64| 1e3 * seconds / STEPS as f64;
            let whole = host.whole.wall - host.engines().wall;
            largest = largest.max(per_step(whole));
            println!("  {name}: {:.1} ms per time step", per_step(whole));
            let resolve = host.resolve - host.collisions.wall;
            let dynamics = host.dynamics - host.engine_of_dynamics.wall;
            table.row([
                name.into(),
                host.vertices.into(),
                host.rows.into(),
                (host.newton_iterations as f64 / STEPS as f64).into(),
                (host.steps as f64 / STEPS as f64).into(),
                per_step(resolve).into(),
                per_step(host.judge).into(),
                per_step(dynamics).into(),
                per_step(whole - resolve - host.judge - dynamics).into(),
                per_step(whole).into(),
                per_step(host.whole.cpu - host.engines().cpu).into(),
            ]);
        }
        Ok(Report {
            finding: format!("The host takes at most {} ms per time step.", short(largest)),
            parts: vec![Part::table(
                self.name(),
                "milliseconds of the host per time step on a device",
                table,
            )],
        })
    }
}

/// What some time steps of a scene took, twins included [s].
#[derive(Debug)]
struct Host {
    whole: Seconds,
    /// Of the engines alone.
    collisions: Seconds,
    engine_of_dynamics: Seconds,
    resolve: f64,
    judge: f64,
    dynamics: f64,
    vertices: usize,
    rows: usize,
    newton_iterations: usize,
    steps: usize,
}

impl Host {
    fn of(scene: &Scene, lead: usize) -> Result<Self> {
        let mut simulator = Simulator::new(scene)?;
        for _ in 0..lead {
            simulator.step()?;
        }
        let [collisions, engine_of_dynamics, resolve, judge]: [Arc<Mutex<Seconds>>; 4] = Default::default();
        let engine = |seconds: &Arc<Mutex<Seconds>>| TimedEngine {
            twin: TwinEngine::new(),
            seconds: Arc::clone(seconds),
        };
        simulator.set_backend(Box::new(TimedBackend {
            backend: Box::new(Device::new("twins".to_owned(), engine(&collisions))),
            resolve: Arc::clone(&resolve),
            judge: Arc::clone(&judge),
        }))?;
        let dynamics = ConjugateGradients::new("twins".to_owned(), engine(&engine_of_dynamics));
        simulator.set_dynamics_backend(Some(Box::new(dynamics)))?;
        // The first time step prepares the scene.
        simulator.step()?;
        for seconds in [&collisions, &engine_of_dynamics, &resolve, &judge] {
            taken(seconds);
        }
        let whole = Mutex::default();
        let mut host = Self {
            whole: Seconds::default(),
            collisions: Seconds::default(),
            engine_of_dynamics: Seconds::default(),
            resolve: 0.0,
            judge: 0.0,
            dynamics: 0.0,
            vertices: simulator.world().collision_vertices(),
            rows: 0,
            newton_iterations: 0,
            steps: 0,
        };
        for _ in 0..STEPS {
            let statistics = timed(&whole, || simulator.step())?;
            host.dynamics += statistics.seconds.dynamics;
            host.rows = host.rows.max(statistics.contact_rows);
            host.newton_iterations += statistics.newton_iterations;
            host.steps += statistics.two_way_steps;
        }
        host.whole = taken(&whole);
        host.collisions = taken(&collisions);
        host.engine_of_dynamics = taken(&engine_of_dynamics);
        host.resolve = taken(&resolve).wall;
        host.judge = taken(&judge).wall;
        Ok(host)
    }

    fn engines(&self) -> Seconds {
        let [a, b] = [&self.collisions, &self.engine_of_dynamics];
        Seconds { wall: a.wall + b.wall, cpu: a.cpu + b.cpu }
    }
}

/// The twins with the seconds of their runs.
#[derive(Debug)]
struct TimedEngine {
    twin: TwinEngine,
    seconds: Arc<Mutex<Seconds>>,
}

impl Engine for TimedEngine {
    fn buffer(&mut self, label: &'static str, words: usize) -> Result<BufferId, GpuError> {
        self.twin.buffer(label, words)
    }

    fn free(&mut self, buffer: BufferId) {
        self.twin.free(buffer);
    }

    fn clear(&mut self) {
        self.twin.clear();
    }

    fn words(&self, buffer: BufferId) -> usize {
        self.twin.words(buffer)
    }

    fn run(&mut self, recording: &Recording, read: &[(BufferId, usize)]) -> Result<Vec<Vec<u32>>, GpuError> {
        timed(&self.seconds, || self.twin.run(recording, read))
    }
}
