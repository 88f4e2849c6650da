//! A picture of a state that intersects: the whole, and a cutout around the deepest place.

use crate::exit::Failure;
use bowknot::check::StateOptions;
use bowknot::geometry::Point;
use bowknot::judging::JudgedState;
use bowknot_render::{
    DEFAULT_FOV, Elements, Fit, Frame, Legend, Model, Picture, Quality, Renderer, Shot, Style, View,
    body_color, write_png,
};
use std::path::Path;

/// Size of each half [pixels].
const SIZE: [u32; 2] = [720, 600];
/// Radius of the cutout, relative to the longest edge of the elements at the place.
const CUTOUT: f64 = 3.0;

/// Draws a state beside the elements around its deepest intersection, which have the colors of their parts; in
/// the whole, what intersects has them, and all else is gray. Returns what was written, in words.
pub fn write(path: &Path, state: &JudgedState<'_>) -> Result<String, Failure> {
    let all = StateOptions { limit: usize::MAX, distance: false };
    let found = state.judge.check_state(state.positions, &all).map_err(Failure::input)?.intersections;
    let Some(deepest) = found.iter().max_by(|a, b| a.depth.total_cmp(&b.depth)) else {
        return Ok(String::new());
    };
    let offending = state.judge.offending_mesh(state.positions, &found);
    let mut renderer = Renderer::new(Quality::FINE)?;

    // What intersects is drawn over copies of its vertices, in the colors of the parts.
    let mesh = state.mesh;
    let part = |v: u32| mesh.body.as_ref().map_or(0, |body| body[v as usize]);
    let count = state.positions.len() as u32;
    let positions: Vec<Point> = state.positions.iter().chain(&offending.positions).copied().collect();
    let own = |v: u32| v + count;
    let is_offending = |t: &[u32; 3]| t.iter().all(|v| offending.vertices.binary_search(v).is_ok());
    let mut rest = mesh.clone();
    rest.leave_out(&mesh.absent(state.positions));
    rest.triangles.retain(|triangle| !is_offending(triangle));
    rest.triangles.extend(offending.triangles.iter().map(|t| t.map(own)));
    rest.strands.extend(offending.edges.iter().map(|e| e.map(own)));
    let gray: Vec<bool> = (0..positions.len() as u32).map(|v| v < count).collect();
    let body: Vec<u32> = (0..count).chain(offending.vertices.iter().copied()).map(part).collect();
    let whole = Elements {
        triangles: &rest.triangles,
        strands: &rest.strands,
        particles: &rest.particles,
        obstacle: &gray,
        body: &body,
    };
    let left = draw(&mut renderer, &whole, &positions, None)?;

    let near = |v: &u32| {
        let corners = deepest.vertices.iter().flatten().map(|&w| &state.positions[w as usize]);
        let size = corners.map(|p| (p - deepest.place).norm()).fold(0.0, f64::max);
        (state.positions[*v as usize] - deepest.place).norm() <= CUTOUT * size
    };
    let [a, b] = deepest.bodies.map(|body| body.unwrap_or(u32::MAX));
    let involved = |v: &u32| [a, b].contains(&part(*v)) && near(v);
    let triangles: Vec<[u32; 3]> =
        mesh.triangles.iter().filter(|t| t.iter().all(involved)).copied().collect();
    let strands: Vec<[u32; 2]> = mesh.strands.iter().filter(|e| e.iter().all(involved)).copied().collect();
    let particles: Vec<u32> = mesh.particles.iter().filter(|v| involved(v)).copied().collect();
    let of_state: Vec<u32> = (0..count).map(part).collect();
    let cutout = Elements {
        triangles: &triangles,
        strands: &strands,
        particles: &particles,
        obstacle: &[],
        body: &of_state,
    };
    let mut names: Vec<u32> = deepest.bodies.iter().flatten().copied().collect();
    names.dedup();
    let names =
        names.iter().filter_map(|&part| Some((mesh.names.get(part as usize)?.clone(), body_color(part))));
    let legend = Legend::Names(names.collect());
    let right = draw(&mut renderer, &cutout, state.positions, Some(&legend))?;

    let mut picture = Picture::new(2 * SIZE[0], SIZE[1], [255; 3]);
    for (row, line) in picture.pixels.chunks_mut(2 * SIZE[0] as usize).enumerate() {
        let (first, last) = line.split_at_mut(SIZE[0] as usize);
        let pixels = row * SIZE[0] as usize..(row + 1) * SIZE[0] as usize;
        first.copy_from_slice(&left.pixels[pixels.clone()]);
        last.copy_from_slice(&right.pixels[pixels]);
    }
    crate::render::encode(path, |out| write_png(out, &picture))?;
    Ok(format!("drew {} to {}", state.name, path.display()))
}

fn draw(
    renderer: &mut Renderer,
    elements: &Elements<'_>,
    positions: &[Point],
    legend: Option<&Legend>,
) -> Result<Picture, Failure> {
    let corners = elements.triangles.as_flattened().iter().chain(elements.strands.as_flattened());
    let drawn = || corners.clone().chain(elements.particles).map(|&v| &positions[v as usize]);
    let (low, high) = drawn()
        .fold((Point::from([f64::INFINITY; 3]), Point::from([f64::NEG_INFINITY; 3])), |(low, high), p| {
            (low.inf(p), high.sup(p))
        });
    let radius = 2e-3 * (high - low).norm().min(f64::MAX);
    let legend_width = legend.map_or(0, |legend| legend.width(SIZE[1])).min(SIZE[0] / 2);
    let aspect = f64::from(SIZE[0] - legend_width) / f64::from(SIZE[1]);
    let mut fit = Fit::new(View::ThreeQuarter, DEFAULT_FOV, aspect);
    drawn().for_each(|p| fit.add(p, radius));
    let style = Style { strand_radius: radius, particle_radius: radius };
    let model = Model::new(elements, positions, &style)?;
    let shot = Shot { legend_width, ..Shot::new(fit.camera(), SIZE) };
    let mut picture = renderer.render(&model, &Frame { positions, values: &[] }, &shot)?;
    if let Some(legend) = legend {
        legend.draw(&mut picture);
    }
    Ok(picture)
}
