//! A scene's meshes, loaded and put together.
//!
//! The vertices of a world stand in this order:
//!
//! | vertices | who knows them |
//! |---|---|
//! | of deformable bodies that collide: cloth, the surface of solids, strands, particles | all |
//! | of obstacles | all |
//! | inside of solids | the dynamics alone |
//!
//! The collision model, the judge and the frames cover the first two groups, [`World::collision_vertices`] of
//! them.

mod assemble;
mod follow;
mod jumps;
mod motion;
mod part;
mod pins;
mod presence;
mod roots;
mod sequence;
mod size;
mod thickness;
mod unused;

pub use follow::Attachment;
pub use motion::{ObstacleMotion, Placing, Procedural, Sequence};
pub use presence::Presence;
pub use size::BodySize;

use crate::description::Scene;
use crate::error::SceneError;
use crate::kind::BodyKind;
use crate::motion::Motion;
use bowknot_dynamics::{Body, DynamicsModel};
use bowknot_geometry::{BodyFilter, HalfSpace, Point, TETRAHEDRON_EDGES, Vector};
use bowknot_io::{Groups, Surface};
use bowknot_proximity::CollisionModel;
use bowknot_twoway::ContactData;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// A scene's bodies over one array of vertices.
#[derive(Clone, Debug)]
pub struct World {
    /// Deformable bodies, then obstacles with a mesh, each in the scene's order.
    pub bodies: Vec<WorldBody>,
    /// Names of the half-spaces, in the order of [`CollisionModel::half_spaces`].
    pub half_space_names: Vec<String>,
    /// When the half-spaces are there, in the same order.
    pub half_space_presence: Vec<Presence>,
    /// Number of deformable vertices that collide; those of obstacles follow.
    pub deformable_vertices: usize,
    /// Positions of all vertices at time 0 [m].
    pub positions: Vec<Point>,
    /// Velocities at time 0 [m/s].
    pub velocities: Vec<Vector>,
    /// Topology, bodies, filters, half-spaces, with all obstacles there.
    pub collision: CollisionModel,
    /// Contact data of the bodies and half-spaces of the collision model.
    pub contact: ContactData,
    /// The bodies for the dynamics, in the order of `bodies`.
    pub materials: Vec<Body>,
    /// Held or led vertices.
    pub pins: Vec<Pin>,
    /// What was repaired or left out on the way, what speaks for a wrong unit, and keys without effect, in
    /// words.
    pub warnings: Vec<String>,
    /// Positions of obstacle vertices without their motion [m]; of the other vertices that collide, those at
    /// time 0.
    pub base: Vec<Point>,
}

/// A body of a [`World`].
#[derive(Clone, Debug)]
pub struct WorldBody {
    /// Its name.
    pub name: String,
    /// What it is made of; `None` for an obstacle.
    pub kind: Option<BodyKind>,
    /// Its vertices that collide.
    pub vertices: Range<u32>,
    /// Its vertices inside of a solid, or the frame points of its rods: what the dynamics alone knows.
    pub interior: Range<u32>,
    /// Its tetrahedra, of positive volume at time 0, if it is a solid; eight of each quadratic one.
    pub tets: Vec<[u32; 4]>,
    /// Its quadratic tetrahedra, if it is a solid of such: corners, then the middles of the edges 01, 02, 03,
    /// 12, 13, 23.
    pub quadratic_tets: Vec<[u32; 10]>,
    /// Its edges with their frame points, if it is made of strands that resist twist, see
    /// [`bowknot_geometry::add_frame_points`].
    pub rods: Vec<[u32; 3]>,
    /// Its edges, if it is made of strands.
    pub strands: Vec<[u32; 2]>,
    /// What its mesh says about its faces, over its own vertices: polygons whose fans are its triangles.
    pub surface: Option<Surface>,
    /// Named sets of vertices, by their numbers in the mesh.
    pub groups: Groups,
    /// How it moves, if it is an obstacle.
    pub motion: ObstacleMotion,
    /// When it is there, if it is an obstacle.
    pub presence: Presence,
    /// Number in the mesh of each vertex but frame points, `vertices` first.
    numbers: Vec<u32>,
    /// Vertices that the mesh has, those left out counted.
    mesh_vertices: usize,
}

impl WorldBody {
    /// The edges of its quadratic tetrahedra, by the vertices at their ends, with those in their middles;
    /// some more than once.
    fn middles(&self) -> impl Iterator<Item = ([u32; 2], u32)> + '_ {
        self.quadratic_tets.iter().flat_map(|tet| {
            TETRAHEDRON_EDGES.iter().zip(&tet[4..]).map(|([i, j], &v)| ([tet[*i], tet[*j]], v))
        })
    }

    /// Its vertices, those inside of a solid and frame points last.
    pub fn all_vertices(&self) -> impl Iterator<Item = u32> + Clone + use<> {
        self.vertices.clone().chain(self.interior.clone())
    }

    /// The frame points of the edges whose ends are both among the vertices `held`, in ascending order, so that what holds
    /// these holds their twist.
    pub fn frame_points_between(&self, mut held: Vec<u32>) -> impl Iterator<Item = u32> + '_ {
        held.sort_unstable();
        let is_held = move |v: &u32| held.binary_search(v).is_ok();
        self.rods.iter().filter(move |rod| rod[..2].iter().all(&is_held)).map(|rod| rod[2])
    }

    /// Its vertices but frame points, which its mesh does not have.
    pub fn own_vertices(&self) -> impl Iterator<Item = u32> + Clone + use<> {
        self.all_vertices().take(self.numbers.len())
    }

    /// Its vertices in the order of the mesh that it was made of, without frame points; none for those that no element names, which
    /// are left out.
    pub fn mesh_order(&self) -> Vec<Option<u32>> {
        let mut order = vec![None; self.mesh_vertices];
        self.own_vertices().for_each(|v| order[self.mesh_number(v) as usize] = Some(v));
        order
    }

    /// Number of one of its vertices in the mesh that it was made of, from 0.
    pub fn mesh_number(&self, vertex: u32) -> u32 {
        let local = if vertex < self.vertices.end {
            vertex.checked_sub(self.vertices.start)
        } else {
            vertex.checked_sub(self.interior.start).map(|v| v + self.vertices.len() as u32)
        };
        local.and_then(|local| self.numbers.get(local as usize)).copied().unwrap_or(vertex)
    }
}

/// Held or led vertices of a body.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Pin {
    /// Its name in reports, such as `pin[0] of sheet`.
    pub name: String,
    /// The vertices.
    pub vertices: Vec<u32>,
    /// How they move.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub motion: Option<Motion>,
    /// The body, an obstacle, whose surface they follow; then there is no motion.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub follow: Option<u32>,
    /// When the pin takes hold [s].
    pub start: f64,
    /// When it lets go [s].
    #[serde(default = "never", skip_serializing_if = "is_never")]
    pub end: f64,
}

/// The end of what has none. Formats such as JSON have no infinity, so it is left out.
fn never() -> f64 {
    f64::INFINITY
}

fn is_never(time: &f64) -> bool {
    *time == never()
}

/// Counts of a scene, as `bowknot info --json` prints them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SceneInfo {
    /// Deformable vertices, those inside of solids included.
    pub vertices: usize,
    /// Edges of deformable bodies that collide.
    pub edges: usize,
    /// Triangles of deformable bodies: of cloth, and of the surfaces of solids.
    pub triangles: usize,
    /// Tetrahedra; a quadratic one counts as eight.
    pub tets: usize,
    /// Quadratic tetrahedra.
    pub quadratic_tets: usize,
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

impl Pin {
    /// Whether it holds its vertices at the end of a time step, at `time` [s].
    pub fn holds(&self, time: f64, dt: f64) -> bool {
        // Times are multiples of dt, rounded.
        let tolerance = 1e-9 * dt;
        self.start < time - tolerance && time <= self.end + tolerance
    }
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

impl World {
    /// Number of vertices that collide: all but those inside of solids. They come first.
    pub fn collision_vertices(&self) -> usize {
        self.collision.topology().vertex_count
    }

    fn obstacle_vertices(&self) -> usize {
        self.collision_vertices() - self.deformable_vertices
    }

    /// Index of the body of a name, an obstacle included.
    pub fn index_of(&self, name: &str) -> Option<usize> {
        self.bodies.iter().position(|body| body.name == name)
    }

    /// Which bodies, then which half-spaces, are to be there at `time`, a multiple of the time step `dt` [s].
    pub fn present(&self, time: f64, dt: f64) -> Vec<bool> {
        let bodies = self.bodies.iter().map(|body| &body.presence);
        bodies.chain(&self.half_space_presence).map(|presence| presence.holds(time, dt)).collect()
    }

    /// The names of bodies, then of half-spaces.
    pub fn names(&self) -> impl Iterator<Item = &String> {
        self.bodies.iter().map(|body| &body.name).chain(&self.half_space_names)
    }

    /// Filters of the bodies, and half-spaces, of which those are absent that are not `present`: one entry
    /// per body, then one per half-space.
    pub fn filters(&self, present: &[bool]) -> (Vec<BodyFilter>, Vec<HalfSpace>) {
        let (bodies, half_spaces) = present.split_at(self.bodies.len());
        let body = |(filter, present): (&BodyFilter, &bool)| if *present { *filter } else { filter.absent() };
        let plane = |(plane, present): (&HalfSpace, &bool)| if *present { *plane } else { plane.absent() };
        let filters = self.collision.bodies().iter().zip(bodies).map(body).collect();
        (filters, self.collision.half_spaces().iter().zip(half_spaces).map(plane).collect())
    }

    /// The collision model with those absent that are not `present`, as for [`Self::filters`].
    pub fn collision_of(&self, present: &[bool]) -> CollisionModel {
        let mut model = self.collision.clone();
        let (filters, half_spaces) = self.filters(present);
        model.set_filters(&filters, &half_spaces);
        model
    }

    /// Counts.
    pub fn info(&self, time_step: f64) -> SceneInfo {
        let topology = self.collision.topology();
        let deformable = |v: u32| (v as usize) < self.deformable_vertices;
        let (low, high) = self.bounds();
        SceneInfo {
            vertices: self.bodies.iter().filter(|b| b.kind.is_some()).map(|b| b.own_vertices().count()).sum(),
            edges: topology.edges.iter().filter(|e| deformable(e[0])).count(),
            triangles: topology.triangles.iter().filter(|t| deformable(t[0])).count(),
            tets: self.bodies.iter().map(|body| body.tets.len()).sum(),
            quadratic_tets: self.bodies.iter().map(|body| body.quadratic_tets.len()).sum(),
            strand_edges: topology
                .strand_edges
                .iter()
                .filter(|&&e| deformable(topology.edges[e as usize][0]))
                .count(),
            particles: topology.particles.iter().filter(|&&v| deformable(v)).count(),
            obstacle_vertices: self.obstacle_vertices(),
            time_step,
            extent: (high - low).into(),
        }
    }

    /// The names of the bodies whose dynamics the CPU alone computes, each with what it has and what it needs instead,
    /// see [`bowknot_dynamics::BodyShape::only_on_cpu`].
    pub fn bodies_only_on_cpu(&self) -> impl Iterator<Item = (&str, [&'static str; 2])> {
        self.materials.iter().filter_map(|body| Some((body.name.as_str(), body.shape.only_on_cpu()?)))
    }

    /// The size of each body and of each obstacle with a mesh, in their order.
    pub fn sizes(&self) -> Vec<BodySize> {
        let size = |body: &WorldBody| {
            let own: Vec<Point> = body.own_vertices().map(|v| self.positions[v as usize]).collect();
            let (low, high) = bounds(&own);
            BodySize {
                kind: body.kind,
                name: body.name.clone(),
                vertices: own.len(),
                extent: (high - low).into(),
            }
        };
        self.bodies.iter().map(size).collect()
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

    /// As [`Self::dynamics_model`], with bodies as obstacles where `is_obstacle` says so, by index of the
    /// body. Vertices have the same numbers.
    ///
    /// # Errors
    /// What the dynamics refuses, in words.
    pub fn dynamics_model_with_obstacles(
        &self,
        is_obstacle: impl Fn(usize) -> bool,
    ) -> Result<DynamicsModel, SceneError> {
        let material = |(index, material): (usize, &Body)| {
            if !is_obstacle(index) || material.shape.is_obstacle() {
                return material.clone();
            }
            let body = &self.bodies[index];
            Body::obstacle(&*body.name, body.vertices.clone().chain(body.interior.clone()).collect())
        };
        let materials = self.materials.iter().enumerate().map(material).collect();
        DynamicsModel::new(self.positions.clone(), materials).map_err(joined)
    }

    /// Ties the vertices of a pin that follows an obstacle, when they are at `homes`, to it: one entry
    /// per vertex, none where the obstacle has no triangle with an area.
    pub fn attach(&self, pin: &Pin, homes: &[Point]) -> Vec<Option<Attachment>> {
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
        match self.collision.vertex_body().get(vertex) {
            Some(&body) => self.name_of(body),
            None => {
                let inside = |body: &&WorldBody| body.interior.contains(&(vertex as u32));
                self.bodies.iter().find(inside).map_or("", |body| &body.name)
            }
        }
    }

    /// Name of a body by index; half-spaces and bodies that do not exist have none.
    pub fn name_of(&self, body: u32) -> &str {
        self.bodies.get(body as usize).map_or("", |b| &b.name)
    }
}

fn joined<E: ToString>(errors: impl IntoIterator<Item = E>) -> SceneError {
    let lines: Vec<String> = errors.into_iter().take(10).map(|error| error.to_string()).collect();
    SceneError::Model(lines.join("\n"))
}

fn bounds(positions: &[Point]) -> (Point, Point) {
    let start = positions.first().copied().unwrap_or_else(Point::origin);
    positions.iter().fold((start, start), |(low, high), p| (low.inf(p), high.sup(p)))
}
