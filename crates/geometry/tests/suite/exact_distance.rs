use crate::integer::{Int3, distance_squared, square_at_most};
use crate::sampling::{KINDS, Random, extent, shuffled};
use bowknot_geometry::{PairKind, Point, distance, separation};

/// 2^-53.
const U: f64 = f64::EPSILON / 2.0;

/// Four points on a grid of random coarseness; coarse grids and the copied, collinear and parallel
/// points make degenerate pairs common.
fn grid_pair(random: &mut Random) -> [Int3; 4] {
    let range = [1, 2, 4, 16, 256][random.below(5)];
    let mut p = [0; 4].map(|_| [0; 3].map(|_: i32| random.below(2 * range + 1) as i128 - range as i128));
    let [i, j, k, _] = shuffled(random);
    match random.below(8) {
        0 => p[i] = p[j],
        1 => p[i] = [0, 1, 2].map(|c| (p[j][c] + p[k][c]) / 2),
        2 => p[3] = [0, 1, 2].map(|c| (p[2][c] + p[1][c] - p[0][c]).clamp(-256, 256)),
        _ => {}
    }
    p
}

/// Grid points as the library sees them: scaled by a power of two and moved, both without rounding.
fn place(points: [Int3; 4], spacing: f64, shift: f64) -> [Point; 4] {
    points.map(|p| Point::from(p.map(|x| x as f64 * spacing + shift)))
}

fn for_each_pair(count: usize, mut check: impl FnMut(PairKind, [Int3; 4], f64, [Point; 4])) {
    let mut random = Random(3);
    for i in 0..count {
        let grid = grid_pair(&mut random);
        let (spacing, shift) = [(1.0, 0.0), (2_f64.powi(-10), 8192.0), (2_f64.powi(-30), 0.0)][i % 3];
        check(KINDS[random.below(4)], grid, spacing, place(grid, spacing, shift));
    }
}

#[test]
fn distances_and_weights_are_those_of_integer_arithmetic() {
    for_each_pair(600_000, |kind, grid, spacing, points| {
        let closest = distance::closest(kind, &points);
        let tolerance = 16.0 * U * extent(kind, &points);
        let expected = distance_squared(kind, grid).to_f64().sqrt() * spacing;
        assert!((closest.distance - expected).abs() <= tolerance, "{kind:?} {grid:?} {closest:?} {expected}");
        assert!((closest.offset.norm() - closest.distance).abs() <= tolerance);

        let weights = closest.weights;
        assert!(weights.iter().all(|w| (0.0..=1.0).contains(w)), "{kind:?} {grid:?} {weights:?}");
        let (a, b) = weights.split_at(kind.side_a());
        assert!(
            (a.iter().sum::<f64>() - 1.0).abs() <= 2.0 * U && (b.iter().sum::<f64>() - 1.0).abs() <= 2.0 * U
        );
        assert!(weights[kind.vertex_count()..].iter().all(|&w| w == 0.0));
        // The offset is that of the points that the weights name.
        let named = (0..kind.vertex_count())
            .map(|i| (points[i] - points[0]) * if i < kind.side_a() { weights[i] } else { -weights[i] })
            .sum::<bowknot_geometry::Vector>();
        assert!((named - closest.offset).amax() <= tolerance, "{kind:?} {grid:?} {closest:?}");
    });
}

#[test]
fn widths_never_exceed_the_exact_distance_and_stay_close_to_it() {
    for_each_pair(600_000, |kind, grid, spacing, points| {
        let width = separation::separate(kind, &points).width;
        let squared = distance_squared(kind, grid);
        if squared.numerator == 0 {
            assert!(width <= 0.0, "{kind:?} {grid:?} {width}");
        } else {
            // The spacing is a power of two: dividing by it is exact.
            assert!(width <= 0.0 || square_at_most(width / spacing, squared), "{kind:?} {grid:?} {width}");
            let expected = squared.to_f64().sqrt() * spacing;
            assert!(width >= 0.99 * expected, "{kind:?} {grid:?} {width} {expected}");
        }
    });
}
