//! The springs that callers describe contacts by.

use bowknot_geometry::Vector;

/// A contact between up to four vertices, as a spring.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RepulsionSpring {
    /// The vertices, of obstacles too. If there are fewer than four, fill up with any vertex and weight 0.
    pub vertices: [u32; 4],
    /// Their weights beta [1], barycentric: positive on the side that the normal points to, negative on the
    /// other side. For an upper limit of a distance the signs are reversed.
    pub weights: [f64; 4],
    /// Unit normal n [1].
    pub normal: Vector,
    /// Length that is subtracted from sum beta_i n.x_i to give the gap [m]: 0 between primitives, n.p for a
    /// half-space through p.
    pub offset: f64,
    /// Gap below which the spring pushes [m]. For an upper limit of a distance: minus that limit.
    pub desired: f64,
    /// Stiffness k in units of the bodies' own stiffness at the contact [1]: 1 / sum beta_i^2 / (n . H_ii n)
    /// over free vertices, with H_ii the diagonal blocks of the Newton system, inertia included. Springs of
    /// light bodies and of strands are softer.
    pub stiffness: f64,
    /// Coefficient of friction mu [1]; 0: the force is along the normal.
    pub friction: f64,
    /// Known force of the contact on the side that the normal points to [N]: its multipliers, lambda n + tau.
    pub force: Vector,
}
