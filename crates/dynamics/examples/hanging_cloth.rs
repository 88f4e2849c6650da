//! A square of cotton, held at two corners, swings down; no contact.
//!
//! ```text
//! cargo run --release -p bowknot-dynamics --example hanging_cloth
//! ```
#![allow(clippy::print_stdout, reason = "an example reports what it did")]

#[path = "../tests/suite/common/cloth.rs"]
mod cloth;
#[path = "../tests/suite/common/sheet.rs"]
mod sheet;

use bowknot_dynamics::{ClothMaterial, Dynamics, DynamicsParams};
use bowknot_geometry::Vector;
use cloth::cloth_model;
use sheet::sheet;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let cells = 40;
    let (rest, triangles) = sheet(1.0, 1.0, cells, cells);
    let model = cloth_model(&rest, triangles, ClothMaterial::cotton());
    let mut dynamics = Dynamics::new(model, DynamicsParams::default())?;

    // Two corners of one side are held.
    let mut prescribed = vec![false; rest.len()];
    (prescribed[0], prescribed[cells]) = (true, true);
    let (mut x, mut v) = (rest.clone(), vec![Vector::zeros(); rest.len()]);
    println!("time [s]   lowest point [m]   stretch   energy [J]   Newton steps kept   CG iterations");
    for frame in 1..=60 {
        let infos = dynamics.solve_step(&mut x, &mut v, 1.0 / 60.0, &prescribed, &rest, 3)?;
        if frame % 6 == 0 {
            let lowest = x.iter().map(|p| p.z).fold(f64::INFINITY, f64::min);
            println!(
                "{:8.2}   {:16.3}   {:7.4}   {:10.5}   {:17?}   {:?}",
                frame as f64 / 60.0,
                lowest,
                dynamics.max_stretch(&x),
                dynamics.energies(&x, &v).total(),
                infos.iter().map(|i| i.step_length).collect::<Vec<_>>(),
                infos.iter().map(|i| i.cg.iterations).collect::<Vec<_>>(),
            );
        }
    }
    Ok(())
}
