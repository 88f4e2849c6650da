//! Stages that are given another scene of equal size than before do what new ones would.

use crate::common::sheet;
use bowknot_geometry::{Point, Topology, Vector};
use bowknot_proximity::CollisionModel;
use bowknot_twoway::{
    BackwardStep, CertifiedForward, LcpBackward, Params, ResolveInput, Resolver, Search, Statistics,
    TrustRegionSearch,
};

/// Two sheets, the upper one of which wants to go through the lower one. `mirrored`: the diagonals of their
/// squares are the other ones. Pairs keep `delta` [m].
fn crossing(mirrored: bool, delta: f64) -> (Resolver, Vec<Point>, Vec<Point>) {
    const CELLS: u32 = 4;
    let (mut x, mut triangles) = (Vec::new(), Vec::new());
    for height in [0.0, 0.005] {
        sheet(CELLS as usize, 0.1, height, &mut x, &mut triangles);
    }
    let side = CELLS + 1;
    let number = |v: u32| if mirrored { v - v % side + CELLS - v % side } else { v };
    let topology = Topology::builder(x.len()).triangles(triangles.iter().map(|t| t.map(number)));
    let model = CollisionModel::single_body(topology.build().expect("sheets"));
    let mut params = Params::fast();
    params.contact.delta = Some(delta);
    let y = x.iter().map(|p| p - 1.7 * p.z * Vector::z()).collect();
    let resolver = Resolver::new(model, &x, &vec![1.0; x.len()], params).expect("a scene");
    (resolver, x, y)
}

#[test]
fn stages_of_another_scene_begin_anew() {
    // Its trust regions hold the whole paths, with less margin than the new scene needs.
    let (mut other, start, y) = crossing(false, 1e-5);
    let mut search = TrustRegionSearch::new(other.scene());
    let mut backward = LcpBackward::new();
    other.detect_contacts(&start, &ResolveInput::default()).expect("a call");
    let mut state = other.state().clone();
    search.begin(other.scene(), &mut state, false);
    search.update(other.scene(), &mut state, &mut Statistics::default());
    backward.begin(other.scene(), &state);

    let (mut fresh, ..) = crossing(true, 0.03);
    let scene = fresh.scene().clone();
    let mut mixed = Resolver::with_stages(scene, search, backward, CertifiedForward::default());
    let (mut expected, mut found) = (start.clone(), start);
    let statistics = fresh.resolve(&mut expected, &y).expect("a call");
    assert!(statistics.contact_rows > 0 && statistics.edge_rows > 0, "{statistics:?}");
    mixed.resolve(&mut found, &y).expect("a call");
    assert!(found == expected);
    assert!(fresh.detect_intersections(&found, 1).is_ok_and(|report| report.is_clear()));
}
