//! A spring whose rest length follows music: a cloth hangs from two pins, and a spring between its lower
//! corners draws them together with each beat.
//!
//! ```text
//! cargo run --release -p bowknot --example music_spring
//! ```

#![allow(clippy::print_stdout)]

use bowknot::dynamics::{CustomElement, ElementMatrix, check_derivatives};
use bowknot::geometry::nalgebra::Matrix3;
use bowknot::geometry::{Point, Vector};
use bowknot::scene::{BodySpec, Scene};
use bowknot::shapes::MeshArrays;
use bowknot::{SimulationError, Simulator};
use std::sync::Arc;

/// Samples of the music per second.
const RATE: usize = 8000;

/// Time steps per second.
const FRAMES: usize = 60;

/// Energy k/2 (length - rest)^2 [J].
#[derive(Debug)]
struct Spring {
    vertices: [u32; 2],
    /// k [N/m].
    stiffness: f64,
    /// [m]
    rest: f64,
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
        let (length, direction) = (way.norm(), way.normalize());
        let along = direction * direction.transpose();
        // Negative where the spring is shorter than its rest length. The time step takes that away.
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

/// Four seconds of music: a note of an arpeggio every half second, which dies away.
fn music() -> Vec<f64> {
    let sample = |k: usize| {
        let (note, time) = (k / (RATE / 2), (k % (RATE / 2)) as f64 / RATE as f64);
        let pitch = 220.0 * [1.0, 1.25, 1.5, 2.0][note % 4];
        (2.0 * std::f64::consts::PI * pitch * time).sin() * (-8.0 * time).exp()
    };
    (0..4 * RATE).map(sample).collect()
}

/// How loud each time step's part of the music is, in [0, 1]: the root of its mean square.
fn loudness(samples: &[f64]) -> Vec<f64> {
    let mean_square = |part: &[f64]| part.iter().map(|s| s * s).sum::<f64>() / part.len() as f64;
    samples.chunks(RATE / FRAMES).map(|part| (2.0 * mean_square(part)).sqrt().min(1.0)).collect()
}

/// Vertices along each side of the cloth.
const SIDE: u32 = 11;

/// A cloth of 0.3 m that hangs in the plane y = 0, its lowest row first.
fn cloth() -> BodySpec {
    let step = 0.3 / f64::from(SIDE - 1);
    let vertex = |v: u32| Point::new(f64::from(v % SIDE) * step, 0.0, f64::from(v / SIDE) * step);
    let square = |q: u32| {
        let a = q / (SIDE - 1) * SIDE + q % (SIDE - 1);
        [[a, a + 1, a + SIDE + 1], [a, a + SIDE + 1, a + SIDE]]
    };
    let triangles = (0..(SIDE - 1) * (SIDE - 1)).flat_map(square).collect();
    BodySpec::from_arrays("cloth", MeshArrays::surface((0..SIDE * SIDE).map(vertex).collect(), triangles))
}

fn main() -> Result<(), SimulationError> {
    let mut scene = Scene { bodies: vec![cloth()], ..Scene::default() };
    scene.simulation.dt = 1.0 / FRAMES as f64;
    scene.environment.air_drag = 2.0;
    let mut simulator = Simulator::new(&scene)?;
    simulator.add_pin("hands", "cloth", &[SIDE * (SIDE - 1), SIDE * SIDE - 1])?;
    let corners = [simulator.vertex("cloth", 0)?, simulator.vertex("cloth", SIDE - 1)?];
    let string = |rest: f64| Arc::new(Spring { vertices: corners, stiffness: 20.0, rest });
    let places = corners.map(|v| simulator.positions()[v as usize]);
    match check_derivatives(&*string(0.2), &places) {
        Ok(errors) => println!("the spring's derivatives: {errors:?}"),
        Err(problem) => panic!("{problem}"),
    }
    simulator.add_elements("string", vec![string(0.3)])?;

    println!("  time  loudness  rest length  distance");
    let mut shortest = [f64::INFINITY; 2];
    for (frame, loud) in loudness(&music()).into_iter().enumerate() {
        // A soft string pulls at each beat, and is slack between.
        simulator.set_elements("string", vec![string(0.3 - 0.25 * loud)])?;
        simulator.step()?;
        let [a, b] = corners.map(|v| simulator.positions()[v as usize]);
        let distance = (b - a).norm();
        let is_loud = usize::from(loud > 0.5);
        shortest[is_loud] = shortest[is_loud].min(distance);
        if frame % 5 == 4 {
            println!("{:6.2}  {loud:8.2}  {:9.3} m  {distance:6.3} m", simulator.time(), 0.3 - 0.25 * loud);
        }
    }
    println!("shortest distance in loud parts: {:.3} m, in others: {:.3} m", shortest[1], shortest[0]);
    assert!(shortest[1] < 0.2, "the corners do not follow the music");
    Ok(())
}

#[test]
fn corners_of_the_cloth_follow_the_music() {
    main().unwrap_or_else(|error| panic!("{error}"));
}
