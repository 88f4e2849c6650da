//! Which obstacles moved since they were last seen.

use bowknot_geometry::{CollisionModel, Point, Vector};

/// Searches without motion after which an obstacle counts as being at rest again. Each change of an
/// obstacle's layer makes two spatial orders anew, so one that waits now and then stays where it is.
const REST_AFTER: u32 = 16;

/// A vertex as it was last seen.
type Seen = (Point, Vector, f64);

/// Keeps watch over the obstacles' vertices.
#[derive(Debug, Default)]
pub struct Watch {
    vertices: Vec<u32>,
    seen: Vec<Seen>,
    /// Searches since each body last moved; obstacles start at rest.
    still_for: Vec<u32>,
    moved: Vec<bool>,
    /// Whether each body is in the layer of those that move.
    pub moving: Vec<bool>,
}

/// What changed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Changes {
    /// An obstacle went from one layer to the other.
    pub layers: bool,
    /// An obstacle in the layer of moving ones moved.
    pub moved: bool,
}

impl Watch {
    pub fn new(model: &CollisionModel) -> Self {
        let vertices: Vec<u32> =
            model.topology().surface_vertices.iter().copied().filter(|&v| model.is_obstacle(v)).collect();
        let bodies = model.bodies().len();
        Self {
            vertices,
            seen: Vec::new(),
            still_for: vec![REST_AFTER; bodies],
            moved: vec![false; bodies],
            moving: vec![false; bodies],
        }
    }

    /// Compares all obstacles' vertices with what was last seen. A motion, a changed radius and a
    /// displacement (of a swept search) count alike: each makes the boxes invalid.
    pub fn look(
        &mut self,
        model: &CollisionModel,
        positions: &[Point],
        displacements: Option<&[Vector]>,
        radii: &[f64],
    ) -> Changes {
        let state = |v: u32| -> Seen {
            let v = v as usize;
            (positions[v], displacements.map_or(Vector::new(0.0, 0.0, 0.0), |u| u[v]), radii[v])
        };
        let first_look = self.seen.is_empty();
        if first_look {
            self.seen.extend(self.vertices.iter().map(|&v| state(v)));
        }
        self.moved.fill(false);
        for (&v, seen) in self.vertices.iter().zip(&mut self.seen) {
            let now = state(v);
            // A vertex that is not a number always differs: safe, though never at rest. One that is swept moves, and
            // if along the same path as last time: boxes of obstacles at rest have no sweep.
            if *seen != now || now.1 != Vector::new(0.0, 0.0, 0.0) {
                *seen = now;
                self.moved[model.vertex_body()[v as usize] as usize] = true;
            }
        }
        let mut changes = Changes { layers: first_look && !self.vertices.is_empty(), moved: false };
        for ((filter, moved), (still_for, moving)) in
            model.bodies().iter().zip(&self.moved).zip(self.still_for.iter_mut().zip(&mut self.moving))
        {
            if !filter.obstacle {
                continue;
            }
            *still_for = if *moved { 0 } else { still_for.saturating_add(1) };
            changes.moved |= *moved;
            let moves = *moved || (*moving && *still_for < REST_AFTER);
            changes.layers |= moves != *moving;
            *moving = moves;
        }
        changes
    }
}
