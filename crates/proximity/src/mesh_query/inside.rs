//! Whether a point is inside of a closed mesh: the exact winding number.

use super::descend::{Placed, Probe, descend};
use super::local_point::local_box;
use crate::min_max::larger;
use crate::tree::{LANES, Node};
use bowknot_geometry::{Point, intersection};

struct Column<'a> {
    mesh: Placed<'a>,
    point: &'a Point,
    /// A box around the point, in the local frame.
    low: [f32; 3],
    high: [f32; 3],
    winding: i64,
    on_surface: bool,
}

/// Whether the surface winds around the point, or contains it; `None` for a point without a place.
pub fn is_inside(mesh: Placed<'_>, point: &Point) -> Option<bool> {
    let [low, high] = local_box(point, &mesh.origin)?;
    let mut column = Column { mesh, point, low, high, winding: 0, on_surface: false };
    descend(mesh.tree, &mut column);
    Some(column.on_surface || column.winding != 0)
}

impl Probe for Column<'_> {
    /// 0 for boxes that the ray upward meets.
    #[inline(always)]
    fn bounds(&self, node: &Node) -> [f64; LANES] {
        let mut outside = [0.0; LANES];
        for lane in 0..LANES {
            let x = larger(node.low[0][lane] - self.high[0], self.low[0] - node.high[0][lane]);
            let y = larger(node.low[1][lane] - self.high[1], self.low[1] - node.high[1][lane]);
            let z = self.low[2] - node.high[2][lane];
            outside[lane] = larger(larger(x, y), z);
        }
        outside.map(|gap| if gap > 0.0 { f64::INFINITY } else { 0.0 })
    }

    fn limit(&self) -> f64 {
        if self.on_surface { -1.0 } else { 0.0 }
    }

    fn visit(&mut self, _: u32, vertices: [u32; 3]) {
        let corners = self.mesh.corners(vertices);
        if intersection::point_on_triangle(self.point, corners) {
            self.on_surface = true;
        } else {
            self.winding += i64::from(intersection::upward_crossing(self.point, corners));
        }
    }
}
