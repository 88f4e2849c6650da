//! Writes the meshes of `assets/meshes`: a character with fingers, a shirt of separate panels, a duck of
//! tetrahedra.
//!
//! ```text
//! cargo run --release -p bowknot-scene --example meshes -- assets/meshes
//! ```
//!
//! All three are made from round cones. Coordinates are rounded to micrometers.
#![allow(clippy::print_stdout, reason = "an example reports what it did")]

mod character;
mod duck;
mod parts;
mod remesh;
mod shirt;
mod shirt_surface;

use bowknot_scene::geometry::Point;
use bowknot_scene::io::{MeshView, write_obj, write_ply, write_text};
use std::error::Error;
use std::fmt::Write;
use std::path::Path;

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args().nth(1).unwrap_or_else(|| "assets/meshes".to_owned());
    let folder = Path::new(&folder);

    let character = character::surface();
    let positions = rounded(&character.positions, 1e6);
    let view = MeshView { positions: &positions, triangles: &character.triangles, ..MeshView::default() };
    write_ply(&folder.join("character.ply"), &view)?;
    println!("character: {} vertices, {} triangles", positions.len(), character.triangles.len());

    let shirt = shirt::panels();
    // As pattern tools write it: y up, in millimeters, rounded to micrometers.
    let y_up: Vec<Point> = shirt.positions.iter().map(|p| Point::new(p.x, p.z, -p.y) * 1e3).collect();
    let positions = rounded(&y_up, 1e3);
    let surface = shirt_surface::of_panels(&shirt, folder);
    let view = MeshView {
        positions: &positions,
        triangles: &shirt.triangles,
        surface: Some(&surface),
        ..MeshView::default()
    };
    write_obj(&folder.join("shirt.obj"), &view)?;
    write_text(&folder.join(shirt_surface::LIBRARY), shirt_surface::MATERIALS)?;
    println!("shirt: {} vertices, {} triangles", positions.len(), shirt.triangles.len());

    let duck = duck::tetrahedra();
    let positions = rounded(&duck.positions, 1e6);
    write_text(&folder.join("duck.msh"), &gmsh(&positions, &duck.tets)?)?;
    println!("duck: {} vertices, {} tetrahedra", positions.len(), duck.tets.len());
    Ok(())
}

/// Coordinates as multiples of 1 / `per_unit`.
fn rounded(positions: &[Point], per_unit: f64) -> Vec<Point> {
    // Adding 0 turns -0 into 0.
    positions.iter().map(|p| p.map(|c| (c * per_unit).round() / per_unit + 0.0)).collect()
}

/// Gmsh 2.2, text.
fn gmsh(positions: &[Point], tets: &[[u32; 4]]) -> Result<String, std::fmt::Error> {
    let mut text = String::from("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n");
    writeln!(text, "{}", positions.len())?;
    for (n, p) in positions.iter().enumerate() {
        writeln!(text, "{} {} {} {}", n + 1, p.x, p.y, p.z)?;
    }
    writeln!(text, "$EndNodes\n$Elements\n{}", tets.len())?;
    for (n, [a, b, c, d]) in tets.iter().enumerate() {
        // Type 4 is a tetrahedron; it has no tags.
        writeln!(text, "{} 4 0 {} {} {} {}", n + 1, a + 1, b + 1, c + 1, d + 1)?;
    }
    text.push_str("$EndElements\n");
    Ok(text)
}
