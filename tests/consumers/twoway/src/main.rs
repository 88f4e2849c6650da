//! Two triangles whose targets swap them: they end close to each other, in the same order.
#![allow(clippy::print_stdout, reason = "a command")]

use bowknot_twoway::geometry::{Point, Topology, Vector};
use bowknot_twoway::proximity::CollisionModel;
use bowknot_twoway::{AcceptedState, Params, ResolveInput, Resolver};
use std::error::Error;
use std::ops::ControlFlow;

fn main() -> Result<(), Box<dyn Error>> {
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let at = |z: f64| corners.map(|p| Point::from(p) + z * Vector::z());
    let mut x = [at(0.0), at(0.1)].concat();
    let y = [at(0.1), at(0.0)].concat();

    let topology = Topology::builder(6).triangles([[0, 1, 2], [3, 4, 5]]).build()?;
    let mut resolver = Resolver::new(CollisionModel::single_body(topology), &x, &[1.0; 6], Params::fast())?;
    let mut seen = 0;
    let mut observer = |state: &AcceptedState<'_>| {
        seen += 1;
        assert!((0..3).all(|i| state.positions[i].z < state.positions[i + 3].z), "in order after every step");
        ControlFlow::Continue(())
    };
    let report = resolver.resolve_with(&mut x, &y, &ResolveInput::default(), &mut observer)?;
    println!("{} steps, gap {:?} m", report.steps, report.min_gap_m);
    assert_eq!(seen, report.steps);
    assert!(report.min_gap_m.is_some_and(|gap| gap > 0.0));
    Ok(())
}

#[test]
fn runs() {
    main().unwrap();
}
