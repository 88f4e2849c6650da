use crate::common::{Scene, assert_same_on_any_number_of_threads};
use bowknot_baselines::Method;
use bowknot_baselines::twoway::{Call, Params};
use bowknot_baselines::zones::{ImpactZones, RigidZones, TwoPhase, ZoneParams};

#[test]
fn results_have_the_same_bits_on_any_number_of_threads() {
    // Large enough for loops to be shared out.
    let scene = Scene::two_sheets(24, 0.02);
    let target = scene.swapped();
    assert_same_on_any_number_of_threads(|| {
        let problem = || scene.problem(Params::fast());
        let params = ZoneParams { max_iterations: 4, ..ZoneParams::default() };
        let methods: [Box<dyn Method>; 3] = [
            Box::new(ImpactZones::new(problem(), params).unwrap()),
            Box::new(RigidZones::new(problem())),
            Box::new(TwoPhase::new(problem(), 3, RigidZones::new(problem())).unwrap()),
        ];
        methods.map(|mut method| {
            let mut x = scene.x.clone();
            let call = Call { time_step: Some(0.01), ..Call::default() };
            let outcome = method.solve(&mut x, &target, &call).unwrap();
            (x, outcome.steps, outcome.failed)
        })
    });
}
