//! Parameters of the contact and edge-length constraints.

use serde::{Deserialize, Serialize};

/// Largest ratio of an edge's length to its reference [1] where neither a body nor
/// [`ConstraintParams::stretch_limit`] gives one.
pub const STRETCH_LIMIT: f64 = 1.1;

/// Parameters of the constraints.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ConstraintParams {
    /// Distance [m] that contacts are separated to, delta. Default a tenth of the mean edge length.
    /// Larger: faster, rounder contacts with a visible gap; smaller: tighter and slower.
    pub delta: Option<f64>,
    /// Distance within which a pair is listed and becomes a contact row, in `delta`. Larger: contacts are seen
    /// earlier; pairs multiply with its square. Default 2 (paper: 4).
    pub range: f64,
    /// Predicted gap below which a row is swept, in `delta`. Larger: more rows for few steps less. Default 1.1.
    pub active: f64,
    /// Speed [m/s] at which pairs that start nearer than `delta` are separated; the default is 20 `delta` a second.
    /// Larger: tight starts open faster and fling the cloth.
    pub separation_speed: Option<f64>,
    /// Whether rows are made of contacts alone, pairs whose normal lies in the normal cones of both features, and not of all
    /// that are near: those ahead of a vertex that slides on a mesh are walls in its way. Default true (paper: false).
    pub contacts_only: bool,
    /// Form of the contact constraint. Default gap.
    pub form: ContactForm,
    /// How friction acts where bodies have it: `coulomb`, within the backward step; `filter`, on the target before each
    /// call as in the paper, cheaper and coarser; or `none`. Without coefficients of friction all three cost nothing.
    /// Default coulomb.
    pub friction_model: FrictionModel,
    /// Whether edge lengths are limited at all. Default true.
    pub edges: bool,
    /// Largest ratio of an edge's length to its reference, sigma, of every body that has none of its own. Default: that of
    /// the body's material if it is a cloth, otherwise 1.1 (paper: 1.1 for all).
    pub stretch_limit: Option<f64>,
    /// What an edge's reference is. Default rest.
    pub edge_reference: EdgeReference,
    /// How an edge's limit is solved. Default ball.
    pub edge_form: EdgeForm,
}

/// Form of the contact constraint.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ContactForm {
    /// Signed distance along the normal: c = n . (p - q) - delta.
    Gap,
    /// Volume of the pair against that of the separated pair (paper, Eq. 14-16), in units of length;
    /// falls back to the gap where the closest features are not the interiors.
    Volume,
    /// Distance along the triangle's normal or the edges' common normal, wherever the closest features are (Harmon et al.
    /// 2008; Tang et al. 2018): a wall beside the primitive as well as above it. To compare with.
    Face,
}

/// How friction acts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum FrictionModel {
    /// Coulomb's law in every backward step: tangential multipliers bounded by mu times the normal's, solved with it.
    Coulomb,
    /// The velocity filter of Bridson et al. 2002 (paper, section 6.3): penetration depths at the target estimate the
    /// normal impulses, and the target's slip is reduced by mu times them before collisions are handled.
    Filter,
    /// None.
    None,
}

/// Reference length of an edge's limit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum EdgeReference {
    /// The length at the start of the call (paper, Eq. 17).
    Start,
    /// L = max(sigma * rest, 0.97 * length at the start).
    Rest,
}

/// How an edge's limit is solved.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum EdgeForm {
    /// A row linearised at the current state (paper, Eq. 17).
    Linear,
    /// The convex ball |y_a - y_b| <= L with a vector multiplier, nothing to linearise.
    Ball,
}

impl Default for ConstraintParams {
    fn default() -> Self {
        Self {
            delta: None,
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

impl ConstraintParams {
    /// As the paper has it.
    pub fn paper() -> Self {
        Self {
            range: 4.0,
            contacts_only: false,
            form: ContactForm::Volume,
            friction_model: FrictionModel::Filter,
            stretch_limit: Some(STRETCH_LIMIT),
            edge_reference: EdgeReference::Start,
            edge_form: EdgeForm::Linear,
            ..Self::default()
        }
    }

    /// Appends a line for each field out of its range.
    pub fn validate(&self, problems: &mut Vec<String>) {
        let mut check = |ok: bool, message: String| {
            if !ok {
                problems.push(message);
            }
        };
        for (key, value) in
            [("constraints.delta", self.delta), ("constraints.separation_speed", self.separation_speed)]
        {
            if let Some(value) = value {
                check(
                    value.is_finite() && value > 0.0,
                    format!("{key} = {value} must be finite and above 0"),
                );
            }
        }
        check(
            self.range.is_finite() && self.range >= 1.0,
            format!("constraints.range = {} must be finite and at least 1", self.range),
        );
        check(
            self.active.is_finite() && self.active >= 1.0,
            format!("constraints.active = {} must be finite and at least 1", self.active),
        );
        if let Some(limit) = self.stretch_limit {
            check(
                limit.is_finite() && limit > 1.0,
                format!("constraints.stretch_limit = {limit} must be finite and above 1"),
            );
        }
    }
}
