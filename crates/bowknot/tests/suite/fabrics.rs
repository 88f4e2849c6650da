use super::scene;
use bowknot::dynamics::ClothMaterial;
use bowknot::geometry::Vector;
use bowknot::recording::Recorder;
use bowknot::recording::States;
use bowknot::scene::Material;
use bowknot::simulator::CollisionProblem;
use bowknot::{Scene, SimulationObserver, Simulator};
use std::ops::ControlFlow;

/// A sheet of 0.3 m that hangs from one side.
fn hanging(body: &str, contact: &str) -> Scene {
    scene(&format!(
        "[contact]\n{contact}\n[[body]]\nname = \"sheet\"\n{body}\n\
         shape = {{ type = \"sheet\", size = [0.3, 0.3], edge = 0.05 }}\n[[pin]]\nside = \"x-min\"\n"
    ))
}

fn cloth(scene: &Scene) -> ClothMaterial {
    let Material::Cloth(material) = scene.bodies[0].material else { panic!("no cloth") };
    material
}

/// What the collision stage holds, of the first body.
fn limit(scene: &Scene) -> f64 {
    Simulator::new(scene).unwrap_or_else(|error| panic!("{error}")).resolver().scene().stretch_limit(0)
}

#[test]
fn every_fabric_is_held_at_its_limit_where_its_elasticity_would_give_way() {
    for name in ClothMaterial::NAMES {
        let mut scene = hanging(&format!("material = \"{name}\""), "");
        let material = cloth(&scene);
        // Drawn along its length until its own stiffness would let the held side stretch by four times its
        // limit.
        let strain = 4.0 * (material.stretch_limit - 1.0);
        let pull = strain * material.stretch_stiffness / (material.density * 0.3);
        scene.environment.gravity = Vector::new(pull, 0.0, 0.0);
        scene.simulation.dt = 0.002;
        let stretch = |scene: &Scene| {
            let mut simulator = Simulator::new(scene).unwrap_or_else(|error| panic!("{error}"));
            let steps: Vec<_> = (0..60).map(|_| simulator.step().expect("a time step")).collect();
            assert!(steps.iter().all(|s| s.converged), "{name}");
            (steps.iter().map(|s| s.max_stretch).fold(0.0, f64::max), steps[59].max_stretch)
        };
        let tolerance = 1.0 + scene.solver.stop.stretch_tolerance;
        let (largest, last) = stretch(&scene);
        assert!(largest <= tolerance * material.stretch_limit + 1e-9, "{name}: {largest}");
        assert!(
            last >= material.stretch_limit * (1.0 - 1e-3),
            "{name}: {last} of {}",
            material.stretch_limit
        );
        scene.bodies[0].stretch_limit = Some(f64::INFINITY);
        let (free, _) = stretch(&scene);
        assert!(free > 1.0 + 0.75 * strain, "{name}: {free} without a limit");
    }
}

#[test]
fn a_body_a_scene_and_a_preset_override_what_the_fabric_says() {
    for (body, contact, expected) in [
        ("material = \"wool\"", "", 1.06),
        ("material = \"wool-lycra\"", "", 1.2),
        ("material = { base = \"wool\", density = 1.0 }", "", 1.06),
        ("material = { stretch_limit = 1.03 }", "", 1.03),
        ("material = { stretch_limit = inf }", "", f64::INFINITY),
        ("material = \"wool\"\nstretch_limit = 1.3", "", 1.3),
        ("material = \"wool\"\nstretch_limit = inf", "", f64::INFINITY),
        ("material = \"wool\"", "stretch_limit = 1.01", 1.01),
        ("material = \"wool\"\nstretch_limit = 1.3", "stretch_limit = 1.01", 1.3),
        ("material = \"wool\"", "stretch_limit = inf", f64::INFINITY),
        ("material = \"wool\"", "preset = \"paper\"", 1.1),
        ("material = { stretch_limit = inf }", "preset = \"paper\"", 1.1),
        ("material = \"wool\"", "preset = \"paper\"\nstretch_limit = 1.01", 1.01),
        ("material = \"wool\"\nstretch_limit = 1.3", "preset = \"paper\"", 1.3),
    ] {
        let scene = hanging(body, contact);
        assert_eq!(limit(&scene), expected, "{body} {contact}");
        let text = scene.to_toml();
        let again = Scene::from_toml(&text, "").expect("what was written");
        assert_eq!(again, scene, "{text}");
        assert_eq!(limit(&again), expected, "{text}");
    }
    let set = |sets: &[&str]| {
        let scene =
            hanging("material = \"wool\"", "").with_sets(sets).unwrap_or_else(|error| panic!("{error}"));
        limit(&scene)
    };
    assert_eq!(set(&["contact.preset=paper"]), 1.1);
    assert_eq!(set(&["contact.preset=paper", "body.sheet.stretch_limit=1.04"]), 1.04);
    assert_eq!(set(&["body.sheet.material=wool-lycra"]), 1.2);
    assert_eq!(set(&["body.sheet.material.stretch_limit=1.15"]), 1.15);
    let back = hanging("material = \"wool\"", "preset = \"paper\"").with_sets(&["contact.preset=fast"]);
    assert_eq!(limit(&back.expect("the other preset")), 1.06);
}

#[test]
fn what_is_no_cloth_takes_the_limit_of_the_scene() {
    let block = "kind = \"solid\"\nshape = \"block\"";
    let strands = "kind = \"strands\"\nshape = \"strands\"";
    for (body, contact, expected) in [
        (block, "", f64::INFINITY),
        (block, "[contact]\nstretch_limit = 1.02\n", 1.02),
        (block, "[contact]\npreset = \"paper\"\n", 1.1),
        (strands, "", 1.1),
        (strands, "[contact]\nstretch_limit = 1.02\n", 1.02),
    ] {
        assert_eq!(limit(&scene(&format!("{contact}[[body]]\n{body}\n"))), expected, "{contact}{body}");
    }
}

/// Keeps the last collision problem, as a file holds it.
struct Last(Recorder, Option<States>);

impl SimulationObserver for Last {
    fn problem(&mut self, problem: &CollisionProblem<'_>) -> ControlFlow<()> {
        self.1 = Some(self.0.states(problem));
        ControlFlow::Continue(())
    }
}

#[test]
fn recorded_problems_hold_the_limit_of_the_fabric() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("states.npz");
    for (contact, recorded) in [("", Some(1.06)), ("preset = \"paper\"", None)] {
        let scene = hanging("material = \"wool\"", contact);
        let mut simulator = Simulator::new(&scene).unwrap_or_else(|error| panic!("{error}"));
        let mut last = Last(Recorder::new(&simulator), None);
        simulator.step_observed(&mut last).expect("a time step");
        last.1.expect("a problem").write(&path).expect("written");
        let states = States::read(&path).expect("read");
        assert_eq!(states.body_contacts.first().and_then(|b| b.stretch_limit), recorded, "{contact}");
        let model = states.collision_model().expect("a model");
        let resolver = states.resolver(model, scene.twoway()).expect("a resolver");
        assert_eq!(resolver.scene().stretch_limit(0), limit(&scene), "{contact}");
    }
}

#[test]
fn a_fabric_whose_limit_leaves_no_room_is_refused() {
    for (value, shown) in [("1.0", "1"), ("0.9", "0.9"), ("nan", "NaN")] {
        let text = format!(
            "[[body]]\nname = \"sheet\"\nmaterial = {{ stretch_limit = {value} }}\nshape = \"sheet\"\n"
        );
        let error = Scene::from_toml(&text, "").expect_err(value).to_string();
        let expected = format!("body[0].material.stretch_limit: {shown} must be above 1, inf included");
        assert!(error.contains(&expected), "{error}");
    }
}
