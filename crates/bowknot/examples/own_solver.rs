//! Contacts in a solver of one's own: a search lists the pairs, the pairs become springs, and their potential gives
//! energy, gradient and Hessian to a Newton's method that is written here.
//!
//! A triangle of three masses slides on a table and comes to rest by friction. Nothing holds its shape.
//!
//! `cargo run --release -p bowknot --example own_solver`

#![allow(clippy::print_stdout)]

use bowknot::constraints::Facing;
use bowknot::dynamics::{ContactLaw, ContactPotential, RepulsionSpring, StepError};
use bowknot::geometry::nalgebra::{SMatrix, SVector};
use bowknot::geometry::{BodyFilter, CollisionModel, Point, Topology, Vector, separation};
use bowknot::proximity::{PairList, ProximitySearch};
use std::error::Error;

/// Each of the three masses [kg].
const MASS: f64 = 0.1;
const GRAVITY: f64 = 9.81;
/// The time step [s].
const DT: f64 = 0.005;
const LAW: ContactLaw = ContactLaw { stiffness: 1000.0, reach: 0.002, floor: 0.0, friction: 0.5 };

/// What finds contacts, kept from call to call.
struct Contacts {
    model: CollisionModel,
    facing: Facing,
    search: ProximitySearch,
    pairs: PairList,
    separations: Vec<separation::Separation>,
}

impl Contacts {
    /// The potential of the contacts at `x`, with slip since `start`.
    fn potential(&mut self, x: &[Point], start: &[Point]) -> Result<ContactPotential, StepError> {
        let radii = vec![0.5 * LAW.reach; x.len()];
        self.search.search(&self.model, x, &radii, &mut self.pairs, &mut self.separations);
        let topology = self.model.topology();
        let springs = self.pairs.iter().zip(&self.separations).map(|((kind, pair), separation)| {
            // Pairs that are close only because their neighbors touch are no contacts.
            let features = Facing::features(topology, kind, pair, separation);
            let share = self.facing.contact_share(topology, features, &separation.normal, x);
            let law = ContactLaw { stiffness: share * LAW.stiffness, ..LAW };
            RepulsionSpring::of_pair(kind, pair.vertices, separation, &law, x, start)
        });
        ContactPotential::new(&springs.collect::<Vec<_>>(), x, start)
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut x: Vec<Point> = [
        [0.0, 0.0, 0.0014],
        [0.1, 0.0, 0.0014],
        [0.0, 0.1, 0.0014],
        [-1.0, -1.0, 0.0],
        [1.0, -1.0, 0.0],
        [1.0, 1.0, 0.0],
        [-1.0, 1.0, 0.0],
    ]
    .map(Point::from)
    .to_vec();
    let topology = Topology::builder(7).triangles([[0, 1, 2], [3, 4, 5], [3, 5, 6]]).build()?;
    let facing = Facing::new(&topology);
    let bodies = vec![BodyFilter::DEFORMABLE, BodyFilter::OBSTACLE];
    let model = CollisionModel::new(topology, vec![0, 0, 0, 1, 1, 1, 1], bodies, Vec::new())?;
    let search = ProximitySearch::new(&model);
    let mut contacts =
        Contacts { model, facing, search, pairs: PairList::default(), separations: Vec::new() };

    let speed = 1.0;
    let mut v = [Vector::x() * speed; 3];
    for step in 0..100 {
        let start = x.clone();
        let inertial = [0, 1, 2].map(|i: usize| start[i] + (v[i] - Vector::z() * (GRAVITY * DT)) * DT);
        newton(&mut contacts, &mut x, &start, &inertial)?;
        v = [0, 1, 2].map(|i: usize| (x[i] - start[i]) / DT);
        if step % 10 == 0 {
            println!("{:.3} s: at {:.4} m, {:.4} m/s", f64::from(step) * DT, x[0].x, v[0].x);
        }
    }
    let forces = contacts.potential(&x, &x)?.forces(&x);
    let carried: f64 = forces.iter().map(|force| force.normal).sum();
    println!("{} contacts carry {carried:.6} N of {:.6} N", forces.len(), 3.0 * MASS * GRAVITY);
    assert!((carried - 3.0 * MASS * GRAVITY).abs() < 1e-6);
    // Coulomb's v^2 / (2 mu g), less what implicit Euler brakes at once.
    let way = speed * (speed / (2.0 * LAW.friction * GRAVITY) - 0.5 * DT);
    assert!((x[0].x - way).abs() < 0.01 * way && v[0].norm() < 1e-6, "{} {way}", x[0].x);
    Ok(())
}

/// Minimizes inertia and contacts over the three masses.
fn newton(
    contacts: &mut Contacts,
    x: &mut Vec<Point>,
    start: &[Point],
    inertial: &[Point; 3],
) -> Result<(), StepError> {
    let stiffness = MASS / (DT * DT);
    for _ in 0..30 {
        // Normals, closest points and bounds of friction are those of this iterate.
        let potential = contacts.potential(x, start)?;
        let mut matrix = SMatrix::<f64, 9, 9>::identity() * stiffness;
        for (row, column, block) in potential.hessian(x).into_iter().filter(|(i, j, _)| *i.max(j) < 3) {
            let mut place = matrix.fixed_view_mut::<3, 3>(3 * row as usize, 3 * column as usize);
            place += block;
        }
        let mut force = SVector::<f64, 9>::zeros();
        for (i, gradient) in potential.gradient(x).iter().take(3).enumerate() {
            force.fixed_rows_mut::<3>(3 * i).copy_from(&((inertial[i] - x[i]) * stiffness - gradient));
        }
        let Some(step) = matrix.cholesky().map(|factor| factor.solve(&force)) else { break };

        let energy = |x: &[Point]| {
            let inertia: f64 = (0..3).map(|i| (x[i] - inertial[i]).norm_squared()).sum();
            0.5 * stiffness * inertia + potential.energy(x)
        };
        let before = energy(x);
        let mut fraction = 1.0;
        while fraction > 1e-6 {
            let mut trial = x.clone();
            (0..3).for_each(|i| trial[i] += step.fixed_rows::<3>(3 * i) * fraction);
            // The energy is finite on the other side too.
            if energy(&trial) <= before && is_above(&trial) {
                *x = trial;
                break;
            }
            fraction *= 0.5;
        }
        if step.norm() < 1e-12 {
            break;
        }
    }
    Ok(())
}

/// Whether a plane certainly separates the triangle from both halves of the table, and it is above.
fn is_above(x: &[Point]) -> bool {
    [[3, 4, 5], [3, 5, 6]].iter().all(|table| {
        let table = table.map(|v: usize| &x[v]);
        let apart = separation::triangle_triangle([&x[0], &x[1], &x[2]], table);
        apart.width > 0.0 && x[0].z > 0.0
    })
}

#[test]
fn a_triangle_slides_as_far_as_coulomb_says() {
    main().unwrap_or_else(|error| panic!("{error}"));
}
