//! A tetrahedron, written and read back without archives.
#![allow(clippy::print_stdout, reason = "a command")]

use bowknot_io::geometry::Point;
use bowknot_io::{Import, MeshView, read_mesh, write_ply};
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::temp_dir().join(format!("consumer-io-{}.ply", std::process::id()));
    let positions = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(Point::from);
    let triangles = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
    write_ply(&path, &MeshView { positions: &positions, triangles: &triangles, ..MeshView::default() })?;
    let mesh = read_mesh(&path, &Import::default())?;
    std::fs::remove_file(&path)?;
    println!("{} vertices, {} triangles", mesh.positions.len(), mesh.triangles.len());
    assert_eq!((mesh.positions.as_slice(), mesh.triangles.as_slice()), (&positions[..], &triangles[..]));
    Ok(())
}

#[test]
fn runs() {
    main().unwrap();
}
