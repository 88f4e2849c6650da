//! Input that is refused, each with the fault that it names.
#![allow(clippy::unwrap_used)] // helpers outside the test functions

use bowknot_lcp::*;
use nalgebra::Vector2;

fn row(vertices: [u32; 4], weights: &[f64]) -> Row {
    let mut row = Row::new(vertices, [Vector::x(), Vector::y(), Vector::zeros(), Vector::zeros()], 0.0);
    row.prepare(weights).unwrap();
    row
}

fn friction(normal: u32) -> FrictionRow {
    FrictionRow {
        tangents: [Vector::x(), Vector::y()],
        coefficients: [1.0, -1.0, 0.0, 0.0],
        offsets: [0.0; 2],
        vertices: [0, 1, 0, 0],
        friction: 0.5,
        inverse_diagonal: 0.5,
        normal,
    }
}

/// The error of a problem with these rows only.
fn new(weights: &[f64], rows: ConstraintSet<'_, Row>) -> Result<(), LcpError> {
    LcpProblem::new(weights, rows, ConstraintSet::default(), ConstraintSet::default()).map(|_| ())
}

#[test]
fn problems_with_faults_are_refused() {
    let weights = [1.0, 0.0, 2.0];
    let good = [row([0, 1, 0, 0], &weights), row([1, 2, 1, 1], &weights)];
    assert_eq!(new(&weights, ConstraintSet::serial(&good)), Ok(()));

    for value in [-1.0, f64::INFINITY, f64::NAN] {
        let bad = [1.0, 1.0, value];
        let Err(LcpError::Weight { node: 2, .. }) = new(&bad, ConstraintSet::serial(&good)) else {
            panic!("weight {value} must be refused")
        };
    }
    let unknown = |constraint, index, node| Err(LcpError::UnknownNode { constraint, index, node, nodes: 3 });
    let mut bad = good;
    bad[1].vertices[3] = 3;
    assert_eq!(new(&weights, ConstraintSet::serial(&bad)), unknown("row", 1, 3));
    assert_eq!(prepare_rows(&mut bad, &weights), unknown("row", 1, 3));
    let mut many = vec![good[0]; 3000];
    many[2500].vertices[0] = 7;
    assert_eq!(prepare_rows(&mut many, &weights), unknown("row", 2500, 7));
    let limits = [DistanceLimit { vertices: [0, 9], limit: 1.0 }];
    let result = LcpProblem::new(
        &weights,
        ConstraintSet::serial(&good),
        ConstraintSet::serial(&limits),
        ConstraintSet::default(),
    );
    assert_eq!(result.map(|_| ()), unknown("distance limit", 0, 9));

    let unprepared = [Row::new([0; 4], [Vector::x(); 4], 0.0)];
    let result = new(&weights, ConstraintSet::serial(&unprepared));
    assert_eq!(result, Err(LcpError::NotPrepared { constraint: "row", index: 0 }));
    let rubbing = [friction(0), friction(2)];
    let result = LcpProblem::new(
        &weights,
        ConstraintSet::serial(&good),
        ConstraintSet::default(),
        ConstraintSet::serial(&rubbing),
    );
    assert_eq!(result.map(|_| ()), Err(LcpError::UnknownNormal { index: 1, normal: 2, rows: 2 }));

    for starts in [&[0, 1][..], &[1, 2], &[0, 2, 1, 2], &[0, 3], &[0]] {
        let result = new(&weights, ConstraintSet::new(&good, Schedule::colored(starts)));
        assert_eq!(result, Err(LcpError::Starts { constraint: "row", expected: 2 }), "{starts:?}");
    }
    let result = new(&weights, ConstraintSet::new(&good, Schedule::active(&[0, 2], &[0, 2])));
    assert_eq!(result, Err(LcpError::Order { constraint: "row", index: 2, count: 2 }));
    let result = new(&weights, ConstraintSet::new(&good, Schedule::active(&[1], &[0, 2])));
    assert_eq!(result, Err(LcpError::Starts { constraint: "row", expected: 1 }));
}

#[test]
fn states_and_parameters_that_do_not_fit_are_refused() {
    let weights = [1.0; 2];
    let rows = [row([0, 1, 0, 0], &weights)];
    let problem = LcpProblem::of_rows(&weights, &rows).unwrap();
    let params = LcpParams::default();
    let mut y = [Vector::zeros(); 2];
    let fault = |state: &mut LcpState<'_>, params: &LcpParams| {
        let fault = solve_serial(&problem, state, params).unwrap_err();
        // As text, since NaN is unequal to itself.
        assert_eq!(sweep_colored(&problem, state, params).unwrap_err().to_string(), fault.to_string());
        assert_eq!(Jacobi::new().solve(&problem, state, params).unwrap_err().to_string(), fault.to_string());
        fault
    };
    let mut state = LcpState { y: &mut y[..1], ..LcpState::default() };
    assert_eq!(fault(&mut state, &params), LcpError::Length { what: "y", given: 1, expected: 2 });
    let mut state = LcpState { y: &mut y, ..LcpState::default() };
    assert_eq!(fault(&mut state, &params), LcpError::Length { what: "lambda", given: 0, expected: 1 });
    let mut slips = [Vector2::zeros()];
    let mut state = LcpState { y: &mut y, lambda: &mut [0.0], friction: &mut slips, ..LcpState::default() };
    assert_eq!(fault(&mut state, &params), LcpError::Length { what: "friction", given: 1, expected: 0 });
    for params in [
        LcpParams { relaxation: 0.0, ..params },
        LcpParams { relaxation: 2.0, ..params },
        LcpParams { relaxation: f64::NAN, ..params },
        LcpParams { spectral_radius: 1.0, ..params },
        LcpParams { tolerance: Some(f64::NAN), ..params },
    ] {
        assert!(matches!(fault(&mut state, &params), LcpError::Parameters(_)), "{params:?}");
    }
}

#[test]
fn colors_that_share_a_moving_node_are_refused() {
    let weights = [1.0, 0.0, 2.0, 1.0];
    // Node 1 cannot move, so rows 0 and 1 may share it; rows 1 and 2 share node 2.
    let rows = [row([0, 1, 0, 0], &weights), row([1, 2, 1, 1], &weights), row([2, 3, 2, 2], &weights)];
    let judge = |order: &[u32], starts: &[u32]| {
        let rows = ConstraintSet::new(&rows, Schedule::active(order, starts));
        validate_colors(
            &LcpProblem::new(&weights, rows, ConstraintSet::default(), ConstraintSet::default()).unwrap(),
        )
    };
    assert_eq!(judge(&[0, 1, 2], &[0, 2, 3]), Ok(()));
    assert_eq!(judge(&[2, 0, 1], &[0, 2, 3]), Ok(()));
    let clash = LcpError::Color { constraint: "row", color: 1, first: 1, second: 2, node: 2 };
    assert_eq!(judge(&[0, 1, 2], &[0, 1, 3]), Err(clash));
    let clash = LcpError::Color { constraint: "row", color: 0, first: 0, second: 0, node: 0 };
    assert_eq!(judge(&[0, 0], &[0, 2]), Err(clash));
    // Without colors rows are swept one after the other, so there is no clash.
    assert_eq!(judge(&[0, 1, 2], &[]), Ok(()));
    let limits =
        [DistanceLimit { vertices: [0, 2], limit: 1.0 }, DistanceLimit { vertices: [2, 3], limit: 1.0 }];
    let limits = ConstraintSet::new(&limits, Schedule::colored(&[0, 2]));
    let problem =
        LcpProblem::new(&weights, ConstraintSet::default(), limits, ConstraintSet::default()).unwrap();
    assert!(matches!(
        validate_colors(&problem),
        Err(LcpError::Color { constraint: "distance limit", node: 2, .. })
    ));
}

#[test]
fn dense_input_with_faults_is_refused() {
    use nalgebra::DMatrix;
    let one = DMatrix::from_element(1, 1, 1.0);
    assert!(matches!(solve_dense(&one, &[0.0, 0.0], &[1.0, 1.0]), Err(LcpError::Length { .. })));
    assert!(matches!(solve_dense(&one, &[f64::NAN], &[1.0]), Err(LcpError::NotFinite { index: 0, .. })));
    assert!(matches!(solve_dense(&one, &[-1.0], &[f64::NAN]), Err(LcpError::NotFinite { index: 0, .. })));
    let bad = DMatrix::from_element(1, 1, f64::INFINITY);
    assert!(matches!(solve_dense(&bad, &[-1.0], &[1.0]), Err(LcpError::NotFinite { index: 0, .. })));
    let (lambda, _) = solve_dense(&DMatrix::zeros(0, 0), &[], &[]).unwrap();
    assert!(lambda.is_empty());
}
