//! A scene in rapier: soft bodies with what its constructors choose where the scene says nothing else, in single precision.

use crate::meshes::{Mesh, Point};
use crate::scenes::{Body, CLOTH_DENSITY, CLOTH_STIFFNESS, Obstacle, SOLID_DENSITY, Scene};
use rapier3d::prelude::*;

/// What is varied; `Default` is what rapier chooses, but for the cells: its own have no Young's modulus.
pub struct Settings {
    /// Solver iterations, which are substeps.
    pub substeps: usize,
    /// Thickness to each side, in distances of neighbors.
    pub radius: f64,
    /// The parts of the recovery from tangles that are off by default.
    pub recovery: bool,
    /// Natural frequency of a cloth's edges [Hz]; otherwise from the stiffness of the fabric.
    pub edge_hz: Option<f64>,
    pub solver: SoftBodySolver,
    pub cells: SoftBodyCellModel,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            substeps: IntegrationParameters::default().num_solver_iterations,
            radius: 0.5,
            recovery: false,
            edge_hz: None,
            solver: SoftBodySolver::Constraints,
            cells: SoftBodyCellModel::Corotational,
        }
    }
}

pub struct World {
    world: PhysicsWorld,
    bodies: Vec<SoftBodyHandle>,
}

impl World {
    pub fn new(scene: &Scene, settings: &Settings, dt: f64) -> Self {
        let mut world = PhysicsWorld::new();
        world.gravity = Vector::new(0.0, 0.0, -scene.gravity as Real);
        let parameters = &mut world.integration_parameters;
        parameters.dt = dt as Real;
        parameters.num_solver_iterations = settings.substeps;
        parameters.soft_bodies.recovery.edge_speculation = settings.recovery;
        parameters.soft_bodies.recovery.crossing_repulsion = settings.recovery;
        let friction = scene.friction as Real;
        for obstacle in &scene.obstacles {
            let (place, collider) = match obstacle {
                Obstacle::Ball(radius, center, _) => {
                    (Pose::from_translation(vector(*center)), ColliderBuilder::ball(*radius as Real))
                }
                // A thick box whose upper side is the plane.
                Obstacle::Plane(normal) => {
                    let normal = vector(*normal);
                    let turn = Rotation::from_rotation_arc(Vector::Z, normal);
                    (Pose::from_parts(-0.5 * normal, turn), ColliderBuilder::cuboid(5.0, 5.0, 0.5))
                }
            };
            world.insert(RigidBodyBuilder::fixed().pose(place), collider.friction(friction));
        }
        let bodies =
            scene.bodies.iter().map(|body| world.insert_soft_body(soft_body(body, friction, settings)));
        Self { bodies: bodies.collect(), world }
    }

    /// One time step that ends at `time`.
    pub fn step(&mut self, scene: &Scene, time: f64) {
        for (body, &handle) in scene.bodies.iter().zip(&self.bodies) {
            let soft = &mut self.world.soft_bodies[handle];
            for grip in &body.grips {
                for &i in &grip.vertices {
                    if time <= grip.end {
                        let goal = grip.motion.place(body.mesh.points[i as usize], time);
                        soft.set_particle_kinematic_target(i as usize, vector(goal));
                    } else if soft.particles()[i as usize].is_pinned() {
                        soft.set_particle_pinned(i as usize, false);
                    }
                }
            }
        }
        self.world.step();
    }

    /// Positions of the particles, body by body.
    pub fn positions(&self) -> Vec<Vec<Point>> {
        let place = |p: Vector| [p.x, p.y, p.z].map(f64::from);
        let of_body = |&handle| self.world.soft_bodies[handle].particle_positions().map(place).collect();
        self.bodies.iter().map(of_body).collect()
    }

    pub fn asleep(&self) -> bool {
        self.bodies.iter().all(|&handle| self.world.soft_bodies[handle].is_sleeping())
    }
}

fn soft_body(body: &Body, friction: Real, settings: &Settings) -> SoftBodyBuilder {
    let mesh = &body.mesh;
    let builder = SoftBodyBuilder::new(mesh.points.iter().map(|&p| vector(p)).collect())
        .masses(masses(mesh))
        .particle_radius((settings.radius * mesh.spacing) as Real)
        // Off by default. Cloth folds, the solids here do not.
        .self_contacts(mesh.tets.is_empty())
        .solver(settings.solver)
        .surface_collider(ColliderBuilder::ball(0.05).density(0.0).friction(friction))
        .pinned_particles(body.grips.iter().flat_map(|grip| grip.vertices.iter().copied()));
    if mesh.tets.is_empty() {
        let hz = settings.edge_hz.unwrap_or_else(|| edge_frequency(mesh));
        let edge_softness = SpringCoefficients::new(hz as Real, 1.0);
        builder
            .surface(mesh.triangles.clone())
            .edges(mesh.springs.clone())
            .bend_edges(mesh.bends.clone())
            .material(SoftBodyMaterial { edge_softness, ..Default::default() })
    } else {
        let [young_modulus, poisson_ratio] = body.elastic.map(|x| x as Real);
        builder
            .surface(mesh.triangles.clone())
            .cells(mesh.tets.clone())
            .cell_model(settings.cells)
            .material(SoftBodyMaterial { young_modulus, poisson_ratio, ..Default::default() })
    }
}

/// The frequency of two vertices joined by a spring [Hz]. Squares whose sides and diagonals have the stiffness k resist
/// stretching along a side with 1.5 k per width.
fn edge_frequency(mesh: &Mesh) -> f64 {
    let mass = 0.5 * CLOTH_DENSITY * mesh.spacing * mesh.spacing;
    (CLOTH_STIFFNESS / 1.5 / mass).sqrt() / std::f64::consts::TAU
}

/// Masses of the particles by their share of area or volume [kg].
fn masses(mesh: &Mesh) -> Vec<Real> {
    let mut masses = vec![0.0; mesh.points.len()];
    let side = |a: u32, b: u32| vector(mesh.points[b as usize]) - vector(mesh.points[a as usize]);
    let mut add = |vertices: &[u32], mass: Real| {
        vertices.iter().for_each(|&i| masses[i as usize] += mass / vertices.len() as Real);
    };
    if mesh.tets.is_empty() {
        for &[a, b, c] in &mesh.triangles {
            add(&[a, b, c], CLOTH_DENSITY as Real * 0.5 * side(a, b).cross(side(a, c)).length());
        }
    }
    for &[a, b, c, d] in &mesh.tets {
        let volume = side(a, b).cross(side(a, c)).dot(side(a, d)).abs() / 6.0;
        add(&[a, b, c, d], SOLID_DENSITY as Real * volume);
    }
    masses
}

fn vector([x, y, z]: Point) -> Vector {
    Vector::new(x as Real, y as Real, z as Real)
}
