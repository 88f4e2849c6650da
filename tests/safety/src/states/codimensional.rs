//! Particles and strands.

use super::{Case, Draft, draw_clear, grid_triangles};
use crate::Random;
use bowknot_geometry::{HalfSpace, Point, Vector};
use bowknot_proximity::BodyFilter;

/// Sand in three layers, grains down to 2 um apart, between a sheet and a tilted plane.
pub fn particles(seed: u64) -> Case {
    draw_clear("particles", seed, |noise| {
        let mut random = Random::new(seed);
        let mut draft = Draft::default();
        let mut grains = Vec::new();
        for i in 0..150 {
            let place =
                Point::new(0.01 * (i % 5) as f64, 0.01 * (i / 5 % 10) as f64, 0.01 + 0.01 * (i / 50) as f64);
            let grain = place + random.vector(0.004 * noise);
            grains.push(grain);
            // Every third grain has a neighbor that nearly touches it.
            if i % 3 == 0 {
                grains.push(grain + random.direction() * random.magnitude(2e-6, 1e-3));
            }
        }
        draft.add_particles(BodyFilter::DEFORMABLE, grains);
        let n = 6;
        let sheet = (0..n * n)
            .map(|i| Point::new(0.012 * (i % n) as f64 - 0.01, 0.022 * (i / n) as f64 - 0.01, 0.036));
        let triangles = grid_triangles(n as u32, n as u32, |_, _| random.below(2) == 0);
        draft.add_mesh(BodyFilter::DEFORMABLE, sheet.collect(), &triangles);
        draft.half_spaces.extend(HalfSpace::new(Point::new(0.0, 0.0, -0.01), Vector::new(0.1, 0.05, 1.0)));
        draft
    })
}

/// Two crossing bundles of wavy strands, 10 um to 1 mm apart, and loose grains between them.
pub fn strands(seed: u64) -> Case {
    draw_clear("strands", seed, |noise| {
        let mut random = Random::new(seed);
        let gap = random.magnitude(1e-5, 1e-3);
        let mut draft = Draft::default();
        for bundle in 0..2 {
            let mut strands = Vec::new();
            for k in 0..10 {
                // All strands of a bundle have the same wave, so they stay side by side.
                let strand = (0..10)
                    .map(|i| {
                        let (along, across) = (0.01 * i as f64, 0.01 + 0.008 * k as f64);
                        let wave = 0.3 * gap * (9.0 * along).sin();
                        let shake = random.vector(0.3 * noise * gap);
                        let (x, y) = if bundle == 0 { (along, across) } else { (across, along) };
                        Point::new(x, y, bundle as f64 * gap + wave) + shake
                    })
                    .collect();
                strands.push(strand);
            }
            draft.add_strands(BodyFilter::DEFORMABLE, strands);
        }
        let grains = (0..20).map(|_| {
            let place = Point::new(random.between(0.0, 0.1), random.between(0.0, 0.1), 2.0 * gap);
            place + random.vector(0.3 * noise * gap)
        });
        draft.add_particles(BodyFilter::DEFORMABLE, grains.collect());
        draft
    })
}
