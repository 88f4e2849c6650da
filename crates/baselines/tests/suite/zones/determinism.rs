use crate::common::{Scene, assert_same_on_any_number_of_threads};
use bowknot_baselines::Method;
use bowknot_baselines::twoway::{Params, ResolveInput};
use bowknot_baselines::zones::{ImpactZones, RigidZones, TwoPhase, ZoneParams};

#[test]
fn results_have_the_same_bits_on_any_number_of_threads() {
    // Large enough for loops to be shared out.
    let scene = Scene::two_sheets(24, 0.02);
    let target = scene.swapped();
    assert_same_on_any_number_of_threads(|| {
        let collision = || scene.collision_scene(Params::fast());
        let params = ZoneParams { max_iterations: 4, ..ZoneParams::default() };
        let methods: [Box<dyn Method>; 3] = [
            Box::new(ImpactZones::new(collision(), params)),
            Box::new(RigidZones::new(collision())),
            Box::new(TwoPhase::new(collision(), 3, RigidZones::new(collision()))),
        ];
        methods.map(|mut method| {
            let mut x = scene.x.clone();
            let input = ResolveInput { time_step: Some(0.01), ..ResolveInput::default() };
            let outcome = method.solve(&mut x, &target, &input).unwrap();
            (x, outcome.steps, outcome.failed)
        })
    });
}
