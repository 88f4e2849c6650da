use super::*;
use bowknot_geometry::{HalfSpace, Point, Topology, Vector};
use bowknot_proximity::BodyFilter;

fn table(
    bodies: &[BodyContact],
    half_spaces: &[HalfSpaceContact],
    pairs: &[PairFriction],
) -> Result<ContactTable, ResolveError> {
    let topology = Topology::builder(2).particles([0, 1]).build().expect("two particles");
    let ground = HalfSpace::new(Point::origin(), Vector::z()).expect("a plane");
    let filters = vec![BodyFilter::DEFORMABLE; 2];
    let model = CollisionModel::new(topology, vec![0, 1], filters, vec![ground]).expect("a model");
    let data =
        ContactData { bodies: bodies.to_vec(), half_spaces: half_spaces.to_vec(), pairs: pairs.to_vec() };
    ContactTable::new(&model, data)
}

#[test]
fn friction_is_the_geometric_mean_unless_the_pair_has_its_own() {
    assert!(!table(&[], &[], &[]).expect("fine").frictional());
    let bodies = [0.9, 0.4].map(|friction| BodyContact { friction, ..BodyContact::default() });
    let (a, b, ground) = (ContactSide::Body(0), ContactSide::Body(1), ContactSide::HalfSpace(0));
    let smooth = table(&bodies, &[], &[]).expect("fine");
    assert!((smooth.friction(a, b) - 0.6).abs() < 1e-15);
    assert_eq!(smooth.friction(a, ground), 0.0);
    let planes = [HalfSpaceContact { friction: 0.1, thickness: None }];
    let rough = table(&bodies, &planes, &[]).expect("fine");
    assert!((rough.friction(ground, b) - 0.2).abs() < 1e-15);
    let own = PairFriction { sides: [b, a], friction: 0.05 };
    let pairs = [own, PairFriction { sides: [ground, a], friction: 0.7 }];
    let table = table(&bodies, &planes, &pairs).expect("fine");
    assert_eq!((table.friction(a, b), table.friction(b, a)), (0.05, 0.05));
    assert_eq!(table.friction(a, ground), 0.7);
    assert!((table.friction(a, a) - 0.9).abs() < 1e-15);
}

#[test]
fn every_error_is_reported() {
    let bad =
        BodyContact { thickness: Some(-1.0), delta: Some(0.0), friction: f64::NAN, stretch_limit: Some(1.0) };
    let plane = HalfSpaceContact { thickness: Some(f64::INFINITY), friction: -1.0 };
    let pair = PairFriction { sides: [ContactSide::Body(7), ContactSide::HalfSpace(1)], friction: -0.1 };
    for (bodies, planes, pairs, count) in
        [(&[bad][..], &[][..], &[][..], 5), (&[], &[plane], &[], 2), (&[], &[], &[pair, pair], 7)]
    {
        let Err(ResolveError::Contact(errors)) = table(bodies, planes, pairs) else { panic!("accepted") };
        assert_eq!(errors.len(), count, "{errors}");
    }
    let Err(ResolveError::Contact(errors)) = table(&[bad], &[plane], &[pair, pair]) else {
        panic!("accepted")
    };
    assert!(errors.len() > 10, "all at once: {errors}");
}
