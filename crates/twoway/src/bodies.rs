//! What each body brings into its contacts: thickness, contact distance, friction, stretch limit.
//!
//! Of a pair, with sides a and b:
//! - *floor* xi_p, the gap below which no step closes it: the mean of both sides' thicknesses, where at least one is
//!   given, a side without one counting as 0 if it is a half-space and as the scene's floor otherwise;
//! - *desired distance* delta_p: the mean of both sides' `delta`, a side without one counting as the scene's delta,
//!   and never less than [`FLOOR_MARGIN`] times the floor. For a grain, `delta` is its diameter: the mean of two
//!   diameters is the sum of two radii;
//! - *friction* mu: the geometric mean of both coefficients, unless the pair of bodies has its own.

use crate::ResolveError;
use bowknot_geometry::PairKind;
use bowknot_proximity::{CollisionModel, Pair};
use serde::{Deserialize, Serialize};

/// What one body brings into its contacts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct BodyContact {
    /// Guaranteed smallest gap [m] to a body of the same thickness: the floor of a pair is the mean of both sides'.
    /// None: the floor of the scene.
    pub thickness: Option<f64>,
    /// Distance [m] that contacts with a body alike are separated to, the grain size of particles; a pair takes the
    /// mean of both sides'. None: `delta` of the scene.
    pub delta: Option<f64>,
    /// Coefficient of Coulomb friction [1], at least 0; a pair takes the geometric mean of both sides'. 0, the
    /// default: none, at no cost.
    pub friction: f64,
    /// Largest ratio of an edge's length to its reference, above 1; infinite: none, and no rows. None:
    /// `constraints.stretch_limit`, or [`bowknot_constraints::STRETCH_LIMIT`] where that is none either.
    pub stretch_limit: Option<f64>,
}

/// What one half-space brings into its contacts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct HalfSpaceContact {
    /// As [`BodyContact::thickness`]. None: 0 against a body with a thickness, so that the body keeps half of
    /// its own from the plane; the scene's floor against others.
    pub thickness: Option<f64>,
    /// As [`BodyContact::friction`].
    pub friction: f64,
}

/// One side of a [`PairFriction`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ContactSide {
    /// A body of the collision model, obstacles included.
    Body(u32),
    /// A half-space of the collision model.
    HalfSpace(u32),
}

/// A coefficient of friction between two bodies, in place of the mean of their own.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PairFriction {
    /// The two sides, in any order; twice the same body for its contacts with itself.
    pub sides: [ContactSide; 2],
    /// Coefficient of Coulomb friction [1], at least 0.
    pub friction: f64,
}

/// Contact data of all bodies and half-spaces, checked.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ContactTable {
    bodies: Vec<BodyContact>,
    half_spaces: Vec<HalfSpaceContact>,
    /// Overrides by sorted sides, ascending.
    pairs: Vec<([ContactSide; 2], f64)>,
    frictional: bool,
}

impl ContactTable {
    /// What a scene without contact data has: every body and half-space like any other, without friction.
    pub fn new(model: &CollisionModel) -> Self {
        Self {
            bodies: vec![BodyContact::default(); model.bodies().len()],
            half_spaces: vec![HalfSpaceContact::default(); model.half_spaces().len()],
            ..Self::default()
        }
    }

    /// One entry a body.
    pub fn bodies(&self) -> &[BodyContact] {
        &self.bodies
    }

    /// One entry a half-space.
    pub fn half_spaces(&self) -> &[HalfSpaceContact] {
        &self.half_spaces
    }

    /// Whether any pair may have friction.
    pub fn frictional(&self) -> bool {
        self.frictional
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

    pub(crate) fn set_bodies(&mut self, bodies: Vec<BodyContact>) -> Result<(), ResolveError> {
        let mut problems = Vec::new();
        count("bodies", bodies.len(), self.bodies.len(), &mut problems);
        for (b, body) in bodies.iter().enumerate() {
            let name = format!("body {b}");
            at_least_0(&name, "thickness", body.thickness, &mut problems);
            at_least_0(&name, "friction", Some(body.friction), &mut problems);
            if let Some(delta) = body.delta
                && !(delta.is_finite() && delta > 0.0)
            {
                problems.push(format!("delta = {delta} of {name} must be finite and above 0"));
            }
            if let Some(limit) = body.stretch_limit
                && (limit.is_nan() || limit <= 1.0)
            {
                problems.push(format!(
                    "stretch_limit = {limit} of {name} must be above 1, or infinite for no limit"
                ));
            }
        }
        self.accept(problems, |table| table.bodies = bodies)
    }

    pub(crate) fn set_half_spaces(&mut self, half_spaces: Vec<HalfSpaceContact>) -> Result<(), ResolveError> {
        let mut problems = Vec::new();
        count("half-spaces", half_spaces.len(), self.half_spaces.len(), &mut problems);
        for (h, side) in half_spaces.iter().enumerate() {
            let name = format!("half-space {h}");
            at_least_0(&name, "thickness", side.thickness, &mut problems);
            at_least_0(&name, "friction", Some(side.friction), &mut problems);
        }
        self.accept(problems, |table| table.half_spaces = half_spaces)
    }

    pub(crate) fn set_pairs(&mut self, pairs: &[PairFriction]) -> Result<(), ResolveError> {
        let mut problems = Vec::new();
        let mut entries: Vec<([ContactSide; 2], f64)> = Vec::new();
        for (index, pair) in pairs.iter().enumerate() {
            let name = format!("friction pair {index}");
            at_least_0(&name, "friction", Some(pair.friction), &mut problems);
            for side in pair.sides {
                let (what, given, known) = match side {
                    ContactSide::Body(b) => ("body", b, self.bodies.len()),
                    ContactSide::HalfSpace(h) => ("half-space", h, self.half_spaces.len()),
                };
                if given as usize >= known {
                    problems.push(format!("{name} names {what} {given}, but there are only {known}"));
                }
            }
            let sides = sorted(pair.sides);
            if entries.iter().any(|(other, _)| *other == sides) {
                problems.push(format!("{name} repeats the sides of an earlier pair"));
            }
            entries.push((sides, pair.friction));
        }
        entries.sort_by_key(|entry| entry.0);
        self.accept(problems, |table| table.pairs = entries)
    }

    fn accept(&mut self, problems: Vec<String>, change: impl FnOnce(&mut Self)) -> Result<(), ResolveError> {
        if !problems.is_empty() {
            return Err(ResolveError::Contact(problems));
        }
        change(self);
        self.frictional = self.bodies.iter().any(|b| b.friction > 0.0)
            || self.pairs.iter().any(|(_, friction)| *friction > 0.0);
        Ok(())
    }
}

fn sorted(mut sides: [ContactSide; 2]) -> [ContactSide; 2] {
    sides.sort_unstable();
    sides
}

fn count(what: &str, given: usize, needed: usize, problems: &mut Vec<String>) {
    if given != needed {
        problems.push(format!("contact data of {given} {what} given for a model with {needed}"));
    }
}

fn at_least_0(name: &str, key: &str, value: Option<f64>, problems: &mut Vec<String>) {
    if let Some(value) = value
        && !(value.is_finite() && value >= 0.0)
    {
        problems.push(format!("{key} = {value} of {name} must be finite and at least 0"));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bowknot_geometry::{HalfSpace, Point, Topology, Vector};
    use bowknot_proximity::BodyFilter;

    fn table() -> ContactTable {
        let topology = Topology::builder(2).particles([0, 1]).build().expect("two particles");
        let ground = HalfSpace::new(Point::origin(), Vector::z()).expect("a plane");
        let filters = vec![BodyFilter::DEFORMABLE; 2];
        let model = CollisionModel::new(topology, vec![0, 1], filters, vec![ground]).expect("a model");
        ContactTable::new(&model)
    }

    #[test]
    fn friction_is_the_geometric_mean_unless_the_pair_has_its_own() {
        let mut table = table();
        assert!(!table.frictional());
        let bodies = [0.9, 0.4].map(|friction| BodyContact { friction, ..BodyContact::default() });
        table.set_bodies(bodies.to_vec()).expect("fine");
        let (a, b, ground) = (ContactSide::Body(0), ContactSide::Body(1), ContactSide::HalfSpace(0));
        assert!((table.friction(a, b) - 0.6).abs() < 1e-15);
        assert_eq!(table.friction(a, ground), 0.0);
        table.set_half_spaces(vec![HalfSpaceContact { friction: 0.1, thickness: None }]).expect("fine");
        assert!((table.friction(ground, b) - 0.2).abs() < 1e-15);
        let own = PairFriction { sides: [b, a], friction: 0.05 };
        table.set_pairs(&[own, PairFriction { sides: [ground, a], friction: 0.7 }]).expect("fine");
        assert_eq!((table.friction(a, b), table.friction(b, a)), (0.05, 0.05));
        assert_eq!(table.friction(a, ground), 0.7);
        assert!((table.friction(a, a) - 0.9).abs() < 1e-15);
    }

    #[test]
    fn every_problem_is_named_and_the_table_left_alone() {
        let mut table = table();
        let before = table.clone();
        let bad = BodyContact {
            thickness: Some(-1.0),
            delta: Some(0.0),
            friction: f64::NAN,
            stretch_limit: Some(1.0),
        };
        let Err(ResolveError::Contact(problems)) = table.set_bodies(vec![bad]) else { panic!("accepted") };
        assert_eq!(problems.len(), 5, "{problems:?}");
        let pair = PairFriction { sides: [ContactSide::Body(7), ContactSide::HalfSpace(1)], friction: -0.1 };
        let Err(ResolveError::Contact(problems)) = table.set_pairs(&[pair, pair]) else { panic!("accepted") };
        assert_eq!(problems.len(), 7, "{problems:?}");
        let bad = HalfSpaceContact { thickness: Some(f64::INFINITY), friction: -1.0 };
        let Err(ResolveError::Contact(problems)) = table.set_half_spaces(vec![bad]) else {
            panic!("accepted")
        };
        assert_eq!(problems.len(), 2, "{problems:?}");
        assert_eq!(table, before);
    }
}
