//! The hard states are free of intersections, nearly intersecting, and the same in every run. The targets
//! lead through other elements.

use bowknot_check::{Judge, PathOptions, StateOptions};
use bowknot_safety::states::GENERATORS;
use bowknot_safety::targets::Rule;
use bowknot_safety::{Random, StepChecker};

#[test]
fn states_are_clear_but_nearly_intersecting() {
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

/// Most straight paths to the targets intersect. Otherwise a step that does not would prove little.
#[test]
fn most_targets_lead_through_other_elements() {
    let (mut cases, mut crossings) = (0, 0);
    for generator in GENERATORS {
        // To one point or into one plane everything leads through something, and the judge takes a minute to
        // say so.
        let rules = Rule::ALL.into_iter().filter(|rule| !matches!(rule, Rule::Collapsed | Rule::Flattened));
        for rule in rules {
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
fn the_checker_finds_a_step_that_intersects() {
    let case = bowknot_safety::states::folded_sheet(3);
    let targets = Rule::Scattered.targets(&case, 1e-2, &mut Random::new(3));
    let mut checker = StepChecker::new(&case);
    checker.follow(&case, &targets, 10, |_, y| y.to_vec());
    let fault = checker.fault.expect("the whole way at once must be found");
    assert!(fault.starts_with("step 0: "), "{fault}");

    // A step that moves nothing has no fault.
    let mut checker = StepChecker::new(&case);
    checker.follow(&case, &targets, 10, |x, _| x.to_vec());
    assert_eq!((checker.fault, checker.steps), (None, 1));
}
