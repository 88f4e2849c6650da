//! A cloth of your own material: its membrane is a triangle law from outside, here that of St. Venant and
//! Kirchhoff. Under its own weight it must stretch as the built-in law does, since strains are small.
//!
//! ```text
//! cargo run --release -p bowknot --example own_triangle
//! ```

#![allow(clippy::print_stdout)]

use bowknot::dynamics::{ClothMaterial, CustomElement, ElementMatrix, check_derivatives};
use bowknot::geometry::nalgebra::{Matrix2, Matrix3, Matrix3x2, Vector2};
use bowknot::geometry::{Point, Vector};
use bowknot::scene::{BodySpec, Material, Scene};
use bowknot::shapes::MeshArrays;
use bowknot::{SimulationError, Simulator};
use std::sync::Arc;

/// Vertices along the width and the length of the strip.
const COUNT: [u32; 2] = [5, 21];

/// Length of the strip [m].
const LENGTH: f64 = 1.0;

/// Energy area (mu |E|^2 + lambda/2 tr(E)^2) of the strain E = (F^T F - I)/2, with F = sum x_a g_a^T.
#[derive(Debug)]
struct Triangle {
    vertices: [u32; 3],
    /// Gradients g_a of the shape functions at rest [1/m].
    gradients: [Vector2<f64>; 3],
    /// At rest [m^2].
    area: f64,
    /// lambda and mu [N/m].
    lame: (f64, f64),
}

impl Triangle {
    /// A triangle with its corners at rest [m]; None if it has no area.
    fn new(vertices: [u32; 3], rest: [Point; 3], lame: (f64, f64)) -> Option<Self> {
        let (a, b) = (rest[1] - rest[0], rest[2] - rest[0]);
        let along = a.normalize();
        let across = (b - along * along.dot(&b)).normalize();
        let edges = Matrix2::new(a.dot(&along), b.dot(&along), a.dot(&across), b.dot(&across));
        let inverse = edges.try_inverse()?;
        let [g1, g2] = [0, 1].map(|row| Vector2::new(inverse[(row, 0)], inverse[(row, 1)]));
        Some(Self { vertices, gradients: [-g1 - g2, g1, g2], area: 0.5 * edges.determinant(), lame })
    }

    fn deformation(&self, x: &[Point]) -> Matrix3x2<f64> {
        x.iter().zip(&self.gradients).map(|(x, g)| x.coords * g.transpose()).sum()
    }

    fn strain(f: &Matrix3x2<f64>) -> Matrix2<f64> {
        (f.transpose() * f - Matrix2::identity()) * 0.5
    }

    /// The stress S = 2 mu E + lambda tr(E) I [N/m].
    fn stress(&self, f: &Matrix3x2<f64>) -> Matrix2<f64> {
        let ((lambda, mu), strain) = (self.lame, Self::strain(f));
        strain * (2.0 * mu) + Matrix2::from_diagonal_element(lambda * strain.trace())
    }
}

impl CustomElement for Triangle {
    fn vertices(&self) -> &[u32] {
        &self.vertices
    }

    fn energy(&self, x: &[Point]) -> f64 {
        let ((lambda, mu), strain) = (self.lame, Self::strain(&self.deformation(x)));
        self.area * (mu * strain.norm_squared() + 0.5 * lambda * strain.trace().powi(2))
    }

    fn gradient(&self, x: &[Point], gradient: &mut [Vector]) {
        let f = self.deformation(x);
        let forces = f * self.stress(&f) * self.area;
        gradient.iter_mut().zip(&self.gradients).for_each(|(gradient, g)| *gradient = forces * g);
    }

    fn hessian(&self, x: &[Point], hessian: &mut ElementMatrix<'_>) {
        let (f, (lambda, mu)) = (self.deformation(x), self.lame);
        let stress = self.stress(&f);
        for (a, g_a) in self.gradients.iter().enumerate() {
            for (b, g_b) in self.gradients.iter().enumerate().skip(a) {
                let (f_a, f_b) = (f * g_a, f * g_b);
                let block = Matrix3::from_diagonal_element(g_a.dot(&(stress * g_b)))
                    + f * f.transpose() * (mu * g_a.dot(g_b))
                    + f_b * f_a.transpose() * mu
                    + f_a * f_b.transpose() * lambda;
                hessian.add(a, b, &(block * self.area));
            }
        }
    }

    fn is_invariant(&self) -> bool {
        true
    }
}

/// A strip that hangs in the plane y = 0, its highest row first.
fn strip() -> MeshArrays {
    let [columns, rows] = COUNT;
    let step = LENGTH / f64::from(rows - 1);
    let vertex = |v: u32| Point::new(f64::from(v % columns) * step, 0.0, -f64::from(v / columns) * step);
    let square = |q: u32| {
        let a = q / (columns - 1) * columns + q % (columns - 1);
        [[a, a + 1, a + columns + 1], [a, a + columns + 1, a + columns]]
    };
    let triangles = (0..(columns - 1) * (rows - 1)).flat_map(square).collect();
    MeshArrays::surface((0..columns * rows).map(vertex).collect(), triangles)
}

/// How much longer the strip is under its own weight [m].
fn elongation(material: ClothMaterial, own_lame: Option<(f64, f64)>) -> Result<f64, SimulationError> {
    let mesh = strip();
    let body = BodySpec::from_arrays("strip", mesh.clone());
    let body = BodySpec { material: Material::Cloth(material), ..body };
    let mut scene = Scene { bodies: vec![body], ..Scene::default() };
    scene.simulation.dt = 0.05;
    let mut simulator = Simulator::new(&scene)?;
    simulator.add_pin("rail", "strip", &(0..COUNT[0]).collect::<Vec<u32>>())?;
    if let Some(lame) = own_lame {
        let mut elements: Vec<Arc<dyn CustomElement>> = Vec::new();
        for triangle in mesh.triangles {
            let mut vertices = [0; 3];
            for (vertex, corner) in vertices.iter_mut().zip(triangle) {
                *vertex = simulator.vertex("strip", corner)?;
            }
            let rest = vertices.map(|v| simulator.positions()[v as usize]);
            let element = Triangle::new(vertices, rest, lame);
            elements.extend(element.map(|element| Arc::new(element) as Arc<dyn CustomElement>));
        }
        let deformed = [[0.0, 0.1, 0.0], [0.06, -0.02, 0.01], [0.01, 0.02, 0.06]].map(Point::from);
        match check_derivatives(&*elements[0], &deformed) {
            Ok(errors) => println!("a triangle's derivatives: {errors:?}"),
            Err(problem) => panic!("{problem}"),
        }
        simulator.add_elements("membrane", elements)?;
    }
    for _ in 0..80 {
        simulator.step()?;
    }
    let last = simulator.vertex("strip", COUNT[0] * (COUNT[1] - 1))?;
    Ok(-simulator.positions()[last as usize].z - LENGTH)
}

fn main() -> Result<(), SimulationError> {
    let material = ClothMaterial { stretch_limit: f64::INFINITY, ..ClothMaterial::cotton() };
    // Without a stiffness of its own the membrane is that of the elements alone; bending stays.
    let bare = ClothMaterial { stretch_stiffness: 0.0, ..material };
    let built_in = elongation(material, None)?;
    let own = elongation(bare, Some(material.lame()))?;
    let theory = material.density * 9.81 * LENGTH * LENGTH / (2.0 * material.stretch_stiffness);
    println!("the strip of {LENGTH} m stretches by");
    println!("  {:.4} mm in theory, without the hem that the rail keeps wide", 1e3 * theory);
    println!("  {:.4} mm by the built-in law", 1e3 * built_in);
    println!("  {:.4} mm by the law of this file", 1e3 * own);
    assert!((own / built_in - 1.0).abs() < 0.01, "both laws differ");
    Ok(())
}

#[test]
fn the_law_of_this_file_stretches_as_the_built_in_one() {
    main().unwrap_or_else(|error| panic!("{error}"));
}
