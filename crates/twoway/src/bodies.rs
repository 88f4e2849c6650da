//! Contact data of bodies and half-spaces: thickness, contact distance, friction, stretch limit.
//!
//! A pair with sides a and b has:
//! - a *minimum separation* xi_p, below which no step closes its gap: the mean of both sides' thicknesses, if
//!   at least one side has one. A side without a thickness counts as 0 if it is a half-space, and with the
//!   scene's minimum separation otherwise;
//! - a *contact distance* delta_p: the mean of both sides' `delta`. A side without one counts with the
//!   scene's delta, and a side's delta is at least [`crate::MIN_SEPARATION_MARGIN`] times its thickness. For
//!   a grain, `delta` is its diameter: the mean of two diameters is the sum of two radii;
//! - a *coefficient of friction* mu: the geometric mean of both coefficients, unless the pair of bodies has
//!   its own.

use crate::error::ResolveError;
use bowknot_errors::{Checks, Parameters};
use bowknot_geometry::PairKind;
use bowknot_proximity::{CollisionModel, Pair};
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

/// Contact data of a body.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields, default))]
pub struct BodyContact {
    /// Guaranteed smallest gap [m] to a body of the same thickness: the minimum separation of a pair is the
    /// mean of both sides'. None: the minimum separation of the scene.
    pub thickness: Option<f64>,
    /// Contact distance [m] of contacts with a body of the same `delta`, the grain size of particles. A pair
    /// has the mean of both sides'. None: `delta` of the scene.
    pub delta: Option<f64>,
    /// Coefficient of Coulomb friction [1], at least 0. A pair has the geometric mean of both sides'. 0, the
    /// default: no friction, at no cost.
    pub friction: f64,
    /// Largest ratio of an edge's length to its reference length, above 1. Infinite: no limit and no rows.
    /// None: `contact.stretch_limit`, or [`bowknot_constraints::STRETCH_LIMIT`] if that is none as well.
    pub stretch_limit: Option<f64>,
}

/// Contact data of a half-space.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields, default))]
pub struct HalfSpaceContact {
    /// As [`BodyContact::thickness`]. None: 0 against a body with a thickness, so that the gap between body
    /// and plane is at least half of the body's thickness; the scene's minimum separation against others.
    pub thickness: Option<f64>,
    /// As [`BodyContact::friction`].
    pub friction: f64,
}

/// One side of a [`PairFriction`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum ContactSide {
    /// A body of the collision model, obstacles included.
    Body(u32),
    /// A half-space of the collision model.
    HalfSpace(u32),
}

/// Coefficient of friction between two bodies, in place of the mean of their own.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct PairFriction {
    /// The two sides, in any order. The same body twice stands for its contacts with itself.
    pub sides: [ContactSide; 2],
    /// Coefficient of Coulomb friction [1], at least 0.
    pub friction: f64,
}

/// Contact data of a scene. A list without entries stands for defaults throughout.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ContactData {
    /// One entry per body of the collision model, obstacles included.
    pub bodies: Vec<BodyContact>,
    /// One entry per half-space of the collision model.
    pub half_spaces: Vec<HalfSpaceContact>,
    /// Coefficients of friction of pairs of bodies, in place of the means of both sides'.
    pub pairs: Vec<PairFriction>,
}

/// Checked contact data of all bodies and half-spaces.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ContactTable {
    bodies: Vec<BodyContact>,
    half_spaces: Vec<HalfSpaceContact>,
    /// Coefficients of pairs by sorted sides, ascending.
    pairs: Vec<([ContactSide; 2], f64)>,
    frictional: bool,
}

impl ContactTable {
    /// The table of a scene.
    ///
    /// # Errors
    /// [`ResolveError::Contact`] with every entry out of its range, a wrong number of entries, a side of a
    /// pair that does not exist, a pair that is named twice.
    pub(crate) fn new(model: &CollisionModel, data: ContactData) -> Result<Self, ResolveError> {
        let mut checks = Checks::default();
        let bodies = one_each(&mut checks, "bodies", data.bodies, model.bodies().len());
        let half_spaces = one_each(&mut checks, "half_spaces", data.half_spaces, model.half_spaces().len());
        let pairs = sorted_pairs(&mut checks, &data.pairs, [bodies.len(), half_spaces.len()]);
        checks.finish().map_err(ResolveError::Contact)?;
        let frictional =
            bodies.iter().any(|b| b.friction > 0.0) || pairs.iter().any(|(_, friction)| *friction > 0.0);
        Ok(Self { bodies, half_spaces, pairs, frictional })
    }

    /// One entry per body.
    pub fn bodies(&self) -> &[BodyContact] {
        &self.bodies
    }

    /// One entry per half-space.
    pub fn half_spaces(&self) -> &[HalfSpaceContact] {
        &self.half_spaces
    }

    /// Whether any pair may have friction.
    pub fn frictional(&self) -> bool {
        self.frictional
    }

    /// Coefficients of friction [1] that pairs of sides have of their own, sorted by the sides.
    pub fn pair_frictions(&self) -> &[([ContactSide; 2], f64)] {
        &self.pairs
    }

    /// Coefficient of friction between two sides [1].
    pub fn friction(&self, a: ContactSide, b: ContactSide) -> f64 {
        if !self.frictional {
            return 0.0;
        }
        let sides = sorted([a, b]);
        match self.pairs.binary_search_by(|(other, _)| other.cmp(&sides)) {
            Ok(found) => self.pairs[found].1,
            Err(_) => (self.friction_of(a) * self.friction_of(b)).sqrt(),
        }
    }

    /// Coefficient of friction of a pair [1].
    pub fn friction_of_pair(&self, model: &CollisionModel, kind: PairKind, pair: &Pair) -> f64 {
        if !self.frictional {
            return 0.0;
        }
        let body = |place: usize| ContactSide::Body(model.vertex_body()[pair.vertices[place] as usize]);
        let other = match kind {
            PairKind::VertexHalfSpace => ContactSide::HalfSpace(pair.elements[1]),
            _ => body(kind.side_a()),
        };
        self.friction(body(0), other)
    }

    fn friction_of(&self, side: ContactSide) -> f64 {
        match side {
            ContactSide::Body(b) => self.bodies[b as usize].friction,
            ContactSide::HalfSpace(h) => self.half_spaces[h as usize].friction,
        }
    }
}

impl Parameters for BodyContact {
    fn check(&self, checks: &mut Checks) {
        if let Some(thickness) = self.thickness {
            checks.non_negative("thickness", thickness);
        }
        if let Some(delta) = self.delta {
            checks.positive("delta", delta);
        }
        checks.non_negative("friction", self.friction);
        if let Some(limit) = self.stretch_limit {
            checks.above_or_infinite("stretch_limit", limit, 1.0);
        }
    }
}

impl Parameters for HalfSpaceContact {
    fn check(&self, checks: &mut Checks) {
        if let Some(thickness) = self.thickness {
            checks.non_negative("thickness", thickness);
        }
        checks.non_negative("friction", self.friction);
    }
}

impl Parameters for PairFriction {
    fn check(&self, checks: &mut Checks) {
        checks.non_negative("friction", self.friction);
    }
}

fn sorted(mut sides: [ContactSide; 2]) -> [ContactSide; 2] {
    sides.sort_unstable();
    sides
}

/// The entries that are given, one for each body or half-space of the model; defaults if none are given.
fn one_each<T: Parameters + Clone + Default>(
    checks: &mut Checks,
    what: &str,
    given: Vec<T>,
    count: usize,
) -> Vec<T> {
    if given.is_empty() {
        return vec![T::default(); count];
    }
    let allowed = format!("must be {count}, one per entry of the model, or 0");
    checks.require(given.len() == count, &format!("{what}.len()"), given.len(), allowed);
    for (index, entry) in given.iter().enumerate() {
        checks.within(&format!("{what}[{index}]"), entry);
    }
    given
}

/// Coefficients of friction by sorted sides, ascending, of so many bodies and half-spaces.
fn sorted_pairs(
    checks: &mut Checks,
    pairs: &[PairFriction],
    [bodies, half_spaces]: [usize; 2],
) -> Vec<([ContactSide; 2], f64)> {
    let mut entries: Vec<([ContactSide; 2], f64)> = Vec::new();
    for (index, pair) in pairs.iter().enumerate() {
        let path = format!("friction_pairs[{index}]");
        checks.within(&path, pair);
        for side in pair.sides {
            let (what, given, known) = match side {
                ContactSide::Body(b) => ("body", b, bodies),
                ContactSide::HalfSpace(h) => ("half-space", h, half_spaces),
            };
            checks.require(
                (given as usize) < known,
                &format!("{path}.sides"),
                format!("{what} {given}"),
                format!("must be below {known}, the number of them"),
            );
        }
        let sides = sorted(pair.sides);
        checks.require(
            entries.iter().all(|(other, _)| *other != sides),
            &format!("{path}.sides"),
            format!("{:?}", pair.sides),
            "must differ from the sides of other pairs",
        );
        entries.push((sides, pair.friction));
    }
    entries.sort_by_key(|entry| entry.0);
    entries
}

#[cfg(test)]
mod tests;
