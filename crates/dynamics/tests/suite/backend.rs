//! Linear solves by a backend: the targets are those of the CPU, and failures are errors.

use crate::common::{dynamics, sheet, with_tolerance};
use bowknot_dynamics::{
    Body, ClothMaterial, Dynamics, LinearBackend, LinearBackendError, LinearSystem, RepulsionSpring,
    SpringKind, StepError,
};
use bowknot_geometry::{Point, Vector};
use nalgebra::{Matrix3, Vector3};

const DT: f64 = 0.02;

/// So many that a time step is solved: intermediate linear solves are inexact, and each solver errs in its
/// own way.
const NEWTON_ITERATIONS: usize = 10;

/// Largest difference of two solvers as a share of the way: the forces of the contacts may be off by 0.2 %,
/// so that time steps are not solved to rounding.
const AGREEMENT: f64 = 2e-5;

/// Conjugate gradients in single precision with block-Jacobi, one loop after the other.
#[derive(Debug, Default)]
struct Plain {
    rows: Vec<Vec<(usize, Matrix3<f32>)>>,
    sums: Vec<Matrix3<f32>>,
    inverses: Vec<Matrix3<f32>>,
    r: Vec<Vector3<f32>>,
    fault: Fault,
}

#[derive(Clone, Copy, Debug, Default, PartialEq)]
enum Fault {
    #[default]
    None,
    /// Each call is an error.
    Lost,
    /// It makes no progress.
    Idle,
}

impl Plain {
    fn multiply(&self, x: &[Vector3<f32>]) -> Vec<Vector3<f32>> {
        let row = |i: usize| {
            let others = self.rows[i].iter().map(|(j, block)| block * (x[*j] - x[i]));
            others.fold(self.sums[i] * x[i], |sum, product| sum + product)
        };
        (0..x.len()).map(row).collect()
    }

    fn precondition(&self, r: &[Vector3<f32>]) -> Vec<Vector3<f32>> {
        r.iter().zip(&self.inverses).map(|(r, inverse)| inverse * r).collect()
    }
}

fn dot(a: &[Vector3<f32>], b: &[Vector3<f32>]) -> f64 {
    a.iter().zip(b).map(|(a, b)| f64::from(a.dot(b))).sum()
}

impl LinearBackend for Plain {
    fn name(&self) -> String {
        "plain".to_owned()
    }

    fn prepare(&mut self, system: &LinearSystem<'_>) -> Result<(), LinearBackendError> {
        if self.fault == Fault::Lost {
            return Err("the device was lost".into());
        }
        (self.rows, self.sums, self.inverses) = Default::default();
        for i in 0..system.free.len() {
            let (mut row, mut sum) = (Vec::new(), Matrix3::zeros());
            let mut inverse = Matrix3::zeros();
            if system.free[i] {
                row.extend(system.blocks.row(i).map(|(j, block)| (j, *block)));
                row.extend(system.scalars.row(i).map(|(j, q)| (j, Matrix3::from_diagonal_element(*q))));
                sum = system.row_sum(i);
                for &(spring, weight) in system.springs_of(i) {
                    let spring = &system.springs[spring as usize];
                    for (&j, other) in spring.nodes.iter().zip(spring.weights) {
                        if j != u32::MAX {
                            let block = spring.hessian * (weight * other);
                            sum += block;
                            row.push((j as usize, block));
                        }
                    }
                }
                inverse = system.diagonal_with_springs(i).try_inverse().ok_or("singular")?;
            }
            row.retain(|(j, _)| *j != i);
            self.rows.push(row.into_iter().map(|(j, block)| (j, block.cast())).collect());
            self.sums.push(sum.cast());
            self.inverses.push(inverse.cast());
        }
        Ok(())
    }

    fn begin(&mut self, r: &[Vector], factor: f64) -> Result<f64, LinearBackendError> {
        self.r = r.iter().map(|r| (r * factor).cast()).collect();
        Ok(dot(&self.r, &self.precondition(&self.r)))
    }

    fn iterate(
        &mut self,
        goal: f64,
        max_iterations: usize,
        factor: f64,
        x: &mut [Vector],
    ) -> Result<usize, LinearBackendError> {
        if self.fault == Fault::Idle {
            return Ok(0);
        }
        let mut solution = vec![Vector3::zeros(); x.len()];
        let mut p = self.precondition(&self.r);
        let mut rz = dot(&self.r, &p);
        let goal = goal.max(1e-10 * rz);
        let mut iterations = 0;
        while rz > goal && iterations < max_iterations {
            let q = self.multiply(&p);
            let step = (rz / dot(&p, &q)) as f32;
            for k in 0..x.len() {
                solution[k] += p[k] * step;
                self.r[k] -= q[k] * step;
            }
            let z = self.precondition(&self.r);
            let next = dot(&self.r, &z);
            let ratio = (next / rz) as f32;
            p.iter_mut().zip(&z).for_each(|(p, z)| *p = z + *p * ratio);
            rz = next;
            iterations += 1;
        }
        x.iter_mut().zip(&solution).for_each(|(x, s)| *x += s.cast::<f64>() * factor);
        Ok(iterations)
    }
}

/// A sheet that hangs at two corners, with springs between some of its vertices and to an obstacle.
fn hanging_sheet(tolerance: f64) -> (Dynamics, Vec<Point>, Vec<bool>) {
    let (mut rest, triangles) = sheet(0.3, 0.3, 10, 10);
    let count = rest.len() as u32;
    rest.push(Point::new(0.15, 0.15, -0.01));
    let bodies =
        vec![Body::cloth("sheet", triangles, ClothMaterial::cotton()), Body::obstacle("floor", vec![count])];
    let mut dynamics = dynamics(&rest, bodies, with_tolerance(tolerance));
    let spring = |vertices: [u32; 4], weights| RepulsionSpring {
        kind: SpringKind::Contact,
        vertices,
        weights,
        normal: Vector::z(),
        offset: 0.0,
        reach: 0.012,
        floor: -0.05,
        start_gap: 0.012,
        stiffness: 1.0,
        friction: 0.3,
        friction_ratio: Vector::zeros(),
    };
    let springs = [
        spring([60, count, 0, 0], [1.0, -1.0, 0.0, 0.0]),
        spring([30, 52, 63, 64], [1.0, -0.25, -0.25, -0.5]),
    ];
    dynamics.set_repulsion(&springs).expect("valid");
    let held = (0..=count).map(|v| [0, 10, count].contains(&v)).collect();
    (dynamics, rest, held)
}

fn fall(dynamics: &mut Dynamics, rest: &[Point], held: &[bool], steps: usize) -> Vec<Point> {
    let (mut x, mut v) = (rest.to_vec(), vec![Vector::zeros(); rest.len()]);
    for _ in 0..steps {
        let infos = dynamics.solve_step(&mut x, &mut v, DT, held, rest, NEWTON_ITERATIONS).expect("solves");
        assert!(infos.iter().all(|info| info.cg.converged), "{infos:?}");
    }
    x
}

fn apart(a: &[Point], b: &[Point]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max)
}

#[test]
fn targets_are_those_of_the_cpu() {
    let (mut cpu, rest, held) = hanging_sheet(1e-9);
    let (mut other, ..) = hanging_sheet(1e-9);
    other.set_backend(Some(Box::new(Plain::default())));
    assert_eq!(other.backend().map(LinearBackend::name).as_deref(), Some("plain"));
    let [a, b] = [&mut cpu, &mut other].map(|dynamics| fall(dynamics, &rest, &held, 8));
    let (apart, fallen) = (apart(&a, &b), apart(&a, &rest));
    assert!(fallen > 0.1 && apart < AGREEMENT * fallen && apart > 0.0, "{apart:e} m of {fallen} m");
}

#[test]
fn where_single_precision_gains_nothing_the_cpu_solves() {
    let (mut cpu, rest, held) = hanging_sheet(1e-9);
    let (mut other, ..) = hanging_sheet(1e-9);
    other.set_backend(Some(Box::new(Plain { fault: Fault::Idle, ..Plain::default() })));
    let [a, b] = [&mut cpu, &mut other].map(|dynamics| fall(dynamics, &rest, &held, 8));
    let (apart, fallen) = (apart(&a, &b), apart(&a, &rest));
    assert!(apart < AGREEMENT * fallen, "{apart:e} m");
}

#[test]
fn a_backend_that_fails_is_an_error_and_may_be_replaced() {
    let (mut dynamics, rest, held) = hanging_sheet(1e-6);
    dynamics.set_backend(Some(Box::new(Plain { fault: Fault::Lost, ..Plain::default() })));
    let (mut x, mut v) = (rest.clone(), vec![Vector::zeros(); rest.len()]);
    let error = dynamics.solve_step(&mut x, &mut v, DT, &held, &rest, 1).expect_err("it is lost");
    assert_eq!(error, StepError::LinearBackend { message: "the device was lost".to_owned() });
    assert_eq!(x, rest);
    dynamics.set_backend(None);
    let resumed = fall(&mut dynamics, &rest, &held, 3);
    let (mut fresh, ..) = hanging_sheet(1e-6);
    assert_eq!(resumed, fall(&mut fresh, &rest, &held, 3));
}
