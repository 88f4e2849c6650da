//! `bowknot scenes`: lists the built-in scenes with their sizes.

use crate::args::ScenesOptions;
use crate::exit::{Exit, Failure};
use crate::output;
use bowknot::{BUILTIN, Scene, SceneInfo};
use serde::Serialize;

#[derive(Debug, Serialize)]
struct Entry {
    name: &'static str,
    summary: &'static str,
    /// Default `--frames`.
    frames: usize,
    #[serde(flatten)]
    info: SceneInfo,
}

pub fn scenes(options: &ScenesOptions) -> Result<Exit, Failure> {
    let entry = |name, summary| -> Result<Entry, Failure> {
        let scene = Scene::builtin(name, 1.0).map_err(Failure::input)?;
        let info = scene.info().map_err(Failure::input)?;
        Ok(Entry { name, summary, frames: scene.simulation.frames, info })
    };
    let entries: Vec<Entry> = BUILTIN.iter().map(|b| entry(b.name, b.summary)).collect::<Result<_, _>>()?;
    if options.json {
        output::print_json(&entries)?;
        return Ok(Exit::Success);
    }
    let mut lines = vec![format!(
        "{:<10} {:>9} {:>10} {:>9} {:>7}",
        "scene", "vertices", "triangles", "obstacle", "frames"
    )];
    lines.extend(entries.iter().map(|e| {
        let SceneInfo { vertices, triangles, obstacle_vertices, .. } = e.info;
        format!(
            "{:<10} {vertices:>9} {triangles:>10} {obstacle_vertices:>9} {:>7}  {}",
            e.name, e.frames, e.summary
        )
    }));
    let note =
        "(vertices and triangles of deformable bodies, vertices of obstacles, default number of time steps)";
    lines.push(note.to_owned());
    output::print(&lines.join("\n"))?;
    Ok(Exit::Success)
}
