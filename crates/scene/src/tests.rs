use super::*;
use crate::shapes::Shape;
use bowknot_dynamics::ClothMaterial;
use bowknot_geometry::Vector;

const SMALL: &str = r#"
[simulation]
dt = 0.02
gravity = [0, 0, -1.62]

[contact]
delta = 0.002

[solver]
backward = { sweeps = 4 }
newton = { cg_tolerance = 1e-6 }
stop = { max_steps = 100 }

[[body]]
name = "sheet"
shape = { type = "sheet", edge = 0.1 }
material = { fabric = "silk", density = 0.1 }
translate = [0, 0, 1]

[[obstacle]]
name = "ground"
shape = "half-space"

[[obstacle]]
shape = { type = "ball", radius = 0.3, edge = 0.1 }
motion = { spin = 90, keyframes = [{ time = 1.0, translate = [0, 0, 1] }] }

[[pin]]
side = "x-min"
box = { min = [-1, -1, 0] }
"#;

fn problems(text: &str) -> Vec<String> {
    match Scene::from_toml(text, "") {
        Err(SceneError::Invalid(problems)) => problems.iter().map(ToString::to_string).collect(),
        other => panic!("expected problems, not {other:?}"),
    }
}

/// The small scene with one line replaced.
fn changed(from: &str, to: &str) -> String {
    assert!(SMALL.contains(from), "{from}");
    SMALL.replace(from, to)
}

#[test]
fn values_reach_their_structs() {
    let scene = Scene::from_toml(SMALL, "").expect("a scene");
    assert_eq!(scene.simulation.dt, 0.02);
    assert_eq!(scene.simulation.frames, SimulationParams::default().frames);
    assert_eq!(scene.environment.gravity, Vector::new(0.0, 0.0, -1.62));
    assert_eq!(scene.solver.newton.cg_tolerance, 1e-6);
    assert_eq!(scene.contact.delta, Some(0.002));
    assert_eq!(scene.solver.backward.sweeps, 4);
    assert_eq!(scene.solver.stop.max_steps, Some(100));
    let Material::Cloth(material) = scene.bodies[0].material else { panic!("no cloth") };
    assert_eq!(material, ClothMaterial { density: 0.1, ..ClothMaterial::silk() });
    assert!(matches!(scene.obstacles[0].shape, Some(Shape::HalfSpace(_))));
    assert_eq!(scene.obstacles[1].name, "obstacle1");
    let motion = scene.obstacles[1].motion.as_ref().expect("a motion");
    assert_eq!((motion.spin, motion.keyframes.len()), (90.0, 1));
    assert_eq!(scene.pins[0].body, "sheet");
    assert_eq!(scene.pins[0].region.expect("a box").max.x, f64::INFINITY);
}

#[test]
fn a_resolved_scene_reads_back_equal() {
    for scene in BUILTIN
        .iter()
        .map(|b| Scene::builtin(b.name, 0.1).expect("a scene"))
        .chain([Scene::from_toml(SMALL, "").expect("a scene")])
    {
        let text = scene.to_toml();
        assert_eq!(Scene::from_toml(&text, "").expect("what was written"), scene, "{text}");
        let json = serde_json::to_string(&scene.with_sets(&["solver.stop.max_seconds=9"]).expect("a set"));
        assert!(json.expect("serialisable").contains("max_seconds"));
    }
}

#[test]
fn problems_name_file_line_key_and_what_is_allowed() {
    for (from, to, expected) in [
        (
            "delta = 0.002",
            "detla = 0.002",
            "scene.toml:7: contact.detla: unknown key; did you mean contact.delta?",
        ),
        (
            "dt = 0.02",
            "dt = \"fast\"",
            "scene.toml:3: simulation.dt: must be a number, not the string \"fast\"",
        ),
        (
            "dt = 0.02",
            "dt = nan",
            "scene.toml:3: simulation.dt: NaN must be a number of seconds from 1e-6 to 1",
        ),
        (
            "dt = 0.02",
            "dt = -1",
            "scene.toml:3: simulation.dt: -1 must be a number of seconds from 1e-6 to 1",
        ),
        ("delta = 0.002", "delta = 0", "scene.toml:7: contact.delta: 0 must be finite and above 0"),
        ("sweeps = 4", "sweeps = 0", "scene.toml:10: solver.backward.sweeps: 0 must be at least 1"),
        (
            "cg_tolerance = 1e-6",
            "gravity = [0, 0, 0]",
            "scene.toml:11: solver.newton.gravity: unknown key; known here:",
        ),
        (
            "cg_tolerance = 1e-6",
            "cg_tolerance = 2",
            "scene.toml:11: solver.newton.cg_tolerance: 2 must lie between 0 and 1",
        ),
        ("max_steps = 100", "max_steps = 0", "scene.toml:12: solver.stop.max_steps: 0 must be at least 1"),
        (
            "fabric = \"silk\"",
            "fabric = \"slik\"",
            "scene.toml:17: body[0].material.fabric: the string \"slik\" must be one of cotton, wool, \
             wool-lycra, polyester, silk, denim; did you mean silk?",
        ),
        (
            "density = 0.1",
            "density = 0",
            "scene.toml:17: body[0].material.density: 0 kg/m2 must be finite and above 0",
        ),
        (
            "type = \"sheet\"",
            "type = \"shet\"",
            "scene.toml:16: body[0].shape.type: \"shet\" must be one of sheet, tube, ball, cone, box, \
             figure, garment, wedge, lathe, ribbon, half-space, block, tet-ball, strands, woven, grains, arrays; did \
             you mean sheet?",
        ),
        (
            "radius = 0.3",
            "raduis = 0.3",
            "scene.toml:25: obstacle[1].shape.raduis: unknown key; did you mean obstacle[1].shape.radius?",
        ),
        (
            "time = 1.0",
            "tiem = 1.0",
            "scene.toml:26: obstacle[1].motion.keyframes[0].tiem: unknown key; did you mean \
             obstacle[1].motion.keyframes[0].time?",
        ),
        ("side = \"x-min\"", "side = \"left\"", "scene.toml:29: pin[0].side: \"left\" must be one of x-min,"),
        ("[solver]", "[slover]", "scene.toml:9: slover: unknown key; did you mean solver?"),
        ("[solver]", "[wind]", "scene.toml:9: wind: unknown key; did you mean simulation.wind?"),
        (
            "name = \"ground\"",
            "name = \"sheet\"",
            "scene.toml:21: obstacle[0].name: \"sheet\" is the name of body[0]",
        ),
        (
            "side = \"x-min\"",
            "body = \"shet\"",
            "scene.toml:29: pin[0].body: no body \"shet\"; there are: sheet; did",
        ),
        ("shape = \"half-space\"", "", "scene.toml:20: obstacle[0].mesh: needs a mesh file, or a shape"),
    ] {
        let found = problems(&changed(from, to));
        assert!(found[0].starts_with(expected), "{to}\n  gave     {found:#?}\n  expected {expected}");
    }
}

#[test]
fn polish_sweeps_follow_sweeps_unless_they_are_given() {
    let polish_sweeps = |sets: &[&str]| {
        twoway_params(sets).map(|params| params.solver.backward.polish_sweeps).map_err(|e| e.to_string())
    };
    assert_eq!(polish_sweeps(&["solver.backward.sweeps=100"]), Ok(100));
    assert_eq!(polish_sweeps(&["solver.backward.sweeps=10"]), Ok(64));
    let error = polish_sweeps(&["solver.backward.sweeps=100", "solver.backward.polish_sweeps=64"]);
    assert!(
        error.is_err_and(|error| error.starts_with("assignment: solver.backward.polish_sweeps: 64 must be"))
    );
}

#[test]
fn the_keys_of_a_stopping_rule_stand_beside_it() {
    let sets = ["contact.preset=paper", "solver.stop.rule=travel", "solver.stop.net_residual=0.1"];
    let params = twoway_params(&sets).expect("parameters");
    let rule = bowknot_twoway::StopRule::Travel { net_residual: 0.1, residual: None };
    assert_eq!(params.solver.stop.rule, rule);
    let error = twoway_params(&["solver.stop.net_residual=nan"]).expect_err("NaN").to_string();
    assert!(error.starts_with("assignment: solver.stop.net_residual: NaN must be"), "{error}");
    let error = twoway_params(&["solver.stop.imbalance=1"]).expect_err("unknown").to_string();
    assert!(error.starts_with("assignment: solver.stop.imbalance: unknown key"), "{error}");
}

#[test]
fn every_problem_is_reported_not_only_the_first() {
    let text = changed("dt = 0.02", "dt = true").replace("sweeps = 4", "sweps = 4").replace("0.002", "[]");
    assert_eq!(problems(&text).len(), 3);
}

#[test]
fn syntax_errors_have_line_and_column() {
    let error = Scene::from_toml("[simulation]\ndt = = 3\n", "").expect_err("no TOML").to_string();
    assert!(error.starts_with("scene.toml:2:6: not TOML:"), "{error}");
}

#[test]
fn an_empty_scene_is_refused() {
    assert!(matches!(Scene::from_toml("[simulation]\n", ""), Err(SceneError::Empty)));
}

#[test]
fn a_byte_order_mark_hides_no_line() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("marked.toml");
    std::fs::write(&path, "\u{feff}[simulation]\nframes = 7\n[[body]]\nshape = \"sheet\"\n").expect("writes");
    assert_eq!(Scene::load(&path, &[""; 0]).expect("a scene").simulation.frames, 7);
}

#[test]
fn sets_override_before_anything_is_interpreted() {
    let set = |sets: &[&str]| Scene::builtin("drape", 0.1).expect("a scene").with_sets(sets);
    let scene = set(&["simulation.dt=1/50"]).expect_err("not a number").to_string();
    assert_eq!(scene, "assignment: simulation.dt: must be a number, not the string \"1/50\"");
    let scene =
        set(&["simulation.dt = 0.05", "solver.stop.max_steps=7", "contact.form=volume"]).expect("sets");
    assert_eq!((scene.simulation.dt, scene.solver.stop.max_steps), (0.05, Some(7)));
    assert_eq!(scene.contact.form, bowknot_constraints::ContactForm::Volume);
    let scene = set(&["body.sheet.material.density=2", "obstacle.0.shape.radius=0.2"]).expect("sets");
    let Material::Cloth(material) = scene.bodies[0].material else { panic!("no cloth") };
    assert_eq!(material, ClothMaterial { density: 2.0, ..ClothMaterial::cotton() });
    assert!(matches!(&scene.obstacles[0].shape, Some(Shape::Ball(ball)) if ball.radius == 0.2));
    let scene = set(&["body.0.material=silk"]).expect("sets");
    assert_eq!(scene.bodies[0].material, Material::Cloth(ClothMaterial::silk()));

    for (sets, expected) in [
        ("contact.delt=1", "assignment: contact.delt: unknown key; did you mean contact.delta?"),
        ("contact", "assignment: contact: an assignment has the form KEY.PATH=VALUE"),
        ("body.shet.scale=2", "assignment: body: has no entry shet; it has 1 entry"),
        ("simulation.dt=nan", "assignment: simulation.dt: NaN must be"),
    ] {
        let error = set(&[sets]).expect_err(sets).to_string();
        assert!(error.starts_with(expected), "{sets}: {error}");
    }
}

#[test]
fn a_preset_changes_defaults_and_keeps_what_was_stated() {
    let stated = Scene::from_toml(&changed("delta = 0.002", "delta = 0.002\npreset = \"paper\""), "")
        .expect("a scene");
    assert_eq!(stated.solver.backward.sweeps, 4);
    assert_eq!(stated.contact.delta, Some(0.002));
    assert_eq!(stated.solver.forward, bowknot_twoway::ForwardParams::paper());
    let set =
        Scene::builtin("drape", 0.1).expect("a scene").with_sets(&["contact.preset=paper"]).expect("a set");
    assert_eq!(set.twoway(), bowknot_twoway::Params::paper());
    assert_eq!(set.solver.repulsion, crate::RepulsionParams::paper());
    let sets = ["contact.preset=paper", "solver.forward.bound=planes"];
    let params = twoway_params(&sets).expect("parameters");
    assert_eq!(params.solver.forward.bound, bowknot_twoway::stepper::Bound::Planes);
    assert_eq!(params.solver.backward, bowknot_twoway::Params::paper().solver.backward);
    assert!(twoway_params(&["simulation.dt=1"]).is_err());
    assert!(
        twoway_params(&["solver.forward.damping=2"])
            .expect_err("range")
            .to_string()
            .starts_with("assignment: solver.forward.damping")
    );
}

#[test]
fn names_are_looked_up_and_suggested() {
    let none: &[&str] = &[];
    let error = Scene::open("neddle", None, none).expect_err("no such scene").to_string();
    assert!(error.ends_with("did you mean needle?"), "{error}");
    let error = Scene::open("missing.toml", None, none).expect_err("no such file").to_string();
    assert!(error.contains("missing.toml: no such file"), "{error}");
    for scale in [0.0, -1.0, f64::NAN, 1e9] {
        assert!(matches!(Scene::builtin("drape", scale), Err(SceneError::Scale { .. })));
    }
}

#[test]
fn builtin_scenes_have_the_sizes_that_they_claim() {
    for (name, vertices, triangles) in [
        ("drape", 2601, 5000),
        ("needle", 10201, 20000),
        ("stack", 8836, 16928),
        ("sphere", 50176, 99458),
        ("tube", 25600, 50880),
        ("blade", 59405, 116_640),
        ("funnel", 49284, 97_682),
        ("bow-knot", 71778, 136_640),
        ("reef-knot", 36432, 69_468),
    ] {
        let info = Scene::builtin(name, 1.0).expect("a scene").info().expect("meshes");
        assert_eq!((info.vertices, info.triangles), (vertices, triangles), "{name}");
        let half = Scene::builtin(name, 0.5).expect("a scene").info().expect("meshes");
        let ratio = info.vertices as f64 / half.vertices as f64;
        assert!((3.5..4.2).contains(&ratio), "{name}: {ratio}");
    }
}
