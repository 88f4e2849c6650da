//! The light of a picture: a soft key light and a sky, both sampled by many small lights.
//!
//! Each small light casts hard shadows through a shadow map; in penumbras the shader looks around in it. The
//! sum of many samples of an area light and of a dome gives soft shadows and ambient occlusion. This is the
//! many-light view of global illumination (Keller, "Instant Radiosity", SIGGRAPH 1997) with a single bounce
//! of sky light.

use bowknot_geometry::Vector;
use std::f64::consts::{PI, TAU};

/// Share of the light on a level ground that comes from the key light.
const KEY_SHARE: f64 = 0.55;
/// Half the angle that the key light subtends [deg]; it sets the width of the penumbras.
const KEY_HALF_ANGLE: f64 = 7.0;
/// Height of the key light above the horizon [deg].
const KEY_HEIGHT: f64 = 48.0;
/// Angle between the camera and the key light, which stands to the left of it [deg].
const KEY_TURN: f64 = 56.0;
/// Angle between one point of a spiral and the next: the golden angle [rad].
const GOLDEN: f64 = 2.399_963_229_728_653;
/// Radius of the part of the key light that a light stands for, over that of an even share.
const OVERLAP: f64 = 1.6;

/// A small light, infinitely far away.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Light {
    /// Unit vector toward the light.
    pub direction: Vector,
    /// Irradiance of a surface that faces the light. All lights together give 1 on a level ground.
    pub weight: f64,
    /// Whether it belongs to the key light.
    pub key: bool,
    /// From its direction to the middle of the part of the key light that it stands for, to the right and up
    /// [tangents of angles]; 0 of the sky.
    pub offset: [f64; 2],
    /// Radius of the part of the key light or of the sky that it stands for [tangent of an angle].
    pub radius: f64,
}

/// The lights for a camera. `back` points from its target to its eye; the key light stands to the left of the
/// camera.
pub fn lights(back: &Vector, key_count: usize, sky_count: usize) -> Vec<Light> {
    let around = if back.x.hypot(back.y) > 1e-3 { back.y.atan2(back.x) } else { -PI / 2.0 };
    let (azimuth, height) = (around - KEY_TURN.to_radians(), KEY_HEIGHT.to_radians());
    let center = Vector::new(azimuth.cos() * height.cos(), azimuth.sin() * height.cos(), height.sin());
    let [right, up, _] = crate::camera::axes(&center);

    let mut lights = Vec::with_capacity(key_count + sky_count);
    // A spiral spreads the points evenly over a disc.
    let key_radius = KEY_HALF_ANGLE.to_radians().tan();
    // Parts overlap, so that the edges between them do not show, and no part reaches out of the light.
    let part = (OVERLAP / (key_count as f64).sqrt()).min(0.7);
    for k in 0..key_count {
        let offset = key_place(k, key_count).map(|c| key_radius * c);
        let direction = (center + right * offset[0] + up * offset[1]).normalize();
        let middle = spiral(k, key_count).map(|c| key_radius * (1.0 - part) * c);
        let way = right * (middle[0] - offset[0]) + up * (middle[1] - offset[1]);
        let [own_right, own_up, _] = crate::camera::axes(&direction);
        lights.push(Light {
            direction,
            weight: 1.0,
            key: true,
            offset: [way.dot(&own_right), way.dot(&own_up)],
            radius: key_radius * part,
        });
    }
    normalize(&mut lights, KEY_SHARE);

    // A spiral spreads the points over a hemisphere by equal area (Archimedes: bands of equal height in z).
    // The sky is brighter toward the zenith, as an overcast sky is (Moon and Spencer, "Illumination from a
    // nonuniform sky", 1942).
    let mut sky = Vec::with_capacity(sky_count);
    // The hemisphere has an area of 2 pi.
    let part = (2.0 / sky_count as f64).sqrt();
    for k in 0..sky_count {
        let z = 0.06 + 0.94 * (k as f64 + 0.5) / sky_count as f64;
        let (s, c) = (k as f64 * GOLDEN + TAU / 8.0).sin_cos();
        let level = (1.0 - z * z).sqrt();
        let direction = Vector::new(level * c, level * s, z);
        let weight = (1.0 + 2.0 * z) / 3.0;
        sky.push(Light { direction, weight, key: false, offset: [0.0; 2], radius: part });
    }
    normalize(&mut sky, if key_count > 0 { 1.0 - KEY_SHARE } else { 1.0 });
    lights.extend(sky);
    lights
}

/// Point `k` of `count` that are spread evenly over a disc of radius 1.
pub fn spiral(k: usize, count: usize) -> [f64; 2] {
    let (s, c) = (k as f64 * GOLDEN).sin_cos();
    let radius = ((k as f64 + 0.5) / count as f64).sqrt();
    [radius * c, radius * s]
}

/// Where light `k` of `count` looks from, in a key light of radius 1: half of them from its rim, so that
/// whatever blocks a part of it blocks some of them.
fn key_place(k: usize, count: usize) -> [f64; 2] {
    let inner = count / 2 - count / 4;
    if k < inner {
        return spiral(k, inner).map(|c| 0.7 * c);
    }
    let (s, c) = (TAU * (k - inner) as f64 / (count - inner) as f64).sin_cos();
    [c, s]
}

/// Scales the weights so that the lights give `total` on a level ground.
fn normalize(lights: &mut [Light], total: f64) {
    let sum: f64 = lights.iter().map(|l| l.weight * l.direction.z).sum();
    lights.iter_mut().for_each(|l| l.weight *= total / sum);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_irradiance_of_a_level_ground_is_one() {
        for back in [Vector::new(-0.5, -1.0, 0.5), Vector::z(), Vector::y()] {
            let lights = lights(&back.normalize(), 12, 40);
            assert_eq!(lights.len(), 52);
            let ground: f64 = lights.iter().map(|l| l.weight * l.direction.z).sum();
            assert!((ground - 1.0).abs() < 1e-12);
            assert!(lights.iter().all(|l| (l.direction.norm() - 1.0).abs() < 1e-12 && l.direction.z > 0.0));
        }
    }

    #[test]
    fn the_key_light_stands_to_the_left_of_the_camera() {
        let back = Vector::new(0.3, -1.0, 0.4).normalize();
        let [right, ..] = crate::camera::axes(&back);
        let lights = lights(&back, 8, 8);
        let key: Vec<&Light> = lights.iter().filter(|l| l.key).collect();
        assert_eq!(key.len(), 8);
        assert!(key.iter().all(|l| l.direction.dot(&right) < 0.0 && l.direction.dot(&back) > 0.0));
    }

    /// The parts of the key light fill it, and none reaches out of it: what no light's own direction sees
    /// blocked is then in full light.
    #[test]
    fn the_parts_of_the_key_light_lie_within_it() {
        let radius = KEY_HALF_ANGLE.to_radians().tan();
        for count in [1, 8, 20, 40] {
            let lights = lights(&Vector::y(), count, 8);
            let key = || lights.iter().filter(|l| l.key);
            let center = key().fold(Vector::zeros(), |sum, l| {
                let [right, up, _] = crate::camera::axes(&l.direction);
                sum + l.direction + right * l.offset[0] + up * l.offset[1]
            });
            let center = center.normalize();
            let mut farthest: f64 = 0.0;
            for light in key() {
                let [right, up, _] = crate::camera::axes(&light.direction);
                let middle = light.direction + right * light.offset[0] + up * light.offset[1];
                let away = (middle / middle.dot(&center) - center).norm();
                assert!(away + light.radius < 1.1 * radius, "{count}: {away} and {}", light.radius);
                farthest = farthest.max(away + light.radius);
            }
            assert!(farthest > 0.7 * radius, "{count}: {farthest}");
        }
    }

    /// The mean direction of the sky is up.
    #[test]
    fn the_sky_is_even() {
        let sky: Vec<Light> = lights(&Vector::y(), 4, 64).into_iter().filter(|l| !l.key).collect();
        let mean = sky.iter().fold(Vector::zeros(), |sum, l| sum + l.direction * l.weight);
        assert!(mean.x.hypot(mean.y) < 0.05 * mean.z, "{mean}");
    }
}
