//! The ground: squares on the half-spaces, large enough to fade out before their edges.

use super::shot::Shot;
use crate::camera::axes;
use crate::model::{Drawing, SurfaceVertex};

/// Half the side of a square of ground, as a multiple of the radius of the model. The shader fades the ground
/// to the backdrop within this distance.
const GROUND_EXTENT: f64 = 8.0;

/// Two triangles for each plane that has the camera in front of it.
pub fn ground_vertices(shot: &Shot, drawing: &Drawing) -> Vec<SurfaceVertex> {
    let mut vertices = Vec::new();
    for plane in shot.ground.iter().filter(|plane| plane.signed_distance(&shot.camera.eye) > 0.0) {
        let normal = plane.normal;
        let foot = -normal * plane.signed_distance(&drawing.origin);
        let [right, up, _] = axes(&normal);
        let (u, v) = (right * (GROUND_EXTENT * drawing.radius), up * (GROUND_EXTENT * drawing.radius));
        let corners = [foot - u - v, foot + u - v, foot + u + v, foot - u + v];
        for corner in [0, 1, 2, 0, 2, 3] {
            vertices.push(SurfaceVertex {
                point: [0, 1, 2].map(|c| corners[corner][c] as f32),
                value: -1.0,
                normal: [0, 1, 2].map(|c| normal[c] as f32),
                color: [0; 4],
            });
        }
    }
    vertices
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Camera;
    use bowknot_geometry::{HalfSpace, Point, Vector};

    #[test]
    fn ground_seen_from_behind_is_left_out() {
        let camera = Camera { eye: Point::new(0.0, -3.0, 1.0), target: Point::origin(), fov: 30.0 };
        let plane = |normal: Vector, offset: f64| HalfSpace { normal, offset };
        let planes = vec![plane(Vector::z(), -0.5), plane(-Vector::y(), -1.0), plane(Vector::y(), -1.0)];
        let shot = Shot { ground: planes, ..Shot::new(camera, [64, 64]) };
        let drawing = Drawing { radius: 1.0, ..Drawing::default() };
        let vertices = ground_vertices(&shot, &drawing);
        assert_eq!(vertices.len(), 12);
        assert!(vertices[..6].iter().all(|v| (v.point[2] + 0.5).abs() < 1e-6));
        assert!(vertices[6..].iter().all(|v| (v.point[1] - 1.0).abs() < 1e-6));
    }
}
