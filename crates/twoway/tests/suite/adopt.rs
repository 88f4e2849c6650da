#![allow(clippy::unwrap_used)] // helpers of tests are outside the functions that the lint knows as tests

use crate::common::sheet;
use bowknot_geometry::{HalfSpace, PairKind, Point, Topology, Vector};
use bowknot_proximity::{BodyFilter, CollisionModel, Pair, PairList};
use bowknot_twoway::{
    CallEnd, CallInput, ContactSet, PairMultipliers, Params, ResolveInput, Resolver, Statistics,
};

/// All pairs of elements that may collide, far ones as well.
fn all_pairs(model: &CollisionModel) -> PairList {
    let topology = model.topology();
    let body = |v: u32| model.vertex_body()[v as usize];
    let (vertices, edges) = (topology.vertex_count as u32, topology.edges.len() as u32);
    let mut kinds: [Vec<Pair>; 5] = Default::default();
    let mut add = |kind: PairKind, elements: [u32; 2]| {
        let pair = Pair::of_elements(topology, kind, elements);
        if kind == PairKind::VertexHalfSpace || body(pair.vertices[0]) != body(pair.vertices[kind.side_a()]) {
            kinds[kind as usize].push(pair);
        }
    };
    for v in 0..vertices {
        (0..topology.triangles.len() as u32).for_each(|t| add(PairKind::VertexTriangle, [v, t]));
        add(PairKind::VertexHalfSpace, [v, 0]);
    }
    (0..edges).for_each(|a| (a + 1..edges).for_each(|b| add(PairKind::EdgeEdge, [a, b])));
    PairList::from_kinds(kinds)
}

/// The pairs and all numbers: what is printed of two of them differs if a bit does.
fn described(contacts: &ContactSet) -> String {
    format!("{contacts:?}")
}

/// Whoever knows the pairs in range, whatever others it names, gets what a search finds.
#[test]
fn pairs_that_are_known_need_no_search() {
    let (mut x, mut triangles, mut bodies) = (Vec::new(), Vec::new(), Vec::new());
    for (body, height) in [0.008, 0.02].into_iter().enumerate() {
        sheet(4, 0.1, height, &mut x, &mut triangles);
        bodies.resize(x.len(), body as u32);
    }
    let topology = Topology::builder(x.len()).triangles(triangles).build().unwrap();
    let filters = vec![BodyFilter { self_collision: false, ..BodyFilter::DEFORMABLE }; 2];
    let ground = HalfSpace::new(Point::origin(), Vector::z()).unwrap();
    let model = CollisionModel::new(topology, bodies, filters, vec![ground]).unwrap();
    let near = all_pairs(&model);
    let params = Params::fast();
    let mut resolver = Resolver::new(model, &x, &vec![1.0; x.len()], params).unwrap();
    let target: Vec<Point> = x.iter().map(|x| x - 0.02 * Vector::z()).collect();
    let input = ResolveInput { time_step: Some(0.01), ..ResolveInput::default() };
    let mut end = x.clone();
    resolver.resolve_with(&mut end, &target, &input, &mut ()).unwrap();
    let state = resolver.state().clone();
    let pressing = (0..state.contacts.pairs.len()).filter(|&p| state.contacts.multipliers[p] > 0.0);
    let carried = pressing.map(|p| PairMultipliers {
        kind: state.contacts.pairs.kind(p),
        elements: state.contacts.pairs.pairs()[p].elements,
        normal: state.contacts.multipliers[p],
        friction: Vector::zeros(),
    });
    let contacts: Vec<PairMultipliers> = carried.collect();
    let mut adopt = |near: Option<&PairList>, carried: &[PairMultipliers]| {
        let input = ResolveInput { carried, ..input };
        let call = CallInput::new(resolver.scene(), &x, &target, &input).unwrap();
        let call_end = CallEnd {
            start: &x,
            positions: &end,
            target: &target,
            aims: &state.y,
            contacts: &contacts,
            near,
        };
        let mut statistics = Statistics::default();
        resolver.adopt(&call_end, call, &mut statistics).unwrap();
        (described(&resolver.state().contacts), statistics.min_gap_m, statistics.injected_j)
    };
    let (searched, known) = (adopt(None, &[]), adopt(Some(&near), &[]));
    assert!(searched == known);
    // Only these: nothing is searched for.
    let (empty, gap, _) = adopt(Some(&PairList::default()), &[]);
    assert!(gap.is_none() && empty != searched.0);
    // A search after it finds all again.
    assert!(adopt(None, &[]) == searched);
    // What pairs carried at the start of the call is no more.
    let all = (0..state.contacts.pairs.len()).map(|p| PairMultipliers {
        kind: state.contacts.pairs.kind(p),
        elements: state.contacts.pairs.pairs()[p].elements,
        normal: 1.0,
        friction: Vector::zeros(),
    });
    let mut all: Vec<PairMultipliers> = all.collect();
    all.sort_unstable_by_key(|pair| (pair.kind, pair.elements));
    assert!(adopt(None, &all) == searched);
    assert!(state.contacts.pairs.len() > 50 && !contacts.is_empty(), "{}", state.contacts.pairs.len());
    assert!(near.len() > 4 * state.contacts.pairs.len(), "{}", near.len());
}
