//! Parameters of the dynamics.

use crate::ParamsError;
use bowknot_geometry::Vector;
use serde::{Deserialize, Serialize};

/// How [`crate::Dynamics`] makes targets. The number of Newton iterations is the caller's.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct DynamicsParams {
    /// Acceleration of gravity [m/s^2], unless a body has its own. Default (0, 0, -9.81).
    pub gravity: Vector,
    /// Mass-proportional damping [1/s]: velocities decay as exp(-t * this), in a vacuum too. It
    /// slows free flight and rotation; for losses inside of the material see
    /// [`crate::ClothMaterial::stretch_damping`]. Default 0.
    pub air_drag: f64,
    /// Velocity of the air [m/s]; it matters with an `air_density`. Default (0, 0, 0).
    pub wind: Vector,
    /// Density of the air [kg/m^3]: 1.2 at room temperature. Surfaces, strands and grains then feel drag
    /// against the wind, in the square of the relative velocity. Default 0, a vacuum.
    pub air_density: f64,
    /// Drag coefficient across surfaces and strands [1]. Default 1.2: a plate across the flow has 1.1 to 1.3.
    pub drag_normal: f64,
    /// Drag coefficient along surfaces and strands, both sides together [1]. Default 0.02: the friction of rough
    /// skin.
    pub drag_tangential: f64,
    /// Residual at which linear solves end, in the preconditioner's norm and relative to the right-hand side of the first one
    /// of the time step [1]; those on the way to a target may end at 0.03 of their own. Smaller: more iterations; larger: the
    /// target stretches, see the table in the README. Default 1e-4: 0.1 to 0.4 mm at 10,000 vertices and dt = 1/20 s.
    pub cg_tolerance: f64,
    /// Residual of the time step below which iterations end, in mean edge lengths [1]: forces that do not balance, in the
    /// distance that they are worth, see [`crate::Residual::distance`]. It is for whoever alternates Newton iterations with a
    /// collision stage, and for time steps of 1/100 s: in shorter ones it shrinks with their square, in longer ones it grows with
    /// them. Smaller: more iterations, up to `simulation.newton_iterations`; they end as well where three of them, one after the
    /// other, do not take off three tenths of a residual that is no more than four tolerances. 0: all are made. Default 0.003.
    pub step_tolerance: f64,
    /// Most iterations of the linear solve [1]. Reached, it ends with the best so far and says so.
    /// Default 10000.
    pub cg_max_iterations: usize,
    /// Preconditioner of the linear solve.
    pub preconditioner: Preconditioner,
    /// What becomes of the negative curvatures of the elastic energy.
    pub hessian_filter: HessianFilter,
    /// Most halvings of a Newton step by the line search [1]; 0 accepts every full step. Default 20.
    pub line_search_halvings: usize,
    /// Most Newton iterations within one target after the first [1], made until the last one corrects little; where
    /// there are no strands, only if the quadratic model missed its promise by a tenth. Fewer: stiff bodies that turn
    /// fast, above all strands, move as if through honey. Default 12.
    pub correcting_iterations: usize,
    /// Share of the predicted decrease of energy that a step must reach (Armijo) [1], in [0, 0.5).
    /// Larger: more halvings. Default 1e-4.
    pub line_search_decrease: f64,
}

/// Preconditioner of the linear solve.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Preconditioner {
    /// The inverses of the 3 x 3 diagonal blocks: little memory, many iterations.
    BlockJacobi,
    /// Block-Jacobi plus a coarse correction, in which patches of 32 to 64 nodes move as rigid bodies:
    /// 20 to 40 times fewer iterations and 5 to 10 times less time at 10,000 vertices of cloth. Strands are
    /// solved exactly.
    #[default]
    TwoLevel,
}

/// What becomes of an element's negative curvatures, so that the system is positive definite.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum HessianFilter {
    /// They become zero, which makes the nearest positive semi-definite matrix: a little faster near a
    /// solution, once many iterations are made.
    Clamp,
    /// They change sign (Chen et al. 2024, "Stabler Neo-Hookean Simulation: Absolute Eigenvalue
    /// Filtering for Projected Newton"): as good or better in the first iteration, and far safer out of strong compression,
    /// where a clamped direction has nothing but inertia to hold it.
    Absolute,
    /// They change sign for the first target of a time step and become zero for the later ones.
    #[default]
    Mixed,
}

impl Default for DynamicsParams {
    fn default() -> Self {
        Self {
            gravity: Vector::new(0.0, 0.0, -9.81),
            air_drag: 0.0,
            wind: Vector::zeros(),
            air_density: 0.0,
            drag_normal: 1.2,
            drag_tangential: 0.02,
            cg_tolerance: 1e-4,
            step_tolerance: 0.003,
            cg_max_iterations: 10_000,
            preconditioner: Preconditioner::default(),
            hessian_filter: HessianFilter::default(),
            line_search_halvings: 20,
            correcting_iterations: 12,
            line_search_decrease: 1e-4,
        }
    }
}

impl DynamicsParams {
    /// Checks every value.
    ///
    /// # Errors
    /// All that is wrong, by field name.
    pub fn validate(&self) -> Result<(), Vec<ParamsError>> {
        let mut errors = Vec::new();
        let mut check = |ok: bool, field, value, allowed| {
            if !ok {
                errors.push(ParamsError { field, value, allowed });
            }
        };
        let gravity = self.gravity.norm();
        check(gravity.is_finite(), "gravity", gravity, "its components must be finite");
        let wind = self.wind.norm();
        check(wind.is_finite(), "wind", wind, "its components must be finite");
        for (field, value) in [
            ("air_drag", self.air_drag),
            ("air_density", self.air_density),
            ("drag_normal", self.drag_normal),
            ("drag_tangential", self.drag_tangential),
        ] {
            check(value >= 0.0 && value.is_finite(), field, value, "it must be a finite number, 0 or more");
        }
        let tolerance = self.cg_tolerance;
        check(tolerance > 0.0 && tolerance < 1.0, "cg_tolerance", tolerance, "it must lie in (0, 1)");
        let tolerance = self.step_tolerance;
        check(
            tolerance >= 0.0 && tolerance.is_finite(),
            "step_tolerance",
            tolerance,
            "it must be finite, 0 or more",
        );
        let most = self.cg_max_iterations;
        check(most > 0, "cg_max_iterations", most as f64, "it must be 1 or more");
        let decrease = self.line_search_decrease;
        check((0.0..0.5).contains(&decrease), "line_search_decrease", decrease, "it must lie in [0, 0.5)");
        let halvings = self.line_search_halvings;
        check(halvings <= 60, "line_search_halvings", halvings as f64, "it must be 60 or less");
        if errors.is_empty() { Ok(()) } else { Err(errors) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn defaults_are_valid_and_survive_toml() {
        let params = DynamicsParams::default();
        params.validate().expect("defaults");
        let text = toml::to_string(&params).expect("serialise");
        assert_eq!(toml::from_str::<DynamicsParams>(&text).expect("parse"), params);
        assert!(toml::from_str::<DynamicsParams>("cg_tolerence = 1e-3").is_err());
    }

    #[test]
    fn all_bad_values_are_named() {
        let params = DynamicsParams {
            gravity: Vector::new(f64::NAN, 0.0, 0.0),
            air_drag: -1.0,
            wind: Vector::repeat(f64::INFINITY),
            air_density: -1.0,
            drag_normal: f64::NAN,
            drag_tangential: -1.0,
            cg_tolerance: 0.0,
            step_tolerance: -1.0,
            cg_max_iterations: 0,
            line_search_decrease: 0.5,
            line_search_halvings: 61,
            ..DynamicsParams::default()
        };
        let fields: Vec<_> = params.validate().expect_err("ten").iter().map(|e| e.field).collect();
        assert_eq!(
            fields,
            [
                "gravity",
                "wind",
                "air_drag",
                "air_density",
                "drag_normal",
                "drag_tangential",
                "cg_tolerance",
                "step_tolerance",
                "cg_max_iterations",
                "line_search_decrease",
                "line_search_halvings"
            ]
        );
    }
}
