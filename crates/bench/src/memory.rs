//! The memory of a run, measured in a process of its own: a process only tells the most that it has ever had.

use anyhow::{Context, Result, ensure};
use bowknot::simulator::peak_memory_bytes;
use bowknot::{Scene, Simulator};
use serde::{Deserialize, Serialize};
use std::process::Command;

/// What a run took.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub struct Footprint {
    /// Largest resident memory.
    pub bytes: u64,
    /// Deformable vertices.
    pub vertices: usize,
    /// Most pairs listed after a search.
    pub pairs: usize,
}

/// Runs a scene in another process of this command.
pub fn footprint(scene: &str, scale: f64, frames: usize) -> Result<Footprint> {
    let output = Command::new(std::env::current_exe()?)
        .args(["footprint", "--of", scene, "--scale", &scale.to_string(), "--frames", &frames.to_string()])
        .output()
        .context("cannot start another process of this command")?;
    ensure!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    Ok(serde_json::from_slice(&output.stdout)?)
}

/// What that process does: runs the scene and prints its footprint as JSON.
pub fn print_footprint(scene: &str, scale: f64, frames: usize) -> Result<()> {
    let mut simulator = Simulator::new(&Scene::builtin(scene, scale)?)?;
    let mut pairs = 0;
    for _ in 0..frames {
        pairs = pairs.max(simulator.step()?.pairs);
    }
    let bytes = peak_memory_bytes().context("this system does not tell how much memory a process has had")?;
    let vertices = simulator.world().deformable_vertices;
    println!("{}", serde_json::to_string(&Footprint { bytes, vertices, pairs })?);
    Ok(())
}
