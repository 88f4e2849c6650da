//! `bowknot info`: counts and size of a scene or a mesh.

use crate::args::InfoOptions;
use crate::exit::{Exit, Failure};
use crate::{bare_mesh, output, setup};
use bowknot::io::{Import, Mesh, read_mesh};
use bowknot::{Scene, SceneInfo};
use serde::Serialize;
use std::collections::BTreeSet;
use std::path::Path;

/// Counts and size of a scene or a mesh; a mesh has no time step.
#[derive(Debug, Serialize)]
struct Info {
    vertices: usize,
    edges: usize,
    triangles: usize,
    tets: usize,
    strand_edges: usize,
    particles: usize,
    obstacle_vertices: usize,
    time_step: Option<f64>,
    extent: [f64; 3],
}

pub fn info(options: &InfoOptions) -> Result<Exit, Failure> {
    let Some(name) = options.scene.as_deref().filter(|_| !options.gpus) else {
        return Err(setup::no_gpu());
    };
    let info = if bare_mesh::is_mesh(name) {
        info_of_mesh(read_mesh(Path::new(name), &Import::default())?)
    } else {
        let sets: [&str; 0] = [];
        info_of_scene(Scene::open(name, None, &sets).and_then(|scene| scene.info()).map_err(Failure::input)?)
    };
    if options.json {
        output::print_json(&info)?;
    } else {
        output::print(&to_text(name, &info))?;
    }
    Ok(Exit::Success)
}

fn info_of_scene(info: SceneInfo) -> Info {
    Info {
        vertices: info.vertices,
        edges: info.edges,
        triangles: info.triangles,
        tets: info.tets,
        strand_edges: info.strand_edges,
        particles: info.particles,
        obstacle_vertices: info.obstacle_vertices,
        time_step: Some(info.time_step),
        extent: info.extent,
    }
}

/// Counts of a mesh as its file holds it, with the surface of its tetrahedra. In a frame, elements with an
/// obstacle vertex are not counted.
fn info_of_mesh(mesh: Mesh) -> Info {
    let tets = mesh.tets.len();
    let mesh = mesh.into_surface();
    let obstacle = |v: &u32| mesh.obstacle.as_ref().is_some_and(|o| o[*v as usize]);
    let deformable = |vertices: &[u32]| !vertices.iter().any(obstacle);
    let triangles: Vec<&[u32; 3]> = mesh.triangles.iter().filter(|t| deformable(*t)).collect();
    let strands: BTreeSet<[u32; 2]> =
        mesh.strands.iter().filter(|e| deformable(*e)).map(|&[i, j]| [i.min(j), i.max(j)]).collect();
    let mut edges = strands.clone();
    edges.extend(
        triangles.iter().flat_map(|&&[i, j, k]| [[i, j], [j, k], [k, i]]).map(|[i, j]| [i.min(j), i.max(j)]),
    );
    let obstacle_vertices = (0..mesh.positions.len() as u32).filter(obstacle).count();
    let mut extent = [0.0; 3];
    for (k, length) in extent.iter_mut().enumerate() {
        let low = mesh.positions.iter().map(|p| p[k]).fold(f64::INFINITY, f64::min);
        let high = mesh.positions.iter().map(|p| p[k]).fold(f64::NEG_INFINITY, f64::max);
        *length = high - low;
    }
    Info {
        vertices: mesh.positions.len() - obstacle_vertices,
        edges: edges.len(),
        triangles: triangles.len(),
        tets,
        strand_edges: strands.len(),
        particles: mesh.particles.iter().filter(|v| !obstacle(v)).count(),
        obstacle_vertices,
        time_step: None,
        extent,
    }
}

fn to_text(name: &str, info: &Info) -> String {
    let mut lines = vec![format!("{name}:")];
    let counts = [
        ("vertices", info.vertices),
        ("edges", info.edges),
        ("triangles", info.triangles),
        ("tetrahedra", info.tets),
        ("strand edges", info.strand_edges),
        ("particles", info.particles),
        ("obstacle vertices", info.obstacle_vertices),
    ];
    // Counts of zero are left out, except that of the vertices.
    let shown = counts.iter().filter(|(what, count)| *count > 0 || *what == "vertices");
    lines.extend(shown.map(|(what, count)| format!("  {what:<18} {count}")));
    if let Some(dt) = info.time_step {
        lines.push(format!("  {:<18} {dt} s", "time step"));
    }
    let [x, y, z] = info.extent;
    lines.push(format!("  {:<18} {x:.4} x {y:.4} x {z:.4} m", "extent"));
    lines.join("\n")
}
