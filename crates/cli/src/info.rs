//! `bowknot info`: counts, size and structure of a scene or a mesh.

use crate::args::InfoOptions;
use crate::exit::{Exit, Failure};
use crate::{archive, bare_mesh, gpu, near_starts, output};
use bowknot::geometry::{MeshEdge, MeshProblem, MeshStructure, Point, check_mesh};
use bowknot::io::Mesh;
use bowknot::simulator::NearStart;
use bowknot::{Scene, SceneInfo, SimulationError, Simulator, World};
use bowknot_errors::counted;
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// Counts and size of a scene or a mesh. The extent of a mesh is in the unit of its file unless that is
/// given.
#[derive(Debug, Serialize)]
struct Info {
    vertices: usize,
    edges: usize,
    triangles: usize,
    tets: usize,
    quadratic_tets: usize,
    strand_edges: usize,
    particles: usize,
    obstacle_vertices: usize,
    /// A mesh has none.
    time_step: Option<f64>,
    extent: [f64; 3],
    /// Of a scene alone: only there contact distances are known.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    near_starts: Vec<NearStart>,
    #[serde(skip)]
    has_unit: bool,
    /// Number of vertices of each group of a mesh.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    groups: BTreeMap<String, usize>,
    /// A scene has none.
    #[serde(flatten)]
    surface: Option<Surface>,
}

/// How the triangles of a mesh hang together, and what is wrong with it.
#[derive(Debug, Serialize)]
struct Surface {
    #[serde(flatten)]
    structure: MeshStructure,
    /// Why `run` refuses the mesh as a body, in words.
    problems: Vec<String>,
}

pub fn info(options: &InfoOptions) -> Result<Exit, Failure> {
    let Some(name) = options.scene.as_deref().filter(|_| !options.gpus) else {
        output::print(&gpu::list()?)?;
        return Ok(Exit::Success);
    };
    let info = if bare_mesh::is_mesh(name) {
        info_of_file(name, &bare_mesh::assignments(options.up, options.scale))?
    } else if Path::new(name).extension().is_some_and(|ending| ending.eq_ignore_ascii_case("npz")) {
        let mesh = archive::read(Path::new(name))?.frame_mesh(0);
        let problems = problems(&mesh);
        Info { has_unit: true, ..info_of_mesh(mesh, problems) }
    } else if options.up.is_some() || options.scale.is_some() {
        return Err(Failure::input("--up and --scale apply to meshes"));
    } else {
        let sets: [&str; 0] = [];
        info_of_scene(&Scene::open(name, None, &sets).map_err(Failure::input)?)?
    };
    if options.json {
        output::print_json(&info)?;
    } else {
        output::print(&to_text(name, &info, options.list))?;
    }
    Ok(Exit::Success)
}

fn info_of_scene(scene: &Scene) -> Result<Info, Failure> {
    let (info, near_starts) = match Simulator::new(scene) {
        Ok(simulator) => (simulator.world().info(scene.simulation.dt), simulator.near_starts()),
        // `run` and `check` say what is wrong with the start.
        Err(SimulationError::StartIntersects { .. }) => (scene.info().map_err(Failure::input)?, Vec::new()),
        Err(error) => return Err(Failure::input(error)),
    };
    Ok(of_counts(info, near_starts))
}

fn of_counts(info: SceneInfo, near_starts: Vec<NearStart>) -> Info {
    Info {
        vertices: info.vertices,
        edges: info.edges,
        triangles: info.triangles,
        tets: info.tets,
        quadratic_tets: info.quadratic_tets,
        strand_edges: info.strand_edges,
        particles: info.particles,
        obstacle_vertices: info.obstacle_vertices,
        time_step: Some(info.time_step),
        extent: info.extent,
        near_starts,
        has_unit: true,
        groups: BTreeMap::new(),
        surface: None,
    }
}

/// Counts of a mesh file, and what keeps it from being simulated.
fn info_of_file(name: &str, import: &[String]) -> Result<Info, Failure> {
    let scene = bare_mesh::scene(name, import)?;
    let body = &scene.bodies[0];
    let mut mesh = bare_mesh::read(Path::new(name), body)?;
    let faults = mesh.triangulate().describe();
    let mut problems = problems(&mesh);
    // What only the assembly finds, such as inverted tetrahedra. A frame with obstacles is no body.
    if problems.is_empty() && mesh.obstacle.is_none() {
        // Without the ball and the ground, which nobody asked for here.
        let alone = Scene { obstacles: Vec::new(), ..scene };
        problems.extend(World::new(&alone).err().map(|error| error.to_string()));
    } else if let Some(faults) = faults {
        // The assembly tells them otherwise.
        eprintln!("warning: {name}: {faults}");
    }
    let has_unit = import.iter().any(|set| set.starts_with("body.0.scale="));
    Ok(Info { has_unit, ..info_of_mesh(mesh, problems) })
}

/// Counts of a mesh with the surface of its tetrahedra. In a frame, elements with an obstacle vertex are not
/// counted.
fn info_of_mesh(mesh: Mesh, problems: Vec<String>) -> Info {
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
    Info {
        vertices: mesh.positions.len() - obstacle_vertices,
        edges: edges.len(),
        triangles: triangles.len(),
        tets,
        quadratic_tets: 0,
        strand_edges: strands.len(),
        particles: mesh.particles.iter().filter(|v| !obstacle(v)).count(),
        obstacle_vertices,
        time_step: None,
        extent: extent(&mesh.positions),
        near_starts: Vec::new(),
        has_unit: false,
        groups: mesh.groups.iter().map(|(name, vertices)| (name.to_owned(), vertices.len())).collect(),
        surface: Some(Surface { structure: MeshStructure::new(&mesh.positions, &mesh.triangles), problems }),
    }
}

/// Triangles that no deformable body may have, in words.
fn problems(mesh: &Mesh) -> Vec<String> {
    check_mesh(&mesh.positions, &mesh.triangles)
        .iter()
        .filter(|problem| !matches!(problem, MeshProblem::UnreferencedVertex { .. }))
        .map(ToString::to_string)
        .collect()
}

/// Size of the bounding box [m].
fn extent(positions: &[Point]) -> [f64; 3] {
    let (low, high) = bare_mesh::extent(positions);
    (high - low).into()
}

fn to_text(name: &str, info: &Info, list: usize) -> String {
    let mut lines = vec![format!("{name}:")];
    let mut line = |what: &str, value: String| lines.push(format!("  {what:<18} {value}"));
    let counts = [
        ("vertices", info.vertices),
        ("edges", info.edges),
        ("triangles", info.triangles),
        ("tetrahedra", info.tets),
        ("quadratic tets", info.quadratic_tets),
        ("strand edges", info.strand_edges),
        ("particles", info.particles),
        ("obstacle vertices", info.obstacle_vertices),
    ];
    // Counts of zero are left out, except that of the vertices.
    for (what, count) in counts.into_iter().filter(|(what, count)| *count > 0 || *what == "vertices") {
        line(what, count.to_string());
    }
    if let Some(dt) = info.time_step {
        line("time step", format!("{dt} s"));
    }
    let [x, y, z] = info.extent;
    // Nothing tells the unit of a mesh file.
    let unit = if info.has_unit { "m" } else { "(units of the file)" };
    line("extent", format!("{x:.4} x {y:.4} x {z:.4} {unit}"));
    lines.extend(near_starts::line(&info.near_starts).map(|text| format!("  {text}")));
    let groups =
        info.groups.iter().map(|(name, &count)| format!("{name}: {}", counted(count, "vertex", "vertices")));
    lines.extend(section("groups", &groups.collect::<Vec<_>>(), list));
    if let Some(surface) = &info.surface {
        lines.extend(surface_lines(surface, list));
    }
    lines.join("\n")
}

/// Parts, borders, odd edges and problems: how many there are, and the first `list` of each.
fn surface_lines(surface: &Surface, list: usize) -> Vec<String> {
    let MeshStructure { parts, borders, branching_edges, flipped_edges } = &surface.structure;
    let part = |part: &bowknot::geometry::MeshPart| {
        let [low, high] = part.bounds;
        format!(
            "vertex {} and {} more, {} triangles, from {} to {}",
            part.vertex,
            part.vertices - 1,
            part.triangles,
            place(&low),
            place(&high)
        )
    };
    let border = |border: &bowknot::geometry::MeshBorder| {
        format!("{} edges, from vertex {} at {}", border.edges, border.vertex, place(&border.place))
    };
    let sections: [(&str, Vec<String>); 5] = [
        ("connected parts", parts.iter().map(part).collect()),
        ("borders", borders.iter().map(border).collect()),
        ("edges of three or more triangles", branching_edges.iter().map(edge).collect()),
        ("edges whose triangles face opposite ways", flipped_edges.iter().map(edge).collect()),
        ("problems, for which `run` refuses the mesh as a body", surface.problems.clone()),
    ];
    sections.iter().flat_map(|(what, entries)| section(what, entries, list)).collect()
}

/// How many entries there are, and the first `list` of them; nothing if there are none.
fn section(what: &str, entries: &[String], list: usize) -> Vec<String> {
    if entries.is_empty() {
        return Vec::new();
    }
    let mut lines = vec![format!("  {what:<18} {}", entries.len())];
    lines.extend(entries.iter().take(list).map(|entry| format!("    {entry}")));
    if entries.len() > list {
        lines.push(format!("    and {} more", entries.len() - list));
    }
    lines
}

fn edge(edge: &MeshEdge) -> String {
    let ([a, b], triangles) = (edge.vertices, &edge.triangles);
    let triangles: Vec<String> = triangles.iter().map(ToString::to_string).collect();
    format!("vertices {a}, {b}, triangles {}, at {}", triangles.join(", "), place(&edge.place))
}

fn place(p: &Point) -> String {
    format!("({:.4}, {:.4}, {:.4})", p.x, p.y, p.z)
}
