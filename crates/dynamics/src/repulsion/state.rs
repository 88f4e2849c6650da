//! The state of a contact, and Coulomb's law.

use bowknot_geometry::Vector;

/// How a contact resists slip.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Friction {
    /// Without friction.
    None,
    /// It sticks, with the multiplier tau [N].
    Stick(Vector),
    /// It slides: direction d of the slip, bound m [N], curvature c orthogonal to d [N/m].
    Slide(Vector, f64, f64),
}

/// The part of a spring that changes from solve to solve.
#[derive(Clone, Copy, Debug)]
pub(super) struct SpringState {
    /// k [N/m]; 0 if no vertex is free.
    pub stiffness: f64,
    /// Whether it is in the active set: it pushes.
    pub active: bool,
    /// The multiplier of the normal force [N].
    pub lambda: f64,
    pub friction: Friction,
    /// The bound m of friction [N]: mu times the normal force.
    pub friction_bound: f64,
}

impl SpringState {
    pub const INACTIVE: Self =
        Self { stiffness: 0.0, active: false, lambda: 0.0, friction: Friction::None, friction_bound: 0.0 };

    /// Friction after a `slip` with the multiplier `tau` and the given bound: Coulomb's law.
    pub fn coulomb(&self, tau: Vector, slip: &Vector, bound: f64) -> Friction {
        let trial = tau - slip * self.stiffness;
        let size = trial.norm();
        if bound == 0.0 {
            Friction::None
        } else if size <= bound {
            Friction::Stick(trial)
        } else {
            Friction::Slide(-trial / size, bound, bound / slip.norm().max(bound / self.stiffness))
        }
    }

    /// The multiplier tau [N].
    pub fn tau(&self) -> Vector {
        match self.friction {
            Friction::None => Vector::zeros(),
            Friction::Stick(tau) => tau,
            Friction::Slide(direction, bound, _) => direction * -bound,
        }
    }
}
