//! The same bits for any number of threads, and whatever was searched before.

use crate::scenes::folded::folded_cloth;
use crate::scenes::{Builder, Random};
use bowknot_proximity::{BodyFilter, ProximitySearch};

#[test]
fn threads_do_not_change_a_bit() {
    let (positions, triangles) = folded_cloth(3000, 0.004);
    let mut builder = Builder::default();
    builder.body(BodyFilter::DEFORMABLE).mesh(&positions, &triangles, 0.003);
    builder.soup(&mut Random::new(1), [0, 100, 300], 0.2, 0.01);
    builder.body(BodyFilter::OBSTACLE).soup(&mut Random::new(2), [200, 0, 0], 0.2, 0.01);
    let scene = builder.build();
    let results = [1, 2, 3].map(|threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| {
            let mut search = ProximitySearch::new(&scene.model);
            let (pairs, separations) = scene.search_with(&mut search);
            let bits: Vec<[u64; 9]> = separations
                .iter()
                .map(|s| {
                    let [w0, w1, w2, w3] = s.weights;
                    [s.normal.x, s.normal.y, s.normal.z, w0, w1, w2, w3, s.distance, s.width]
                        .map(f64::to_bits)
                })
                .collect();
            (pairs, bits, search.statistics())
        })
    });
    assert!(results[0].0.len() > 10_000);
    assert!(results[0] == results[1] && results[0] == results[2]);
}

#[test]
fn an_old_list_is_matched_with_a_new_one() {
    let (positions, triangles) = folded_cloth(500, 0.004);
    let mut builder = Builder::default();
    builder.body(BodyFilter::DEFORMABLE).mesh(&positions, &triangles, 0.003);
    let mut scene = builder.build();
    let (old, _) = scene.search();
    let mut random = Random::new(3);
    scene.positions.iter_mut().for_each(|p| *p += random.vector(0.002));
    let (new, _) = scene.search();
    let mut matches = Vec::new();
    new.match_with(&old, &mut matches);
    assert_eq!(matches.len(), new.len());
    let mut both = 0;
    for (i, pair) in new.pairs().iter().enumerate() {
        let same = |j: usize| old.kind(j) == new.kind(i) && old.pairs()[j].elements == pair.elements;
        if matches[i] == u32::MAX {
            assert!(!(0..old.len()).any(same));
        } else {
            assert!(same(matches[i] as usize));
            both += 1;
        }
    }
    assert!(both > 0 && both < new.len() && both < old.len());
}
