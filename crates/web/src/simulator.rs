//! Simulations: time steps, and what can be read between them.

use crate::arrays;
use crate::error::{self, Thrown, input};
use crate::options::object;
use crate::scene::Scene;
use bowknot::check::{MotionJudge, StateOptions};
use bowknot::geometry::Identity;
use bowknot::simulator::describe_intersections;
use bowknot::world::WorldBody;
use js_sys::{Float64Array, Uint32Array};
use serde::Serialize;
use wasm_bindgen::JsValue;
use wasm_bindgen::prelude::wasm_bindgen;

/// Most intersections that a verdict names.
const NAMED: usize = 10;

/// A running simulation.
#[wasm_bindgen]
pub struct Simulator {
    pub(crate) inner: bowknot::Simulator,
    judge: Option<KeptJudge>,
}

/// A judge that keeps its trees from one state to the next, and what it was made for.
struct KeptJudge {
    judge: MotionJudge,
    model: Identity,
    present: Vec<bool>,
}

/// The state of a simulation between two time steps.
#[wasm_bindgen]
pub struct Checkpoint {
    state: bowknot::simulator::Checkpoint,
}

#[wasm_bindgen]
impl Checkpoint {
    /// Time steps made.
    #[wasm_bindgen(getter)]
    pub fn step(&self) -> usize {
        self.state.step
    }
}

/// A body of the simulation.
#[derive(Serialize)]
struct BodyInfo<'a> {
    name: &'a str,
    kind: &'static str,
    start: u32,
    end: u32,
}

/// What the judge says.
#[derive(Serialize)]
struct Verdict {
    count: usize,
    intersections: Vec<String>,
}

#[wasm_bindgen]
impl Simulator {
    /// Puts the scene's meshes together. A start that intersects is refused.
    #[wasm_bindgen(constructor)]
    pub fn new(scene: &Scene) -> Result<Simulator, Thrown> {
        let inner = bowknot::Simulator::new(&scene.scene).map_err(error::simulation)?;
        Ok(Self { inner, judge: None })
    }

    /// Makes one time step, and says what it did. An error leaves the state as it was.
    #[wasm_bindgen(unchecked_return_type = "StepStatistics")]
    pub fn step(&mut self) -> Result<JsValue, Thrown> {
        object(&self.inner.step().map_err(error::simulation)?)
    }

    /// Whether time steps measure energies and the like, which they do not need. True at first.
    #[wasm_bindgen(js_name = setMeasured)]
    pub fn set_measured(&mut self, measured: bool) {
        self.inner.set_measured(measured);
    }

    /// Time of the state [s].
    #[wasm_bindgen(getter)]
    pub fn time(&self) -> f64 {
        self.inner.time()
    }

    /// Time steps made.
    #[wasm_bindgen(getter, js_name = stepIndex)]
    pub fn step_index(&self) -> usize {
        self.inner.step_index()
    }

    /// The time step [s].
    #[wasm_bindgen(getter, js_name = timeStep)]
    pub fn time_step(&self) -> f64 {
        self.inner.scene().simulation.dt
    }

    /// Distance at which surfaces begin to press on each other [m].
    #[wasm_bindgen(getter, js_name = contactDistance)]
    pub fn contact_distance(&self) -> f64 {
        let resolver = self.inner.resolver().scene();
        let own = resolver.contact().bodies().iter().filter_map(|body| body.delta);
        own.min_by(f64::total_cmp).unwrap_or(resolver.lengths().delta)
    }

    /// A copy of the positions, x y z of each vertex [m]: of deformable bodies, then of obstacles, then inside of solids.
    #[wasm_bindgen(getter)]
    pub fn positions(&self) -> Float64Array {
        arrays::from_points(self.inner.positions())
    }

    /// A copy of the velocities [m/s], likewise.
    #[wasm_bindgen(getter)]
    pub fn velocities(&self) -> Float64Array {
        arrays::from_vectors(self.inner.velocities())
    }

    /// Vertices of the triangles, three for each.
    #[wasm_bindgen(getter)]
    pub fn triangles(&self) -> Uint32Array {
        let topology = self.inner.world().collision.topology();
        arrays::from_elements(topology.triangles.iter().copied())
    }

    /// Vertices of the edges of strands, two for each.
    #[wasm_bindgen(getter)]
    pub fn edges(&self) -> Uint32Array {
        let topology = self.inner.world().collision.topology();
        arrays::from_elements(topology.strand_edges.iter().map(|&e| topology.edges[e as usize]))
    }

    /// Vertices that are particles.
    #[wasm_bindgen(getter)]
    pub fn particles(&self) -> Uint32Array {
        Uint32Array::from(self.inner.world().collision.topology().particles.as_slice())
    }

    /// Half-spaces: normal and offset [m] of each, four numbers.
    #[wasm_bindgen(getter)]
    pub fn planes(&self) -> Float64Array {
        let planes = self.inner.world().collision.half_spaces().iter();
        arrays::from_rows(planes.map(|plane| [plane.normal.x, plane.normal.y, plane.normal.z, plane.offset]))
    }

    /// The bodies and obstacles with a mesh. Vertices inside of solids are in none of their ranges.
    #[wasm_bindgen(getter, unchecked_return_type = "BodyInfo[]")]
    pub fn bodies(&self) -> Result<JsValue, Thrown> {
        fn info(body: &WorldBody) -> BodyInfo<'_> {
            let kind = body.kind.map_or("obstacle", |kind| kind.name());
            BodyInfo { name: &body.name, kind, start: body.vertices.start, end: body.vertices.end }
        }
        object(&self.inner.world().bodies.iter().map(info).collect::<Vec<_>>())
    }

    /// For each vertex of the mesh of a body its number in `positions`, or -1 if no element names it.
    #[wasm_bindgen(js_name = meshOrder)]
    pub fn mesh_order(&self, body: &str) -> Result<Vec<i32>, Thrown> {
        let world = self.inner.world();
        let index = world.index_of(body).ok_or_else(|| input(format!("no body {body}")))?;
        let order = world.bodies[index].mesh_order();
        Ok(order.into_iter().map(|v| v.map_or(-1, |v| v as i32)).collect())
    }

    /// Judges the present state with exact arithmetic.
    #[wasm_bindgen(unchecked_return_type = "Verdict")]
    pub fn check(&mut self) -> Result<JsValue, Thrown> {
        let Self { inner, judge, .. } = self;
        let (model, present) = (inner.world().collision.identity(), inner.present());
        // Other elements, or obstacles that have come or gone.
        if judge.as_ref().is_some_and(|kept| kept.model != model || kept.present != present) {
            *judge = None;
        }
        let kept = judge.get_or_insert_with(|| KeptJudge {
            judge: MotionJudge::new(inner.judge()),
            model,
            present: present.to_vec(),
        });
        let positions = &inner.positions()[..inner.world().collision_vertices()];
        let options = StateOptions { limit: NAMED, distance: false };
        let report = kept.judge.check_state(positions, &options).map_err(input)?;
        let intersections = describe_intersections(inner.world(), &report.intersections);
        object(&Verdict { count: report.intersection_count, intersections })
    }

    /// The scene as it is now.
    pub fn scene(&self) -> Scene {
        Scene { scene: self.inner.scene().clone() }
    }

    /// The present state, to go on from later.
    pub fn checkpoint(&self) -> Checkpoint {
        Checkpoint { state: self.inner.checkpoint() }
    }

    /// Goes on from a state of a simulation of the same scene.
    pub fn restore(&mut self, checkpoint: &Checkpoint) -> Result<(), Thrown> {
        self.inner.restore(&checkpoint.state).map_err(|source| error::simulation(source.into()))
    }
}
