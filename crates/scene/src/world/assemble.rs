//! Puts a scene's meshes together.

use super::part::Part;
use super::pins::pins;
use super::roots::Surroundings;
use super::unused::unused_keys;
use super::{ObstacleMotion, Placing, Presence, Procedural, World, WorldBody, joined, jumps, sequence, size};
use crate::body::BodySpec;
use crate::description::Scene;
use crate::error::SceneError;
use crate::material::Material;
use crate::obstacle::ObstacleSpec;
use crate::shapes::Shape;
use bowknot_dynamics::{Body, BodyShape};
use bowknot_errors::counted;
use bowknot_geometry::{HalfSpace, Point, Topology, Vector};
use bowknot_io::Import;
use bowknot_proximity::{BodyFilter, CollisionModel};
use bowknot_twoway::{BodyContact, ContactData, ContactSide, HalfSpaceContact, PairFriction};
use std::ops::Range;

impl World {
    /// Loads and places the meshes of a scene.
    ///
    /// # Errors
    /// What [`Scene::validate`] refuses; meshes that are missing, malformed, or of other elements than their
    /// body is made of; triangles of a deformable body without area or repeated; tetrahedra that overlap
    /// or flat; strand edges whose points coincide; sequences whose topology changes; pins without vertices.
    pub fn new(scene: &Scene) -> Result<Self, SceneError> {
        scene.validate()?;
        let mut assembly = Assembly::default();
        for (index, body) in scene.bodies.iter().enumerate() {
            let part = format!("body[{index}]");
            let keys = [&*format!("{part}.mesh"), &*part];
            assembly.body(scene, body).map_err(|error| error.at(scene.origins.of(keys)))?;
        }
        let deformable_vertices = assembly.base.len();
        assembly.positions.clone_from(&assembly.base);
        for (index, obstacle) in scene.obstacles.iter().enumerate() {
            let part = format!("obstacle[{index}]");
            let keys = [&*format!("{part}.mesh"), &*format!("{part}.sequence"), &*part];
            assembly.obstacle(scene, obstacle).map_err(|error| error.at(scene.origins.of(keys)))?;
        }
        assembly.interior();
        assembly.finish(scene, deformable_vertices)
    }
}

#[derive(Default)]
struct Assembly {
    bodies: Vec<WorldBody>,
    models: Vec<Body>,
    filters: Vec<BodyFilter>,
    contact: ContactData,
    base: Vec<Point>,
    positions: Vec<Point>,
    velocities: Vec<Vector>,
    vertex_body: Vec<u32>,
    triangles: Vec<[u32; 3]>,
    strands: Vec<[u32; 2]>,
    particles: Vec<u32>,
    half_spaces: Vec<HalfSpace>,
    half_space_names: Vec<String>,
    half_space_presence: Vec<Presence>,
    /// Positions and velocities of vertices inside of each body, and of frame points.
    insides: Vec<(Vec<Point>, Vec<Vector>)>,
    warnings: Vec<String>,
}

impl Assembly {
    fn body(&mut self, scene: &Scene, body: &BodySpec) -> Result<(), SceneError> {
        let import = Import { up: body.up, scale: body.scale };
        let placing = Placing { import, rotate: body.rotate, translate: body.translate };
        let part = Part::load(
            &scene.folder,
            body.mesh.as_deref(),
            body.part.as_deref(),
            body.shape.as_ref(),
            &import,
        )?;
        let mut part = part.into_body(body, &mut self.warnings)?;
        placing.place(&mut part.positions);
        let mut velocities = initial_velocities(body, &part.positions, part.rods.len());

        let outside = part.positions.len() - part.interior;
        self.insides.push((part.positions.split_off(outside), velocities.split_off(outside)));
        let filter = filter(&body.groups, body.collides_with.as_deref(), false, body.self_collision);
        // Numbered within the part; those of the world follow when all of it is known.
        let (tets, quadratic_tets) =
            (std::mem::take(&mut part.tets), std::mem::take(&mut part.quadratic_tets));
        let rods = std::mem::take(&mut part.rods);
        let (vertices, elements) = self.append(part, filter);
        self.velocities.extend(velocities);
        let shape = match body.material {
            Material::Cloth(material) => BodyShape::Cloth { triangles: elements.triangles, material },
            Material::Solid(material) if quadratic_tets.is_empty() => {
                BodyShape::Solid { tets: Vec::new(), material }
            }
            Material::Solid(material) => BodyShape::QuadraticSolid { tets: Vec::new(), material },
            Material::Strands(material) if !rods.is_empty() => {
                BodyShape::Rods { edges: Vec::new(), material }
            }
            Material::Strands(material) => BodyShape::Strands { edges: elements.strands.clone(), material },
            Material::Particles(material) => {
                BodyShape::Particles { vertices: vertices.clone().collect(), material }
            }
        };
        self.models.push(Body { gravity: body.gravity, ..Body::new(&*body.name, shape) });
        let grain = match body.material {
            Material::Particles(material) => Some(2.0 * material.radius),
            _ => None,
        };
        self.contact.bodies.push(BodyContact {
            thickness: body.thickness,
            delta: body.delta.or(grain),
            friction: body.friction,
            stretch_limit: stretch_limit(scene, body),
        });
        self.bodies.push(WorldBody {
            name: body.name.clone(),
            kind: Some(body.kind),
            vertices,
            interior: 0..0,
            tets,
            quadratic_tets,
            rods,
            strands: elements.strands,
            surface: elements.surface,
            motion: ObstacleMotion::Rest,
            presence: Presence::default(),
            groups: elements.groups,
            numbers: elements.numbers,
            mesh_vertices: elements.mesh_vertices,
        });
        Ok(())
    }

    fn obstacle(&mut self, scene: &Scene, obstacle: &ObstacleSpec) -> Result<(), SceneError> {
        let import = Import { up: obstacle.up, scale: obstacle.scale };
        let placing = Placing { import, rotate: obstacle.rotate, translate: obstacle.translate };
        if let Some(Shape::HalfSpace(shape)) = &obstacle.shape {
            let normal = placing.rotation() * shape.normal;
            // Validation has refused a normal of no length.
            self.half_spaces.extend(HalfSpace::new(Point::from(obstacle.translate), normal));
            self.half_space_names.push(obstacle.name.clone());
            self.half_space_presence.push(Presence::default().between(obstacle.appears, obstacle.vanishes));
            let (thickness, friction) = (obstacle.thickness, obstacle.friction);
            self.contact.half_spaces.push(HalfSpaceContact { thickness, friction });
            return Ok(());
        }
        let (part, motion, presence) = if let Some(path) = &obstacle.sequence {
            let (part, frames, presence) =
                sequence::load(&scene.folder, path, obstacle, &placing, &mut self.warnings)?;
            (part, ObstacleMotion::Sequence(frames), presence)
        } else {
            let (mesh, shape) = (obstacle.mesh.as_deref(), obstacle.shape.as_ref());
            let part = Part::load(&scene.folder, mesh, obstacle.part.as_deref(), shape, &import)?;
            let mut part = part.into_obstacle(&format!("obstacle {}", obstacle.name), &mut self.warnings)?;
            placing.place(&mut part.positions);
            (part, motion(obstacle, placing), Presence::default())
        };
        let mut start = part.positions.clone();
        motion.positions(&part.positions, 0.0, &mut start);
        self.positions.extend(start);
        let filter = filter(&obstacle.groups, obstacle.collides_with.as_deref(), true, false);
        let (vertices, elements) = self.append(part, filter);
        self.velocities.resize(vertices.end as usize, Vector::zeros());
        self.models.push(Body::obstacle(&*obstacle.name, vertices.clone().collect()));
        self.contact.bodies.push(BodyContact {
            thickness: obstacle.thickness,
            friction: obstacle.friction,
            ..BodyContact::default()
        });
        self.insides.push((Vec::new(), Vec::new()));
        self.bodies.push(WorldBody {
            name: obstacle.name.clone(),
            kind: None,
            vertices,
            interior: 0..0,
            tets: Vec::new(),
            quadratic_tets: Vec::new(),
            rods: Vec::new(),
            strands: elements.strands,
            surface: elements.surface,
            motion,
            presence: presence.between(obstacle.appears, obstacle.vanishes),
            groups: elements.groups,
            numbers: elements.numbers,
            mesh_vertices: elements.mesh_vertices,
        });
        Ok(())
    }

    /// Appends what collides of a part as the next body; its vertices, and its elements in the world's
    /// numbering.
    fn append(&mut self, mut part: Part, filter: BodyFilter) -> (Range<u32>, Part) {
        let first = self.base.len() as u32;
        part.triangles.iter_mut().flatten().for_each(|v| *v += first);
        part.strands.iter_mut().flatten().for_each(|v| *v += first);
        part.particles.iter_mut().for_each(|v| *v += first);
        self.triangles.extend_from_slice(&part.triangles);
        self.strands.extend_from_slice(&part.strands);
        self.particles.extend_from_slice(&part.particles);
        self.vertex_body.resize(self.base.len() + part.positions.len(), self.filters.len() as u32);
        self.base.append(&mut part.positions);
        self.filters.push(filter);
        (first..self.base.len() as u32, part)
    }

    /// Appends the vertices inside of solids and frame points behind all others, and numbers tetrahedra and rods.
    fn interior(&mut self) {
        for (index, (positions, velocities)) in std::mem::take(&mut self.insides).into_iter().enumerate() {
            let body = &mut self.bodies[index];
            let first = self.positions.len() as u32;
            body.interior = first..first + positions.len() as u32;
            let (start, outside) = (body.vertices.start, body.vertices.len() as u32);
            let number = |v: &mut u32| *v = if *v < outside { *v + start } else { *v - outside + first };
            body.tets.iter_mut().flatten().for_each(number);
            body.quadratic_tets.iter_mut().flatten().for_each(number);
            body.rods.iter_mut().flatten().for_each(number);
            match &mut self.models[index].shape {
                BodyShape::Solid { tets, .. } => tets.clone_from(&body.tets),
                BodyShape::QuadraticSolid { tets, .. } => tets.clone_from(&body.quadratic_tets),
                BodyShape::Rods { edges, .. } => edges.clone_from(&body.rods),
                _ => {}
            }
            self.positions.extend(positions);
            self.velocities.extend(velocities);
        }
    }

    fn finish(mut self, scene: &Scene, deformable_vertices: usize) -> Result<World, SceneError> {
        let surroundings = Surroundings {
            triangles: &self.triangles,
            first_vertex: deformable_vertices as u32,
            positions: &self.positions,
        };
        let pins = pins(scene, &self.bodies, &surroundings, &mut self.warnings)?;
        self.contact.pairs = self.friction_pairs(scene);
        let topology = Topology::builder(self.base.len())
            .triangles(self.triangles)
            .strand_edges(self.strands.iter().copied())
            .particles(self.particles.iter().copied())
            .build()
            .map_err(joined)?;
        let collision = CollisionModel::new(topology, self.vertex_body, self.filters, self.half_spaces)
            .map_err(|error| SceneError::Model(error.to_string()))?;
        let mut world = World {
            bodies: self.bodies,
            half_space_names: self.half_space_names,
            half_space_presence: self.half_space_presence,
            deformable_vertices,
            positions: self.positions,
            velocities: self.velocities,
            collision,
            contact: self.contact,
            materials: self.models,
            pins,
            warnings: self.warnings,
            base: self.base,
        };
        world.warnings.extend(size::warnings(&world.sizes()));
        world.warnings.extend(unused_keys(scene));
        let simulation = &scene.simulation;
        world.warnings.extend(jumps::warnings(&world, simulation.dt, simulation.frames));
        world.warnings.extend(never_there(&world, simulation.dt, simulation.frames));
        for warning in &world.warnings {
            tracing::warn!("{warning}");
        }
        Ok(world)
    }

    fn friction_pairs(&self, scene: &Scene) -> Vec<PairFriction> {
        let side = |name: &String| {
            let body = self.bodies.iter().position(|b| b.name == *name).map(|b| ContactSide::Body(b as u32));
            let plane = || self.half_space_names.iter().position(|n| n == name);
            body.or_else(|| plane().map(|h| ContactSide::HalfSpace(h as u32)))
        };
        let pair = |spec: &crate::friction::FrictionPair| {
            let [a, b] = &spec.bodies;
            // Validation has refused names that do not exist.
            Some(PairFriction { sides: [side(a)?, side(b)?], friction: spec.friction })
        };
        scene.friction_pairs.iter().filter_map(pair).collect()
    }
}

/// Warnings of obstacles that are there in none of so many time steps of `dt` [s].
fn never_there(world: &World, dt: f64, steps: usize) -> Vec<String> {
    let presences = world.bodies.iter().map(|body| &body.presence).chain(&world.half_space_presence);
    let never = world.names().zip(presences).filter(|(_, presence)| !presence.is_ever(dt, steps.max(1)));
    let warning = |(name, _): (&String, &Presence)| {
        format!(
            "obstacle {name} is never there: none of the {} of the run begins while it is",
            counted(steps, "time step", "time steps")
        )
    };
    never.map(warning).collect()
}

/// Stretch limit of a body: its own, or that of its material unless the scene has one for all, which is left
/// to `contact.stretch_limit`.
fn stretch_limit(scene: &Scene, body: &BodySpec) -> Option<f64> {
    let for_all = scene.contact.stretch_limit.is_some();
    body.stretch_limit.or_else(|| if for_all { None } else { body.material.stretch_limit() })
}

fn motion(obstacle: &ObstacleSpec, placing: Placing) -> ObstacleMotion {
    let animated = obstacle.shape.as_ref().and_then(Shape::animated);
    match (animated, &obstacle.motion) {
        (Some(shape), _) => ObstacleMotion::Procedural(Procedural { shape, placing }),
        (None, Some(motion)) => ObstacleMotion::Rigid(motion.clone()),
        (None, None) => ObstacleMotion::Rest,
    }
}

/// Velocities of a body that moves as a rigid one [m/s]. The last `frame_points` of its vertices have no part in its
/// center.
fn initial_velocities(body: &BodySpec, positions: &[Point], frame_points: usize) -> Vec<Vector> {
    let turn = body.angular_velocity.map(f64::to_radians);
    if turn == Vector::zeros() {
        return vec![body.velocity; positions.len()];
    }
    let own = &positions[..positions.len() - frame_points];
    let sum: Vector = own.iter().map(|p| p.coords).sum();
    let center = Point::from(sum / own.len().max(1) as f64);
    positions.iter().map(|p| body.velocity + turn.cross(&(p - center))).collect()
}

fn filter(groups: &[u32], collides_with: Option<&[u32]>, obstacle: bool, self_collision: bool) -> BodyFilter {
    let bits =
        |list: &[u32]| list.iter().fold(0u32, |bits, group| bits | 1u32.checked_shl(*group).unwrap_or(0));
    BodyFilter { obstacle, groups: bits(groups), mask: collides_with.map_or(u32::MAX, bits), self_collision }
}
