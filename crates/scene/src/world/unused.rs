//! Keys of a scene that have no effect in it.

use crate::description::Scene;
use crate::kind::BodyKind;
use crate::obstacle::ObstacleSpec;
use crate::params::InteriorFollows;
use crate::pin::RootEnd;
use crate::shapes::Shape;
use bowknot_constraints::FrictionModel;
use bowknot_dynamics::Environment;
use bowknot_twoway::stepper::Bound;

/// What the scene says without effect, in words: the key, and what it lacks.
pub(super) fn unused_keys(scene: &Scene) -> Vec<String> {
    let mut unused = Vec::new();
    let mut note = |applies: bool, key: &str, why: &str| {
        if applies {
            unused.push(format!("{key} has no effect: {why}"));
        }
    };
    of_air(scene, &mut note);
    of_friction(scene, &mut note);
    of_solver(scene, &mut note);
    of_obstacles(scene, &mut note);
    of_meshes(scene, &mut note);
    unused
}

type Note<'a> = &'a mut dyn FnMut(bool, &str, &str);

fn of_air(scene: &Scene, note: Note<'_>) {
    let (own, default) = (&scene.environment, Environment::default());
    let is_vacuum = own.air_density == 0.0;
    let why = "it needs simulation.air_density, 1.2 kg/m3 at room temperature";
    note(is_vacuum && own.wind != default.wind, "simulation.wind", why);
    note(is_vacuum && own.drag_normal != default.drag_normal, "simulation.drag_normal", why);
    note(is_vacuum && own.drag_tangential != default.drag_tangential, "simulation.drag_tangential", why);
}

fn of_meshes(scene: &Scene, note: Note<'_>) {
    for (index, body) in scene.bodies.iter().enumerate() {
        let why = "only the meshes of cloth leave out lines";
        let has_none = body.elements.is_some() && body.kind != BodyKind::Solid;
        note(has_none, &format!("body[{index}].elements"), "only solids have a choice of elements");
        note(body.drop_lines && body.kind != BodyKind::Cloth, &format!("body[{index}].drop_lines"), why);
    }
    for (index, pin) in scene.pins.iter().enumerate() {
        let is_alone = pin.roots == 0 && pin.root_end != RootEnd::First;
        note(is_alone, &format!("pin[{index}].root_end"), "it holds no roots");
    }
}

fn of_friction(scene: &Scene, note: Note<'_>) {
    let is_off = scene.contact.friction_model == FrictionModel::None;
    let off = "contact.friction_model is \"none\"";
    note(is_off && !scene.friction_pairs.is_empty(), "contact.friction_pairs", off);
    // What each side brings: it takes both to rub, and a body can rub on itself.
    let bodies = scene.bodies.iter().enumerate().map(|(i, b)| (format!("body[{i}]"), b.friction));
    let obstacles = scene.obstacles.iter().enumerate().map(|(i, o)| (format!("obstacle[{i}]"), o.friction));
    for (path, _) in bodies.chain(obstacles).filter(|(_, friction)| is_off && *friction > 0.0) {
        note(true, &format!("{path}.friction"), off);
    }
    let no_obstacle_rubs = !scene.obstacles.is_empty() && scene.obstacles.iter().all(|o| o.friction == 0.0);
    if let [body] = &scene.bodies[..] {
        let alone = !is_off && body.friction > 0.0 && no_obstacle_rubs && scene.friction_pairs.is_empty();
        let why = "none of them has friction, and both sides of a contact must";
        note(alone, "body[0].friction on obstacles", why);
    }
    let no_body_rubs = scene.bodies.iter().all(|body| body.friction == 0.0);
    for (index, obstacle) in scene.obstacles.iter().enumerate() {
        let alone = !is_off && obstacle.friction > 0.0 && no_body_rubs;
        note(
            alone,
            &format!("obstacle[{index}].friction"),
            "no body has friction, and both sides of a contact must",
        );
    }
}

fn of_solver(scene: &Scene, note: Note<'_>) {
    let isotropic = scene.solver.forward.bound == Bound::Isotropic;
    let default = Scene::with_preset(scene.preset).solver.forward;
    let swept = scene.solver.forward.swept_travel != default.swept_travel;
    note(isotropic && swept, "solver.forward.swept_travel", "it needs solver.forward.bound = \"planes\"");
    let solids = scene.bodies.iter().any(|body| body.kind == BodyKind::Solid);
    let interior = scene.simulation.interior != InteriorFollows::default();
    note(interior && !solids, "simulation.interior", "no body is a solid");
}

fn of_obstacles(scene: &Scene, note: Note<'_>) {
    let default = ObstacleSpec::default();
    for (index, obstacle) in scene.obstacles.iter().enumerate() {
        let key = |name: &str| format!("obstacle[{index}].{name}");
        let why = "the obstacle has no sequence";
        let still = obstacle.sequence.is_none();
        note(still && obstacle.sequence_rate != default.sequence_rate, &key("sequence_rate"), why);
        note(still && obstacle.sequence_start != default.sequence_start, &key("sequence_start"), why);
        let plane = matches!(obstacle.shape, Some(Shape::HalfSpace(_)));
        note(plane && obstacle.scale != 1.0, &key("scale"), "a half-space has no size");
    }
}

#[cfg(test)]
mod tests {
    use super::unused_keys;
    use crate::{BUILTIN, Scene};

    fn unused(scene: &str) -> Vec<String> {
        let text = format!("{scene}\n[[body]]\nname = \"sheet\"\nshape = \"sheet\"\n");
        unused_keys(&Scene::from_toml(&text, "").expect("a scene"))
    }

    #[test]
    fn each_key_without_effect_is_named_with_what_it_lacks() {
        for (scene, start) in [
            (
                "[simulation]\nwind = [3, 0, 0]",
                "simulation.wind has no effect: it needs simulation.air_density",
            ),
            ("[simulation]\ndrag_normal = 2", "simulation.drag_normal has no effect"),
            ("[simulation]\ninterior = \"average\"", "simulation.interior has no effect: no body is a solid"),
            (
                "[contact]\nfriction_model = \"none\"\n[[obstacle]]\nshape = \"ball\"\nfriction = 1",
                "obstacle[0].friction",
            ),
            (
                "[[obstacle]]\nshape = \"ball\"\nfriction = 1",
                "obstacle[0].friction has no effect: no body has friction",
            ),
            ("[solver.forward]\nbound = \"isotropic\"\nswept_travel = 0.5", "solver.forward.swept_travel"),
            ("[[obstacle]]\nshape = \"ball\"\nsequence_rate = 24", "obstacle[0].sequence_rate"),
            ("[[obstacle]]\nshape = \"half-space\"\nscale = 2", "obstacle[0].scale has no effect"),
        ] {
            let found = unused(scene);
            assert!(found.len() == 1 && found[0].starts_with(start), "{scene}: {found:?}");
        }
    }

    #[test]
    fn friction_that_only_the_body_itself_feels_is_named() {
        let scene = |friction: f64| {
            let ball = format!("[[obstacle]]\nshape = \"ball\"\nfriction = {friction}\n");
            format!("{ball}[[body]]\nshape = \"sheet\"\nfriction = 0.5\n")
        };
        let unused = |friction| unused_keys(&Scene::from_toml(&scene(friction), "").expect("a scene"));
        assert!(unused(0.0)[0].starts_with("body[0].friction on obstacles has no effect"));
        assert_eq!(unused(0.5), [""; 0]);
    }

    #[test]
    fn what_has_an_effect_is_not_named() {
        assert_eq!(unused("[simulation]\nwind = [3, 0, 0]\nair_density = 1.2"), [""; 0]);
        for builtin in BUILTIN {
            let scene = Scene::builtin(builtin.name, 0.2).expect("a scene");
            assert_eq!(unused_keys(&scene), [""; 0], "{}", builtin.name);
        }
    }
}
