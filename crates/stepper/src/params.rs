//! Parameters of the forward step and of the trust regions.

use bowknot_errors::{Checks, Parameters};
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

/// Parameters of the forward step.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields, default))]
pub struct ForwardParams {
    /// The bound that limits the vertices. Default planes.
    pub bound: Bound,
    /// Share of a pair's gap that one step may use up, the paper's gamma. Closer to 1: longer steps that
    /// leave smaller gaps. Default 0.9.
    pub damping: f64,
    /// How far vertices may travel between two searches. Default per-vertex.
    pub trust_region: TrustRegionRule,
    /// Smallest radius of a trust region: in local edge lengths for `per-vertex` (default 0.1; with smaller
    /// ones pairs are searched more often), in `delta` for `uniform` (D_min/2; paper: 2 delta / 2).
    pub trust_region_min: f64,
    /// Longest travel of a vertex in a step, in local edge lengths, for `per-vertex` (default 0.35; larger
    /// ones find many more pairs); radius of the trust regions, in `delta`, for `uniform` (paper: D_max/2 =
    /// 4 delta / 2).
    pub trust_region_max: f64,
    /// Wanted travel, in mean edge lengths, above which the search follows the vertices along their paths
    /// while no contact presses. Larger: more steps in free flight. `inf` switches it off. Default 0.6.
    pub swept_travel: f64,
}

/// The bound that keeps steps safe.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum Bound {
    /// Half of the smallest distance, whatever the direction (paper, Eq. 18-20).
    Isotropic,
    /// Each side stays on its side of a certified separating slab; only closing motion is limited.
    Planes,
}

/// The rule for the distance that vertices may travel between two searches.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum TrustRegionRule {
    /// One distance for all vertices: the next search is due when the fastest vertex has used it up (paper,
    /// Algorithm 1).
    Uniform,
    /// One ball per vertex, about the path that the vertex wants to take.
    PerVertex,
}

impl Default for ForwardParams {
    fn default() -> Self {
        Self {
            bound: Bound::Planes,
            damping: 0.9,
            trust_region: TrustRegionRule::PerVertex,
            trust_region_min: 0.1,
            trust_region_max: 0.35,
            swept_travel: 0.6,
        }
    }
}

impl ForwardParams {
    /// The values of the paper.
    pub fn paper() -> Self {
        Self {
            bound: Bound::Isotropic,
            trust_region: TrustRegionRule::Uniform,
            trust_region_min: 1.0,
            trust_region_max: 2.0,
            swept_travel: f64::INFINITY,
            ..Self::default()
        }
    }
}

impl Parameters for ForwardParams {
    fn check(&self, checks: &mut Checks) {
        checks.between("damping", self.damping, 0.0, 1.0);
        checks.positive("trust_region_min", self.trust_region_min);
        checks.require(
            self.trust_region_max.is_finite() && self.trust_region_max >= self.trust_region_min,
            "trust_region_max",
            self.trust_region_max,
            "must be finite and at least trust_region_min",
        );
        checks.above_or_infinite("swept_travel", self.swept_travel, 0.0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_number_must_be_in_range_and_nan_is_refused() {
        assert!(ForwardParams::default().validate().is_ok() && ForwardParams::paper().validate().is_ok());
        type Field = fn(&mut ForwardParams) -> &mut f64;
        let fields: [(&str, Field); 4] = [
            ("damping", |p| &mut p.damping),
            ("trust_region_min", |p| &mut p.trust_region_min),
            ("trust_region_max", |p| &mut p.trust_region_max),
            ("swept_travel", |p| &mut p.swept_travel),
        ];
        for (path, field) in fields {
            for value in [f64::NAN, -1.0] {
                let mut params = ForwardParams::default();
                *field(&mut params) = value;
                let errors = params.validate().expect_err(path);
                assert!(errors.iter().any(|error| error.path == path), "{path} = {value}: {errors}");
            }
        }
    }
}
