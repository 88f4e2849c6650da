//! A search that is given another model, or one whose filters have changed, loses no pair.

use crate::scenes::{Builder, Random, Scene};
use bowknot_geometry::Vector;
use bowknot_proximity::{BodyFilter, CandidateList, PairList, ProximitySearch};

/// 96 vertices in two bodies. With `shift`, other triangles and strands join them, and the second body, an
/// obstacle, has other vertices.
fn scene(shift: usize) -> Scene {
    let mut random = Random::new(20 + shift as u64);
    let mut builder = Builder::default();
    builder.body(BodyFilter::DEFORMABLE).soup(&mut random, [16 - 2 * shift, shift, 6], 0.3, 0.1);
    builder.body(BodyFilter::OBSTACLE).soup(&mut random, [14 + shift, 0, 0], 0.3, 0.1);
    builder.build()
}

#[test]
fn another_model_of_equal_size_is_searched_anew() {
    let scenes = [scene(0), scene(4)];
    assert_eq!(scenes[0].positions.len(), scenes[1].positions.len());
    let mut search = ProximitySearch::new(&scenes[0].model);
    let mut list = CandidateList::default();
    let unchanged = vec![false; scenes[0].positions.len()];
    for (round, scene) in scenes.iter().cycle().take(6).enumerate() {
        let (pairs, separations) = scene.search_with(&mut search);
        assert!(pairs.len() > 100, "{}", pairs.len());
        assert!((pairs.clone(), separations) == scene.search(), "round {round}");

        search.update(&scene.model, &scene.positions, &scene.radii, Some(&unchanged), &mut list);
        let half_spaces = pairs.range(bowknot_geometry::PairKind::VertexHalfSpace).len();
        assert_eq!(list.len(), pairs.len() - half_spaces, "round {round}");

        let still = vec![Vector::zeros(); unchanged.len()];
        let swept = |search: &mut ProximitySearch| {
            let (mut pairs, mut separations) = (PairList::default(), Vec::new());
            let Scene { model, positions, radii } = scene;
            search.search_swept(model, positions, &still, radii, &mut pairs, &mut separations);
            pairs
        };
        let other = &scenes[1 - round % 2];
        other.search_with(&mut search);
        assert!(swept(&mut search) == swept(&mut ProximitySearch::new(&scene.model)), "round {round}");
        other.search_with(&mut search);
    }
}

#[test]
fn a_search_of_no_model_takes_the_one_that_it_is_given() {
    let scene = scene(0);
    assert!(scene.search_with(&mut ProximitySearch::default()) == scene.search());
}

#[test]
fn changed_filters_are_seen() {
    let mut scene = scene(0);
    let filters = scene.model.bodies().to_vec();
    let mut search = ProximitySearch::new(&scene.model);
    let all = scene.search_with(&mut search);
    let absent: Vec<BodyFilter> = filters.iter().map(|filter| filter.absent()).collect();
    scene.model.set_filters(&absent, &[]);
    assert!(scene.search_with(&mut search).0.is_empty());
    scene.model.set_filters(&filters, &[]);
    assert!(scene.search_with(&mut search) == all);
    scene.model.set_filters(&[BodyFilter::DEFORMABLE; 2], &[]);
    let more = scene.search_with(&mut search);
    assert!(more.0.len() > all.0.len() && more == scene.search());
}
