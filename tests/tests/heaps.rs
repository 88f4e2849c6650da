//! Heaps of grains with friction, which take thousands of sweeps.

use bowknot::Scene;
use bowknot::recording::States;
use bowknot::run::{self, RunOptions};
use bowknot_geometry::Point;
use bowknot_twoway::{AcceptedState, Params};
use std::ops::ControlFlow;

/// The collision problem of a time step in which sand runs out of a funnel.
fn problem() -> States {
    let folder = tempfile::tempdir().expect("a folder");
    let sets = ["simulation.frames=56", "output.record=true"].map(str::to_owned);
    let scene = Scene::builtin("sand", 0.08).and_then(|scene| scene.with_sets(&sets)).expect("a scene");
    let options = RunOptions { out: folder.path().join("sand"), ..RunOptions::default() };
    run::run(&scene, &options, &mut |_| ControlFlow::Continue(())).expect("a run");
    let last = States::read(&folder.path().join("sand/states/000056_00.npz")).expect("the last problem");
    // The sweeps of a call alone, from nothing.
    States { known: Vec::new(), carried: Vec::new(), ..last }
}

#[test]
fn coarse_corrections_help_and_do_not_keep_the_sweeps_from_converging() {
    let problem = problem();
    let model = problem.collision_model().expect("a model");
    let end = |sweeps: usize, coarse_correction: bool| -> Vec<Point> {
        let mut params = Params::fast();
        params.solver.backward.sweeps = sweeps;
        params.solver.backward.polish_sweeps = sweeps;
        params.solver.backward.coarse_correction = coarse_correction;
        let mut resolver = problem.resolver(model.clone(), params).expect("a resolver");
        let mut x = problem.x.clone();
        resolver
            .resolve_with(&mut x, &problem.y, &problem.input(), &mut |_: &AcceptedState<'_>| {
                ControlFlow::Continue(())
            })
            .expect("a result");
        x
    };
    let limit = end(4000, false);
    let error = |sweeps: usize, coarse_correction: bool| {
        let x = end(sweeps, coarse_correction);
        let squares: f64 = x.iter().zip(&limit).map(|(x, y)| (x - y).norm_squared()).sum();
        (squares / x.len() as f64).sqrt()
    };
    let [plain, few, many] = [error(8, false), error(8, true), error(1000, true)];
    assert!(few < plain, "{few} m with coarse corrections, {plain} m without");
    assert!(many < 0.3 * few, "{many} m after 1000 sweeps, {few} m after 8");
}
