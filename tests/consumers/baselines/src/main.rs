//! Two triangles whose targets swap them, by a method made of the default stages: they end up close, and
//! still in order.
#![allow(clippy::print_stdout, reason = "a command")]

use bowknot_baselines::twoway::geometry::{Point, Topology, Vector};
use bowknot_baselines::twoway::proximity::CollisionModel;
use bowknot_baselines::twoway::{Params, ResolveInput, Resolver};
use bowknot_baselines::{Composed, Method};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let at = |z: f64| corners.map(|p| Point::from(p) + z * Vector::z());
    let mut x = [at(0.0), at(0.1)].concat();
    let y = [at(0.1), at(0.0)].concat();

    let topology = Topology::builder(6).triangles([[0, 1, 2], [3, 4, 5]]).build()?;
    let resolver = Resolver::new(CollisionModel::single_body(topology), &x, &[1.0; 6], Params::fast())?;
    let mut method = Composed::new("two-way", resolver);
    let outcome = method.solve(&mut x, &y, &ResolveInput::default())?;
    println!("{}: {} steps", method.name(), outcome.steps);
    assert!(outcome.converged);
    assert!((0..3).all(|i| x[i].z < x[i + 3].z));
    Ok(())
}

#[test]
fn runs() {
    main().unwrap();
}
