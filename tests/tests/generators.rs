//! The hard states are clear, hard, and the same every time; the targets lead through one another.

use bowknot::check::{Judge, PathOptions, StateOptions};
use bowknot_tests::states::GENERATORS;
use bowknot_tests::targets::Rule;
use bowknot_tests::{Random, Watch};

#[test]
fn states_are_clear_but_only_just() {
    for generator in GENERATORS {
        let mut smallest = f64::INFINITY;
        for seed in 0..6 {
            let case = generator(seed);
            let judge = Judge::from_model(&case.model);
            let report =
                judge.check_state(&case.positions, &StateOptions::default()).expect("finite positions");
            assert!(report.is_clear(), "{}: {}", case.name, report.intersections[0]);
            let nearest = report.nearest.expect("every case has pairs");
            assert!(nearest.distance > 0.0, "{}: {nearest}", case.name);
            smallest = smallest.min(nearest.distance);
            assert_eq!(case.positions, generator(seed).positions, "{} is not the same twice", case.name);
        }
        let name = generator(0).name;
        assert!(smallest < 1e-3, "{name}: never nearer than {smallest:e} m");
    }
}

/// Going straight to the target is mostly wrong, so a step that is not is worth something.
#[test]
fn targets_lead_through_one_another() {
    let (mut cases, mut crossings) = (0, 0);
    for generator in GENERATORS {
        for rule in Rule::ALL {
            let case = generator(1);
            let targets = rule.targets(&case, 0.02, &mut Random::new(2));
            let judge = Judge::from_model(&case.model);
            let report =
                judge.check_path(&case.positions, &targets, &PathOptions::default()).expect("finite");
            cases += 1;
            crossings += usize::from(!report.is_clear());
        }
    }
    assert!(4 * crossings >= 3 * cases, "{crossings} of {cases}");
}

#[test]
fn the_watch_catches_a_careless_step() {
    let case = bowknot_tests::states::folded_sheet(3);
    let targets = Rule::Scattered.targets(&case, 1e-2, &mut Random::new(3));
    let mut watch = Watch::new(&case);
    watch.follow(&case, &targets, 10, |_, y| y.to_vec());
    let fault = watch.fault.expect("the whole way at once must be seen");
    assert!(fault.starts_with("step 0: "), "{fault}");

    // And lets a step pass that does nothing.
    let mut watch = Watch::new(&case);
    watch.follow(&case, &targets, 10, |x, _| x.to_vec());
    assert_eq!((watch.fault, watch.steps), (None, 1));
}
