//! One quantity over decades.

use super::case::Case;
use super::scenes::{EDGE, STRETCH_LIMIT, Setting, hammock, pile};
use crate::bench::Size;

/// Time steps of a case unless its sweep is over time steps.
const TIME_STEPS: usize = 60;

/// Simulated time of the sweep over time steps [s].
const DURATION: f64 = 0.6;

/// Why cases are known to miss a goal.
const UNSOLVED: &str = "the block and the taut sheet are not in balance after 8 Newton iterations; the rise \
                        falls with `simulation.newton_iterations`";
const TINY: &str = "energies of 1e-8 J; not understood";
const FAR: &str = "the contact distance is 40 edge lengths: nothing fits";
const THIN: &str = "the contact distance is a thousandth of an edge and less; calls end at their step limit, \
                    it is not understood why";
const FAST: &str = "all motion ends within a time step, calls end at their step limit, and edges that are \
                    too long are shortened by 3 % per call only";
const SLIVERS: &str = "positions are solved to 0.01 mean edge lengths, ten heights of a sliver and more";

/// All sweeps; smaller sizes have their ends and one value between.
pub fn all(size: Size) -> Vec<Case> {
    let steps = size.pick(TIME_STEPS, 30, 12);
    let mut cases = Vec::new();
    let thinned = |values: &[f64]| -> Vec<f64> {
        let last = values.len() - 1;
        match size {
            Size::Full => values.to_vec(),
            Size::Quick => vec![values[0], values[last / 2], values[last]],
            Size::Tiny => vec![values[last]],
        }
    };
    let usual = Setting::default();

    for dt in thinned(&[1e-3, 1.0 / 300.0, 1e-2, 1.0 / 30.0, 0.1, 0.2]) {
        let setting = Setting { dt, ..usual };
        let count = size.pick(DURATION, 0.3, 0.1) / dt;
        let count = (count.round() as usize).max(steps.min(10));
        cases.push(Case::of(&setting, ["time step", ""], format!("{dt:.4} s"), pile, count));
    }
    for exponent in thinned(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0, 10.0]) {
        let setting = Setting { stiffness: Some(10f64.powf(exponent)), ..usual };
        cases.push(Case::of(&setting, ["stiffness", ""], format!("1e{exponent:.0} Pa"), pile, steps));
    }
    for exponent in thinned(&[-3.0, -2.0, -1.0, 0.0, 1.0, 2.0, 3.0]) {
        let setting = Setting { density: 10f64.powf(exponent), ..usual };
        cases.push(Case::of(&setting, ["density", ""], format!("x 1e{exponent:.0}"), pile, steps));
    }
    for exponent in thinned(&[-3.0, -2.0, -1.0, 0.0, 1.0, 2.0, 3.0]) {
        let setting = Setting { block_density: 10f64.powf(exponent), ..usual };
        let sweep = ["density of a block on a sheet", UNSOLVED];
        cases.push(Case::of(&setting, sweep, format!("x 1e{exponent:.0}"), hammock, steps));
    }
    // Lengths of the scene from 1 mm to 1 km.
    for exponent in thinned(&[-3.0, -2.0, -1.0, 0.0, 1.0, 2.0, 3.0]) {
        let scale = 10f64.powf(exponent) / (10.0 * EDGE);
        let value = format!("1e{exponent:.0} m");
        // Large scenes take longer to fall.
        let dt = (0.01 * scale.sqrt()).clamp(0.01, 0.2);
        let scaled = Setting { size: scale, dt, ..usual };
        let known = if exponent < -2.0 { TINY } else { "" };
        cases.push(Case::of(&scaled, ["size", known], value.clone(), pile, steps));
        let fixed = Setting { delta: Some(0.1 * EDGE), ..scaled };
        // A contact distance of 40 edge lengths makes all vertices neighbors: a time step takes up to ten seconds.
        let (steps, known) = if exponent < -2.0 { (size.pick(16, 2, 2), FAR) } else { (steps, "") };
        let known = if exponent > 1.0 { THIN } else { known };
        cases.push(Case::of(&fixed, ["size, delta 4 mm", known], value, pile, steps));
    }
    for origin in thinned(&[0.0, 1.0, 1e2, 1e3, 1e4, 1e5, 1e6]) {
        let setting = Setting { origin, ..usual };
        let sweep = ["distance from the origin", ""];
        cases.push(Case::of(&setting, sweep, format!("{origin:e} m"), pile, steps));
    }
    for speed in thinned(&[1.0, 5.0, 20.0, 50.0, 100.0, 200.0, 500.0]) {
        let setting = Setting { speed, ..usual };
        let (value, known) = (format!("{speed} m per s"), if speed > 100.0 { FAST } else { "" });
        cases.push(Case::of(&setting, ["speed of a sheet", known], value.clone(), pile, steps));
        let known = if speed > 10.0 { FAST } else { UNSOLVED };
        cases.push(Case::of(&setting, ["speed of a block on a sheet", known], value, hammock, steps));
    }
    for limit in thinned(&[1.2, STRETCH_LIMIT, 1.02, 1.01, 1.003, 1.001]) {
        let setting = Setting { stretch_limit: limit, block_density: 10.0, ..usual };
        cases.push(Case::of(&setting, ["stretch limit", UNSOLVED], format!("{limit}"), hammock, steps));
    }
    for share in thinned(&[0.01, 0.03, 0.1, 0.3, 0.6, 0.9]) {
        let setting = Setting { delta: Some(share * EDGE), ..usual };
        cases.push(Case::of(&setting, ["delta, in edge lengths", ""], format!("{share}"), pile, steps));
    }
    for ratio in thinned(&[1.0, 10.0, 1e2, 1e3, 1e4]) {
        for own_delta in [false, true] {
            cases.push(slivers(ratio, own_delta, steps));
        }
    }
    cases
}

/// A sheet with a row of triangles of an aspect ratio in its middle, thrown over a block. The contact
/// distance is the default of the scene, or half of the height of the slivers.
fn slivers(ratio: f64, own_delta: bool, steps: usize) -> Case {
    let height = EDGE / ratio;
    let delta = own_delta.then_some((0.5 * height).min(0.1 * EDGE));
    let setting = Setting { delta, ..Setting::default() };
    let sheet = setting.sheet("sheet", [0.0, 0.0, 0.2], 0.0);
    let (shape, _) = sheet.split_once("shape = ").unwrap_or_default();
    let rest = sheet.split_once("rotate").map(|(_, rest)| rest).unwrap_or_default();
    let name = format!("slivers-{ratio:e}.obj");
    let mut scene = setting.head(steps);
    scene += &setting.block("block", [0.013, 0.007, 0.1], 0.0);
    scene += &format!("{shape}mesh = \"{name}\"\nrotate{rest}");
    scene += &setting.ground();
    let sweep = if own_delta { "aspect ratio, delta half a height" } else { "aspect ratio" };
    let mut case = Case::new(sweep, format!("{ratio:e}"), scene, steps);
    case.meshes.push((name, sliver_mesh(height)));
    case.known = if ratio > 500.0 { SLIVERS } else { "" };
    case
}

/// A sheet of 10 by 11 quadrilaterals, those of the middle row of a height of their own.
fn sliver_mesh(height: f64) -> String {
    let (columns, rows) = (10, 11);
    let mut text = String::new();
    for row in 0..=rows {
        let y = match row {
            0..=5 => (row as f64 - 5.0) * EDGE - 0.5 * height,
            _ => (row as f64 - 6.0) * EDGE + 0.5 * height,
        };
        for column in 0..=columns {
            let x = (column as f64 - 0.5 * f64::from(columns)) * EDGE;
            text.push_str(&format!("v {x:e} {y:e} 0\n"));
        }
    }
    for row in 0..rows {
        for column in 0..columns {
            let corner = row * (columns + 1) + column + 1;
            let above = corner + columns + 1;
            text.push_str(&format!("f {corner} {} {}\n", corner + 1, above + 1));
            text.push_str(&format!("f {corner} {} {above}\n", above + 1));
        }
    }
    text
}
