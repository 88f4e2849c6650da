//! Draws the buffers and the dispatches of a two-way step, from what the step records, as an SVG on stdout:
//! `cargo run --release -p bowknot-gpu --example step_picture > docs/gpu/step.svg`
#![allow(clippy::print_stdout, reason = "an example")]

use bowknot_geometry::{BodyFilter, CollisionModel, HalfSpace, Point, Topology, Vector};
use bowknot_gpu::{
    BufferId, Call, Collision, Constraints, Engine, GpuError, Lengths, Phase, Recording, Settings, TwinEngine,
};
use std::fmt::Write;

/// Sides of the sheets, in vertices.
const SIDE: usize = 6;

/// Width of a column, height of a row, width of the names of buffers, height of those of stages [pixels].
const COLUMN: usize = 17;
const ROW: usize = 15;
const NAMES: usize = 170;
const STAGES: usize = 150;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut collision = scene(RecordingEngine::default())?;
    let target: Vec<Point> = positions().iter().map(|x| x - Vector::new(0.0, 0.0, 0.5)).collect();
    collision.begin(&Call::toward(&target))?;
    // The first steps make room for their pairs.
    for _ in 0..4 {
        collision.step()?;
    }
    println!("{}", picture(collision.engine())?);
    Ok(())
}

/// Two sheets above each other.
fn positions() -> Vec<Point> {
    let sheet = |z: f64| (0..SIDE * SIDE).map(move |k| Point::new((k % SIDE) as f64, (k / SIDE) as f64, z));
    sheet(0.1).chain(sheet(0.2)).collect()
}

/// The sheets over the ground, with friction and limits on the lengths of edges, so that every stage takes
/// part.
fn scene(engine: RecordingEngine) -> Result<Collision<RecordingEngine>, Box<dyn std::error::Error>> {
    let corner = |first: usize, k: usize| (first + k) as u32;
    let mut triangles = Vec::new();
    for first in [0, SIDE * SIDE] {
        for k in (0..SIDE * (SIDE - 1)).filter(|k| k % SIDE != SIDE - 1) {
            let [a, b, c, d] = [k, k + 1, k + SIDE + 1, k + SIDE].map(|k| corner(first, k));
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    let x = positions();
    let count = x.len();
    let topology = Topology::builder(count).triangles(triangles).build()?;
    let edges = topology.edges.len();
    let ground = HalfSpace::new(Point::origin(), Vector::z()).ok_or("a normal of no length")?;
    let bodies = (0..count).map(|v| u32::from(v >= SIDE * SIDE)).collect();
    let model = CollisionModel::new(topology, bodies, vec![BodyFilter::DEFORMABLE; 2], vec![ground])?;
    let lengths = Lengths {
        edges: &vec![1.0; count],
        margins: &vec![0.05; count],
        deltas: &vec![0.02; count],
        half_space_deltas: &vec![0.02; count],
        thicknesses: &vec![f64::NAN; count],
        half_space_thicknesses: &[f64::NAN],
        min_separation: 1e-3,
        edge_limits: &vec![1.6; edges],
    };
    let constraints =
        Constraints { frictions: &vec![0.3; count], half_space_frictions: &[0.3], ..Constraints::default() };
    Ok(Collision::new(engine, &model, &x, &x, &lengths, &constraints, &Settings::default())?)
}

/// The twins, with the names of the buffers and the stages of the last step.
#[derive(Debug, Default)]
struct RecordingEngine {
    twin: TwinEngine,
    labels: Vec<(BufferId, &'static str)>,
    stages: Vec<StageUse>,
}

/// A stage of a step: how often it runs, what it reads and writes.
#[derive(Clone, Debug)]
struct StageUse {
    name: &'static str,
    phase: Phase,
    dispatches: usize,
    /// Names of buffers, and whether they are written.
    buffers: Vec<(&'static str, bool)>,
}

impl RecordingEngine {
    fn label(&self, buffer: BufferId) -> &'static str {
        let found = self.labels.iter().rev().find(|(id, _)| *id == buffer);
        found.map_or("?", |(_, label)| label)
    }

    fn note(&mut self, recording: &Recording) {
        let mut stages: Vec<StageUse> = Vec::new();
        for dispatch in recording.dispatches() {
            let Some(phase) = dispatch.phase else { continue };
            let index = stages.iter().position(|use_| use_.name == dispatch.stage && use_.phase == phase);
            let index = index.unwrap_or_else(|| {
                stages.push(StageUse { name: dispatch.stage, phase, dispatches: 0, buffers: Vec::new() });
                stages.len() - 1
            });
            stages[index].dispatches += 1;
            for (&buffer, write) in dispatch.buffers.iter().zip(&dispatch.writes) {
                let label = self.label(buffer);
                let buffers = &mut stages[index].buffers;
                match buffers.iter_mut().find(|(name, _)| *name == label) {
                    Some((_, written)) => *written |= write,
                    None => buffers.push((label, *write)),
                }
            }
        }
        // A search alone, or a read, is no step.
        if stages.iter().any(|use_| use_.phase == Phase::Backward) {
            self.stages = stages;
        }
    }
}

impl Engine for RecordingEngine {
    fn buffer(&mut self, label: &'static str, words: usize) -> Result<BufferId, GpuError> {
        let buffer = self.twin.buffer(label, words)?;
        self.labels.push((buffer, label));
        Ok(buffer)
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
        self.note(recording);
        self.twin.run(recording, read)
    }
}

fn color(phase: Phase) -> &'static str {
    match phase {
        Phase::Search => "#0072b2",
        Phase::Evaluate => "#009e73",
        Phase::Backward => "#d55e00",
        Phase::Forward => "#cc79a7",
    }
}

/// One column per stage, one row per buffer.
fn picture(engine: &RecordingEngine) -> Result<String, std::fmt::Error> {
    let stages = &engine.stages;
    let mut buffers: Vec<&str> = Vec::new();
    for (name, _) in stages.iter().flat_map(|stage| &stage.buffers) {
        if !buffers.contains(name) {
            buffers.push(name);
        }
    }
    let (width, height) = (NAMES + COLUMN * stages.len() + 10, STAGES + ROW * buffers.len() + 40);
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" width=\"{width}\" \
         font-family=\"sans-serif\" font-size=\"11\">\n<rect width=\"{width}\" height=\"{height}\" fill=\"white\"/>\n"
    );
    for (row, name) in buffers.iter().enumerate() {
        let y = STAGES + ROW * row;
        let shade = if row % 2 == 0 { "#f2f2f2" } else { "white" };
        writeln!(svg, "<rect x=\"0\" y=\"{y}\" width=\"{width}\" height=\"{ROW}\" fill=\"{shade}\"/>")?;
        writeln!(svg, "<text x=\"{}\" y=\"{}\" text-anchor=\"end\">{name}</text>", NAMES - 6, y + ROW - 4)?;
    }
    for (column, stage) in stages.iter().enumerate() {
        let (x, color) = (NAMES + COLUMN * column, color(stage.phase));
        let times = if stage.dispatches > 1 { format!(" x {}", stage.dispatches) } else { String::new() };
        writeln!(
            svg,
            "<text transform=\"translate({} {}) rotate(-90)\" fill=\"{color}\">{}{times}</text>",
            x + COLUMN - 5,
            STAGES - 6,
            stage.name
        )?;
        for (name, write) in &stage.buffers {
            let row = buffers.iter().position(|buffer| buffer == name).unwrap_or(0);
            let (x, y) = (x + 4, STAGES + ROW * row + 3);
            let fill = if *write { color } else { "white" };
            writeln!(
                svg,
                "<rect x=\"{x}\" y=\"{y}\" width=\"9\" height=\"9\" fill=\"{fill}\" stroke=\"{color}\" stroke-width=\"1.5\"/>"
            )?;
        }
    }
    let y = height - 14;
    let mut x = NAMES;
    for phase in [Phase::Backward, Phase::Evaluate, Phase::Forward, Phase::Search] {
        writeln!(svg, "<text x=\"{x}\" y=\"{y}\" fill=\"{}\">{phase:?}</text>", color(phase))?;
        x += 70;
    }
    let words = "filled: written, or read and written; empty: read; x n: dispatches per step";
    writeln!(svg, "<text x=\"{x}\" y=\"{y}\">{words}</text>")?;
    svg += "</svg>";
    Ok(svg)
}
