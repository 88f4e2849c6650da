//! Whole runs into a folder, and their pages.

use crate::compute::compute;
use crate::error;
use crate::scene::Scene;
use bowknot::report::{ReportOptions, write_report};
use bowknot::run::{Progress, RunOptions, Summary, UnsolvedAdvice};
use bowknot::scene::SimulationParams;
use pyo3::prelude::*;
use std::ops::ControlFlow;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::Ordering;

/// Runs a scene into a folder as the command does: findings of the check, and what to say of time
/// steps that did not go well.
#[pyfunction]
pub fn run(
    py: Python<'_>,
    scene: &Scene,
    out: PathBuf,
    resume: bool,
    check: bool,
) -> PyResult<(Vec<String>, Vec<String>)> {
    let done = compute(py, |stop| {
        let options = RunOptions { out, resume, check, interrupt: Some(Arc::clone(stop)), watch: None };
        let mut go_on = |_: &Progress<'_>| match stop.load(Ordering::Relaxed) {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        };
        bowknot::run::run(&scene.scene, &options, &mut go_on).map_err(error::simulation)
    })?;
    let outcome = done.finish()??;
    Ok((outcome.findings, advice(&outcome.summary, &scene.scene.simulation)))
}

/// What the command says at the end of a run about time steps, with the keys of scenes.
fn advice(summary: &Summary, simulation: &SimulationParams) -> Vec<String> {
    let unsolved = summary.unsolved_advice(simulation).map(|UnsolvedAdvice { text, remedy }| {
        let key = |key: &str, value: &str| match value {
            "" => format!("simulation.{key}"),
            value => format!("simulation.{key} = {value}"),
        };
        match remedy {
            Some(remedy) => format!("{text}; what helps: {}", remedy.in_words(key)),
            None => text,
        }
    });
    unsolved.into_iter().chain(summary.held_apart_advice()).collect()
}

/// Writes the page of a run: its path, and what it leaves out.
#[pyfunction]
pub fn report(
    py: Python<'_>,
    folder: PathBuf,
    out: PathBuf,
    stride: Option<usize>,
    max_bytes: Option<u64>,
) -> PyResult<(PathBuf, Vec<String>)> {
    let defaults = ReportOptions::default();
    let options = ReportOptions { stride, max_bytes: max_bytes.unwrap_or(defaults.max_bytes) };
    let written =
        compute(py, |_| write_report(&folder, &out, &options, &mut |_, _| {}).map_err(error::input))?;
    let info = written.finish()??;
    Ok((info.path, info.left_out))
}
