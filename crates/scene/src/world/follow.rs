//! Pinned vertices that follow the surface of an obstacle, however it moves or deforms.

use bowknot_geometry::distance::vertex_triangle;
use bowknot_geometry::{Point, Vector};

/// A point's place relative to a triangle: in the frame of two of its edges and its normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Attachment {
    corners: [u32; 3],
    /// Along the first edge and the second [1], and along the unit normal [m].
    coordinates: Vector,
}

impl Attachment {
    /// Ties a point to the nearest of `triangles`, over `positions`; none without triangles of an area.
    pub fn new(x: &Point, triangles: &[[u32; 3]], positions: &[Point]) -> Option<Self> {
        let mut nearest = (f64::INFINITY, None);
        for &corners in triangles {
            let [a, b, c] = corners.map(|v| &positions[v as usize]);
            let distance = vertex_triangle(x, [a, b, c]).distance;
            if distance < nearest.0 {
                nearest = (distance, Some(corners));
            }
        }
        let corners = nearest.1?;
        let [first, second, normal] = frame(corners, positions)?;
        let offset = x - positions[corners[0] as usize];
        let inverse = nalgebra::Matrix3::from_columns(&[first, second, normal]).try_inverse()?;
        Some(Self { corners, coordinates: inverse * offset })
    }

    /// Where the point belongs; none if the triangle has lost its area.
    pub fn place(&self, positions: &[Point]) -> Option<Point> {
        let [first, second, normal] = frame(self.corners, positions)?;
        let [u, v, w] = self.coordinates.into();
        Some(positions[self.corners[0] as usize] + first * u + second * v + normal * w)
    }
}

fn frame(corners: [u32; 3], positions: &[Point]) -> Option<[Vector; 3]> {
    let [a, b, c] = corners.map(|v| positions[v as usize]);
    let normal = (b - a).cross(&(c - a)).try_normalize(0.0)?;
    Some([b - a, c - a, normal])
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Rotation3, Translation3};

    #[test]
    fn a_point_keeps_its_place_under_rigid_motion_and_follows_stretch() {
        let positions =
            [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.5]].map(Point::from).to_vec();
        let triangles = [[0, 1, 2], [1, 3, 2]];
        let x = Point::new(0.2, 0.1, 0.05);
        let attachment = Attachment::new(&x, &triangles, &positions).expect("a triangle");
        assert_eq!(attachment.corners, [0, 1, 2]);
        assert!((attachment.place(&positions).expect("a place") - x).norm() < 1e-15);
        let motion = Translation3::new(1.0, 2.0, 3.0) * Rotation3::from_euler_angles(0.3, -0.7, 1.9);
        let moved: Vec<Point> = positions.iter().map(|p| motion * p).collect();
        assert!((attachment.place(&moved).expect("a place") - motion * x).norm() < 1e-14);
        // Twice as wide: the height above the triangle stays.
        let wide: Vec<Point> = positions.iter().map(|p| Point::from(p.coords * 2.0)).collect();
        let expected = Point::new(0.4, 0.2, 0.05);
        assert!((attachment.place(&wide).expect("a place") - expected).norm() < 1e-15);
        let flat = vec![Point::origin(); 4];
        assert_eq!(attachment.place(&flat), None);
    }
}
