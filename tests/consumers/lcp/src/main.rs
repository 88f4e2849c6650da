//! A stack of five blocks on the ground, pressed down: who carries what.
#![allow(clippy::print_stdout, reason = "a command")]

use bowknot_lcp::{LcpError, LcpParams, LcpProblem, LcpState, Row, Vector, prepare_rows, solve_serial};

fn main() -> Result<(), LcpError> {
    // Blocks of height 1, and each wants to be 1 lower than where it just touches.
    let count = 5;
    let weights = vec![1.0; count];
    let mut y: Vec<Vector> = (0..count).map(|i| Vector::new(0.0, 0.0, i as f64 - 1.0)).collect();
    let (up, none) = (Vector::z(), Vector::zeros());
    let mut rows: Vec<Row> = (0..count as u32)
        .map(|i| match i {
            0 => Row::new([0; 4], [up, none, none, none], 0.0),
            _ => Row::new([i, i - 1, i, i], [up, -up, none, none], -1.0),
        })
        .collect();
    prepare_rows(&mut rows, &weights)?;
    let problem = LcpProblem::of_rows(&weights, &rows)?;

    let mut lambda = vec![0.0; count];
    let mut state =
        LcpState { y: &mut y, lambda: &mut lambda, limit_multipliers: &mut [], friction: &mut [] };
    let params = LcpParams { tolerance: Some(1e-12), max_sweeps: 10_000, ..LcpParams::default() };
    let info = solve_serial(&problem, &mut state, &params)?;
    println!("heights {:?}, loads {lambda:?}, {info:?}", y.iter().map(|y| y.z).collect::<Vec<_>>());
    for i in 0..count {
        assert!((y[i].z - i as f64).abs() < 1e-9);
        // Each carries what lies on it and itself.
        assert!((lambda[i] - (count - i) as f64).abs() < 1e-9);
    }
    Ok(())
}

#[test]
fn runs() {
    main().unwrap();
}
