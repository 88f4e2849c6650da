//! Degenerate contacts never intersect: tips on tips, edges along edges, notches, inner edges, sheets a
//! micrometer apart, closed meshes inside each other, needles and points.

use bowknot_tests::degenerate::{run, scenes};

fn are_safe(settings: &[&str], every: usize) {
    let settings: Vec<String> = settings.iter().map(|text| (*text).to_owned()).collect();
    for scene in scenes().iter().step_by(every) {
        let judged = run(scene, &settings);
        assert_eq!(judged.intersections, 0, "{}: {:#?}", scene.name, judged.findings);
        // What does not move shows nothing.
        assert!(judged.paths > 0 && judged.moved > 1e-3, "{}: {judged:?}", scene.name);
    }
}

#[test]
fn no_degenerate_scene_intersects() {
    are_safe(&[], 1);
}

#[test]
fn no_degenerate_scene_intersects_in_long_time_steps() {
    are_safe(&["simulation.dt=0.04"], 2);
}

#[test]
fn no_degenerate_scene_intersects_with_the_paper_preset() {
    are_safe(&["contact.preset=\"paper\"", "solver.stop.max_steps=100"], 3);
}
