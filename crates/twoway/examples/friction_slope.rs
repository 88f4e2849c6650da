//! Cost and effect of friction: four sheets on top of each other on a slope of 20 degrees, tan = 0.36.
//!
//! `cargo run --release -p bowknot-twoway --example friction_slope -- [cells] [frames]`
#![allow(clippy::print_stdout)] // an example's purpose is to print

use bowknot_constraints::FrictionModel;
use bowknot_geometry::{HalfSpace, Point, Topology, Vector};
use bowknot_proximity::{BodyFilter, CollisionModel};
use bowknot_twoway::{BodyContact, ContactData, HalfSpaceContact, Params, ResolveInput, Resolver};

const DT: f64 = 0.01;
const SUBSTEPS: usize = 20;
const SHEETS: usize = 4;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let argument =
        |k: usize, default: usize| std::env::args().nth(k).and_then(|a| a.parse().ok()).unwrap_or(default);
    let (cells, frames) = (argument(1, 30), argument(2, 50));
    println!(
        "means over {frames} frames of {SHEETS} sheets of {cells} x {cells} cells; downhill: speed of each \
         at the end"
    );
    println!(
        "model    mu    steps  searches  rows  friction  backward ms  total ms  largest slip mm  downhill m/s"
    );
    for (model, friction) in [
        (FrictionModel::None, 0.0),
        (FrictionModel::Filter, 0.2),
        (FrictionModel::Filter, 0.6),
        (FrictionModel::Coulomb, 0.2),
        (FrictionModel::Coulomb, 0.6),
    ] {
        slide(cells, frames, model, friction)?;
    }
    Ok(())
}

fn slide(
    cells: usize,
    frames: usize,
    model: FrictionModel,
    friction: f64,
) -> Result<(), Box<dyn std::error::Error>> {
    let (n, h) = (cells + 1, 0.5 / cells as f64);
    let delta = 0.1 * h;
    let (mut x, mut triangles) = (Vec::new(), Vec::new());
    for sheet in 0..SHEETS {
        let first = x.len();
        // Each sheet is turned a little, so that no vertex lies on another.
        let (sin, cos) = (0.3 * sheet as f64).sin_cos();
        x.extend((0..n * n).map(|i| {
            let (u, v) = ((i % n) as f64 * h - 0.25, (i / n) as f64 * h - 0.25);
            Point::new(cos * u - sin * v, sin * u + cos * v, (1 + sheet) as f64 * 1.2 * delta)
        }));
        let vertex = |i: usize, j: usize| (first + j * n + i) as u32;
        for j in 0..cells {
            for i in 0..cells {
                let [a, b, c, d] = [vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)];
                triangles.extend(if (i + j) % 2 == 0 {
                    [[a, b, c], [a, c, d]]
                } else {
                    [[a, b, d], [b, c, d]]
                });
            }
        }
    }
    let topology = Topology::builder(x.len()).triangles(triangles).build()?;
    let springs: Vec<([usize; 2], f64)> = (topology.edges.iter())
        .map(|e| e.map(|v| v as usize))
        .map(|e| (e, (x[e[0]] - x[e[1]]).norm()))
        .collect();
    let bodies = (0..x.len()).map(|v| (v / (n * n)) as u32).collect();
    let ground = HalfSpace::new(Point::origin(), Vector::z()).ok_or("no normal")?;
    let model_of = CollisionModel::new(topology, bodies, vec![BodyFilter::DEFORMABLE; SHEETS], vec![ground])?;
    let mut params = Params::fast();
    params.contact.friction_model = model;
    let contact = ContactData {
        bodies: vec![BodyContact { friction, ..BodyContact::default() }; SHEETS],
        half_spaces: vec![HalfSpaceContact { friction, ..HalfSpaceContact::default() }],
        ..ContactData::default()
    };
    let mut resolver = Resolver::with_contact(model_of, &x, &vec![1.0; x.len()], contact, params)?;

    // Gravity has the slope: x points downhill.
    let slope = 20f64.to_radians();
    let gravity = 9.81 * Vector::new(slope.sin(), 0.0, -slope.cos());
    let mut v = vec![Vector::zeros(); x.len()];
    let mut sums = [0.0; 6];
    let mut slip = 0.0f64;
    for _ in 0..frames {
        let start = x.clone();
        let y = integrate(&start, &v, &springs, &gravity);
        let report = resolver.resolve_with(
            &mut x,
            &y,
            &ResolveInput { time_step: Some(DT), ..ResolveInput::default() },
            &mut (),
        )?;
        v.iter_mut().zip(x.iter().zip(&start)).for_each(|(v, (x, start))| *v = (x - start) / DT);
        let values = [
            report.steps as f64,
            report.searches as f64,
            report.contact_rows as f64,
            report.friction_rows as f64,
            1e3 * report.seconds.backward,
            1e3 * report.seconds.total,
        ];
        sums.iter_mut().zip(values).for_each(|(sum, value)| *sum += value / frames as f64);
        slip = slip.max(report.sticking_slip_m);
    }
    let speed = |sheet: &[Vector]| sheet.iter().map(|v| v.x).sum::<f64>() / sheet.len() as f64;
    let speeds: Vec<String> = v.chunks(n * n).map(|sheet| format!("{:.4}", speed(sheet))).collect();
    let [steps, searches, rows, rough, backward, total] = sums;
    println!(
        "{:7} {friction:4.1} {steps:8.2} {searches:9.2} {rows:5.0} {rough:9.0} {backward:12.2} {total:9.2} \
         {:17.4}  {}",
        format!("{model:?}"),
        1e3 * slip,
        speeds.join(" "),
    );
    Ok(())
}

/// Positions after a frame without collisions: stiff springs by symplectic Euler with substeps.
fn integrate(x: &[Point], v: &[Vector], springs: &[([usize; 2], f64)], gravity: &Vector) -> Vec<Point> {
    // Gravity acts before the substeps, so that the displacement has all of its impulse.
    let (mut y, mut v) = (x.to_vec(), v.iter().map(|v| v + gravity * DT).collect::<Vec<_>>());
    let dt = DT / SUBSTEPS as f64;
    for _ in 0..SUBSTEPS {
        for &([a, b], rest) in springs {
            let d = y[b] - y[a];
            let pull = d * (4e5 * dt * (1.0 - rest / d.norm()));
            v[a] += pull;
            v[b] -= pull;
        }
        y.iter_mut().zip(&v).for_each(|(y, v)| *y += *v * dt);
    }
    y
}
