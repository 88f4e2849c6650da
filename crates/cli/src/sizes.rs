//! What speaks for a wrong unit in a collision problem.

use crate::bare_mesh;
use bowknot::geometry::Point;
use bowknot::recording::States;

/// Extent from which on lengths are likely not in meters [m].
const LARGE: f64 = 20.0;
/// Extent below which they are likely not [m].
const SMALL: f64 = 1e-3;
/// Ratio of an edge at the start to its rest length, or the reverse, that no fabric has.
const MAX_EDGE_RATIO: f64 = 2.0;
/// Distance of a target that no time step makes, in extents of the state.
const MAX_TRAVEL: f64 = 100.0;

/// What is odd about the sizes, in words.
pub fn oddities(states: &States) -> Vec<String> {
    let mut found = Vec::new();
    let extent = extent(&states.x);
    if states.x.len() > 1 && !(SMALL..=LARGE).contains(&extent) {
        found.push(format!("the state x is {extent:.3e} m in size; lengths are in m"));
    }
    if let Some(ratio) = edge_ratio(states).filter(|r| !(1.0 / MAX_EDGE_RATIO..=MAX_EDGE_RATIO).contains(r)) {
        found.push(format!(
            "edges of x are {ratio:.3} times as long as those of rest (median); are both in m?"
        ));
    }
    let travel = states.x.iter().zip(&states.y).map(|(x, y)| (y - x).norm()).fold(0.0, f64::max);
    if travel > MAX_TRAVEL * extent && extent > 0.0 {
        found.push(format!("the target y is up to {travel:.3e} m from x, which is {extent:.3e} m in size"));
    }
    found
}

/// The largest side of the bounding box [m].
fn extent(positions: &[Point]) -> f64 {
    let (low, high) = bare_mesh::extent(positions);
    (high - low).max()
}

/// Median ratio of the lengths of deformable edges in x and at rest.
fn edge_ratio(states: &States) -> Option<f64> {
    let sides = states.triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
    let edges = sides.chain(states.strands.iter().copied()).map(|edge| edge.map(|v| v as usize));
    let deformable = edges.filter(|[a, b]| !states.obstacle[*a] && !states.obstacle[*b]);
    let length = |x: &[Point], [a, b]: [usize; 2]| (x[a] - x[b]).norm();
    let mut ratios: Vec<f64> = deformable
        .map(|edge| length(&states.x, edge) / length(&states.rest, edge))
        .filter(|ratio| ratio.is_finite())
        .collect();
    let middle = ratios.len() / 2;
    (!ratios.is_empty()).then(|| *ratios.select_nth_unstable_by(middle, f64::total_cmp).1)
}
