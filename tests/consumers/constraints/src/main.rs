//! A vertex that wants to go through a triangle: one contact row, solved.
#![allow(clippy::print_stdout, reason = "a command")]

use bowknot_constraints::geometry::{PairKind, Point, Vector, separation};
use bowknot_constraints::lcp::{LcpError, LcpParams, LcpProblem, LcpState, prepare_rows, solve_serial};
use bowknot_constraints::{ContactForm, contact_row, predicted_gap};

fn main() -> Result<(), LcpError> {
    let x = [[0.2, 0.2, 0.1], [0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]].map(Point::from);
    let target = [x[0] - 0.3 * Vector::z(), x[1], x[2], x[3]];
    let (kind, vertices, delta) = (PairKind::VertexTriangle, [0, 1, 2, 3], 0.01);
    let separation = separation::separate(kind, &x);
    assert!(predicted_gap(kind, &vertices, &separation, &x, &target) < 0.0, "the target is through");

    for form in [ContactForm::Gap, ContactForm::Volume] {
        let weights = [1.0; 4];
        let mut rows = [contact_row(form, kind, vertices, &x, &separation, delta)];
        prepare_rows(&mut rows, &weights)?;
        let problem = LcpProblem::of_rows(&weights, &rows)?;
        let mut y = target.map(|p| p.coords);
        let mut lambda = [0.0];
        let mut state =
            LcpState { y: &mut y, lambda: &mut lambda, limit_multipliers: &mut [], friction: &mut [] };
        let params = LcpParams { tolerance: Some(1e-12), max_sweeps: 100, ..LcpParams::default() };
        solve_serial(&problem, &mut state, &params)?;
        let after = y.map(Point::from);
        let gap = predicted_gap(kind, &vertices, &separation, &x, &after);
        println!("{form:?}: gap {gap:.6} m, multiplier {:.4}", lambda[0]);
        assert!(lambda[0] > 0.0);
        assert!(gap > 0.0, "the modified target no longer goes through");
    }
    Ok(())
}

#[test]
fn runs() {
    main().unwrap();
}
