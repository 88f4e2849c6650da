use super::figure::{figure, sew, spacing};
use crate::description::Scene;
use crate::shapes::{Figure, Garment};

/// 26,500 vertices and 52,000 triangles, after Fig. 21c of the paper: a gown to the ground, trumpet-shaped,
/// a skirt over it and two shorter tiers over that, 3.5 s of walking in a tightening curve.
pub(super) fn scene(scale: f64) -> Scene {
    let edge = (0.01726 / scale).min(0.06);
    let apart = spacing(edge, 0.01);
    let tier = |layer: f64, top: f64, hem: f64, flare: f64| Garment {
        edge,
        top,
        hem,
        gap: 0.008 + layer * apart,
        flare,
        curve: 1.6,
        ..Garment::default()
    };
    let mut scene = figure(Figure {
        edge: (0.016 / scale).min(0.02),
        walk_speed: 0.75,
        cadence: 1.6,
        leg_swing: 17.0,
        arm_swing: 14.0,
        turn_rate: -100.0,
        turn_start: 1.0,
        ..Figure::default()
    });
    let pleated = |garment: Garment| Garment { pleats: 14, pleat_depth: 0.05, ..garment };
    sew(&mut scene, "gown", "cotton", tier(0.0, 1.255, 0.13, 0.28));
    sew(&mut scene, "skirt", "silk", pleated(tier(1.0, 1.07, 0.1, 0.42)));
    sew(&mut scene, "middle", "silk", pleated(tier(2.0, 1.075, 0.45, 0.32)));
    sew(&mut scene, "upper", "silk", pleated(tier(3.0, 1.08, 0.75, 0.21)));
    scene.simulation.frames = 350;
    scene
}
