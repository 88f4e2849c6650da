use super::*;

type Set = fn(&mut Params, f64);

/// Every number of every struct, with its path.
const NUMBERS: &[(&str, Set)] = &[
    ("contact.delta", |p, value| p.contact.delta = Some(value)),
    ("contact.min_separation", |p, value| p.contact.min_separation = Some(value)),
    ("contact.range", |p, value| p.contact.range = value),
    ("contact.active", |p, value| p.contact.active = value),
    ("contact.separation_speed", |p, value| p.contact.separation_speed = Some(value)),
    ("contact.stretch_limit", |p, value| p.contact.stretch_limit = Some(value)),
    ("solver.backward.polish_distance", |p, value| p.solver.backward.polish_distance = value),
    ("solver.backward.edge_proximal", |p, value| p.solver.backward.edge_proximal = value),
    ("solver.backward.contact_proximal", |p, value| p.solver.backward.contact_proximal = value),
    ("solver.backward.proximal_growth", |p, value| p.solver.backward.proximal_growth = value),
    ("solver.forward.damping", |p, value| p.solver.forward.damping = value),
    ("solver.forward.trust_region_min", |p, value| p.solver.forward.trust_region_min = value),
    ("solver.forward.trust_region_max", |p, value| p.solver.forward.trust_region_max = value),
    ("solver.forward.swept_travel", |p, value| p.solver.forward.swept_travel = value),
    ("solver.stop.max_seconds", |p, value| p.solver.stop.max_seconds = Some(value)),
    ("solver.stop.distance", |p, value| p.solver.stop.distance = value),
    ("solver.stop.stretch_tolerance", |p, value| p.solver.stop.stretch_tolerance = value),
    ("solver.stop.remaining_fraction", |p, remaining_fraction| {
        p.solver.stop.rule = StopRule::Clock { remaining_fraction };
    }),
    ("solver.stop.net_residual", |p, net_residual| {
        p.solver.stop.rule = StopRule::Travel { net_residual, residual: None };
    }),
    ("solver.stop.residual", |p, value| {
        p.solver.stop.rule = StopRule::Travel { net_residual: 0.2, residual: Some(value) };
    }),
];

#[test]
fn every_number_refuses_nan_and_what_is_negative() {
    for preset in [Params::fast(), Params::paper()] {
        assert_eq!(preset.validate(), Ok(()));
        for (path, set) in NUMBERS {
            for value in [f64::NAN, -1.0] {
                let mut params = preset.clone();
                set(&mut params, value);
                let errors = params.validate().expect_err(path);
                assert!(errors.iter().any(|error| error.path == *path), "{path} = {value}: {errors}");
            }
        }
    }
}

/// A field that is added without an entry in [`NUMBERS`] fails here.
#[test]
fn no_number_is_missing_from_the_list() {
    fn collect(value: &toml::Value, path: &str, found: &mut Vec<String>) {
        match value {
            toml::Value::Table(table) => {
                for (key, value) in table {
                    collect(value, &format!("{path}{}{key}", if path.is_empty() { "" } else { "." }), found);
                }
            }
            toml::Value::Float(_) => found.push(path.to_owned()),
            _ => {}
        }
    }
    let mut found = Vec::new();
    for mut params in [Params::fast(), Params::paper()] {
        // Optional numbers are in the table only if they are given.
        let ContactParams { delta, min_separation, separation_speed, stretch_limit, .. } =
            &mut params.contact;
        for number in
            [delta, min_separation, separation_speed, stretch_limit, &mut params.solver.stop.max_seconds]
        {
            *number = Some(1.5);
        }
        if let StopRule::Travel { residual, .. } = &mut params.solver.stop.rule {
            *residual = Some(1.0);
        }
        let table = toml::Value::try_from(&params).expect("a table");
        collect(&table, "", &mut found);
    }
    found.sort();
    found.dedup();
    let mut listed: Vec<&str> = NUMBERS.iter().map(|(path, _)| *path).collect();
    listed.sort_unstable();
    assert_eq!(found, listed);
}

#[test]
fn counts_are_checked_too() {
    let mut params = Params::fast();
    params.solver.backward = BackwardParams { sweeps: 0, ..BackwardParams::default() };
    params.solver.stop.max_steps = Some(0);
    let errors = params.validate().expect_err("both");
    let paths: Vec<&str> = errors.iter().map(|error| error.path.as_str()).collect();
    assert_eq!(paths, ["solver.backward.sweeps", "solver.stop.max_steps"]);
    params = Params::fast();
    params.solver.backward.polish_sweeps = 7;
    let errors = params.validate().expect_err("fewer than sweeps");
    assert_eq!(errors.to_string(), "solver.backward.polish_sweeps = 7: must be at least sweeps, 8");
}
