//! Solids.

use super::checks::{non_negative, positive};
use bowknot_errors::{Checks, Parameters};
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

/// An isotropic solid.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields, default))]
pub struct SolidMaterial {
    /// Mass per volume [kg/m^3]. Default 1000.
    pub density: f64,
    /// Young's modulus at small strain [Pa]. Default 1e6. Larger: deforms less.
    pub young_modulus: f64,
    /// Poisson's ratio at small strain [1], in (-1, 0.5). Default 0.45. As it approaches 0.5, linear
    /// tetrahedra become much too stiff in bending (volumetric locking).
    pub poisson_ratio: f64,
    /// Law of large strains. Default `stable-neo-hookean`.
    pub model: SolidModel,
    /// Strain-rate damping [s]: viscous stress = this times stiffness times strain rate. It conserves linear
    /// and angular momentum. Default 0: no damping but that of implicit Euler.
    pub damping: f64,
}

/// Law of large strains of a solid. At small strains both are linear elasticity.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
#[non_exhaustive]
pub enum SolidModel {
    /// St. Venant-Kirchhoff: stress is linear in the Green strain. It stiffens under tension. Compressed
    /// below 1/sqrt(3) = 0.58 of its length it softens, and flattened it has no stress: strong compression
    /// collapses it, and inverted elements stay inverted.
    Stvk,
    /// Stable neo-Hookean (Smith, de Goes and Kim 2018): it resists inversion and recovers from it, and its
    /// energy is smooth there.
    #[default]
    StableNeoHookean,
}

impl Default for SolidMaterial {
    /// [`SolidMaterial::rubber`].
    fn default() -> Self {
        Self::rubber()
    }
}

impl SolidMaterial {
    /// The names that [`Self::named`] accepts.
    pub const NAMES: [&'static str; 4] = ["rubber", "silicone", "jelly", "foam"];

    /// A soft rubber: 1000 kg/m^3, 1 MPa (about Shore A 25), 0.45 instead of 0.4995, at which linear
    /// tetrahedra lock.
    pub fn rubber() -> Self {
        Self {
            density: 1000.0,
            young_modulus: 1e6,
            poisson_ratio: 0.45,
            model: SolidModel::default(),
            damping: 0.0,
        }
    }

    /// A very soft silicone, as of moulded props: 1070 kg/m^3, 125 kPa (data sheets: modulus at 100 %
    /// strain of 8 to 10 psi for Shore 00-30), 0.45 as for rubber.
    pub fn silicone() -> Self {
        Self { density: 1070.0, young_modulus: 125e3, ..Self::rubber() }
    }

    /// Table jelly: 1020 kg/m^3, 10 kPa, the middle of the range of gelatine of 5 to 10 %.
    pub fn jelly() -> Self {
        Self { density: 1020.0, young_modulus: 10e3, ..Self::rubber() }
    }

    /// Upholstery foam: 30 kg/m^3 (trade weight), 30 kPa before its cells buckle, 0.1 (engineering
    /// choices).
    pub fn foam() -> Self {
        Self { density: 30.0, young_modulus: 30e3, poisson_ratio: 0.1, ..Self::rubber() }
    }

    /// The solid of that name, one of [`Self::NAMES`].
    pub fn named(name: &str) -> Option<Self> {
        Some(match name {
            "rubber" => Self::rubber(),
            "silicone" => Self::silicone(),
            "jelly" => Self::jelly(),
            "foam" => Self::foam(),
            _ => return None,
        })
    }

    /// Lame parameters of linear elasticity [Pa]: (lambda, mu).
    pub fn lame(&self) -> (f64, f64) {
        let (e, nu) = (self.young_modulus, self.poisson_ratio);
        (e * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)), e / (2.0 * (1.0 + nu)))
    }
}

impl Parameters for SolidMaterial {
    fn check(&self, checks: &mut Checks) {
        let Self { density, young_modulus, poisson_ratio, model: _, damping } = *self;
        positive(checks, &[("density", density, "kg/m3"), ("young_modulus", young_modulus, "Pa")]);
        checks.between("poisson_ratio", poisson_ratio, -1.0, 0.5);
        non_negative(checks, &[("damping", damping, "s")]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_name_gives_a_valid_material_that_survives_toml() {
        for name in SolidMaterial::NAMES {
            let material = SolidMaterial::named(name).expect(name);
            material.validate().expect(name);
            let text = toml::to_string(&material).expect("serialize");
            assert_eq!(toml::from_str::<SolidMaterial>(&text).expect("parse"), material);
        }
        let stvk: SolidMaterial = toml::from_str("model = \"stvk\"").expect("parse");
        assert_eq!(stvk, SolidMaterial { model: SolidModel::Stvk, ..SolidMaterial::default() });
        assert!(toml::from_str::<SolidMaterial>("modell = \"stvk\"").is_err());
    }

    #[test]
    fn all_bad_values_are_named() {
        let bad = SolidMaterial {
            density: -1.0,
            young_modulus: 0.0,
            poisson_ratio: 0.5,
            damping: f64::INFINITY,
            ..SolidMaterial::default()
        };
        let errors = bad.validate().expect_err("all four are out of range");
        assert_eq!(
            errors.to_string(),
            "density = -1 kg/m3: must be finite and above 0\n\
             young_modulus = 0 Pa: must be finite and above 0\n\
             poisson_ratio = 0.5: must lie between -1 and 0.5\n\
             damping = inf s: must be finite and at least 0"
        );
    }
}
