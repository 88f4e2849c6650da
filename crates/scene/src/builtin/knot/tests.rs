//! That the knots are the knots they claim to be, that their ribbons could be cut from a flat band, and that
//! nothing touches at the start, at any scale.

use super::super::{bow_knot, reef_knot};
use crate::description::Scene;
use crate::shapes::{Ribbon, Shape};
use crate::world::World;
use bowknot_check::{Judge, StateOptions};
use bowknot_geometry::Point;

const KNOTS: [fn(f64) -> Scene; 2] = [reef_knot::scene, bow_knot::scene];

fn ribbon(scene: &Scene) -> Ribbon {
    let Some(Shape::Ribbon(ribbon)) = &scene.bodies[0].shape else { panic!("a ribbon") };
    ribbon.clone()
}

/// The center-line of the left ribbon as points about 1 cm apart.
fn centre_line(scene: &Scene) -> Vec<Point> {
    // Two columns of quadrilaterals make three vertices a row, the middle one on the center-line.
    let ribbon = ribbon(scene);
    let narrow = Ribbon { width: 0.02, edge: 0.01, ..ribbon };
    narrow.mesh().positions.iter().skip(1).step_by(3).copied().collect()
}

/// A crossing of two curves seen along -z: which segments, whether the first lies above, its sign (+1 if the
/// upper strand must turn counter-clockwise to run along the lower one, by less than half a turn).
#[derive(Clone, Copy, Debug)]
struct Crossing {
    segments: [usize; 2],
    over: bool,
    sign: i32,
}

/// The crossings in the order of the first curve; of a curve with itself each once.
fn crossings(a: &[Point], b: &[Point], itself: bool) -> Vec<Crossing> {
    let mut found = Vec::new();
    for i in 0..a.len() - 1 {
        for j in if itself { i + 2 } else { 0 }..b.len() - 1 {
            let (r, s, q) = (a[i + 1] - a[i], b[j + 1] - b[j], b[j] - a[i]);
            let determinant = r.x * s.y - r.y * s.x;
            if determinant == 0.0 {
                continue;
            }
            let t = (q.x * s.y - q.y * s.x) / determinant;
            let u = (q.x * r.y - q.y * r.x) / determinant;
            if (0.0..1.0).contains(&t) && (0.0..1.0).contains(&u) {
                let over = a[i].z + t * r.z > b[j].z + u * s.z;
                let sign = if (determinant > 0.0) == over { 1 } else { -1 };
                found.push(Crossing { segments: [i, j], over, sign });
            }
        }
    }
    found
}

fn turned(line: &[Point]) -> Vec<Point> {
    line.iter().map(|p| Point::from(super::turned(p.coords))).collect()
}

fn signs_and_heights(crossings: &[Crossing]) -> Vec<(i32, bool)> {
    crossings.iter().map(|c| (c.sign, c.over)).collect()
}

/// Two half knots of 3 alternating crossings: of opposite sense they make a reef knot (closed at either side,
/// a trefoil and its mirror image), of the same sense a granny knot.
fn reef(sense: i32) -> [(i32, bool); 6] {
    [(sense, true), (sense, false), (sense, true), (-sense, true), (-sense, false), (-sense, true)]
}

#[test]
fn the_reef_knot_is_a_reef_knot_and_no_granny() {
    let left = centre_line(&reef_knot::scene(0.2));
    let between = crossings(&left, &turned(&left), false);
    assert_eq!(signs_and_heights(&between), reef(-1));
    // Each half knot by itself, above and below the line between the bights.
    for (k, crossing) in between.iter().enumerate() {
        assert_eq!(left[crossing.segments[0]].y > 0.0, k < 3);
    }
    assert!(crossings(&left, &left, true).is_empty());
}

#[test]
fn the_bow_is_a_reef_knot_whose_second_half_is_tied_with_bights() {
    let left = centre_line(&bow_knot::scene(0.2));
    let right = turned(&left);
    let tip = (0..left.len()).min_by(|&i, &j| left[i].x.total_cmp(&left[j].x)).expect("points");
    let between = crossings(&left, &right, false);
    let strands = |there: bool, back: bool| -> Vec<(i32, bool)> {
        let on = |c: &&Crossing| (c.segments[0] < tip) == there && (c.segments[1] < tip) == back;
        signs_and_heights(&between.iter().filter(on).copied().collect::<Vec<_>>())
    };
    // On the way to the loops' tips: a reef knot.
    assert_eq!(strands(true, true), reef(1));
    // On the way back both strands keep beside those on the way there, through the second half knot only; run
    // backwards they change the sign.
    let second = |sign: i32| [(sign, true), (sign, false), (sign, true)];
    assert_eq!(strands(false, false), second(-1));
    // The free ends hang before and behind everything: one more crossing with the standing end of the other.
    assert_eq!(strands(false, true)[..3], second(1));
    assert_eq!(strands(false, true)[3..], [(-1, true)]);
    assert_eq!(strands(true, false)[1..], second(1));
    assert_eq!(strands(true, false)[..1], [(-1, true)]);
    // The strand back lies above the strand there all the way: they are not twisted around each other, so
    // that a pull at the free end would undo the bow.
    assert!(crossings(&left, &left, true).iter().all(|c| !c.over));
}

#[test]
fn the_ribbons_could_be_cut_from_a_flat_band() {
    for (scene, most, mean_square) in
        [(reef_knot::scene(0.5), 0.003, 0.001), (bow_knot::scene(0.5), 0.035, 0.005)]
    {
        let ribbon = ribbon(&scene);
        let mesh = ribbon.mesh();
        let wide = (ribbon.width / ribbon.edge).round() as usize;
        let rows: Vec<&[Point]> = mesh.positions.chunks(wide + 1).collect();
        let (step, across) = (ribbon.length() / (rows.len() - 1) as f64, ribbon.width / wide as f64);
        let (mut largest, mut sum, mut count) = (0.0f64, 0.0, 0.0);
        let mut note = |a: &Point, b: &Point, flat: f64| {
            let strain = (b - a).norm() / flat - 1.0;
            (largest, sum, count) = (largest.max(strain.abs()), sum + strain * strain, count + 1.0);
        };
        for pair in rows.windows(2) {
            for i in 0..=wide {
                note(&pair[0][i], &pair[1][i], step);
            }
            for i in 0..wide {
                note(&pair[0][i], &pair[0][i + 1], across);
                note(&pair[0][i], &pair[1][i + 1], step.hypot(across));
                note(&pair[0][i + 1], &pair[1][i], step.hypot(across));
            }
        }
        assert!(largest < most, "{largest}");
        assert!((sum / count).sqrt() < mean_square, "{}", (sum / count).sqrt());
    }
}

#[test]
fn nothing_is_near_anything_at_the_start_at_any_scale() {
    for knot in KNOTS {
        for scale in [0.1, 0.13, 0.17, 0.2, 0.25, 0.3, 0.4, 0.5, 0.65, 0.8, 1.0] {
            let scene = knot(scale);
            let edge = ribbon(&scene).edge;
            let world = World::new(&scene).expect("a world");
            let report = Judge::from_model(&world.collision)
                .check_state(&world.positions, &StateOptions::default())
                .expect("finite positions");
            assert!(report.is_clear(), "scale {scale}: {:?}", report.intersections);
            // The contact distance is a tenth of an edge; within the flat strips pairs are two thirds of one
            // apart.
            let nearest = report.nearest.expect("pairs").distance;
            assert!(nearest > 0.5 * edge, "scale {scale}: {nearest} m at edges of {edge} m");
        }
    }
}
