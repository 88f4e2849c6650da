//! Fabrics.

use super::checks::{non_negative, positive};
use super::rest_shape::RestShape;
use bowknot_errors::{Checks, Parameters};
use bowknot_geometry::Vector;
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

/// A woven or knitted sheet, linear in the rotated frame. It is isotropic, or has different stiffnesses along
/// warp, weft and in shear.
///
/// Forces do not depend on the thickness: stiffnesses are those of the sheet, per meter of its width. For a
/// homogeneous sheet with Young's modulus E they are `E t` and `E t^3 / (12 (1 - nu^2))`, see
/// [`ClothMaterial::from_young_modulus`]. The yarns of a fabric slide, so that it bends far more easily than
/// that.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields, default))]
pub struct ClothMaterial {
    /// Mass per area [kg/m^2]. Larger: heavier, slower to accelerate.
    pub density: f64,
    /// Young's modulus times thickness [N/m]; along the warp if `weft_stiffness` is given. Larger: stretches
    /// less; the linear solve takes more iterations, about in proportion to the square root. 0, without
    /// stiffnesses of weft and shear: the cloth resists bending alone, for custom elements in place of its
    /// membrane.
    pub stretch_stiffness: f64,
    /// Young's modulus times thickness along the weft [N/m], across `warp_direction`. Default: that along the
    /// warp.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub weft_stiffness: Option<f64>,
    /// Shear modulus times thickness [N/m]: force per width and angle between warp and weft. Woven cloth
    /// shears 10 to 100 times more easily than it stretches. Default: sqrt(warp weft)/(2 (1 + nu)), isotropic
    /// if warp and weft are equal.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub shear_stiffness: Option<f64>,
    /// Direction of the warp in the rest state [1], projected into each triangle. It is used only with a weft
    /// or shear stiffness. Default (1, 0, 0).
    pub warp_direction: Vector,
    /// Poisson's ratio of the membrane [1], in (-1, 1): how much it narrows when it is stretched. With
    /// different stiffnesses along warp and weft, the geometric mean of both ratios.
    pub poisson_ratio: f64,
    /// Bending stiffness D [N m]: moment per width and curvature of a strip with free sides. Larger: wider
    /// folds.
    pub bend_stiffness: f64,
    /// Shape without bending energy: `flat`, or `initial`, the curved shape that the body has at the start.
    /// Default `flat`.
    pub rest_shape: RestShape,
    /// Thickness [m], for contact and for pictures.
    pub thickness: f64,
    /// Largest ratio of an edge's length to its rest length [1], above 1; inf: no limit. At this ratio the
    /// yarns of the fabric are straight and it stiffens; below, the fabric stretches according to its
    /// stiffness. The collision stage enforces the limit on every edge, whatever its direction: cloth of low
    /// shear stiffness stretches more on the bias and needs a higher limit. Wool has 1.06, wool-lycra 1.2,
    /// the other fabrics 1.05.
    pub stretch_limit: f64,
    /// Strain-rate damping [s]: viscous stress = this times stiffness times strain rate. It conserves linear
    /// and angular momentum. 0: no damping but that of implicit Euler.
    pub stretch_damping: f64,
    /// Bending-rate damping [s]: viscous moment = this times stiffness times curvature rate. It conserves
    /// linear momentum, but slightly slows a bent sheet that spins as a whole.
    pub bend_damping: f64,
}

impl Default for ClothMaterial {
    /// [`ClothMaterial::cotton`].
    fn default() -> Self {
        Self::cotton()
    }
}

impl ClothMaterial {
    /// The names that [`Self::named`] accepts.
    pub const NAMES: [&'static str; 6] = ["cotton", "wool", "wool-lycra", "polyester", "silk", "denim"];

    /// A homogeneous sheet: density [kg/m^2], Young's modulus [Pa], Poisson's ratio, thickness [m]. It has no
    /// stretch limit, as these numbers do not say where it stiffens.
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
    /// Source of cotton, [`Self::wool`], [`Self::wool_lycra`] and [`Self::polyester`]: weight,
    /// thickness, initial modulus and Poisson's ratio measured by Penava, Simic Penava and Knezic,
    /// "Determination of the Elastic Constants of Plain Woven Fabrics by a Tensile Test in Various
    /// Directions", Fibres & Textiles in Eastern Europe 22 (2014), tables 1 and 3, as simulation
    /// packages transcribe them. Bending is the homogeneous estimate, an engineering choice.
    ///
    /// Stretch limits are class values, rounded to a hundredth: 1 plus the strain EMT that the Kawabata
    /// system (KES-F) measures under 500 gf/cm = 490 N/m, mean of warp and weft, in fabrics of that kind. No
    /// such test of exactly these fabrics is known. Cotton takes the limit of denim, which is of cellulose as
    /// well, see [`Self::denim`].
    pub fn cotton() -> Self {
        Self { stretch_limit: 1.05, ..Self::from_young_modulus(0.1503, 0.821e6, 0.243, 0.318e-3) }
    }

    /// Plain-woven wool: 0.2348 kg/m^2, 0.568 mm, 0.170 MPa, 0.277; stretch limit 1.06. Source: see
    /// [`Self::cotton`].
    ///
    /// Limit: the mean of 214 winter suitings, 0.26 kg/m^2, has LT = 0.6082 and log10 WT = 0.9621 (Kawabata,
    /// "The Standardization and Analysis of Hand Evaluation", 2nd ed., 1980, constants of equation
    /// KN-101-WINTER, as they are quoted; not checked against the book), hence EMT = 2 WT/(500 LT) = 6.0 %.
    pub fn wool() -> Self {
        Self { stretch_limit: 1.06, ..Self::from_young_modulus(0.2348, 0.170e6, 0.277, 0.568e-3) }
    }

    /// Plain-woven wool with lycra: 0.1782 kg/m^2, 0.328 mm, 0.076 MPa, 0.071; stretch limit 1.2. Source: see
    /// [`Self::cotton`].
    ///
    /// Limit: the lower end of "comfort stretch", the trade's word for woven fabrics with a little elastane
    /// that stretch by 20 to 30 %. It is a trade value, not a measurement.
    pub fn wool_lycra() -> Self {
        Self { stretch_limit: 1.2, ..Self::from_young_modulus(0.1782, 0.076e6, 0.071, 0.328e-3) }
    }

    /// Plain-woven polyester: 0.1646 kg/m^2, 0.252 mm, 0.478 MPa, 0.381; stretch limit 1.05. Source: see
    /// [`Self::cotton`].
    ///
    /// Limit: the mean of 156 summer suitings, 0.19 kg/m^2, has LT = 0.6286 and log10 WT = 0.8713 (Kawabata
    /// 1980 as for [`Self::wool`], equation KN-101-SUMMER), hence EMT = 4.7 %: a class of woven cloth as
    /// light, not of polyester in particular.
    pub fn polyester() -> Self {
        Self { stretch_limit: 1.05, ..Self::from_young_modulus(0.1646, 0.478e6, 0.381, 0.252e-3) }
    }

    /// A light silk. Engineering choices throughout: 60 g/m^2 is the trade weight of a 14 momme crepe de
    /// Chine; the stiffnesses place it below cotton in bending, above it in stretching per weight. The
    /// stretch limit 1.05 is that of light woven fabrics, see [`Self::polyester`]; no silk was tested for it.
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
    /// Limit: six denims based on regenerated cellulose have EMT from 4.7 to 5.7 %, 5.2 % on average (Kumari
    /// and Khurana, "Regenerated Cellulose-Based Denim Fabric for Tropical Regions", Journal of Textiles
    /// 2016, 4614168, table 5).
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

    /// Whether it has a weft or shear stiffness of its own.
    pub fn is_woven(&self) -> bool {
        self.weft_stiffness.is_some() || self.shear_stiffness.is_some()
    }

    /// Lame parameters of plane stress times thickness [N/m]: (lambda, mu).
    ///
    /// `mu = Et / (2 (1 + nu))`, `lambda = Et nu / (1 - nu^2)`. A strip that is pulled along its length with
    /// free sides then has the stiffness Et exactly.
    pub fn lame(&self) -> (f64, f64) {
        let (stiffness, nu) = (self.stretch_stiffness, self.poisson_ratio);
        (stiffness * nu / (1.0 - nu * nu), stiffness / (2.0 * (1.0 + nu)))
    }
}

impl Parameters for ClothMaterial {
    fn check(&self, checks: &mut Checks) {
        let Self {
            density,
            stretch_stiffness,
            weft_stiffness,
            shear_stiffness,
            warp_direction,
            poisson_ratio,
            bend_stiffness,
            rest_shape: _,
            thickness,
            stretch_limit,
            stretch_damping,
            bend_damping,
        } = *self;
        positive(checks, &[("density", density, "kg/m2")]);
        non_negative(checks, &[("stretch_stiffness", stretch_stiffness, "N/m")]);
        checks.require(
            !self.is_woven() || stretch_stiffness != 0.0,
            "stretch_stiffness",
            format!("{stretch_stiffness} N/m"),
            "must be above 0 where weft_stiffness or shear_stiffness is given",
        );
        let optional = [("weft_stiffness", weft_stiffness), ("shear_stiffness", shear_stiffness)];
        for (field, value) in optional.into_iter().filter_map(|(field, value)| Some((field, value?))) {
            positive(checks, &[(field, value, "N/m")]);
        }
        let length = warp_direction.norm();
        let fits = length > 0.0 && length.is_finite();
        checks.require(
            fits,
            "warp_direction",
            format!("{:?}", warp_direction.as_slice()),
            "must be finite and not zero",
        );
        checks.between("poisson_ratio", poisson_ratio, -1.0, 1.0);
        non_negative(checks, &[("bend_stiffness", bend_stiffness, "N m")]);
        positive(checks, &[("thickness", thickness, "m")]);
        checks.above_or_infinite("stretch_limit", stretch_limit, 1.0);
        non_negative(
            checks,
            &[("stretch_damping", stretch_damping, "s"), ("bend_damping", bend_damping, "s")],
        );
    }
}

#[cfg(test)]
mod tests;
