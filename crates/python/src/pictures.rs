//! Pictures as arrays of pixels.

use crate::arrays::{self, Indices, Rows};
use crate::compute::compute;
use crate::error;
use bowknot_render::{
    Camera, Elements, Fit, Frame, Model, OBSTACLE_COLOR, Quality, RenderError, Renderer, Shot, Style, View,
};
use numpy::{PyArray1, PyArray3, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;

/// What is drawn.
#[derive(FromPyObject)]
pub struct Drawn<'py> {
    positions: Rows<'py>,
    triangles: Indices<'py>,
    strands: Indices<'py>,
    particles: PyReadonlyArray1<'py, u32>,
    obstacle: PyReadonlyArray1<'py, bool>,
    body: PyReadonlyArray1<'py, u32>,
    planes: Rows<'py>,
    values: PyReadonlyArray1<'py, f32>,
    colors: PyReadonlyArray2<'py, u8>,
    radius: f64,
}

/// How it is drawn.
#[derive(FromPyObject)]
pub struct Look {
    size: [u32; 2],
    view: String,
    fov: f64,
    eye: Option<[f64; 3]>,
    target: Option<[f64; 3]>,
    fine: bool,
}

/// The color of a body by its number; of obstacles without one.
#[pyfunction]
#[pyo3(signature = (body))]
pub fn body_color(body: Option<u32>) -> [u8; 3] {
    body.map_or(OBSTACLE_COLOR, bowknot_render::body_color)
}

/// Draws a picture: an array of shape (height, width, 3).
#[pyfunction]
pub fn render<'py>(py: Python<'py>, drawn: Drawn<'_>, look: Look) -> PyResult<Bound<'py, PyArray3<u8>>> {
    let refused = |failed: RenderError| match failed {
        RenderError::NoDriver { .. } | RenderError::Device { .. } | RenderError::OutOfMemory { .. } => {
            error::device(failed)
        }
        failed => error::input(failed),
    };
    let view = match look.view.as_str() {
        "front" => View::Front,
        "side" => View::Side,
        "top" => View::Top,
        "three-quarter" => View::ThreeQuarter,
        other => {
            let message =
                format!("view {other:?}: it must be \"front\", \"side\", \"top\" or \"three-quarter\"");
            return Err(error::input(message));
        }
    };
    if !(look.fov > 0.0 && look.fov < 180.0) {
        return Err(error::input(format!("fov {} must lie between 0 and 180", look.fov)));
    }
    let positions = arrays::points(&drawn.positions)?;
    let (triangles, strands) = (arrays::elements(&drawn.triangles)?, arrays::elements(&drawn.strands)?);
    let particles = arrays::column(&drawn.particles);
    let (obstacle, body) = (arrays::column(&drawn.obstacle), arrays::column(&drawn.body));
    let values = arrays::column(&drawn.values);
    let ground = arrays::half_spaces(&drawn.planes)?;
    let colors: Vec<u8> = drawn.colors.as_array().iter().copied().collect();
    let radius = drawn.radius;
    let picture = compute(py, |_| {
        let elements = Elements {
            triangles: &triangles,
            strands: &strands,
            particles: &particles,
            obstacle: &obstacle,
            body: &body,
        };
        let style = Style { strand_radius: radius, particle_radius: radius };
        let mut model = Model::new(&elements, &positions, &style).map_err(refused)?;
        if !colors.is_empty() {
            model.set_colors(colors.as_chunks::<3>().0).map_err(refused)?;
        }
        let aspect = f64::from(look.size[0]) / f64::from(look.size[1].max(1));
        let mut fit = Fit::new(view, look.fov, aspect);
        positions.iter().for_each(|x| fit.add(x, radius));
        let fitted = fit.camera();
        let camera = Camera {
            eye: look.eye.map_or(fitted.eye, Into::into),
            target: look.target.map_or(fitted.target, Into::into),
            fov: look.fov,
        };
        let shot = Shot { ground, ..Shot::new(camera, look.size) };
        let quality = if look.fine { Quality::FINE } else { Quality::FAST };
        let mut renderer = Renderer::new(quality).map_err(refused)?;
        let frame = Frame { positions: &positions, values: &values };
        renderer.render(&model, &frame, &shot).map_err(refused)
    })?;
    let picture = picture.finish()??;
    let (height, width) = (picture.height as usize, picture.width as usize);
    PyArray1::from_vec(py, picture.pixels.into_iter().flatten().collect()).reshape([height, width, 3])
}
