//! What the shader reads besides vertices: the views of the camera and the lights, and the scene.

use super::shot::{Quality, Shot};
use crate::camera::axes;
use crate::colormap::{to_linear, viridis};
use crate::lights::{lights, spiral};
use crate::model::Drawing;
use crate::{RenderError, palette};
use bowknot_geometry::Vector;
use bytemuck::{Pod, Zeroable};
use nalgebra::{Matrix4, RowVector4};

/// Largest number of lights: the length of the array in the shader.
const MAX_LIGHTS: usize = 96;
/// Distance between two views in their buffer [bytes]: the alignment that every device supports.
pub const VIEW_STRIDE: usize = 256;
/// Points that a part of a light is looked up at.
const DISC: usize = 16;
/// Tint of the key light.
const KEY_TINT: [f64; 3] = [1.04, 1.0, 0.95];
/// Tint of the sky.
const SKY_TINT: [f64; 3] = [0.95, 1.0, 1.07];

/// The uniforms of a frame.
pub struct Uniforms {
    /// A [`ViewData`] every [`VIEW_STRIDE`] bytes: first the camera, then the lights.
    pub views: Vec<u8>,
    /// The scene.
    pub scene: SceneData,
    /// Number of lights.
    pub light_count: usize,
}

/// `View` in the shader.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
pub struct ViewData {
    matrix: [[f32; 4]; 4],
    eye: [f32; 4],
}

/// `Light` in the shader.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
pub struct LightData {
    matrix: [[f32; 4]; 4],
    direction: [f32; 4],
    radiance: [f32; 4],
    part: [f32; 4],
}

/// `Scene` in the shader.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
pub struct SceneData {
    upper: [f32; 4],
    lower: [f32; 4],
    open_sky: [f32; 4],
    bound: [f32; 4],
    counts: [u32; 4],
    disc: [[f32; 4]; DISC],
    palette: [[f32; 4]; 256],
    lights: [LightData; MAX_LIGHTS],
}

impl Uniforms {
    /// The uniforms for a drawing of this size [pixels], to be reduced by `supersampling`.
    ///
    /// # Errors
    /// [`RenderError::CameraAtTarget`].
    pub fn new(
        drawing: &Drawing,
        shot: &Shot,
        quality: &Quality,
        size: [u32; 2],
        supersampling: u32,
    ) -> Result<Self, RenderError> {
        let [.., back] = shot.camera.axes()?;
        let [key, sky] = light_counts(quality);
        let lights = lights(&back, key, sky);
        let texel = 2.0 * drawing.radius / f64::from(quality.shadow_map);

        let mut views = vec![0_u8; (lights.len() + 1) * VIEW_STRIDE];
        let mut put = |index: usize, data: ViewData| {
            let bytes = bytemuck::bytes_of(&data);
            views[index * VIEW_STRIDE..][..bytes.len()].copy_from_slice(bytes);
        };
        put(0, camera_view(drawing, shot)?);
        let mut scene = scene_data(drawing, size, texel);
        for (index, light) in lights.iter().enumerate() {
            let matrix = light_matrix(&light.direction, drawing.radius);
            put(index + 1, ViewData { matrix: columns(&matrix), eye: homogeneous(&light.direction, 0.0) });
            let tint = if light.key { KEY_TINT } else { SKY_TINT };
            let radiance = tint.map(|c| c * light.weight);
            scene.lights[index] = LightData {
                matrix: columns(&(to_texture() * matrix)),
                direction: homogeneous(&light.direction, f64::from(u8::from(light.key))),
                radiance: [radiance[0] as f32, radiance[1] as f32, radiance[2] as f32, 0.0],
                part: [light.offset[0], light.offset[1], light.radius, 0.0].map(|v| v as f32),
            };
            for c in 0..3 {
                scene.open_sky[c] += (radiance[c] * light.direction.z) as f32;
            }
        }
        scene.counts[0] = lights.len() as u32;
        scene.counts[2] = key as u32 + 256 * quality.penumbra_taps.clamp(1, 4);
        scene.counts[3] = u32::from(supersampling.is_multiple_of(2));
        Ok(Self { views, scene, light_count: lights.len() })
    }
}

/// Numbers of key lights and of sky lights: together at most [`MAX_LIGHTS`], and at least one sky light.
pub fn light_counts(quality: &Quality) -> [usize; 2] {
    let key = quality.key_lights.min(MAX_LIGHTS - 1);
    [key, quality.sky_lights.clamp(1, MAX_LIGHTS - key)]
}

/// The scene without its lights. `texel` is the width of a texel of the shadow maps [m].
fn scene_data(drawing: &Drawing, size: [u32; 2], texel: f64) -> SceneData {
    let linear = |[r, g, b]: [u8; 3], w: f32| {
        let [r, g, b] = [r, g, b].map(|v| to_linear(f64::from(v) / 255.0) as f32);
        [r, g, b, w]
    };
    let [upper, lower] = palette::BACKDROP;
    let color = |k: usize| {
        let [r, g, b] = viridis(k as f64 / 255.0).map(|c| to_linear(c) as f32);
        [r, g, b, 1.0]
    };
    SceneData {
        upper: linear(upper, size[1] as f32),
        lower: linear(lower, 0.0),
        open_sky: [0.0; 4],
        bound: [0.0, 0.0, 0.0, drawing.radius as f32],
        counts: [0, (texel as f32).to_bits(), 0, 0],
        disc: std::array::from_fn(|k| {
            let [x, y] = spiral(k, DISC);
            [x as f32, y as f32, 0.0, 0.0]
        }),
        palette: std::array::from_fn(color),
        lights: [LightData::zeroed(); MAX_LIGHTS],
    }
}

/// The view from the space of the drawing to clip space, where x and y run from -1 to 1 over the whole
/// picture and depth from 0 to 1.
fn camera_view(drawing: &Drawing, shot: &Shot) -> Result<ViewData, RenderError> {
    let camera = &shot.camera;
    let [right, up, back] = camera.axes()?;
    let eye = camera.eye - drawing.origin;
    let [width, height] = shot.size.map(f64::from);
    // The target lies in the middle of the part that the legend leaves free.
    let shift = -f64::from(shot.legend_width) / width;
    let f = 1.0 / (camera.fov.to_radians() / 2.0).tan();
    let distance = eye.norm();
    let (near, far) = (0.01 * distance.max(drawing.radius), 50.0 * (distance + drawing.radius));
    let row = |axis: &Vector| RowVector4::new(axis.x, axis.y, axis.z, -axis.dot(&eye));
    let depth = -row(&back);
    let matrix = Matrix4::from_rows(&[
        row(&right) * (f * height / width) + depth * shift,
        row(&up) * f,
        depth * (far / (far - near)) - RowVector4::new(0.0, 0.0, 0.0, far * near / (far - near)),
        depth,
    ]);
    Ok(ViewData { matrix: columns(&matrix), eye: homogeneous(&eye, 1.0) })
}

/// From the space of the drawing to the clip space of a light: a parallel projection of everything within
/// `radius`.
fn light_matrix(direction: &Vector, radius: f64) -> Matrix4<f64> {
    let [right, up, back] = axes(direction);
    let row = |axis: &Vector, scale: f64, shift: f64| {
        RowVector4::new(axis.x * scale, axis.y * scale, axis.z * scale, shift)
    };
    Matrix4::from_rows(&[
        row(&right, 1.0 / radius, 0.0),
        row(&up, 1.0 / radius, 0.0),
        row(&back, -0.5 / radius, 0.5),
        RowVector4::new(0.0, 0.0, 0.0, 1.0),
    ])
}

/// From clip space to texture coordinates, the second of which runs downward.
fn to_texture() -> Matrix4<f64> {
    Matrix4::new(
        0.5, 0.0, 0.0, 0.5, //
        0.0, -0.5, 0.0, 0.5, //
        0.0, 0.0, 1.0, 0.0, //
        0.0, 0.0, 0.0, 1.0,
    )
}

fn columns(matrix: &Matrix4<f64>) -> [[f32; 4]; 4] {
    matrix.map(|v| v as f32).into()
}

fn homogeneous(v: &Vector, w: f64) -> [f32; 4] {
    [v.x as f32, v.y as f32, v.z as f32, w as f32]
}

#[cfg(test)]
mod tests;
