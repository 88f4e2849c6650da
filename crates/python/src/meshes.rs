//! Meshes by themselves: files, the judge, the search, repair.

use crate::arrays::{self, Indices, Rows};
use crate::compute::compute;
use crate::error;
use bowknot::check::{Judge, Parts, PathOptions, StateOptions};
use bowknot::geometry::{BodyFilter, CollisionModel, HalfSpace, PairKind, Topology};
use bowknot::io::{Import, Mesh, Up};
use bowknot::proximity::{PairList, ProximitySearch};
use bowknot::repair::RepairParams;
use bowknot_errors::Parameters;
use numpy::PyReadonlyArray1;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::PathBuf;

/// Elements over one array of vertices.
#[derive(FromPyObject)]
pub struct Given<'py> {
    triangles: Indices<'py>,
    strands: Indices<'py>,
    particles: PyReadonlyArray1<'py, u32>,
    obstacle: PyReadonlyArray1<'py, bool>,
    body: PyReadonlyArray1<'py, u32>,
    planes: Rows<'py>,
}

/// The same, as the library takes it.
struct Owned {
    triangles: Vec<[u32; 3]>,
    strands: Vec<[u32; 2]>,
    particles: Vec<u32>,
    obstacle: Vec<bool>,
    body: Vec<u32>,
    half_spaces: Vec<HalfSpace>,
}

impl Given<'_> {
    fn owned(&self) -> PyResult<Owned> {
        Ok(Owned {
            triangles: arrays::elements(&self.triangles)?,
            strands: arrays::elements(&self.strands)?,
            particles: arrays::column(&self.particles),
            obstacle: arrays::column(&self.obstacle),
            body: arrays::column(&self.body),
            half_spaces: arrays::half_spaces(&self.planes)?,
        })
    }
}

impl Owned {
    fn judge(&self, vertex_count: usize) -> PyResult<Judge> {
        let parts = Parts {
            vertex_count,
            triangles: &self.triangles,
            strands: &self.strands,
            particles: &self.particles,
            obstacle: &self.obstacle,
            body: &self.body,
            half_spaces: &self.half_spaces,
            filters: &[],
        };
        Judge::new(&parts).map_err(error::input)
    }
}

/// What the judge says of a state: its report as JSON, and each intersection in words.
#[pyfunction]
pub fn check_state(
    py: Python<'_>,
    positions: Rows<'_>,
    elements: Given<'_>,
    limit: usize,
    distance: bool,
) -> PyResult<(String, Vec<String>)> {
    let (x, elements) = (arrays::points(&positions)?, elements.owned()?);
    let report = compute(py, |_| {
        let judge = elements.judge(x.len())?;
        judge.check_state(&x, &StateOptions { limit, distance }).map_err(error::input)
    })?;
    let report = report.finish()??;
    let words = report.intersections.iter().map(ToString::to_string).collect();
    Ok((serde_json::to_string(&report).map_err(error::internal)?, words))
}

/// What the judge says of the straight path between two states, likewise.
#[pyfunction]
pub fn check_path(
    py: Python<'_>,
    start: Rows<'_>,
    end: Rows<'_>,
    elements: Given<'_>,
    limit: usize,
) -> PyResult<(String, Vec<String>)> {
    let (start, end, elements) = (arrays::points(&start)?, arrays::points(&end)?, elements.owned()?);
    let report = compute(py, |_| {
        let judge = elements.judge(start.len())?;
        // The start need not be clear.
        let options = PathOptions { limit, skip_unmoved: false };
        judge.check_path(&start, &end, &options).map_err(error::input)
    })?;
    let report = report.finish()??;
    let words = report.hits.iter().map(ToString::to_string).collect();
    Ok((serde_json::to_string(&report).map_err(error::internal)?, words))
}

/// All pairs of primitives nearer than a distance [m].
#[pyfunction]
pub fn search<'py>(
    py: Python<'py>,
    positions: Rows<'_>,
    elements: Given<'_>,
    distance: f64,
) -> PyResult<Bound<'py, PyDict>> {
    if !(distance.is_finite() && distance >= 0.0) {
        return Err(error::input(format!("distance {distance} must be finite and at least 0")));
    }
    let (x, elements) = (arrays::points(&positions)?, elements.owned()?);
    let found = compute(py, |_| {
        let topology = Topology::builder(x.len())
            .triangles(elements.triangles)
            .strand_edges(elements.strands)
            .particles(elements.particles)
            .build()
            .map_err(error::input)?;
        let count = elements.body.iter().max().map_or(0, |&body| body as usize + 1);
        let mut filters = vec![BodyFilter::DEFORMABLE; count];
        for (&body, _) in elements.body.iter().zip(&elements.obstacle).filter(|(_, obstacle)| **obstacle) {
            filters[body as usize] = BodyFilter::OBSTACLE;
        }
        let model = CollisionModel::new(topology, elements.body, filters, elements.half_spaces);
        let model = model.map_err(error::input)?;
        let (mut pairs, mut separations) = (PairList::default(), Vec::new());
        let radii = vec![0.5 * distance; x.len()];
        ProximitySearch::new(&model).search(&model, &x, &radii, &mut pairs, &mut separations);
        PyResult::Ok((pairs, separations))
    })?;
    let (pairs, separations) = found.finish()??;
    let near: Vec<_> =
        pairs.iter().zip(&separations).filter(|(_, separation)| separation.distance <= distance).collect();
    let result = PyDict::new(py);
    let kind_of = |kind: &PairKind| *kind as u8;
    result.set_item("kinds", arrays::list(py, near.iter().map(|((kind, _), _)| kind_of(kind))))?;
    result.set_item("elements", arrays::row_array(py, near.iter().map(|((_, pair), _)| pair.elements))?)?;
    result.set_item("vertices", arrays::row_array(py, near.iter().map(|((_, pair), _)| pair.vertices))?)?;
    result.set_item("distances", arrays::list(py, near.iter().map(|(_, s)| s.distance)))?;
    result
        .set_item("normals", arrays::row_array(py, near.iter().map(|(_, s)| <[f64; 3]>::from(s.normal)))?)?;
    let weights = near.iter().map(|((kind, _), s)| s.signed_weights(*kind));
    result.set_item("weights", arrays::row_array(py, weights)?)?;
    Ok(result)
}

/// The arrays of a mesh.
fn arrays_of<'py>(py: Python<'py>, mesh: &Mesh) -> PyResult<Bound<'py, PyDict>> {
    let result = PyDict::new(py);
    result.set_item("vertices", arrays::point_array(py, &mesh.positions)?)?;
    result.set_item("faces", arrays::row_array(py, mesh.triangles.iter().copied())?)?;
    result.set_item("tets", arrays::row_array(py, mesh.tets.iter().copied())?)?;
    result.set_item("edges", arrays::row_array(py, mesh.strands.iter().copied())?)?;
    result.set_item("particles", arrays::list(py, mesh.particles.iter().copied()))?;
    Ok(result)
}

/// An axis by its name.
pub fn up_of(name: &str) -> PyResult<Up> {
    match name {
        "x" => Ok(Up::X),
        "y" => Ok(Up::Y),
        "z" => Ok(Up::Z),
        other => Err(error::input(format!("up {other:?}: it must be \"x\", \"y\" or \"z\""))),
    }
}

/// Reads a mesh file, or a part of it.
#[pyfunction]
pub fn read_mesh<'py>(
    py: Python<'py>,
    path: PathBuf,
    up: &str,
    scale: f64,
    part: Option<String>,
) -> PyResult<Bound<'py, PyDict>> {
    let import = Import { up: up_of(up)?, scale };
    import.validate().map_err(error::input)?;
    let read = compute(py, |_| {
        let read = match &part {
            Some(part) => bowknot::io::read_mesh_part(&path, &import, part),
            None => bowknot::io::read_mesh(&path, &import),
        };
        let mut mesh = read.map_err(error::input)?;
        if let Some(faults) = mesh.triangulate().describe() {
            tracing::warn!("{}: {faults}", path.display());
        }
        // Objects of an OBJ are parts, too.
        if mesh.body.is_none() {
            mesh.name_parts(&path.file_stem().unwrap_or_default().to_string_lossy());
        }
        PyResult::Ok(mesh)
    })?;
    let mesh = read.finish()??;
    let groups = PyDict::new(py);
    for (name, vertices) in mesh.groups.iter() {
        groups.set_item(name, arrays::list(py, vertices.iter().copied()))?;
    }
    let result = arrays_of(py, &mesh)?;
    result.set_item("groups", groups)?;
    result.set_item("bodies", arrays::list(py, mesh.body.iter().flatten().copied()))?;
    result.set_item("names", &mesh.names)?;
    result.set_item("obstacles", arrays::list(py, mesh.obstacle.iter().flatten().copied()))?;
    Ok(result)
}

/// Repairs a mesh: its arrays, and what was done as JSON.
#[pyfunction]
#[allow(clippy::too_many_arguments)]
pub fn repair<'py>(
    py: Python<'py>,
    positions: Rows<'_>,
    triangles: Indices<'_>,
    tets: Indices<'_>,
    strands: Indices<'_>,
    weld_distance: Option<f64>,
    drop_lines: bool,
    drop_triangles: bool,
) -> PyResult<(Bound<'py, PyDict>, String)> {
    let mesh = Mesh {
        positions: arrays::points(&positions)?,
        triangles: arrays::elements(&triangles)?,
        tets: arrays::elements(&tets)?,
        strands: arrays::elements(&strands)?,
        ..Mesh::default()
    };
    let params = RepairParams { weld_distance, drop_lines, drop_triangles };
    let repaired = compute(py, |_| bowknot::repair::repair(&mesh, &params).map_err(error::input))?;
    let (clean, report) = repaired.finish()??;
    Ok((arrays_of(py, &clean)?, serde_json::to_string(&report).map_err(error::internal)?))
}
