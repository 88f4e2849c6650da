use super::*;

#[test]
fn defaults_are_valid_and_survive_toml() {
    let params = DynamicsParams::default();
    params.validate().expect("defaults");
    let text = toml::to_string(&params).expect("serialize");
    assert_eq!(toml::from_str::<DynamicsParams>(&text).expect("parse"), params);
    assert!(toml::from_str::<DynamicsParams>("newton.cg_tolerence = 1e-3").is_err());
    assert!(toml::from_str::<DynamicsParams>("environment.gravitation = [0, 0, 0]").is_err());
}

#[test]
fn every_number_out_of_its_range_is_named() {
    let params = DynamicsParams {
        integrator: Integrator::ImplicitEuler,
        environment: Environment {
            gravity: Vector::new(f64::NAN, 0.0, 0.0),
            air_drag: -1.0,
            wind: Vector::repeat(f64::INFINITY),
            air_density: -1.0,
            drag_normal: f64::NAN,
            drag_tangential: -1.0,
        },
        newton: NewtonParams {
            cg_tolerance: 0.0,
            step_tolerance: -1.0,
            cg_max_iterations: 0,
            line_search_halvings: 61,
            correcting_iterations: 1001,
            line_search_decrease: 0.5,
            ..NewtonParams::default()
        },
    };
    assert_eq!(
        params.validate().expect_err("all numbers are out of range").to_string(),
        "environment.gravity = [NaN, 0.0, 0.0]: must be finite in every component\n\
         environment.air_drag = -1: must be finite and at least 0\n\
         environment.wind = [inf, inf, inf]: must be finite in every component\n\
         environment.air_density = -1: must be finite and at least 0\n\
         environment.drag_normal = NaN: must be finite and at least 0\n\
         environment.drag_tangential = -1: must be finite and at least 0\n\
         newton.cg_tolerance = 0: must lie between 0 and 1\n\
         newton.step_tolerance = -1: must be finite and at least 0\n\
         newton.cg_max_iterations = 0: must be at least 1\n\
         newton.line_search_halvings = 61: must be at most 60\n\
         newton.correcting_iterations = 1001: must be at most 1000\n\
         newton.line_search_decrease = 0.5: must be at least 0 and below 0.5"
    );
}

#[test]
fn nan_is_refused() {
    let nan = f64::NAN;
    let params = NewtonParams {
        cg_tolerance: nan,
        step_tolerance: nan,
        line_search_decrease: nan,
        ..NewtonParams::default()
    };
    assert_eq!(params.validate().expect_err("three").len(), 3);
}
