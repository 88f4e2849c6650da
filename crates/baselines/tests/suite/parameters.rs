//! Parameters out of their range are refused, NaN included.

use crate::common::Scene;
use bowknot_baselines::ccd::AdditiveCcd;
use bowknot_baselines::rows::{AugmentedLagrangian, LinearSystem, ProjectedJacobi};
use bowknot_baselines::twoway::Params;
use bowknot_baselines::zones::{ImpactZones, ZoneParams};
use bowknot_baselines::{Parameters, barrier::BarrierParams};

/// The paths of the fields that are refused.
fn refused(params: &impl Parameters) -> Vec<String> {
    let errors = params.validate().err();
    errors.into_iter().flatten().map(|error| error.path).collect()
}

#[test]
fn defaults_are_accepted() {
    assert!(refused(&ZoneParams::default()).is_empty());
    assert!(refused(&BarrierParams::default()).is_empty());
    assert!(refused(&AdditiveCcd::default()).is_empty());
    assert!(refused(&LinearSystem::default()).is_empty());
    assert!(refused(&AugmentedLagrangian::default()).is_empty());
    assert!(refused(&ProjectedJacobi::default()).is_empty());
}

#[test]
fn every_field_is_checked() {
    let zones = ZoneParams {
        max_iterations: 0,
        max_sweeps: 0,
        tolerance: f64::NAN,
        thickness: f64::NAN,
        ..ZoneParams::default()
    };
    assert_eq!(refused(&zones), ["max_iterations", "max_sweeps", "tolerance", "thickness"]);
    let collision = Scene::two_sheets(1, 0.05).collision_scene(Params::fast());
    assert_eq!(ImpactZones::new(collision, zones).expect_err("refused").len(), 4);

    let ccd = AdditiveCcd { slackness: f64::NAN, max_iterations: 0, ..AdditiveCcd::default() };
    assert_eq!(refused(&ccd), ["slackness", "max_iterations"]);

    assert_eq!(refused(&LinearSystem { sweeps: 0, projected: false }), ["sweeps"]);

    let mut descent = AugmentedLagrangian::new(0);
    (descent.penalty, descent.gradient_steps) = (f64::NAN, 0);
    assert_eq!(refused(&descent), ["iterations", "penalty", "gradient_steps"]);

    let mut jacobi = ProjectedJacobi::new(0, f64::NAN);
    jacobi.relaxation = 2.0;
    assert_eq!(refused(&jacobi), ["sweeps", "relaxation", "spectral_radius"]);
}
