//! What is fixed for a scene, as the device needs it.

use crate::grid::Grid;
use crate::layout::{Block, NONE, PairFriction, Plane, Vertex};
use bowknot_geometry::{CollisionModel, HalfSpace};

/// Lengths of a scene [m].
#[derive(Clone, Copy, Debug)]
pub struct Lengths<'a> {
    /// Local edge length of each vertex.
    pub edges: &'a [f64],
    /// Half of the largest contact range of a pair with each vertex.
    pub margins: &'a [f64],
    /// Desired distance of the contacts of each vertex with others like it.
    pub deltas: &'a [f64],
    /// Desired distance of the contacts of each vertex with half-spaces that have no thickness. May be empty: as
    /// with others like it.
    pub half_space_deltas: &'a [f64],
    /// Thickness of the body of each vertex, a guaranteed minimum separation; none where it is not a number.
    /// May be empty: no body has any.
    pub thicknesses: &'a [f64],
    /// Thickness of each half-space, likewise.
    pub half_space_thicknesses: &'a [f64],
    /// No step makes a gap between bodies without a thickness smaller than this, nor smaller than a tenth of
    /// the pair's desired distance if that is less.
    pub min_separation: f64,
    /// Largest length of each edge of the topology, infinite for no limit. May be empty: no edge has one.
    pub edge_limits: &'a [f64],
}

/// How vertices move, and what slows them down.
#[derive(Clone, Copy, Debug, Default)]
pub struct Constraints<'a> {
    /// Whether each vertex is prescribed, those of obstacles included.
    pub prescribed: &'a [bool],
    /// The group of each vertex, [`NONE`] for none: its vertices move by one fraction of their displacements.
    /// Each obstacle has one of its own in any case.
    pub groups: &'a [u32],
    /// Mass of each vertex, above 0 for those that are not prescribed. May be empty: all have the same.
    pub masses: &'a [f64],
    /// Coefficient of friction of the body of each vertex; of a contact counts the geometric mean of both
    /// sides'. May be empty: there is no friction.
    pub frictions: &'a [f64],
    /// Coefficient of friction of each half-space. May be empty.
    pub half_space_frictions: &'a [f64],
    /// Coefficients of friction that two sides have with each other instead, each pair once. A side is a
    /// body, or a half-space, whose numbers follow those of the bodies. May be empty.
    pub pair_frictions: &'a [([u32; 2], f64)],
}

/// The static data of the vertices, and behind them that of the half-spaces.
pub(crate) fn vertices(
    model: &CollisionModel,
    lengths: &Lengths<'_>,
    constraints: &Constraints<'_>,
    grid: &Grid,
) -> Vec<Vertex> {
    let bodies = model.bodies();
    let deformable = |v: &usize| !model.is_obstacle(*v as u32);
    let masses: Vec<f64> =
        (0..constraints.masses.len()).filter(deformable).map(|v| constraints.masses[v]).collect();
    let mean_mass = masses.iter().sum::<f64>() / masses.len().max(1) as f64;
    let group_count = constraints.groups.iter().filter(|g| **g != NONE).max().map_or(0, |last| last + 1);
    let vertex = |v: usize| {
        let body = model.vertex_body()[v];
        let filter = &bodies[body as usize];
        let prescribed = filter.obstacle || constraints.prescribed.get(v).is_some_and(|p| *p);
        let group = if filter.obstacle {
            group_count + body
        } else {
            constraints.groups.get(v).copied().unwrap_or(NONE)
        };
        Vertex {
            edge: grid.length(lengths.edges[v]),
            // Rounded up.
            margin: grid.length(lengths.margins[v]).next_up(),
            body,
            flags: [
                (filter.obstacle, Vertex::OBSTACLE),
                (prescribed, Vertex::PRESCRIBED),
                (filter.self_collision, Vertex::SELF_COLLIDES),
            ]
            .into_iter()
            .fold(0, |flags, (holds, flag)| if holds { flags | flag } else { flags }),
            groups: filter.groups,
            mask: filter.mask,
            group,
            delta: grid.length(lengths.deltas[v]),
            half_space_delta: grid.length(*lengths.half_space_deltas.get(v).unwrap_or(&lengths.deltas[v])),
            thickness: thickness(grid, lengths.thicknesses.get(v)),
            mass: constraints.masses.get(v).map_or(1.0, |mass| (mass / mean_mass) as f32),
            root_of_friction: root(constraints.frictions.get(v)),
        }
    };
    let half_space = |h: usize| Vertex {
        body: (bodies.len() + h) as u32,
        thickness: thickness(grid, lengths.half_space_thicknesses.get(h)),
        root_of_friction: root(constraints.half_space_frictions.get(h)),
        ..Vertex::default()
    };
    let half_spaces = (0..model.half_spaces().len()).map(half_space);
    (0..model.topology().vertex_count).map(vertex).chain(half_spaces).collect()
}

/// Rounded up; below 0 for none.
fn thickness(grid: &Grid, thickness: Option<&f64>) -> f32 {
    thickness.filter(|t| **t >= 0.0).map_or(-1.0, |t| grid.length(*t).next_up())
}

/// The friction of pairs, sorted by their sides.
pub(crate) fn pair_frictions(constraints: &Constraints<'_>) -> Vec<PairFriction> {
    let pair = |&([a, b], coefficient): &([u32; 2], f64)| PairFriction {
        a: a.min(b),
        b: a.max(b),
        coefficient: coefficient as f32,
    };
    let mut pairs: Vec<PairFriction> = constraints.pair_frictions.iter().map(pair).collect();
    pairs.sort_by_key(|pair| [pair.a, pair.b]);
    pairs
}

/// The half-spaces. Their points are those of the planes that are nearest to the middle of the grid; a plane
/// outside of the grid, which nothing touches, is moved to a place inside of it that is as good.
pub(crate) fn planes(model: &CollisionModel, grid: &Grid) -> Vec<Plane> {
    let middle = grid.position([0; 3]);
    let farthest = f64::from(1 << 28) * grid.quantum();
    let plane = |plane: &HalfSpace| {
        let length = plane.normal.norm();
        let normal = plane.normal / length;
        let height = (plane.normal.dot(&middle.coords) - plane.offset) / length;
        let point = middle - normal * height.clamp(-farthest, farthest);
        Plane {
            normal: [normal.x as f32, normal.y as f32, normal.z as f32],
            // Each coordinate of the normal is off by 2^-25, the height by four roundings of 2^-24 more.
            rounding: 8.0 * f32::EPSILON,
            point: grid.nearest(&point).unwrap_or([0; 3]),
            padding: 0,
        }
    };
    model.half_spaces().iter().map(plane).collect()
}

fn root(friction: Option<&f64>) -> f32 {
    friction.map_or(0.0, |friction| friction.sqrt() as f32)
}

/// Blocks of successive vertices of one body.
pub(crate) fn blocks(model: &CollisionModel) -> Vec<Block> {
    let mut blocks: Vec<Block> = Vec::new();
    for (v, &body) in (0..).zip(model.vertex_body()) {
        match blocks.last_mut() {
            Some(last) if last.body == body && (last.count as usize) < Block::MOST => last.count += 1,
            _ => blocks.push(Block { first: v, count: 1, body }),
        }
    }
    blocks
}
