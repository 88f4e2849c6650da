//! Grains.

use super::checks::positive;
use bowknot_errors::{Checks, Parameters};
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

/// A grain: a sphere with mass. The only forces on it are gravity and the drag of air.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields, default))]
pub struct ParticleMaterial {
    /// Mass per volume [kg/m^3]. Default 2650, quartz.
    pub density: f64,
    /// Radius [m], for mass, drag by air, contact and pictures. Default 0.5e-3.
    pub radius: f64,
}

impl Default for ParticleMaterial {
    /// [`ParticleMaterial::sand`].
    fn default() -> Self {
        Self::sand()
    }
}

impl ParticleMaterial {
    /// The names that [`Self::named`] accepts.
    pub const NAMES: [&'static str; 3] = ["sand", "gravel", "beads"];

    /// Coarse quartz sand: 2650 kg/m^3, the density of quartz; 1 mm across, the upper end of "coarse
    /// sand" in ISO 14688-1.
    pub fn sand() -> Self {
        Self { density: 2650.0, radius: 0.5e-3 }
    }

    /// Medium gravel: 2650 kg/m^3, 10 mm across (ISO 14688-1: 6.3 to 20 mm).
    pub fn gravel() -> Self {
        Self { density: 2650.0, radius: 5e-3 }
    }

    /// Beads of polystyrene: 1050 kg/m^3, 5 mm across (engineering choice).
    pub fn beads() -> Self {
        Self { density: 1050.0, radius: 2.5e-3 }
    }

    /// The grains of that name, one of [`Self::NAMES`].
    pub fn named(name: &str) -> Option<Self> {
        Some(match name {
            "sand" => Self::sand(),
            "gravel" => Self::gravel(),
            "beads" => Self::beads(),
            _ => return None,
        })
    }

    /// Mass of one grain [kg].
    pub fn mass(&self) -> f64 {
        self.density * 4.0 / 3.0 * std::f64::consts::PI * self.radius.powi(3)
    }
}

impl Parameters for ParticleMaterial {
    fn check(&self, checks: &mut Checks) {
        let Self { density, radius } = *self;
        positive(checks, &[("density", density, "kg/m3"), ("radius", radius, "m")]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_valid_and_bad_values_are_all_named() {
        for name in ParticleMaterial::NAMES {
            ParticleMaterial::named(name).expect(name).validate().expect(name);
        }
        let bad = ParticleMaterial { density: f64::NAN, radius: 0.0 };
        let errors = bad.validate().expect_err("both are out of range");
        assert_eq!(
            errors.to_string(),
            "density = NaN kg/m3: must be finite and above 0\nradius = 0 m: must be finite and above 0"
        );
        assert!(toml::from_str::<ParticleMaterial>("radus = 1.0").is_err());
    }

    #[test]
    fn a_grain_of_sand_weighs_more_than_a_milligram() {
        // 2650 kg/m^3 * 4/3 pi (0.5 mm)^3 = 1.3875 mg.
        assert!((ParticleMaterial::sand().mass() - 1.3875e-6).abs() < 1e-10);
    }
}
