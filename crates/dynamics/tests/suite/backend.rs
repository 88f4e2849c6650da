//! Newton iterations by a backend: where it gains nothing the CPU takes over, failures are errors, and what a backend cannot
//! compute is refused.

use crate::common::{dynamics, sheet, with_tolerance};
use bowknot_dynamics::{
    AssemblySprings, Body, ClothMaterial, CustomElement, Dynamics, DynamicsModel, ElementGroup,
    ElementMatrix, ElementModel, NewtonBackend, NewtonBackendError, NewtonSolve, NewtonStep, NewtonTarget,
    OutOfBalance, RepulsionSpring, SolidMaterial, SolveLimits, SpringKind, StepError, Trial, Watched,
};
use bowknot_geometry::{Point, Vector, add_edge_middles};
use nalgebra::Matrix3;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

const DT: f64 = 0.02;

/// So many that a time step is solved: intermediate linear solves are inexact, and each solver errs in its
/// own way.
const NEWTON_ITERATIONS: usize = 10;

/// Largest difference of two solvers as a share of the way: the forces of the contacts may be off by 0.2 %,
/// so that time steps are not solved to rounding.
const AGREEMENT: f64 = 2e-5;

/// Gets as far as a linear solve, which gains nothing. Or each call is an error.
#[derive(Debug, Default)]
struct Idle {
    is_lost: bool,
    iterate: Watched,
    solves: Arc<AtomicUsize>,
    models: Arc<AtomicUsize>,
}

impl Idle {
    fn answer(&self) -> Result<(), NewtonBackendError> {
        if self.is_lost { Err("the device was lost".into()) } else { Ok(()) }
    }

    /// What comes after a linear solve.
    fn never<T>() -> Result<T, NewtonBackendError> {
        Err("it has not solved anything".into())
    }
}

impl NewtonBackend for Idle {
    fn name(&self) -> String {
        "idle".to_owned()
    }

    fn set_model(&mut self, _model: &ElementModel) -> Result<(), NewtonBackendError> {
        self.models.fetch_add(1, Ordering::Relaxed);
        self.answer()
    }

    fn begin_step(&mut self, _step: &NewtonStep<'_>) -> Result<(), NewtonBackendError> {
        self.answer()
    }

    fn begin_target(&mut self, target: &NewtonTarget<'_>) -> Result<Watched, NewtonBackendError> {
        self.iterate = target.watched.iter().map(|&node| target.iterate[node as usize]).collect();
        Ok(self.iterate.clone())
    }

    fn linearize(&mut self, _absolute: bool) -> Result<(), NewtonBackendError> {
        self.answer()
    }

    fn diagonal(&mut self, blocks: &mut Vec<Matrix3<f64>>) -> Result<(), NewtonBackendError> {
        *blocks = vec![Matrix3::identity(); self.iterate.len()];
        self.answer()
    }

    fn solve(
        &mut self,
        _springs: &AssemblySprings<'_>,
        _limits: &SolveLimits,
    ) -> Result<NewtonSolve, NewtonBackendError> {
        self.solves.fetch_add(1, Ordering::Relaxed);
        Ok(NewtonSolve { info: Default::default(), scale: 1.0, stalled: true })
    }

    fn component_residuals(&mut self, _sums: &mut Vec<Vector>) -> Result<(), NewtonBackendError> {
        Self::never()
    }

    fn translate(&mut self, _translations: &[Vector]) -> Result<(), NewtonBackendError> {
        Self::never()
    }

    fn place(&mut self, _length: f64) -> Result<Trial, NewtonBackendError> {
        Self::never()
    }

    fn begin_search(&mut self) -> Result<(Watched, Trial), NewtonBackendError> {
        Self::never()
    }

    fn start_from_trial(&mut self) -> Result<(), NewtonBackendError> {
        Self::never()
    }

    fn keep_trial(&mut self) -> Result<(), NewtonBackendError> {
        Self::never()
    }

    fn start_from_kept_trial(&mut self) -> Result<(), NewtonBackendError> {
        Self::never()
    }

    fn target(&mut self, _y: &mut [Vector]) -> Result<(), NewtonBackendError> {
        Self::never()
    }

    fn out_of_balance(
        &mut self,
        _springs: &AssemblySprings<'_>,
        _known: &[Vector],
        _counted: &[bool],
        _absolute: bool,
    ) -> Result<OutOfBalance, NewtonBackendError> {
        Self::never()
    }
}

/// A sheet that hangs at two corners, with springs between some of its vertices and to an obstacle.
fn hanging_sheet(tolerance: f64) -> (Dynamics, Vec<Point>, Vec<bool>) {
    let (mut rest, triangles) = sheet(0.3, 0.3, 10, 10);
    let count = rest.len() as u32;
    rest.push(Point::new(0.15, 0.15, -0.01));
    let bodies =
        vec![Body::cloth("sheet", triangles, ClothMaterial::cotton()), Body::obstacle("floor", vec![count])];
    let mut dynamics = dynamics(&rest, bodies, with_tolerance(tolerance));
    let spring = |vertices: [u32; 4], weights| RepulsionSpring {
        kind: SpringKind::Contact,
        vertices,
        weights,
        normal: Vector::z(),
        offset: 0.0,
        reach: 0.012,
        floor: -0.05,
        start_gap: 0.012,
        stiffness: 1.0,
        friction: 0.3,
        friction_ratio: Vector::zeros(),
    };
    let springs = [
        spring([60, count, 0, 0], [1.0, -1.0, 0.0, 0.0]),
        spring([30, 52, 63, 64], [1.0, -0.25, -0.25, -0.5]),
    ];
    dynamics.set_repulsion(&springs).expect("valid");
    let held = (0..=count).map(|v| [0, 10, count].contains(&v)).collect();
    (dynamics, rest, held)
}

fn fall(dynamics: &mut Dynamics, rest: &[Point], held: &[bool], steps: usize) -> Vec<Point> {
    let (mut x, mut v) = (rest.to_vec(), vec![Vector::zeros(); rest.len()]);
    for _ in 0..steps {
        let infos = dynamics.solve_step(&mut x, &mut v, DT, held, rest, NEWTON_ITERATIONS).expect("solves");
        assert!(infos.iter().all(|info| info.cg.converged), "{infos:?}");
    }
    x
}

#[test]
fn where_single_precision_gains_nothing_the_cpu_does_the_rest_of_the_time_step() {
    let (mut cpu, rest, held) = hanging_sheet(1e-9);
    let (mut other, ..) = hanging_sheet(1e-9);
    let idle = Idle::default();
    let (solves, models) = (Arc::clone(&idle.solves), Arc::clone(&idle.models));
    other.set_backend(Some(Box::new(idle))).expect("cloth");
    assert_eq!(other.backend().map(NewtonBackend::name).as_deref(), Some("idle"));
    let [a, b] = [&mut cpu, &mut other].map(|dynamics| fall(dynamics, &rest, &held, 8));
    let largest = |a: &[Point], b: &[Point]| a.iter().zip(b).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
    let (apart, fallen) = (largest(&a, &b), largest(&a, &rest));
    assert!(fallen > 0.1 && apart < AGREEMENT * fallen, "{apart:e} m of {fallen} m");
    assert_eq!([solves, models].map(|count| count.load(Ordering::Relaxed)), [8, 1]);
}

#[test]
fn a_backend_that_fails_is_an_error_and_may_be_replaced() {
    let (mut dynamics, rest, held) = hanging_sheet(1e-6);
    dynamics.set_backend(Some(Box::new(Idle { is_lost: true, ..Idle::default() }))).expect("cloth");
    let (mut x, mut v) = (rest.clone(), vec![Vector::zeros(); rest.len()]);
    let error = dynamics.solve_step(&mut x, &mut v, DT, &held, &rest, 1).expect_err("it is lost");
    assert_eq!(error, StepError::Backend { message: "the device was lost".to_owned() });
    assert_eq!(x, rest);
    dynamics.set_backend(None).expect("the CPU");
    let resumed = fall(&mut dynamics, &rest, &held, 3);
    let (mut fresh, ..) = hanging_sheet(1e-6);
    assert_eq!(resumed, fall(&mut fresh, &rest, &held, 3));
}

#[test]
fn quadratic_elements_are_refused_by_name_and_stay_on_the_cpu() {
    let corners = [[0.0; 3], [0.1, 0.0, 0.0], [0.0, 0.1, 0.0], [0.0, 0.0, 0.1]].map(Point::from);
    let of = |has_backend: bool| {
        let mut rest = corners.to_vec();
        let tets = add_edge_middles(&mut rest, &[[0, 1, 2, 3]]);
        let body = Body::quadratic_solid("beam", tets, SolidMaterial::rubber());
        let mut dynamics = dynamics(&rest, vec![body], with_tolerance(1e-6));
        if has_backend {
            let error = dynamics.set_backend(Some(Box::new(Idle::default()))).expect_err("quadratic");
            assert!(matches!(error, StepError::OnlyOnCpu { ref body, .. } if body == "beam"), "{error}");
            let text = error.to_string();
            assert!(text.contains("\"beam\"") && text.contains("elements = \"linear\""), "{text}");
            assert!(dynamics.backend().is_none());
        }
        fall(&mut dynamics, &rest, &[true].repeat(3).into_iter().chain([false; 7]).collect::<Vec<_>>(), 2)
    };
    assert_eq!(of(true), of(false));
}

/// A vertex that nothing pulls.
#[derive(Debug)]
struct Zero;

impl CustomElement for Zero {
    fn vertices(&self) -> &[u32] {
        &[0]
    }

    fn energy(&self, _x: &[Point]) -> f64 {
        0.0
    }

    fn gradient(&self, _x: &[Point], _gradient: &mut [Vector]) {}

    fn hessian(&self, _x: &[Point], _hessian: &mut ElementMatrix<'_>) {}
}

#[test]
fn custom_elements_are_refused_by_name_and_stay_on_the_cpu() {
    let (rest, triangles) = sheet(0.1, 0.1, 2, 2);
    let model = DynamicsModel::new(rest, vec![Body::cloth("sheet", triangles, ClothMaterial::cotton())]);
    let model =
        model.and_then(|model| model.with_elements(vec![ElementGroup::new("none", vec![Arc::new(Zero)])]));
    let mut dynamics = Dynamics::new(model.expect("valid"), with_tolerance(1e-6)).expect("valid");
    let error = dynamics.set_backend(Some(Box::new(Idle::default()))).expect_err("custom");
    assert_eq!(error, StepError::CustomElements { group: "none".to_owned() });
    assert!(dynamics.backend().is_none());
}
