//! Hair and yarn.

use super::checks::{non_negative, positive};
use super::rest_shape::RestShape;
use bowknot_errors::{Checks, Parameters};
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// A thin round rod that stretches and bends and, if it has a [`Self::twist_stiffness`], resists twist.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields, default))]
pub struct StrandMaterial {
    /// Mass per length [kg/m]. Default: that of hair.
    pub density: f64,
    /// Young's modulus times cross-section, EA [N]: force per strain. Default: that of hair.
    pub stretch_stiffness: f64,
    /// Young's modulus times second moment of area, EI [N m^2]: moment per curvature. Default: that of
    /// hair. 0: a thread.
    pub bend_stiffness: f64,
    /// Shear modulus times polar moment of area, GJ [N m^2]: torque per twist per length, E I / (1 + nu) of a round rod.
    /// Above 0 strands are rods: twist stores energy, ends and roots that are clamped hold it, and curls keep their shape.
    /// The CPU alone computes them. That of hair is 3.6e-9 (0.89 GPa, Robbins, as for [`Self::hair`]). Default 0: strands
    /// turn freely about themselves.
    pub twist_stiffness: f64,
    /// Radius [m], for the drag by air, for contact and for pictures. Default: that of hair.
    pub radius: f64,
    /// Strain-rate damping [s]: viscous force = this times stiffness times strain rate. It conserves linear
    /// and angular momentum. Default 0.
    pub stretch_damping: f64,
    /// Bending-rate damping [s]: viscous moment = this times stiffness times curvature rate. It conserves
    /// linear momentum, but slightly slows a bent strand that spins as a whole, unless that resists twist. Default 0.
    pub bend_damping: f64,
    /// Shape without bending energy: `flat` is straight; `initial` has the angle at each vertex that the
    /// strand has at the start and, if it resists twist, the planes of bending (without, a curl may roll over).
    /// Default `initial`.
    pub rest_shape: RestShape,
}

impl Default for StrandMaterial {
    /// [`StrandMaterial::hair`].
    fn default() -> Self {
        Self::hair()
    }
}

impl StrandMaterial {
    /// The names that [`Self::named`] accepts.
    pub const NAMES: [&'static str; 5] = ["hair", "lock", "yarn", "rope", "straw"];

    /// A homogeneous round rod: density [kg/m^3], Young's modulus [Pa], radius [m]. EA = E pi r^2,
    /// EI = E pi r^4 / 4.
    pub fn from_young_modulus(density: f64, young_modulus: f64, radius: f64) -> Self {
        let area = PI * radius * radius;
        Self {
            density: density * area,
            stretch_stiffness: young_modulus * area,
            bend_stiffness: young_modulus * area * radius * radius / 4.0,
            twist_stiffness: 0.0,
            radius,
            stretch_damping: 0.0,
            bend_damping: 0.0,
            rest_shape: RestShape::Initial,
        }
    }

    /// One human scalp hair: 1320 kg/m^3, 3.9 GPa, 80 micrometers across (Robbins, "Chemical and
    /// Physical Behavior of Human Hair", 5th ed. 2012, chapter 9).
    pub fn hair() -> Self {
        Self::from_young_modulus(1320.0, 3.9e9, 40e-6)
    }

    /// A lock of 100 hairs that slide freely: 100 times the mass and the stiffnesses of one hair. Its radius
    /// is that of a round bundle half filled with hair. It is for scenes in which one strand stands for many
    /// hairs.
    pub fn lock() -> Self {
        let hair = Self::hair();
        Self {
            density: 100.0 * hair.density,
            stretch_stiffness: 100.0 * hair.stretch_stiffness,
            bend_stiffness: 100.0 * hair.bend_stiffness,
            radius: hair.radius * 200f64.sqrt(),
            ..hair
        }
    }

    /// Cotton yarn of 100 tex: 0.1 g/m, 1 mm across. Engineering choices: EA 160 N, half of that of straight
    /// cotton fibres of 5 GPa; EI that of 575 loose fibres of 12 micrometers.
    pub fn yarn() -> Self {
        Self {
            density: 1e-4,
            stretch_stiffness: 160.0,
            bend_stiffness: 3e-9,
            twist_stiffness: 0.0,
            radius: 0.5e-3,
            stretch_damping: 0.0,
            bend_damping: 0.0,
            rest_shape: RestShape::Initial,
        }
    }

    /// A polyester rope, 10 mm across: 70 g/m (trade weight). Engineering choices: EA 20 kN, 1 % at
    /// 200 N; EI 0.02 N m^2.
    pub fn rope() -> Self {
        Self {
            density: 0.07,
            stretch_stiffness: 20e3,
            bend_stiffness: 0.02,
            twist_stiffness: 0.0,
            radius: 5e-3,
            stretch_damping: 0.0,
            bend_damping: 0.0,
            rest_shape: RestShape::Initial,
        }
    }

    /// A stiff rod: polypropylene, 905 kg/m^3, 1.5 GPa, 3 mm across.
    pub fn straw() -> Self {
        Self::from_young_modulus(905.0, 1.5e9, 1.5e-3)
    }

    /// The strand of that name, one of [`Self::NAMES`].
    pub fn named(name: &str) -> Option<Self> {
        Some(match name {
            "hair" => Self::hair(),
            "lock" => Self::lock(),
            "yarn" => Self::yarn(),
            "rope" => Self::rope(),
            "straw" => Self::straw(),
            _ => return None,
        })
    }
}

impl Parameters for StrandMaterial {
    fn check(&self, checks: &mut Checks) {
        let Self {
            density,
            stretch_stiffness,
            bend_stiffness,
            twist_stiffness,
            radius,
            stretch_damping,
            bend_damping,
            rest_shape: _,
        } = *self;
        positive(checks, &[("density", density, "kg/m"), ("stretch_stiffness", stretch_stiffness, "N")]);
        non_negative(
            checks,
            &[("bend_stiffness", bend_stiffness, "N m2"), ("twist_stiffness", twist_stiffness, "N m2")],
        );
        positive(checks, &[("radius", radius, "m")]);
        non_negative(
            checks,
            &[("stretch_damping", stretch_damping, "s"), ("bend_damping", bend_damping, "s")],
        );
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_name_gives_a_valid_material_that_survives_toml() {
        for name in StrandMaterial::NAMES {
            let material = StrandMaterial::named(name).expect(name);
            material.validate().expect(name);
            let text = toml::to_string(&material).expect("serialize");
            assert_eq!(toml::from_str::<StrandMaterial>(&text).expect("parse"), material);
        }
        assert!(toml::from_str::<StrandMaterial>("bend = 1.0").is_err());
    }

    #[test]
    fn a_hair_has_the_stiffness_of_its_section() {
        // E pi r^2 = 3.9e9 * 5.0265e-9 = 19.6 N, E pi r^4/4 = 7.84e-9 N m^2, 6.6 mg/m.
        let hair = StrandMaterial::hair();
        assert!((hair.stretch_stiffness - 19.604).abs() < 1e-3);
        assert!((hair.bend_stiffness - 7.841e-9).abs() < 1e-12);
        assert!((hair.density - 6.635e-6).abs() < 1e-9);
    }

    #[test]
    fn all_bad_values_are_named() {
        let bad = StrandMaterial {
            density: 0.0,
            stretch_stiffness: -1.0,
            radius: f64::NAN,
            bend_stiffness: -1.0,
            twist_stiffness: f64::INFINITY,
            stretch_damping: -1.0,
            bend_damping: -1.0,
            ..StrandMaterial::hair()
        };
        assert_eq!(
            bad.validate().expect_err("all seven are out of range").to_string(),
            "density = 0 kg/m: must be finite and above 0\n\
             stretch_stiffness = -1 N: must be finite and above 0\n\
             bend_stiffness = -1 N m2: must be finite and at least 0\n\
             twist_stiffness = inf N m2: must be finite and at least 0\n\
             radius = NaN m: must be finite and above 0\n\
             stretch_damping = -1 s: must be finite and at least 0\n\
             bend_damping = -1 s: must be finite and at least 0"
        );
    }
}
