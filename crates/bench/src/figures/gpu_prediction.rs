//! What time steps would take on a large GPU, from the dispatches and the bytes of small scenes: a prediction.

use super::table_2::{PaperScene, paper_scenes};
use crate::bench::Bench;
use crate::figure::{Figure, Part, Report};
use crate::table::{Table, geometric_mean, short};
use anyhow::{Context, Result};
use bowknot::gpu::{
    BufferId, ConjugateGradients, Device, DispatchView, Engine, GpuError, Recording, TwinEngine,
};
use bowknot::{Scene, Simulator, World};
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

pub struct GpuPrediction;

/// The device of the prediction: bytes per second of its memory, its multiprocessors, seconds from one dispatch to the
/// next; seconds until the threads of a workgroup have waited for each other and have their next data, from the memory of
/// the device, or from their own with the arithmetic of a row; seconds from a submission until the host has what it reads,
/// bytes per second between host and device.
const BANDWIDTH: f64 = 4.8e12;
const MULTIPROCESSORS: f64 = 132.0;
const DISPATCH: f64 = 3e-6;
const WAIT: f64 = 1e-6;
const SHORT_WAIT: f64 = 0.3e-6;
const SUBMISSION: f64 = 30e-6;
const LINK: f64 = 50e9;

/// How often the threads of a workgroup wait per round of coloring, of which there are as many as colors, and for a bucket or
/// a cluster that they keep in their own memory: what it has, rows or edges, displacements, and to write them back.
const WAITS_PER_COLORING: f64 = 5.0;
const WAITS_PER_VISIT: f64 = 4.0;

/// The same for a bucket or cluster that a sweep would not change, where nothing is swept or written.
const WAITS_OF_IDLE: f64 = 3.0;

/// Sweeps over a bucket of rows and over a cluster of edges, as `bowknot_gpu::Settings::default` has them; most rows of a bucket
/// and most colors of a cluster that a workgroup keeps (`sweep_rows.wgsl`, `sweep_edges.wgsl`).
const BUCKET_SWEEPS: f64 = 3.0;
const CLUSTER_SWEEPS: f64 = 3.0;
const KEPT_ROWS: u32 = 256;
const KEPT_COLORS: u32 = 12;

/// Nodes of a patch of the preconditioner. A full one has 64: there are at most so many coarse levels.
const NODES_OF_PATCH: usize = 50;

/// Time steps that are counted.
const FRAMES: usize = 3;

impl Figure for GpuPrediction {
    fn name(&self) -> &'static str {
        "gpu-prediction"
    }

    fn title(&self) -> &'static str {
        "Time steps on a GPU: a prediction"
    }

    fn question(&self) -> &'static str {
        "A prediction, not a measurement. The CPU leads small scenes into contact; then the twins of the kernels make a time \
         step, which writes what stays for the run, and three more, of which every dispatch is counted, with the bytes that are in use of the buffers that it binds. For a device of 4.8 TB/s and 132 \
         multiprocessors, a dispatch takes 3 microseconds, one more for each time that the threads of a workgroup wait for \
         each other and for memory, 0.3 for a color whose rows or edges they keep, plus its bytes at full speed, or at the share of the multiprocessors that it has \
         workgroups for. Dispatches of one stage that follow each other with the same buffers \
         (colors of a sweep, levels of a tree) share the bytes. A submission takes 30 microseconds, and what the host \
         writes and reads goes at 50 GB/s. To the paper's size, bytes and threads grow with the number of vertices, and \
         dispatches stay as many, but for coarse levels of the preconditioner; stages of one workgroup keep one. Iterations of conjugate gradients that \
         are submitted after the last one that is needed take their dispatches, and no bytes. Seconds of collisions per time \
         step are those of as many two-way steps as the paper takes; those of the dynamics are of the time steps that were counted, whose linear iterations \
         grow with the size. Work of the host is left out (`gpu-host` has it), and so are cache misses, atomics and arithmetic."
    }

    fn run(&self, bench: &Bench) -> Result<Report> {
        let mut table = Table::new([
            "scene",
            "vertices",
            "counted_vertices",
            "counted_rows",
            "dispatches_per_step",
            "of_one_workgroup",
            "megabytes_per_step",
            "bucket_visits_left_out",
            "cluster_visits_left_out",
            "least_ms_per_step",
            "ms_per_step",
            "paper_ms_per_step",
            "paper_steps",
            "predicted_s",
            "paper_s",
        ]);
        let mut stages =
            Table::new(["scene", "stage", "dispatches_per_step", "megabytes_per_step", "us_per_step"]);
        let mut stages_of_dynamics = Table::new([
            "scene",
            "stage",
            "dispatches_per_time_step",
            "megabytes_per_time_step",
            "us_per_time_step",
        ]);
        let mut dynamics = Table::new([
            "scene",
            "nodes",
            "counted_nodes",
            "newton_iterations",
            "cg_iterations",
            "dispatches_per_time_step",
            "submissions_per_time_step",
            "megabytes_per_time_step",
            "host_megabytes_per_time_step",
            "least_ms",
            "predicted_ms",
            "with_collisions_ms",
        ]);
        let scenes = paper_scenes();
        let count = bench.size.pick(scenes.len(), 3, 1);
        let mut ratios = Vec::new();
        for paper in &scenes[..count] {
            if !bench.has_time() {
                break;
            }
            let scene = Counted::of(paper, bench.size.pick(1.0, 0.7, 0.3))?;
            let counts = &scene.collisions;
            let growth = scene.vertices as f64 / scene.counted_vertices as f64;
            let steps = scene.steps as f64;
            let step = counts.seconds(growth) / steps;
            let least = counts.latency() / steps;
            let [dispatches, single] = counts.dispatches().map(|count| count as f64 / steps);
            let bytes = counts.bytes();
            println!("  {}: {:.3} ms per step", paper.scene, 1e3 * step);
            ratios.push(step * paper.steps / paper.seconds);
            table.row([
                paper.scene.into(),
                scene.vertices.into(),
                scene.counted_vertices.into(),
                scene.rows.into(),
                dispatches.into(),
                single.into(),
                (1e-6 * growth * bytes / steps).into(),
                counts.share_left_out("sweep_rows").map_or("".into(), Into::into),
                counts.share_left_out("sweep_edges").map_or("".into(), Into::into),
                (1e3 * least).into(),
                (1e3 * step).into(),
                (1e3 * paper.seconds / paper.steps).into(),
                paper.steps.into(),
                (step * paper.steps).into(),
                paper.seconds.into(),
            ]);
            let frames = FRAMES as f64;
            let (of_dynamics, growth_of_nodes) =
                (&scene.dynamics, scene.nodes[1] as f64 / scene.nodes[0] as f64);
            let seconds = of_dynamics.seconds(growth_of_nodes) / frames;
            dynamics.row([
                paper.scene.into(),
                scene.nodes[1].into(),
                scene.nodes[0].into(),
                (scene.newton_iterations as f64 / frames).into(),
                (scene.cg_iterations as f64 / frames).into(),
                (of_dynamics.dispatches()[0] as f64 / frames).into(),
                (of_dynamics.submissions as f64 / frames).into(),
                (1e-6 * growth_of_nodes * of_dynamics.bytes() / frames).into(),
                (1e-6 * growth_of_nodes * of_dynamics.link_bytes / frames).into(),
                (1e3 * of_dynamics.latency() / frames).into(),
                (1e3 * seconds).into(),
                (1e3 * (seconds + step * paper.steps)).into(),
            ]);
            let by_stage = [
                (counts, growth, steps, &mut stages),
                (of_dynamics, growth_of_nodes, frames, &mut stages_of_dynamics),
            ];
            for (counts, growth, over, table) in by_stage {
                for (stage, [dispatches, bytes, seconds]) in counts.by_stage(growth) {
                    table.row([
                        paper.scene.into(),
                        stage.into(),
                        (dispatches / over).into(),
                        (1e-6 * bytes / over).into(),
                        (1e6 * seconds / over).into(),
                    ]);
                }
            }
        }
        Ok(Report {
            finding: format!(
                "Predicted, not measured: {} times the paper's seconds, geometric mean over {} scenes, with as many steps as the \
                 paper takes.",
                short(geometric_mean(&ratios)),
                ratios.len()
            ),
            parts: vec![
                Part::table(self.name(), "predicted seconds of the collision stage on a large GPU", table),
                Part::file("gpu-prediction-stages", "the same by stage of the two-way step", stages),
                Part::file(
                    "gpu-prediction-stages-of-dynamics",
                    "the same by stage of the dynamics, per time step",
                    stages_of_dynamics,
                ),
                Part::table(
                    "gpu-prediction-dynamics",
                    "predicted milliseconds of the dynamics per time step on a large GPU",
                    dynamics,
                ),
            ],
        })
    }
}

/// Dispatches of one stage with the same number of workgroups.
#[derive(Debug, Default)]
struct Group {
    dispatches: usize,
    /// Bytes in use of the bound buffers.
    bytes: f64,
    /// Seconds in which the threads of a workgroup wait for each other.
    waits: f64,
}

/// What one workgroup does of a dispatch that goes through colors.
#[derive(Clone, Copy, Debug)]
struct Workgroup {
    /// Whether its bucket or cluster has rows or edges.
    works: bool,
    /// Whether a sweep would change one of them.
    sweeps: bool,
    /// Seconds that its threads wait for each other.
    waits: f64,
}

/// What some time steps of a scene needed.
#[derive(Debug)]
struct Counted {
    collisions: Counts,
    dynamics: Counts,
    /// Two-way steps, and most contact rows of a time step.
    steps: usize,
    rows: usize,
    newton_iterations: usize,
    cg_iterations: usize,
    counted_vertices: usize,
    /// Vertices at the paper's size.
    vertices: usize,
    /// Nodes of the dynamics, counted and at the paper's size.
    nodes: [usize; 2],
}

impl Counted {
    /// Counts some time steps of a scene at a share of its small scale.
    fn of(paper: &PaperScene, share: f64) -> Result<Self> {
        let scene = Scene::builtin(paper.scene, share * paper.scale)?;
        let mut lead = Simulator::new(&scene)?;
        for _ in 1..paper.frames {
            lead.step()?;
        }
        let mut simulator = Simulator::new(&scene)?;
        simulator.restore(&lead.checkpoint()).map_err(anyhow::Error::msg)?;
        let (engine, collisions) = CountingEngine::new();
        let mut device = Device::new("twins".to_owned(), engine);
        // Each dispatch that is recorded then runs.
        device.set_steps_per_submission(1);
        simulator.set_backend(Box::new(device))?;
        let (engine, dynamics) = CountingEngine::new();
        simulator
            .set_dynamics_backend(Some(Box::new(ConjugateGradients::new("twins".to_owned(), engine))))?;
        let taken = |counts: &Mutex<Counts>| {
            std::mem::take(&mut *counts.lock().unwrap_or_else(PoisonError::into_inner))
        };
        // The first time step writes what stays for a run.
        simulator.step()?;
        taken(&collisions);
        taken(&dynamics);
        let full = World::new(&Scene::builtin(paper.scene, 1.0)?)?;
        let nodes =
            |world: &World| world.deformable_vertices + world.positions.len() - world.collision_vertices();
        let mut counted = Self {
            collisions: Counts::default(),
            dynamics: Counts::default(),
            steps: 0,
            rows: 0,
            newton_iterations: 0,
            cg_iterations: 0,
            counted_vertices: simulator.world().collision_vertices(),
            vertices: full.collision_vertices(),
            nodes: [nodes(simulator.world()), nodes(&full)],
        };
        for _ in 0..FRAMES {
            let statistics = simulator.step()?;
            counted.steps += statistics.two_way_steps;
            counted.rows = counted.rows.max(statistics.contact_rows);
            counted.newton_iterations += statistics.newton_iterations;
            counted.cg_iterations += statistics.cg_iterations;
        }
        counted.collisions = taken(&collisions);
        counted.dynamics = taken(&dynamics);
        counted.dynamics.more_climbs = climbs(counted.nodes[1]) / climbs(counted.nodes[0]) - 1.0;
        (counted.steps > 0).then_some(counted).context("no two-way step was made")
    }
}

/// What the submissions to a device needed.
#[derive(Debug, Default)]
struct Counts {
    /// By the stage and the mean number of workgroups of dispatches that share their bytes; 0 for stages of one workgroup.
    groups: BTreeMap<(&'static str, usize), Group>,
    /// Visits of buckets or clusters by stage, and those of which something changed.
    visits: BTreeMap<&'static str, [usize; 2]>,
    /// Submissions that the host waits for.
    submissions: usize,
    /// Bytes between host and device.
    link_bytes: f64,
    /// Dispatches of `climb` that the paper's size has more, for each one that was counted.
    more_climbs: f64,
}

impl Counts {
    /// `colored` tells, by dispatch, the workgroups of all dispatches of a stage that goes through the colors of something,
    /// one dispatch after the other, `share_of` which share of the dispatches like this one moves its bytes.
    fn add(
        &mut self,
        recording: &Recording,
        bytes_of: impl Fn(BufferId) -> f64,
        share_of: impl Fn(&DispatchView<'_>) -> f64,
        colored: &[Option<Vec<Workgroup>>],
        words_read: usize,
    ) {
        let all: Vec<_> = recording.dispatches().zip(colored).collect();
        for run in all.chunk_by(|(a, _), (b, _)| a.stage == b.stage && a.buffers == b.buffers) {
            let (mut workgroups, mut waits) = (0, 0.0);
            let mut next = 0;
            for (one, colored) in run {
                let count = one.threads.div_ceil(one.workgroup);
                if let Some(all) = colored {
                    // The next sweep begins again.
                    if next + count > all.len() {
                        next = 0;
                    }
                    let here = &all[next..next + count];
                    next += count;
                    let visited = here.iter().filter(|one| one.works).count();
                    let visits = self.visits.entry(one.stage).or_default();
                    visits[0] += visited;
                    visits[1] += here.iter().filter(|one| one.sweeps).count();
                    workgroups += visited;
                    waits += here.iter().map(|one| one.waits).fold(0.0, f64::max);
                } else {
                    workgroups += count;
                }
            }
            let is_single = run.iter().all(|(one, _)| one.threads == 1);
            let workgroups = if is_single { 0 } else { workgroups.div_ceil(run.len()).max(1) };
            let first = &run[0].0;
            let group = self.groups.entry((first.stage, workgroups)).or_default();
            group.dispatches += run.len();
            group.waits += waits;
            let bytes: f64 = first.buffers.iter().map(|&buffer| bytes_of(buffer)).sum();
            group.bytes += share_of(first) * bytes;
        }
        self.submissions += usize::from(words_read > 0);
        self.link_bytes += 4.0 * (recording.words_written() + words_read) as f64;
    }

    /// Bytes in use of the bound buffers.
    fn bytes(&self) -> f64 {
        self.groups.values().map(|group| group.bytes).sum()
    }

    /// Number of dispatches, and of those with one workgroup.
    fn dispatches(&self) -> [usize; 2] {
        let count = |only_single: bool| {
            let groups = self.groups.iter().filter(|((_, workgroups), _)| !only_single || *workgroups == 0);
            groups.map(|(_, group)| group.dispatches).sum()
        };
        [count(false), count(true)]
    }

    /// The share of the visits of buckets or clusters by a stage in which nothing was to be swept; nothing without visits.
    fn share_left_out(&self, stage: &str) -> Option<f64> {
        let [visits, swept] = *self.visits.get(stage)?;
        (visits > 0).then(|| 1.0 - swept as f64 / visits as f64)
    }

    /// Seconds of dispatches, waits and submissions alone.
    fn latency(&self) -> f64 {
        let waits: f64 = self.groups.values().map(|group| group.waits).sum();
        let dispatches: f64 = self.groups.iter().map(|(key, group)| self.full_dispatches(key.0, group)).sum();
        DISPATCH * dispatches + waits + SUBMISSION * self.submissions as f64
    }

    /// Dispatches of a stage at the paper's size.
    fn full_dispatches(&self, stage: &str, group: &Group) -> f64 {
        group.dispatches as f64 * if stage == "climb" { 1.0 + self.more_climbs } else { 1.0 }
    }

    /// Predicted seconds of a scene that is so many times as large.
    fn seconds(&self, growth: f64) -> f64 {
        let bytes: f64 =
            self.groups.iter().map(|(key, group)| byte_seconds(key.1, group.bytes, growth)).sum();
        self.latency() + bytes + growth * self.link_bytes / LINK
    }

    /// Dispatches, bytes and seconds of each stage.
    fn by_stage(&self, growth: f64) -> BTreeMap<&'static str, [f64; 3]> {
        let mut stages: BTreeMap<&'static str, [f64; 3]> = BTreeMap::new();
        for ((stage, workgroups), group) in &self.groups {
            let dispatches = self.full_dispatches(stage, group);
            let latency = DISPATCH * dispatches + group.waits;
            let seconds = latency + byte_seconds(*workgroups, group.bytes, growth);
            let sums = stages.entry(stage).or_default();
            for (sum, more) in sums.iter_mut().zip([dispatches, growth * group.bytes, seconds]) {
                *sum += more;
            }
        }
        stages
    }
}

/// Seconds in which a stage moves its bytes, at the share of the multiprocessors that its workgroups fill; 0 workgroups are
/// one that stays one.
fn byte_seconds(workgroups: usize, bytes: f64, growth: f64) -> f64 {
    let filled = if workgroups == 0 { 1.0 } else { growth * workgroups as f64 };
    growth * bytes / (BANDWIDTH * (filled / MULTIPROCESSORS).min(1.0))
}

/// Whether a stage is one of an iteration of the conjugate gradients that count in that buffer.
fn is_of_iterations(dispatch: &DispatchView<'_>, progress: BufferId) -> bool {
    let stages = ["strand_product", "multiply", "descend", "climb", "redirect"];
    stages.contains(&dispatch.stage) && dispatch.buffers.last() == Some(&progress)
}

/// Seconds that the threads of a workgroup wait for a bucket of rows or a cluster of edges, by its words.
fn waiting(stage: &str, part: &[u32]) -> f64 {
    let colors = f64::from(part[part.len() - 1]);
    let visit = |colors: f64| WAITS_PER_VISIT * WAIT + colors * SHORT_WAIT;
    match stage {
        "color" => WAITS_PER_COLORING * WAIT * colors,
        "sweep_rows" if part[1] - part[0] <= KEPT_ROWS => visit(BUCKET_SWEEPS * colors),
        "sweep_rows" => BUCKET_SWEEPS * WAIT * colors,
        _ if part[4] <= KEPT_COLORS => visit(CLUSTER_SWEEPS * colors),
        _ => CLUSTER_SWEEPS * WAIT * colors,
    }
}

/// A dispatch that goes through the colors of buckets of rows or of clusters of edges: which words it reads, before it runs or
/// after.
#[derive(Debug)]
struct Colored {
    stage: &'static str,
    /// Buckets (where they begin, where they end, how many colors they have), or clusters, of whose five words the last is
    /// the number of colors.
    parts: Vec<u32>,
    /// The order of the rows, or where colors end.
    order: Vec<u32>,
    /// Rows or edges, and the displacements.
    items: Vec<u32>,
    displacements: Vec<u32>,
}

impl Colored {
    fn of(twin: &TwinEngine, dispatch: &DispatchView<'_>) -> Option<Self> {
        let bindings = match dispatch.stage {
            "color" => [2, 6, 1, 0],
            "sweep_rows" => [1, 0, 3, 4],
            "sweep_edges" => [1, 3, 4, 5],
            _ => return None,
        };
        let [parts, order, items, displacements] =
            bindings.map(|binding| twin.words_of(dispatch.buffers[binding]));
        Some(Self { stage: dispatch.stage, parts, order, items, displacements })
    }

    /// The rows or edges of a bucket or cluster.
    fn items_of<'a>(&'a self, part: &'a [u32]) -> impl Iterator<Item = &'a [u32]> {
        let (rows, edges) = if self.stage == "sweep_edges" {
            let last = self.order[(part[3] + part[4] - 1) as usize];
            (&self.order[..0], part[2]..last)
        } else {
            (&self.order[part[0] as usize..part[1] as usize], 0..0)
        };
        let words = if self.stage == "sweep_edges" { 8 } else { 24 };
        rows.iter().copied().chain(edges).map(move |item| &self.items[words * item as usize..][..words])
    }

    /// The words of the multipliers of a row or of an edge, friction included.
    fn multipliers(&self, item: &[u32]) -> [u32; 4] {
        if self.stage == "sweep_edges" {
            [item[4], item[5], item[6], 0]
        } else {
            [item[13], item[20], item[21], item[22]]
        }
    }

    /// What each workgroup does if the dispatch leaves `after`: no sweep where nothing changes.
    fn workgroups(&self, after: &Self) -> Vec<Workgroup> {
        let words = if self.stage == "sweep_edges" { 5 } else { 3 };
        // Multipliers that are only applied move something and stay.
        let only_applies = self.items == after.items && self.displacements != after.displacements;
        let is_swept = |part: &[u32]| {
            let mut pairs = self.items_of(part).zip(after.items_of(part));
            pairs.any(|(before, after)| {
                let multipliers = self.multipliers(before);
                // The words of a multiplier are 0 or those of -0 where there is no force.
                let presses = multipliers.iter().any(|word| word & 0x7fff_ffff != 0);
                if only_applies { presses } else { multipliers != self.multipliers(after) }
            })
        };
        let workgroup = |part: &[u32]| {
            let works = part[words - 1] > 0;
            let sweeps = works && (self.stage == "color" || is_swept(part));
            let waits = match [works, sweeps] {
                [false, _] => 0.0,
                [true, false] => WAITS_OF_IDLE * WAIT,
                [true, true] => waiting(self.stage, part),
            };
            Workgroup { works, sweeps, waits }
        };
        // Buckets have their colors once they are colored.
        let parts = if self.stage == "color" { &after.parts } else { &self.parts };
        parts.chunks_exact(words).map(workgroup).collect()
    }
}

/// Dispatches of `climb` per iteration for so many nodes: one per three coarse levels, of which each has an eighth of the
/// groups of the one before.
fn climbs(nodes: usize) -> f64 {
    let (mut groups, mut levels) = (nodes.div_ceil(NODES_OF_PATCH), 0usize);
    while groups > 1 {
        levels += 1;
        groups = if groups <= 8 { 1 } else { groups.div_ceil(8) };
    }
    levels.div_ceil(3).max(1) as f64
}

/// The twins, and what they do.
#[derive(Debug)]
struct CountingEngine {
    twin: TwinEngine,
    counts: Arc<Mutex<Counts>>,
}

impl CountingEngine {
    fn new() -> (Self, Arc<Mutex<Counts>>) {
        let counts: Arc<Mutex<Counts>> = Arc::default();
        (Self { twin: TwinEngine::new(), counts: Arc::clone(&counts) }, counts)
    }

    /// Runs a recording. Tells, by dispatch, the workgroups of those that go through colors.
    fn run_apart(&mut self, recording: &Recording) -> Result<Vec<Option<Vec<Workgroup>>>, GpuError> {
        let mut workgroups = Vec::new();
        for part in recording.parts() {
            let before = part.dispatches().next().map(|dispatch| Colored::of(&self.twin, &dispatch));
            self.twin.run(&part, &[])?;
            let Some(before) = before else { continue };
            let after = part.dispatches().next().and_then(|dispatch| Colored::of(&self.twin, &dispatch));
            workgroups.push(before.zip(after).map(|(before, after)| before.workgroups(&after)));
        }
        Ok(workgroups)
    }

    /// Where conjugate gradients count their iterations in a recording that ends a round, and how many they have counted.
    fn iterations(&self, recording: &Recording) -> Option<(BufferId, u32)> {
        let end = recording.dispatches().find(|one| one.stage == "accumulate")?;
        let progress = end.buffers[1];
        Some((progress, self.twin.words_of(progress)[1]))
    }

    /// How many of the iterations in a recording were made, and their number: the others find that the residual is small enough.
    fn iterations_made(
        &self,
        recording: &Recording,
        before: Option<(BufferId, u32)>,
    ) -> Option<(BufferId, [u32; 2])> {
        let (progress, before) = before?;
        let starts = recording.dispatches().any(|one| one.stage == "guess");
        let made = self.twin.words_of(progress)[1].saturating_sub(if starts { 0 } else { before });
        let is_one = |one: &DispatchView<'_>| one.stage == "redirect" && is_of_iterations(one, progress);
        let recorded = recording.dispatches().filter(is_one).count() as u32;
        (recorded > 0).then_some((progress, [made, recorded]))
    }

    /// Zeros for the rows and their order, which a step makes anew: what an earlier step with more rows left there is not in
    /// use.
    fn without_old_rows(&self, recording: &Recording) -> Recording {
        let mut zeros = Recording::default();
        for dispatch in recording.dispatches() {
            let made = match dispatch.stage {
                "list" => dispatch.buffers[2],
                "sort" => dispatch.buffers[3],
                _ => continue,
            };
            zeros.write(made, &vec![0u32; self.twin.words_in_use(made)]);
        }
        zeros
    }
}

impl Engine for CountingEngine {
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
        self.twin.run(&self.without_old_rows(recording), &[])?;
        let before = self.iterations(recording);
        let colored = self.run_apart(recording)?;
        let result = self.twin.run(&Recording::default(), read)?;
        let made = self.iterations_made(recording, before);
        let words_read = read.iter().map(|(_, words)| words).sum();
        let mut counts = self.counts.lock().unwrap_or_else(PoisonError::into_inner);
        let bytes_of = |buffer| 4.0 * self.twin.words_in_use(buffer) as f64;
        let share_of = |dispatch: &DispatchView<'_>| match made {
            Some((progress, [made, recorded])) if is_of_iterations(dispatch, progress) => {
                // That the residual is small enough is found after one product more.
                let product = matches!(dispatch.stage, "strand_product" | "multiply");
                f64::from((made + u32::from(product)).min(recorded)) / f64::from(recorded)
            }
            _ => 1.0,
        };
        counts.add(recording, bytes_of, share_of, &colored, words_read);
        Ok(result)
    }
}
