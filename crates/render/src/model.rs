//! What is drawn: elements, which stay the same, and frames, in which their vertices move.

use crate::RenderError;
use crate::palette;
use crate::surface::Surface;
use crate::tubes::Tubes;
use bowknot_geometry::{Point, VertexOutOfRange};
use bytemuck::{Pod, Zeroable};

/// Elements over one array of vertices. Each slice may be empty.
#[derive(Clone, Copy, Debug, Default)]
pub struct Elements<'a> {
    /// Vertices of each triangle.
    pub triangles: &'a [[u32; 3]],
    /// Vertices of each strand edge.
    pub strands: &'a [[u32; 2]],
    /// Vertex of each particle; it is drawn as a ball.
    pub particles: &'a [u32],
    /// Whether each vertex belongs to an obstacle; empty if none does. The first vertex of an element
    /// decides.
    pub obstacle: &'a [bool],
    /// Body of each vertex, which gives its color; empty if all belong to body 0.
    pub body: &'a [u32],
}

/// The thickness of strands and particles in pictures.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Style {
    /// Radius of the tubes around strands [m].
    pub strand_radius: f64,
    /// Radius of the balls around particles [m].
    pub particle_radius: f64,
}

/// A frame of a model.
#[derive(Clone, Copy, Debug)]
pub struct Frame<'a> {
    /// Positions of the vertices [m].
    pub positions: &'a [Point],
    /// A value in [0, 1] per vertex, which the color map shows; a vertex with NaN has the color of its
    /// body. Empty: all are NaN.
    pub values: &'a [f32],
}

/// Elements prepared for drawing: everything that is the same in all frames.
#[derive(Clone, Debug)]
pub struct Model {
    vertex_count: usize,
    surface: Surface,
    tubes: Tubes,
    particles: Vec<u32>,
    style: Style,
    /// Color of each vertex. Alpha is 255 where the two sides of a surface differ, else 0.
    colors: Vec<[u8; 4]>,
}

/// A vertex of a surface as the shader reads it.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct SurfaceVertex {
    pub point: [f32; 3],
    pub value: f32,
    pub normal: [f32; 3],
    pub color: [u8; 4],
}

/// A ball as the shader reads it.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct Ball {
    pub center: [f32; 3],
    pub radius: f32,
    pub value: f32,
    pub color: [u8; 4],
}

/// A frame in the layout of the shader, with positions relative to `origin`.
#[derive(Clone, Debug, Default)]
pub(crate) struct Drawing {
    pub origin: Point,
    /// Radius of a ball around `origin` that contains everything [m].
    pub radius: f64,
    pub vertices: Vec<SurfaceVertex>,
    pub indices: Vec<u32>,
    pub balls: Vec<Ball>,
}

impl Model {
    /// Prepares elements. The creases of surfaces are those at the positions `rest` [m].
    ///
    /// # Errors
    /// [`RenderError::VertexOutOfRange`] and [`RenderError::Length`].
    pub fn new(elements: &Elements<'_>, rest: &[Point], style: &Style) -> Result<Self, RenderError> {
        let n = rest.len();
        check("triangle", elements.triangles, n)?;
        check("strand edge", elements.strands, n)?;
        check("particle", bytemuck::cast_slice::<u32, [u32; 1]>(elements.particles), n)?;
        for (what, given) in [("obstacle", elements.obstacle.len()), ("body", elements.body.len())] {
            if given != 0 && given != n {
                return Err(RenderError::Length { what, given, expected: n });
            }
        }
        let colors = (0..n)
            .map(|v| {
                let is_obstacle = elements.obstacle.get(v).copied().unwrap_or(false);
                let body = elements.body.get(v).copied().unwrap_or(0);
                let [r, g, b] = if is_obstacle { palette::OBSTACLE } else { palette::body(body) };
                [r, g, b, if is_obstacle { 0 } else { 255 }]
            })
            .collect();
        // Where there are many strands they are thin, and corners are not seen.
        let sides = match elements.strands.len() {
            0..4_000 => 14,
            4_000..20_000 => 8,
            _ => 5,
        };
        Ok(Self {
            vertex_count: n,
            surface: Surface::new(elements.triangles, rest),
            tubes: Tubes::new(elements.strands, sides),
            particles: elements.particles.to_vec(),
            style: *style,
            colors,
        })
    }

    /// Gives each vertex a color of its own, as sRGB, in place of that of its body.
    ///
    /// # Errors
    /// [`RenderError::Length`].
    pub fn set_colors(&mut self, colors: &[[u8; 3]]) -> Result<(), RenderError> {
        if colors.len() != self.vertex_count {
            let (given, expected) = (colors.len(), self.vertex_count);
            return Err(RenderError::Length { what: "colors", given, expected });
        }
        for (own, [r, g, b]) in self.colors.iter_mut().zip(colors) {
            *own = [*r, *g, *b, own[3]];
        }
        Ok(())
    }

    /// The frame in the layout of the shader.
    pub(crate) fn drawing(&self, frame: &Frame<'_>) -> Result<Drawing, RenderError> {
        let n = self.vertex_count;
        if frame.positions.len() != n {
            return Err(RenderError::Length { what: "positions", given: frame.positions.len(), expected: n });
        }
        if !frame.values.is_empty() && frame.values.len() != n {
            return Err(RenderError::Length { what: "values", given: frame.values.len(), expected: n });
        }
        let strand_vertices = self.tubes.vertices(frame.positions, self.style.strand_radius);
        let drawn = || {
            let surface = self.surface.sources.iter().copied();
            surface.chain(strand_vertices.iter().map(|v| v.source)).chain(self.particles.iter().copied())
        };
        let (mut low, mut high) = (Point::from([f64::INFINITY; 3]), Point::from([f64::NEG_INFINITY; 3]));
        for v in drawn() {
            let p = &frame.positions[v as usize];
            (low, high) = (low.inf(p), high.sup(p));
        }
        if low.x > high.x {
            (low, high) = (Point::origin(), Point::origin());
        }
        let origin = nalgebra::center(&low, &high);
        let extent = drawn().map(|v| (frame.positions[v as usize] - origin).norm()).fold(0.0, f64::max);
        let thickness = if strand_vertices.is_empty() { 0.0 } else { self.style.strand_radius };
        let grain = if self.particles.is_empty() { 0.0 } else { self.style.particle_radius };
        let radius = (extent + thickness.max(grain)).max(1e-6) * 1.02;

        // Relative to a near origin, the rounding error of single precision is far below a pixel.
        let point = |p: &Point| [0, 1, 2].map(|c| (p[c] - origin[c]) as f32);
        // Shaders need not preserve NaN, so a negative number stands for it.
        let value = |v: u32| {
            let value = frame.values.get(v as usize).copied().unwrap_or(f32::NAN);
            if value.is_nan() { -1.0 } else { value.clamp(0.0, 1.0) }
        };
        let color = |v: u32| self.colors[v as usize];
        let normals = self.surface.normals(frame.positions);
        let surface = self.surface.sources.iter().zip(&normals).map(|(&v, normal)| SurfaceVertex {
            point: point(&frame.positions[v as usize]),
            value: value(v),
            normal: [0, 1, 2].map(|c| normal[c] as f32),
            color: color(v),
        });
        let tubes = strand_vertices.iter().map(|vertex| SurfaceVertex {
            point: point(&vertex.position),
            value: value(vertex.source),
            normal: [0, 1, 2].map(|c| vertex.normal[c] as f32),
            color: color(vertex.source),
        });
        let first = self.surface.sources.len() as u32;
        let triangles = self.surface.triangles.iter().flatten().copied();
        let tube_triangles = self.tubes.triangles.iter().flatten().map(|v| v + first);
        let ball = |&v: &u32| Ball {
            center: point(&frame.positions[v as usize]),
            radius: self.style.particle_radius as f32,
            value: value(v),
            color: color(v),
        };
        Ok(Drawing {
            origin,
            radius,
            vertices: surface.chain(tubes).collect(),
            indices: triangles.chain(tube_triangles).collect(),
            balls: self.particles.iter().map(ball).collect(),
        })
    }
}

fn check<const N: usize>(
    element: &'static str,
    elements: &[[u32; N]],
    vertex_count: usize,
) -> Result<(), RenderError> {
    for (index, vertices) in elements.iter().enumerate() {
        if let Some(error) = VertexOutOfRange::of(element, index, vertices, vertex_count).next() {
            return Err(error.into());
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests;
