//! A time step put together by hand: the dynamics computes where a cloth wants to be, the two-way step moves
//! it there without an intersection, and contacts go back to the dynamics as springs with friction.
//!
//! ```text
//! cargo run --release -p bowknot --example own_loop
//! ```

#![allow(clippy::print_stdout)]

use bowknot::check::{Judge, StateOptions};
use bowknot::dynamics::{Body, ClothMaterial, Dynamics, DynamicsModel, DynamicsParams};
use bowknot::dynamics::{RepulsionSpring, SpringKind, Touching};
use bowknot::geometry::{BodyFilter, CollisionModel, PairKind, Point, Separation, Topology, Vector};
use bowknot::proximity::Pair;
use bowknot::twoway::{ContactSet, Params, ResolveInput, Resolver};
use std::error::Error;

/// Vertices along each side of the cloth.
const SIDE: u32 = 21;

/// Time step [s].
const DT: f64 = 0.01;

fn main() -> Result<(), Box<dyn Error>> {
    // A cloth of 40 cm, and a table of four triangles, an obstacle, whose top has a peak in the middle.
    let cell = 0.4 / f64::from(SIDE - 1);
    let cloth = (0..SIDE * SIDE).map(|v| Point::new(f64::from(v % SIDE), f64::from(v / SIDE), 0.0) * cell);
    let peak = [[0.1, 0.1, 0.0], [0.3, 0.1, 0.0], [0.3, 0.3, 0.0], [0.1, 0.3, 0.0], [0.2, 0.2, 0.1]];
    let mut x: Vec<Point> = cloth.map(|p| p + 0.15 * Vector::z()).chain(peak.map(Point::from)).collect();
    let first = SIDE * SIDE;
    let square = |a: u32| [[a, a + 1, a + SIDE + 1], [a, a + SIDE + 1, a + SIDE]];
    let squares = (0..first - SIDE).filter(|a| a % SIDE != SIDE - 1);
    let triangles: Vec<[u32; 3]> = squares.flat_map(square).collect();
    let top = (0..4).map(|k| [first + k, first + (k + 1) % 4, first + 4]);

    // The dynamics knows materials, the resolver which bodies collide. Vertices are the same for both.
    let bodies = vec![
        Body::cloth("cloth", triangles.clone(), ClothMaterial::cotton()),
        Body::obstacle("table", (first..first + 5).collect()),
    ];
    let model = DynamicsModel::new(x.clone(), bodies)?;
    let masses = model.masses().to_vec();
    let mut dynamics = Dynamics::new(model, DynamicsParams::default())?;
    let topology = Topology::builder(x.len()).triangles(triangles.into_iter().chain(top)).build()?;
    let vertex_body = (0..x.len() as u32).map(|v| u32::from(v >= first)).collect();
    let filters = vec![BodyFilter::DEFORMABLE, BodyFilter::OBSTACLE];
    let collisions = CollisionModel::new(topology, vertex_body, filters, vec![])?;
    let judge = Judge::from_model(&collisions);
    let mut resolver = Resolver::new(collisions, &x, &masses, Params::fast())?;

    let mut v = vec![Vector::zeros(); x.len()];
    let (pinned, known) = (vec![false; x.len()], vec![true; x.len()]);
    for step in 1..=60 {
        let start = x.clone();
        dynamics.begin_step(&x, &v, DT)?;
        for _ in 0..8 {
            // The dynamics knows the contacts near x, so the two-way step leaves their gaps to it.
            let input = ResolveInput {
                time_step: Some(DT),
                start: Some(&start),
                known: &known,
                ..ResolveInput::default()
            };
            let springs = springs(resolver.detect_contacts(&x, &input)?, &start);
            dynamics.set_repulsion(&springs)?;
            let mut y = x.clone();
            dynamics.newton_target(&x, &pinned, &start, &mut y)?;
            resolver.resolve_with(&mut x, &y, &input, &mut ())?;
            let moved = x.iter().zip(&y).map(|(x, y)| (x - y).norm()).fold(0.0, f64::max);
            if moved < 1e-6 && dynamics.residual(&x, &pinned, &known)?.distance < 1e-4 {
                break;
            }
        }
        v = x.iter().zip(&start).map(|(x, start)| (x - start) / DT).collect();
        dynamics.end_velocities(&x, &pinned, &Touching::default(), &mut v);
        if step % 10 == 0 {
            let [highest, lowest] =
                [f64::max, f64::min].map(|of| x.iter().map(|x| x.z).reduce(of).unwrap_or(0.0));
            println!("t = {:.2} s: z from {lowest:6.3} to {highest:5.3} m", f64::from(step) * DT);
        }
    }
    assert!(judge.check_state(&x, &StateOptions::default())?.is_clear());
    assert!(x[..first as usize].iter().any(|x| x.z > 0.1), "the peak holds it");
    Ok(())
}

/// The contacts within reach as springs of the dynamics.
fn springs(contacts: &ContactSet, start: &[Point]) -> Vec<RepulsionSpring> {
    let pairs = contacts.pairs.iter().zip(&contacts.separations);
    let near = pairs.zip(&contacts.deltas).filter(|((_, separation), delta)| separation.distance < **delta);
    let spring = |(((kind, pair), separation), delta): (((PairKind, &Pair), &Separation), &f64)| {
        let weights = separation.signed_weights(kind);
        let gap = |k: usize| weights[k] * separation.normal.dot(&start[pair.vertices[k] as usize].coords);
        RepulsionSpring {
            kind: SpringKind::Contact,
            vertices: pair.vertices,
            weights,
            normal: separation.normal,
            offset: 0.0,
            reach: *delta,
            floor: 0.0,
            start_gap: (0..4).map(gap).sum(),
            stiffness: 1.0,
            friction: 0.5,
            friction_ratio: Vector::zeros(),
        }
    };
    near.map(spring).collect()
}

#[test]
fn a_cloth_lies_on_a_peak() {
    main().unwrap_or_else(|error| panic!("{error}"));
}
