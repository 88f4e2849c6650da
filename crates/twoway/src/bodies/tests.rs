use super::*;
use bowknot_geometry::{HalfSpace, Point, Topology, Vector};
use bowknot_proximity::BodyFilter;

fn table() -> ContactTable {
    let topology = Topology::builder(2).particles([0, 1]).build().expect("two particles");
    let ground = HalfSpace::new(Point::origin(), Vector::z()).expect("a plane");
    let filters = vec![BodyFilter::DEFORMABLE; 2];
    let model = CollisionModel::new(topology, vec![0, 1], filters, vec![ground]).expect("a model");
    ContactTable::new(&model)
}

#[test]
fn friction_is_the_geometric_mean_unless_the_pair_has_its_own() {
    let mut table = table();
    assert!(!table.frictional());
    let bodies = [0.9, 0.4].map(|friction| BodyContact { friction, ..BodyContact::default() });
    table.set_bodies(bodies.to_vec()).expect("fine");
    let (a, b, ground) = (ContactSide::Body(0), ContactSide::Body(1), ContactSide::HalfSpace(0));
    assert!((table.friction(a, b) - 0.6).abs() < 1e-15);
    assert_eq!(table.friction(a, ground), 0.0);
    table.set_half_spaces(vec![HalfSpaceContact { friction: 0.1, thickness: None }]).expect("fine");
    assert!((table.friction(ground, b) - 0.2).abs() < 1e-15);
    let own = PairFriction { sides: [b, a], friction: 0.05 };
    table.set_pairs(&[own, PairFriction { sides: [ground, a], friction: 0.7 }]).expect("fine");
    assert_eq!((table.friction(a, b), table.friction(b, a)), (0.05, 0.05));
    assert_eq!(table.friction(a, ground), 0.7);
    assert!((table.friction(a, a) - 0.9).abs() < 1e-15);
}

#[test]
fn every_error_is_reported_and_the_table_is_unchanged() {
    let mut table = table();
    let before = table.clone();
    let bad =
        BodyContact { thickness: Some(-1.0), delta: Some(0.0), friction: f64::NAN, stretch_limit: Some(1.0) };
    let Err(ResolveError::Contact(errors)) = table.set_bodies(vec![bad]) else { panic!("accepted") };
    assert_eq!(errors.len(), 5, "{errors}");
    let pair = PairFriction { sides: [ContactSide::Body(7), ContactSide::HalfSpace(1)], friction: -0.1 };
    let Err(ResolveError::Contact(errors)) = table.set_pairs(&[pair, pair]) else { panic!("accepted") };
    assert_eq!(errors.len(), 7, "{errors}");
    let bad = HalfSpaceContact { thickness: Some(f64::INFINITY), friction: -1.0 };
    let Err(ResolveError::Contact(errors)) = table.set_half_spaces(vec![bad]) else { panic!("accepted") };
    assert_eq!(errors.len(), 2, "{errors}");
    assert_eq!(table, before);
}
