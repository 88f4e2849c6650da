use crate::integer::{Int3, distance_squared, square_at_most};
use crate::sampling::{KINDS, Random, extent, shuffled};
use bowknot_geometry::{PairKind, Point, distance, separation};

/// 2^-53.
const U: f64 = f64::EPSILON / 2.0;

/// Four points on a grid of random coarseness up to `finest`; coarse grids and the copied, collinear and
/// parallel points make degenerate pairs common, fine grids make slivers.
fn grid_pair(random: &mut Random, finest: usize) -> [Int3; 4] {
    let range = [1, 2, 4, 16, finest][random.below(5)];
    let mut p = [0; 4].map(|_| [0; 3].map(|_: i32| random.below(2 * range + 1) as i128 - range as i128));
    let [i, j, k, l] = shuffled(random);
    match random.below(8) {
        0 => p[i] = p[j],
        1 => p[i] = [0, 1, 2].map(|c| (p[j][c] + p[k][c]) / 2),
        2 => p[3] = [0, 1, 2].map(|c| (p[2][c] + p[1][c] - p[0][c]).clamp(-(range as i128), range as i128)),
        // Steps of successive Fibonacci numbers: as nearly parallel as integers allow.
        3 if finest > 256 => {
            let n = random.below(25);
            let fibonacci = |n: usize| (0..n).fold((0_i128, 1), |(x, y), _| (y, x + y)).0;
            let step = |n| [fibonacci(n), fibonacci(n + 1), fibonacci(n + 1) - fibonacci(n)];
            p[j] = [0, 1, 2].map(|c| p[i][c] / 4 + step(n)[c]);
            p[k] = [0, 1, 2].map(|c| p[i][c] / 4 + step(n + 1)[c]);
            p[l] = [0, 1, 2].map(|c| (p[j][c] + p[k][c]) / 2);
            p[i] = [0, 1, 2].map(|c| p[i][c] / 4);
            // One edge as a whole, or two corners of the triangle, any way off.
            let reach = [0, 1, 1 << 9, 1 << 18][random.below(4)];
            let shift = [0; 3].map(|_: i32| random.below(2 * reach + 1) as i128 - reach as i128);
            for corner in &mut p[2..] {
                *corner = [0, 1, 2].map(|c| corner[c] + shift[c]);
            }
        }
        _ => {}
    }
    p
}

/// Grid points as input of the library: scaled by a power of two and moved, both without rounding.
fn place(points: [Int3; 4], spacing: f64, shift: f64) -> [Point; 4] {
    points.map(|p| Point::from(p.map(|x| x as f64 * spacing + shift)))
}

fn for_each_pair(count: usize, finest: usize, mut check: impl FnMut(PairKind, [Int3; 4], f64, [Point; 4])) {
    let mut random = Random::new(3);
    for i in 0..count {
        let grid = grid_pair(&mut random, finest);
        let (spacing, shift) = [(1.0, 0.0), (2_f64.powi(-20), 8192.0), (2_f64.powi(-30), 0.0)][i % 3];
        check(KINDS[random.below(4)], grid, spacing, place(grid, spacing, shift));
    }
}

#[test]
fn distances_and_weights_are_those_of_integer_arithmetic() {
    for_each_pair(1_000_000, 1 << 19, |kind, grid, spacing, points| {
        let closest = distance::closest(kind, &points);
        // The largest error seen is below 4 U.
        let tolerance = 8.0 * U * extent(kind, &points);
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
        // The offset is that of the points that the weights define.
        let named = (0..kind.vertex_count())
            .map(|i| (points[i] - points[0]) * if i < kind.side_a() { weights[i] } else { -weights[i] })
            .sum::<bowknot_geometry::Vector>();
        assert!((named - closest.offset).amax() <= tolerance, "{kind:?} {grid:?} {closest:?}");
    });
}

#[test]
fn widths_never_exceed_the_exact_distance_and_stay_close_to_it() {
    for_each_pair(600_000, 256, |kind, grid, spacing, points| {
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
