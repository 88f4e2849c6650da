//! Elements of a caller: springs against theory and against those of strands, momentum, threads, and what is
//! refused.

use crate::common::{cloth_model, sheet, strands, weightless, with_gravity, with_tolerance};
use bowknot_dynamics::{
    Body, ClothMaterial, CustomElement, Dynamics, DynamicsModel, ElementGroup, ElementMatrix, ElementProblem,
    ModelError, ParticleMaterial, StepError, StrandMaterial, check_derivatives,
};
use bowknot_geometry::{Point, Vector};
use nalgebra::Matrix3;
use std::sync::Arc;

/// Energy k/2 (length - rest)^2 between two vertices.
#[derive(Debug)]
struct Spring {
    vertices: [u32; 2],
    stiffness: f64,
    rest: f64,
}

pub fn spring(vertices: [u32; 2], stiffness: f64, rest: f64) -> Arc<dyn CustomElement> {
    Arc::new(Spring { vertices, stiffness, rest })
}

impl CustomElement for Spring {
    fn vertices(&self) -> &[u32] {
        &self.vertices
    }

    fn energy(&self, x: &[Point]) -> f64 {
        0.5 * self.stiffness * ((x[1] - x[0]).norm() - self.rest).powi(2)
    }

    fn gradient(&self, x: &[Point], gradient: &mut [Vector]) {
        let way = x[1] - x[0];
        gradient[1] = way * (self.stiffness * (1.0 - self.rest / way.norm()));
        gradient[0] = -gradient[1];
    }

    fn hessian(&self, x: &[Point], hessian: &mut ElementMatrix<'_>) {
        let way = x[1] - x[0];
        let (length, n) = (way.norm(), way.normalize());
        let along = n * n.transpose();
        let across = (Matrix3::identity() - along) * (1.0 - self.rest / length);
        let block = (along + across) * self.stiffness;
        hessian.add(0, 0, &block);
        hessian.add(1, 1, &block);
        hessian.add(0, 1, &-block);
    }

    fn is_invariant(&self) -> bool {
        true
    }
}

/// A force that pulls a vertex.
#[derive(Debug)]
struct Pull {
    vertex: [u32; 1],
    force: Vector,
}

impl CustomElement for Pull {
    fn vertices(&self) -> &[u32] {
        &self.vertex
    }

    fn energy(&self, x: &[Point]) -> f64 {
        -self.force.dot(&x[0].coords)
    }

    fn gradient(&self, _x: &[Point], gradient: &mut [Vector]) {
        gradient[0] = -self.force;
    }

    fn hessian(&self, _x: &[Point], _hessian: &mut ElementMatrix<'_>) {}

    fn is_positive_semidefinite(&self) -> bool {
        true
    }
}

/// Energy -s log z, which keeps a vertex above 0; without `barrier` it is not a number below.
#[derive(Debug)]
struct Logarithm {
    vertex: [u32; 1],
    strength: f64,
    barrier: bool,
}

impl CustomElement for Logarithm {
    fn vertices(&self) -> &[u32] {
        &self.vertex
    }

    fn energy(&self, x: &[Point]) -> f64 {
        if self.barrier && x[0].z <= 0.0 { f64::INFINITY } else { -self.strength * x[0].z.ln() }
    }

    fn gradient(&self, x: &[Point], gradient: &mut [Vector]) {
        gradient[0].z = -self.strength / x[0].z;
    }

    fn hessian(&self, x: &[Point], hessian: &mut ElementMatrix<'_>) {
        hessian.add(0, 0, &Matrix3::from_diagonal(&Vector::new(0.0, 0.0, self.strength / (x[0].z * x[0].z))));
    }
}

pub fn group(elements: Vec<Arc<dyn CustomElement>>) -> Vec<ElementGroup> {
    vec![ElementGroup::new("own", elements)]
}

/// Grains of 1 g at these places.
pub fn grains(places: &[Point]) -> DynamicsModel {
    let radius = 0.005;
    let volume = 4.0 / 3.0 * std::f64::consts::PI * radius * radius * radius;
    let material = ParticleMaterial { density: 1e-3 / volume, radius };
    let body = Body::particles("grains", (0..places.len() as u32).collect(), material);
    DynamicsModel::new(places.to_vec(), vec![body]).expect("valid")
}

#[test]
fn derivatives_of_the_elements_here_are_right() {
    let x = [Point::new(0.1, 0.2, 0.3), Point::new(0.5, -0.1, 0.4)];
    check_derivatives(&*spring([0, 1], 30.0, 0.3), &x).expect("right");
    check_derivatives(&*spring([0, 1], 30.0, 0.8), &x).expect("right");
    check_derivatives(&Pull { vertex: [0], force: Vector::new(1.0, 2.0, 3.0) }, &x[..1]).expect("right");
    let errors =
        check_derivatives(&Logarithm { vertex: [0], strength: 2.0, barrier: true }, &x[..1]).expect("right");
    assert!(errors.rigid_motion > 0.01 && errors.smallest_eigenvalue >= 0.0, "{errors:?}");
}

#[test]
fn a_weight_hangs_on_a_spring_and_swings_with_its_period() {
    let (stiffness, mass, rest): (f64, f64, f64) = (1.0, 1e-3, 0.1);
    let places = [Point::origin(), Point::new(0.0, 0.0, -rest)];
    let model = grains(&places).with_elements(group(vec![spring([0, 1], stiffness, rest)])).expect("valid");
    assert_eq!(model.components_of_vertices(), [0, 0]);
    let mut dynamics = Dynamics::new(model, with_tolerance(1e-10)).expect("valid");
    let (mut x, mut v, dt) = (places.to_vec(), vec![Vector::zeros(); 2], 2e-4);
    let period = 2.0 * std::f64::consts::PI * (mass / stiffness).sqrt();
    let lowest = -rest - mass * 9.81 / stiffness;
    let mut crossings = Vec::new();
    for step in 0..(3.2 * period / dt) as usize {
        let before = x[1].z - lowest;
        dynamics.solve_step(&mut x, &mut v, dt, &[true, false], &places, 4).expect("a step");
        let after = x[1].z - lowest;
        if before * after < 0.0 {
            crossings.push((step as f64 + before / (before - after)) * dt);
        }
    }
    // It begins at the top, a quarter of a period before it first passes the middle.
    assert_eq!(crossings.len(), 6);
    let measured = (crossings[5] - crossings[1]) / 2.0;
    assert!((measured / period - 1.0).abs() < 1e-3, "{measured} s in place of {period} s");
    for _ in 0..4000 {
        v[1] *= 0.9;
        dynamics.solve_step(&mut x, &mut v, 1e-3, &[true, false], &places, 2).expect("a step");
    }
    assert!((x[1].z - lowest).abs() < 1e-9, "{} m below its rest", lowest - x[1].z);
    let energies = dynamics.model().elastic_energies(&x);
    let expected = 0.5 * (mass * 9.81).powi(2) / stiffness;
    assert!((energies.custom / expected - 1.0).abs() < 1e-6 && energies.total() == energies.custom);
}

/// A strand that lies along x.
fn aside() -> (Vec<Point>, Vec<[u32; 2]>) {
    let (places, edges) = strands(1, 20, 0.5, 0.0);
    (places.iter().map(|x| Point::new(x.coords.norm(), 0.0, 0.0)).collect(), edges)
}

#[test]
fn springs_do_what_those_of_strands_do() {
    let run = |stiffness: f64, own: f64| {
        let (rest, edges) = aside();
        let material =
            StrandMaterial { stretch_stiffness: stiffness, bend_stiffness: 0.0, ..StrandMaterial::yarn() };
        let model = DynamicsModel::new(rest.clone(), vec![Body::strands("rope", edges.clone(), material)]);
        let model = model.expect("valid");
        let length = |&[a, b]: &[u32; 2]| (rest[a as usize] - rest[b as usize]).norm();
        let springs = edges.iter().map(|edge| spring(*edge, own / length(edge), length(edge)));
        let springs = if own > 0.0 { group(springs.collect()) } else { Vec::new() };
        let model = model.with_elements(springs).expect("valid");
        let mut dynamics = Dynamics::new(model, with_tolerance(1e-10)).expect("valid");
        let (mut x, mut v) = (rest.clone(), vec![Vector::zeros(); rest.len()]);
        let held: Vec<bool> = (0..rest.len()).map(|vertex| vertex == 0).collect();
        for _ in 0..30 {
            dynamics.solve_step(&mut x, &mut v, 0.01, &held, &rest, 8).expect("a step");
        }
        x
    };
    let (built_in, mixed) = (run(2.0, 0.0), run(0.5, 1.5));
    let off = built_in.iter().zip(&mixed).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
    let way = built_in.iter().zip(&aside().0).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
    assert!(way > 0.1 && off < 1e-6 * way, "{off} of {way} m");
}

/// Two sheets that a spring joins, spinning.
#[test]
fn momentum_of_bodies_that_springs_join_is_conserved() {
    let (mut places, mut triangles) = sheet(0.2, 0.2, 4, 4);
    let count = places.len() as u32;
    places.extend(places.clone().iter().map(|x| x + Vector::new(0.3, 0.1, 0.2)));
    triangles.extend(triangles.clone().iter().map(|t| t.map(|v| v + count)));
    let springs = vec![spring([0, count], 5.0, 0.1), spring([7, count + 12], 20.0, 0.5)];
    let model = cloth_model(&places, triangles, ClothMaterial::cotton())
        .with_elements(group(springs))
        .expect("valid");
    let mut dynamics = Dynamics::new(model, weightless(with_tolerance(1e-3))).expect("valid");
    let mut v: Vec<Vector> = places
        .iter()
        .map(|x| Vector::new(0.5, 0.0, 0.2) + Vector::new(1.0, 4.0, 2.0).cross(&x.coords))
        .collect();
    let mut x = places;
    let (p, l) = (dynamics.momentum(&v), dynamics.angular_momentum(&x, &v));
    let free = vec![false; x.len()];
    for _ in 0..50 {
        let keyframes = x.clone();
        dynamics.solve_step(&mut x, &mut v, 0.01, &free, &keyframes, 2).expect("a step");
    }
    assert!((dynamics.momentum(&v) - p).norm() < 1e-13 * p.norm());
    let turned = dynamics.angular_momentum(&x, &v) - l;
    assert!(turned.norm() < 1e-12 * l.norm(), "{turned} of {l}");
}

#[test]
fn an_outer_force_gives_a_free_body_its_momentum() {
    let (places, triangles) = sheet(0.2, 0.2, 4, 4);
    let force = Vector::new(0.01, 0.0, 0.03);
    let pull = vec![Arc::new(Pull { vertex: [3], force }) as Arc<dyn CustomElement>];
    let model =
        cloth_model(&places, triangles, ClothMaterial::cotton()).with_elements(group(pull)).expect("valid");
    let mut dynamics = Dynamics::new(model, weightless(with_tolerance(1e-8))).expect("valid");
    let (mut x, mut v) = (places.clone(), vec![Vector::zeros(); places.len()]);
    for _ in 0..20 {
        dynamics.solve_step(&mut x, &mut v, 0.01, &vec![false; places.len()], &places, 6).expect("a step");
    }
    let off = (dynamics.momentum(&v) - force * 0.2).norm();
    assert!(off < 1e-6 * force.norm() * 0.2, "{off} of {}", force.norm() * 0.2);
}

#[test]
fn results_have_the_same_bits_for_any_number_of_threads() {
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        pool.install(|| {
            let (places, triangles) = sheet(1.0, 1.0, 40, 40);
            let springs =
                (0..800).map(|k| spring([(k * 37) % 1681, (k * 37 + 200 + k % 90) % 1681], 2.0, 0.2));
            let model = cloth_model(&places, triangles, ClothMaterial::cotton());
            let model = model.with_elements(group(springs.collect())).expect("valid");
            let mut dynamics = Dynamics::new(model, with_tolerance(1e-4)).expect("valid");
            let (mut x, mut v) = (places.clone(), vec![Vector::zeros(); places.len()]);
            let held: Vec<bool> = (0..places.len()).map(|vertex| vertex < 41).collect();
            for _ in 0..3 {
                dynamics.solve_step(&mut x, &mut v, 0.01, &held, &places, 2).expect("a step");
            }
            let moved = x.iter().zip(&places).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
            assert!(moved > 0.005, "{moved}");
            x.iter().flat_map(|x| [x.x, x.y, x.z].map(f64::to_bits)).collect::<Vec<u64>>()
        })
    };
    let one = run(1);
    assert!(one == run(2) && one == run(3));
}

#[test]
fn no_elements_change_no_bit() {
    let run = |groups: Option<Vec<ElementGroup>>| {
        let (places, triangles) = sheet(0.3, 0.3, 8, 8);
        let mut model = cloth_model(&places, triangles, ClothMaterial::cotton());
        if let Some(groups) = groups {
            model = model.with_elements(groups).expect("valid");
        }
        let mut dynamics = Dynamics::new(model, with_tolerance(1e-4)).expect("valid");
        let (mut x, mut v) = (places.clone(), vec![Vector::zeros(); places.len()]);
        let held: Vec<bool> = (0..places.len()).map(|vertex| vertex < 9).collect();
        for _ in 0..3 {
            dynamics.solve_step(&mut x, &mut v, 0.01, &held, &places, 2).expect("a step");
        }
        x
    };
    assert_eq!(run(None), run(Some(Vec::new())));
    assert_eq!(run(None), run(Some(group(Vec::new()))));
}

#[test]
fn rest_lengths_change_between_time_steps() {
    let places = [Point::origin(), Point::new(0.1, 0.0, 0.0)];
    let only = |rest: f64| vec![spring([0, 1], 4.0, rest)];
    let model = grains(&places).with_elements(group(only(0.1))).expect("valid");
    let mut dynamics = Dynamics::new(model, weightless(with_tolerance(1e-8))).expect("valid");
    let (mut x, mut v) = (places.to_vec(), vec![Vector::zeros(); 2]);
    let step = |dynamics: &mut Dynamics, x: &mut [Point], v: &mut [Vector]| {
        for _ in 0..200 {
            v.iter_mut().for_each(|v| *v *= 0.8);
            dynamics.solve_step(x, v, 0.005, &[true, false], &places, 3).expect("a step");
        }
    };
    step(&mut dynamics, &mut x, &mut v);
    assert_eq!(x, places, "at rest");
    dynamics.replace_elements("own", only(0.15)).expect("the same vertices");
    step(&mut dynamics, &mut x, &mut v);
    assert!((x[1].x - 0.15).abs() < 1e-9, "{}", x[1].x);

    let refused = |dynamics: &mut Dynamics, name: &str, elements| {
        dynamics.replace_elements(name, elements).expect_err("refused").to_string()
    };
    assert_eq!(refused(&mut dynamics, "mine", only(0.1)), "no custom elements \"mine\"; there are: own");
    assert_eq!(refused(&mut dynamics, "own", Vec::new()), "custom elements \"own\": 0 given in place of 1");
    assert_eq!(
        refused(&mut dynamics, "own", vec![spring([1, 0], 4.0, 0.1)]),
        "custom element 0 of \"own\": it would replace one with the vertices [0, 1] and must have the same: \
         remove and add elements anew"
    );
}

#[test]
fn a_line_search_stays_where_an_energy_is_defined() {
    let places = [Point::new(0.0, 0.0, 0.02)];
    let barrier = |barrier| {
        vec![Arc::new(Logarithm { vertex: [0], strength: 1e-6, barrier }) as Arc<dyn CustomElement>]
    };
    let run = |barrier| {
        let model = grains(&places).with_elements(group(barrier)).expect("valid");
        let mut dynamics = Dynamics::new(model, with_tolerance(1e-8)).expect("valid");
        let (mut x, mut v) = (places.to_vec(), vec![Vector::new(0.0, 0.0, -4.0)]);
        for _ in 0..20 {
            dynamics.solve_step(&mut x, &mut v, 0.01, &[false], &places, 10)?;
            assert!(x[0].z > 0.0, "{}", x[0].z);
        }
        Ok(())
    };
    run(barrier(true)).expect("infinite below");
    let error: StepError = run(barrier(false)).expect_err("not a number below");
    assert_eq!(error, StepError::CustomElement { group: "own".to_owned(), index: 0, quantity: "energy" });
    assert_eq!(error.to_string(), "custom element 0 of \"own\": its energy is not finite");
}

/// A law of which a quantity is not a number.
#[derive(Debug)]
struct Broken {
    vertices: [u32; 2],
    quantity: &'static str,
}

impl CustomElement for Broken {
    fn vertices(&self) -> &[u32] {
        &self.vertices
    }

    fn energy(&self, _x: &[Point]) -> f64 {
        if self.quantity == "energy" { f64::NAN } else { 0.0 }
    }

    fn gradient(&self, _x: &[Point], gradient: &mut [Vector]) {
        gradient[1].y = if self.quantity == "gradient" { f64::INFINITY } else { 0.0 };
    }

    fn hessian(&self, _x: &[Point], hessian: &mut ElementMatrix<'_>) {
        let value = if self.quantity == "Hessian" { f64::NAN } else { 0.0 };
        hessian.add(0, 1, &Matrix3::from_diagonal_element(value));
    }
}

#[test]
fn what_is_not_finite_ends_the_step_and_names_the_element() {
    let (places, triangles) = sheet(0.2, 0.2, 4, 4);
    for quantity in ["energy", "gradient", "Hessian"] {
        let broken = Arc::new(Broken { vertices: [20, 3], quantity }) as Arc<dyn CustomElement>;
        let elements = vec![spring([0, 9], 1.0, 0.1), broken, spring([1, 9], 1.0, 0.1)];
        let model =
            cloth_model(&places, triangles.clone(), ClothMaterial::cotton()).with_elements(group(elements));
        let mut dynamics = Dynamics::new(model.expect("valid"), with_tolerance(1e-4)).expect("valid");
        let (mut x, mut v) = (places.clone(), vec![Vector::zeros(); places.len()]);
        let free = vec![false; places.len()];
        let error = dynamics.solve_step(&mut x, &mut v, 0.01, &free, &places, 2).expect_err("not finite");
        assert_eq!(error, StepError::CustomElement { group: "own".to_owned(), index: 1, quantity });
        assert_eq!(x, places, "the state is that before the step");
        dynamics.begin_step(&x, &v, 0.01).expect("a step");
        for _ in 0..2 {
            let again =
                dynamics.newton_target(&x, &free, &places, &mut places.clone()).expect_err("not finite");
            assert_eq!(again, error, "whatever was computed before");
        }
        // The step can be made once the element is a sound one.
        let sound = vec![spring([0, 9], 1.0, 0.1), spring([20, 3], 1.0, 0.1), spring([1, 9], 1.0, 0.1)];
        dynamics.replace_elements("own", sound).expect("the same vertices");
        dynamics.solve_step(&mut x, &mut v, 0.01, &free, &places, 2).expect("finite");
    }
}

#[test]
fn refusals_name_the_element_and_the_reason() {
    let mut places = sheet(0.2, 0.2, 2, 2).0;
    places.push(Point::new(0.0, 0.0, 1.0));
    let cloth = Body::cloth("sheet", sheet(0.2, 0.2, 2, 2).1, ClothMaterial::cotton());
    let model = || {
        DynamicsModel::new(places.clone(), vec![cloth.clone(), Body::obstacle("hook", vec![9])])
            .expect("valid")
    };
    let elements = vec![
        spring([0, 1], 1.0, 0.1),
        spring([0, 10], 1.0, 0.1),
        spring([3, 3], 1.0, 0.1),
        spring([9, 3], 1.0, 0.1),
    ];
    let mut groups = group(elements);
    groups.extend(group(Vec::new()));
    let errors = model().with_elements(groups).expect_err("refused");
    let text: Vec<String> = errors.iter().map(ToString::to_string).collect();
    assert_eq!(
        text,
        [
            "custom element 1 of \"own\": it names vertex 10, but there are only 10 vertices",
            "custom element 2 of \"own\": it names vertex 3 twice",
            "custom element 3 of \"own\": vertex 9 belongs to the obstacle \"hook\", which no element moves: let \
             the element hold that place itself, and replace it where the obstacle moves",
            "two groups of custom elements have the name \"own\"; names must differ",
        ]
    );
    #[derive(Debug)]
    struct Long(Vec<u32>);
    impl CustomElement for Long {
        fn vertices(&self) -> &[u32] {
            &self.0
        }
        fn energy(&self, _x: &[Point]) -> f64 {
            0.0
        }
        fn gradient(&self, _x: &[Point], _gradient: &mut [Vector]) {}
        fn hessian(&self, _x: &[Point], _hessian: &mut ElementMatrix<'_>) {}
    }
    for given in [0, 17] {
        let long = Arc::new(Long((0..given).collect())) as Arc<dyn CustomElement>;
        let errors = model().with_elements(group(vec![long])).expect_err("refused");
        let problem = ElementProblem::Count { given: given as usize, most: 16 };
        assert_eq!(errors[..], [ModelError::CustomElement { group: "own".to_owned(), index: 0, problem }]);
    }
}

/// A rope of grains between two pins of a sheet: nodes of two bodies in one element, prescribed and free
/// ones.
#[test]
fn elements_join_bodies_and_vertices_that_are_prescribed() {
    let (mut places, triangles) = sheet(0.2, 0.2, 4, 4);
    let count = places.len() as u32;
    places.push(Point::new(0.0, 0.0, -0.2));
    let weight = ParticleMaterial { density: 1000.0, radius: 0.01 };
    let bodies = vec![
        Body::cloth("sheet", triangles, ClothMaterial::cotton()),
        Body::particles("weight", vec![count], weight),
    ];
    let model = DynamicsModel::new(places.clone(), bodies).expect("valid");
    let model = model.with_elements(group(vec![spring([0, count], 10.0, 0.2)])).expect("valid");
    let params = with_gravity(with_tolerance(1e-8), Vector::new(0.0, 0.0, -10.0));
    let mut dynamics = Dynamics::new(model, params).expect("valid");
    let (mut x, mut v) = (places.clone(), vec![Vector::zeros(); places.len()]);
    let held: Vec<bool> = (0..places.len() as u32).map(|vertex| vertex < count).collect();
    for _ in 0..300 {
        v.iter_mut().for_each(|v| *v *= 0.9);
        dynamics.solve_step(&mut x, &mut v, 0.01, &held, &places, 3).expect("a step");
    }
    let load = dynamics.model().masses()[count as usize] * 10.0;
    let stretched = places[0].z - x[count as usize].z - 0.2;
    assert!((stretched - load / 10.0).abs() < 1e-6, "{stretched} m under {load} N");
    // What holds the corner must carry the weight and its share of the sheet.
    dynamics.begin_step(&x, &v, 0.01).expect("a step");
    dynamics.residual(&x, &held, &vec![true; places.len()]).expect("a residual");
    let own = dynamics.model().masses()[0] * 10.0;
    let force = dynamics.holding_force(0).expect("of the CPU").z;
    assert!((force - load - own).abs() < 1e-3 * load, "{force} N for {load} N and {own} N");
}
