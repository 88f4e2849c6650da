//! Grains.

use super::check;
use crate::MaterialError;
use serde::{Deserialize, Serialize};

/// A grain: a sphere that has mass and feels gravity and air, and nothing else.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ParticleMaterial {
    /// Mass per volume [kg/m^3]. Default 2650, quartz.
    pub density: f64,
    /// Radius [m]: of the mass, of the drag by air, for contact and for pictures. Default 0.5e-3.
    pub radius: f64,
}

impl Default for ParticleMaterial {
    /// [`ParticleMaterial::sand`].
    fn default() -> Self {
        Self::sand()
    }
}

impl ParticleMaterial {
    /// Names that [`Self::named`] knows.
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

    /// Checks every value.
    ///
    /// # Errors
    /// All that is wrong, by field name.
    pub fn validate(&self) -> Result<(), Vec<MaterialError>> {
        let errors = check(&[("density", self.density, "kg/m3"), ("radius", self.radius, "m")], &[]);
        if errors.is_empty() { Ok(()) } else { Err(errors) }
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
        let text: Vec<String> = bad.validate().expect_err("two").iter().map(ToString::to_string).collect();
        assert!(text[0].starts_with("density = NaN") && text[1].starts_with("radius = 0 m"), "{text:?}");
        assert!(toml::from_str::<ParticleMaterial>("radus = 1.0").is_err());
    }

    #[test]
    fn a_grain_of_sand_weighs_more_than_a_milligram() {
        // 2650 kg/m^3 * 4/3 pi (0.5 mm)^3 = 1.3875 mg.
        assert!((ParticleMaterial::sand().mass() - 1.3875e-6).abs() < 1e-10);
    }
}
