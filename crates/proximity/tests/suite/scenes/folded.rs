//! Folded cloth: a strip laid back and forth in layers, each near the next.

use bowknot_geometry::Point;

/// Vertices along each half circle that joins two layers.
const FOLD: usize = 6;

/// About `vertices` vertices in layers `gap` [m] apart, with wrinkles that the layers share.
pub fn folded_cloth(vertices: usize, gap: f64) -> (Vec<Point>, Vec<[u32; 3]>) {
    let panel = 0.2;
    let layers = ((vertices as f64 / 1000.0).sqrt() * 2.0).round().max(4.0) as usize;
    let across = ((vertices / layers / 2) as f64).sqrt().max(8.0) as usize;
    let straight = (vertices / layers / across).saturating_sub(FOLD).max(8);

    let mut profile = Vec::new();
    for layer in 0..layers {
        let (height, forth) = (layer as f64 * gap, layer % 2 == 0);
        for i in 0..straight {
            let u = panel * i as f64 / (straight - 1) as f64;
            profile.push([if forth { u } else { panel - u }, height]);
        }
        for i in 1..=FOLD {
            let angle = std::f64::consts::PI * (i as f64 / (FOLD + 1) as f64 - 0.5);
            let out = 0.5 * gap * angle.cos();
            let x = if forth { panel + out } else { -out };
            if layer + 1 < layers {
                profile.push([x, height + 0.5 * gap * (1.0 + angle.sin())]);
            }
        }
    }

    // Noise breaks the symmetry. The figures of the README depend on these numbers of a linear congruential
    // generator, so that they do not come from a library.
    let mut state = 1_u64;
    let mut noise = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((state >> 33) as f64 / (1_u64 << 30) as f64 - 1.0) * gap / 8.0
    };
    let mut positions = Vec::with_capacity(profile.len() * across);
    for &[x, height] in &profile {
        let flat = (x.min(panel - x) / (0.05 * panel)).clamp(0.0, 1.0);
        for j in 0..across {
            let y = panel * j as f64 / (across - 1) as f64;
            let wrinkle = 0.01 * (25.0 * x).sin() * (19.0 * y).sin();
            positions.push(Point::new(x, y, height + wrinkle + flat * noise()));
        }
    }
    let mut triangles = Vec::new();
    let n = across as u32;
    for i in 0..profile.len() as u32 - 1 {
        for j in 0..n - 1 {
            let [a, b, c, d] = [i * n + j, (i + 1) * n + j, (i + 1) * n + j + 1, i * n + j + 1];
            triangles.extend(if (i + j) % 2 == 0 { [[a, b, d], [b, c, d]] } else { [[a, b, c], [a, c, d]] });
        }
    }
    (positions, triangles)
}
