use super::*;

fn square() -> (Vec<Point>, Vec<[u32; 3]>) {
    let positions = vec![
        Point::new(0.0, 0.0, 0.0),
        Point::new(1.0, 0.0, 0.0),
        Point::new(1.0, 1.0, 0.0),
        Point::new(0.0, 1.0, 0.0),
    ];
    (positions, vec![[0, 1, 2], [0, 2, 3]])
}

fn cotton(triangles: Vec<[u32; 3]>) -> Body {
    Body::cloth("sheet", triangles, ClothMaterial::cotton())
}

#[test]
fn masses_are_thirds_of_areas() {
    let (positions, triangles) = square();
    let model = DynamicsModel::new(positions, vec![cotton(triangles)]).expect("valid");
    let density = ClothMaterial::cotton().density;
    let expected = [1.0 / 3.0, 1.0 / 6.0, 1.0 / 3.0, 1.0 / 6.0];
    for (mass, share) in model.masses().iter().zip(expected) {
        assert!((mass - share * density).abs() < 1e-15);
    }
    assert!((model.total_mass() - density).abs() < 1e-15);
    assert_eq!(model.families.iter().map(|f| f.len()).sum::<usize>(), 2);
    assert_eq!(model.edges.len(), 5);
}

#[test]
fn obstacles_have_no_mass_and_no_nodes() {
    let (mut positions, triangles) = square();
    positions.push(Point::new(0.0, 0.0, -1.0));
    let bodies = vec![cotton(triangles), Body::obstacle("pin", vec![4])];
    let model = DynamicsModel::new(positions, bodies).expect("valid");
    assert_eq!(model.masses()[4], 0.0);
    assert_eq!(model.obstacle(), [false, false, false, false, true]);
    assert_eq!(model.vertex_node[4], NO_NODE);
    assert_eq!(model.body_name(4), "pin");
}

#[test]
fn refusals_name_body_element_and_reason() {
    let (positions, triangles) = square();
    let refuse = |positions: Vec<Point>, bodies: Vec<Body>| -> Vec<String> {
        let errors = DynamicsModel::new(positions, bodies).expect_err("must be refused");
        errors.iter().map(ToString::to_string).collect()
    };
    let with = |extra: [u32; 3]| {
        let mut triangles = triangles.clone();
        triangles.push(extra);
        vec![cotton(triangles)]
    };

    let text = refuse(positions.clone(), with([0, 1, 9]));
    assert_eq!(text, ["body \"sheet\": triangle 2 names vertex 9, but there are only 4 vertices"]);
    let text = refuse(positions.clone(), with([1, 1, 2]));
    assert_eq!(text, ["body \"sheet\": triangle 2 names vertex 1 twice"]);
    let text = refuse(positions.clone(), with([2, 0, 1]));
    assert_eq!(text, ["body \"sheet\": triangles 0 and 2 have the same vertices"]);

    let mut line = positions.clone();
    line.push(Point::new(2.0, 0.0, 0.0));
    let text = refuse(line.clone(), with([0, 1, 4]));
    assert_eq!(text, ["body \"sheet\": triangle 2 has no area at rest (0e0 m2)"]);
    let text = refuse(line.clone(), vec![cotton(triangles.clone())]);
    assert_eq!(text, ["vertex 4 belongs to no body, so it has no mass"]);

    let bodies = vec![cotton(triangles.clone()), Body::obstacle("ball", vec![2])];
    let text = refuse(positions.clone(), bodies);
    assert_eq!(text, ["obstacle \"ball\" and the deformable body \"sheet\" share vertex 2"]);

    let mut broken = positions.clone();
    broken[3].y = f64::NAN;
    let text = refuse(broken, vec![cotton(triangles.clone())]);
    assert_eq!(text, ["the rest position of vertex 3 is not finite"]);

    // All of the problems at once.
    let material = ClothMaterial { density: -1.0, poisson_ratio: 2.0, ..ClothMaterial::cotton() };
    let text = refuse(positions, vec![Body::cloth("flag", triangles, material)]);
    assert_eq!(text.len(), 2);
    assert!(text.iter().all(|t| t.starts_with("body \"flag\": ")), "{text:?}");
}

#[test]
fn a_scene_of_obstacles_alone_is_a_model() {
    let (positions, _) = square();
    let model =
        DynamicsModel::new(positions, vec![Body::obstacle("floor", vec![0, 1, 2, 3])]).expect("valid");
    assert_eq!(model.total_mass(), 0.0);
    assert_eq!(model.max_stretch(model.rest_positions()), 0.0);
}
