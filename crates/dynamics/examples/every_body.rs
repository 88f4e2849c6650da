//! Every kind of body for a second: a jelly cube held at its top, a flag of woven cloth in the wind, hair,
//! and grains that springs keep above a plane. It prints energies by kind. There are no other contacts.
//!
//! ```text
//! cargo run --release -p bowknot-dynamics --example every_body
//! ```

#![allow(clippy::print_stdout, reason = "an example reports what it did")]

#[path = "../tests/suite/common/block.rs"]
mod block;
#[path = "../tests/suite/common/sheet.rs"]
mod sheet;
#[path = "../tests/suite/common/strands.rs"]
mod strands;

use bowknot_dynamics::{
    Body, ClothMaterial, Dynamics, DynamicsModel, DynamicsParams, Environment, ParticleMaterial,
    RepulsionSpring, SolidMaterial, SpringKind, StrandMaterial,
};
use bowknot_geometry::{Point, Vector};
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    let mut rest: Vec<Point> = Vec::new();
    let mut append = |positions: Vec<Point>, shift: Vector| {
        let first = rest.len() as u32;
        rest.extend(positions.iter().map(|p| p + shift));
        first
    };
    // Cotton that shears easily, its warp along x.
    let (positions, triangles) = sheet::sheet(0.6, 0.4, 24, 16);
    let flag = append(positions, Vector::new(1.0, 0.0, 1.0));
    let cotton =
        ClothMaterial { weft_stiffness: Some(180.0), shear_stiffness: Some(8.0), ..ClothMaterial::cotton() };
    let (positions, tets) = block::block([0.1, 0.1, 0.2], [4, 4, 8]);
    let cube = append(positions, Vector::new(0.0, 0.0, 1.0));
    let (positions, edges) = strands::strands(50, 30, 0.3, 0.005);
    let hair = append(positions, Vector::new(-0.5, 0.0, 1.0));
    let grains =
        append((0..100).map(|k| Point::new(0.01 * f64::from(k), -0.5, 0.5)).collect(), Vector::zeros());
    let bodies = vec![
        Body::cloth("flag", triangles.iter().map(|t| t.map(|v| v + flag)).collect(), cotton),
        Body::solid("cube", tets.iter().map(|t| t.map(|v| v + cube)).collect(), SolidMaterial::jelly()),
        Body::strands("hair", edges.iter().map(|e| e.map(|v| v + hair)).collect(), StrandMaterial::hair()),
        Body::particles("sand", (grains..grains + 100).collect(), ParticleMaterial::sand()),
    ];
    let model = DynamicsModel::new(rest.clone(), bodies)?;
    let environment =
        Environment { air_density: 1.2, wind: Vector::new(4.0, 0.5, 0.0), ..Environment::default() };
    let mut dynamics = Dynamics::new(model, DynamicsParams { environment, ..DynamicsParams::default() })?;

    let held: Vec<bool> = (0..rest.len() as u32)
        .map(|v| {
            let p = rest[v as usize];
            let root = v >= hair && v < grains && (v - hair) % 30 < 2;
            root || (v < cube && p.x < 1.0 + 1e-9) || (v >= cube && v < hair && p.z > 1.2 - 1e-9)
        })
        .collect();
    // Grains stay above the plane z = 0: springs push below a gap of 1 mm.
    let on_plane = |v: u32, x: &[Point]| RepulsionSpring {
        kind: SpringKind::Contact,
        vertices: [v, 0, 0, 0],
        weights: [1.0, 0.0, 0.0, 0.0],
        normal: Vector::z(),
        offset: 0.0,
        reach: 1e-3,
        floor: 0.0,
        start_gap: x[v as usize].z,
        stiffness: 10.0,
        friction: 0.3,
        friction_ratio: Vector::zeros(),
    };

    let (mut x, mut v) = (rest.clone(), vec![Vector::zeros(); rest.len()]);
    println!(
        "time s, membrane, bending, solid, strand stretching, strand bending [mJ], volume [l], iterations"
    );
    for step in 1..=100 {
        let springs: Vec<RepulsionSpring> = (grains..grains + 100).map(|v| on_plane(v, &x)).collect();
        dynamics.set_repulsion(&springs)?;
        let infos = dynamics.solve_step(&mut x, &mut v, 0.01, &held, &rest, 2)?;
        if step % 20 == 0 {
            let e = dynamics.model().elastic_energies(&x);
            let parts = [e.membrane, e.bending, e.solid, e.strand_stretching, e.strand_bending];
            let parts: Vec<String> = parts.iter().map(|joule| format!("{:.1e}", joule * 1e3)).collect();
            let iterations: Vec<usize> = infos.iter().map(|info| info.cg.iterations).collect();
            let volume = dynamics.model().volume(&x) * 1e3;
            println!("{:.1}, {}, {volume:.3}, {iterations:?}", step as f64 * 0.01, parts.join(", "));
        }
    }
    println!("inverted tets: {}", dynamics.model().inverted_tets(&x).len());
    Ok(())
}
