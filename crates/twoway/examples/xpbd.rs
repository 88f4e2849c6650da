//! Cloth by extended position-based dynamics (XPBD) over an obstacle that rises and turns, and on the ground.
//! `docs/tutorials/own-solver.md` explains it.
//!
//! `cargo run --release -p bowknot-twoway --example xpbd -- [friction] [frames]`
//!
//! Source of the constraint projection: Macklin, Mueller and Chentanez, "XPBD: position-based simulation of
//! compliant constrained dynamics", 2016, Eq. 18, with one iteration per substep.
#![allow(clippy::print_stdout)] // an example's purpose is to print

use bowknot_twoway::geometry::{HalfSpace, Point, Topology, Vector};
use bowknot_twoway::proximity::{BodyFilter, CollisionModel};
use bowknot_twoway::{BodyContact, ContactData, HalfSpaceContact, Params, ResolveInput, Resolver};
use std::error::Error;

/// A square sheet [m, kg, s; z up].
pub struct Cloth {
    /// Positions.
    pub x: Vec<Point>,
    /// Velocities.
    pub v: Vec<Vector>,
    /// Mass of each vertex.
    mass: f64,
    /// Which vertices are pinned.
    pub pinned: Vec<bool>,
    /// Ends, rest length [m] and compliance [m/N] of each spring.
    springs: Vec<([usize; 2], f64, f64)>,
    triangles: Vec<[u32; 3]>,
}

impl Cloth {
    /// A level sheet of n x n vertices.
    fn sheet(n: usize, side: f64, height: f64) -> Self {
        let h = side / (n - 1) as f64;
        let at =
            |i: usize| Point::new((i % n) as f64 * h - 0.49 * side, (i / n) as f64 * h - 0.48 * side, height);
        let x: Vec<Point> = (0..n * n).map(at).collect();
        let (mut springs, mut triangles) = (Vec::new(), Vec::new());
        for (i, j) in (0..n * n).map(|k| (k % n, k / n)) {
            // Along the threads, across them, and over two cells against bending.
            for (di, dj, compliance) in [(1, 0, 1e-6), (0, 1, 1e-6), (1, 1, 1e-4), (2, 0, 0.5), (0, 2, 0.5)] {
                if i + di < n && j + dj < n {
                    let ends = [j * n + i, (j + dj) * n + i + di];
                    springs.push((ends, (x[ends[0]] - x[ends[1]]).norm(), compliance));
                }
            }
            if i + 1 < n && j + 1 < n {
                let [a, b, c, d] =
                    [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)].map(|(i, j)| (j * n + i) as u32);
                triangles.extend([[a, b, c], [a, c, d]]);
            }
        }
        let mass = 0.2 * side * side / x.len() as f64;
        let (v, pinned) = (vec![Vector::zeros(); x.len()], vec![false; x.len()]);
        Self { x, v, mass, pinned, springs, triangles }
    }

    /// Moves the vertices to where they would be after `dt` if nothing were in their way.
    fn substep(&mut self, dt: f64) {
        let weight = |pinned: bool| if pinned { 0.0 } else { 1.0 / self.mass };
        let w: Vec<f64> = self.pinned.iter().map(|&pinned| weight(pinned)).collect();
        for i in (0..w.len()).filter(|&i| w[i] > 0.0) {
            self.v[i].z -= 9.81 * dt;
            self.x[i] += dt * self.v[i];
        }
        for &([a, b], rest, compliance) in self.springs.iter().filter(|([a, b], ..)| w[*a] + w[*b] > 0.0) {
            let d = self.x[b] - self.x[a];
            let pull = d * ((d.norm() - rest) / (d.norm() * (w[a] + w[b] + compliance / (dt * dt))));
            self.x[a] += w[a] * pull;
            self.x[b] -= w[b] * pull;
        }
    }

    /// Velocities from the way since `start`, damped along the springs.
    fn set_velocities(&mut self, start: &[Point], dt: f64) {
        self.v = self.x.iter().zip(start).map(|(x, start)| (x - start) / dt).collect();
        for &([a, b], ..) in &self.springs {
            let along = (self.x[b] - self.x[a]).normalize();
            let impulse = along * (0.5 * 0.1 * (self.v[b] - self.v[a]).dot(&along));
            self.v[a] += impulse;
            self.v[b] -= impulse;
        }
    }
}

/// An octahedron that rises in the first second and turns from the second on: its vertices at a time [s].
fn obstacle_at(time: f64) -> [Point; 6] {
    let (rise, angle) = (0.15 * time.min(1.0), (time - 2.0).max(0.0));
    let (sin, cos) = angle.sin_cos();
    [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, -1.0]]
        .map(|[x, y, z]| Point::new(cos * x - sin * y, sin * x + cos * y, z) * 0.2)
        .map(|p| p + Vector::new(0.0, 0.0, 0.45 + rise))
}

/// Faces of the octahedron.
const OBSTACLE: [[u32; 3]; 8] =
    [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4], [1, 0, 5], [2, 1, 5], [3, 2, 5], [0, 3, 5]];

/// What collides: the cloth, body 0; the obstacle, body 1, whose vertices follow; the ground.
fn resolver(cloth: &Cloth, x: &[Point], friction: f64) -> Result<Resolver, Box<dyn Error>> {
    let first = cloth.x.len() as u32;
    let obstacle = OBSTACLE.map(|triangle| triangle.map(|v| v + first));
    let topology =
        Topology::builder(x.len()).triangles(cloth.triangles.iter().copied().chain(obstacle)).build()?;
    let body = (0..x.len() as u32).map(|v| u32::from(v >= first)).collect();
    let filters = vec![BodyFilter::DEFORMABLE, BodyFilter::OBSTACLE];
    let ground = HalfSpace::new(Point::origin(), Vector::z()).ok_or("the ground has no normal")?;
    let model = CollisionModel::new(topology, body, filters, vec![ground])?;
    // Friction needs both sides. The springs alone limit the stretch here, as they would without collisions.
    let of_cloth = BodyContact { friction, stretch_limit: Some(f64::INFINITY), ..BodyContact::default() };
    let of_obstacle = BodyContact { friction, ..BodyContact::default() };
    let of_ground = HalfSpaceContact { friction, ..HalfSpaceContact::default() };
    let contact = ContactData {
        bodies: vec![of_cloth, of_obstacle],
        half_spaces: vec![of_ground],
        ..ContactData::default()
    };
    Ok(Resolver::with_contact(model, x, &vec![cloth.mass; x.len()], contact, Params::fast())?)
}

/// Simulates frames of 1/60 s, each of ten substeps. Returns the cloth, the two-way steps of all substeps,
/// and the smallest gap [m].
pub fn simulate(cells: usize, friction: f64, frames: usize) -> Result<(Cloth, usize, f64), Box<dyn Error>> {
    let dt = 1.0 / 600.0;
    let mut cloth = Cloth::sheet(cells + 1, 1.0, 0.75);
    let count = cloth.x.len();
    let mut x = [&cloth.x[..], &obstacle_at(0.0)].concat();
    let mut resolver = resolver(&cloth, &x, friction)?;
    assert!(resolver.detect_intersections(&x, 1)?.is_clear(), "the start must be free of intersections");
    let (mut steps, mut gap) = (0, f64::INFINITY);
    for substep in 1..=10 * frames {
        let time = substep as f64 * dt;
        // Two corners are pinned in the first second.
        [0, cells].iter().for_each(|&corner| cloth.pinned[corner] = time < 1.0);
        let prescribed: Vec<bool> = cloth.pinned.iter().copied().chain([true; 6]).collect();

        let start = cloth.x.clone();
        cloth.substep(dt);
        let y = [&cloth.x[..], &obstacle_at(time)].concat();
        let input = ResolveInput { prescribed: &prescribed, time_step: Some(dt), ..ResolveInput::default() };
        let report = resolver.resolve_with(&mut x, &y, &input, &mut ())?;
        cloth.x.copy_from_slice(&x[..count]);
        cloth.set_velocities(&start, dt);

        steps += report.steps;
        gap = report.min_gap_m.unwrap_or(gap).min(gap);
        if !report.converged || !report.lags.is_empty() {
            println!("substep {substep}: {} steps, lags {:?}", report.steps, report.lags);
        }
    }
    assert!(resolver.detect_intersections(&x, 1)?.is_clear(), "no intersection, ever");
    Ok((cloth, steps, gap))
}

/// Simulates with the friction and the number of frames that the command line gives.
pub fn main() -> Result<(), Box<dyn Error>> {
    let argument =
        |k: usize, default: f64| std::env::args().nth(k).and_then(|a| a.parse().ok()).unwrap_or(default);
    let (friction, frames) = (argument(1, 0.5), argument(2, 240.0) as usize);
    let (cloth, steps, gap) = simulate(29, friction, frames)?;
    let mean = cloth.x.iter().map(|p| p.z).sum::<f64>() / cloth.x.len() as f64;
    println!(
        "{frames} frames: {:.2} two-way steps per substep, smallest gap {:.3} mm, mean height {mean:.3} m",
        steps as f64 / (10 * frames) as f64,
        1e3 * gap
    );
    Ok(())
}
