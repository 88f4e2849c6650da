//! Meshes for Bowknot's scene files, and frames as `bowknot check` reads them.

use crate::meshes::{Mesh, Point};
use crate::scenes::{Obstacle, Scene};
use std::fmt::Write as _;
use std::fs;
use std::io;
use std::path::Path;

/// Writes each body as `NAME.obj` or, with tetrahedra, `NAME.msh`, and balls as `ball.obj`.
pub fn write_meshes(scene: &Scene, folder: &Path) -> io::Result<()> {
    for body in &scene.bodies {
        if body.mesh.tets.is_empty() {
            fs::write(folder.join(format!("{}.obj", body.name)), obj(&body.mesh))?;
        } else {
            fs::write(folder.join(format!("{}.msh", body.name)), msh(&body.mesh))?;
        }
    }
    for obstacle in &scene.obstacles {
        if let Obstacle::Ball(_, _, mesh) = obstacle {
            fs::write(folder.join("ball.obj"), obj(mesh))?;
        }
    }
    Ok(())
}

fn obj(mesh: &Mesh) -> String {
    let mut text = String::new();
    for [x, y, z] in &mesh.points {
        let _ = writeln!(text, "v {x} {y} {z}");
    }
    for triangle in &mesh.triangles {
        let [a, b, c] = triangle.map(|i| i + 1);
        let _ = writeln!(text, "f {a} {b} {c}");
    }
    text
}

/// Gmsh's format 2.2.
fn msh(mesh: &Mesh) -> String {
    let mut text = format!("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{}\n", mesh.points.len());
    for (i, [x, y, z]) in mesh.points.iter().enumerate() {
        let _ = writeln!(text, "{} {x} {y} {z}", i + 1);
    }
    let _ = writeln!(text, "$EndNodes\n$Elements\n{}", mesh.tets.len());
    for (i, tet) in mesh.tets.iter().enumerate() {
        let [a, b, c, d] = tet.map(|i| i + 1);
        let _ = writeln!(text, "{} 4 0 {a} {b} {c} {d}", i + 1);
    }
    text + "$EndElements\n"
}

/// The surfaces of all bodies, then the obstacles with a mesh, as Bowknot writes frames.
pub struct Frames<'a> {
    header: Vec<u8>,
    faces: Vec<u8>,
    outside: Vec<Vec<u32>>,
    balls: Vec<&'a Mesh>,
}

impl<'a> Frames<'a> {
    pub fn new(scene: &'a Scene) -> Self {
        let balls = scene.obstacles.iter().filter_map(|obstacle| match obstacle {
            Obstacle::Ball(_, _, mesh) => Some(mesh),
            Obstacle::Plane(_) => None,
        });
        let (balls, mut first) = (balls.collect::<Vec<_>>(), 0);
        let (mut outside, mut faces, mut count) = (Vec::new(), Vec::new(), 0);
        for mesh in scene.bodies.iter().map(|body| &body.mesh).chain(balls.iter().copied()) {
            let used = mesh.outside();
            for triangle in &mesh.triangles {
                faces.push(3);
                for vertex in triangle {
                    let place = first + used.partition_point(|i| i < vertex);
                    faces.extend((place as u32).to_le_bytes());
                }
            }
            count += mesh.triangles.len();
            first += used.len();
            outside.push(used);
        }
        outside.truncate(scene.bodies.len());
        let mut header = String::from("ply\nformat binary_little_endian 1.0\n");
        let names = scene.bodies.iter().map(|body| body.name.as_str()).chain(["ball"]);
        for (k, name) in names.take(scene.bodies.len() + balls.len()).enumerate() {
            let _ = writeln!(header, "comment body {k} {name}");
        }
        let _ = writeln!(
            header,
            "element vertex {first}\nproperty double x\nproperty double y\nproperty double z\nproperty uchar obstacle\n\
             property int body\nelement face {count}\nproperty list uchar int vertex_indices\nend_header"
        );
        Self { header: header.into_bytes(), faces, outside, balls }
    }

    /// Number of vertices that move, and that of all triangles.
    pub fn sizes(&self) -> (usize, usize) {
        (self.outside.iter().map(Vec::len).sum(), self.faces.len() / 13)
    }

    /// Writes one frame from the positions of all particles, body by body.
    pub fn write(&self, bodies: &[Vec<Point>], path: &Path) -> io::Result<()> {
        let mut bytes = self.header.clone();
        let mut vertex = |point: Point, obstacle: u8, body: usize| {
            point.iter().for_each(|x| bytes.extend(x.to_le_bytes()));
            bytes.push(obstacle);
            bytes.extend((body as i32).to_le_bytes());
        };
        for (k, (points, outside)) in bodies.iter().zip(&self.outside).enumerate() {
            outside.iter().for_each(|&i| vertex(points[i as usize], 0, k));
        }
        for (k, ball) in self.balls.iter().enumerate() {
            ball.points.iter().for_each(|&point| vertex(point, 1, bodies.len() + k));
        }
        bytes.extend(&self.faces);
        fs::write(path, bytes)
    }
}
