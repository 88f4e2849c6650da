//! A chain of nodes hangs from one pinned end and is thrown below the ground: distance limits for the links,
//! rows for the ground, friction on the ground.
//!
//! `cargo run --release -p bowknot-lcp --example chain_on_ground`
#![allow(clippy::print_stdout)] // an example shows something

use bowknot_lcp::*;
use nalgebra::Vector2;

fn main() -> Result<(), LcpError> {
    let (nodes, link) = (12_u32, 0.1);
    // The first node is pinned 0.4 m above the ground.
    let weights: Vec<f64> = (0..nodes).map(|i| if i == 0 { 0.0 } else { 1.0 }).collect();
    let start = |i: u32| Vector::new(f64::from(i) * link, 0.0, 0.4);
    // The unconstrained positions: sideways and 0.6 m down, through the ground.
    let mut y: Vec<Vector> =
        (0..nodes).map(|i| if i == 0 { start(0) } else { start(i) + Vector::new(0.0, 0.05, -0.6) }).collect();

    // One row per node: z >= 0. Unused places repeat the node, with a zero gradient.
    let zero = Vector::zeros();
    let mut rows: Vec<Row> =
        (0..nodes).map(|i| Row::new([i; 4], [Vector::z(), zero, zero, zero], 0.0)).collect();
    prepare_rows(&mut rows, &weights)?;
    let limits: Vec<DistanceLimit> =
        (1..nodes).map(|i| DistanceLimit { vertices: [i - 1, i], limit: link }).collect();
    let mut friction: Vec<FrictionRow> = (0..nodes)
        .map(|i| FrictionRow {
            tangents: [Vector::x(), Vector::y()],
            coefficients: [1.0, 0.0, 0.0, 0.0],
            offsets: [-start(i).x, -start(i).y],
            vertices: [i; 4],
            friction: 0.05,
            inverse_diagonal: f64::NAN,
            normal: i,
        })
        .collect();
    prepare_friction(&mut friction, &weights)?;

    // Ground rows share no node: one color. Links alternate between two, through an order.
    let order: Vec<u32> = (0..nodes - 1).step_by(2).chain((1..nodes - 1).step_by(2)).collect();
    let link_starts = [0, nodes / 2, nodes - 1];
    let ground = [0, nodes];
    let problem = LcpProblem::new(
        &weights,
        ConstraintSet::new(&rows, Schedule::colored(&ground)),
        ConstraintSet::new(&limits, Schedule::active(&order, &link_starts)),
        ConstraintSet::new(&friction, Schedule::colored(&ground)),
    )?;
    validate_colors(&problem)?;

    let (mut lambda, mut limit_multipliers) = (vec![0.0; rows.len()], vec![zero; limits.len()]);
    let mut multipliers = vec![Vector2::zeros(); friction.len()];
    let mut state = LcpState {
        y: &mut y,
        lambda: &mut lambda,
        limit_multipliers: &mut limit_multipliers,
        friction: &mut multipliers,
    };
    let params = LcpParams { max_sweeps: 5000, tolerance: Some(1e-9), ..LcpParams::default() };
    let info = solve_colored(&problem, &mut state, &params)?;
    let left = residuals(&problem, &state, params.friction_bound)?;
    println!(
        "{} sweeps, residual {:.1e} m; complementarity {:.1e}",
        info.sweeps, info.residual, left.complementarity
    );
    for (i, (position, lambda)) in y.iter().zip(&lambda).enumerate() {
        println!(
            "node {i:2}: {:6.3} {:6.3} {:6.3} m, ground {lambda:.3}",
            position.x, position.y, position.z
        );
    }
    Ok(())
}
