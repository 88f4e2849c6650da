//! The swept search against moments of the motion.

use crate::scenes::{Builder, Random, Scene};
use bowknot_geometry::{HalfSpace, PairKind, Point, Vector};
use bowknot_proximity::{BodyFilter, Pair, PairList, ProximitySearch};
use std::collections::HashSet;

const MOMENTS: usize = 64;

fn sweep(scene: &Scene, displacements: &[Vector], search: &mut ProximitySearch) -> PairList {
    let (mut pairs, mut separations) = (PairList::default(), Vec::new());
    search.search_swept(
        &scene.model,
        &scene.positions,
        displacements,
        &scene.radii,
        &mut pairs,
        &mut separations,
    );
    assert_eq!(pairs.len(), separations.len());
    pairs
}

fn keys(pairs: &PairList) -> HashSet<(PairKind, Pair)> {
    pairs.pairs().iter().enumerate().map(|(i, p)| (pairs.kind(i), *p)).collect()
}

/// Corners of the inflated box of some vertices at a moment, moving linearly from start to end.
fn moving_box(scene: &Scene, displacements: &[Vector], vertices: &[u32], time: f64) -> [Point; 2] {
    let radius = vertices.iter().map(|&v| scene.radii[v as usize]).fold(0.0, f64::max);
    let bounds = |time: f64| {
        let at = |v: &u32| scene.positions[*v as usize] + time * displacements[*v as usize];
        let first = at(&vertices[0]);
        vertices.iter().map(at).fold([first, first], |[low, high], p| [low.inf(&p), high.sup(&p)])
    };
    let ([low0, high0], [low1, high1]) = (bounds(0.0), bounds(1.0));
    let inflate = Vector::repeat(radius);
    [low0 + time * (low1 - low0) - inflate, high0 + time * (high1 - high0) + inflate]
}

/// Every pair whose moving boxes overlap at a sampled moment must be listed. The boxes of a listed pair must
/// overlap, up to rounding, at a moment or between two moments.
fn check(scene: &Scene, displacements: &[Vector], listed: &PairList) -> usize {
    let listed = keys(listed);
    let all = scene.all_pairs();
    for (kind, pair) in &all {
        let (a, b) = pair.vertices[..kind.vertex_count()].split_at(kind.side_a());
        let slack_of_step = 2.0
            * pair.vertices.iter().map(|&v| displacements[v as usize].norm()).fold(0.0, f64::max)
            / MOMENTS as f64;
        let mut meet = false;
        let mut nearly = false;
        for moment in 0..=MOMENTS {
            let time = moment as f64 / MOMENTS as f64;
            let [low, high] = moving_box(scene, displacements, a, time);
            let gap = if *kind == PairKind::VertexHalfSpace {
                let v = a[0] as usize;
                let place = scene.positions[v] + time * displacements[v];
                scene.model.half_spaces()[pair.elements[1] as usize].signed_distance(&place)
                    - 2.0 * scene.radii[v]
            } else {
                let [other_low, other_high] = moving_box(scene, displacements, b, time);
                (low - other_high).sup(&(other_low - high)).max()
            };
            meet |= gap <= -1e-12;
            nearly |= gap <= slack_of_step + 1e-6;
        }
        let present = listed.contains(&(*kind, *pair));
        assert!(present || !meet, "{kind:?} {pair:?} meets but is missing");
        assert!(!present || nearly, "{kind:?} {pair:?} never comes near but is listed");
    }
    assert!(listed.len() < all.len());
    listed.len()
}

fn soup(random: &mut Random) -> Scene {
    let mut builder = Builder::default();
    builder.body(BodyFilter::DEFORMABLE).soup(random, [40, 20, 30], 1.0, 0.01);
    builder.body(BodyFilter::OBSTACLE).soup(random, [20, 10, 10], 1.0, 0.0);
    builder.body(BodyFilter::DEFORMABLE).soup(random, [20, 10, 10], 1.0, 0.01);
    builder.half_space(HalfSpace::new(Point::new(0.0, 0.0, -0.8), Vector::z()).expect("a normal"));
    builder.build()
}

#[test]
fn pairs_that_meet_on_the_way_are_listed() {
    let mut random = Random::new(1);
    for (common, own) in [(0.0, 0.02), (0.3, 0.3), (5.0, 0.1)] {
        let scene = soup(&mut random);
        let along = [random.vector(common), Vector::zeros(), random.vector(common)];
        let displacements: Vec<Vector> =
            scene.model.vertex_body().iter().map(|&b| along[b as usize] + random.vector(own)).collect();
        let mut search = ProximitySearch::new(&scene.model);
        let pairs = sweep(&scene, &displacements, &mut search);
        assert!(check(&scene, &displacements, &pairs) > 100);
    }
}

#[test]
fn a_common_motion_adds_nothing() {
    // The hulls of the paths of all bodies overlap, but nothing comes nearer at the same path time.
    let mut random = Random::new(2);
    let scene = soup(&mut random);
    let mut search = ProximitySearch::new(&scene.model);
    let still = sweep(&scene, &vec![Vector::zeros(); scene.positions.len()], &mut search);
    let moving = sweep(&scene, &vec![Vector::new(0.75, 0.5, 0.25); scene.positions.len()], &mut search);
    // The half-space stays where it is and is left behind or stays as near as at the start. Boxes that touch
    // to rounding may differ.
    let (still, moving) = (keys(&still), keys(&moving));
    assert!(still.symmetric_difference(&moving).count() * 1000 < still.len());
}

#[test]
fn swept_and_plain_searches_share_trees() {
    let mut random = Random::new(3);
    let mut scene = soup(&mut random);
    let mut kept = ProximitySearch::new(&scene.model);
    for step in 0..30 {
        let displacements: Vec<Vector> = (0..scene.positions.len())
            .map(|v| {
                if scene.model.is_obstacle(v as u32) && step % 7 != 0 {
                    Vector::zeros()
                } else {
                    random.vector(0.2)
                }
            })
            .collect();
        let swept = sweep(&scene, &displacements, &mut kept);
        assert!(swept == sweep(&scene, &displacements, &mut ProximitySearch::new(&scene.model)));
        assert!(scene.search_with(&mut kept) == scene.search());
        for (p, u) in scene.positions.iter_mut().zip(&displacements) {
            *p += 0.5 * u;
        }
    }
}

#[test]
fn a_bullet_is_seen_wherever_it_passes() {
    // A particle crosses a triangle far from both ends of its path.
    let mut builder = Builder::default();
    builder.body(BodyFilter::DEFORMABLE);
    builder.triangle([Point::origin(), Point::new(1.0, 0.0, 0.0), Point::new(0.0, 1.0, 0.0)], 0.0);
    builder.particle(Point::new(0.25, 0.25, 100.0), 0.0);
    let scene = builder.build();
    let mut displacements = vec![Vector::zeros(); 4];
    displacements[3].z = -300.0;
    let pairs = sweep(&scene, &displacements, &mut ProximitySearch::new(&scene.model));
    assert_eq!(pairs.len(), 1);
    displacements[3].z = -99.0;
    assert!(sweep(&scene, &displacements, &mut ProximitySearch::new(&scene.model)).is_empty());
}

#[test]
fn an_obstacle_that_is_swept_along_the_same_path_again_and_again_never_counts_as_resting() {
    let mut builder = Builder::default();
    builder.body(BodyFilter::DEFORMABLE);
    builder.particle(Point::new(0.25, 0.25, 1.0), 0.0);
    builder.body(BodyFilter::OBSTACLE);
    builder.triangle([Point::origin(), Point::new(1.0, 0.0, 0.0), Point::new(0.0, 1.0, 0.0)], 0.0);
    let scene = builder.build();
    let upward: Vec<Vector> = (0..4)
        .map(|v| if scene.model.is_obstacle(v) { Vector::new(0.0, 0.0, 2.0) } else { Vector::zeros() })
        .collect();
    let mut kept = ProximitySearch::new(&scene.model);
    for search in 0..50 {
        assert_eq!(sweep(&scene, &upward, &mut kept).len(), 1, "search {search}");
    }
}
