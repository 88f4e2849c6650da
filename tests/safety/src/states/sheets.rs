//! Sheets: folded, crumpled, and made of slivers.

use super::{Case, Draft, draw_clear, grid_triangles};
use crate::Random;
use bowknot_geometry::{Point, Vector};
use bowknot_proximity::BodyFilter;

/// A strip folded zigzag: four layers, 0.1 to 5 mm apart, with bends of tiny triangles.
pub fn folded_sheet(seed: u64) -> Case {
    draw_clear("folded sheet", seed, |noise| {
        let mut random = Random::new(seed);
        let gap = random.magnitude(1e-4, 5e-3);
        let (layers, cells, width, length) = (4, 7, 6, 0.2);
        // The profile of the strip in (x, z): layers back and forth, joined by half circles.
        let mut profile = Vec::new();
        for layer in 0..layers {
            let height = layer as f64 * gap;
            let forth = layer % 2 == 0;
            for k in 0..=cells {
                let along = length * k as f64 / cells as f64;
                profile.push((if forth { along } else { length - along }, height));
            }
            if layer + 1 < layers {
                let (end, side) = if forth { (length, 1.0) } else { (0.0, -1.0) };
                for k in 1..4 {
                    let angle = std::f64::consts::PI * (k as f64 / 4.0 - 0.5);
                    profile.push((
                        end + side * 0.5 * gap * angle.cos(),
                        height + 0.5 * gap * (1.0 + angle.sin()),
                    ));
                }
            }
        }
        let count = profile.len() as u32;
        let mut points = Vec::new();
        for j in 0..width {
            for &(x, z) in &profile {
                let shake = random.vector(0.4 * noise * gap);
                points.push(Point::new(x, 0.1 * j as f64 / (width - 1) as f64, z) + shake);
            }
        }
        let mut draft = Draft::default();
        let triangles = grid_triangles(count, width, |_, _| random.below(2) == 0);
        draft.add_mesh(BodyFilter::DEFORMABLE, points, &triangles);
        draft
    })
}

/// A sheet deformed by random shears, which map space one to one, and then flattened to a fifth.
pub fn crumpled_sheet(seed: u64) -> Case {
    draw_clear("crumpled sheet", seed, |noise| {
        let mut random = Random::new(seed);
        let n = 18;
        let mut points: Vec<Point> =
            (0..n * n).map(|i| Point::new((i % n) as f64 * 0.01, (i / n) as f64 * 0.01, 0.0)).collect();
        for _ in 0..7 {
            let along = random.direction();
            let across = along.cross(&random.direction()).normalize();
            let (waves, phase) = (random.between(20.0, 90.0), random.between(0.0, 6.0));
            let height = noise * random.between(0.01, 0.04);
            for p in &mut points {
                *p += across * (height * (waves * along.dot(&p.coords) + phase).sin());
            }
        }
        let flat = random.direction();
        points.iter_mut().for_each(|p| *p -= flat * (0.8 * flat.dot(&p.coords)));
        let mut draft = Draft::default();
        let triangles = grid_triangles(n as u32, n as u32, |_, _| random.below(2) == 0);
        draft.add_mesh(BodyFilter::DEFORMABLE, points, &triangles);
        draft
    })
}

/// Two sheets 1 to 1000 um apart whose columns and rows are 2 um to 2 cm wide: needles and caps.
pub fn slivers(seed: u64) -> Case {
    draw_clear("slivers", seed, |noise| {
        let mut random = Random::new(seed);
        let gap = random.magnitude(1e-6, 1e-3);
        let n = 10;
        let mut draft = Draft::default();
        for layer in 0..2 {
            let mut coordinates = || {
                let mut at = 0.0;
                (0..n)
                    .map(|_| {
                        at += random.magnitude(2e-6, 2e-2);
                        at
                    })
                    .collect::<Vec<f64>>()
            };
            let (xs, ys) = (coordinates(), coordinates());
            let mut points = Vec::new();
            for y in &ys {
                for x in &xs {
                    let lift = Vector::z() * (layer as f64 * gap + noise * random.between(-0.4, 0.4) * gap);
                    points.push(Point::new(*x, *y, 0.0) + lift);
                }
            }
            let triangles = grid_triangles(n, n, |_, _| random.below(2) == 0);
            draft.add_mesh(BodyFilter::DEFORMABLE, points, &triangles);
        }
        draft
    })
}
