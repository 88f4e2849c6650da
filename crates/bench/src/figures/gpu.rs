//! Time steps on a GPU beside the CPU's: the scenes of Table 2, the stages of a step, the growth with the size.

use super::goals::TABLE_2;
use crate::bench::{Bench, Size};
use crate::figure::{Figure, Part, Report};
use crate::table::{Entry, Table, geometric_mean, largest, mean, short};
use crate::timed::{TimedBackend, taken};
use anyhow::{Context, Result};
use bowknot::dynamics::NewtonBackend;
use bowknot::gpu::{Adapter, ConjugateGradients, Device, DeviceEngine, Profile, StageTime};
use bowknot::simulator::{CollisionBackend, Cpu};
use bowknot::{Scene, Simulator};
use bowknot_errors::counted;
use std::sync::Arc;
use std::time::Instant;

pub struct Gpu;

/// Scene, its scale and number of time steps, in which the stages are measured: it touches the ball in the last ones.
const STAGES: (&str, f64, usize) = ("drape", 2.0, 16);

/// Scales of the growth with the size: 10 thousand to 2 million triangles.
const SCALES: [f64; 6] = [1.4, 3.2, 6.3, 10.0, 14.0, 20.0];

impl Figure for Gpu {
    fn name(&self) -> &'static str {
        "gpu"
    }

    fn title(&self) -> &'static str {
        "Time steps on a GPU"
    }

    fn question(&self) -> &'static str {
        "First time steps of the scenes of Table 2 at the paper's size, first on the CPU, on as many threads \
         as `--threads` says, then on the first GPU, with their dynamics. Seconds of the collision stage per \
         time step, reading of contacts included, and of whole time steps. A time step before them does not count, since the device compiles its \
         kernels in it. `gpu-stages.csv`: what the stages of the device take, between time stamps of its own, and the bytes of \
         the buffers that they bind. `gpu-sizes.csv`: growth with the number of triangles. On a software driver everything \
         runs small, and times mean nothing."
    }

    fn run(&self, bench: &Bench) -> Result<Report> {
        let adapter = Adapter::choose(None)?;
        let small = adapter.is_software();
        println!("  {adapter}");
        let scale = bench.size.pick(if small { 0.15 } else { 1.0 }, 0.1, 0.1);
        let mut scenes = table(["scene", "time_steps"]);
        let count = bench.size.pick(TABLE_2.len(), 3, 1);
        let (mut ratios, mut over_paper) = (Vec::new(), Vec::new());
        for &(name, frames, paper) in &TABLE_2[..count] {
            if !bench.has_time() {
                break;
            }
            let frames = bench.size.pick(if small { frames.min(4) } else { frames }, 3, 1);
            let pair = Pair::measure(&adapter, name, scale, frames)?;
            println!("  {name}: CPU {:.4} s, GPU {:.4} s per time step", pair.cpu.mean(), pair.gpu.mean());
            ratios.push(pair.cpu.mean() / pair.gpu.mean());
            over_paper.push(pair.gpu.mean() / paper);
            pair.add(&mut scenes, vec![name.into(), frames.into()], paper);
        }
        let mut sizes = table(["scale", "triangles"]);
        let scales = bench.size.pick(if small { 2 } else { SCALES.len() }, 1, 1);
        for scale in &SCALES[..scales] {
            if !bench.has_time() {
                break;
            }
            let pair = Pair::measure(&adapter, "drape", *scale, bench.size.pick(6, 2, 1))?;
            pair.add(&mut sizes, vec![(*scale).into(), pair.triangles.into()], f64::NAN);
        }
        let stages = stages(&adapter, bench)?;
        let note = if small { " It is a software driver: these times mean nothing." } else { "" };
        Ok(Report {
            finding: format!(
                "{adapter}: the CPU ({}) takes {} times as long, geometric mean over {} scenes; the device {} times \
                 the paper's seconds at most.{note}",
                counted(rayon::current_num_threads(), "thread", "threads"),
                short(geometric_mean(&ratios)),
                ratios.len(),
                short(largest(&over_paper)),
            ),
            parts: vec![
                Part::table(
                    self.name(),
                    "seconds of the collision stage and of whole time steps on a GPU and on the CPU, beside the paper's",
                    scenes,
                ),
                Part::table("gpu-stages", "what the stages of the two-way step take on a GPU", stages),
                Part::table(
                    "gpu-sizes",
                    "growth of the collision stage with the size, on a GPU and on the CPU",
                    sizes,
                ),
            ],
        })
    }
}

fn table(first: [&str; 2]) -> Table {
    Table::new([
        first[0],
        first[1],
        "vertices",
        "cpu_s",
        "cpu_most_s",
        "gpu_s",
        "gpu_most_s",
        "paper_gpu_s",
        "cpu_steps",
        "gpu_steps",
        "gpu_ms_per_step",
        "cpu_whole_s",
        "gpu_whole_s",
    ])
}

/// The same time steps on both.
struct Pair {
    cpu: Measured,
    gpu: Measured,
    vertices: usize,
    triangles: usize,
}

/// Seconds and two-way steps of the collision stage by time step, and seconds of all of it.
struct Measured {
    seconds: Vec<f64>,
    whole: Vec<f64>,
    steps: Vec<f64>,
}

impl Measured {
    fn mean(&self) -> f64 {
        mean(&self.seconds)
    }
}

impl Pair {
    fn measure(adapter: &Adapter, name: &str, scale: f64, frames: usize) -> Result<Self> {
        let scene = Scene::builtin(name, scale)?;
        let (cpu, world) = simulate(&scene, Box::new(Cpu), None, frames)?;
        let name = adapter.to_string();
        let device = Device::new(name.clone(), DeviceEngine::open(adapter)?);
        let dynamics = ConjugateGradients::new(name, DeviceEngine::open(adapter)?);
        let (gpu, _) = simulate(&scene, Box::new(device), Some(Box::new(dynamics)), frames)?;
        let triangles = world.collision.topology().triangles.len();
        Ok(Self { cpu, gpu, vertices: world.collision_vertices(), triangles })
    }

    fn add(&self, table: &mut Table, first: Vec<Entry>, paper: f64) {
        let steps: f64 = self.gpu.steps.iter().sum();
        let mut row = first;
        row.extend([
            self.vertices.into(),
            self.cpu.mean().into(),
            largest(&self.cpu.seconds).into(),
            self.gpu.mean().into(),
            largest(&self.gpu.seconds).into(),
            paper.into(),
            mean(&self.cpu.steps).into(),
            mean(&self.gpu.steps).into(),
            (1e3 * self.gpu.seconds.iter().sum::<f64>() / steps).into(),
            mean(&self.cpu.whole).into(),
            mean(&self.gpu.whole).into(),
        ]);
        table.row(row);
    }
}

/// Runs the first time steps of a scene and times the calls of the backend, but for those of the first one.
fn simulate(
    scene: &Scene,
    backend: Box<dyn CollisionBackend>,
    dynamics: Option<Box<dyn NewtonBackend>>,
    frames: usize,
) -> Result<(Measured, Arc<bowknot::World>)> {
    let mut simulator = Simulator::new(scene)?;
    let seconds = Arc::default();
    // The judge is a part of the collision stage.
    let timed = TimedBackend { backend, resolve: Arc::clone(&seconds), judge: Arc::clone(&seconds) };
    simulator.set_backend(Box::new(timed))?;
    simulator.set_dynamics_backend(dynamics)?;
    let mut measured = Measured { seconds: Vec::new(), whole: Vec::new(), steps: Vec::new() };
    for frame in 0..=frames {
        let timer = Instant::now();
        let statistics = simulator.step()?;
        let whole = timer.elapsed().as_secs_f64();
        let spent = taken(&seconds).wall;
        // The device compiles its kernels in the first one.
        if frame == 0 {
            continue;
        }
        measured.seconds.push(spent);
        measured.whole.push(whole);
        measured.steps.push(statistics.two_way_steps as f64);
    }
    Ok((measured, Arc::clone(simulator.world())))
}

/// What the stages of the device take in one scene.
fn stages(adapter: &Adapter, bench: &Bench) -> Result<Table> {
    let mut table = Table::new([
        "stage",
        "dispatches_per_step",
        "us_per_step",
        "share",
        "us_per_dispatch",
        "bound_megabytes_per_dispatch",
        "bound_gigabytes_per_s",
    ]);
    let (name, scale, frames) = STAGES;
    let small = adapter.is_software() || bench.size != Size::Full;
    let (scale, frames) = if small { (0.2, bench.size.pick(16, 8, 2)) } else { (scale, frames) };
    let mut engine = DeviceEngine::open(adapter).context("a device for the stages")?;
    let profile = Profile::default();
    engine.measure(profile.clone());
    let scene = Scene::builtin(name, scale)?;
    let (measured, _) = simulate(&scene, Box::new(Device::new(adapter.to_string(), engine)), None, frames)?;
    let steps: f64 = measured.steps.iter().sum();
    let mut stages: Vec<(&str, StageTime)> = profile.stages();
    stages.sort_by(|a, b| b.1.seconds.total_cmp(&a.1.seconds));
    let total: f64 = stages.iter().map(|(_, time)| time.seconds).sum();
    for (name, time) in stages {
        let dispatches = time.dispatches as f64;
        let bytes = time.bytes as f64 / dispatches;
        table.row([
            name.into(),
            (dispatches / steps).into(),
            (1e6 * time.seconds / steps).into(),
            (time.seconds / total).into(),
            (1e6 * time.seconds / dispatches).into(),
            (1e-6 * bytes).into(),
            (1e-9 * time.bytes as f64 / time.seconds).into(),
        ]);
    }
    Ok(table)
}
