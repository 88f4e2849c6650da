//! Simulations of a scene.

use crate::error::{BowknotStatus, guarded, input};
use crate::memory::{array, exclusive, numbers, points, shared, text, write};
use bowknot::check::StateOptions;
use bowknot::geometry::{Point, Topology, Vector};
use bowknot::{DriveError, Scene, Simulator};
use std::ffi::{CString, c_char};

/// A running simulation.
pub struct BowknotSimulator {
    inner: Simulator,
    /// Names of the bodies as C has them, made anew where bodies come or go.
    names: Vec<CString>,
}

/// What a time step did.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default)]
pub struct BowknotStep {
    /// Number of the time step, from 1.
    pub step: u64,
    /// Time at its end [s].
    pub time: f64,
    /// Whether the time step was solved to its tolerance.
    pub solved: bool,
    /// Newton iterations.
    pub newton_iterations: u32,
    /// Two-way steps.
    pub two_way_steps: u32,
    /// Residual of the time step [m].
    pub residual: f64,
    /// Smallest distance of a pair [m]; infinite if none is within reach.
    pub min_gap: f64,
    /// Largest ratio of an edge's length to its rest length.
    pub max_stretch: f64,
    /// Kinetic, elastic and potential energy [J].
    pub energy: [f64; 3],
}

/// A body or an obstacle with a mesh.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct BowknotBody {
    /// Its name. It stays until the simulation is freed.
    pub name: *const c_char,
    /// Its first vertex that collides.
    pub first_vertex: u32,
    /// How many vertices of it collide.
    pub vertices: u32,
    /// Whether it is an obstacle.
    pub is_obstacle: bool,
}

/// Makes a simulation of a scene: the `toml` of a scene file, whose paths are relative to `folder` (NULL: to the current
/// folder). The handle is written to `simulator`, NULL if the call fails. A start that intersects is refused.
///
/// # Safety
/// Both texts are null or end with a zero; `simulator` is null or points to a pointer.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn bowknot_simulator_new(
    toml: *const c_char,
    folder: *const c_char,
    simulator: *mut *mut BowknotSimulator,
) -> BowknotStatus {
    guarded(|| {
        // SAFETY: by the contract.
        let (out, toml) = unsafe { (exclusive("simulator", simulator)?, text("toml", toml)?) };
        *out = std::ptr::null_mut();
        // SAFETY: by the contract.
        let folder = if folder.is_null() { "." } else { unsafe { text("folder", folder)? } };
        let scene = Scene::from_toml(toml, folder).map_err(input)?;
        let inner = Simulator::new(&scene)?;
        let names = inner
            .world()
            .bodies
            .iter()
            .map(|body| CString::new(body.name.replace('\0', " ")).unwrap_or_default());
        let names = names.collect();
        *out = Box::into_raw(Box::new(BowknotSimulator { inner, names }));
        Ok(())
    })
}

/// Frees a simulation; NULL does nothing.
///
/// # Safety
/// The handle is null or one of `bowknot_simulator_new` that has not been freed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn bowknot_simulator_free(simulator: *mut BowknotSimulator) {
    if !simulator.is_null() {
        guarded(|| {
            // SAFETY: it came from a box, by the contract.
            drop(unsafe { Box::from_raw(simulator) });
            Ok(())
        });
    }
}

/// Makes one time step. What it did is written to `step`, unless that is NULL. If it fails the state is that before.
///
/// # Safety
/// The handle is that of a simulation; `step` is null or points to a `BowknotStep`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn bowknot_simulator_step(
    simulator: *mut BowknotSimulator,
    step: *mut BowknotStep,
) -> BowknotStatus {
    guarded(|| {
        // SAFETY: by the contract.
        let (simulator, out) = unsafe { (exclusive("simulator", simulator)?, step.as_mut()) };
        let did = simulator.inner.step()?;
        let energy = [did.energy.kinetic, did.energy.elastic, did.energy.potential];
        let done = BowknotStep {
            step: did.step as u64,
            time: did.time,
            solved: did.solved,
            newton_iterations: did.newton_iterations as u32,
            two_way_steps: did.two_way_steps as u32,
            residual: did.residual_m,
            min_gap: did.min_gap_m.unwrap_or(f64::INFINITY),
            max_stretch: did.max_stretch,
            energy,
        };
        out.into_iter().for_each(|out| *out = done);
        Ok(())
    })
}

/// How many vertices there are: of deformable bodies, then of obstacles, then those that do not collide (inside of solids).
///
/// # Safety
/// The handle is null, for which there are none, or that of a simulation.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn bowknot_simulator_vertices(simulator: *const BowknotSimulator) -> usize {
    // SAFETY: by the contract.
    unsafe { simulator.as_ref() }.map_or(0, |simulator| simulator.inner.positions().len())
}

/// Writes x y z of each vertex [m]. `count` is the room of the array, three numbers per vertex.
///
/// # Safety
/// The handle is that of a simulation; the array has that much room.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn bowknot_simulator_positions(
    simulator: *const BowknotSimulator,
    positions: *mut f64,
    count: usize,
) -> BowknotStatus {
    // SAFETY: by the contract.
    unsafe { rows(simulator, positions, count, |inner| numbers(inner.positions().iter().map(|x| &x.coords))) }
}

/// Writes the velocities [m/s], as `bowknot_simulator_positions` does positions.
///
/// # Safety
/// As for `bowknot_simulator_positions`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn bowknot_simulator_velocities(
    simulator: *const BowknotSimulator,
    velocities: *mut f64,
    count: usize,
) -> BowknotStatus {
    // SAFETY: by the contract.
    unsafe { rows(simulator, velocities, count, |inner| numbers(inner.velocities().iter())) }
}

/// Writes the vertices of the triangles, three for each, and how many numbers that are to `count`, which holds the room of
/// the array before. With NULL as `triangles` it only counts.
///
/// # Safety
/// The handle is that of a simulation; `count` points to a number; the array is null or has that much room.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn bowknot_simulator_triangles(
    simulator: *const BowknotSimulator,
    triangles: *mut u32,
    count: *mut usize,
) -> BowknotStatus {
    // SAFETY: by the contract.
    unsafe { vertices_of(simulator, triangles, count, |topology| topology.triangles.concat()) }
}

/// Writes the vertices of the edges of strands, two for each, as `bowknot_simulator_triangles` does triangles.
///
/// # Safety
/// As for `bowknot_simulator_triangles`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn bowknot_simulator_edges(
    simulator: *const BowknotSimulator,
    edges: *mut u32,
    count: *mut usize,
) -> BowknotStatus {
    let all = |topology: &Topology| {
        topology.strand_edges.iter().flat_map(|&e| topology.edges[e as usize]).collect()
    };
    // SAFETY: by the contract.
    unsafe { vertices_of(simulator, edges, count, all) }
}

/// How many bodies and obstacles with a mesh there are.
///
/// # Safety
/// The handle is null, for which there are none, or that of a simulation.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn bowknot_simulator_bodies(simulator: *const BowknotSimulator) -> usize {
    // SAFETY: by the contract.
    unsafe { simulator.as_ref() }.map_or(0, |simulator| simulator.names.len())
}

/// Tells of the body or obstacle of an `index`.
///
/// # Safety
/// The handle is that of a simulation; `body` points to a `BowknotBody`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn bowknot_simulator_body(
    simulator: *const BowknotSimulator,
    index: usize,
    body: *mut BowknotBody,
) -> BowknotStatus {
    guarded(|| {
        // SAFETY: by the contract.
        let (simulator, out) = unsafe { (shared("simulator", simulator)?, exclusive("body", body)?) };
        let bodies = &simulator.inner.world().bodies;
        let found = bodies.get(index).zip(simulator.names.get(index));
        let (found, name) =
            found.ok_or_else(|| input(format!("body {index}, but there are {}", bodies.len())))?;
        *out = BowknotBody {
            name: name.as_ptr(),
            first_vertex: found.vertices.start,
            vertices: found.vertices.len() as u32,
            is_obstacle: found.kind.is_none(),
        };
        Ok(())
    })
}

/// Adds a pin that holds `count` vertices of a body where they are. They are numbered as in the body's mesh, from 0.
///
/// # Safety
/// The handle is that of a simulation; the texts end with a zero; the array has so many entries.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn bowknot_simulator_add_pin(
    simulator: *mut BowknotSimulator,
    name: *const c_char,
    body: *const c_char,
    vertices: *const u32,
    count: usize,
) -> BowknotStatus {
    guarded(|| {
        // SAFETY: by the contract.
        unsafe {
            let (name, body) = (text("name", name)?, text("body", body)?);
            let vertices = array("vertices", vertices, count)?;
            Ok(exclusive("simulator", simulator)?.inner.add_pin(name, body, vertices)?)
        }
    })
}

/// Leads the vertices of a pin to `targets` at the end of the next time step: x y z for each of its vertices [m], `count`
/// numbers together. They go there without cutting through anything, and wait where they cannot.
///
/// # Safety
/// As for `bowknot_simulator_add_pin`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn bowknot_simulator_set_pin_targets(
    simulator: *mut BowknotSimulator,
    name: *const c_char,
    targets: *const f64,
    count: usize,
) -> BowknotStatus {
    // SAFETY: by the contract.
    unsafe { lead(simulator, name, targets, count, Simulator::set_pin_targets) }
}

/// Removes a pin.
///
/// # Safety
/// The handle is that of a simulation; the text ends with a zero.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn bowknot_simulator_remove_pin(
    simulator: *mut BowknotSimulator,
    name: *const c_char,
) -> BowknotStatus {
    guarded(|| {
        // SAFETY: by the contract.
        unsafe { Ok(exclusive("simulator", simulator)?.inner.remove_pin(text("name", name)?)?) }
    })
}

/// Leads an obstacle: x y z of each vertex of its mesh at the end of the next time step [m], `count` numbers together.
///
/// # Safety
/// As for `bowknot_simulator_add_pin`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn bowknot_simulator_set_obstacle_targets(
    simulator: *mut BowknotSimulator,
    name: *const c_char,
    targets: *const f64,
    count: usize,
) -> BowknotStatus {
    // SAFETY: by the contract.
    unsafe { lead(simulator, name, targets, count, Simulator::set_obstacle_targets) }
}

/// Sets the acceleration of gravity [m/s^2].
///
/// # Safety
/// The handle is that of a simulation.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn bowknot_simulator_set_gravity(
    simulator: *mut BowknotSimulator,
    x: f64,
    y: f64,
    z: f64,
) -> BowknotStatus {
    guarded(|| {
        // SAFETY: by the contract.
        Ok(unsafe { exclusive("simulator", simulator)? }.inner.set_gravity(Vector::new(x, y, z))?)
    })
}

/// Judges the present state with exact arithmetic: how many pairs intersect is written to `count`.
///
/// # Safety
/// The handle is that of a simulation; `count` points to a number.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn bowknot_simulator_intersections(
    simulator: *const BowknotSimulator,
    count: *mut usize,
) -> BowknotStatus {
    guarded(|| {
        // SAFETY: by the contract.
        let (simulator, count) = unsafe { (shared("simulator", simulator)?, exclusive("count", count)?) };
        let inner = &simulator.inner;
        let positions = &inner.positions()[..inner.world().collision_vertices()];
        let options = StateOptions { limit: 0, distance: false };
        *count = inner.judge().check_state(positions, &options).map_err(input)?.intersection_count;
        Ok(())
    })
}

/// Writes x y z of each vertex to an array with room for `count` numbers.
///
/// # Safety
/// As for `bowknot_simulator_positions`.
unsafe fn rows(
    simulator: *const BowknotSimulator,
    array: *mut f64,
    count: usize,
    rows: impl FnOnce(&Simulator) -> Vec<f64>,
) -> BowknotStatus {
    guarded(|| {
        // SAFETY: by the contract.
        unsafe {
            // NULL, by which other calls only count, is refused: the caller knows the count.
            let (simulator, _) = (shared("simulator", simulator)?, exclusive("the array", array)?);
            write("the array", &rows(&simulator.inner), array, count, std::ptr::null_mut())
        }
    })
}

/// Writes the vertices of elements.
///
/// # Safety
/// As for `bowknot_simulator_triangles`.
unsafe fn vertices_of(
    simulator: *const BowknotSimulator,
    array: *mut u32,
    count: *mut usize,
    elements: impl FnOnce(&Topology) -> Vec<u32>,
) -> BowknotStatus {
    guarded(|| {
        // SAFETY: by the contract.
        unsafe {
            let (simulator, room) = (shared("simulator", simulator)?, *exclusive("count", count)?);
            write("the array", &elements(simulator.inner.world().collision.topology()), array, room, count)
        }
    })
}

/// Leads a pin or an obstacle.
///
/// # Safety
/// As for `bowknot_simulator_set_pin_targets`.
unsafe fn lead(
    simulator: *mut BowknotSimulator,
    name: *const c_char,
    targets: *const f64,
    count: usize,
    lead: impl FnOnce(&mut Simulator, &str, &[Point]) -> Result<(), DriveError>,
) -> BowknotStatus {
    guarded(|| {
        // SAFETY: by the contract.
        unsafe {
            let (name, targets) =
                (text("name", name)?, points("targets", array("targets", targets, count)?)?);
            Ok(lead(&mut exclusive("simulator", simulator)?.inner, name, &targets)?)
        }
    })
}
