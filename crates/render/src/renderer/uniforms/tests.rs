use super::*;
use crate::Camera;
use bowknot_geometry::Point;

/// The structs have the sizes that WGSL's layout rules give those of the shader.
#[test]
fn layouts_agree_with_the_shader() {
    assert_eq!(size_of::<ViewData>(), 64 + 16);
    assert_eq!(size_of::<LightData>(), 64 + 48);
    assert_eq!(size_of::<SceneData>(), 5 * 16 + DISC * 16 + 256 * 16 + MAX_LIGHTS * size_of::<LightData>());
    let shader = include_str!("../../shader.wgsl");
    assert!(shader.contains(&format!("array<Light, {MAX_LIGHTS}>")));
    // What devices of the lowest class can bind.
    assert!(size_of::<SceneData>() <= 16 << 10);
}

fn transform(matrix: &[[f32; 4]; 4], p: &Point) -> [f64; 3] {
    let sum =
        |r: usize| (0..3).map(|c| f64::from(matrix[c][r]) * p[c]).sum::<f64>() + f64::from(matrix[3][r]);
    [sum(0) / sum(3), sum(1) / sum(3), sum(2) / sum(3)]
}

#[test]
fn the_target_lies_in_the_middle_beside_the_legend() {
    let camera = Camera { eye: Point::new(3.0, -4.0, 2.0), target: Point::new(0.5, 0.5, 0.25), fov: 30.0 };
    let drawing = Drawing { origin: Point::new(0.5, 0.0, 0.0), radius: 1.0, ..Drawing::default() };
    let shot = Shot { legend_width: 100, ..Shot::new(camera, [400, 300]) };
    let view = camera_view(&drawing, &shot).unwrap();
    let [x, y, z] = transform(&view.matrix, &(camera.target - drawing.origin.coords));
    // Pixel 150 of 400 is the middle of the 300 that are free.
    assert!((x + 0.25).abs() < 1e-6 && y.abs() < 1e-6 && z > 0.0 && z < 1.0, "{x} {y} {z}");
    // Half the field of view above it lies the upper edge.
    let [_, up, back] = camera.axes().unwrap();
    let distance = (camera.eye - camera.target).norm();
    let edge = camera.eye - back * distance + up * (distance * 15_f64.to_radians().tan());
    assert!((transform(&view.matrix, &(edge - drawing.origin.coords))[1] - 1.0).abs() < 1e-6);
}

#[test]
fn lights_see_everything_nearest_first() {
    let direction = Vector::new(0.3, -0.5, 0.8).normalize();
    let matrix = columns(&(to_texture() * light_matrix(&direction, 2.0)));
    let near = transform(&matrix, &Point::from(direction * 2.0));
    let far = transform(&matrix, &Point::from(direction * -2.0));
    assert!((near[0] - 0.5).abs() < 1e-6 && near[2].abs() < 1e-6 && (far[2] - 1.0).abs() < 1e-6);
}
