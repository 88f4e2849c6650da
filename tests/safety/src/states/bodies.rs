//! Sharp features that face each other, and a scene with all types of elements.

use super::{Case, Draft, draw_clear, grid_triangles};
use crate::Random;
use bowknot_geometry::{HalfSpace, Point, Vector};
use bowknot_proximity::BodyFilter;

/// Hinges, convex, flat and concave, with a vertex, a parallel edge or a crossing edge exactly above the
/// shared edge, 1 um to 1 mm away. There is no noise, because it would remove the degenerate placements.
pub fn vertex_over_edge(seed: u64) -> Case {
    draw_clear("vertex over edge", seed, |_| {
        let mut random = Random::new(seed);
        let mut draft = Draft::default();
        for k in 0..9 {
            let origin = Vector::new(0.2 * (k % 3) as f64, 0.2 * (k / 3) as f64, 0.0);
            let gap = random.magnitude(1e-6, 1e-3);
            let slope = [-0.03, 0.0, 0.02][k % 3];
            let at = |x: f64, y: f64, z: f64| Point::new(x, y, z) + origin;
            // The shared edge along y, the wings to either side.
            let wings =
                vec![at(0.0, -0.05, 0.0), at(0.0, 0.05, 0.0), at(0.05, 0.0, slope), at(-0.05, 0.0, slope)];
            draft.add_mesh(BodyFilter::DEFORMABLE, wings, &[[0, 2, 1], [0, 1, 3]]);
            let tip = at(0.0, [0.0, 0.05, 0.02][k / 3], gap);
            let above = match k / 3 {
                // A corner above the edge, or above its end.
                0 => vec![tip, tip + Vector::new(0.01, 0.0, 0.04), tip + Vector::new(-0.01, 0.01, 0.04)],
                // An edge parallel to the shared one.
                1 => vec![tip, tip - Vector::y() * 0.06, tip + Vector::new(0.0, 0.01, 0.05)],
                // An edge across it.
                _ => {
                    let half = if slope > 0.0 { 0.5 * gap } else { 0.004 };
                    let aside = Vector::new(half, 0.2 * half, 0.0);
                    vec![tip - aside, tip + aside, tip + Vector::z() * 0.05]
                }
            };
            draft.add_mesh(BodyFilter::DEFORMABLE, above, &[[0, 1, 2]]);
        }
        draft
    })
}

/// Sharp cones tip to tip, 1 um to 1 mm apart; some tips are slightly offset.
pub fn spike_on_spike(seed: u64) -> Case {
    draw_clear("spike on spike", seed, |noise| {
        let mut random = Random::new(seed);
        let mut draft = Draft::default();
        for k in 0..6 {
            let place = Vector::new(0.04 * (k % 3) as f64, 0.04 * (k / 3) as f64, 0.0);
            let gap = random.magnitude(1e-6, 1e-3);
            let aside = if k % 2 == 0 { Vector::zeros() } else { random.vector(noise * gap) };
            for (side, shift) in [(-1.0, Vector::zeros()), (1.0, aside)] {
                let sides = 5;
                let mut points = vec![Point::origin() + place + shift + Vector::z() * (0.5 * side * gap)];
                for i in 0..sides {
                    let angle = i as f64 / sides as f64 * std::f64::consts::TAU + random.between(0.0, 0.5);
                    points
                        .push(points[0] + Vector::new(0.003 * angle.cos(), 0.003 * angle.sin(), 0.04 * side));
                }
                let triangles: Vec<[u32; 3]> = (0..sides).map(|i| [0, 1 + i, 1 + (i + 1) % sides]).collect();
                draft.add_mesh(BodyFilter::DEFORMABLE, points, &triangles);
            }
        }
        draft
    })
}

/// A sheet between a ball, which is an obstacle, and the ground, with strands across it and particles on top.
pub fn mixed(seed: u64) -> Case {
    draw_clear("mixed", seed, |noise| {
        let mut random = Random::new(seed);
        let gap = random.magnitude(1e-5, 2e-3);
        let mut draft = Draft::default();

        let n: u32 = 13;
        let sheet: Vec<Point> = (0..n * n)
            .map(|i| Point::new((i % n) as f64 * 0.02 - 0.12, (i / n) as f64 * 0.02 - 0.12, gap))
            .map(|p| p + random.vector(0.3 * noise * gap))
            .collect();
        let triangles = grid_triangles(n, n, |i, j| (i + j) % 2 == 0);
        draft.add_mesh(BodyFilter::DEFORMABLE, sheet, &triangles);

        let strands = (0..4).map(|k| {
            let y = 0.05 * k as f64 - 0.06;
            (0..9)
                .map(|i| Point::new(0.03 * i as f64 - 0.11, y, 2.0 * gap) + random.vector(0.3 * noise * gap))
                .collect()
        });
        draft.add_strands(BodyFilter::DEFORMABLE, strands.collect());

        let grains = (0..25).map(|i| {
            let place = Point::new(0.02 * (i % 5) as f64 + 0.013, 0.02 * (i / 5) as f64 + 0.017, 3.0 * gap);
            place + random.vector(0.3 * noise * gap)
        });
        draft.add_particles(BodyFilter::DEFORMABLE, grains.collect());

        let (points, triangles) = ball(0.05, Point::new(-0.05, -0.04, 0.05 + 3.5 * gap));
        draft.add_mesh(BodyFilter::OBSTACLE, points, &triangles);
        draft.half_spaces.extend(HalfSpace::new(Point::origin(), Vector::z()));
        draft
    })
}

/// A ball of six rings of ten vertices, and its poles.
fn ball(radius: f64, center: Point) -> (Vec<Point>, Vec<[u32; 3]>) {
    let (rings, around) = (6u32, 10u32);
    let mut points = Vec::new();
    for r in 1..=rings {
        let polar = std::f64::consts::PI * r as f64 / (rings + 1) as f64;
        for k in 0..around {
            let angle = std::f64::consts::TAU * k as f64 / around as f64;
            let unit = Vector::new(polar.sin() * angle.cos(), polar.sin() * angle.sin(), polar.cos());
            points.push(center + radius * unit);
        }
    }
    let (north, south) = (points.len() as u32, points.len() as u32 + 1);
    points.extend([center + Vector::z() * radius, center - Vector::z() * radius]);
    let at = |r: u32, k: u32| r * around + k % around;
    let mut triangles = Vec::new();
    for k in 0..around {
        triangles.push([north, at(0, k), at(0, k + 1)]);
        triangles.push([south, at(rings - 1, k + 1), at(rings - 1, k)]);
        for r in 1..rings {
            triangles.push([at(r - 1, k), at(r, k), at(r, k + 1)]);
            triangles.push([at(r - 1, k), at(r, k + 1), at(r - 1, k + 1)]);
        }
    }
    (points, triangles)
}
