//! The springs that callers describe contacts by.

use super::law::NormalLaw;
use bowknot_geometry::{PairKind, Point, Separation, Vector};
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

/// What a spring stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum SpringKind {
    /// A contact: the gap is n . sum beta_i x_i - offset, with a normal that stays while Newton's method
    /// iterates.
    Contact,
    /// A repulsion of quadratic energy k/2 (reach - gap)^2 below its reach, with the gap of a contact: without
    /// floor, drag and friction (paper, section 6.2).
    Repulsion,
    /// An upper limit of a distance, such as of the length of an edge: the gap is -offset - |sum beta_i x_i|,
    /// and the normal turns with the vertices.
    Limit,
}

/// A contact between up to four vertices, or an upper limit of a distance, as a nonlinear spring. Its force
/// is a function of the gap, see [`crate::repulsion`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct RepulsionSpring {
    /// What it stands for.
    pub kind: SpringKind,
    /// The vertices, of obstacles too. If there are fewer than four, fill up with any vertex and weight 0.
    pub vertices: [u32; 4],
    /// Their weights beta [1], barycentric: positive on the side that the normal points to, negative on the
    /// other side. For an upper limit of a distance from b to a they are -1 at a and 1 at b.
    pub weights: [f64; 4],
    /// Unit normal n [1], in which the gap opens. For a limit it is used only where the distance is 0.
    pub normal: Vector,
    /// Length that is subtracted to give the gap [m]: 0 between primitives, n . p for a half-space through p,
    /// minus the largest distance for a limit.
    pub offset: f64,
    /// Gap from which on nothing acts [m].
    pub reach: f64,
    /// Gap at which the force becomes infinite [m], below the reach.
    pub floor: f64,
    /// Gap at the start of the time step [m]. The drag pulls to it, and friction at the start is a share of
    /// the force there.
    pub start_gap: f64,
    /// Stiffness at the reach in units of 1 / sum beta_i^2 / K_i over the free vertices [1]. K_i is the
    /// stiffness of a vertex: for a contact inertia (mass / dt^2) plus the body's stiffness at rest in its
    /// softest direction, limited by the inertia of the whole body; for a limit inertia plus a share of the
    /// stiffness in the stiffest direction. Nearer to the floor a contact is stiffer without bound, a repulsion is
    /// not.
    pub stiffness: f64,
    /// Coefficient of friction mu [1]; 0: the force is along the normal. Only a contact has any.
    pub friction: f64,
    /// Friction at the start of the time step on the side that the normal points to, as a multiple of the
    /// normal force at the start [1]. Callers keep it from the end of the last time step, see
    /// [`crate::Dynamics::contact_forces`]; with zero, a contact that sticks first slips a little in each
    /// time step.
    pub friction_ratio: Vector,
}

/// The law of a contact, see [`crate::repulsion`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct ContactLaw {
    /// See [`RepulsionSpring::stiffness`]. For a [`crate::ContactPotential`] in N/m: begin with the mass of a vertex
    /// over the square of the time step.
    pub stiffness: f64,
    /// Gap from which on nothing acts [m].
    pub reach: f64,
    /// Gap at which the force becomes infinite [m], below the reach. It may be negative: the force then stays
    /// moderate at contact, which leaves what is nearer to a collision stage that keeps distances.
    pub floor: f64,
    /// Coefficient of friction mu [1].
    pub friction: f64,
}

impl RepulsionSpring {
    /// Its law without drag, with a stiffness in N/m and the gap at the start of the time step [m].
    pub(super) fn law(&self, stiffness: f64, start: f64) -> NormalLaw {
        match self.kind {
            SpringKind::Repulsion => NormalLaw::quadratic(stiffness, self.reach, self.floor),
            SpringKind::Contact | SpringKind::Limit => {
                NormalLaw::new(stiffness, self.reach, self.floor, start)
            }
        }
    }

    /// The spring of a pair with `separation` at `positions` [m], without friction at the start of the time step.
    /// `start` are the positions there. Its gap is the distance of the pair, and its gradient that of the
    /// distance.
    ///
    /// # Panics
    /// If a position is missing.
    pub fn of_pair(
        kind: PairKind,
        mut vertices: [u32; 4],
        separation: &Separation,
        law: &ContactLaw,
        positions: &[Point],
        start: &[Point],
    ) -> Self {
        let weights = separation.signed_weights(kind);
        // Unused places may hold anything.
        (0..4).filter(|&k| weights[k] == 0.0).for_each(|k| vertices[k] = vertices[0]);
        let height = |x: &[Point]| -> f64 {
            (0..4).map(|k| weights[k] * separation.normal.dot(&x[vertices[k] as usize].coords)).sum()
        };
        let offset = height(positions) - separation.distance;
        let ContactLaw { stiffness, reach, floor, friction } = *law;
        Self {
            kind: SpringKind::Contact,
            vertices,
            weights,
            normal: separation.normal,
            offset,
            reach,
            floor,
            start_gap: height(start) - offset,
            stiffness,
            friction,
            friction_ratio: Vector::zeros(),
        }
    }
}
