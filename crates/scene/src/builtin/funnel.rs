use super::{ground, sheet};
use crate::body::BodySpec;
use crate::description::Scene;
use crate::motion::{Keyframe, Motion};
use crate::obstacle::ObstacleSpec;
use crate::pin::{PinSpec, Region};
use crate::shapes::{Lathe, Shape};
use bowknot_constraints::STRETCH_LIMIT;
use bowknot_geometry::{Point, Vector};

/// Radius of the neck inside [m]: a sixth of the sheet's circumference fits around it without folds.
const NECK: f64 = 0.1;
/// Radius of the mouth inside [m]; the walls of the cone stand at 45 degrees.
const MOUTH: f64 = 0.45;
/// Heights of the neck's lower end and of its upper end, where the cone begins [m].
const BOTTOM: f64 = 1.0;
const THROAT: f64 = 1.15;
/// Thickness of the wall [m].
const WALL: f64 = 0.01;
/// Height at which the sheet's middle is let go [m], with the corners just out of the neck.
const RELEASE: f64 = 0.2;
/// Speed at which it is drawn [m/s]: 2.5 cm within the longest of the paper's time steps.
const SPEED: f64 = 0.5;

/// 49,284 vertices and 97,682 triangles, after Fig. 19 of the paper. A sheet of 1 m width lies 1 cm above a
/// funnel of 45 cm radius at its mouth and 10 cm at its neck, 15 cm long; its middle, a patch of 4 cm, is
/// drawn down through the neck at 0.5 m/s and let go 20 cm above the ground. The paper's four time steps are
/// `--dt` 0.05, 0.025, 0.0125 and 0.00625, with `--frames` as many times 80.
pub(super) fn scene(scale: f64) -> Scene {
    let edge = 1.0 / (221.0 * scale);
    let top = THROAT + MOUTH - NECK;
    let start = top + 0.01;
    let funnel = Lathe { profile: profile(top, 2.0 * edge), closed: true, edge: 2.0 * edge };
    let reach = start - RELEASE;
    let lead = PinSpec {
        body: "sheet".to_owned(),
        region: Some(Region {
            min: Point::new(-0.02, -0.02, f64::NEG_INFINITY),
            max: Point::new(0.02, 0.02, f64::INFINITY),
        }),
        motion: Some(Motion {
            keyframes: vec![Keyframe {
                time: reach / SPEED,
                translate: Vector::new(0.0, 0.0, -reach),
                angle: 0.0,
            }],
            ..Motion::default()
        }),
        end: reach / SPEED,
        ..PinSpec::default()
    };
    let mut scene = Scene {
        bodies: vec![BodySpec {
            // In the neck limits and contacts contradict each other, and now and then a collision problem
            // takes all the steps it may: with cotton's own 1.05 at two of five scales, with the paper's 1.1
            // at none of seven. No limit rules it out: at scale 0.2 it happens with 1.07, 1.101 and 1.11, not
            // with 1.049, 1.051, 1.06 and 1.08.
            stretch_limit: Some(STRETCH_LIMIT),
            ..sheet("sheet", 1.0, edge, [0.0, 0.0, start], 7.0)
        }],
        obstacles: vec![
            ObstacleSpec {
                name: "funnel".to_owned(),
                shape: Some(Shape::Lathe(funnel)),
                ..ObstacleSpec::default()
            },
            ground(),
        ],
        pins: vec![lead],
        ..Scene::default()
    };
    scene.simulation.dt = 0.05;
    scene.simulation.frames = 80;
    scene
}

/// The funnel's wall as a closed profile, inside downwards and outside upwards, its corners rounded.
fn profile(top: f64, edge: f64) -> Vec<[f64; 2]> {
    // The offset of a wall at 45 degrees shifts its corner with the upright wall by tan(22.5 degrees).
    let shift = WALL * libm::tan(std::f64::consts::FRAC_PI_8);
    let corners = [
        ([MOUTH, top], 0.4 * WALL),
        ([NECK, THROAT], 0.04),
        ([NECK, BOTTOM], 0.4 * WALL),
        ([NECK + WALL, BOTTOM], 0.4 * WALL),
        ([NECK + WALL, THROAT - shift], 0.05),
        ([MOUTH + WALL * std::f64::consts::SQRT_2, top], 0.4 * WALL),
    ];
    let n = corners.len();
    let at = |k: usize| Point::new(corners[k % n].0[0], corners[k % n].0[1], 0.0);
    let mut points = Vec::new();
    for (k, (_, radius)) in corners.iter().enumerate() {
        let (before, corner, after) = (at(k + n - 1), at(k), at(k + 1));
        let (to, from) = ((before - corner).normalize(), (after - corner).normalize());
        // The arc touches both sides at this distance from the corner.
        let half_angle = 0.5 * libm::acos(to.dot(&from));
        let (reach, turn) = (radius / libm::tan(half_angle), std::f64::consts::PI - 2.0 * half_angle);
        let center = corner + (to + from).normalize() * (radius / libm::sin(half_angle));
        let (start, end) = (corner + to * reach - center, corner + from * reach - center);
        let steps = (radius * turn / edge).ceil().max(3.0) as u32;
        for step in 0..=steps {
            let s = f64::from(step) / f64::from(steps);
            let weight = |s: f64| libm::sin(s * turn) / libm::sin(turn);
            let arm = start * weight(1.0 - s) + end * weight(s);
            points.push([center.x + arm.x, center.y + arm.y]);
        }
    }
    points
}
