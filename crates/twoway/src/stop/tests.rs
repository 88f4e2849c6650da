use super::*;

fn report(remaining_fraction: f64, remaining: f64) -> StepReport {
    StepReport { remaining_fraction, remaining, ..StepReport::default() }
}

fn test(rule: StopRule) -> StopTest {
    StopTest::new(&StopParams { rule, ..StopParams::default() }, 1.0, None, None)
}

#[test]
fn the_rule_clock_asks_for_the_remaining_fraction_alone() {
    let mut test = test(StopRule::clock());
    let never = || panic!("no residual is needed");
    assert!(!test.is_met(&report(1e-3, 0.0), never));
    assert!(test.is_met(&report(1e-5, 9.0), never));
    assert!(!test.takes_finishing_step(&report(1e-5, 9.0), 1, || true));
}

#[test]
fn the_rule_travel_asks_for_residuals_once_vertices_have_arrived() {
    let mut test = test(StopRule::travel());
    assert!(!test.is_met(&report(0.0, 0.011), || panic!("not yet")));
    let near = report(1.0, 0.009);
    let residuals = |net_residual: f64, mean_residual: f64, stretch_to_limit: f64| {
        move || Residuals { net_residual, mean_residual, stretch_to_limit }
    };
    assert!(!test.is_met(&near, residuals(0.2, 0.0, 1.0)), "a body is out of balance");
    assert!(!test.is_met(&near, residuals(0.1, 0.0, 1.03)), "an edge is too long");
    assert!(!test.is_met(&near, residuals(0.1, 0.1, 1.0)), "the mean residual may still fall");
    assert!(!test.is_met(&near, residuals(0.1, 0.04, 1.0)), "it has more than halved");
    assert!(test.is_met(&near, residuals(0.1, 0.03, 1.0)), "it has not halved");
    assert!(test.is_met(&near, residuals(0.1, 0.9e-4, 1.0)), "it is below its tolerance");
}

#[test]
fn a_call_without_contact_takes_two_finishing_steps() {
    let mut test = test(StopRule::travel());
    let near = report(0.5, 1e-3);
    assert!(!test.takes_finishing_step(&near, 1, || false), "a contact presses");
    assert!(!test.takes_finishing_step(&report(0.0, 0.0), 1, || true), "it has arrived to the bit");
    assert!(!test.takes_finishing_step(&near, 512, || true), "no steps are left");
    assert!(test.takes_finishing_step(&near, 1, || true));
    assert!(test.takes_finishing_step(&near, 2, || true));
    assert!(!test.takes_finishing_step(&near, 3, || true));
}

#[test]
fn the_limit_on_steps_follows_the_time_step_unless_it_is_given() {
    let limit = |given: Option<usize>, time_step: Option<f64>, own: Option<usize>| {
        let params = StopParams { max_steps: given, ..StopParams::default() };
        StopTest::new(&params, 1.0, time_step, own).max_steps
    };
    assert_eq!(limit(None, None, None), 512);
    assert_eq!(limit(None, Some(0.03), None), 512 + 768);
    assert_eq!(limit(None, Some(1.0), None), 2048);
    assert_eq!(limit(Some(7), Some(1.0), Some(9)), 7);
    assert_eq!(limit(None, None, Some(9)), 9);
}

#[test]
fn as_a_table_the_fields_of_the_rule_stand_beside_it() {
    let read = |text: &str| toml::from_str::<StopParams>(text);
    let clock = read("rule = \"clock\"\nremaining_fraction = 0.01").expect("valid");
    assert_eq!(clock.rule, StopRule::Clock { remaining_fraction: 0.01 });
    assert_eq!(read("rule = \"clock\"").expect("valid").rule, StopRule::clock());
    let travel = read("residual = 0.001\ndistance = 0.1").expect("valid");
    assert_eq!(travel.rule, StopRule::Travel { net_residual: 0.2, residual: Some(0.001) });
    assert_eq!(travel.distance, 0.1);
    assert!(read("rule = \"never\"").is_err() && read("drag = 1.0").is_err());
    for params in [clock, travel, StopParams::default()] {
        let text = toml::to_string(&params).expect("a table");
        assert_eq!(read(&text), Ok(params));
    }
}
