//! Fabrics.

use super::{RestShape, check};
use crate::MaterialError;
use crate::elements::woven::Weave;
use bowknot_geometry::Vector;
use serde::{Deserialize, Serialize};

/// A woven or knitted sheet, linear in the rotated frame: isotropic, or with stiffnesses of its own along warp,
/// weft and in shear.
///
/// Thickness never enters the forces by itself: stiffnesses are those of the sheet, per metre of
/// its width. For a homogeneous sheet with Young's modulus E they follow as `E t` and
/// `E t^3 / (12 (1 - nu^2))`, see [`ClothMaterial::from_young_modulus`]; a fabric, whose yarns slide,
/// bends far more easily than that.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ClothMaterial {
    /// Mass per area [kg/m^2]. Larger: heavier, slower to accelerate.
    pub density: f64,
    /// Young's modulus times thickness [N/m], along the warp if the weft has its own. Larger: stretches
    /// less, and the linear solve takes more iterations, about as its square root.
    pub stretch_stiffness: f64,
    /// Young's modulus times thickness along the weft [N/m], across `warp_direction`. Default: as along the warp.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub weft_stiffness: Option<f64>,
    /// Shear modulus times thickness [N/m]: force per width and angle between warp and weft. Woven cloth
    /// shears 10 to 100 times more easily than it stretches. Default: sqrt(warp weft)/(2 (1 + nu)), isotropic if warp
    /// and weft are equal.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub shear_stiffness: Option<f64>,
    /// Direction of the warp in the rest state [1], projected into each triangle; matters only with a weft or
    /// shear stiffness. Default (1, 0, 0).
    pub warp_direction: Vector,
    /// Poisson's ratio of the membrane [1], in (-1, 1): how much it narrows when stretched. With different
    /// stiffnesses, the geometric mean of both ratios.
    pub poisson_ratio: f64,
    /// Bending stiffness D [N m]: moment per width and curvature of a strip free at its sides.
    /// Larger: wider folds.
    pub bend_stiffness: f64,
    /// Shape free of bending: `flat`, or `initial`, the curved shape that the body has at the start. Default
    /// `flat`.
    pub rest_shape: RestShape,
    /// Thickness [m], for contact and for pictures.
    pub thickness: f64,
    /// Largest ratio of an edge's length to its rest length [1], above 1; inf: no limit. This is where the fabric
    /// stiffens because its yarns are straight; below it the fabric stretches by its stiffness. The collision stage
    /// holds every edge to it, whatever its direction: cloth of low shear stiffness stretches more on the bias and needs
    /// a higher limit. Wool has 1.06, wool-lycra 1.2, the other fabrics 1.05.
    pub stretch_limit: f64,
    /// Strain-rate damping [s]: viscous stress = this times stiffness times strain rate. It conserves
    /// both momenta. 0: none besides that of implicit Euler.
    pub stretch_damping: f64,
    /// Bending-rate damping [s]: viscous moment = this times stiffness times curvature rate. It
    /// conserves linear momentum; a bent sheet that spins as a whole is slowed, slightly.
    pub bend_damping: f64,
}

impl Default for ClothMaterial {
    /// [`ClothMaterial::cotton`].
    fn default() -> Self {
        Self::cotton()
    }
}

impl ClothMaterial {
    /// Names that [`Self::named`] knows.
    pub const NAMES: [&'static str; 6] = ["cotton", "wool", "wool-lycra", "polyester", "silk", "denim"];

    /// A homogeneous sheet: density [kg/m^2], Young's modulus [Pa], Poisson's ratio, thickness [m]. It has no stretch
    /// limit: nothing says where it would stiffen.
    pub fn from_young_modulus(density: f64, young_modulus: f64, poisson_ratio: f64, thickness: f64) -> Self {
        Self {
            density,
            stretch_stiffness: young_modulus * thickness,
            weft_stiffness: None,
            shear_stiffness: None,
            warp_direction: Vector::x(),
            poisson_ratio,
            bend_stiffness: young_modulus * thickness.powi(3)
                / (12.0 * (1.0 - poisson_ratio * poisson_ratio)),
            rest_shape: RestShape::Flat,
            thickness,
            stretch_limit: f64::INFINITY,
            stretch_damping: 0.0,
            bend_damping: 0.0,
        }
    }

    /// Plain-woven cotton: 0.1503 kg/m^2, 0.318 mm, 0.821 MPa, 0.243; stretch limit 1.05.
    ///
    /// Source of this one, [`Self::wool`], [`Self::wool_lycra`] and [`Self::polyester`]: weight,
    /// thickness, initial modulus and Poisson's ratio measured by Penava, Simic Penava and Knezic,
    /// "Determination of the Elastic Constants of Plain Woven Fabrics by a Tensile Test in Various
    /// Directions", Fibres & Textiles in Eastern Europe 22 (2014), tables 1 and 3, as simulation
    /// packages transcribe them. Bending is the homogeneous estimate, an engineering choice.
    ///
    /// Stretch limits are class values, rounded to a hundredth: 1 plus the strain EMT that the Kawabata system (KES-F)
    /// measures under 500 gf/cm = 490 N/m, mean of warp and weft, in fabrics of that kind. No such test of the very
    /// fabrics above is known. Cotton takes that of denim, which is of cellulose as well, see [`Self::denim`].
    pub fn cotton() -> Self {
        Self { stretch_limit: 1.05, ..Self::from_young_modulus(0.1503, 0.821e6, 0.243, 0.318e-3) }
    }

    /// Plain-woven wool: 0.2348 kg/m^2, 0.568 mm, 0.170 MPa, 0.277; stretch limit 1.06. Source: see
    /// [`Self::cotton`].
    ///
    /// Limit: the mean of 214 winter suitings, 0.26 kg/m^2, has LT = 0.6082 and log10 WT = 0.9621 (Kawabata, "The
    /// Standardization and Analysis of Hand Evaluation", 2nd ed., 1980, constants of equation KN-101-WINTER, as they are quoted;
    /// not checked against the book), hence EMT = 2 WT/(500 LT) = 6.0 %.
    pub fn wool() -> Self {
        Self { stretch_limit: 1.06, ..Self::from_young_modulus(0.2348, 0.170e6, 0.277, 0.568e-3) }
    }

    /// Plain-woven wool with lycra: 0.1782 kg/m^2, 0.328 mm, 0.076 MPa, 0.071; stretch limit 1.2. Source: see
    /// [`Self::cotton`].
    ///
    /// Limit: the lower end of "comfort stretch", the trade's word for woven fabrics with a little elastane that give 20
    /// to 30 %. A trade value, not a test of it.
    pub fn wool_lycra() -> Self {
        Self { stretch_limit: 1.2, ..Self::from_young_modulus(0.1782, 0.076e6, 0.071, 0.328e-3) }
    }

    /// Plain-woven polyester: 0.1646 kg/m^2, 0.252 mm, 0.478 MPa, 0.381; stretch limit 1.05. Source: see
    /// [`Self::cotton`].
    ///
    /// Limit: the mean of 156 summer suitings, 0.19 kg/m^2, has LT = 0.6286 and log10 WT = 0.8713 (Kawabata 1980 as for
    /// [`Self::wool`], equation KN-101-SUMMER), hence EMT = 4.7 %: a class of woven cloth as light, not of polyester in
    /// particular.
    pub fn polyester() -> Self {
        Self { stretch_limit: 1.05, ..Self::from_young_modulus(0.1646, 0.478e6, 0.381, 0.252e-3) }
    }

    /// A light silk. Engineering choices throughout: 60 g/m^2 is the trade weight of a 14 momme
    /// crepe de Chine; the stiffnesses place it below cotton in bending, above it in stretching
    /// per weight. The stretch limit 1.05 is that of light woven fabrics, see [`Self::polyester`]; no test of a silk
    /// stands behind it.
    pub fn silk() -> Self {
        Self {
            density: 0.060,
            stretch_stiffness: 200.0,
            poisson_ratio: 0.25,
            bend_stiffness: 0.5e-6,
            thickness: 0.15e-3,
            stretch_limit: 1.05,
            ..Self::cotton()
        }
    }

    /// A heavy denim; stretch limit 1.05. Engineering choices: 0.41 kg/m^2 is the trade weight of a 12 ounce
    /// denim; the stiffnesses place it well above cotton.
    ///
    /// Limit: six denims based on regenerated cellulose have EMT from 4.7 to 5.7 %, 5.2 % on average (Kumari and
    /// Khurana, "Regenerated Cellulose-Based Denim Fabric for Tropical Regions", Journal of Textiles 2016, 4614168,
    /// table 5).
    pub fn denim() -> Self {
        Self {
            density: 0.41,
            stretch_stiffness: 2000.0,
            poisson_ratio: 0.25,
            bend_stiffness: 30.0e-6,
            thickness: 0.8e-3,
            stretch_limit: 1.05,
            ..Self::cotton()
        }
    }

    /// The fabric of that name, one of [`Self::NAMES`].
    pub fn named(name: &str) -> Option<Self> {
        Some(match name {
            "cotton" => Self::cotton(),
            "wool" => Self::wool(),
            "wool-lycra" => Self::wool_lycra(),
            "polyester" => Self::polyester(),
            "silk" => Self::silk(),
            "denim" => Self::denim(),
            _ => return None,
        })
    }

    /// Checks every value.
    ///
    /// # Errors
    /// All that is wrong, by field name.
    pub fn validate(&self) -> Result<(), Vec<MaterialError>> {
        let mut errors = check(
            &[
                ("density", self.density, "kg/m2"),
                ("stretch_stiffness", self.stretch_stiffness, "N/m"),
                ("thickness", self.thickness, "m"),
            ],
            &[
                ("bend_stiffness", self.bend_stiffness, "N m"),
                ("stretch_damping", self.stretch_damping, "s"),
                ("bend_damping", self.bend_damping, "s"),
            ],
        );
        let optional = [("weft_stiffness", self.weft_stiffness), ("shear_stiffness", self.shear_stiffness)];
        for (field, value) in optional.into_iter().filter_map(|(field, value)| Some((field, value?))) {
            errors.extend(check(&[(field, value, "N/m")], &[]));
        }
        if self.stretch_limit.is_nan() || self.stretch_limit <= 1.0 {
            errors.push(MaterialError::StretchLimit { value: self.stretch_limit });
        }
        errors.extend(check(&[("warp_direction", self.warp_direction.norm(), "long")], &[]));
        if !(self.poisson_ratio > -1.0 && self.poisson_ratio < 1.0) {
            errors.push(MaterialError::PoissonRatio { value: self.poisson_ratio, range: "(-1, 1)" });
        }
        if errors.is_empty() { Ok(()) } else { Err(errors) }
    }

    /// Whether warp, weft and shear have stiffnesses of their own.
    pub fn is_woven(&self) -> bool {
        self.weft_stiffness.is_some() || self.shear_stiffness.is_some()
    }

    /// Stiffnesses along warp and weft, between them, and in shear.
    pub(crate) fn weave(&self) -> Weave {
        let (warp, nu) = (self.stretch_stiffness, self.poisson_ratio);
        let weft = self.weft_stiffness.unwrap_or(warp);
        let (mean, plane) = ((warp * weft).sqrt(), 1.0 / (1.0 - nu * nu));
        Weave {
            c11: warp * plane,
            c12: nu * mean * plane,
            c22: weft * plane,
            shear: self.shear_stiffness.unwrap_or(mean / (2.0 * (1.0 + nu))),
        }
    }

    /// Lame parameters of plane stress times thickness [N/m]: (lambda, mu).
    ///
    /// `mu = Et / (2 (1 + nu))`, `lambda = Et nu / (1 - nu^2)`; then a strip pulled along its length
    /// with free sides has stiffness Et exactly.
    pub fn lame(&self) -> (f64, f64) {
        let (stiffness, nu) = (self.stretch_stiffness, self.poisson_ratio);
        (stiffness * nu / (1.0 - nu * nu), stiffness / (2.0 * (1.0 + nu)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_name_gives_a_valid_material() {
        for name in ClothMaterial::NAMES {
            let material = ClothMaterial::named(name).expect(name);
            material.validate().expect(name);
        }
        assert_eq!(ClothMaterial::named("chain mail"), None);
    }

    #[test]
    fn every_fabric_has_a_limit_that_its_own_stiffness_stays_below_where_it_hangs() {
        let limits = ClothMaterial::NAMES.map(|name| ClothMaterial::named(name).expect(name).stretch_limit);
        assert_eq!(limits, [1.05, 1.06, 1.2, 1.05, 1.05, 1.05]);
        for name in ClothMaterial::NAMES {
            let material = ClothMaterial::named(name).expect(name);
            // Strain at the upper end of 2 m of it, from weight and stiffness.
            let strain = material.density * 9.81 * 2.0 / material.stretch_stiffness;
            assert!(strain < material.stretch_limit - 1.0, "{name} hangs from its limit: {strain}");
        }
        assert_eq!(ClothMaterial::from_young_modulus(1.0, 1e6, 0.3, 1e-3).stretch_limit, f64::INFINITY);
        for bad in [1.0, 0.5, f64::NAN, f64::NEG_INFINITY] {
            let material = ClothMaterial { stretch_limit: bad, ..ClothMaterial::cotton() };
            assert_eq!(material.validate().expect_err("bad").len(), 1, "{bad}");
        }
        ClothMaterial { stretch_limit: f64::INFINITY, ..ClothMaterial::cotton() }
            .validate()
            .expect("no limit");
    }

    #[test]
    fn all_bad_values_are_named() {
        let material = ClothMaterial {
            density: 0.0,
            stretch_stiffness: f64::NAN,
            bend_stiffness: -1.0,
            poisson_ratio: 1.0,
            weft_stiffness: Some(0.0),
            shear_stiffness: Some(-1.0),
            warp_direction: Vector::zeros(),
            stretch_limit: 1.0,
            ..ClothMaterial::cotton()
        };
        let errors = material.validate().expect_err("eight bad values");
        let text: Vec<String> = errors.iter().map(ToString::to_string).collect();
        for field in [
            "density",
            "stretch_stiffness",
            "bend_stiffness",
            "poisson_ratio",
            "weft_stiffness",
            "shear_stiffness",
            "warp_direction",
            "stretch_limit",
        ] {
            assert!(text.iter().any(|t| t.starts_with(field)), "{field} missing in {text:?}");
        }
        assert_eq!(errors.len(), 8);
    }

    #[test]
    fn a_material_survives_toml_and_unknown_keys_are_refused() {
        let material = ClothMaterial {
            weft_stiffness: Some(1500.0),
            rest_shape: RestShape::Initial,
            stretch_limit: f64::INFINITY,
            ..ClothMaterial::denim()
        };
        let text = toml::to_string(&material).expect("serialise");
        assert_eq!(toml::from_str::<ClothMaterial>(&text).expect("parse"), material);
        assert!(toml::from_str::<ClothMaterial>("densty = 1.0").is_err());
        // Keys left out take the default's values.
        let partial: ClothMaterial = toml::from_str("density = 0.5").expect("parse");
        assert_eq!(partial, ClothMaterial { density: 0.5, ..ClothMaterial::default() });
    }
}
