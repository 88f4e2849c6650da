//! Time steps in contact on a GPU beside the CPU's: whole time steps, the stages of the device, the growth with the size.

use super::goals::TABLE_2;
use crate::bench::{Bench, Size};
use crate::figure::{Figure, Part, Report};
use crate::table::{Table, geometric_mean, largest, short};
use anyhow::{Context, Result};
use bowknot::dynamics::{DeviceWork, NewtonBackend};
use bowknot::gpu::{Adapter, ConjugateGradients, Device, DeviceEngine, Profile, StageTime};
use bowknot::simulator::{Checkpoint, CollisionBackend};
use bowknot::{Scene, Simulator, StepStatistics};
use bowknot_errors::counted;
use std::fs;
use std::time::Instant;

pub struct Gpu;

/// Scenes with their scale, and the time steps that the CPU makes before: they lead into contact.
const SCENES: [(&str, f64, usize); 12] = [
    ("bow-knot", 1.0, 60),
    ("needle", 1.0, 25),
    ("dress", 1.0, 37),
    ("tube", 1.0, 40),
    ("reef-knot", 1.0, 76),
    ("sphere", 1.0, 32),
    ("gown", 1.0, 42),
    ("mat", 1.0, 126),
    ("hair", 1.0, 36),
    ("sand", 1.0, 60),
    ("blade", 1.0, 1),
    ("funnel", 1.0, 0),
];

/// Scales of `drape`, which falls with 4 m/s and lands: 16 thousand to 800 thousand triangles.
const SIZES: [f64; 4] = [1.4, 3.2, 6.3, 10.0];
const FALL: &str = "body.0.velocity=[0,0,-4]";
const FALL_LEAD: usize = 7;

/// Time steps that are measured, after one in which the device compiles its kernels.
const STEPS: usize = 3;

/// No further time step is made on the CPU after this time [s].
const CPU_SECONDS: f64 = 2.0;

/// Scenes in which the stages are measured, with settings.
const STAGES: [(&str, f64, usize, &[&str]); 2] =
    [("bow-knot", 1.0, 60, &[]), ("drape", 3.2, FALL_LEAD, &[FALL])];

impl Figure for Gpu {
    fn name(&self) -> &'static str {
        "gpu"
    }

    fn title(&self) -> &'static str {
        "Time steps on a GPU"
    }

    fn question(&self) -> &'static str {
        "Three time steps in contact on the first GPU, with collisions and dynamics, and the same on the CPU on as many \
         threads as `--threads` says, one of them where it takes long: seconds per time step, all of it included. The CPU leads the scenes into contact \
         and writes that state to `leads/` in the folder of results; what lies there is taken, and `--cases leads` makes them on a machine without a \
         GPU. Per time step: iterations, \
         submissions, dispatches and waits of the device, milliseconds in which the host records and submits, and in which it waits \
         for results. `apart_mm`: between the centers of mass of the bodies after these time steps, at most. `paper_s`: the \
         collision stage alone in the paper, on its GPU, mean over other time steps. `gpu-stages.csv`: what the stages of the \
         device take, between time stamps of its own, and the bytes of the buffers that they bind. `gpu-sizes.csv`: growth \
         with the number of triangles. On a software driver everything runs small, and times mean nothing."
    }

    fn run(&self, bench: &Bench) -> Result<Report> {
        if bench.asks_for("leads") {
            return leads(bench);
        }
        let adapter = Adapter::choose(None)?;
        let is_small = adapter.is_software() || bench.size != Size::Full;
        println!("  {adapter}");
        let mut scenes = table();
        let (mut ratios, mut over_paper) = (Vec::new(), Vec::new());
        let count = bench.size.pick(SCENES.len(), 3, 1);
        for &(name, scale, lead) in SCENES[..count].iter().filter(|(name, ..)| bench.wants(name)) {
            if !bench.has_time() {
                break;
            }
            let (scale, lead) = if is_small { (0.1 * scale, lead / 4) } else { (scale, lead) };
            let course = Course::new(bench, name, scale, &[], lead)?;
            let [cpu, gpu] = course.both(&adapter)?;
            let paper = TABLE_2.iter().find(|row| row.0 == name).map_or(f64::NAN, |row| row.2);
            ratios.push(cpu.seconds / gpu.seconds);
            over_paper.push(gpu.seconds / paper);
            course.add(&mut scenes, &cpu, &gpu, paper);
        }
        let stages =
            if bench.wants("stages") { stages(&adapter, bench, is_small)? } else { Table::default() };
        let mut sizes = table();
        let count = if is_small { bench.size.pick(2, 1, 1) } else { SIZES.len() };
        for &scale in SIZES[..count].iter().filter(|_| bench.wants("sizes")) {
            if !bench.has_time() {
                break;
            }
            let scale = if is_small { 0.2 * scale } else { scale };
            let course = Course::new(bench, "drape", scale, &[FALL], FALL_LEAD)?;
            let [cpu, gpu] = course.both(&adapter)?;
            course.add(&mut sizes, &cpu, &gpu, f64::NAN);
        }
        let note =
            if adapter.is_software() { " It is a software driver: these times mean nothing." } else { "" };
        Ok(Report {
            finding: format!(
                "{adapter}: the CPU ({}) takes {} times as long, geometric mean over {} scenes; a whole time step on the \
                 device takes {} times the paper's collision stage at most.{note}",
                counted(rayon::current_num_threads(), "thread", "threads"),
                short(geometric_mean(&ratios)),
                ratios.len(),
                short(largest(&over_paper)),
            ),
            parts: vec![
                Part::table(self.name(), "whole time steps in contact on a GPU and on the CPU", scenes),
                Part::table("gpu-stages", "what the stages of a time step take on a GPU", stages),
                Part::table("gpu-sizes", "growth with the size, on a GPU and on the CPU", sizes),
            ],
        })
    }
}

fn table() -> Table {
    Table::new([
        "scene",
        "scale",
        "vertices",
        "cpu_s",
        "gpu_s",
        "paper_s",
        "newton_cpu",
        "newton_gpu",
        "linear_cpu",
        "linear_gpu",
        "steps_cpu",
        "steps_gpu",
        "submissions",
        "dispatches",
        "waits",
        "buffers",
        "departures",
        "encode_ms",
        "wait_ms",
        "collisions_ms",
        "dynamics_ms",
        "apart_mm",
    ])
}

/// A scene, and its state in contact.
struct Course {
    name: String,
    scale: f64,
    scene: Scene,
    lead: Checkpoint,
}

/// Time steps on one backend.
struct Measured {
    /// Seconds per time step.
    seconds: f64,
    statistics: Vec<StepStatistics>,
    /// Centers of the vertices of each body at the end of each time step [m].
    centers: Vec<Vec<[f64; 3]>>,
    vertices: usize,
}

impl Measured {
    /// Mean per time step.
    fn mean(&self, of: impl Fn(&StepStatistics) -> f64) -> f64 {
        self.statistics.iter().map(of).sum::<f64>() / self.statistics.len() as f64
    }
}

impl Course {
    fn new(bench: &Bench, name: &str, scale: f64, sets: &[&str], lead: usize) -> Result<Self> {
        let sets: Vec<String> = sets.iter().map(|&set| set.to_owned()).collect();
        let scene = Scene::builtin(name, scale)?.with_sets(&sets)?;
        let folder = bench.out().join("leads");
        fs::create_dir_all(&folder).with_context(|| format!("cannot create {}", folder.display()))?;
        let file = folder.join(format!("{name}-{scale}.npz"));
        let lead = if file.exists() {
            Checkpoint::read(&file)?
        } else {
            let mut simulator = Simulator::new(&scene)?;
            (0..lead).try_for_each(|_| simulator.step().map(|_| ()))?;
            let lead = simulator.checkpoint();
            lead.write(&file)?;
            lead
        };
        Ok(Self { name: name.to_owned(), scale, scene, lead })
    }

    fn both(&self, adapter: &Adapter) -> Result<[Measured; 2]> {
        let gpu = self.measure(Some(device(adapter, None)?))?;
        let cpu = self.measure(None)?;
        println!(
            "  {} {}: CPU {:.4} s, GPU {:.4} s per time step",
            self.name, self.scale, cpu.seconds, gpu.seconds
        );
        Ok([cpu, gpu])
    }

    /// The time steps, on the CPU or on a device.
    fn measure(&self, device: Option<Backends>) -> Result<Measured> {
        let mut simulator = Simulator::new(&self.scene)?;
        let is_device = device.is_some();
        if let Some((collisions, dynamics)) = device {
            simulator.set_backend(collisions)?;
            simulator.set_dynamics_backend(Some(dynamics))?;
        }
        simulator.restore(&self.lead)?;
        if is_device {
            simulator.step()?;
            simulator.restore(&self.lead)?;
        }
        let (mut statistics, mut centers, mut seconds) = (Vec::new(), Vec::new(), 0.0);
        while statistics.is_empty() || statistics.len() < STEPS && (is_device || seconds < CPU_SECONDS) {
            let timer = Instant::now();
            statistics.push(simulator.step()?);
            seconds += timer.elapsed().as_secs_f64();
            centers.push(centers_of(&simulator));
        }
        let seconds = seconds / statistics.len() as f64;
        Ok(Measured { seconds, statistics, centers, vertices: simulator.positions().len() })
    }

    fn add(&self, table: &mut Table, cpu: &Measured, gpu: &Measured, paper: f64) {
        let distance =
            |(a, b): (&[f64; 3], &[f64; 3])| (0..3).map(|k| (a[k] - b[k]).powi(2)).sum::<f64>().sqrt();
        let last = cpu.centers.len() - 1;
        let apart = cpu.centers[last].iter().zip(&gpu.centers[last]).map(distance).fold(0.0, f64::max);
        let work = |of: fn(&DeviceWork) -> f64| gpu.mean(|step| step.device.as_ref().map_or(0.0, of));
        table.row([
            self.name.as_str().into(),
            self.scale.into(),
            gpu.vertices.into(),
            cpu.seconds.into(),
            gpu.seconds.into(),
            paper.into(),
            cpu.mean(|step| step.newton_iterations as f64).into(),
            gpu.mean(|step| step.newton_iterations as f64).into(),
            cpu.mean(|step| step.cg_iterations as f64).into(),
            gpu.mean(|step| step.cg_iterations as f64).into(),
            cpu.mean(|step| step.two_way_steps as f64).into(),
            gpu.mean(|step| step.two_way_steps as f64).into(),
            work(|work| work.submissions as f64).into(),
            work(|work| work.dispatches as f64).into(),
            work(|work| work.waits as f64).into(),
            work(|work| work.buffers as f64).into(),
            work(|work| work.departures as f64).into(),
            (1e3 * work(|work| work.encode_s)).into(),
            (1e3 * work(|work| work.wait_s)).into(),
            (1e3 * gpu.mean(|step| step.seconds.total - step.seconds.dynamics)).into(),
            (1e3 * gpu.mean(|step| step.seconds.dynamics)).into(),
            (1e3 * apart).into(),
        ]);
        println!("{}", table.markdown().lines().last().unwrap_or_default());
    }
}

/// Centers of the vertices of each body [m].
fn centers_of(simulator: &Simulator) -> Vec<[f64; 3]> {
    let positions = simulator.positions();
    let center = |vertices: std::ops::Range<u32>| {
        let count = vertices.len().max(1) as f64;
        let sum = vertices.map(|v| positions[v as usize].coords).sum::<bowknot::geometry::Vector>();
        (sum / count).into()
    };
    simulator.world().bodies.iter().map(|body| center(body.vertices.clone())).collect()
}

/// Writes the states in contact of all scenes at full size.
fn leads(bench: &Bench) -> Result<Report> {
    let of_scenes = SCENES.map(|(name, scale, lead)| (name, scale, &[] as &[&str], lead));
    let of_sizes = SIZES.map(|scale| ("drape", scale, &[FALL] as &[&str], FALL_LEAD));
    for (name, scale, sets, lead) in of_scenes.into_iter().chain(of_sizes) {
        let timer = Instant::now();
        Course::new(bench, name, scale, sets, lead)?;
        println!("  {name} {scale}: {:.1} s", timer.elapsed().as_secs_f64());
    }
    Ok(Report { finding: "states in contact".into(), parts: Vec::new() })
}

type Backends = (Box<dyn CollisionBackend>, Box<dyn NewtonBackend>);

/// The device as both backends, which measures its stages if there are profiles.
fn device(adapter: &Adapter, profiles: Option<[Profile; 2]>) -> Result<Backends> {
    let name = adapter.to_string();
    let mut collisions = DeviceEngine::open(adapter)?;
    let mut dynamics = collisions.beside();
    if let Some([of_collisions, of_dynamics]) = profiles {
        collisions.measure(of_collisions);
        dynamics.measure(of_dynamics);
    }
    Ok((Box::new(Device::new(name.clone(), collisions)), Box::new(ConjugateGradients::new(name, dynamics))))
}

/// What the stages of the device take.
fn stages(adapter: &Adapter, bench: &Bench, is_small: bool) -> Result<Table> {
    let mut table = Table::new([
        "scene",
        "half",
        "stage",
        "dispatches",
        "ms",
        "us_per_dispatch",
        "bound_megabytes_per_dispatch",
        "bound_gigabytes_per_s",
    ]);
    for (name, scale, lead, sets) in STAGES {
        let (scale, lead) = if is_small { (0.1 * scale, lead / 4) } else { (scale, lead) };
        let profiles = [Profile::default(), Profile::default()];
        let course = Course::new(bench, name, scale, sets, lead)?;
        let measured = course.measure(Some(device(adapter, Some(profiles.clone()))?))?;
        // The time step in which kernels are compiled counts.
        let steps = measured.statistics.len() as f64 + 1.0;
        for (half, profile) in ["collisions", "dynamics"].into_iter().zip(profiles) {
            let mut stages: Vec<(&str, StageTime)> = profile.stages();
            stages.sort_by(|a, b| b.1.seconds.total_cmp(&a.1.seconds));
            for (stage, time) in stages {
                let dispatches = time.dispatches as f64;
                table.row([
                    name.into(),
                    half.into(),
                    stage.into(),
                    (dispatches / steps).into(),
                    (1e3 * time.seconds / steps).into(),
                    (1e6 * time.seconds / dispatches).into(),
                    (1e-6 * time.bytes as f64 / dispatches).into(),
                    (1e-9 * time.bytes as f64 / time.seconds).into(),
                ]);
            }
        }
    }
    println!("{}", table.markdown());
    Ok(table)
}
