//! Which pairs of bodies may collide.

use bowknot_geometry::CollisionModel;

/// A summary of which pairs of bodies may collide: trees of bodies that never collide are not searched.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct CollisionMatrix {
    /// Whether primitives of deformable bodies may collide with each other.
    pub deformable: bool,
    /// Whether a primitive of a deformable body may collide with an obstacle.
    pub obstacle: bool,
    /// Whether some pairs of bodies that are searched together may not collide.
    pub some_forbidden: bool,
}

impl CollisionMatrix {
    /// The summary of a model's bodies.
    pub fn new(model: &CollisionModel) -> Self {
        let mut filters: Vec<_> =
            model.bodies().iter().map(|b| (b.obstacle, b.groups, b.mask, b.self_collision)).collect();
        filters.sort_unstable();
        filters.dedup();
        let mut matrix = Self::default();
        for a in filters.iter().filter(|a| !a.0) {
            matrix.deformable |= a.3;
            matrix.some_forbidden |= !a.3;
            // A filter is also compared with itself. If only one body has it, this may cost time but loses no
            // pair.
            for b in &filters {
                let allowed = a.1 & b.2 != 0 && b.1 & a.2 != 0;
                matrix.some_forbidden |= !allowed;
                if b.0 {
                    matrix.obstacle |= allowed;
                } else {
                    matrix.deformable |= allowed;
                }
            }
        }
        matrix
    }
}
