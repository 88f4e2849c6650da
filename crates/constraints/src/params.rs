//! Parameters of contacts and edge-length limits.

use bowknot_errors::{Checks, Parameters};
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

/// Largest ratio of an edge's length to its reference [1] where neither a body nor
/// [`ContactParams::stretch_limit`] gives one.
pub const STRETCH_LIMIT: f64 = 1.1;

/// Parameters of contacts and edge-length limits.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields, default))]
pub struct ContactParams {
    /// Contact distance of contacts [m], delta. Default a tenth of the mean edge length. Larger: faster,
    /// rounder contacts with a visible gap; smaller: tighter contacts, more steps.
    pub delta: Option<f64>,
    /// Minimum separation [m], xi: a step leaves this gap, or a tenth of the gap that the pair may have after it if
    /// that is less. So small gaps can shrink from step to step; with a `thickness` of the bodies they do not. Default
    /// a tenth of `delta`; 0 switches it off, so that gaps are bounded by rounding alone. Refused below 16 ulp of the
    /// largest coordinate.
    pub min_separation: Option<f64>,
    /// Distance within which a pair is a candidate and becomes a contact row, in `delta`. Larger: contacts
    /// are found earlier, and the number of pairs grows with its square. Default 2 (paper: 4).
    pub range: f64,
    /// Predicted gap below which the solver sweeps a row, in `delta`. Larger: more rows, slightly fewer
    /// steps. Default 1.1.
    pub active: f64,
    /// Speed [m/s] at which pairs are separated that start closer than `delta`. Default 20 `delta` per
    /// second. Larger: pairs that start close open faster, and the cloth is thrown; inf: at once (paper).
    pub separation_speed: Option<f64>,
    /// Whether only contacts become rows: pairs whose normal lies in the normal cones of both features. If
    /// false, all pairs in range do; the rows of those ahead of a vertex that slides on a mesh block its way.
    /// Default true (paper: false).
    pub contacts_only: bool,
    /// Form of the contact constraint. Default gap.
    pub form: ContactForm,
    /// How friction acts where bodies have it: `coulomb`, in the backward step; `filter`, on the target
    /// before each call as in the paper, cheaper and less accurate; or `none`. Without coefficients of
    /// friction all three cost nothing. Default coulomb.
    pub friction_model: FrictionModel,
    /// Whether edge lengths are limited at all. Default true.
    pub edges: bool,
    /// Largest ratio of an edge's length to its reference length, sigma, for every body without its own;
    /// above 1, inf: no limit. Default: the limit of the body's material if it is a cloth, none for solids,
    /// otherwise 1.1 (paper: 1.1 for all).
    pub stretch_limit: Option<f64>,
    /// The reference length of an edge. Default rest.
    pub edge_reference: EdgeReference,
    /// How an edge's limit is solved. Default ball.
    pub edge_form: EdgeForm,
}

/// Form of the contact constraint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum ContactForm {
    /// Signed distance along the normal: c = n . (p - q) - delta.
    Gap,
    /// Volume of the pair less that of the separated pair (paper, Eq. 14-16), in units of length. It
    /// falls back to the gap form where the closest features are not the interiors.
    Volume,
    /// Distance along the triangle's normal or the edges' common normal, wherever the closest features are
    /// (Harmon et al. 2008; Tang et al. 2018). It also constrains vertices that pass beside the primitive.
    /// For comparison.
    Face,
}

/// How friction acts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum FrictionModel {
    /// Coulomb's law in every backward step: tangential multipliers are at most mu times the normal's and
    /// solved with it.
    Coulomb,
    /// The velocity filter of Bridson et al. 2002 (paper, section 6.3): penetration depths at the target
    /// estimate the normal impulses, and the target's slip is reduced by mu times them before collisions are
    /// handled.
    Filter,
    /// No friction.
    None,
}

/// Reference length of an edge's limit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum EdgeReference {
    /// The length at the start of the call (paper, Eq. 17).
    Start,
    /// L = max(sigma * rest, 0.97 * length at the start).
    Rest,
}

/// How an edge's limit is solved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum EdgeForm {
    /// A row linearized at the current state (paper, Eq. 17).
    Linear,
    /// The convex ball |y_a - y_b| <= L with a vector multiplier, without linearization.
    Ball,
}

impl Default for ContactParams {
    fn default() -> Self {
        Self {
            delta: None,
            min_separation: None,
            range: 2.0,
            active: 1.1,
            separation_speed: None,
            contacts_only: true,
            form: ContactForm::Gap,
            friction_model: FrictionModel::Coulomb,
            edges: true,
            stretch_limit: None,
            edge_reference: EdgeReference::Rest,
            edge_form: EdgeForm::Ball,
        }
    }
}

impl ContactParams {
    /// The values of the paper.
    pub fn paper() -> Self {
        Self {
            min_separation: Some(0.0),
            range: 4.0,
            separation_speed: Some(f64::INFINITY),
            contacts_only: false,
            form: ContactForm::Volume,
            friction_model: FrictionModel::Filter,
            stretch_limit: Some(STRETCH_LIMIT),
            edge_reference: EdgeReference::Start,
            edge_form: EdgeForm::Linear,
            ..Self::default()
        }
    }
}

impl Parameters for ContactParams {
    fn check(&self, checks: &mut Checks) {
        if let Some(delta) = self.delta {
            checks.positive("delta", delta);
        }
        if let Some(min_separation) = self.min_separation {
            checks.non_negative("min_separation", min_separation);
        }
        checks.at_least("range", self.range, 1.0);
        checks.at_least("active", self.active, 1.0);
        if let Some(speed) = self.separation_speed {
            checks.above_or_infinite("separation_speed", speed, 0.0);
        }
        if let Some(limit) = self.stretch_limit {
            checks.above_or_infinite("stretch_limit", limit, 1.0);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_number_must_be_in_range_and_nan_is_refused() {
        assert!(ContactParams::default().validate().is_ok() && ContactParams::paper().validate().is_ok());
        type Set = fn(&mut ContactParams, f64);
        let fields: [(&str, Set); 4] = [
            ("delta", |p, value| p.delta = Some(value)),
            ("min_separation", |p, value| p.min_separation = Some(value)),
            ("range", |p, value| p.range = value),
            ("active", |p, value| p.active = value),
        ];
        for (path, set) in fields {
            for value in [f64::NAN, f64::INFINITY, -1.0] {
                let mut params = ContactParams::default();
                set(&mut params, value);
                let errors = params.validate().expect_err(path);
                assert_eq!((errors.len(), errors[0].path.as_str()), (1, path), "{value}");
            }
        }
        let limited = |limit| ContactParams { stretch_limit: Some(limit), ..ContactParams::default() };
        for limit in [f64::NAN, -1.0, 1.0] {
            let errors = limited(limit).validate().expect_err("out of range");
            assert_eq!((errors.len(), errors[0].path.as_str()), (1, "stretch_limit"), "{limit}");
        }
        assert!(limited(f64::INFINITY).validate().is_ok(), "no limit");
        let separating = |speed| ContactParams { separation_speed: Some(speed), ..ContactParams::default() };
        for speed in [f64::NAN, -1.0, 0.0] {
            let errors = separating(speed).validate().expect_err("out of range");
            assert_eq!((errors.len(), errors[0].path.as_str()), (1, "separation_speed"), "{speed}");
        }
        assert!(separating(f64::INFINITY).validate().is_ok(), "at once");
    }
}
