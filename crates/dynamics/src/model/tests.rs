use super::*;
use crate::material::{ClothMaterial, ParticleMaterial, SolidMaterial, StrandMaterial};

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
    assert_eq!(model.element_sets.iter().map(|set| set.len()).sum::<usize>(), 2);
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
fn vertices_that_elements_connect_are_of_one_component() {
    let mut positions = vec![Point::new(0.0, 0.0, -1.0)];
    for height in [0.0, 1.0, 2.0] {
        positions.extend(square().0.iter().map(|x| x + Vector::z() * height));
    }
    let moved = |by: u32| square().1.into_iter().map(move |triangle| triangle.map(|v| v + by));
    // One body of two sheets, and another one.
    let bodies = vec![
        Body::obstacle("pin", vec![0]),
        cotton(moved(1).chain(moved(9)).collect()),
        cotton(moved(5).collect()),
    ];
    let components = DynamicsModel::new(positions, bodies).expect("valid").components_of_vertices();
    assert_eq!(components[0], u32::MAX);
    let sheets: Vec<&[u32]> = components[1..].chunks(4).collect();
    assert!(sheets.iter().all(|sheet| sheet.iter().all(|component| *component == sheet[0])), "{sheets:?}");
    let mut numbers: Vec<u32> = sheets.iter().map(|sheet| sheet[0]).collect();
    numbers.sort_unstable();
    assert_eq!(numbers, [0, 1, 2]);
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

    // All errors are reported.
    let material = ClothMaterial { density: -1.0, poisson_ratio: 2.0, ..ClothMaterial::cotton() };
    let text = refuse(positions, vec![Body::cloth("flag", triangles, material)]);
    assert_eq!(
        text,
        [
            "body \"flag\": density = -1 kg/m2: must be finite and above 0",
            "body \"flag\": poisson_ratio = 2: must lie between -1 and 1"
        ]
    );
}

#[test]
fn a_scene_of_obstacles_only_is_valid() {
    let (positions, _) = square();
    let model =
        DynamicsModel::new(positions, vec![Body::obstacle("floor", vec![0, 1, 2, 3])]).expect("valid");
    assert_eq!(model.total_mass(), 0.0);
    assert_eq!(model.max_stretch(model.rest_positions()), 0.0);
}

/// A unit cube as six tets around its diagonal, all positive.
fn cube() -> (Vec<Point>, Vec<[u32; 4]>) {
    let positions =
        (0..8).map(|k| Point::new((k & 1) as f64, (k >> 1 & 1) as f64, (k >> 2 & 1) as f64)).collect();
    let tets = vec![[0, 1, 3, 7], [0, 3, 2, 7], [0, 2, 6, 7], [0, 6, 4, 7], [0, 4, 5, 7], [0, 5, 1, 7]];
    (positions, tets)
}

#[test]
fn masses_of_every_kind_add_up() {
    let (mut positions, tets) = cube();
    // A strand from the cube's corner 7, and a grain.
    positions.extend([Point::new(1.0, 1.0, 1.5), Point::new(1.0, 1.0, 1.75), Point::new(9.0, 0.0, 0.0)]);
    let (solid, hair, sand) = (SolidMaterial::foam(), StrandMaterial::rope(), ParticleMaterial::sand());
    let bodies = vec![
        Body::solid("block", tets, solid),
        Body::strands("rope", vec![[7, 8], [8, 9]], hair),
        Body::particles("grain", vec![10], sand).with_gravity(Vector::zeros()),
    ];
    let model = DynamicsModel::new(positions, bodies).expect("valid");
    let m = model.masses();
    let close = |a: f64, b: f64| (a - b).abs() < 1e-12 * b;
    assert!(close(m[..7].iter().sum::<f64>() + m[7], solid.density + 0.25 * hair.density), "{m:?}");
    assert!(close(m[7], 0.25 * solid.density + 0.25 * hair.density));
    assert!(close(m[8], 0.375 * hair.density) && close(m[9], 0.125 * hair.density));
    assert!(close(m[10], sand.mass()));
    assert_eq!(model.components, [0..10, 10..11]);
}

#[test]
fn refusals_of_tets_strands_and_grains_name_what_is_wrong() {
    let refuse = |positions: Vec<Point>, body: Body| -> Vec<String> {
        let errors = DynamicsModel::new(positions, vec![body]).expect_err("must be refused");
        errors.iter().map(ToString::to_string).collect()
    };
    let (positions, mut tets) = cube();
    tets.iter_mut().for_each(|t| t.swap(0, 1));
    tets.extend((0..8).map(|k| [k % 4, 4 + k % 4, 1 + k, 7]));
    let block = |tets: Vec<[u32; 4]>| Body::solid("block", tets, SolidMaterial::default());
    let text = refuse(positions.clone(), block(tets[..6].to_vec()));
    assert_eq!(
        text,
        ["body \"block\": 6 of its 6 tets are inverted at rest (0, 1, 2, 3, 4, 5) and 0 are flat: mend the \
          mesh (of a mesh that is inverted throughout, swap two vertices of every tet)"]
    );
    let text = refuse(positions.clone(), block(vec![[0, 1, 2, 3]]));
    assert!(text[0].contains("0 of its 1 tets are inverted at rest and 1 are flat (0): mend"), "{text:?}");
    // All are listed in the error; the message shows ten.
    let many: Vec<Point> = (0..12)
        .flat_map(|k| {
            [[0., 0., 0.], [0., 1., 0.], [1., 0., 0.], [0., 0., 1.]]
                .map(|[x, y, z]| Point::new(x + 3.0 * k as f64, y, z))
        })
        .collect();
    let errors = DynamicsModel::new(
        many,
        vec![block((0..12).map(|k| [4 * k, 4 * k + 1, 4 * k + 2, 4 * k + 3]).collect())],
    )
    .expect_err("inverted");
    assert!(matches!(&errors[..], [ModelError::BadTets { inverted, .. }] if inverted.len() == 12));
    assert!(errors[0].to_string().contains("(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, ..)"), "{}", errors[0]);

    let line = vec![Point::new(1.0, 0.0, 0.0), Point::new(1.0, 0.0, 0.0), Point::new(2.0, 0.0, 0.0)];
    let text = refuse(line.clone(), Body::strands("hair", vec![[0, 1], [1, 2]], StrandMaterial::default()));
    assert_eq!(
        text,
        ["body \"hair\": edge 0 has no length at rest, vertices 0 and 1 are at one place: merge them"]
    );
    let text =
        refuse(line.clone(), Body::strands("hair", vec![[0, 2], [1, 1], [2, 0]], StrandMaterial::default()));
    assert_eq!(
        text,
        ["body \"hair\": edge 1 names vertex 1 twice", "body \"hair\": edges 0 and 2 have the same vertices"]
    );
    let text =
        refuse(line.clone(), Body::particles("sand", vec![0, 1, 2, 3, 1], ParticleMaterial::default()));
    assert_eq!(
        text,
        [
            "body \"sand\": particle 3 names vertex 3, but there are only 3 vertices",
            "body \"sand\": particles 1 and 4 have the same vertices"
        ]
    );
    let heavy = Body::particles("sand", vec![0, 1, 2], ParticleMaterial::default())
        .with_gravity(Vector::repeat(f64::NAN));
    assert_eq!(refuse(line, heavy), ["body \"sand\": the components of its gravity must be finite"]);
}

#[test]
fn a_warp_normal_to_triangles_is_refused_for_woven_cloth_only() {
    let (positions, triangles) = square();
    let upright = ClothMaterial { warp_direction: Vector::z() * 2.0, ..ClothMaterial::cotton() };
    let body = |material| vec![Body::cloth("flag", triangles.clone(), material)];
    DynamicsModel::new(positions.clone(), body(upright)).expect("isotropic: the warp has no effect");
    let woven = ClothMaterial { shear_stiffness: Some(5.0), ..upright };
    let errors = DynamicsModel::new(positions.clone(), body(woven)).expect_err("no projection");
    assert_eq!(
        errors[0].to_string(),
        "body \"flag\": warp_direction is normal to 2 of its triangles (0, 1): choose a direction along the \
         cloth"
    );
    let along = ClothMaterial { warp_direction: Vector::new(0.0, 1.0, 9.0), ..woven };
    let model = DynamicsModel::new(positions, body(along)).expect("projected");
    assert_eq!(model.element_sets.iter().map(|set| set.len()).sum::<usize>(), 2);
}
