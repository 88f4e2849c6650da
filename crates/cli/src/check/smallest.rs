//! The fewest elements of a state that intersect.

use crate::exit::Failure;
use crate::failure_dump;
use crate::interrupt::Interrupt;
use bowknot::judging::JudgedState;
use bowknot::recording::{Failure as Shown, States};
use bowknot::run::SmallestState;
use bowknot::twoway::Params;
use std::collections::BTreeSet;
use std::path::Path;

/// Writes the fewest elements of a state that intersect, and says what it wrote.
pub fn write(file: &Path, states: &States) -> Result<String, Failure> {
    let smallest = failure_dump::reduce(&Interrupt::default(), |limits| {
        let reduction = states.reduce(&Params::default(), Shown::Intersects, limits)?;
        Some(SmallestState { failure: Some(Shown::Intersects), reduction })
    });
    match smallest {
        Some(smallest) => failure_dump::write(file, &smallest, None),
        None => Ok(format!("an archive cannot hold this state: nothing was written to {}", file.display())),
    }
}

/// A judged mesh as a problem that moves nothing. Bodies are numbered anew: any numbers may stand in a mesh,
/// and obstacles share them with what is none.
pub fn state_of(state: &JudgedState<'_>) -> States {
    let positions = state.positions;
    let mut mesh = state.mesh.clone();
    mesh.leave_out(&mesh.absent(positions));
    let count = positions.len();
    let obstacle = mesh.obstacle.unwrap_or_else(|| vec![false; count]);
    let body = mesh.body.unwrap_or_else(|| vec![0; count]);
    let keys: Vec<(u32, bool)> = body.into_iter().zip(obstacle.iter().copied()).collect();
    let numbers: BTreeSet<(u32, bool)> = keys.iter().copied().collect();
    let numbers: Vec<(u32, bool)> = numbers.into_iter().collect();
    States {
        x: positions.to_vec(),
        y: positions.to_vec(),
        rest: positions.to_vec(),
        masses: vec![1.0; count],
        triangles: mesh.triangles,
        strands: mesh.strands,
        particles: mesh.particles,
        fixed: vec![false; count],
        obstacle,
        body: keys.iter().map(|key| numbers.partition_point(|other| other < key) as u32).collect(),
        ..States::default()
    }
}
