//! Parameters, models and equilibria.

use bowknot_dynamics::{Body, Dynamics, DynamicsModel, DynamicsParams, Environment, NewtonParams};
use bowknot_geometry::{Point, Vector};

/// The default parameters with another tolerance of linear solves.
pub fn with_tolerance(cg_tolerance: f64) -> DynamicsParams {
    DynamicsParams {
        newton: NewtonParams { cg_tolerance, ..NewtonParams::default() },
        ..DynamicsParams::default()
    }
}

/// The same parameters with another gravity [m/s^2].
pub fn with_gravity(params: DynamicsParams, gravity: Vector) -> DynamicsParams {
    DynamicsParams { environment: Environment { gravity, ..params.environment }, ..params }
}

/// The same parameters without gravity.
pub fn weightless(params: DynamicsParams) -> DynamicsParams {
    with_gravity(params, Vector::zeros())
}

/// Valid bodies and parameters.
pub fn dynamics(rest: &[Point], bodies: Vec<Body>, params: DynamicsParams) -> Dynamics {
    Dynamics::new(DynamicsModel::new(rest.to_vec(), bodies).expect("valid"), params).expect("valid")
}

/// The equilibrium at `x`: one step of `dt`, so long that inertia has no effect. The last of its `iterations`
/// must move vertices by less than `tolerance` [m].
pub fn equilibrium(
    dynamics: &mut Dynamics,
    x: &mut [Point],
    held: &[bool],
    keyframes: &[Point],
    (dt, iterations, tolerance): (f64, usize, f64),
) {
    let mut v = vec![Vector::zeros(); x.len()];
    let infos = dynamics.solve_step(x, &mut v, dt, held, keyframes, iterations).expect("solves");
    let last = infos[iterations - 1];
    assert!(last.cg.converged && last.max_displacement < tolerance, "{last:?}");
}
