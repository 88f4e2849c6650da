//! What is drawn: elements that stay the same, and frames in which their vertices move.

use crate::RenderError;
use crate::palette;
use crate::surface::Surface;
use crate::tubes::Tubes;
use bowknot_geometry::{Point, VertexOutOfRange};
use bytemuck::{Pod, Zeroable};

/// Elements over one array of vertices. Every slice may be empty.
#[derive(Clone, Copy, Debug, Default)]
pub struct Elements<'a> {
    /// Vertices of each triangle.
    pub triangles: &'a [[u32; 3]],
    /// Vertices of each strand edge.
    pub strands: &'a [[u32; 2]],
    /// Vertices that are drawn as balls.
    pub particles: &'a [u32],
    /// Whether each vertex is of an obstacle; empty: none is. An element is as its first vertex.
    pub obstacle: &'a [bool],
    /// Body of each vertex, for its colour; empty: all are of body 0.
    pub body: &'a [u32],
}

/// How thick what has no thickness is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Style {
    /// Radius of the tubes about strands [m].
    pub strand_radius: f64,
    /// Radius of the balls about particles [m].
    pub particle_radius: f64,
}

/// A frame of a model.
#[derive(Clone, Copy, Debug)]
pub struct Frame<'a> {
    /// Where the vertices are [m].
    pub positions: &'a [Point],
    /// A share in [0, 1] of each vertex that the colour map shows; NaN shows the body's own colour. Empty: all NaN.
    pub values: &'a [f32],
}

/// What is the same in all frames, prepared for drawing.
#[derive(Clone, Debug)]
pub struct Model {
    vertex_count: usize,
    surface: Surface,
    tubes: Tubes,
    particles: Vec<u32>,
    style: Style,
    /// Of each vertex; alpha 255: its two sides differ.
    colors: Vec<[u8; 4]>,
}

/// A vertex of a surface as the shader reads it.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct SurfaceVertex {
    pub place: [f32; 3],
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

/// A frame as the shaders read it, relative to `origin`.
#[derive(Clone, Debug, Default)]
pub(crate) struct Drawing {
    pub origin: Point,
    /// Radius about the origin that holds everything [m].
    pub radius: f64,
    pub vertices: Vec<SurfaceVertex>,
    pub indices: Vec<u32>,
    pub balls: Vec<Ball>,
}

impl Model {
    /// Prepares elements. Creases of surfaces are found at `rest`, positions of all vertices [m].
    ///
    /// # Errors
    /// Elements that name vertices which do not exist, arrays of the wrong length.
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
        // Many strands are thin ones, on which nobody sees corners.
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

    /// The frame in the shaders' layout.
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
        let reach = drawn().map(|v| (frame.positions[v as usize] - origin).norm()).fold(0.0, f64::max);
        let thickness = if strand_vertices.is_empty() { 0.0 } else { self.style.strand_radius };
        let grain = if self.particles.is_empty() { 0.0 } else { self.style.particle_radius };
        let radius = (reach + thickness.max(grain)).max(1e-6) * 1.02;

        // Offsets from a near origin keep the device's single precision far below a pixel.
        let place = |p: &Point| [0, 1, 2].map(|c| (p[c] - origin[c]) as f32);
        // A shader cannot be relied on to tell NaN: below zero means none.
        let value = |v: u32| {
            let value = frame.values.get(v as usize).copied().unwrap_or(f32::NAN);
            if value.is_nan() { -1.0 } else { value.clamp(0.0, 1.0) }
        };
        let color = |v: u32| self.colors[v as usize];
        let normals = self.surface.normals(frame.positions);
        let surface = self.surface.sources.iter().zip(&normals).map(|(&v, normal)| SurfaceVertex {
            place: place(&frame.positions[v as usize]),
            value: value(v),
            normal: [0, 1, 2].map(|c| normal[c] as f32),
            color: color(v),
        });
        let tubes = strand_vertices.iter().map(|vertex| SurfaceVertex {
            place: place(&vertex.position),
            value: value(vertex.source),
            normal: [0, 1, 2].map(|c| vertex.normal[c] as f32),
            color: color(vertex.source),
        });
        let first = self.surface.sources.len() as u32;
        let triangles = self.surface.triangles.iter().flatten().copied();
        let tube_triangles = self.tubes.triangles.iter().flatten().map(|v| v + first);
        let ball = |&v: &u32| Ball {
            center: place(&frame.positions[v as usize]),
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
mod tests {
    use super::*;

    const STYLE: Style = Style { strand_radius: 0.05, particle_radius: 0.2 };

    fn points() -> Vec<Point> {
        (0..7).map(|k| Point::new(1000.0 + f64::from(k), f64::from(k % 2), f64::from(k / 3))).collect()
    }

    #[test]
    fn a_drawing_holds_everything_about_its_origin() {
        let elements = Elements {
            triangles: &[[0, 1, 2]],
            strands: &[[3, 4], [4, 5]],
            particles: &[6],
            obstacle: &[false, false, false, true, true, true, false],
            body: &[0, 0, 0, 1, 1, 1, 2],
        };
        let points = points();
        let model = Model::new(&elements, &points, &STYLE).unwrap();
        let values = [0.5, 2.0, f32::NAN, 0.0, 0.0, 0.0, -3.0];
        let drawing = model.drawing(&Frame { positions: &points, values: &values }).unwrap();
        assert_eq!((drawing.balls.len(), drawing.indices.len() % 3), (1, 0));
        assert!(drawing.indices.iter().all(|&v| (v as usize) < drawing.vertices.len()));
        for vertex in &drawing.vertices {
            let distance = vertex.place.iter().map(|c| c * c).sum::<f32>().sqrt();
            assert!(f64::from(distance) <= drawing.radius);
        }
        let shown: Vec<f32> = drawing.vertices[..3].iter().map(|v| v.value).collect();
        assert_eq!(shown, [0.5, 1.0, -1.0]);
        assert_eq!(drawing.balls[0].value, 0.0);
        assert_eq!(drawing.vertices[0].color[..3], palette::body(0));
        assert_eq!(drawing.vertices[3].color, [176, 178, 182, 0]);
    }

    #[test]
    fn what_does_not_fit_is_refused() {
        let points = points();
        let wrong = Elements { strands: &[[0, 1], [2, 7]], ..Elements::default() };
        let error = Model::new(&wrong, &points, &STYLE).unwrap_err().to_string();
        assert_eq!(error, "strand edge 1 names vertex 7, but there are only 7 vertices");
        let short = Elements { body: &[0], ..Elements::default() };
        assert!(Model::new(&short, &points, &STYLE).is_err());
        let model = Model::new(&Elements::default(), &points, &STYLE).unwrap();
        assert!(model.drawing(&Frame { positions: &points[1..], values: &[] }).is_err());
        assert!(model.drawing(&Frame { positions: &points, values: &[0.0] }).is_err());
        // Nothing to draw is no error.
        assert!(model.drawing(&Frame { positions: &points, values: &[] }).unwrap().radius > 0.0);
    }
}
