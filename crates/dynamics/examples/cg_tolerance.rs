//! How small must the residual of CG be? Compares targets of a cloth of about 10,000 vertices at dt = 1/20 s,
//! solved to several tolerances, with the converged target.
//!
//! ```text
//! cargo run --release -p bowknot-dynamics --example cg_tolerance [-- cells [preconditioner..]]
//! ```
//!
//! There are three states, each after some time steps: a crumpled sheet in free flight; a sheet held at two
//! corners; a sheet draped over a ball by plain projection. The projection is no real contact resolution, but
//! it moves iterates x away from the last target as contact does.
#![allow(clippy::print_stdout, reason = "an experiment prints its table")]

#[path = "../tests/suite/common/cloth.rs"]
mod cloth;
#[path = "../tests/suite/common/sheet.rs"]
mod sheet;

use bowknot_dynamics::{ClothMaterial, Dynamics, DynamicsParams, NewtonParams, PreconditionerKind};
use bowknot_geometry::{Point, Vector};
use cloth::cloth_model;
use sheet::sheet;
use std::time::Instant;

const DT: f64 = 1.0 / 20.0;

struct State {
    name: &'static str,
    x: Vec<Point>,
    v: Vec<Vector>,
    prescribed: Vec<bool>,
    ball: bool,
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let cells: usize = arguments.next().map_or(Ok(100), |a| a.parse())?;
    let mut preconditioners: Vec<PreconditionerKind> = Vec::new();
    for name in arguments {
        preconditioners.push(serde_json::from_value(name.into())?);
    }
    if preconditioners.is_empty() {
        preconditioners.push(PreconditionerKind::default());
    }
    let (rest, triangles) = sheet(1.0, 1.0, cells, cells);
    let material = ClothMaterial::cotton();
    let dynamics = |newton: NewtonParams| {
        let model = cloth_model(&rest, triangles.clone(), material);
        Dynamics::new(model, DynamicsParams { newton, ..DynamicsParams::default() })
    };
    println!("{} vertices, dt = 1/20 s, cotton", rest.len());

    for state in
        states(&rest, cells, &mut dynamics(NewtonParams { cg_tolerance: 1e-7, ..Default::default() })?)?
    {
        println!("\n{}", state.name);
        let solve = |dynamics: &mut Dynamics| -> Result<_, Box<dyn std::error::Error>> {
            // Two iterations of a step: the second one starts from the target of the first, moved by contact.
            let mut target = state.x.clone();
            dynamics.begin_step(&state.x, &state.v, DT)?;
            let begin = Instant::now();
            let first = dynamics.newton_target(&state.x, &state.prescribed, &state.x, &mut target)?;
            let seconds = begin.elapsed().as_secs_f64();
            let mut x = target.clone();
            if state.ball {
                project(&mut x);
            }
            let mut second_target = x.clone();
            let second = dynamics.newton_target(&x, &state.prescribed, &state.x, &mut second_target)?;
            Ok((target, first, second, seconds))
        };
        let mut exact =
            dynamics(NewtonParams { cg_tolerance: 1e-11, cg_max_iterations: 100_000, ..Default::default() })?;
        let (exact_target, exact_info, _, _) = solve(&mut exact)?;
        println!(
            "converged: {} iterations, stretch {:.4}, step kept {}",
            exact_info.cg.iterations,
            exact.max_stretch(&exact_target),
            exact_info.step_length
        );
        println!(
            "tolerance  preconditioner  iterations 1st  2nd   seconds 1st   error max [mm]   rms [mm]   \
             stretch"
        );
        for &preconditioner in &preconditioners {
            for exponent in [1, 2, 3, 4, 5, 6, 7, 8] {
                let cg_tolerance = 10f64.powi(-exponent);
                let mut dynamics =
                    dynamics(NewtonParams { cg_tolerance, preconditioner, ..Default::default() })?;
                let (target, first, second, seconds) = solve(&mut dynamics)?;
                let errors = target.iter().zip(&exact_target).map(|(a, b)| (a - b).norm() * 1e3);
                let (mut largest, mut squares) = (0.0f64, 0.0);
                for error in errors {
                    largest = largest.max(error);
                    squares += error * error;
                }
                println!(
                    "{cg_tolerance:9.0e}  {:14}  {:14} {:4}   {seconds:11.3}   {largest:14.4}   {:8.4}   \
                     {:7.4}",
                    format!("{preconditioner:?}"),
                    first.cg.iterations,
                    second.cg.iterations,
                    (squares / target.len() as f64).sqrt(),
                    dynamics.max_stretch(&target),
                );
            }
        }
    }
    Ok(())
}

/// Moves vertices inside of a ball to its surface.
fn project(x: &mut [Point]) {
    let (center, radius) = (Point::new(0.5, 0.5, -0.35), 0.25);
    for p in x {
        let offset = *p - center;
        if offset.norm() < radius {
            *p = center + offset * (radius / offset.norm());
        }
    }
}

fn states(
    rest: &[Point],
    cells: usize,
    dynamics: &mut Dynamics,
) -> Result<Vec<State>, Box<dyn std::error::Error>> {
    let mut states = Vec::new();
    for (name, steps, pins, ball) in [
        ("free flight: crumpled and spinning, step 4", 3, vec![], false),
        ("held at two corners, step 8", 7, vec![0, cells], false),
        ("draped over a ball by projection, step 10", 9, vec![], true),
    ] {
        let mut prescribed = vec![false; rest.len()];
        pins.iter().for_each(|&pin| prescribed[pin] = true);
        let mut x = rest.to_vec();
        let mut v = vec![Vector::zeros(); rest.len()];
        if !ball && prescribed.iter().all(|p| !p) {
            for (x, v) in x.iter_mut().zip(&mut v) {
                let p = x.coords;
                x.z += 0.03 * (25.0 * p.x).sin() * (21.0 * p.y + 5.0 * p.x).cos();
                *v = Vector::new(0.5, 0.2, 3.0).cross(&(p - Vector::new(0.5, 0.5, 0.0)))
                    + Vector::new((9.0 * p.y).sin(), (8.0 * p.x).cos(), (6.0 * p.x * p.y).sin());
            }
        }
        for _ in 0..steps {
            let start = x.clone();
            dynamics.begin_step(&start, &v, DT)?;
            let mut target = x.clone();
            for _ in 0..2 {
                dynamics.newton_target(&x, &prescribed, rest, &mut target)?;
                x.copy_from_slice(&target);
                if ball {
                    project(&mut x);
                }
            }
            v = x.iter().zip(&start).map(|(end, start)| (end - start) / DT).collect();
        }
        states.push(State { name, x, v, prescribed, ball });
    }
    Ok(states)
}
