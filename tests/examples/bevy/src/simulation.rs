//! Bowknot in Bevy, to copy into a game: time steps in the background, meshes that show where they end.

use bevy::asset::RenderAssetUsages;
use bevy::mesh::{Indices, PrimitiveTopology};
use bevy::prelude::*;
use bevy::tasks::{AsyncComputeTaskPool, Task, futures::check_ready};
use bowknot::check::StateOptions;
use bowknot::geometry::nalgebra::{Isometry3, Quaternion, Translation3, UnitQuaternion};
use bowknot::{SimulationError, Simulator, StepStatistics};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Computes the time steps of a simulator, one at a time.
pub struct BowknotPlugin(Arc<Mutex<Simulator>>);

/// An entity that leads an obstacle: its `Transform` takes the obstacle from its place in the scene, about
/// the origin. Scale is ignored.
#[derive(Component)]
pub struct Leads(pub &'static str);

/// An entity whose mesh shows a body or an obstacle, by its index. It is where the *simulator* has got, so
/// that what you see is what the judge has judged: obstacles wait where cloth is in their way.
#[derive(Component)]
pub struct Surface(pub usize);

/// What moves the entities that lead; it runs once per time step, just before one begins.
#[derive(SystemSet, Clone, Debug, PartialEq, Eq, Hash)]
pub struct BeforeStep;

/// What the simulator has done.
#[derive(Resource, Default)]
pub struct Report {
    /// The last time step.
    pub last: StepStatistics,
    /// Pairs of elements that intersected at the ends of all time steps, as the judge counts them.
    pub intersections: usize,
    /// Why there are no more time steps, in words.
    pub error: Option<String>,
}

/// The simulator, locked while a time step is in flight.
#[derive(Resource)]
pub struct Simulation {
    pub simulator: Arc<Mutex<Simulator>>,
    step: Option<Task<Result<(StepStatistics, usize), SimulationError>>>,
}

impl BowknotPlugin {
    pub fn new(simulator: Simulator) -> Self {
        Self(Arc::new(Mutex::new(simulator)))
    }
}

impl Plugin for BowknotPlugin {
    fn build(&self, app: &mut App) {
        let dt = lock(&self.0).scene().simulation.dt;
        app.insert_resource(Simulation { simulator: Arc::clone(&self.0), step: None })
            .init_resource::<Report>()
            // Never faster than the clock; time steps that take longer than that make slow motion.
            .insert_resource(Time::<Fixed>::from_seconds(dt))
            .configure_sets(FixedUpdate, BeforeStep.run_if(idle))
            .add_systems(FixedUpdate, finish_step.before(BeforeStep))
            .add_systems(FixedUpdate, begin_step.run_if(idle).after(BeforeStep))
            .add_systems(PreStartup, spawn_surfaces);
    }
}

/// Whether the next time step can begin.
fn idle(simulation: Res<Simulation>, report: Res<Report>) -> bool {
    simulation.step.is_none() && report.error.is_none()
}

/// Hands the simulator to a task. Bevy goes on with its frames.
fn begin_step(mut simulation: ResMut<Simulation>, leaders: Query<(&Leads, &Transform)>) {
    let poses: Vec<_> = leaders.iter().map(|(leads, transform)| (leads.0, pose(transform))).collect();
    let simulator = Arc::clone(&simulation.simulator);
    let step = async move { time_step(&mut lock(&simulator), &poses) };
    simulation.step = Some(AsyncComputeTaskPool::get().spawn(step));
}

/// A time step, and how many pairs of elements intersect at its end. The simulator guarantees that none does;
/// the judge, which shares no code with it, confirms that.
fn time_step(
    simulator: &mut Simulator,
    poses: &[(&str, Isometry3<f64>)],
) -> Result<(StepStatistics, usize), SimulationError> {
    for (name, pose) in poses {
        simulator.set_obstacle_pose(name, pose)?;
    }
    let statistics = simulator.step()?;
    let positions = &simulator.positions()[..simulator.world().collision_vertices()];
    let judged = simulator.judge().check_state(positions, &StateOptions { limit: 0, distance: false })?;
    Ok((statistics, judged.intersection_count))
}

/// Takes the result of a time step that has ended, and shows it.
fn finish_step(
    mut simulation: ResMut<Simulation>,
    mut report: ResMut<Report>,
    surfaces: Query<(&Surface, &Mesh3d)>,
    mut meshes: ResMut<Assets<Mesh>>,
) {
    let Some(outcome) = simulation.step.as_mut().and_then(check_ready) else { return };
    simulation.step = None;
    match outcome {
        Ok((statistics, intersections)) => {
            report.last = statistics;
            report.intersections += intersections;
        }
        // The simulator is as it was before this time step.
        Err(error) => report.error = Some(error.to_string()),
    }
    let simulator = lock(&simulation.simulator);
    for (surface, mesh) in &surfaces {
        if let Some(mut mesh) = meshes.get_mut(mesh) {
            update(&mut mesh, &simulator, surface.0);
        }
    }
}

/// An entity for each body and each obstacle that is a mesh; half-spaces are none.
fn spawn_surfaces(simulation: Res<Simulation>, mut meshes: ResMut<Assets<Mesh>>, mut commands: Commands) {
    let simulator = lock(&simulation.simulator);
    let world = simulator.world();
    for (index, body) in world.bodies.iter().enumerate() {
        let triangles = world.collision.topology().triangles.iter().flatten();
        let own = triangles.filter(|v| body.vertices.contains(v)).map(|v| v - body.vertices.start);
        let mut mesh = Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::default());
        mesh.insert_indices(Indices::U32(own.collect()));
        update(&mut mesh, &simulator, index);
        commands.spawn((Name::new(body.name.clone()), Surface(index), Mesh3d(meshes.add(mesh))));
    }
}

/// Positions of a body's vertices, and normals by which it looks smooth.
fn update(mesh: &mut Mesh, simulator: &Simulator, body: usize) {
    let vertices = &simulator.world().bodies[body].vertices;
    let positions = &simulator.positions()[vertices.start as usize..vertices.end as usize];
    let positions: Vec<[f32; 3]> = positions.iter().map(|x| [x.x, x.y, x.z].map(|x| x as f32)).collect();
    mesh.insert_attribute(Mesh::ATTRIBUTE_POSITION, positions);
    mesh.compute_smooth_normals();
}

fn pose(transform: &Transform) -> Isometry3<f64> {
    let (t, q) = (transform.translation.as_dvec3(), transform.rotation.as_dquat());
    let rotation = UnitQuaternion::from_quaternion(Quaternion::new(q.w, q.x, q.y, q.z));
    Isometry3::from_parts(Translation3::new(t.x, t.y, t.z), rotation)
}

fn lock(simulator: &Mutex<Simulator>) -> MutexGuard<'_, Simulator> {
    simulator.lock().unwrap_or_else(PoisonError::into_inner)
}
