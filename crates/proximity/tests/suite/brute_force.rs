//! The search against all pairs, on hard cases.

use crate::scenes::folded::folded_cloth;
use crate::scenes::{Builder, Random, Scene};
use bowknot_geometry::{HalfSpace, Point, Vector};
use bowknot_proximity::{BodyFilter, ProximitySearch};

/// Searches, checks, and expects at least so many pairs: an empty list would prove little.
fn check(scene: &Scene, at_least: usize) {
    let (pairs, separations) = scene.search();
    let found = scene.check(&pairs, &separations);
    assert!(found >= at_least, "only {found} pairs");
}

fn cloth(radius: f64) -> Builder {
    let (positions, triangles) = folded_cloth(500, 0.01);
    let mut builder = Builder::default();
    builder.body(BodyFilter::DEFORMABLE).mesh(&positions, &triangles, radius);
    builder
}

#[test]
fn folded_cloth_lists_neighboring_layers() {
    check(&cloth(0.007).build(), 1000);
}

#[test]
fn touching_radii_list_nothing_beyond() {
    check(&cloth(0.0).build(), 0);
    check(&cloth(1e-9).build(), 0);
}

#[test]
fn radii_that_reach_everywhere_list_everything() {
    let (positions, triangles) = folded_cloth(100, 0.01);
    let mut builder = Builder::default();
    builder.body(BodyFilter::DEFORMABLE).mesh(&positions[..80], &triangles[..80], 1.0);
    let scene = builder.build();
    let (pairs, separations) = scene.search();
    assert_eq!(scene.check(&pairs, &separations), scene.all_pairs().len());
}

#[test]
fn radii_vary_from_vertex_to_vertex() {
    let mut scene = cloth(0.0).build();
    let mut random = Random::new(1);
    scene.radii.iter_mut().for_each(|r| *r = 0.012 * random.unit().powi(3));
    check(&scene, 500);
}

#[test]
fn one_huge_triangle_among_tiny_ones() {
    let mut random = Random::new(2);
    let mut builder = Builder::default();
    builder.body(BodyFilter::DEFORMABLE);
    builder.triangle(
        [Point::new(-30.0, -20.0, 0.01), Point::new(40.0, -20.0, 0.0), Point::new(0.0, 50.0, -0.01)],
        0.001,
    );
    for _ in 0..250 {
        let center = Point::new(random.unit(), random.unit(), 0.05 * (random.unit() - 0.5));
        builder.triangle([0; 3].map(|_| center + random.vector(0.01)), 0.004);
    }
    check(&builder.build(), 200);
}

#[test]
fn everything_in_one_place() {
    let mut random = Random::new(3);
    let mut builder = Builder::default();
    builder.body(BodyFilter::DEFORMABLE);
    for _ in 0..40 {
        builder.triangle([0; 3].map(|_| Point::origin() + random.vector(1.0)), 0.15);
    }
    check(&builder.build(), 1000);
    // Not only close: exactly coincident, so that all boxes and centers are equal.
    let mut builder = Builder::default();
    builder.body(BodyFilter::DEFORMABLE);
    for _ in 0..40 {
        builder
            .triangle([Point::new(0.0, 0.0, 1.0), Point::new(1.0, 0.0, 1.0), Point::new(0.0, 1.0, 1.0)], 0.0);
    }
    let scene = builder.build();
    let (pairs, separations) = scene.search();
    assert_eq!(scene.check(&pairs, &separations), scene.all_pairs().len());
}

#[test]
fn far_from_the_origin_nothing_is_lost() {
    let mut scene = cloth(0.007).build();
    let near = scene.search().0.len();
    for offset in [Vector::new(1e4, -1e4, 1e4), Vector::new(3.0e6, 1.0, 2.0e6)] {
        scene.positions.iter_mut().for_each(|p| *p += offset);
        check(&scene, near * 99 / 100);
        assert!(scene.search().0.len() <= near * 101 / 100);
    }
}

#[test]
fn degenerate_elements_are_searched_too() {
    let mut random = Random::new(4);
    let mut builder = Builder::default();
    builder.body(BodyFilter::DEFORMABLE);
    for _ in 0..40 {
        let (p, along) = (Point::origin() + random.vector(0.2), random.vector(0.2));
        builder.triangle([p, p, p], 0.03);
        builder.triangle([p, p + along, p + 0.3 * along], 0.03);
        builder.triangle([p, p + along, p + 0.5 * along + random.vector(1e-9)], 0.03);
        builder.strand(&[p + random.vector(0.01), p, p], 0.03);
    }
    check(&builder.build(), 1000);
}

#[test]
fn strands_particles_and_triangles_mix() {
    let mut random = Random::new(5);
    for size in [0.3, 1.0] {
        let mut builder = Builder::default();
        builder.body(BodyFilter::DEFORMABLE).soup(&mut random, [60, 60, 150], size, 0.03);
        check(&builder.build(), 50);
    }
}

#[test]
fn only_particles_or_only_strands() {
    let mut random = Random::new(6);
    let mut builder = Builder::default();
    builder.body(BodyFilter::DEFORMABLE).soup(&mut random, [0, 0, 500], 0.3, 0.02);
    check(&builder.build(), 100);
    let mut builder = Builder::default();
    builder.body(BodyFilter::DEFORMABLE).soup(&mut random, [0, 200, 0], 0.3, 0.02);
    check(&builder.build(), 100);
}

#[test]
fn nothing_to_find_is_no_trouble() {
    let mut builder = Builder::default();
    builder.body(BodyFilter::DEFORMABLE);
    check(&builder.build(), 0);
    builder.triangle([Point::origin(), Point::new(1.0, 0.0, 0.0), Point::new(0.0, 1.0, 0.0)], 1.0);
    check(&builder.build(), 0);
    let mut builder = Builder::default();
    builder.body(BodyFilter::OBSTACLE).soup(&mut Random::new(7), [50, 20, 20], 0.1, 0.1);
    check(&builder.build(), 0);
}

/// Deformable bodies, obstacles that move and stay, half-spaces, with and without groups.
fn crowd(random: &mut Random, groups: bool) -> Builder {
    let mut builder = Builder::default();
    for body in 0..8_u32 {
        let obstacle = body % 3 == 1;
        let mut filter = if obstacle { BodyFilter::OBSTACLE } else { BodyFilter::DEFORMABLE };
        if groups {
            filter.groups = 1 << (body % 3);
            filter.mask = [0b111, 0b101, 0b011, 0b110][body as usize % 4];
            filter.self_collision = body % 4 != 2 && !obstacle;
        }
        builder.body(filter).soup(random, [30, 10, 15], 0.4, 0.02);
    }
    builder.half_space(
        HalfSpace::new(Point::new(0.0, 0.0, -0.3), Vector::new(0.1, 0.0, 1.0)).expect("a normal"),
    );
    builder.half_space(
        HalfSpace::new(Point::new(0.35, 0.0, 0.0), Vector::new(-1.0, 0.0, 0.0)).expect("a normal"),
    );
    builder
}

#[test]
fn obstacles_groups_and_half_spaces() {
    let mut random = Random::new(8);
    for groups in [false, true] {
        check(&crowd(&mut random, groups).build(), 500);
    }
}

#[test]
fn radii_at_the_very_distance_are_listed() {
    // Two parallel triangles exactly 0.25 apart, radii that sum to 0.25 exactly.
    let corners = |z: f64| [Point::new(0.0, 0.0, z), Point::new(1.0, 0.0, z), Point::new(0.0, 1.0, z)];
    let mut builder = Builder::default();
    builder.body(BodyFilter::DEFORMABLE).triangle(corners(0.0), 0.125).triangle(corners(0.25), 0.125);
    check(&builder.build(), 10);
}

/// Moves everything, obstacles now and then, and compares a search that is kept with a fresh one.
#[test]
fn trees_are_reused_after_motion() {
    let mut random = Random::new(9);
    let mut scene = crowd(&mut random, true).build();
    let mut kept = ProximitySearch::new(&scene.model);
    let mut drift = Vector::zeros();
    for step in 0..60 {
        let obstacles_move = matches!(step, 5..8 | 30..50);
        drift += random.vector(if step > 40 { 0.5 } else { 0.01 });
        for (v, p) in scene.positions.iter_mut().enumerate() {
            let body = scene.model.vertex_body()[v];
            if !scene.model.is_obstacle(v as u32) {
                *p += random.vector(0.02) + 0.1 * drift;
            } else if obstacles_move && body == 1 {
                p.z += 0.002;
            }
        }
        if step == 20 {
            scene.radii.iter_mut().for_each(|r| *r *= 1.5);
        }
        let from_kept = scene.search_with(&mut kept);
        let fresh = scene.search();
        assert!(from_kept == fresh, "step {step}: a kept search differs from a fresh one");
        if step % 10 == 0 {
            scene.check(&from_kept.0, &from_kept.1);
        }
    }
}

#[test]
fn obstacles_at_rest_are_indexed_once() {
    let mut random = Random::new(10);
    let mut builder = Builder::default();
    builder.body(BodyFilter::DEFORMABLE).soup(&mut random, [50, 0, 0], 0.4, 0.02);
    builder.body(BodyFilter::OBSTACLE).soup(&mut random, [50, 0, 0], 0.4, 0.02);
    let mut scene = builder.build();
    let mut search = ProximitySearch::new(&scene.model);
    scene.search_with(&mut search);
    assert_eq!(search.statistics().refits, 6);
    // Within the local frame's grid cell, only the three trees of the deformable body are refitted.
    for _ in 0..5 {
        for v in 0..150 {
            scene.positions[v] += random.vector(1e-4);
        }
        scene.search_with(&mut search);
        assert_eq!((search.statistics().refits, search.statistics().rebuilds), (3, 0));
    }
    scene.positions[200].x += 1e-3;
    scene.search_with(&mut search);
    assert!(search.statistics().refits >= 6);
}

#[test]
fn vertices_that_are_not_finite_are_left_out() {
    let mut scene = cloth(0.007).build();
    let (all, _) = scene.search();
    for (bad, value) in [(17, f64::NAN), (100, f64::INFINITY), (200, f64::NEG_INFINITY)] {
        scene.positions[bad].y = value;
    }
    let mut search = ProximitySearch::new(&scene.model);
    for _ in 0..2 {
        let (pairs, _) = scene.search_with(&mut search);
        let expected = all.pairs().iter().filter(|p| [17, 100, 200].iter().all(|v| !p.vertices.contains(v)));
        assert!(pairs.pairs().iter().eq(expected));
    }
}
