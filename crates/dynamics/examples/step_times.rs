//! Times of time steps for bodies of the sizes in the paper's Table 2: a mat of 33,000 vertices and 86,000
//! tets, hair of 63,000 vertices, and 30,000 grains, each at dt = 1/100 s with two Newton iterations.
//!
//! ```text
//! cargo run --release -p bowknot-dynamics --example step_times [STEPS]
//! ```

#![expect(clippy::print_stdout, reason = "an example reports what it measured")]

#[path = "../tests/suite/common/block.rs"]
mod block;
#[path = "../tests/suite/common/strands.rs"]
mod strands;

use bowknot_dynamics::geometry::boundary_triangles;
use bowknot_dynamics::{
    Body, BodyShape, Dynamics, DynamicsModel, DynamicsParams, ParticleMaterial, SolidMaterial, SolidModel,
    StrandMaterial,
};
use bowknot_geometry::{Point, Vector};
use std::error::Error;
use std::time::Instant;

fn main() -> Result<(), Box<dyn Error>> {
    let steps = std::env::args().nth(1).and_then(|text| text.parse().ok()).unwrap_or(5);
    println!(
        "body, vertices, elements, seconds to build, seconds per step, CPU seconds per step, CG iterations \
         of both targets"
    );
    for model in [SolidModel::Stvk, SolidModel::StableNeoHookean] {
        // A slab of 1 m x 1 m x 2 cm that is held at one side and bent by its initial velocity.
        let (rest, tets) = block::block([1.0, 1.0, 0.02], [120, 120, 1]);
        let count = tets.len();
        let material = SolidMaterial { model, ..SolidMaterial::rubber() };
        let body = Body::solid("mat", tets, material);
        let held: Vec<bool> = rest.iter().map(|p| p.x < 1e-9).collect();
        measure(&format!("slab of rubber, {model:?}"), &rest, body, count, &held, steps)?;
    }
    let (rest, tets) = block::block([0.4, 0.4, 0.4], [31, 31, 31]);
    let count = tets.len();
    let held: Vec<bool> = rest.iter().map(|p| p.z < 1e-9).collect();
    let cube = Body::solid("cube", tets, SolidMaterial::rubber());
    measure("cube of rubber", &rest, cube.clone(), count, &held, steps)?;
    follow_surface(&rest, cube)?;

    let (rest, edges) = strands::strands(1575, 40, 0.3, 0.003);
    let count = edges.len();
    let held: Vec<bool> = (0..rest.len()).map(|v| v % 40 < 2).collect();
    let body = Body::strands("hair", edges, StrandMaterial::hair());
    measure("hair", &rest, body, count, &held, steps)?;

    let rest: Vec<Point> = (0..30_000)
        .map(|k| Point::new(0.001 * f64::from(k % 173), 0.001 * f64::from(k / 173), 0.0))
        .collect();
    let body = Body::particles("sand", (0..30_000).collect(), ParticleMaterial::sand());
    measure("sand", &rest, body, rest.len(), &vec![false; rest.len()], steps)
}

fn measure(
    name: &str,
    rest: &[Point],
    body: Body,
    elements: usize,
    held: &[bool],
    steps: usize,
) -> Result<(), Box<dyn Error>> {
    let timer = Instant::now();
    let model = DynamicsModel::new(rest.to_vec(), vec![body])?;
    let mut dynamics = Dynamics::new(model, DynamicsParams::default())?;
    let built = timer.elapsed().as_secs_f64();
    let mut x = rest.to_vec();
    let mut v: Vec<Vector> = rest
        .iter()
        .map(|p| Vector::new((9.0 * p.y).sin(), (8.0 * p.x).cos(), (7.0 * p.x).sin()) * 0.5)
        .collect();
    let (timer, cpu) = (Instant::now(), cpu_seconds());
    let mut iterations = Vec::new();
    for _ in 0..steps {
        let keyframes = x.clone();
        let infos = dynamics.solve_step(&mut x, &mut v, 0.01, held, &keyframes, 2)?;
        iterations.push(infos.iter().map(|i| i.cg.iterations.to_string()).collect::<Vec<_>>().join("+"));
    }
    let each = timer.elapsed().as_secs_f64() / steps as f64;
    let cpu = (cpu_seconds() - cpu) / steps as f64;
    println!("{name}, {}, {elements}, {built:.2}, {each:.3}, {cpu:.3}, {}", rest.len(), iterations.join(" "));
    Ok(())
}

/// The inside of a solid follows its surface, which contact stopped half-way to the target and moved aside by
/// 2 cm, more than a cell.
fn follow_surface(rest: &[Point], cube: Body) -> Result<(), Box<dyn Error>> {
    let BodyShape::Solid { tets, .. } = &cube.shape else { return Ok(()) };
    let mut surface = vec![false; rest.len()];
    boundary_triangles(tets).iter().flatten().for_each(|v| surface[*v as usize] = true);
    let model = DynamicsModel::new(rest.to_vec(), vec![cube])?;
    let mut dynamics = Dynamics::new(model, DynamicsParams::default())?;
    // Its velocity compresses it from top to bottom.
    let v: Vec<Vector> = rest.iter().map(|p| Vector::new(0.0, 0.0, 4.0 - 20.0 * p.z)).collect();
    let aside = Vector::new(0.02, 0.0, 0.0);
    let (mut x, mut y, none) = (rest.to_vec(), rest.to_vec(), vec![false; rest.len()]);
    dynamics.begin_step(rest, &v, 0.01)?;
    dynamics.newton_target(rest, &none, rest, &mut y)?;
    for k in (0..rest.len()).filter(|&k| surface[k]) {
        x[k] = rest[k] + (y[k] - rest[k]) * 0.5 + aside;
    }
    let inverted = dynamics.model().inverted_tets(&x).len();
    println!("inside of the cube: {inverted} inverted tets after contact, then after each target");
    for _ in 0..2 {
        let (held, cpu) = (x.clone(), cpu_seconds());
        let info = dynamics.newton_target(&x, &surface, &held, &mut y)?;
        x.copy_from_slice(&y);
        let (cpu, iterations) = (cpu_seconds() - cpu, info.cg.iterations);
        let inverted = dynamics.model().inverted_tets(&y).len();
        println!("    {inverted} inverted tets, {cpu:.3} CPU seconds, {iterations} CG iterations");
    }
    Ok(())
}

/// CPU seconds of this process so far (on Linux, in ticks of 10 ms). They are comparable also on a busy
/// machine.
fn cpu_seconds() -> f64 {
    let text = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    let fields = text.rsplit(')').next().unwrap_or_default().split_whitespace();
    let ticks: Vec<f64> = fields.skip(11).take(2).filter_map(|field| field.parse().ok()).collect();
    if ticks.len() == 2 { (ticks[0] + ticks[1]) / 100.0 } else { f64::NAN }
}
