use super::*;
use crate::body::Body;
use crate::linear::system::System;
use crate::material::ClothMaterial;
use crate::params::{HessianFilter, Integrator, NewtonParams};
use crate::repulsion::SpringKind;
use crate::test_support::grid_triangles;
use nalgebra::{DMatrix, DVector, Matrix3};

/// A crumpled 5 x 4 sheet with damping of every kind, one corner prescribed.
fn crumpled() -> (Dynamics, Vec<Point>, Vec<Vector>, Vec<bool>) {
    let rest: Vec<Point> =
        (0..20).map(|k| Point::new(0.1 * f64::from(k % 5), 0.1 * f64::from(k / 5), 0.0)).collect();
    let triangles = grid_triangles(4, 3, false);
    let material = ClothMaterial {
        bend_stiffness: 1e-3,
        stretch_damping: 0.01,
        bend_damping: 0.02,
        ..ClothMaterial::cotton()
    };
    let model =
        DynamicsModel::new(rest.clone(), vec![Body::cloth("sheet", triangles, material)]).expect("valid");
    let params = DynamicsParams {
        integrator: Integrator::ImplicitEuler,
        environment: Environment { air_drag: 0.5, ..Environment::default() },
        newton: NewtonParams::default(),
    };
    let wave = |k: usize, phase: f64| (k as f64 * 1.7 + phase).sin();
    let x: Vec<Point> = rest
        .iter()
        .enumerate()
        .map(|(k, p)| p + Vector::new(wave(k, 0.0), wave(k, 1.0), 2.0 * wave(k, 2.0)) * 0.02)
        .collect();
    let v = (0..rest.len()).map(|k| Vector::new(wave(k, 3.0), wave(k, 4.0), wave(k, 5.0))).collect();
    let prescribed = (0..rest.len()).map(|k| k == 0).collect();
    (Dynamics::new(model, params).expect("valid"), x, v, prescribed)
}

/// Lets Newton's method work on the CPU.
fn with_newton<T>(dynamics: &mut Dynamics, step: &Step, run: impl FnOnce(&mut Newton<'_>) -> T) -> T {
    let Dynamics { model, params, repulsion, course, work, .. } = dynamics;
    let (watched, free) = (repulsion.watched().to_vec(), work.free.clone());
    let mut bodies = CpuBodies::new(model, params, step, work, &watched);
    run(&mut Newton {
        model,
        params,
        bodies: &mut bodies,
        repulsion,
        free: &free,
        dt: step.dt,
        is_first: step.last_target.is_none(),
        course,
        energies: BodyEnergies::default(),
    })
}

/// The time step, linearized at `x`, with the gradient of springs.
fn linearized(dynamics: &mut Dynamics, x: &[Vector]) -> Step {
    let step = dynamics.step.take().expect("begun");
    dynamics.work.x.copy_from_slice(x);
    dynamics.work.imposed.fill(Vector::zeros());
    with_newton(dynamics, &step, |newton| newton.linearize()).expect("on the CPU");
    let Dynamics { repulsion, work, .. } = dynamics;
    if repulsion.is_empty() {
        return step;
    }
    work.gradient.iter_mut().enumerate().for_each(|(n, g)| *g += repulsion.linear().gradient(n));
    step
}

/// The incremental potential at `x`.
fn potential(dynamics: &mut Dynamics, step: &Step, x: &[Vector]) -> f64 {
    dynamics.work.x.copy_from_slice(x);
    with_newton(dynamics, step, |newton| newton.place(0.0)).expect("on the CPU").0
}

fn dense(dynamics: &Dynamics, step: &Step) -> DMatrix<f64> {
    let nodes = dynamics.work.x.len();
    let mut matrix = DMatrix::zeros(3 * nodes, 3 * nodes);
    let pattern = &dynamics.model.pattern;
    for row in 0..nodes {
        let mut set = |column: usize, block: Matrix3<f64>| {
            let mut view = matrix.fixed_view_mut::<3, 3>(3 * row, 3 * column);
            view += block;
        };
        set(row, dynamics.work.values.diagonal[row]);
        for k in pattern.row(row) {
            set(pattern.columns[k] as usize, dynamics.work.values.blocks[k]);
        }
        let (columns, values) = step.scalar.off_pattern(row);
        columns
            .iter()
            .zip(values)
            .for_each(|(&column, &value)| set(column as usize, Matrix3::from_diagonal_element(value)));
    }
    matrix
}

#[test]
fn the_gradient_matches_differences_of_the_incremental_potential() {
    let (mut dynamics, x0, v0, _) = crumpled();
    dynamics.begin_step(&x0, &v0, 0.02).expect("begins");
    let nodes = dynamics.model.node_vertex.clone();
    // At a distance from the start, so that damping has an effect.
    let mut x: Vec<Vector> = nodes.iter().map(|&v| x0[v as usize].coords + v0[v as usize] * 0.01).collect();
    let step = linearized(&mut dynamics, &x);
    let gradient = dynamics.work.gradient.clone();
    let h = 1e-6;
    let scale = gradient.iter().map(|g| g.norm()).fold(0.0, f64::max);
    for node in 0..x.len() {
        for axis in 0..3 {
            let here = x[node][axis];
            let mut energy = |value: f64| {
                x[node][axis] = value;
                potential(&mut dynamics, &step, &x)
            };
            let slope = (energy(here + h) - energy(here - h)) / (2.0 * h);
            x[node][axis] = here;
            // The error is h^2 times third derivatives, about stiffness / length = 3e4 N/m^2, and rounding.
            assert!((slope - gradient[node][axis]).abs() < 1e-6 * scale, "{slope} {}", gradient[node][axis]);
        }
    }
}

/// Steps of 10^6 times the size of the body, as an ill-conditioned system can have them, once raised energies
/// from 10^-8 J to 10^240 J within one time step.
#[test]
fn a_step_that_only_raises_the_potential_is_not_taken() {
    let (mut dynamics, x0, v0, _) = crumpled();
    dynamics.begin_step(&x0, &v0, 0.02).expect("begins");
    let nodes = dynamics.model.node_vertex.clone();
    let x: Vec<Vector> = nodes.iter().map(|&v| x0[v as usize].coords).collect();
    let step = linearized(&mut dynamics, &x);
    let work = &mut dynamics.work;
    work.right_side = work.gradient.iter().map(|g| -g).collect();
    work.step = work.gradient.iter().map(|g| g * 1e6).collect();
    work.trial.clone_from(&x);
    let mut info = NewtonInfo::default();
    with_newton(&mut dynamics, &step, |newton| newton.search_line(&mut info)).expect("on the CPU");
    assert_eq!((info.step_length, info.energy_after), (0.0, info.energy_before));
    assert_eq!(dynamics.work.trial, x);
}

#[test]
fn the_matrix_is_symmetric_positive_definite_and_matches_differences_under_tension() {
    let (mut dynamics, x0, v0, _) = crumpled();
    dynamics.begin_step(&x0, &v0, 0.02).expect("begins");
    let nodes = dynamics.model.node_vertex.clone();
    let crumple: Vec<Vector> = nodes.iter().map(|&v| x0[v as usize].coords).collect();
    let step = linearized(&mut dynamics, &crumple);
    let matrix = dense(&dynamics, &step);
    assert!((&matrix - matrix.transpose()).abs().max() < 1e-12 * matrix.abs().max());
    let smallest = matrix.symmetric_eigenvalues().min();
    let inertia = dynamics.model.node_masses.iter().copied().fold(f64::INFINITY, f64::min) / (0.02 * 0.02);
    assert!(smallest > 0.9 * inertia, "smallest eigenvalue {smallest}, inertia {inertia}");

    // Every triangle stretched: nothing is filtered, H is the derivative of the gradient.
    dynamics.step = Some(step);
    let stretched: Vec<Vector> = crumple.iter().map(|x| x * 1.6).collect();
    let step = linearized(&mut dynamics, &stretched);
    let matrix = dense(&dynamics, &step);
    dynamics.step = Some(step);
    let h = 1e-6;
    for column in [0, 7, 20, 41] {
        let mut at = |offset: f64| {
            let mut x = stretched.clone();
            x[column / 3][column % 3] += offset;
            let step = linearized(&mut dynamics, &x);
            dynamics.step = Some(step);
            dynamics.work.gradient.clone()
        };
        let (plus, minus) = (at(h), at(-h));
        for row in 0..3 * stretched.len() {
            let curvature = (plus[row / 3][row % 3] - minus[row / 3][row % 3]) / (2.0 * h);
            let difference = (curvature - matrix[(row, column)]).abs();
            assert!(difference < 1e-6 * matrix.abs().max(), "({row}, {column}): off by {difference:e}");
        }
    }
}

#[test]
fn the_newton_step_equals_that_of_a_dense_solve() {
    for coarse in [false, true] {
        let (mut dynamics, x0, v0, prescribed) = crumpled();
        dynamics.work.solver = if coarse { two_level(&dynamics.model) } else { LinearSolver::default() };
        check_newton_step(dynamics, x0, v0, prescribed);
    }
}

fn check_newton_step(mut dynamics: Dynamics, x0: Vec<Point>, v0: Vec<Vector>, prescribed: Vec<bool>) {
    dynamics.params.newton.cg_tolerance = 1e-12;
    dynamics.params.newton.line_search_halvings = 0;
    dynamics.begin_step(&x0, &v0, 0.02).expect("begins");
    let mut keyframes = x0.clone();
    keyframes[0] += Vector::new(0.001, 0.002, -0.001);
    let mut y = x0.clone();
    let info = dynamics.newton_target(&x0, &prescribed, &keyframes, &mut y).expect("solves");
    assert!(info.cg.converged && info.cg.residual <= 1e-12, "{info:?}");

    let step = dynamics.step.take().expect("begun");
    let matrix = dense(&dynamics, &step);
    let unknowns: Vec<usize> = (0..3 * x0.len()).filter(|&k| dynamics.work.free[k / 3]).collect();
    let imposed =
        DVector::from_iterator(3 * x0.len(), dynamics.work.imposed.iter().flat_map(|v| [v.x, v.y, v.z]));
    let gradient =
        DVector::from_iterator(3 * x0.len(), dynamics.work.gradient.iter().flat_map(|v| [v.x, v.y, v.z]));
    let right_side = -(gradient + &matrix * imposed);
    let reduced = DMatrix::from_fn(unknowns.len(), unknowns.len(), |i, j| matrix[(unknowns[i], unknowns[j])]);
    let reduced_side = DVector::from_fn(unknowns.len(), |i, _| right_side[unknowns[i]]);
    let exact = reduced.cholesky().expect("positive definite").solve(&reduced_side);
    for (k, &unknown) in unknowns.iter().enumerate() {
        let vertex = dynamics.model.node_vertex[unknown / 3] as usize;
        let found = (y[vertex] - x0[vertex])[unknown % 3];
        assert!((found - exact[k]).abs() < 1e-9 * exact.amax(), "{found} {}", exact[k]);
    }
    assert_eq!(y[0], keyframes[0]);
}

#[test]
fn bad_input_is_refused_by_name() {
    let (mut dynamics, x, v, prescribed) = crumpled();
    let mut y = x.clone();
    assert_eq!(dynamics.newton_target(&x, &prescribed, &x, &mut y), Err(StepError::NotBegun));
    assert_eq!(dynamics.begin_step(&x, &v, 0.0), Err(StepError::TimeStep { dt: 0.0 }));
    assert!(matches!(dynamics.begin_step(&x, &v, f64::NAN), Err(StepError::TimeStep { .. })));
    assert_eq!(
        dynamics.begin_step(&x[1..], &v, 0.1),
        Err(StepError::Length { array: "x0", given: x.len() - 1, vertices: x.len() })
    );
    let mut broken = v.clone();
    broken[3].y = f64::INFINITY;
    assert_eq!(
        dynamics.begin_step(&x, &broken, 0.1),
        Err(StepError::NonFinite { array: "v0", vertex: 3, body: "sheet".into() })
    );
    assert!(dynamics.set_external_forces(&broken).is_err());
    dynamics.begin_step(&x, &v, 0.1).expect("begins");
    // Only keyframes of prescribed vertices are read.
    let mut keyframes = vec![Point::new(f64::NAN, 0.0, 0.0); x.len()];
    keyframes[0] = x[0];
    dynamics.newton_target(&x, &prescribed, &keyframes, &mut y).expect("only vertex 0 is prescribed");
    keyframes[0].z = f64::NAN;
    let error = dynamics.newton_target(&x, &prescribed, &keyframes, &mut y).expect_err("not finite");
    assert_eq!(error.to_string(), "keyframe of vertex 0 (body \"sheet\") is not finite");
}

#[test]
fn newton_converges_from_a_crumpled_state_with_either_filter() {
    for hessian_filter in [HessianFilter::Clamp, HessianFilter::Absolute] {
        let (mut dynamics, x0, v0, prescribed) = crumpled();
        dynamics.params.newton.hessian_filter = hessian_filter;
        dynamics.params.newton.cg_tolerance = 1e-10;
        dynamics.begin_step(&x0, &v0, 0.02).expect("begins");
        let (mut x, mut y) = (x0.clone(), x0.clone());
        let mut energy = f64::INFINITY;
        let mut displacement = f64::INFINITY;
        for _ in 0..40 {
            let info = dynamics.newton_target(&x, &prescribed, &x0, &mut y).expect("solves");
            // Rounding, at the end.
            assert!(info.energy_after <= energy * (1.0 + 1e-13), "{info:?} after {energy}");
            (energy, displacement) = (info.energy_after, info.max_displacement);
            x.copy_from_slice(&y);
        }
        assert!(displacement < 1e-9, "{hessian_filter:?}: still moves by {displacement:e}");
    }
}

#[test]
fn newton_converges_quadratically_under_tension() {
    // A drum: the rim of the 5 x 4 vertices is held, pulled apart by 60 %.
    let (mut dynamics, x0, v0, _) = crumpled();
    dynamics.params.newton.cg_tolerance = 1e-12;
    let x0: Vec<Point> = x0.iter().map(|p| p * 1.6).collect();
    let prescribed: Vec<bool> =
        (0..20).map(|k| !(1..4).contains(&(k % 5)) || !(1..3).contains(&(k / 5))).collect();
    dynamics.begin_step(&x0, &v0, 0.02).expect("begins");
    let (mut x, mut y) = (x0.clone(), x0.clone());
    let mut moves = Vec::new();
    for _ in 0..8 {
        let info = dynamics.newton_target(&x, &prescribed, &x0, &mut y).expect("solves");
        moves.push(info.max_displacement);
        x.copy_from_slice(&y);
    }
    let quadratic = moves.windows(2).all(|m| m[1] <= 100.0 * m[0] * m[0] + 1e-11);
    assert!(quadratic && moves[7] < 1e-11, "{moves:?}");
}

/// [`crumpled`] in the wind, with springs of two to four vertices and limits of distances, most of which
/// push.
fn crumpled_with_everything() -> (Dynamics, Vec<Point>, Vec<Vector>, Vec<bool>) {
    let (dynamics, x, v, prescribed) = crumpled();
    let Dynamics { model, params, .. } = dynamics;
    let wind = Vector::new(2.0, -1.0, 3.0);
    let environment = Environment { air_density: 1.2, wind, ..params.environment };
    let mut dynamics = Dynamics::new(model, DynamicsParams { environment, ..params }).expect("valid");
    let contact = |k: u32| RepulsionSpring {
        kind: SpringKind::Contact,
        vertices: [k, (k + 7) % 20, (k + 12) % 20, (k + 3) % 20],
        weights: if k.is_multiple_of(3) { [1.0, -1.0, 0.0, 0.0] } else { [1.0, -0.5, -0.2, -0.3] },
        normal: Vector::new(f64::from(k).sin(), f64::from(k).cos(), 0.5).normalize(),
        offset: 0.0,
        reach: 0.1,
        floor: -0.6,
        // Some with drag, some without.
        start_gap: if k.is_multiple_of(2) { 0.2 } else { 0.0 },
        stiffness: 0.3 + 0.1 * f64::from(k),
        friction: 0.1 * f64::from(k % 4),
        friction_ratio: Vector::new(0.1, -0.05, 0.02) * f64::from(k % 3),
    };
    // Edges of 0.1 m at rest.
    let limit = |k: u32| RepulsionSpring {
        kind: SpringKind::Limit,
        vertices: [k, k + 5, k, k],
        weights: [-1.0, 1.0, 0.0, 0.0],
        normal: Vector::y(),
        offset: -0.3,
        reach: 0.2,
        floor: -0.2,
        start_gap: 0.1,
        stiffness: 0.5,
        friction: 0.0,
        friction_ratio: Vector::zeros(),
    };
    let springs: Vec<RepulsionSpring> = (0..20).map(contact).chain((0..15).map(limit)).collect();
    dynamics.set_repulsion(&springs).expect("valid");
    (dynamics, x, v, prescribed)
}

#[test]
fn wind_and_repulsion_have_exact_gradients_and_matrices() {
    let (mut dynamics, x0, v0, _) = crumpled_with_everything();
    dynamics.begin_step(&x0, &v0, 0.02).expect("begins");
    let nodes = dynamics.model.node_vertex.clone();
    let stretched: Vec<Vector> =
        nodes.iter().map(|&v| x0[v as usize].coords * 1.6 + v0[v as usize] * 0.002).collect();
    // The bounds of friction are those at these positions; nothing is predicted any more.
    let step = linearized(&mut dynamics, &stretched);
    let watched: Vec<Vector> = dynamics.repulsion.watched().iter().map(|&n| stretched[n as usize]).collect();
    dynamics.repulsion.update(&watched);
    let step = linearized_at(&mut dynamics, step, &stretched);
    let gradient = dynamics.work.gradient.clone();
    let reactions = dynamics.repulsion.linear().reactions(&stretched);
    let pushed = |n: &usize| dynamics.repulsion.linear().row_product(*n, &reactions) != Vector::zeros();
    assert!((0..stretched.len()).filter(pushed).count() > 10);
    let pushing = dynamics.repulsion.linear().all();
    let turning = pushing.iter().filter(|s| s.weights[0] < 0.0).count();
    assert!(turning > 5 && pushing.len() - turning > 10, "{turning} of {}", pushing.len());
    let scale = gradient.iter().map(|g| g.norm()).fold(0.0, f64::max);
    let largest = dynamics.work.values.diagonal.iter().map(|d| d.abs().max()).fold(0.0, f64::max);
    let mut image = vec![Vector::zeros(); stretched.len()];
    let mut moved = stretched.clone();
    dynamics.step = Some(step);
    for node in 0..moved.len() {
        for axis in 0..3 {
            let here = moved[node][axis];
            let step = dynamics.step.take().expect("begun");
            let mut energy = |offset: f64| {
                moved[node][axis] = here + offset;
                potential(&mut dynamics, &step, &moved)
            };
            let slope = (energy(1e-6) - energy(-1e-6)) / 2e-6;
            moved[node][axis] = here;
            assert!((slope - gradient[node][axis]).abs() < 1e-6 * scale, "{slope} {}", gradient[node][axis]);

            // A column of H, computed by a product, against differences of the gradient.
            let step = linearized_at(&mut dynamics, step, &stretched);
            let mut unit = vec![Vector::zeros(); moved.len()];
            unit[node][axis] = 1.0;
            let system = System {
                pattern: &dynamics.model.pattern,
                values: &dynamics.work.values,
                scalar: &step.scalar,
                springs: Some(dynamics.repulsion.linear()),
                free: &dynamics.work.free,
            };
            system.multiply(&unit, &mut image);
            let mut gradient_at = |dynamics: &mut Dynamics, step: Step, offset: f64| {
                moved[node][axis] = here + offset;
                let step = linearized_at(dynamics, step, &moved);
                moved[node][axis] = here;
                (dynamics.work.gradient.clone(), step)
            };
            let (plus, step) = gradient_at(&mut dynamics, step, 1e-6);
            let (minus, step) = gradient_at(&mut dynamics, step, -1e-6);
            for row in 0..plus.len() {
                let difference = (plus[row] - minus[row]) / 2e-6 - image[row];
                assert!(difference.norm() < 1e-6 * largest, "({row}, {node}): {difference}");
            }
            dynamics.step = Some(step);
        }
    }
}

fn linearized_at(dynamics: &mut Dynamics, step: Step, x: &[Vector]) -> Step {
    dynamics.step = Some(step);
    linearized(dynamics, x)
}

#[test]
fn newton_converges_with_wind_and_repulsion() {
    let (mut dynamics, x0, v0, prescribed) = crumpled_with_everything();
    dynamics.params.newton.cg_tolerance = 1e-12;
    // Over many iterations this filter converges faster.
    dynamics.params.newton.hessian_filter = HessianFilter::Clamp;
    dynamics.begin_step(&x0, &v0, 0.02).expect("begins");
    let (mut x, mut y) = (x0.clone(), x0.clone());
    // The potential changes with the bounds of friction; the displacement to the next target must vanish.
    let mut displacement = f64::INFINITY;
    for _ in 0..120 {
        displacement = dynamics.newton_target(&x, &prescribed, &x0, &mut y).expect("solves").max_displacement;
        x.copy_from_slice(&y);
    }
    assert!(displacement < 1e-9, "still moves by {displacement:e}");
}

/// Newton's method ends where the gradient of the potential is zero, and the potential falls on the way
/// there.
#[test]
fn time_steps_end_where_the_gradient_is_zero() {
    let rest: Vec<Point> =
        (0..20).map(|k| Point::new(0.1 * f64::from(k % 5), 0.1 * f64::from(k / 5), 0.0)).collect();
    let material = ClothMaterial {
        bend_stiffness: 1e-3,
        stretch_damping: 0.01,
        bend_damping: 0.02,
        ..ClothMaterial::cotton()
    };
    let body = Body::cloth("sheet", grid_triangles(4, 3, false), material);
    let model = DynamicsModel::new(rest.clone(), vec![body]).expect("valid");
    let mut params = DynamicsParams::default();
    params.newton.cg_tolerance = 1e-12;
    params.environment.air_drag = 0.5;
    params.environment.air_density = 1.2;
    params.environment.wind = Vector::new(2.0, -1.0, 0.5);
    let mut dynamics = Dynamics::new(model, params).expect("valid");
    let wave = |k: usize| Vector::new((k as f64 * 1.7).sin(), (k as f64 * 0.9).cos(), (k as f64).sin());
    let start: Vec<Point> = rest.iter().enumerate().map(|(k, x)| x + wave(k) * 0.02).collect();
    let velocities: Vec<Vector> = (0..20).map(|k| wave(k + 5)).collect();
    dynamics.begin_step(&start, &velocities, 0.01).expect("valid");
    let by_node = |dynamics: &Dynamics, x: &[Point]| -> Vec<Vector> {
        dynamics.model.node_vertex.iter().map(|v| x[*v as usize].coords).collect()
    };
    let at = |dynamics: &Dynamics, x: &[Point]| {
        let potential = dynamics.bodies_potential(&by_node(dynamics, x)).expect("begun");
        let largest = potential.gradient.iter().map(Vector::amax).fold(0.0, f64::max);
        (potential.quadratic + potential.elements, largest)
    };
    let (energy, largest) = at(&dynamics, &start);
    let mut x = start.clone();
    for _ in 0..20 {
        let mut y = x.clone();
        dynamics.newton_target(&x, &[false; 20], &rest, &mut y).expect("a target");
        x = y;
    }
    let (end, rest) = at(&dynamics, &x);
    assert!(rest < 1e-8 * largest && end < energy, "{rest:e} of {largest:e}, {end:e} of {energy:e}");
    assert!(dynamics.bodies_potential(&[]).is_err());
}
