//! Meshes that are given by their arrays.

use crate::shapes::{MeshArrays, Shape};
use crate::{BodyKind, BodySpec, ObstacleSpec, PinSpec, Scene, World};
use bowknot_geometry::{Point, Vector};

/// The corners of a tetrahedron.
fn corners() -> Vec<Point> {
    [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(Point::from).to_vec()
}

/// A body of each kind, apart from each other, an obstacle of a surface and one of tetrahedra.
fn scene() -> Scene {
    let triangles = vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
    let meshes = [
        MeshArrays::surface(corners(), vec![[0, 1, 2], [1, 3, 2]]),
        MeshArrays::volume(corners(), vec![[0, 1, 2, 3]]),
        MeshArrays::strands(corners(), vec![[0, 1], [1, 2], [2, 3]]),
        MeshArrays::points(corners()),
    ];
    let body = |(k, mesh): (usize, MeshArrays)| BodySpec {
        translate: Vector::new(0.0, 0.0, 2.0 * (k + 1) as f64),
        ..BodySpec::from_arrays(["cloth", "solid", "strands", "grains"][k], mesh)
    };
    let obstacles = vec![
        ObstacleSpec::from_arrays("surface", MeshArrays::surface(corners(), triangles)),
        ObstacleSpec {
            translate: Vector::new(2.0, 0.0, 0.0),
            ..ObstacleSpec::from_arrays("volume", MeshArrays::volume(corners(), vec![[0, 1, 2, 3]]))
        },
    ];
    let pins = vec![PinSpec { body: "cloth".to_owned(), vertices: vec![1], ..PinSpec::default() }];
    let bodies = meshes.into_iter().enumerate().map(body).collect();
    let mut scene = Scene { bodies, obstacles, pins, ..Scene::default() };
    scene.simulation.name = "arrays".to_owned();
    scene
}

fn problems(change: impl Fn(&mut MeshArrays)) -> String {
    let mut scene = scene();
    let Some(Shape::Arrays(mesh)) = &mut scene.bodies[0].shape else { panic!("a mesh by its arrays") };
    change(mesh);
    World::new(&scene).expect_err("a faulty mesh").to_string()
}

#[test]
fn each_kind_of_body_and_obstacle_can_be_given_by_arrays() {
    let world = World::new(&scene()).expect("a world");
    let kinds: Vec<_> = world.bodies.iter().map(|body| body.kind).collect();
    assert_eq!(kinds[..4], BodyKind::ALL.map(Some));
    assert_eq!(kinds[4..], [None, None]);
    assert!(world.bodies.iter().all(|body| body.vertices.len() == 4));
    let first = world.bodies[0].vertices.start as usize;
    assert_eq!(world.positions[first + 1], corners()[1] + Vector::new(0.0, 0.0, 2.0));
    assert_eq!(world.pins[0].vertices, [1]);
    let of_volume =
        world.collision.topology().triangles.iter().filter(|t| world.bodies[5].vertices.contains(&t[0]));
    assert_eq!(of_volume.count(), 4, "the surface of the tetrahedron");
}

#[test]
fn arrays_are_part_of_the_scene_as_data() {
    let scene = scene();
    for text in [scene.to_toml(), scene.to_short_toml()] {
        assert!(Scene::from_toml(&text, "").expect("a scene") == scene, "{text}");
    }
    let text = toml::to_string(&scene).expect("text");
    assert!(toml::from_str::<Scene>(&text).expect("a scene") == scene, "{text}");
    // These numbers have few digits; of others JSON may lose the last bit.
    let text = serde_json::to_string(&scene).expect("text");
    let read: Scene = serde_json::from_str(&text).expect("a scene");
    assert!(read.bodies.iter().zip(&scene.bodies).all(|(a, b)| a.shape == b.shape), "{text}");
    assert_eq!((read.obstacles, read.pins), (scene.obstacles, scene.pins));
}

#[test]
fn faulty_arrays_are_refused_with_their_place() {
    let missing = problems(|mesh| mesh.triangles[1][2] = 9);
    assert!(missing.contains("body[0].shape.triangles") && missing.contains("triangle 1"), "{missing}");
    let repeated = problems(|mesh| mesh.triangles[1] = [0, 1, 1]);
    assert!(repeated.contains("body[0].shape.triangles"), "{repeated}");
    let infinite = problems(|mesh| mesh.positions[2].y = f64::NAN);
    assert!(infinite.contains("vertex 2") && infinite.contains("finite"), "{infinite}");
    let flat = problems(|mesh| mesh.positions[3] = mesh.positions[1]);
    assert!(flat.contains("cloth") && flat.contains("area"), "{flat}");
    let mixed = problems(|mesh| mesh.tets = vec![[0, 1, 2, 3]]);
    assert!(mixed.contains("kind solid"), "{mixed}");
    let empty = problems(|mesh| *mesh = MeshArrays::default());
    assert!(empty.contains("needs vertices"), "{empty}");
}
