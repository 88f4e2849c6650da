//! The tables `contact` and `solver`.

use super::section::Section;
use crate::description::Scene;
use crate::explain::explain;
use crate::fields::field_names;
use crate::params::{Preset, SceneSolverParams};
use bowknot_twoway::{ContactParams, StopRule};

/// Reads the numbers of `contact`, and `solver`, into an empty scene.
pub fn read(root: &Section<'_>) -> Scene {
    let contact = root.table("contact");
    contact.check_keys(&[&["preset", "friction_pairs"], field_names::<ContactParams>()].concat());
    let preset = contact.get("preset").map_or_else(Preset::default, |value| {
        value.clone().try_into().unwrap_or_else(|error: toml::de::Error| {
            contact.fail("preset", explain(error.message(), value));
            Preset::default()
        })
    });
    let base = Scene::with_preset(preset);
    let contact = contact.fields(&base.contact, &[]);

    let solver = root.table("solver");
    solver.check_keys(field_names::<SceneSolverParams>());
    let of_backward = solver.table("backward");
    let mut backward = of_backward.structure_over(&base.solver.backward, &[]);
    // A scene with more sweeps than the preset's polish_sweeps polishes with as many.
    if of_backward.get("polish_sweeps").is_none() {
        backward.polish_sweeps = backward.polish_sweeps.max(backward.sweeps);
    }
    let of_stop = solver.table("stop");
    let stop = of_stop.structure_over(&base.solver.stop, &[]);
    warn_of_other_rule(&of_stop, &stop.rule);
    let solver = SceneSolverParams {
        backward,
        forward: solver.table("forward").structure_over(&base.solver.forward, &[]),
        stop,
        newton: solver.table("newton").structure_over(&base.solver.newton, &[]),
        repulsion: solver.table("repulsion").structure_over(&base.solver.repulsion, &[]),
        sleep: solver.table("sleep").structure_over(&base.solver.sleep, &[]),
    };
    Scene { contact, solver, ..base }
}

/// Warns of keys that belong to the stopping rule that is not in force.
fn warn_of_other_rule(stop: &Section<'_>, rule: &StopRule) {
    let (rule, others): (_, &[&str]) = match rule {
        StopRule::Clock { .. } => ("clock", &["net_residual", "residual"]),
        StopRule::Travel { .. } => ("travel", &["remaining_fraction"]),
    };
    for key in others.iter().filter(|key| stop.get(key).is_some()) {
        stop.warn(key, format!("has no effect: solver.stop.rule is {rule:?}"));
    }
}
