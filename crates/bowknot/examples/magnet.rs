//! A magnet gathers beads: each is drawn to a place that moves, by an energy of its own position alone.
//!
//! ```text
//! cargo run --release -p bowknot --example magnet
//! ```

#![allow(clippy::print_stdout)]

use bowknot::dynamics::{CustomElement, ElementMatrix, ParticleMaterial, check_derivatives};
use bowknot::geometry::nalgebra::Matrix3;
use bowknot::geometry::{Point, Vector};
use bowknot::scene::{BodyKind, BodySpec, Material, ObstacleSpec, Scene};
use bowknot::shapes::{Grains, HalfSpaceShape, Shape};
use bowknot::{SimulationError, Simulator};
use std::sync::Arc;

/// Distance below which the magnet does not pull harder [m]: half of its width.
const WIDTH: f64 = 0.02;

/// A bead in the field of a magnet. Its energy is -s / r^2 with r^2 = |x - place|^2 + WIDTH^2.
#[derive(Debug)]
struct Bead {
    vertex: [u32; 1],
    place: Point,
    /// s [J m^2].
    strength: f64,
}

impl Bead {
    /// The way from the magnet [m], and r^2 [m^2].
    fn way(&self, x: &[Point]) -> (Vector, f64) {
        let way = x[0] - self.place;
        (way, way.norm_squared() + WIDTH * WIDTH)
    }
}

impl CustomElement for Bead {
    fn vertices(&self) -> &[u32] {
        &self.vertex
    }

    fn energy(&self, x: &[Point]) -> f64 {
        -self.strength / self.way(x).1
    }

    fn gradient(&self, x: &[Point], gradient: &mut [Vector]) {
        let (way, squared) = self.way(x);
        gradient[0] = way * (2.0 * self.strength / (squared * squared));
    }

    fn hessian(&self, x: &[Point], hessian: &mut ElementMatrix<'_>) {
        let (way, squared) = self.way(x);
        let outer = way * way.transpose() * (4.0 / squared);
        hessian.add(0, 0, &((Matrix3::identity() - outer) * (2.0 * self.strength / (squared * squared))));
    }

    // The energy depends on the place of the magnet: `is_invariant` stays false.
}

/// 36 steel beads of 8 mm on the ground.
fn scene() -> Scene {
    let material = ParticleMaterial { density: 7800.0, radius: 0.004 };
    let beads = BodySpec {
        name: "beads".to_owned(),
        kind: BodyKind::Particles,
        shape: Some(Shape::Grains(Grains { count: [6, 6, 1], spacing: 0.02, ..Grains::default() })),
        material: Material::Particles(material),
        translate: Vector::new(0.0, 0.0, 0.006),
        friction: 0.2,
        ..BodySpec::default()
    };
    let ground = Some(Shape::HalfSpace(HalfSpaceShape::default()));
    let ground =
        ObstacleSpec { name: "ground".to_owned(), shape: ground, friction: 0.2, ..ObstacleSpec::default() };
    Scene { bodies: vec![beads], obstacles: vec![ground], ..Scene::default() }
}

fn main() -> Result<(), SimulationError> {
    let mut simulator = Simulator::new(&scene())?;
    let count = simulator.world().bodies[0].mesh_order().len() as u32;
    let vertices = (0..count).map(|k| simulator.vertex("beads", k)).collect::<Result<Vec<u32>, _>>()?;
    let weight = 9.81 * simulator.dynamics_model().total_mass() / f64::from(count);
    // Where it pulls hardest, at a distance of WIDTH / sqrt 3, it draws a bead with 16 times its weight.
    let strength = 25.0 * weight * WIDTH.powi(3);
    let bead = |vertex: u32, place: Point| Bead { vertex: [vertex], place, strength };
    let field = |place: Point| -> Vec<Arc<dyn CustomElement>> {
        vertices.iter().map(|&v| Arc::new(bead(v, place)) as Arc<dyn CustomElement>).collect()
    };
    match check_derivatives(&bead(0, Point::origin()), &[Point::new(0.01, -0.02, 0.005)]) {
        Ok(errors) => println!("a bead's derivatives: {errors:?}"),
        Err(problem) => panic!("{problem}"),
    }
    let start = Point::new(0.0, 0.0, 0.02);
    simulator.add_elements("magnet", field(start))?;

    println!("  time  magnet: x, z      beads within 4 cm");
    let mut near = 0;
    for step in 0..150 {
        // It stays above the middle for a while, goes over the outer beads, and lifts what it has gathered.
        let aside = 0.06 * (f64::from(step - 30) / 60.0).clamp(0.0, 1.0);
        let up = 0.05 * (f64::from(step - 100) / 40.0).clamp(0.0, 1.0);
        let place = start + Vector::new(aside, 0.0, up);
        simulator.set_elements("magnet", field(place))?;
        simulator.step()?;
        near =
            vertices.iter().filter(|&&v| (simulator.positions()[v as usize] - place).norm() < 0.04).count();
        if step % 15 == 14 {
            println!("{:6.2}  {:7.3} {:7.3} m  {near:3} of {count}", simulator.time(), place.x, place.z);
        }
    }
    assert!(near >= 5, "the magnet holds {near} beads");
    Ok(())
}

#[test]
fn a_magnet_gathers_beads_and_lifts_them() {
    main().unwrap_or_else(|error| panic!("{error}"));
}
