//! Error against CPU seconds of linear and quadratic tetrahedra, for three blocks of soft rubber in
//! equilibrium.
//!
//! ```text
//! RAYON_NUM_THREADS=1 cargo run --release -p bowknot-dynamics --example solid_elements
//! ```
//!
//! | case | what is measured |
//! |---|---|
//! | a cantilever of 20 x 2 x 2 cm, nu 0.45 | sag of its tip under a thousandth of its weight |
//! | a bar of 20 x 2 x 2 cm, nu 0.45, one end turned by 90 degrees | its elastic energy |
//! | a cube of 10 cm, nu 0.49, between plates that it sticks to, 20 % lower | its elastic energy |
//!
//! The error is relative to quadratic tetrahedra on a mesh that is finer than all others. Diagonals of cells
//! are parallel, or those of neighbors are mirror images.

#![expect(clippy::print_stdout, reason = "an example reports what it measured")]

#[path = "../tests/suite/common/block.rs"]
mod block;

use block::{block, filled};
use bowknot_dynamics::{Body, Dynamics, DynamicsModel, DynamicsParams, SolidMaterial};
use bowknot_geometry::{Point, Vector, add_edge_middles};
use std::error::Error;

/// One problem of equilibrium.
struct Case {
    name: &'static str,
    size: [f64; 3],
    poisson_ratio: f64,
    /// Cells across of the linear meshes; the last is that of the reference, with quadratic elements.
    cells: [usize; 5],
    gravity: f64,
    /// Whether the vertex at a place is held, and where it is moved to.
    ends: fn(&Point) -> (bool, Point),
    /// What is measured, from the positions at rest and in equilibrium and the elastic energy.
    measure: fn(&[Point], &[Point], f64) -> f64,
}

const CASES: [Case; 3] = [
    Case {
        name: "cantilever",
        size: [0.2, 0.02, 0.02],
        poisson_ratio: 0.45,
        cells: [1, 2, 4, 8, 6],
        gravity: -9.81e-3,
        ends: |p| (p.x < 1e-9, *p),
        measure: |rest, x, _| {
            let tip = rest.iter().zip(x).filter(|(r, _)| r.x > 0.2 - 1e-9);
            let (sum, count) = tip.fold((0.0, 0.0), |(sum, count), (r, x)| (sum + r.z - x.z, count + 1.0));
            sum / count
        },
    },
    Case {
        name: "twisted bar",
        size: [0.2, 0.02, 0.02],
        poisson_ratio: 0.45,
        cells: [1, 2, 4, 8, 6],
        gravity: 0.0,
        ends: |p| {
            let (sin, cos) = (std::f64::consts::FRAC_PI_2 * p.x / 0.2).sin_cos();
            let (y, z) = (p.y - 0.01, p.z - 0.01);
            (
                p.x < 1e-9 || p.x > 0.2 - 1e-9,
                Point::new(p.x, 0.01 + cos * y - sin * z, 0.01 + sin * y + cos * z),
            )
        },
        measure: |_, _, energy| energy,
    },
    Case {
        name: "compressed cube",
        size: [0.1; 3],
        poisson_ratio: 0.49,
        cells: [2, 4, 8, 16, 10],
        gravity: 0.0,
        ends: |p| (p.z < 1e-9 || p.z > 0.1 - 1e-9, Point::new(p.x, p.y, 0.8 * p.z)),
        measure: |_, _, energy| energy,
    },
];

/// Which mesh and which elements.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Parallel,
    Mirrored,
    Quadratic,
}

fn main() -> Result<(), Box<dyn Error>> {
    println!("case, elements, cells across, vertices, CPU seconds, CG iterations, measured, error");
    for case in &CASES {
        let [.., finest] = case.cells;
        let (exact, ..) = solve(case, Kind::Quadratic, finest)?;
        for (kind, name, meshes) in [
            (Kind::Parallel, "linear, parallel", &case.cells[..4]),
            (Kind::Mirrored, "linear", &case.cells[..4]),
            (Kind::Quadratic, "quadratic", &case.cells[..3]),
        ] {
            for &cells in meshes {
                let (measured, vertices, seconds, iterations) = solve(case, kind, cells)?;
                let error = (measured / exact - 1.0).abs();
                println!(
                    "{}, {name}, {cells}, {vertices}, {seconds:.4}, {iterations}, {measured:.4e}, {error:.4}",
                    case.name
                );
            }
        }
    }
    Ok(())
}

/// What is measured, vertices, CPU seconds of the equilibrium, and its CG iterations.
fn solve(case: &Case, kind: Kind, across: usize) -> Result<(f64, usize, f64, usize), Box<dyn Error>> {
    let edge = case.size[2] / across as f64;
    let cells = case.size.map(|length| (length / edge).round() as usize);
    let (rest, tets) = if kind == Kind::Parallel {
        block(case.size, cells)
    } else {
        filled(case.size, cells, |[i, j, k]| (i & 1) + 2 * (j & 1) + 4 * (k & 1))
    };
    let material = SolidMaterial {
        density: 300.0,
        young_modulus: 1e6,
        poisson_ratio: case.poisson_ratio,
        ..SolidMaterial::default()
    };
    let (rest, body) = if kind == Kind::Quadratic {
        let mut rest = rest;
        let tets = add_edge_middles(&mut rest, &tets);
        (rest, Body::quadratic_solid("block", tets, material))
    } else {
        (rest, Body::solid("block", tets, material))
    };
    let mut params = DynamicsParams::default();
    params.environment.gravity = Vector::new(0.0, 0.0, case.gravity);
    params.newton.cg_max_iterations = 100_000;
    let mut dynamics = Dynamics::new(DynamicsModel::new(rest.clone(), vec![body])?, params)?;
    let (held, ends): (Vec<bool>, Vec<Point>) = rest.iter().map(case.ends).unzip();
    let mut x = ends.clone();
    let still = vec![Vector::zeros(); x.len()];
    let (cpu, mut iterations) = (cpu_seconds(), 0);
    // A time step without end has no inertia.
    dynamics.begin_step(&x, &still, 1e4)?;
    for _ in 0..50 {
        let mut y = x.clone();
        iterations += dynamics.newton_target(&x, &held, &ends, &mut y)?.cg.iterations;
        let step = x.iter().zip(&y).map(|(x, y)| (x - y).norm()).fold(0.0, f64::max);
        x = y;
        if step < 1e-6 * case.size[2] {
            break;
        }
    }
    let seconds = cpu_seconds() - cpu;
    let measured = (case.measure)(&rest, &x, dynamics.energies(&x, &still).elastic);
    Ok((measured, rest.len(), seconds, iterations))
}

/// CPU seconds of all threads so far, as Linux counts them; not a number elsewhere.
fn cpu_seconds() -> f64 {
    let nanoseconds = |task: std::io::Result<std::fs::DirEntry>| {
        let text = std::fs::read_to_string(task.ok()?.path().join("schedstat")).ok()?;
        text.split_whitespace().next()?.parse::<f64>().ok()
    };
    let sum = |tasks: std::fs::ReadDir| tasks.filter_map(nanoseconds).sum::<f64>() * 1e-9;
    std::fs::read_dir("/proc/self/task").map_or(f64::NAN, sum)
}
