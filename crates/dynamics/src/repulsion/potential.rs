//! The potential of contacts and friction by itself, for solvers other than [`crate::Dynamics`].

use super::law::Push;
use super::prepare::MIN_GRIP_SHARE;
use super::spring::RepulsionSpring;
use super::springs::Repulsion;
use super::state::SpringState;
use crate::dynamics::MatrixBlocks;
use crate::error::StepError;
use bowknot_geometry::{Point, Vector};

/// The force of one contact on the side that its normal points to; the other side has the opposite.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ContactForces {
    /// Along the normal [N], at least 0 for contacts.
    pub normal: f64,
    /// Across it [N].
    pub friction: Vector,
}

/// The potential of contacts at a state, as a function of the positions: energy, gradient, Hessian.
///
/// The law is that of [`crate::repulsion`] without the drag, with stiffnesses in N/m: they do not follow from
/// masses and materials. Each spring counts; where several pairs have the same closest points, their
/// stiffnesses add up. `bowknot_constraints::Facing::contact_share` tells how much of a contact a pair is.
///
/// **Normals, weights and bounds of friction stay** as they were found at the positions that the potential was
/// made for, so that energy, gradient and Hessian belong together. There the energy and gradient are those of the
/// distances. Make a new potential for the next iterate. The Hessian has no negative eigenvalue; it lacks the
/// curvature of the distances, which is indefinite.
///
/// **Friction** follows from the slip since the start of the time step. It is bounded by mu times the normal force
/// at the positions that the potential was made for. Slip up to that bound is elastic; the stiffness is that of
/// the normal force, but not above that at a fifth of the room. With [`RepulsionSpring::friction_ratio`] it begins
/// with the friction at the start.
///
/// **Vertices that are led**, such as those of an obstacle that moves: they reach their places within the time step,
/// so that the right-hand side of Newton's method has minus the Hessian times their displacement, and a line search
/// compares potentials with them there. Else what they press on looks like a rise of energy, and nothing moves.
///
/// ```
/// use bowknot_dynamics::geometry::{PairKind, Point, Vector, separation};
/// use bowknot_dynamics::{ContactLaw, ContactPotential, RepulsionSpring};
///
/// // A vertex that has slid along x, 1 mm above a triangle.
/// let start = [[0.2, 0.2, 0.001], [0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]].map(Point::from);
/// let mut x = start;
/// x[0].x += 0.01;
/// let separation = separation::separate(PairKind::VertexTriangle, &x);
/// let law = ContactLaw { stiffness: 100.0, reach: 0.002, floor: 0.0, friction: 0.5 };
/// let spring =
///     RepulsionSpring::of_pair(PairKind::VertexTriangle, [0, 1, 2, 3], &separation, &law, &x, &start);
/// let potential = ContactPotential::new(&[spring], &x, &start)?;
///
/// // Half of the room is left: k r (1 - 1/2) / (1/2)^2.
/// let forces = potential.forces(&x)[0];
/// assert!((forces.normal - 0.4).abs() < 1e-12);
/// assert!((forces.friction + 0.2 * Vector::x()).norm() < 1e-12);
///
/// let gradient = potential.gradient(&x);
/// assert!((gradient[0] + Vector::new(-0.2, 0.0, 0.4)).norm() < 1e-12);
/// assert!(gradient.iter().sum::<Vector>().norm() < 1e-12);
/// assert_eq!(potential.hessian(&x).len(), 16);
/// # Ok::<(), bowknot_dynamics::StepError>(())
/// ```
#[derive(Clone, Debug)]
pub struct ContactPotential {
    repulsion: Repulsion,
    vertex_count: usize,
}

impl ContactPotential {
    /// The potential of `springs` at positions `x` [m], with slip since the positions `start` [m]. Both have one
    /// entry per vertex.
    ///
    /// # Errors
    /// If a spring names a vertex that does not exist, or has a value out of its range; see [`StepError`].
    ///
    /// # Panics
    /// If `x` and `start` have different lengths.
    pub fn new(springs: &[RepulsionSpring], x: &[Point], start: &[Point]) -> Result<Self, StepError> {
        assert_eq!(start.len(), x.len(), "one position per vertex");
        let repulsion = Repulsion::over(springs, x.len(), x.len(), |vertex| vertex)?;
        let mut potential = Self { repulsion, vertex_count: x.len() };
        let watched = potential.watched(x);
        let repulsion = &mut potential.repulsion;
        repulsion.anchor(start);
        for (spring, s) in springs.iter().enumerate() {
            let (gap, _) = repulsion.gap_and_slip(spring, &watched);
            let law = s.law(s.stiffness, s.start_gap);
            let ratio = s.friction_ratio - s.normal * s.normal.dot(&s.friction_ratio);
            repulsion.states[spring] = SpringState {
                law,
                acts: s.stiffness > 0.0,
                grip: law.tangent(gap, MIN_GRIP_SHARE),
                tau: ratio * law.force_at_start(),
                bound: s.friction * law.at(gap).force,
                ..SpringState::default()
            };
        }
        Ok(potential)
    }

    /// The energy [J]: 0 without contact, and finite however near contacts are.
    ///
    /// # Panics
    /// Here and below, if there is another number of positions than [`Self::new`] got.
    pub fn energy(&self, x: &[Point]) -> f64 {
        self.repulsion.energy(&self.watched(x))
    }

    /// The gradient [N], minus the force, one entry per vertex.
    pub fn gradient(&self, x: &[Point]) -> Vec<Vector> {
        let watched = self.watched(x);
        let mut gradient = vec![Vector::zeros(); self.vertex_count];
        for spring in self.acting() {
            let ContactForces { normal, friction } = self.force(spring, &watched);
            let force = self.repulsion.normal(spring, &watched) * normal + friction;
            let s = &self.repulsion.springs[spring];
            for (&vertex, weight) in s.vertices.iter().zip(s.weights).filter(|(_, weight)| *weight != 0.0) {
                gradient[vertex as usize] -= force * weight;
            }
        }
        gradient
    }

    /// The blocks of the Hessian [N/m], each with its row and its column, by vertex. Blocks of one place add up.
    pub fn hessian(&self, x: &[Point]) -> MatrixBlocks {
        let watched = self.watched(x);
        let mut blocks = Vec::new();
        for spring in self.acting() {
            let (gap, _) = self.repulsion.gap_and_slip(spring, &watched);
            let Push { force, stiffness } = self.repulsion.states[spring].push(gap);
            let linear = self.repulsion.linearized(spring, [gap, force, stiffness], &watched, true);
            let entries =
                || linear.nodes.into_iter().zip(linear.weights).filter(|(_, weight)| *weight != 0.0);
            for (row, a) in entries() {
                blocks.extend(entries().map(|(column, b)| (row, column, linear.hessian * (a * b))));
            }
        }
        blocks
    }

    /// The forces of each spring.
    pub fn forces(&self, x: &[Point]) -> Vec<ContactForces> {
        let watched = self.watched(x);
        (0..self.repulsion.springs.len()).map(|spring| self.force(spring, &watched)).collect()
    }

    fn force(&self, spring: usize, watched: &[Vector]) -> ContactForces {
        let state = &self.repulsion.states[spring];
        let (gap, slip) = self.repulsion.gap_and_slip(spring, watched);
        ContactForces { normal: state.push(gap).force, friction: state.rub(&slip, state.bound).force }
    }

    /// The springs that have any stiffness.
    fn acting(&self) -> impl Iterator<Item = usize> {
        (0..self.repulsion.springs.len()).filter(|&spring| self.repulsion.states[spring].acts)
    }

    /// The positions of the vertices that springs act on.
    fn watched(&self, x: &[Point]) -> Vec<Vector> {
        assert_eq!(x.len(), self.vertex_count, "one position per vertex");
        self.repulsion.watched().iter().map(|&vertex| x[vertex as usize].coords).collect()
    }
}
