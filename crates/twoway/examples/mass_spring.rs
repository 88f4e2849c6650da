//! A mass-spring cloth in a few lines that never intersects: the resolver after any dynamics.
//!
//! `cargo run --release -p bowknot-twoway --example mass_spring -- [cells] [frames]`
#![allow(clippy::print_stdout)] // an example's purpose is to print

use bowknot_geometry::{HalfSpace, Point, Topology, Vector};
use bowknot_proximity::{BodyFilter, CollisionModel};
use bowknot_twoway::{Params, ResolveInput, Resolver};

const DT: f64 = 0.01;
const SUBSTEPS: usize = 20;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let argument =
        |k: usize, default: usize| std::env::args().nth(k).and_then(|a| a.parse().ok()).unwrap_or(default);
    let (cells, frames) = (argument(1, 40), argument(2, 60));
    let mut args = std::env::args().skip(3);
    let preset = args.next().unwrap_or_default();

    // A square sheet of 1 m above a spike that stands on the ground.
    let n = cells + 1;
    let h = 1.0 / cells as f64;
    let mut x: Vec<Point> = (0..n * n)
        .map(|i| Point::new((i % n) as f64 * h - 0.497, (i / n) as f64 * h - 0.503, 0.55))
        .collect();
    let vertex = |i: usize, j: usize| (j * n + i) as u32;
    let mut triangles = Vec::new();
    for j in 0..cells {
        for i in 0..cells {
            let [a, b, c, d] = [vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)];
            triangles.extend(if (i + j) % 2 == 0 { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] });
        }
    }
    let cloth = x.len();
    let (tip, base) = (cloth as u32, 12);
    x.push(Point::new(0.0, 0.0, 0.5));
    for k in 0..base {
        let angle = k as f64 / base as f64 * std::f64::consts::TAU;
        x.push(Point::new(0.03 * angle.cos(), 0.03 * angle.sin(), 0.005));
        triangles.push([tip, tip + 1 + k as u32, tip + 1 + (k as u32 + 1) % base as u32]);
    }

    // The topology, the obstacle, and a resolver.
    let topology = Topology::builder(x.len()).triangles(triangles).build()?;
    let springs: Vec<([usize; 2], f64)> = (topology.edges.iter())
        .map(|e| e.map(|v| v as usize))
        .filter(|e| e[1] < cloth)
        .map(|e| (e, (x[e[0]] - x[e[1]]).norm()))
        .collect();
    let bodies = (0..x.len()).map(|v| u32::from(v >= cloth)).collect();
    let ground = HalfSpace::new(Point::origin(), Vector::z()).ok_or("no normal")?;
    let filters = vec![BodyFilter::DEFORMABLE, BodyFilter::OBSTACLE];
    let model = CollisionModel::new(topology, bodies, filters, vec![ground])?;
    let params = if preset == "paper" { Params::paper() } else { Params::fast() };
    let mut resolver = Resolver::new(model, &x, &vec![1.0; x.len()], params)?;

    let mut v = vec![Vector::zeros(); x.len()];
    for frame in 0..frames {
        let start = x.clone();
        // Gravity acts before the substeps: the displacement of the step, from which the velocity is taken
        // after collisions, then has all of its impulse. Within the substeps it would have half of it.
        v[..cloth].iter_mut().for_each(|v| v.z -= 9.81 * DT);
        let y = integrate(&start, &v, cloth, &springs);
        let input = ResolveInput { time_step: Some(DT), ..ResolveInput::default() };
        let report = resolver.resolve_with(&mut x, &y, &input, &mut ())?;
        for i in 0..cloth {
            v[i] = (x[i] - start[i]) / DT;
        }
        println!(
            "frame {frame:3}: {:3} steps, {:3} searches, {:6} pairs, gap {:8.3} mm, {:7.4} mm from the \
             target, {:.3} s",
            report.steps,
            report.searches,
            report.pairs,
            1e3 * report.min_gap_m.unwrap_or(f64::NAN),
            1e3 * report.distance_to_target_m,
            report.seconds.total,
        );
        if std::env::var("BOWKNOT_VERBOSE").is_ok() {
            println!("{report:?}");
        }
    }
    Ok(())
}

/// Positions after a step without gravity and collisions: stiff springs by symplectic Euler with substeps.
fn integrate(x: &[Point], v: &[Vector], cloth: usize, springs: &[([usize; 2], f64)]) -> Vec<Point> {
    let (mut y, mut v) = (x.to_vec(), v.to_vec());
    let dt = DT / SUBSTEPS as f64;
    for _ in 0..SUBSTEPS {
        v[..cloth].iter_mut().for_each(|v| *v *= 0.999);
        for &([a, b], rest) in springs {
            let d = y[b] - y[a];
            let pull = d * (4e5 * dt * (1.0 - rest / d.norm()));
            v[a] += pull;
            v[b] -= pull;
        }
        y[..cloth].iter_mut().zip(&v).for_each(|(y, v)| *y += *v * dt);
    }
    y
}
