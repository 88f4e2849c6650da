//! Pictures of frames: shadow maps for every light, then what the camera sees.
//!
//! A picture is one submission: a depth-only pass for each light into a layer of an array, then one pass with four samples
//! a pixel in which every visible place asks all the maps which lights it sees. What the passes need of the frame is
//! uploaded anew each time; the targets and maps are kept.

use crate::camera::axes;
use crate::colormap::{to_linear, viridis};
use crate::device::{COLOR, DEPTH, Device, SAMPLES, SHADOW, wait};
use crate::lights::lights;
use crate::model::{Drawing, SurfaceVertex};
use crate::{Camera, Frame, Model, Picture, RenderError, palette};
use bowknot_geometry::{HalfSpace, Vector};
use bytemuck::{Pod, Zeroable};
use nalgebra::{Matrix4, RowVector4};
use wgpu::BufferUsages;

/// Largest number of lights, as the shader's array has it.
const MAX_LIGHTS: usize = 96;
/// Distance between the views in their buffer: what every device can bind [bytes].
const VIEW_STRIDE: usize = 256;
/// Smallest side of a picture [pixels].
const MIN_SIZE: u32 = 16;
/// Half the side of the square of ground that is drawn, in radii of what stands on it; it has faded before.
const GROUND: f64 = 8.0;
/// Tints of the key light and the sky.
const KEY_TINT: [f64; 3] = [1.04, 1.0, 0.95];
const SKY_TINT: [f64; 3] = [0.95, 1.0, 1.07];

/// How much work goes into a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Quality {
    /// Lights that make up the key light. More: smoother penumbras, at proportional cost.
    pub key_lights: usize,
    /// Lights that make up the sky. More: smoother ambient occlusion, at proportional cost.
    pub sky_lights: usize,
    /// Side of a shadow map [texels]. Larger: finer shadows, and memory with its square, 2 bytes a texel and light.
    pub shadow_map: u32,
    /// Pixels are drawn this much finer in each direction, besides the four samples of each.
    pub supersampling: u32,
}

impl Quality {
    /// For single pictures.
    pub const FINE: Self = Self { key_lights: 20, sky_lights: 60, shadow_map: 1024, supersampling: 2 };
    /// For the frames of animations.
    pub const FAST: Self = Self { key_lights: 8, sky_lights: 24, shadow_map: 768, supersampling: 1 };
}

/// From where a picture is taken, and what surrounds the model.
#[derive(Clone, Debug, PartialEq)]
pub struct Shot {
    /// The camera.
    pub camera: Camera,
    /// Width and height of the picture [pixels].
    pub size: [u32; 2],
    /// Width of a strip at the right that the camera leaves free, for a legend [pixels].
    pub free: u32,
    /// Planes that receive shadows; one that the camera is behind is not drawn.
    pub ground: Vec<HalfSpace>,
}

impl Shot {
    /// A shot without ground or legend.
    pub fn new(camera: Camera, size: [u32; 2]) -> Self {
        Self { camera, size, free: 0, ground: Vec::new() }
    }
}

/// Draws frames. It keeps the device and its largest buffers: use one for all frames of a run.
#[derive(Debug)]
pub struct Renderer {
    device: Device,
    quality: Quality,
    shadows: Option<Shadows>,
    targets: Option<Targets>,
}

/// Shadow maps, a layer for each light.
#[derive(Debug)]
struct Shadows {
    layers: Vec<wgpu::TextureView>,
    all: wgpu::TextureView,
}

/// What is drawn into.
#[derive(Debug)]
struct Targets {
    size: [u32; 2],
    color: wgpu::TextureView,
    depth: wgpu::TextureView,
    resolved: wgpu::Texture,
    download: wgpu::Buffer,
}

/// `View` in the shader.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct ViewData {
    matrix: [[f32; 4]; 4],
    eye: [f32; 4],
}

/// `Light` in the shader.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct LightData {
    matrix: [[f32; 4]; 4],
    direction: [f32; 4],
    radiance: [f32; 4],
}

/// `Scene` in the shader.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct SceneData {
    upper: [f32; 4],
    lower: [f32; 4],
    open_sky: [f32; 4],
    bound: [f32; 4],
    counts: [u32; 4],
    palette: [[f32; 4]; 256],
    lights: [LightData; MAX_LIGHTS],
}

/// Buffers of a frame.
struct Uploaded {
    vertices: wgpu::Buffer,
    indices: wgpu::Buffer,
    index_count: u32,
    balls: wgpu::Buffer,
    ball_count: u32,
    ground: wgpu::Buffer,
    ground_vertices: u32,
    view: wgpu::BindGroup,
    scene: wgpu::BindGroup,
    light_count: usize,
}

impl Renderer {
    /// Opens the fastest device there is.
    ///
    /// # Errors
    /// [`RenderError::NoDriver`], which names the package to install, or the driver's refusal.
    pub fn new(quality: Quality) -> Result<Self, RenderError> {
        Ok(Self { device: Device::open()?, quality, shadows: None, targets: None })
    }

    /// Name of the device that draws.
    pub fn device_name(&self) -> &str {
        &self.device.adapter_name
    }

    /// Draws a frame.
    ///
    /// # Errors
    /// A frame that does not fit the model, a size that the device cannot draw, a camera at its target, a driver that
    /// fails.
    pub fn render(&mut self, model: &Model, frame: &Frame<'_>, shot: &Shot) -> Result<Picture, RenderError> {
        let drawing = model.drawing(frame)?;
        let most = self.device.device.limits().max_texture_dimension_2d;
        let [width, height] = shot.size;
        if shot.size.iter().any(|side| !(MIN_SIZE..=most).contains(side)) {
            return Err(RenderError::Size { width, height, most });
        }
        let factor = self.quality.supersampling.max(1).min(most / width.max(height));

        // What goes wrong on the device comes back as a value instead of ending the program.
        let gpu = self.device.device.clone();
        let memory = gpu.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
        let validation = gpu.push_error_scope(wgpu::ErrorFilter::Validation);
        let drawn = self.draw(&drawing, shot, [width * factor, height * factor]);
        let faults = [wait(validation.pop()), wait(memory.pop())];
        if let Some(error) = faults.into_iter().flatten().next() {
            return Err(self.device.fault(error));
        }
        Ok(drawn?.shrink(factor))
    }

    fn draw(&mut self, drawing: &Drawing, shot: &Shot, size: [u32; 2]) -> Result<Picture, RenderError> {
        if self.targets.as_ref().is_none_or(|targets| targets.size != size) {
            self.targets = Some(Targets::new(&self.device, size));
        }
        let counts = self.light_counts();
        if self.shadows.is_none() {
            self.shadows = Some(Shadows::new(&self.device, counts[0] + counts[1], self.quality.shadow_map));
        }
        let (Some(targets), Some(shadows)) = (&self.targets, &self.shadows) else {
            return Err(self.device.fault("nothing to draw into"));
        };
        let uploaded = self.upload(drawing, shot, size, shadows)?;
        let mut encoder =
            self.device.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        for (index, layer) in shadows.layers.iter().enumerate().take(uploaded.light_count) {
            self.cast(&mut encoder, &uploaded, layer, ((index + 1) * VIEW_STRIDE) as u32);
        }
        self.see(&mut encoder, &uploaded, targets);
        targets.copy(&mut encoder);
        self.device.queue.submit([encoder.finish()]);
        targets.read(&self.device)
    }

    fn light_counts(&self) -> [usize; 2] {
        let key = self.quality.key_lights.min(MAX_LIGHTS - 1);
        [key, self.quality.sky_lights.clamp(1, MAX_LIGHTS - key)]
    }

    /// Draws what casts shadows as a light sees it.
    fn cast(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        uploaded: &Uploaded,
        layer: &wgpu::TextureView,
        view: u32,
    ) {
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("shadow"),
            depth_stencil_attachment: Some(depth_attachment(layer)),
            ..wgpu::RenderPassDescriptor::default()
        });
        pass.set_bind_group(0, &uploaded.view, &[view]);
        uploaded.draw_elements(&mut pass, &self.device.surface_shadow, &self.device.ball_shadow);
    }

    /// Draws what the camera sees.
    fn see(&self, encoder: &mut wgpu::CommandEncoder, uploaded: &Uploaded, targets: &Targets) {
        let resolved = targets.resolved.create_view(&wgpu::TextureViewDescriptor::default());
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("picture"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &targets.color,
                depth_slice: None,
                resolve_target: Some(&resolved),
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color::WHITE),
                    store: wgpu::StoreOp::Discard,
                },
            })],
            depth_stencil_attachment: Some(depth_attachment(&targets.depth)),
            ..wgpu::RenderPassDescriptor::default()
        });
        pass.set_bind_group(0, &uploaded.view, &[0]);
        pass.set_bind_group(1, &uploaded.scene, &[]);
        pass.set_pipeline(&self.device.backdrop);
        pass.draw(0..3, 0..1);
        // What stands in front comes first: the ground behind it is then not shaded in vain.
        uploaded.draw_elements(&mut pass, &self.device.surface, &self.device.balls);
        if uploaded.ground_vertices > 0 {
            pass.set_pipeline(&self.device.ground);
            pass.set_vertex_buffer(0, uploaded.ground.slice(..));
            pass.draw(0..uploaded.ground_vertices, 0..1);
        }
    }

    fn upload(
        &self,
        drawing: &Drawing,
        shot: &Shot,
        size: [u32; 2],
        shadows: &Shadows,
    ) -> Result<Uploaded, RenderError> {
        let [.., back] = shot.camera.axes()?;
        let [key, sky] = self.light_counts();
        let lights = lights(&back, key, sky);
        let texel = 2.0 * drawing.radius / f64::from(self.quality.shadow_map);

        let mut views = vec![0_u8; (lights.len() + 1) * VIEW_STRIDE];
        let mut put = |index: usize, data: ViewData| {
            let bytes = bytemuck::bytes_of(&data);
            views[index * VIEW_STRIDE..][..bytes.len()].copy_from_slice(bytes);
        };
        put(0, camera_view(&shot.camera, drawing, shot)?);
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
            };
            for c in 0..3 {
                scene.open_sky[c] += (radiance[c] * light.direction.z) as f32;
            }
        }
        scene.counts[0] = lights.len() as u32;
        let ground = ground_vertices(shot, drawing);

        let device = &self.device;
        let view_buffer = device.buffer("views", &views, BufferUsages::UNIFORM);
        let scene_buffer = device.buffer("scene", &[scene], BufferUsages::UNIFORM);
        let view = device.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("view"),
            layout: &device.view_layout,
            entries: &[wgpu::BindGroupEntry {
                binding: 0,
                resource: wgpu::BindingResource::Buffer(wgpu::BufferBinding {
                    buffer: &view_buffer,
                    offset: 0,
                    size: std::num::NonZeroU64::new(size_of::<ViewData>() as u64),
                }),
            }],
        });
        let entry = |binding, resource| wgpu::BindGroupEntry { binding, resource };
        let scene = device.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("scene"),
            layout: &device.scene_layout,
            entries: &[
                entry(0, scene_buffer.as_entire_binding()),
                entry(1, wgpu::BindingResource::TextureView(&shadows.all)),
                entry(2, wgpu::BindingResource::Sampler(&device.sampler)),
            ],
        });
        Ok(Uploaded {
            vertices: device.buffer("vertices", &drawing.vertices, BufferUsages::VERTEX),
            indices: device.buffer("indices", &drawing.indices, BufferUsages::INDEX),
            index_count: drawing.indices.len() as u32,
            balls: device.buffer("balls", &drawing.balls, BufferUsages::VERTEX),
            ball_count: drawing.balls.len() as u32,
            ground_vertices: ground.len() as u32,
            ground: device.buffer("ground", &ground, BufferUsages::VERTEX),
            view,
            scene,
            light_count: lights.len(),
        })
    }
}

impl Uploaded {
    fn draw_elements(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        surface: &wgpu::RenderPipeline,
        balls: &wgpu::RenderPipeline,
    ) {
        if self.index_count > 0 {
            pass.set_pipeline(surface);
            pass.set_vertex_buffer(0, self.vertices.slice(..));
            pass.set_index_buffer(self.indices.slice(..), wgpu::IndexFormat::Uint32);
            pass.draw_indexed(0..self.index_count, 0, 0..1);
        }
        if self.ball_count > 0 {
            pass.set_pipeline(balls);
            pass.set_vertex_buffer(0, self.balls.slice(..));
            pass.draw(0..4, 0..self.ball_count);
        }
    }
}

impl Shadows {
    fn new(device: &Device, count: usize, side: u32) -> Self {
        let usage = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING;
        let texture = texture(device, "shadows", [side, side], count as u32, 1, SHADOW, usage);
        let layer = |index| wgpu::TextureViewDescriptor {
            dimension: Some(wgpu::TextureViewDimension::D2),
            base_array_layer: index,
            array_layer_count: Some(1),
            ..wgpu::TextureViewDescriptor::default()
        };
        let all = wgpu::TextureViewDescriptor {
            dimension: Some(wgpu::TextureViewDimension::D2Array),
            ..wgpu::TextureViewDescriptor::default()
        };
        Self {
            layers: (0..count as u32).map(|index| texture.create_view(&layer(index))).collect(),
            all: texture.create_view(&all),
        }
    }
}

impl Targets {
    fn new(device: &Device, size: [u32; 2]) -> Self {
        let attachment = wgpu::TextureUsages::RENDER_ATTACHMENT;
        let view = |texture: wgpu::Texture| texture.create_view(&wgpu::TextureViewDescriptor::default());
        let copied = attachment | wgpu::TextureUsages::COPY_SRC;
        Self {
            size,
            color: view(texture(device, "samples", size, 1, SAMPLES, COLOR, attachment)),
            depth: view(texture(device, "depth", size, 1, SAMPLES, DEPTH, attachment)),
            resolved: texture(device, "picture", size, 1, 1, COLOR, copied),
            download: device.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("download"),
                size: u64::from(row_bytes(size[0])) * u64::from(size[1]),
                usage: BufferUsages::MAP_READ | BufferUsages::COPY_DST,
                mapped_at_creation: false,
            }),
        }
    }

    fn copy(&self, encoder: &mut wgpu::CommandEncoder) {
        let layout = wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(row_bytes(self.size[0])),
            rows_per_image: None,
        };
        encoder.copy_texture_to_buffer(
            self.resolved.as_image_copy(),
            wgpu::TexelCopyBufferInfo { buffer: &self.download, layout },
            self.resolved.size(),
        );
    }

    fn read(&self, device: &Device) -> Result<Picture, RenderError> {
        let (sender, receiver) = std::sync::mpsc::channel();
        self.download.map_async(wgpu::MapMode::Read, .., move |result| {
            // The other end waits below.
            let _ = sender.send(result);
        });
        device.device.poll(wgpu::PollType::wait_indefinitely()).map_err(|e| device.fault(e))?;
        receiver.recv().map_err(|e| device.fault(e))?.map_err(|e| device.fault(e))?;
        let [width, height] = self.size;
        let mut picture = Picture { width, height, pixels: Vec::with_capacity((width * height) as usize) };
        let mapped = self.download.get_mapped_range(..).map_err(|e| device.fault(e))?;
        for row in mapped.chunks_exact(row_bytes(width) as usize) {
            let pixels = row[..4 * width as usize].as_chunks::<4>().0;
            picture.pixels.extend(pixels.iter().map(|&[r, g, b, _]| [r, g, b]));
        }
        drop(mapped);
        self.download.unmap();
        Ok(picture)
    }
}

/// Bytes of a row of pixels, aligned as copies demand.
fn row_bytes(width: u32) -> u32 {
    (4 * width).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT)
}

fn texture(
    device: &Device,
    label: &str,
    [width, height]: [u32; 2],
    layers: u32,
    samples: u32,
    format: wgpu::TextureFormat,
    usage: wgpu::TextureUsages,
) -> wgpu::Texture {
    device.device.create_texture(&wgpu::TextureDescriptor {
        label: Some(label),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: layers },
        mip_level_count: 1,
        sample_count: samples,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage,
        view_formats: &[],
    })
}

fn depth_attachment(view: &wgpu::TextureView) -> wgpu::RenderPassDepthStencilAttachment<'_> {
    wgpu::RenderPassDepthStencilAttachment {
        view,
        depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(1.0), store: wgpu::StoreOp::Store }),
        stencil_ops: None,
    }
}

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
        palette: std::array::from_fn(color),
        lights: [LightData::zeroed(); MAX_LIGHTS],
    }
}

/// From the frame's space to clip space, where x and y run from -1 to 1 over the whole picture and depth from 0 to 1.
fn camera_view(camera: &Camera, drawing: &Drawing, shot: &Shot) -> Result<ViewData, RenderError> {
    let [right, up, back] = camera.axes()?;
    let eye = camera.eye - drawing.origin;
    let [width, height] = shot.size.map(f64::from);
    // The middle of what the legend leaves free.
    let shift = -f64::from(shot.free) / width;
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

/// From the frame's space to what a light sees, in parallel projection about everything within `radius`.
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

/// From clip space to texture coordinates, whose second one runs down.
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

/// Two triangles for each plane that the camera is in front of.
fn ground_vertices(shot: &Shot, drawing: &Drawing) -> Vec<SurfaceVertex> {
    let mut vertices = Vec::new();
    for plane in shot.ground.iter().filter(|plane| plane.signed_distance(&shot.camera.eye) > 0.0) {
        let normal = plane.normal;
        let foot = -normal * plane.signed_distance(&drawing.origin);
        let [right, up, _] = axes(&normal);
        let (u, v) = (right * (GROUND * drawing.radius), up * (GROUND * drawing.radius));
        let corners = [foot - u - v, foot + u - v, foot + u + v, foot - u + v];
        for corner in [0, 1, 2, 0, 2, 3] {
            vertices.push(SurfaceVertex {
                place: [0, 1, 2].map(|c| corners[corner][c] as f32),
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
    use bowknot_geometry::Point;

    /// The structs have the sizes that WGSL's layout rules give those of the shader.
    #[test]
    fn layouts_agree_with_the_shader() {
        assert_eq!(size_of::<ViewData>(), 64 + 16);
        assert_eq!(size_of::<LightData>(), 64 + 32);
        assert_eq!(size_of::<SceneData>(), 5 * 16 + 256 * 16 + MAX_LIGHTS * size_of::<LightData>());
        let shader = include_str!("shader.wgsl");
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
    fn the_target_lies_in_the_middle_of_what_is_free() {
        let camera =
            Camera { eye: Point::new(3.0, -4.0, 2.0), target: Point::new(0.5, 0.5, 0.25), fov: 30.0 };
        let drawing = Drawing { origin: Point::new(0.5, 0.0, 0.0), radius: 1.0, ..Drawing::default() };
        let shot = Shot { free: 100, ..Shot::new(camera, [400, 300]) };
        let view = camera_view(&camera, &drawing, &shot).unwrap();
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

    #[test]
    fn ground_seen_from_behind_is_left_out() {
        let camera = Camera { eye: Point::new(0.0, -3.0, 1.0), target: Point::origin(), fov: 30.0 };
        let plane = |normal: Vector, offset: f64| HalfSpace { normal, offset };
        let planes = vec![plane(Vector::z(), -0.5), plane(-Vector::y(), -1.0), plane(Vector::y(), -1.0)];
        let shot = Shot { ground: planes, ..Shot::new(camera, [64, 64]) };
        let drawing = Drawing { radius: 1.0, ..Drawing::default() };
        let vertices = ground_vertices(&shot, &drawing);
        assert_eq!(vertices.len(), 12);
        assert!(vertices[..6].iter().all(|v| (v.place[2] + 0.5).abs() < 1e-6));
        assert!(vertices[6..].iter().all(|v| (v.place[1] - 1.0).abs() < 1e-6));
    }
}
