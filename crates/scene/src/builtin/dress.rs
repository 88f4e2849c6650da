use super::figure::{figure, sew, spacing};
use crate::description::Scene;
use crate::shapes::{Figure, Garment};

/// 30,057 vertices and 59,204 triangles, after Fig. 21a of the paper: a dress to the knees and two wider
/// skirts over it, 3.5 s of walking with a half turn on the way.
pub(super) fn scene(scale: f64) -> Scene {
    let edge = (0.0129 / scale).min(0.06);
    let apart = spacing(edge, 0.01);
    let skirt = |layer: f64, top: f64, hem: f64, flare: f64| Garment {
        edge,
        top,
        hem,
        gap: 0.008 + layer * apart,
        flare,
        ..Garment::default()
    };
    let mut scene = figure(Figure {
        edge: (0.016 / scale).min(0.02),
        turn_rate: 150.0,
        turn_start: 1.3,
        turn_end: 2.5,
        ..Figure::default()
    });
    let pleated = |pleat_depth: f64, garment: Garment| Garment { pleats: 12, pleat_depth, ..garment };
    sew(&mut scene, "dress", "cotton", skirt(0.0, 1.255, 0.5, 0.2));
    sew(&mut scene, "underskirt", "silk", pleated(0.03, skirt(1.0, 1.07, 0.44, 0.27)));
    sew(&mut scene, "overskirt", "silk", pleated(0.05, skirt(2.0, 1.08, 0.4, 0.36)));
    scene.simulation.frames = 350;
    scene
}
