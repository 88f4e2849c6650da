//! Colors of the rows of recorded collision problems: rows of one color share no vertex that can move, so a
//! sweep may treat them in parallel with one and the same result.
//!
//! `cargo run --release -- run stack --record && cargo run --release -p bowknot --example colors --
//! out/stack/states/*.npz`

#![allow(clippy::print_stdout)]

use bowknot::geometry::Topology;
use bowknot::proximity::{BodyFilter, CollisionModel};
use bowknot::recording::States;
use bowknot::twoway::{AcceptedState, Params, ResolveInput, Resolver};
use std::error::Error;
use std::ops::ControlFlow;
use std::path::Path;

fn main() -> Result<(), Box<dyn Error>> {
    println!("preset  contact rows, colors  edge rows, colors");
    for path in std::env::args().skip(1) {
        let states = States::read(Path::new(&path))?;
        for (name, params) in [("fast", Params::fast()), ("paper", Params::paper())] {
            // The colors of the first backward step; later ones have like rows.
            let mut resolver = Resolver::new(model(&states)?, &states.rest, &states.masses, params)?;
            let mut x = states.x.clone();
            let input = ResolveInput {
                prescribed: &states.fixed,
                time_step: states.time_step,
                ..ResolveInput::default()
            };
            let mut stop = |_: &AcceptedState<'_>| ControlFlow::Break(());
            let s = resolver.resolve_with(&mut x, &states.y, &input, &mut stop)?;
            println!(
                "{name:6}  {:7} {:5}  {:7} {:5}",
                s.contact_rows, s.contact_colors, s.edge_rows, s.edge_colors
            );
        }
    }
    Ok(())
}

/// The collision model of a problem. A body of obstacle vertices is an obstacle.
fn model(states: &States) -> Result<CollisionModel, Box<dyn Error>> {
    let (triangles, count) = (states.triangles.clone(), states.x.len());
    let topology = Topology::builder(count)
        .triangles(triangles)
        .strand_edges(states.strands.iter().copied())
        .particles(states.particles.iter().copied())
        .build()
        .map_err(|errors| errors[0].clone())?;
    let bodies = states.body.iter().max().map_or(0, |&body| body as usize + 1);
    let mut filters = vec![BodyFilter::DEFORMABLE; bodies];
    for (&body, &obstacle) in states.body.iter().zip(&states.obstacle) {
        if obstacle {
            filters[body as usize] = BodyFilter::OBSTACLE;
        }
    }
    Ok(CollisionModel::new(topology, states.body.clone(), filters, states.half_spaces.clone())?)
}
