//! A scene's meshes, loaded and put together: deformable vertices first, then obstacles.

mod follow;
mod motion;

pub(crate) use follow::Attachment;
pub use motion::{ObstacleMotion, Placing, Procedural, Sequence};

use crate::io::{self, Import};
use crate::scene::{BodyKind, Material, Motion, ObstacleSpec, PinSpec, Scene, SceneError};
use crate::shapes::Shape;
use bowknot_dynamics::{Body, DynamicsModel};
use bowknot_geometry::{HalfSpace, MeshProblem, Point, Topology, Vector, check_mesh};
use bowknot_proximity::{BodyFilter, CollisionModel};
use rayon::prelude::*;
use serde::Serialize;
use std::ops::Range;
use std::path::Path;

/// A scene's bodies over one array of vertices.
#[derive(Clone, Debug)]
pub struct World {
    /// Deformable bodies, then obstacles with a mesh, each in the scene's order.
    pub bodies: Vec<WorldBody>,
    /// Names of the half-spaces, in the order of [`CollisionModel::half_spaces`].
    pub half_space_names: Vec<String>,
    /// Number of deformable vertices; those of obstacles follow.
    pub deformable_vertices: usize,
    /// Positions at time 0 [m].
    pub positions: Vec<Point>,
    /// Velocities at time 0 [m/s].
    pub velocities: Vec<Vector>,
    /// Topology, bodies, filters, half-spaces.
    pub collision: CollisionModel,
    /// The bodies for the dynamics, in the order of `bodies`.
    pub materials: Vec<Body>,
    /// Held or led vertices.
    pub pins: Vec<Pin>,
    /// What was repaired or left out on the way, in words.
    pub warnings: Vec<String>,
    /// Positions of obstacle vertices without their motion [m]; of deformable ones, those at time 0.
    pub(crate) base: Vec<Point>,
}

/// A body of a [`World`].
#[derive(Clone, Debug)]
pub struct WorldBody {
    /// Its name.
    pub name: String,
    /// What it is made of; `None` for an obstacle.
    pub kind: Option<BodyKind>,
    /// Its vertices.
    pub vertices: Range<u32>,
    /// How it moves, if it is an obstacle.
    pub motion: ObstacleMotion,
}

/// Held or led vertices of a body.
#[derive(Clone, Debug)]
pub struct Pin {
    /// The vertices, ascending.
    pub vertices: Vec<u32>,
    /// How they move.
    pub motion: Option<Motion>,
    /// The body, an obstacle, whose surface they follow; then there is no motion.
    pub follow: Option<u32>,
    /// When the pin takes hold [s].
    pub start: f64,
    /// When it lets go [s].
    pub end: f64,
}

/// Counts of a scene, as `bowknot info --json` prints them.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SceneInfo {
    /// Deformable vertices.
    pub vertices: usize,
    /// Edges of deformable bodies.
    pub edges: usize,
    /// Triangles of deformable bodies.
    pub triangles: usize,
    /// Tetrahedra.
    pub tets: usize,
    /// Strand edges of deformable bodies.
    pub strand_edges: usize,
    /// Deformable particles.
    pub particles: usize,
    /// Vertices of obstacles.
    pub obstacle_vertices: usize,
    /// Time step [s].
    pub time_step: f64,
    /// Size of the bounding box of all vertices at time 0 [m].
    pub extent: [f64; 3],
}

impl Scene {
    /// Loads the meshes and counts.
    ///
    /// # Errors
    /// As [`World::new`].
    pub fn info(&self) -> Result<SceneInfo, SceneError> {
        Ok(World::new(self)?.info(self.simulation.dt))
    }
}

/// A mesh on its way into the world.
#[derive(Default)]
struct Part {
    positions: Vec<Point>,
    triangles: Vec<[u32; 3]>,
    strands: Vec<[u32; 2]>,
    particles: Vec<u32>,
    /// Vertices of the file that were dropped because nothing used them, ascending.
    dropped: Vec<u32>,
}

impl World {
    /// Loads and places the meshes of a scene.
    ///
    /// # Errors
    /// What [`Scene::validate`] refuses; meshes that are missing or malformed; triangles of a deformable
    /// body without area or repeated; pins without vertices.
    pub fn new(scene: &Scene) -> Result<Self, SceneError> {
        scene.validate()?;
        let mut assembly = Assembly::default();
        for body in &scene.bodies {
            let owner = format!("body {}", body.name);
            let import = Import { up: body.up, scale: body.scale };
            let mut part = load(&scene.folder, body.mesh.as_deref(), body.shape.as_ref(), &import, &owner)?;
            match body.kind {
                BodyKind::Cloth => clean_cloth(&mut part, &body.name, &mut assembly.warnings)?,
            }
            let placing = Placing { import, rotate: body.rotate, translate: body.translate };
            placing.place(&mut part.positions);
            let Material::Cloth(material) = body.material;
            assembly.drops.push(part.dropped.clone());
            let filter = filter(&body.groups, body.collides_with.as_deref(), false, body.self_collision);
            let (vertices, triangles) = assembly.append(part, filter);
            assembly.velocities.resize(vertices.end as usize, body.velocity);
            assembly.models.push(Body::cloth(&*body.name, triangles, material));
            let name = body.name.clone();
            assembly.bodies.push(WorldBody {
                name,
                kind: Some(body.kind),
                vertices,
                motion: ObstacleMotion::Rest,
            });
        }
        let deformable_vertices = assembly.base.len();
        assembly.positions.clone_from(&assembly.base);
        for obstacle in &scene.obstacles {
            let import = Import { up: obstacle.up, scale: obstacle.scale };
            let placing = Placing { import, rotate: obstacle.rotate, translate: obstacle.translate };
            if let Some(Shape::HalfSpace(shape)) = &obstacle.shape {
                let normal = placing.rotation() * shape.normal;
                // Validation has refused a normal of no length.
                assembly.half_spaces.extend(HalfSpace::new(Point::from(obstacle.translate), normal));
                assembly.half_space_names.push(obstacle.name.clone());
                continue;
            }
            let owner = format!("obstacle {}", obstacle.name);
            let (mesh, shape) = (obstacle.mesh.as_deref(), obstacle.shape.as_ref());
            let mut part = load(&scene.folder, mesh, shape, &import, &owner)?;
            clean_obstacle(&mut part, &owner, &mut assembly.warnings)?;
            placing.place(&mut part.positions);
            let filter = filter(&obstacle.groups, obstacle.collides_with.as_deref(), true, false);
            let motion = obstacle_motion(obstacle, placing);
            let mut start = part.positions.clone();
            motion.positions(&part.positions, 0.0, &mut start);
            assembly.positions.extend(start);
            let (vertices, _) = assembly.append(part, filter);
            assembly.velocities.resize(vertices.end as usize, Vector::zeros());
            assembly.models.push(Body::obstacle(&*obstacle.name, vertices.clone().collect()));
            let name = obstacle.name.clone();
            assembly.bodies.push(WorldBody { name, kind: None, vertices, motion });
        }
        let pins = pins(scene, &assembly)?;
        assembly.finish(deformable_vertices, pins)
    }

    /// Counts.
    pub fn info(&self, time_step: f64) -> SceneInfo {
        let topology = self.collision.topology();
        let deformable = |v: u32| (v as usize) < self.deformable_vertices;
        let (low, high) = self.bounds();
        SceneInfo {
            vertices: self.deformable_vertices,
            edges: topology.edges.iter().filter(|e| deformable(e[0])).count(),
            triangles: topology.triangles.iter().filter(|t| deformable(t[0])).count(),
            tets: 0,
            strand_edges: topology
                .strand_edges
                .iter()
                .filter(|&&e| deformable(topology.edges[e as usize][0]))
                .count(),
            particles: topology.particles.iter().filter(|&&v| deformable(v)).count(),
            obstacle_vertices: self.positions.len() - self.deformable_vertices,
            time_step,
            extent: (high - low).into(),
        }
    }

    /// Corners of the bounding box of all vertices at time 0 [m].
    pub fn bounds(&self) -> (Point, Point) {
        bounds(&self.positions)
    }

    /// Masses and elements; their rest state is that at time 0.
    ///
    /// # Errors
    /// What the dynamics refuses, in words.
    pub fn dynamics_model(&self) -> Result<DynamicsModel, SceneError> {
        DynamicsModel::new(self.positions.clone(), self.materials.clone()).map_err(joined)
    }

    /// Ties the vertices of a pin that follows an obstacle, when they are at `homes`, to it: one entry
    /// a vertex, none where the obstacle has no triangle with an area.
    pub(crate) fn attach(&self, pin: &Pin, homes: &[Point]) -> Vec<Option<Attachment>> {
        let Some(body) = pin.follow.and_then(|body| self.bodies.get(body as usize)) else {
            return vec![None; homes.len()];
        };
        let range = body.vertices.start as usize..body.vertices.end as usize;
        let mut positions = self.positions.clone();
        body.motion.positions(&self.base[range.clone()], pin.start, &mut positions[range]);
        let triangles = &self.collision.topology().triangles;
        let own: Vec<[u32; 3]> =
            triangles.iter().filter(|t| body.vertices.contains(&t[0])).copied().collect();
        homes.par_iter().map(|x| Attachment::new(x, &own, &positions)).collect()
    }

    /// Name of the body of a vertex.
    pub fn body_name(&self, vertex: usize) -> &str {
        self.collision.vertex_body().get(vertex).map_or("", |&body| self.name_of(body))
    }

    /// Name of a body by index; half-spaces and bodies that do not exist have none.
    pub fn name_of(&self, body: u32) -> &str {
        self.bodies.get(body as usize).map_or("", |b| &b.name)
    }
}

fn joined<E: ToString>(errors: Vec<E>) -> SceneError {
    let lines: Vec<String> = errors.iter().take(10).map(ToString::to_string).collect();
    SceneError::Model(lines.join("\n"))
}

#[derive(Default)]
struct Assembly {
    bodies: Vec<WorldBody>,
    models: Vec<Body>,
    filters: Vec<BodyFilter>,
    base: Vec<Point>,
    positions: Vec<Point>,
    velocities: Vec<Vector>,
    vertex_body: Vec<u32>,
    triangles: Vec<[u32; 3]>,
    strands: Vec<[u32; 2]>,
    particles: Vec<u32>,
    half_spaces: Vec<HalfSpace>,
    half_space_names: Vec<String>,
    drops: Vec<Vec<u32>>,
    warnings: Vec<String>,
}

impl Assembly {
    /// Appends a part as the next body; its vertices, and its triangles in the world's numbering.
    fn append(&mut self, part: Part, filter: BodyFilter) -> (Range<u32>, Vec<[u32; 3]>) {
        let first = self.base.len() as u32;
        let triangles: Vec<[u32; 3]> = part.triangles.iter().map(|t| t.map(|v| v + first)).collect();
        self.triangles.extend_from_slice(&triangles);
        self.strands.extend(part.strands.iter().map(|e| e.map(|v| v + first)));
        self.particles.extend(part.particles.iter().map(|v| v + first));
        self.vertex_body.resize(self.base.len() + part.positions.len(), self.filters.len() as u32);
        self.base.extend(part.positions);
        self.filters.push(filter);
        (first..self.base.len() as u32, triangles)
    }

    fn finish(self, deformable_vertices: usize, pins: Vec<Pin>) -> Result<World, SceneError> {
        let topology =
            Topology::new(self.base.len(), self.triangles, &self.strands, &self.particles).map_err(joined)?;
        let collision = CollisionModel::new(topology, self.vertex_body, self.filters, self.half_spaces)
            .map_err(|error| SceneError::Model(error.to_string()))?;
        for warning in &self.warnings {
            tracing::warn!("{warning}");
        }
        Ok(World {
            bodies: self.bodies,
            half_space_names: self.half_space_names,
            deformable_vertices,
            positions: self.positions,
            velocities: self.velocities,
            collision,
            materials: self.models,
            pins,
            warnings: self.warnings,
            base: self.base,
        })
    }
}

fn load(
    folder: &Path,
    mesh: Option<&Path>,
    shape: Option<&Shape>,
    import: &Import,
    owner: &str,
) -> Result<Part, SceneError> {
    let mut part = match (mesh, shape.and_then(Shape::mesh)) {
        (Some(path), _) => {
            let mut mesh = io::read_mesh(&folder.join(path), import)?;
            let dropped = mesh.unused_vertices();
            mesh.drop_unused_vertices();
            Part {
                positions: mesh.positions,
                triangles: mesh.triangles,
                strands: mesh.strands,
                particles: mesh.particles,
                dropped,
            }
        }
        (None, Some(mesh)) => Part {
            positions: mesh.positions.iter().map(|p| import.point(p.coords.into())).collect(),
            triangles: mesh.triangles,
            ..Part::default()
        },
        (None, None) => Part::default(),
    };
    // Loose vertices of a PLY come as particles; where there are triangles they are leftovers.
    if !part.triangles.is_empty() && !part.particles.is_empty() {
        drop_particles(&mut part);
    }
    if part.triangles.is_empty() && part.strands.is_empty() {
        return Err(SceneError::Body {
            body: owner.to_owned(),
            message: "the mesh has no triangles".to_owned(),
        });
    }
    Ok(part)
}

fn drop_particles(part: &mut Part) {
    let mut mesh = io::Mesh {
        positions: std::mem::take(&mut part.positions),
        triangles: std::mem::take(&mut part.triangles),
        strands: std::mem::take(&mut part.strands),
        ..io::Mesh::default()
    };
    part.particles.clear();
    // The file's numbers of these vertices: those that were dropped before stand between them.
    let unused = mesh.unused_vertices();
    let mut numbers = Vec::with_capacity(unused.len());
    let mut before = 0;
    for v in unused {
        while part.dropped.get(before).is_some_and(|d| *d <= v + before as u32) {
            before += 1;
        }
        numbers.push(v + before as u32);
    }
    mesh.drop_unused_vertices();
    part.dropped.extend(numbers);
    part.dropped.sort_unstable();
    (part.positions, part.triangles, part.strands) = (mesh.positions, mesh.triangles, mesh.strands);
}

fn clean_cloth(part: &mut Part, name: &str, warnings: &mut Vec<String>) -> Result<(), SceneError> {
    if !part.strands.is_empty() {
        let count = part.strands.len();
        return Err(SceneError::Body {
            body: format!("body {name}"),
            message: format!("the mesh has {count} strand edges, but a cloth is made of triangles only"),
        });
    }
    let problems = check_mesh(&part.positions, &part.triangles);
    if !problems.is_empty() {
        return Err(SceneError::Mesh { body: name.to_owned(), problems });
    }
    if !part.dropped.is_empty() {
        warnings.push(format!(
            "body {name}: left out {} vertices that belong to no triangle, the first is vertex {}",
            part.dropped.len(),
            part.dropped[0]
        ));
    }
    Ok(())
}

fn clean_obstacle(part: &mut Part, owner: &str, warnings: &mut Vec<String>) -> Result<(), SceneError> {
    let problems = check_mesh(&part.positions, &part.triangles);
    let mut drop = vec![false; part.triangles.len()];
    let mut first = None;
    for problem in &problems {
        match problem {
            MeshProblem::ZeroArea { triangle, .. } | MeshProblem::RepeatedTriangle { triangle, .. } => {
                drop[*triangle as usize] = true;
                first = first.or(Some(problem));
            }
            // Of a strand, or of triangles that are dropped.
            MeshProblem::UnreferencedVertex { .. } => {}
            other => {
                let problems = vec![other.clone()];
                return Err(SceneError::Mesh { body: owner.to_owned(), problems });
            }
        }
    }
    let Some(first) = first else { return Ok(()) };
    let count = drop.iter().filter(|d| **d).count();
    warnings.push(format!("{owner}: dropped {count} triangles that are no obstacle: {first}"));
    let mut index = 0;
    part.triangles.retain(|_| {
        index += 1;
        !drop[index - 1]
    });
    drop_particles(part);
    if part.triangles.is_empty() && part.strands.is_empty() {
        let message = "no triangle of the mesh has an area".to_owned();
        return Err(SceneError::Body { body: owner.to_owned(), message });
    }
    Ok(())
}

fn obstacle_motion(obstacle: &ObstacleSpec, placing: Placing) -> ObstacleMotion {
    let animated = obstacle.shape.as_ref().and_then(Shape::animated);
    match (animated, &obstacle.motion) {
        (Some(shape), _) => ObstacleMotion::Procedural(Procedural { shape, placing }),
        (None, Some(motion)) => ObstacleMotion::Rigid(motion.clone()),
        (None, None) => ObstacleMotion::Rest,
    }
}

fn filter(groups: &[u32], collides_with: Option<&[u32]>, obstacle: bool, self_collision: bool) -> BodyFilter {
    let bits =
        |list: &[u32]| list.iter().fold(0u32, |bits, group| bits | 1u32.checked_shl(*group).unwrap_or(0));
    BodyFilter { obstacle, groups: bits(groups), mask: collides_with.map_or(u32::MAX, bits), self_collision }
}

fn bounds(positions: &[Point]) -> (Point, Point) {
    let start = positions.first().copied().unwrap_or_else(Point::origin);
    positions.iter().fold((start, start), |(low, high), p| (low.inf(p), high.sup(p)))
}

fn pins(scene: &Scene, assembly: &Assembly) -> Result<Vec<Pin>, SceneError> {
    let mut pins: Vec<Pin> = Vec::new();
    for (index, spec) in scene.pins.iter().enumerate() {
        let fault = |message: String| SceneError::Body { body: format!("pin[{index}]"), message };
        let Some(body) = scene.bodies.iter().position(|b| b.name == spec.body) else {
            return Err(fault(format!("no body {:?}", spec.body)));
        };
        let range = assembly.bodies[body].vertices.clone();
        let vertices = pinned(spec, range, &assembly.drops[body], &assembly.positions).map_err(fault)?;
        if vertices.is_empty() {
            return Err(fault(format!("it selects no vertex of body {}", spec.body)));
        }
        for (other, pin) in pins.iter().enumerate() {
            let apart = pin.end < spec.start || spec.end < pin.start;
            let shared = vertices.iter().find(|v| pin.vertices.binary_search(v).is_ok());
            if let (false, Some(vertex)) = (apart, shared) {
                let vertex = vertex - assembly.bodies[body].vertices.start;
                return Err(fault(format!(
                    "vertex {vertex} of body {} is held by pin[{other}] at the same time",
                    spec.body
                )));
            }
        }
        let (motion, start, end) = (spec.motion.clone(), spec.start, spec.end);
        // Names of bodies and obstacles differ.
        let obstacle = |name: &String| assembly.bodies.iter().position(|b| b.name == *name);
        let follow = spec.follow.as_ref().and_then(obstacle).map(|body| body as u32);
        pins.push(Pin { vertices, motion, follow, start, end });
    }
    Ok(pins)
}

fn pinned(
    spec: &PinSpec,
    range: Range<u32>,
    dropped: &[u32],
    positions: &[Point],
) -> Result<Vec<u32>, String> {
    let (low, high) = bounds(&positions[range.start as usize..range.end as usize]);
    let mut vertices = Vec::new();
    for &v in &spec.vertices {
        let before = dropped.partition_point(|d| *d < v);
        if dropped.get(before) == Some(&v) {
            return Err(format!("vertex {v} belongs to no triangle of body {}", spec.body));
        }
        // `before` entries of `dropped` are less than `v`, so this does not go below 0.
        let index = v - before as u32;
        if index as usize >= range.len() {
            let count = range.len() + dropped.len();
            return Err(format!("vertex {v}, but body {} has {count} vertices, counted from 0", spec.body));
        }
        vertices.push(range.start + index);
    }
    if let Some(region) = &spec.region {
        vertices.extend(range.clone().filter(|v| region.contains(&positions[*v as usize])));
    }
    if let Some(side) = spec.side {
        let (axis, upper) = side.axis();
        // Vertices that rounding, by a rotation for instance, moved off the side belong to it.
        let tolerance = 1e-9 * (high - low).norm();
        let on = |v: &u32| {
            let x = positions[*v as usize][axis];
            if upper { x >= high[axis] - tolerance } else { x <= low[axis] + tolerance }
        };
        vertices.extend(range.clone().filter(on));
    }
    vertices.sort_unstable();
    vertices.dedup();
    Ok(vertices)
}
