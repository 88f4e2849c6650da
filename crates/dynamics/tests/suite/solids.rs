//! Solids with known answers: bars, beams, patches, inversion, conservation.

use crate::common::{block, dynamics, equilibrium, weightless, with_gravity, with_tolerance};
use bowknot_dynamics::{
    Body, Dynamics, DynamicsModel, DynamicsParams, HessianFilter, SolidMaterial, SolidModel,
};
use bowknot_geometry::{Point, Vector, add_edge_middles};

const MODELS: [SolidModel; 2] = [SolidModel::Stvk, SolidModel::StableNeoHookean];

fn solid(rest: &[Point], tets: Vec<[u32; 4]>, material: SolidMaterial, params: DynamicsParams) -> Dynamics {
    dynamics(rest, vec![Body::solid("block", tets, material)], params)
}

/// See [`equilibrium`].
fn settle(dynamics: &mut Dynamics, x: &mut [Point], held: &[bool], keyframes: &[Point], iterations: usize) {
    equilibrium(dynamics, x, held, keyframes, (1e4, iterations, 1e-6));
}

#[test]
fn the_inside_of_an_affinely_deformed_surface_is_affine() {
    // The patch test at large strain: the surface follows an affine map, and the inside must follow it as
    // well.
    let (rest, tets) = block([1.0, 0.8, 0.6], [4, 4, 3]);
    let map = nalgebra::Matrix3::new(1.3, 0.2, 0.0, -0.1, 0.8, 0.1, 0.2, 0.0, 0.9);
    let surface: Vec<bool> = rest
        .iter()
        .map(|p| {
            p.x < 1e-9 || p.x > 1.0 - 1e-9 || p.y < 1e-9 || p.y > 0.8 - 1e-9 || p.z < 1e-9 || p.z > 0.6 - 1e-9
        })
        .collect();
    assert!(surface.iter().any(|held| !held));
    let target: Vec<Point> = rest.iter().map(|p| map * p).collect();
    for model in MODELS {
        let material = SolidMaterial { model, ..SolidMaterial::rubber() };
        let mut dynamics = solid(&rest, tets.clone(), material, weightless(with_tolerance(1e-10)));
        let mut x = rest.clone();
        settle(&mut dynamics, &mut x, &surface, &target, 12);
        let error = x.iter().zip(&target).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
        assert!(error < 1e-6, "{model:?}: {error:e}");
    }
}

#[test]
fn a_hanging_bar_stretches_by_rho_g_l2_over_2e() {
    // With nu = 0 the clamp has no effect on the stretch, which is exact up to the lumping of mass and
    // strains of 0.1 %.
    let (length, width) = (1.0, 0.2);
    let (rest, tets) = block([width, width, length], [2, 2, 10]);
    for model in MODELS {
        let material =
            SolidMaterial { density: 1000.0, young_modulus: 5e6, poisson_ratio: 0.0, model, damping: 0.0 };
        let mut dynamics = solid(&rest, tets.clone(), material, with_tolerance(1e-9));
        let held: Vec<bool> = rest.iter().map(|p| p.z > length - 1e-9).collect();
        let mut x = rest.clone();
        settle(&mut dynamics, &mut x, &held, &rest, 10);
        let expected = 1000.0 * 9.81 * length * length / (2.0 * 5e6);
        let low: Vec<f64> = rest.iter().zip(&x).filter(|(r, _)| r.z < 1e-9).map(|(r, x)| r.z - x.z).collect();
        let mean = low.iter().sum::<f64>() / low.len() as f64;
        assert!((mean - expected).abs() < 5e-3 * expected, "{model:?}: {mean} {expected}");
    }
}

#[test]
fn a_cantilever_meets_beam_theory_as_it_is_refined() {
    // The tip of a clamped beam under its own weight sags by bending and shear: q L^4 / (8 EI) + 1.2 q L^2 /
    // (2 G A). Linear tets are too stiff in bending; the error decreases with the square of the cell size.
    let (length, height, width) = (1.0f64, 0.2, 0.1);
    let (e, rho) = (5e6, 1000.0);
    let bending = 9.81 * rho * length.powi(4) / (8.0 * e * height * height / 12.0);
    let shear = 1.2 * 9.81 * rho * length * length / (2.0 * 0.5 * e);
    let expected = bending + shear;
    let mut errors = Vec::new();
    for fine in [1, 2] {
        let (rest, tets) = block([length, width, height], [20 * fine, 2 * fine, 4 * fine]);
        let material = SolidMaterial {
            density: rho,
            young_modulus: e,
            poisson_ratio: 0.0,
            model: SolidModel::StableNeoHookean,
            damping: 0.0,
        };
        let params = with_gravity(with_tolerance(1e-8), Vector::new(0.0, 0.0, -0.981));
        let mut dynamics = solid(&rest, tets, material, params);
        let held: Vec<bool> = rest.iter().map(|p| p.x < 1e-9).collect();
        let mut x = rest.clone();
        settle(&mut dynamics, &mut x, &held, &rest, 12);
        let tip: Vec<f64> =
            rest.iter().zip(&x).filter(|(r, _)| r.x > length - 1e-9).map(|(r, x)| r.z - x.z).collect();
        let mean = 10.0 * tip.iter().sum::<f64>() / tip.len() as f64;
        errors.push(1.0 - mean / expected);
    }
    assert!(errors[0] > 0.0 && errors[0] < 0.25, "{errors:?}");
    assert!(errors[1] > 0.0 && errors[1] < 0.35 * errors[0], "{errors:?}");
}

/// Sag of the tip of a cantilever under its own weight, over that of beam theory.
fn sag(cells: [usize; 3], poisson_ratio: f64, with_middles: bool) -> f64 {
    let (length, side, e, rho) = (0.2, 0.02, 1e6, 300.0);
    let (rest, tets) = block([length, side, side], cells);
    let material =
        SolidMaterial { density: rho, young_modulus: e, poisson_ratio, ..SolidMaterial::default() };
    let (rest, body) = if with_middles {
        let mut rest = rest;
        let tets = add_edge_middles(&mut rest, &tets);
        (rest, Body::quadratic_solid("beam", tets, material))
    } else {
        (rest, Body::solid("beam", tets, material))
    };
    // A thousandth of the weight: theory is of small deflections.
    let params = with_gravity(with_tolerance(1e-8), Vector::new(0.0, 0.0, -9.81e-3));
    let mut dynamics = dynamics(&rest, vec![body], params);
    let held: Vec<bool> = rest.iter().map(|p| p.x < 1e-9).collect();
    let mut x = rest.clone();
    settle(&mut dynamics, &mut x, &held, &rest, 12);
    let tip: Vec<f64> =
        rest.iter().zip(&x).filter(|(r, _)| r.x > length - 1e-9).map(|(r, x)| r.z - x.z).collect();
    let bending = 9.81e-3 * rho * length.powi(4) / (8.0 * e * side * side / 12.0);
    let shear = 1.2 * 9.81e-3 * rho * length * length * (1.0 + poisson_ratio) / e;
    tip.iter().sum::<f64>() / tip.len() as f64 / (bending + shear)
}

#[test]
fn quadratic_tetrahedra_bend_where_linear_ones_lock() {
    // One and two elements thick, at Poisson's ratios of rubber. A direct solution of linear elasticity has
    // the same numbers.
    for (cells, ratio, expected) in [
        ([10, 1, 1], 0.45, 0.905),
        ([20, 2, 2], 0.45, 0.959),
        ([10, 1, 1], 0.49, 0.854),
        ([20, 2, 2], 0.49, 0.937),
    ] {
        let sag = sag(cells, ratio, true);
        assert!((sag - expected).abs() < 0.01, "{cells:?}, {ratio}: {sag}");
    }
    let linear = sag([10, 1, 1], 0.45, false);
    assert!(linear < 0.15, "{linear}");
}

#[test]
fn the_inside_of_an_affinely_deformed_quadratic_surface_is_affine() {
    let (mut rest, tets) = block([1.0, 0.8, 0.6], [2, 2, 2]);
    let tets = add_edge_middles(&mut rest, &tets);
    let map = nalgebra::Matrix3::new(1.3, 0.2, 0.0, -0.1, 0.8, 0.1, 0.2, 0.0, 0.9);
    let at_end = |c: f64, size: f64| c < 1e-9 || c > size - 1e-9;
    let surface: Vec<bool> =
        rest.iter().map(|p| at_end(p.x, 1.0) || at_end(p.y, 0.8) || at_end(p.z, 0.6)).collect();
    let target: Vec<Point> = rest.iter().map(|p| map * p).collect();
    for model in MODELS {
        let material = SolidMaterial { model, ..SolidMaterial::rubber() };
        let body = Body::quadratic_solid("block", tets.clone(), material);
        let mut dynamics = dynamics(&rest, vec![body], weightless(with_tolerance(1e-10)));
        let mut x = rest.clone();
        settle(&mut dynamics, &mut x, &surface, &target, 12);
        let error = x.iter().zip(&target).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
        assert!(error < 1e-6, "{model:?}: {error:e}");
    }
}

#[test]
fn middles_of_edges_must_lie_in_the_middle() {
    let (mut rest, tets) = block([1.0; 3], [1; 3]);
    let tets = add_edge_middles(&mut rest, &tets);
    let last = rest.len() - 1;
    rest[last].x += 1e-3;
    let body = Body::quadratic_solid("block", tets, SolidMaterial::rubber());
    let message = DynamicsModel::new(rest, vec![body]).expect_err("an edge is bent").to_string();
    assert!(
        message.contains(&format!("vertex {last} of quadratic tet")) && message.contains("middle"),
        "{message}"
    );
}

#[test]
fn stable_neo_hookean_recovers_from_inversion() {
    // The block is flattened to a crumpled sheet, or its vertices are displaced by more than a cell, so that
    // half of the tets are inverted. It must recover a shape without energy.
    let (rest, tets) = block([0.3, 0.3, 0.3], [3, 3, 3]);
    for filter in [HessianFilter::Clamp, HessianFilter::Absolute] {
        for (height, noise) in [(0.0, 0.01), (1.0, 0.12)] {
            let material = SolidMaterial { damping: 0.01, ..SolidMaterial::jelly() };
            let mut params = weightless(with_tolerance(1e-8));
            params.newton.hessian_filter = filter;
            params.environment.air_drag = 5.0;
            let mut dynamics = solid(&rest, tets.clone(), material, params);
            let wave = |k: usize| (k as f64 * 12.9898).sin();
            let mut x: Vec<Point> = (rest.iter().enumerate())
                .map(|(k, p)| {
                    Point::new(p.x, p.y, height * p.z)
                        + Vector::new(wave(k), wave(k + 99), wave(k + 999)) * noise
                })
                .collect();
            let mut v = vec![Vector::zeros(); x.len()];
            let none = vec![false; x.len()];
            let inverted = dynamics.model().inverted_tets(&x).len();
            assert!(inverted > tets.len() / 4, "{inverted}");
            for _ in 0..100 {
                let keyframes = x.clone();
                dynamics.solve_step(&mut x, &mut v, 0.02, &none, &keyframes, 2).expect("solves");
            }
            let energy = dynamics.model().elastic_energy(&x);
            assert_eq!(dynamics.model().inverted_tets(&x), Vec::<[usize; 2]>::new());
            let volume = dynamics.model().volume(&x);
            assert!(energy < 1e-6 && (volume - 0.027).abs() < 1e-6, "{filter:?}: {energy:e} J, {volume} m3");
        }
    }
}

#[test]
fn momenta_are_conserved_in_free_flight() {
    let (rest, tets) = block([0.3, 0.2, 0.1], [6, 4, 2]);
    for model in MODELS {
        let material = SolidMaterial { model, damping: 0.01, ..SolidMaterial::jelly() };
        let mut params = weightless(with_tolerance(1e-12));
        // Over many iterations this filter converges faster.
        params.newton.hessian_filter = HessianFilter::Clamp;
        let mut dynamics = solid(&rest, tets.clone(), material, params);
        let mut x = rest.clone();
        let mut v: Vec<Vector> = rest
            .iter()
            .map(|p| {
                Vector::new(1.0 + (20.0 * p.y).sin(), p.x, (15.0 * p.x).cos()) * 0.2
                    + Vector::z().cross(&p.coords) * 8.0
            })
            .collect();
        let none = vec![false; x.len()];
        let dt = 0.002;
        for _ in 0..3 {
            let (x0, v0) = (x.clone(), v.clone());
            let infos = dynamics.solve_step(&mut x, &mut v, dt, &none, &x0, 30).expect("solves");
            assert!(infos[29].max_displacement < 1e-10, "{:?}", infos[29]);
            assert!((dynamics.momentum(&v) - dynamics.momentum(&v0)).norm() < 1e-12);
            let before = dynamics.angular_momentum(&x0, &v0);
            let difference = (dynamics.angular_momentum(&x, &v) - before).norm();
            assert!(
                difference < 1e-9 * before.norm(),
                "{model:?}: off by {difference:e} of {}",
                before.norm()
            );
        }
    }
}

#[test]
fn the_inside_follows_a_surface_that_contact_moved() {
    // Contact moves the surface during a time step. One or two more targets with the surface held move the
    // inside, with the inertia of the step, and leave no tet inverted.
    let (rest, tets) = block([0.4, 0.4, 0.2], [8, 8, 4]);
    let mut dynamics = solid(&rest, tets, SolidMaterial::rubber(), DynamicsParams::default());
    let surface: Vec<bool> = rest
        .iter()
        .map(|p| [p.x, p.y].iter().any(|c| *c < 1e-9 || *c > 0.4 - 1e-9) || p.z < 1e-9 || p.z > 0.2 - 1e-9)
        .collect();
    let v = vec![Vector::new(0.0, 0.0, -1.5); rest.len()];
    dynamics.begin_step(&rest, &v, 0.02).expect("begins");
    let none = vec![false; rest.len()];
    let mut y = rest.clone();
    dynamics.newton_target(&rest, &none, &rest, &mut y).expect("solves");
    // The surface ends where contact moved it: flattened at z = 0; the inside is where it was.
    let moved: Vec<Point> = (rest.iter().zip(&y).enumerate())
        .map(|(k, (x, y))| if surface[k] { Point::new(y.x, y.y, y.z.max(0.0)) } else { *x })
        .collect();
    let mut x = moved.clone();
    for _ in 0..2 {
        let info = dynamics.newton_target(&x, &surface, &moved, &mut y).expect("solves");
        assert!(info.cg.converged && info.cg.iterations < 60 * info.iterations, "{info:?}");
        x.copy_from_slice(&y);
    }
    assert!(x.iter().zip(&moved).zip(&surface).all(|((x, m), held)| !held || x == m));
    assert!(dynamics.model().inverted_tets(&x).is_empty());
}
