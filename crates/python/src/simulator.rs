//! Simulations, and their checkpoints.

use crate::arrays::{self, Rows};
use crate::compute::compute;
use crate::contacts;
use crate::device;
use crate::drive;
use crate::error;
use crate::scene::Scene;
use bowknot::SimulationError;
use bowknot::check::StateOptions;
use bowknot::geometry::Point;
use bowknot::simulator::{AcceptedStep, CollisionProblem, SimulationObserver, describe_intersections};
use numpy::{PyArray1, PyArray2, PyReadonlyArray1};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::ops::ControlFlow;
use std::path::PathBuf;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};

/// A running simulation.
#[pyclass(frozen, module = "bowknot._native")]
pub struct Simulator {
    /// None after an internal error.
    inner: Mutex<Option<bowknot::Simulator>>,
}

/// The state of a simulation between two time steps.
#[pyclass(frozen, module = "bowknot._native")]
pub struct Checkpoint {
    state: bowknot::simulator::Checkpoint,
}

#[pymethods]
impl Checkpoint {
    /// Reads a file that a run or [`Self::save`] has written.
    #[staticmethod]
    fn load(path: PathBuf) -> PyResult<Self> {
        let state = bowknot::simulator::Checkpoint::read(&path).map_err(error::input)?;
        Ok(Self { state })
    }

    /// Writes it as an NPZ archive.
    fn save(&self, path: PathBuf) -> PyResult<()> {
        self.state.write(&path).map_err(error::input)
    }

    /// Time steps made.
    #[getter]
    fn step(&self) -> usize {
        self.state.step
    }

    fn __eq__(&self, other: &Self) -> bool {
        self.state == other.state
    }
}

/// Abandons a time step when the user does.
struct Stop<'a>(&'a AtomicBool);

impl Stop<'_> {
    fn go_on(&self) -> ControlFlow<()> {
        if self.0.load(Ordering::Relaxed) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}

impl SimulationObserver for Stop<'_> {
    fn problem(&mut self, _: &CollisionProblem<'_>) -> ControlFlow<()> {
        self.go_on()
    }

    fn accepted(&mut self, _: &AcceptedStep<'_>) -> ControlFlow<()> {
        self.go_on()
    }

    fn sees_each_state(&self) -> bool {
        false
    }

    fn advanced(&mut self, _: usize) -> ControlFlow<()> {
        self.go_on()
    }
}

impl Simulator {
    /// Reads from the simulator.
    fn read<T>(&self, read: impl FnOnce(&bowknot::Simulator) -> PyResult<T>) -> PyResult<T> {
        let guard = self.inner.try_lock().map_err(|_| error::busy("simulator"))?;
        read(guard.as_ref().ok_or_else(|| error::broken("simulator"))?)
    }

    /// Changes the simulator on a thread of the pool.
    fn change<T: Send>(
        &self,
        py: Python<'_>,
        change: impl FnOnce(&mut bowknot::Simulator) -> PyResult<T> + Send,
    ) -> PyResult<T> {
        self.change_until(py, |simulator, _| change(simulator))
    }

    /// As [`Self::change`], with a flag that asks for an end. A change that is refused because of the flag raises what
    /// the signal has raised; one that is done is done.
    fn change_until<T: Send>(
        &self,
        py: Python<'_>,
        change: impl FnOnce(&mut bowknot::Simulator, &AtomicBool) -> PyResult<T> + Send,
    ) -> PyResult<T> {
        let mut guard = self.inner.try_lock().map_err(|_| error::busy("simulator"))?;
        let simulator = guard.as_mut().ok_or_else(|| error::broken("simulator"))?;
        let done = compute(py, |stop| change(simulator, stop))?;
        if done.result.is_err() {
            *guard = None;
        }
        done.finish()?
    }
}

#[pymethods]
impl Simulator {
    #[new]
    fn new(py: Python<'_>, scene: &Scene, backend: &str, device: Option<usize>) -> PyResult<Self> {
        let made = compute(py, |_| {
            let mut simulator = bowknot::Simulator::new(&scene.scene).map_err(error::simulation)?;
            device::set_backends(&mut simulator, backend, device)?;
            PyResult::Ok(simulator)
        })?;
        Ok(Self { inner: Mutex::new(Some(made.finish()??)) })
    }

    /// Makes one time step, and says what it did as JSON.
    fn step(&self, py: Python<'_>) -> PyResult<String> {
        let statistics = self.change_until(py, |simulator, stop| {
            simulator.step_observed(&mut Stop(stop)).map_err(error::simulation)
        })?;
        serde_json::to_string(&statistics).map_err(error::internal)
    }

    fn set_measured(&self, py: Python<'_>, measured: bool) -> PyResult<()> {
        self.change(py, |simulator| {
            simulator.set_measured(measured);
            Ok(())
        })
    }

    #[getter]
    fn time(&self) -> PyResult<f64> {
        self.read(|simulator| Ok(simulator.time()))
    }

    #[getter]
    fn step_index(&self) -> PyResult<usize> {
        self.read(|simulator| Ok(simulator.step_index()))
    }

    fn positions<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        self.read(|simulator| arrays::point_array(py, simulator.positions()))
    }

    fn velocities<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        self.read(|simulator| arrays::vector_array(py, simulator.velocities()))
    }

    /// What is the same in all time steps: elements, bodies, half-spaces.
    fn layout<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        self.read(|simulator| {
            let world = simulator.world();
            let topology = world.collision.topology();
            let count = topology.vertex_count as u32;
            let strands = topology.strand_edges.iter().map(|&e| topology.edges[e as usize]);
            let tets = world.bodies.iter().flat_map(|body| body.tets.iter().copied());
            let planes = world.collision.half_spaces().iter();
            let planes = planes.map(|plane| [plane.normal.x, plane.normal.y, plane.normal.z, plane.offset]);
            let names: Vec<&str> = world.bodies.iter().map(|body| body.name.as_str()).collect();
            let kinds: Vec<&str> =
                world.bodies.iter().map(|body| body.kind.map_or("obstacle", |kind| kind.name())).collect();
            let ranges = world
                .bodies
                .iter()
                .map(|body| [body.vertices.start, body.vertices.end, body.interior.start, body.interior.end]);
            let layout = PyDict::new(py);
            layout.set_item("faces", arrays::row_array(py, topology.triangles.iter().copied())?)?;
            layout.set_item("edges", arrays::row_array(py, strands)?)?;
            layout.set_item("particles", arrays::list(py, topology.particles.iter().copied()))?;
            layout.set_item("tets", arrays::row_array(py, tets)?)?;
            layout
                .set_item("obstacle", arrays::list(py, (0..count).map(|v| world.collision.is_obstacle(v))))?;
            layout.set_item("body", arrays::list(py, world.collision.vertex_body().iter().copied()))?;
            layout.set_item("planes", arrays::row_array(py, planes)?)?;
            layout.set_item("plane_names", &world.half_space_names)?;
            layout.set_item("names", names)?;
            layout.set_item("kinds", kinds)?;
            layout.set_item("ranges", arrays::row_array(py, ranges)?)?;
            layout.set_item("pins", world.pins.iter().map(|pin| pin.name.as_str()).collect::<Vec<_>>())?;
            layout.set_item("collision_vertices", count)?;
            layout.set_item("deformable_vertices", world.deformable_vertices)?;
            layout.set_item("time_step", simulator.scene().simulation.dt)?;
            layout.set_item("radius", drive::drawn_radius(simulator))?;
            Ok(layout)
        })
    }

    /// Which bodies, then which half-spaces, are there in the next time step.
    fn present(&self) -> PyResult<Vec<bool>> {
        self.read(|simulator| Ok(simulator.present().to_vec()))
    }

    /// For each vertex of the mesh of a body its number in the simulation, or -1 if no element names it.
    fn mesh_order<'py>(&self, py: Python<'py>, index: usize) -> PyResult<Bound<'py, PyArray1<i64>>> {
        self.read(|simulator| {
            let body = simulator.world().bodies.get(index).ok_or_else(|| error::input("no such body"))?;
            Ok(arrays::list(py, body.mesh_order().into_iter().map(|v| v.map_or(-1, i64::from))))
        })
    }

    /// What the judge says of the present state: its report as JSON, and each intersection in words.
    fn check(&self, py: Python<'_>, limit: usize, distance: bool) -> PyResult<(String, Vec<String>)> {
        let (report, words) = self.change(py, |simulator| {
            let positions = &simulator.positions()[..simulator.world().collision_vertices()];
            let options = StateOptions { limit, distance };
            let report = simulator.judge().check_state(positions, &options).map_err(error::input)?;
            let words = describe_intersections(simulator.world(), &report.intersections);
            Ok((report, words))
        })?;
        Ok((serde_json::to_string(&report).map_err(error::internal)?, words))
    }

    /// The contacts that carried a force at the end of the last time step.
    fn contacts<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        self.read(|simulator| contacts::arrays_of(py, &simulator.contacts(), simulator.world().bodies.len()))
    }

    fn mass_of(&self, name: &str) -> PyResult<f64> {
        self.read(|simulator| simulator.mass_of(name).map_err(error::input))
    }

    /// Force and torque that all contacts exert on a body.
    fn contact_wrench(&self, name: &str, about: [f64; 3], by: Option<&str>) -> PyResult<[[f64; 3]; 2]> {
        self.read(|simulator| {
            let about = Point::from(about);
            let wrench = match by {
                Some(other) => simulator.contact_wrench_by(name, other, &about),
                None => simulator.contact_wrench(name, &about),
            };
            let wrench = wrench.map_err(error::input)?;
            Ok([wrench.force.into(), wrench.torque.into()])
        })
    }

    fn pin_forces<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyArray2<f64>>> {
        self.read(|simulator| arrays::vector_array(py, simulator.pin_forces(name).map_err(error::input)?))
    }

    /// Force and torque that a pin exerts on its body.
    fn pin_wrench(&self, name: &str, about: [f64; 3]) -> PyResult<[[f64; 3]; 2]> {
        self.read(|simulator| {
            let wrench = simulator.pin_wrench(name, &Point::from(about)).map_err(error::input)?;
            Ok([wrench.force.into(), wrench.torque.into()])
        })
    }

    fn add_pin(
        &self,
        py: Python<'_>,
        name: &str,
        body: &str,
        vertices: PyReadonlyArray1<'_, u32>,
    ) -> PyResult<()> {
        let vertices = arrays::column(&vertices);
        self.change(py, |simulator| simulator.add_pin(name, body, &vertices).map_err(error::input))
    }

    fn remove_pin(&self, py: Python<'_>, name: &str) -> PyResult<()> {
        self.change(py, |simulator| simulator.remove_pin(name).map_err(error::input))
    }

    fn set_pin_targets(&self, py: Python<'_>, name: &str, targets: Rows<'_>) -> PyResult<()> {
        let targets = arrays::points(&targets)?;
        self.change(py, |simulator| simulator.set_pin_targets(name, &targets).map_err(error::input))
    }

    fn set_pin_pose(&self, py: Python<'_>, name: &str, pose: Rows<'_>) -> PyResult<()> {
        let pose = drive::isometry(&pose)?;
        self.change(py, |simulator| simulator.set_pin_pose(name, &pose).map_err(error::input))
    }

    fn set_obstacle_targets(&self, py: Python<'_>, name: &str, targets: Rows<'_>) -> PyResult<()> {
        let targets = arrays::points(&targets)?;
        self.change(py, |simulator| simulator.set_obstacle_targets(name, &targets).map_err(error::input))
    }

    fn set_obstacle_pose(&self, py: Python<'_>, name: &str, pose: Rows<'_>) -> PyResult<()> {
        let pose = drive::isometry(&pose)?;
        self.change(py, |simulator| simulator.set_obstacle_pose(name, &pose).map_err(error::input))
    }

    fn set_gravity(&self, py: Python<'_>, gravity: [f64; 3]) -> PyResult<()> {
        self.change(py, |simulator| simulator.set_gravity(gravity.into()).map_err(error::input))
    }

    fn set_wind(&self, py: Python<'_>, wind: [f64; 3]) -> PyResult<()> {
        self.change(py, |simulator| simulator.set_wind(wind.into()).map_err(error::input))
    }

    fn set_external_forces(&self, py: Python<'_>, forces: Rows<'_>) -> PyResult<()> {
        let forces = arrays::vectors(&forces)?;
        self.change(py, |simulator| simulator.set_external_forces(&forces).map_err(error::input))
    }

    fn set_velocities(&self, py: Python<'_>, body: &str, velocities: Rows<'_>) -> PyResult<()> {
        let velocities = arrays::vectors(&velocities)?;
        self.change(py, |simulator| simulator.set_velocities(body, &velocities).map_err(error::input))
    }

    fn place(&self, py: Python<'_>, name: &str, positions: Rows<'_>) -> PyResult<()> {
        let positions = arrays::points(&positions)?;
        self.change(py, |simulator| simulator.place(name, &positions).map_err(error::simulation))
    }

    /// Adds the bodies and obstacles of another scene.
    fn add(&self, py: Python<'_>, scene: &Scene) -> PyResult<()> {
        self.change(py, |simulator| drive::add(simulator, &scene.scene))
    }

    fn remove(&self, py: Python<'_>, name: &str) -> PyResult<()> {
        self.change(py, |simulator| simulator.remove(name).map_err(error::simulation))
    }

    /// Gives a body a material, as the value of the key `material` in TOML.
    fn set_material(&self, py: Python<'_>, body: &str, material: &str) -> PyResult<()> {
        self.change(py, |simulator| drive::set_material(simulator, body, material))
    }

    fn set_friction(&self, py: Python<'_>, name: &str, friction: f64) -> PyResult<()> {
        self.change(py, |simulator| simulator.set_friction(name, friction).map_err(error::simulation))
    }

    /// The scene as it is now.
    fn scene(&self) -> PyResult<Scene> {
        self.read(|simulator| Ok(Scene { scene: simulator.scene().clone() }))
    }

    fn checkpoint(&self, py: Python<'_>) -> PyResult<Checkpoint> {
        let state = self.change(py, |simulator| Ok(simulator.checkpoint()))?;
        Ok(Checkpoint { state })
    }

    /// Goes on from a state, which is judged if `check` is true.
    fn restore(&self, py: Python<'_>, checkpoint: &Checkpoint, check: bool) -> PyResult<()> {
        self.change(py, |simulator| {
            let state = &checkpoint.state;
            let restored = if check { simulator.restore_checked(state) } else { simulator.restore(state) };
            restored.map_err(|source| error::simulation(SimulationError::from(source)))
        })
    }

    /// What computes the collisions.
    #[getter]
    fn backend(&self) -> PyResult<String> {
        self.read(|simulator| Ok(simulator.backend().name()))
    }
}
