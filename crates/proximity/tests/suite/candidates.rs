//! Compact lists: the pairs of a full search, with certified bounds, also where only changes are searched.

use crate::scenes::folded::folded_cloth;
use crate::scenes::{Builder, Random, Scene};
use bowknot_geometry::{PairKind, distance};
use bowknot_proximity::{BodyFilter, CandidateList, Pair, ProximitySearch};

fn scene() -> Scene {
    let (positions, triangles) = folded_cloth(1500, 0.004);
    let mut builder = Builder::default();
    builder.body(BodyFilter::DEFORMABLE).mesh(&positions, &triangles, 0.003);
    builder.soup(&mut Random::new(1), [0, 60, 200], 0.2, 0.01);
    builder.body(BodyFilter::OBSTACLE).soup(&mut Random::new(2), [150, 0, 20], 0.2, 0.01);
    builder.body(BodyFilter::OBSTACLE).soup(&mut Random::new(3), [100, 20, 0], 0.2, 0.01);
    builder.build()
}

/// The listed pairs by kind, in order; checks the bounds.
fn pairs(scene: &Scene, list: &CandidateList) -> Vec<(PairKind, Pair)> {
    let mut all = Vec::new();
    for kind in PairKind::ALL {
        let Some(candidates) = list.of(kind) else { continue };
        for a in candidates.elements() {
            for candidate in candidates.of(a) {
                let elements = [a as u32, candidate.element];
                let pair = Pair::of_elements(scene.model.topology(), kind, elements);
                let exact = distance::closest(kind, &scene.points(&pair)).distance;
                let bound = f64::from(candidate.bound);
                assert!((0.0..=exact + 1e-15).contains(&bound), "{kind:?} {elements:?}: {bound} for {exact}");
                assert!(bound >= 0.5 * exact - 1e-4, "{kind:?} {elements:?}: {bound} for {exact}");
                all.push((kind, pair));
            }
        }
    }
    assert_eq!(all.len(), list.len());
    all
}

/// The pairs of a search of its own.
fn expected(scene: &Scene) -> Vec<(PairKind, Pair)> {
    let (list, _) = scene.search();
    let kinds = PairKind::ALL.into_iter().filter(|kind| *kind != PairKind::VertexHalfSpace);
    kinds.flat_map(|kind| list.pairs()[list.range(kind)].iter().map(move |pair| (kind, *pair))).collect()
}

#[test]
fn a_compact_list_has_the_pairs_of_a_search() {
    let scene = scene();
    let mut list = CandidateList::default();
    ProximitySearch::new(&scene.model).update(&scene.model, &scene.positions, &scene.radii, None, &mut list);
    assert!(list.len() > 5_000);
    assert!(pairs(&scene, &list) == expected(&scene));
    list.clear();
    assert!(list.is_empty());
}

/// Random vertices, now and then all of an obstacle, move or change their radius, and only they are searched.
#[test]
fn changes_give_the_list_of_a_full_search() {
    let mut scene = scene();
    let mut random = Random::new(4);
    let mut search = ProximitySearch::new(&scene.model);
    let mut list = CandidateList::default();
    let mut searched = Vec::new();
    for round in 0..60 {
        let mut changed = vec![false; scene.positions.len()];
        let share = [0.0, 0.002, 0.02, 0.3][round % 4];
        for v in 0..changed.len() {
            let body = scene.model.vertex_body()[v];
            let with_body = round % 7 == 3 && body == 1;
            if with_body || (body == 0 || round % 5 == 0) && random.unit() < share {
                changed[v] = true;
                scene.positions[v] += random.vector(0.004);
                scene.radii[v] *= 0.7 + 0.6 * random.unit();
            }
        }
        // Not all lists of changes are used, and swept searches come between.
        let given = (round % 9 != 8).then_some(changed.as_slice());
        search.update(&scene.model, &scene.positions, &scene.radii, given, &mut list);
        searched.push(search.statistics().candidates);
        assert!(pairs(&scene, &list) == expected(&scene), "round {round}");
        if round % 13 == 12 {
            let still = vec![bowknot_geometry::Vector::zeros(); changed.len()];
            let (mut other, mut geometry) = Default::default();
            let (x, radii) = (&scene.positions, &scene.radii);
            search.search_swept(&scene.model, x, &still, radii, &mut other, &mut geometry);
        }
    }
    // Without a change nothing is tested, and with few changes little.
    assert_eq!(searched[4], 0);
    assert!(10 * searched[1] < searched[0], "{searched:?}");
}

#[test]
fn a_vertex_that_is_not_finite_leaves_the_list_and_comes_back() {
    let mut scene = scene();
    let mut search = ProximitySearch::new(&scene.model);
    let mut list = CandidateList::default();
    search.update(&scene.model, &scene.positions, &scene.radii, None, &mut list);
    let before = pairs(&scene, &list);
    let vertex = before.iter().find(|(kind, _)| *kind == PairKind::VertexTriangle).unwrap().1.vertices[0];
    let mut changed = vec![false; scene.positions.len()];
    changed[vertex as usize] = true;
    let place = std::mem::replace(&mut scene.positions[vertex as usize], [f64::NAN; 3].into());
    search.update(&scene.model, &scene.positions, &scene.radii, Some(&changed), &mut list);
    let without: Vec<_> = before.iter().filter(|(_, p)| !p.vertices.contains(&vertex)).copied().collect();
    assert!(without.len() < before.len() && pairs(&scene, &list) == without);
    scene.positions[vertex as usize] = place;
    search.update(&scene.model, &scene.positions, &scene.radii, Some(&changed), &mut list);
    assert!(pairs(&scene, &list) == before);
}

/// Without a change marked, a list that is not as the last call left it would stay as it is.
#[test]
fn a_list_that_another_call_has_left_is_searched_anew() {
    let mut scene = scene();
    let mut search = ProximitySearch::new(&scene.model);
    let mut list = CandidateList::default();
    search.update(&scene.model, &scene.positions, &scene.radii, None, &mut list);
    let mut copy = list.clone();
    let unchanged = vec![false; scene.positions.len()];
    let still = vec![bowknot_geometry::Vector::zeros(); unchanged.len()];
    scene.radii.iter_mut().for_each(|radius| *radius *= 1.5);
    search.update(&scene.model, &scene.positions, &scene.radii, None, &mut list);
    let expected = expected(&scene);
    let (x, radii) = (&scene.positions, &scene.radii);

    search.update(&scene.model, x, radii, Some(&unchanged), &mut list);
    assert_eq!(search.statistics().candidates, 0, "a list that is kept needs no search");
    let mut others = [copy.clone(), CandidateList::default(), CandidateList::default(), list.clone()];
    ProximitySearch::new(&scene.model).update(&scene.model, x, &small_radii(radii), None, &mut others[1]);
    others[3].clear();
    for other in &mut others {
        search.update(&scene.model, x, radii, Some(&unchanged), other);
        assert!(pairs(&scene, other) == expected);
    }
    search.list_swept(&scene.model, x, &still, &small_radii(radii), &mut copy);
    search.update(&scene.model, x, radii, Some(&unchanged), &mut copy);
    assert!(pairs(&scene, &copy) == expected);
}

/// Radii with which few pairs are listed.
fn small_radii(radii: &[f64]) -> Vec<f64> {
    radii.iter().map(|radius| 0.1 * radius).collect()
}
