//! Parameters of the dynamics.

use bowknot_errors::{Checks, Parameters};
use bowknot_geometry::Vector;
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

/// Parameters of [`crate::Dynamics`]. The number of Newton iterations per time step is up to the caller.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields, default))]
pub struct DynamicsParams {
    /// How time is integrated.
    pub integrator: Integrator,
    /// Gravity and air.
    pub environment: Environment,
    /// Newton's method and its linear solves.
    pub newton: NewtonParams,
}

/// How time is integrated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
#[non_exhaustive]
pub enum Integrator {
    /// One implicit solve for a time step, of first order: errors halve with the time step. It damps whatever
    /// vibrates, the more the longer the time step, and free fall is dt/2 times its speed too low.
    #[default]
    ImplicitEuler,
    /// Two implicit solves for a time step, of second order: errors fall with its square. Free fall is exact,
    /// and what vibrates with up to a sixth of 1/dt loses less than 1 % of its energy in a time step, while
    /// faster vibrations are damped. See [`crate::dynamics::stages`].
    Sdirk2,
}

/// Gravity and air.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields, default))]
pub struct Environment {
    /// Acceleration of gravity [m/s^2], unless a body has its own. Default (0, 0, -9.81).
    pub gravity: Vector,
    /// Mass-proportional damping [1/s]: velocities decay as exp(-t * this), in a vacuum as well. It slows
    /// free flight and rotation; for losses inside of a material see
    /// [`crate::ClothMaterial::stretch_damping`]. Default 0.
    pub air_drag: f64,
    /// Velocity of the air [m/s]; it has an effect only with an `air_density`. Default (0, 0, 0).
    pub wind: Vector,
    /// Density of the air [kg/m^3]: 1.2 at room temperature. Surfaces, strands and grains then feel drag that
    /// grows with the square of their velocity relative to the wind. Default 0, a vacuum.
    pub air_density: f64,
    /// Drag coefficient across surfaces and strands [1]. Default 1.2: a plate across the flow has 1.1 to 1.3.
    pub drag_normal: f64,
    /// Drag coefficient along surfaces and strands, both sides together [1]. Default 0.02: the friction of
    /// rough skin.
    pub drag_tangential: f64,
}

/// Newton's method and its linear solves.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields, default))]
pub struct NewtonParams {
    /// Residual at which linear solves end [1], in the preconditioner's norm and relative to the right-hand
    /// side of the first solve of the time step. Intermediate solves of a target end at 0.03 of their own
    /// right-hand side as well. Smaller: more iterations; larger: targets are stretched, see the README
    /// of `bowknot-dynamics`. Default 1e-4: errors of 0.1 to 0.4 mm at 10,000 vertices and dt = 1/20 s.
    pub cg_tolerance: f64,
    /// Residual of the time step below which Newton iterations end, in mean edge lengths [1]: the distance
    /// that the forces out of balance are worth, see [`crate::Residual::distance`]. It is for callers that
    /// alternate Newton iterations with a collision stage, and for time steps of 1/100 s: in shorter ones the
    /// residual shrinks with the square of the time step, in longer ones it grows. Smaller: more iterations,
    /// up to `simulation.newton_iterations`. 0: all iterations are made. Default 0.003.
    pub step_tolerance: f64,
    /// Largest number of iterations of a linear solve [1]. At this number the solve ends with its last
    /// iterate and reports that it has not converged. Default 10000.
    pub cg_max_iterations: usize,
    /// Preconditioner of the linear solve.
    pub preconditioner: PreconditionerKind,
    /// What is done with the negative curvatures of the elastic energy.
    pub hessian_filter: HessianFilter,
    /// Largest number of halvings of a Newton step by the line search [1], at most 60; 0 accepts every full
    /// step. Default 20.
    pub line_search_halvings: usize,
    /// Largest number of Newton iterations within one target after the first [1], at most 1000. They are made
    /// until the last one changes little; without strands, only if the quadratic model missed its predicted
    /// decrease by a tenth. Fewer: stiff bodies that rotate fast, above all strands, are slowed down. Default
    /// 12.
    pub correcting_iterations: usize,
    /// Share of the predicted decrease of energy that a step must reach (Armijo condition) [1], in [0, 0.5).
    /// Larger: more halvings. Default 1e-4.
    pub line_search_decrease: f64,
}

/// Preconditioner of the linear solve.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
#[non_exhaustive]
pub enum PreconditionerKind {
    /// The inverses of the 3 x 3 diagonal blocks: little memory, many iterations.
    BlockJacobi,
    /// Block-Jacobi plus a coarse correction, in which patches of 32 to 64 nodes move as rigid bodies: 20 to
    /// 40 times fewer iterations and 5 to 10 times less time at 10,000 vertices of cloth. Strands are solved
    /// exactly.
    #[default]
    TwoLevel,
}

/// What is done with the negative curvatures of an element, so that the system is positive definite.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum HessianFilter {
    /// They are set to zero, which gives the nearest positive semi-definite matrix. It is a little faster
    /// near a solution, if many iterations are made.
    Clamp,
    /// Their sign is changed (Chen et al. 2024, "Stabler Neo-Hookean Simulation: Absolute Eigenvalue
    /// Filtering for Projected Newton"). It is as good or better in the first iteration, and far more robust
    /// under strong compression, where only inertia resists motion along a clamped direction.
    Absolute,
    /// Their sign is changed for the first target of a time step; they are set to zero for later targets.
    #[default]
    Mixed,
}

impl Default for Environment {
    fn default() -> Self {
        Self {
            gravity: Vector::new(0.0, 0.0, -9.81),
            air_drag: 0.0,
            wind: Vector::zeros(),
            air_density: 0.0,
            drag_normal: 1.2,
            drag_tangential: 0.02,
        }
    }
}

impl Default for NewtonParams {
    fn default() -> Self {
        Self {
            cg_tolerance: 1e-4,
            step_tolerance: 0.003,
            cg_max_iterations: 10_000,
            preconditioner: PreconditionerKind::default(),
            hessian_filter: HessianFilter::default(),
            line_search_halvings: 20,
            correcting_iterations: 12,
            line_search_decrease: 1e-4,
        }
    }
}

impl Parameters for DynamicsParams {
    fn check(&self, checks: &mut Checks) {
        let Self { integrator: _, environment, newton } = self;
        checks.within("environment", environment);
        checks.within("newton", newton);
    }
}

impl Parameters for Environment {
    fn check(&self, checks: &mut Checks) {
        let Self { gravity, air_drag, wind, air_density, drag_normal, drag_tangential } = *self;
        checks.all_finite("gravity", &gravity);
        checks.non_negative("air_drag", air_drag);
        checks.all_finite("wind", &wind);
        checks.non_negative("air_density", air_density);
        checks.non_negative("drag_normal", drag_normal);
        checks.non_negative("drag_tangential", drag_tangential);
    }
}

impl Parameters for NewtonParams {
    fn check(&self, checks: &mut Checks) {
        let Self {
            cg_tolerance,
            step_tolerance,
            cg_max_iterations,
            preconditioner: _,
            hessian_filter: _,
            line_search_halvings: halvings,
            correcting_iterations: corrections,
            line_search_decrease: decrease,
        } = *self;
        checks.between("cg_tolerance", cg_tolerance, 0.0, 1.0);
        checks.non_negative("step_tolerance", step_tolerance);
        checks.count_at_least("cg_max_iterations", cg_max_iterations, 1);
        checks.require(halvings <= 60, "line_search_halvings", halvings, "must be at most 60");
        checks.require(corrections <= 1000, "correcting_iterations", corrections, "must be at most 1000");
        let fits = (0.0..0.5).contains(&decrease);
        checks.require(fits, "line_search_decrease", decrease, "must be at least 0 and below 0.5");
    }
}

#[cfg(test)]
mod tests;
