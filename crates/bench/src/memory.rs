//! The memory of a run, measured in a process of its own, because a process reports only its own peak.

use anyhow::{Context, Result, ensure};
use bowknot::simulator::peak_memory_bytes;
use bowknot::{Scene, Simulator};
use serde::{Deserialize, Serialize};
use std::process::Command;

/// Memory and size of a run.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub struct Footprint {
    /// Largest resident memory.
    pub bytes: u64,
    /// Deformable vertices.
    pub vertices: usize,
    /// Largest number of candidate pairs after a search.
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

/// The work of that process: runs the scene and prints its footprint as JSON.
pub fn print_footprint(scene: &str, scale: f64, frames: usize) -> Result<()> {
    let mut simulator = Simulator::new(&Scene::builtin(scene, scale)?)?;
    let mut pairs = 0;
    for _ in 0..frames {
        pairs = pairs.max(simulator.step()?.pairs);
    }
    let bytes = peak_memory_bytes().context("this system does not report the peak memory of a process")?;
    let vertices = simulator.world().deformable_vertices;
    println!("{}", serde_json::to_string(&Footprint { bytes, vertices, pairs })?);
    Ok(())
}
