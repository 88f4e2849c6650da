//! Which obstacles have moved since the last search.

use bowknot_geometry::{CollisionModel, Point, Vector};

/// Number of searches without motion after which an obstacle counts as being at rest. When an obstacle
/// changes its layer, both layers are rebuilt; so an obstacle that stops for a short time stays in the layer
/// of moving ones.
const REST_AFTER: u32 = 16;

/// Position, displacement and radius of a vertex in a search.
type VertexState = (Point, Vector, f64);

/// Compares the vertices of obstacles with those of the last search.
#[derive(Debug, Default)]
pub struct ObstacleTracker {
    /// Surface vertices of obstacles, ascending.
    vertices: Vec<u32>,
    /// State of each of these vertices in the last search.
    last: Vec<VertexState>,
    /// Number of searches since each body last moved. Obstacles start at rest.
    searches_at_rest: Vec<u32>,
    /// Whether each body has moved since the last search.
    moved: Vec<bool>,
    /// Whether each body is in the layer of moving obstacles.
    pub moving: Vec<bool>,
}

/// What has changed since the last search.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Changes {
    /// An obstacle has changed from one layer to the other.
    pub layers: bool,
    /// An obstacle in the layer of moving ones has moved.
    pub moved: bool,
}

impl ObstacleTracker {
    /// A tracker that takes all obstacles of `model` to be at rest.
    pub fn new(model: &CollisionModel) -> Self {
        let vertices: Vec<u32> =
            model.topology().surface_vertices.iter().copied().filter(|&v| model.is_obstacle(v)).collect();
        let bodies = model.bodies().len();
        Self {
            vertices,
            last: Vec::new(),
            searches_at_rest: vec![REST_AFTER; bodies],
            moved: vec![false; bodies],
            moving: vec![false; bodies],
        }
    }

    /// Compares the vertices of all obstacles with the last search and keeps their state for the next. A body
    /// has moved if a position, a radius or a displacement (of a swept search) has changed: each makes its
    /// boxes invalid.
    pub fn update(
        &mut self,
        model: &CollisionModel,
        positions: &[Point],
        displacements: Option<&[Vector]>,
        radii: &[f64],
    ) -> Changes {
        let state = |v: u32| -> VertexState {
            let v = v as usize;
            (positions[v], displacements.map_or(Vector::new(0.0, 0.0, 0.0), |u| u[v]), radii[v])
        };
        let is_first = self.last.is_empty();
        if is_first {
            self.last.extend(self.vertices.iter().map(|&v| state(v)));
        }
        self.moved.fill(false);
        for (&v, last) in self.vertices.iter().zip(&mut self.last) {
            let now = state(v);
            // A position that is not a number differs from itself, so its body never counts as being at rest;
            // this is safe. A vertex with a displacement moves, even along the same path as in the last
            // search: the boxes of obstacles at rest cover no motion.
            if *last != now || now.1 != Vector::new(0.0, 0.0, 0.0) {
                *last = now;
                self.moved[model.vertex_body()[v as usize] as usize] = true;
            }
        }
        let mut changes = Changes { layers: is_first && !self.vertices.is_empty(), moved: false };
        for ((filter, moved), (searches_at_rest, moving)) in
            model.bodies().iter().zip(&self.moved).zip(self.searches_at_rest.iter_mut().zip(&mut self.moving))
        {
            if !filter.obstacle {
                continue;
            }
            *searches_at_rest = if *moved { 0 } else { searches_at_rest.saturating_add(1) };
            changes.moved |= *moved;
            let moves = *moved || (*moving && *searches_at_rest < REST_AFTER);
            changes.layers |= moves != *moving;
            *moving = moves;
        }
        changes
    }
}
