//! Table 2 at the paper's size, to its end.

use super::table_2::ROWS;
use crate::bench::{Bench, FULL_SECONDS};
use crate::figure::{Figure, Part, Report};
use crate::process::Part as RunPart;
use crate::table::{Table, geometric_mean, largest, mean, short};
use anyhow::{Context, Result};
use bowknot::Scene;
use bowknot::run::Summary;
use bowknot::simulator::StepSeconds;
use serde::Deserialize;
use std::fs;
use std::path::Path;

pub struct Table2Full;

impl Figure for Table2Full {
    fn name(&self) -> &'static str {
        "table-2-full"
    }

    fn title(&self) -> &'static str {
        "Table 2 at the paper's size, to its end"
    }

    fn question(&self) -> &'static str {
        "Every scene at scale 1 with its default settings. The judge looks at every state and at the path to it; `cpu_s` \
         includes it, `collision_s` and `dynamics_s` do not. Runs are continued by \
         further runs of this figure, a quarter of an hour each, until \
         all are at their end: `time_steps` of `all_time_steps` are done. Memory is the peak of the process that \
         computed last. The paper's seconds are those of the collision stage on a GPU, for 25 to 70 thousand \
         vertices."
    }

    fn run(&self, bench: &Bench) -> Result<Report> {
        let mut table = Table::new([
            "scene",
            "dt_s",
            "vertices",
            "time_steps",
            "all_time_steps",
            "steps",
            "most_steps",
            "paper_steps",
            "paper_most_steps",
            "collision_s",
            "most_collision_s",
            "paper_gpu_collision_s",
            "paper_gpu_most_collision_s",
            "dynamics_s",
            "cpu_s",
            "memory_kb_per_vertex",
            "max_stretch",
            "injected_energy_j",
            "unsolved",
            "intersections",
        ]);
        let (mut done, mut intersections, mut ended, mut ratios) = (0, 0, 0, Vec::new());
        let rows = bench.size.pick(&ROWS[..], &ROWS[..2], &ROWS[..1]);
        for row in rows {
            let sets: Vec<String> = row.time_step.iter().map(|dt| format!("simulation.dt={dt}")).collect();
            let scale = bench.size.pick(1.0, row.scale, row.scale);
            let scene = Scene::builtin(row.scene, scale)?.with_sets(&sets)?;
            let frames = bench.size.pick(scene.simulation.frames, 5, 2);
            let rate = 1.0 / scene.simulation.dt;
            let notes = bench.out().join("table-2-full").join(format!("{}-{rate:.0}", row.scene));
            let folder = notes.join("run");
            let is_done = read(&folder).is_ok_and(|summary| summary.frames >= frames);
            if !is_done && bench.has_time() {
                let limit = bench.size.pick(FULL_SECONDS, 60, 15) as f64;
                bench.store.note_commit(&notes)?;
                let seconds = limit - bench.figure_seconds();
                RunPart { scene: row.scene, scale, frames, dt: scene.simulation.dt, seconds }.run(&folder)?;
            }
            let Ok(summary) = read(&folder) else { continue };
            let (Some(means), Some(max)) = (&summary.mean, &summary.max) else { continue };
            bench.store.use_commits(&notes)?;
            println!("  {} 1/{rate:.0}: {} of {frames} time steps", row.scene, summary.frames);
            let collision = collision_seconds(&folder)?;
            let vertices = summary.info.vertices;
            let memory = summary.peak_memory_bytes.map_or(f64::NAN, |bytes| bytes as f64 / vertices as f64);
            let number = |value: Option<f64>| value.unwrap_or(f64::NAN);
            let found = summary.intersections.context("the run was judged")?;
            done += summary.frames;
            ended += usize::from(summary.frames >= frames);
            intersections += found;
            ratios.push(mean(&collision) / row.seconds[0]);
            table.row([
                row.scene.into(),
                format!("1/{rate:.0}").into(),
                vertices.into(),
                summary.frames.into(),
                frames.into(),
                number(means.two_way_steps).into(),
                number(max.two_way_steps).into(),
                row.steps[0].into(),
                row.steps[1].into(),
                mean(&collision).into(),
                largest(&collision).into(),
                row.seconds[0].into(),
                row.seconds[1].into(),
                number(means.seconds.dynamics).into(),
                number(means.cpu_seconds).into(),
                (1e-3 * memory).into(),
                number(max.max_stretch).into(),
                (number(means.injected_energy_j) * summary.frames as f64).into(),
                summary.unsolved_steps.into(),
                found.into(),
            ]);
        }
        Ok(Report {
            finding: format!(
                "{intersections} intersections in {done} time steps; {ended} of {} runs are at their end. The \
                 collision stage takes {} times the paper's seconds on a GPU, geometric mean.",
                rows.len(),
                short(geometric_mean(&ratios)),
            ),
            parts: vec![Part::table(
                self.name(),
                "steps, seconds, memory, stretch of every scene at the paper's size, beside the paper's",
                table,
            )],
        })
    }
}

fn read(folder: &Path) -> Result<Summary> {
    let path = folder.join("summary.json");
    let text = fs::read_to_string(&path).with_context(|| format!("cannot read {}", path.display()))?;
    Ok(serde_json::from_str(&text)?)
}

/// Wall seconds of the collision stage in each time step.
fn collision_seconds(folder: &Path) -> Result<Vec<f64>> {
    #[derive(Deserialize)]
    struct TimeStep {
        seconds: StepSeconds,
    }
    let path = folder.join("stats.jsonl");
    let text = fs::read_to_string(&path).with_context(|| format!("cannot read {}", path.display()))?;
    let seconds = |line: &str| -> Result<f64> {
        let TimeStep { seconds: s } = serde_json::from_str(line)?;
        Ok(s.search + s.evaluate + s.backward + s.forward)
    };
    text.lines().map(seconds).collect()
}
