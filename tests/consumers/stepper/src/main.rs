//! A vertex is asked to go 10 km below a triangle; step by step it comes near, and never passes through.
#![allow(clippy::print_stdout, reason = "a command")]

use bowknot_stepper::geometry::{PairKind, Point, Vector, separation};
use bowknot_stepper::proximity::{Pair, PairList};
use bowknot_stepper::{Contacts, Stepper};

fn main() {
    let mut x = [[0.2, 0.2, 0.5], [0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]].map(Point::from);
    let target = [x[0] - 1e4 * Vector::z(), x[1], x[2], x[3]];
    let pair = Pair { elements: [0, 0], vertices: [0, 1, 2, 3] };
    let pairs = PairList::from_kinds([vec![], vec![], vec![pair], vec![], vec![]]);
    let min_separation = 1e-6;

    let mut stepper = Stepper::default();
    stepper.begin(x.len());
    for step in 0..12 {
        let separations = [separation::separate(PairKind::VertexTriangle, &x)];
        let min_separations = [min_separation];
        let contacts =
            Contacts { pairs: &pairs, separations: &separations, min_separations: &min_separations };
        stepper.set_target(&x, &target);
        stepper.limit_by_planes(&contacts, 0.9);
        let report = stepper.advance(&mut x);
        println!("step {step:2}: gap {:.3e} m, moved {:.3e} m", separations[0].width, report.largest_move);
        assert!(x[0].z > 0.0);
    }
    assert!(x[0].z < 2.0 * min_separation, "it has come as near as it may");
}

#[test]
fn runs() {
    main();
}
