//! Steps and collision time of every scene of the paper's Table 2.

use crate::bench::Bench;
use crate::figure::{Figure, Part, Report};
use crate::simulate::simulate;
use crate::table::{Table, geometric_mean, largest, mean, short};
use anyhow::Result;
use bowknot::Scene;

pub struct Table2;

/// A row of the paper's table.
pub(super) struct Row {
    pub scene: &'static str,
    /// Time step [s]; none: the scene's own.
    pub time_step: Option<f64>,
    /// Scale, and number of time steps, which lead into contact.
    pub scale: f64,
    frames: usize,
    /// The paper's steps per time step, and its seconds per time step of the collision stage on a GPU: mean
    /// and largest.
    pub steps: [f64; 2],
    pub seconds: [f64; 2],
}

const fn row(scene: &'static str, scale: f64, frames: usize, steps: [f64; 2], seconds: [f64; 2]) -> Row {
    Row { scene, time_step: None, scale, frames, steps, seconds }
}

const fn funnel(rate: f64, frames: usize, steps: [f64; 2], seconds: [f64; 2]) -> Row {
    Row { time_step: Some(1.0 / rate), ..row("funnel", 0.2, frames, steps, seconds) }
}

pub(super) const ROWS: [Row; 15] = [
    row("needle", 0.4, 40, [46.0, 1304.0], [0.036, 1.942]),
    row("blade", 0.15, 30, [55.0, 779.0], [0.267, 4.463]),
    funnel(20.0, 20, [27.0, 675.0], [0.087, 2.161]),
    funnel(40.0, 40, [23.0, 437.0], [0.055, 1.198]),
    funnel(80.0, 80, [12.0, 165.0], [0.040, 0.776]),
    funnel(160.0, 160, [10.0, 95.0], [0.029, 0.296]),
    row("sphere", 0.2, 80, [19.0, 219.0], [0.044, 0.475]),
    row("dress", 0.12, 80, [39.0, 142.0], [0.133, 0.511]),
    row("gown", 0.12, 80, [32.0, 150.0], [0.092, 0.443]),
    row("bow-knot", 0.2, 150, [5.4, 17.0], [0.034, 0.113]),
    row("reef-knot", 0.25, 150, [7.0, 23.0], [0.024, 0.097]),
    row("tube", 0.25, 120, [19.0, 54.0], [0.308, 1.500]),
    row("mat", 0.2, 200, [9.0, 128.0], [0.020, 0.303]),
    row("hair", 0.12, 100, [16.0, 503.0], [0.252, 15.821]),
    row("sand", 0.2, 100, [51.0, 160.0], [0.223, 1.550]),
];

impl Figure for Table2 {
    fn name(&self) -> &'static str {
        "table-2"
    }

    fn title(&self) -> &'static str {
        "Table 2: steps and collision time of every scene"
    }

    fn question(&self) -> &'static str {
        "Whole simulations into contact, on small meshes to limit the time; `table-2-full` has the scenes \
         at the paper's size. `fast`, and `paper` with at most 2 s per call. All time steps count, also \
         those before contact. Small meshes take fewer steps because motions span fewer edges. The paper's \
         seconds are those of a GPU, for 25 to 70 thousand vertices."
    }

    fn run(&self, bench: &Bench) -> Result<Report> {
        let mut table = Table::new([
            "scene",
            "dt_s",
            "vertices",
            "preset",
            "steps",
            "most_steps",
            "paper_steps",
            "paper_most_steps",
            "collision_s",
            "most_collision_s",
            "paper_gpu_collision_s",
            "paper_gpu_most_collision_s",
            "time_steps",
            "met_rule",
            "intersections",
        ]);
        let (mut intersections, mut states, mut ratios) = (0, 0, Vec::new());
        let rows = bench.size.pick(&ROWS[..], &ROWS[..2], &ROWS[..1]);
        for row in rows {
            let mut means = Vec::new();
            for preset in ["fast", "paper"] {
                if !bench.has_time() {
                    break;
                }
                let limit = bench.size.pick(2.0, 0.1, 2.0);
                let mut sets =
                    vec![format!("contact.preset={preset}"), format!("solver.stop.max_seconds={limit}")];
                sets.extend(row.time_step.map(|dt| format!("simulation.dt={dt}")));
                let scene = Scene::builtin(row.scene, row.scale)?.with_sets(&sets)?;
                let dt = scene.simulation.dt;
                let key = format!("table-2/{preset}-{}-{}", row.scene, 1.0 / dt);
                let frames = bench.size.pick(row.frames, row.frames / 2, row.frames);
                let done = simulate(bench, &key, &scene, frames, 10)?;
                let steps: Vec<f64> = done.steps.iter().map(|&s| s as f64).collect();
                let vertices = done.samples.last().map_or(0, |s| s.positions.len());
                intersections += done.intersections();
                states += done.samples.len();
                means.push(mean(&steps));
                table.row([
                    row.scene.into(),
                    format!("1/{:.0}", 1.0 / dt).into(),
                    vertices.into(),
                    preset.into(),
                    mean(&steps).into(),
                    largest(&steps).into(),
                    row.steps[0].into(),
                    row.steps[1].into(),
                    mean(&done.collision).into(),
                    largest(&done.collision).into(),
                    row.seconds[0].into(),
                    row.seconds[1].into(),
                    steps.len().into(),
                    done.met.into(),
                    done.intersections().into(),
                ]);
            }
            if let [fast, paper] = means[..] {
                ratios.push(paper / fast);
            }
        }
        Ok(Report {
            finding: format!(
                "`paper` takes {} times as many steps as `fast`, geometric mean over {} scenes; \
                 {intersections} intersections in {states} states.",
                short(geometric_mean(&ratios)),
                ratios.len()
            ),
            parts: vec![Part::table(
                self.name(),
                "steps and seconds of the collision stage in whole simulations, beside the paper's",
                table,
            )],
        })
    }
}
