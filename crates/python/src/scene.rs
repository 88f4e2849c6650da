//! Scenes: read, built in, or put together from tables and arrays.

use crate::arrays::{self, Indices, Rows};
use crate::compute::compute;
use crate::error;
use bowknot::geometry::Point;
use bowknot::scene::{BUILTIN, SceneError};
use bowknot::shapes::{MeshArrays, Shape};
use pyo3::prelude::*;
use serde::Deserialize;
use std::path::{Path, PathBuf};
use toml::{Table, Value};

/// A scene; it never changes.
#[pyclass(frozen, module = "bowknot._native")]
pub struct Scene {
    pub scene: bowknot::Scene,
}

/// A mesh by its arrays, for the body or obstacle of a place in the tables given.
type GivenMesh<'py> = (String, usize, Rows<'py>, Indices<'py>, Indices<'py>, Indices<'py>);

/// Which list of a scene a mesh is for.
#[derive(Clone, Copy, PartialEq, Eq)]
enum List {
    Body,
    Obstacle,
}

/// Names and descriptions of the built-in scenes.
#[pyfunction]
pub fn builtin_scenes() -> Vec<(&'static str, &'static str)> {
    BUILTIN.iter().map(|scene| (scene.name, scene.summary)).collect()
}

#[pymethods]
impl Scene {
    /// A scene from text; mesh paths are relative to `folder`.
    #[staticmethod]
    fn from_text(text: &str, folder: PathBuf) -> PyResult<Self> {
        let scene = bowknot::Scene::from_toml(text, folder).map_err(error::input)?;
        Ok(Self { scene })
    }

    /// A scene file.
    #[staticmethod]
    fn load(path: PathBuf) -> PyResult<Self> {
        let scene = bowknot::Scene::load::<&str>(path, &[]).map_err(error::input)?;
        Ok(Self { scene })
    }

    /// A built-in scene.
    #[staticmethod]
    fn builtin(name: &str, scale: f64) -> PyResult<Self> {
        let scene = bowknot::Scene::builtin(name, scale).map_err(error::input)?;
        Ok(Self { scene })
    }

    /// A scene without bodies.
    #[staticmethod]
    fn empty() -> Self {
        Self { scene: bowknot::Scene::default() }
    }

    /// The scene with more tables, as TOML, and with meshes in place of the shapes of their bodies and
    /// obstacles.
    fn extended(&self, text: &str, meshes: Vec<GivenMesh<'_>>) -> PyResult<Self> {
        let mut given = Vec::new();
        for (list, index, positions, triangles, tets, edges) in meshes {
            let list = if list == "obstacle" { List::Obstacle } else { List::Body };
            let mesh = MeshArrays {
                positions: arrays::points(&positions)?,
                triangles: arrays::elements(&triangles)?,
                tets: arrays::elements(&tets)?,
                edges: arrays::elements(&edges)?,
            };
            given.push((list, index, mesh));
        }
        let tables: Table = text.parse().map_err(|error: toml::de::Error| error::input(error.message()))?;
        let scene = extend(&self.scene, tables, given).map_err(error::input)?;
        Ok(Self { scene })
    }

    /// The scene with assignments to its keys.
    fn with_sets(&self, sets: Vec<String>) -> PyResult<Self> {
        let scene = self.scene.clone().with_sets(&sets).map_err(error::input)?;
        Ok(Self { scene })
    }

    /// The scene as TOML, with every default or without those.
    fn to_toml(&self, short: bool) -> String {
        if short { self.scene.to_short_toml() } else { self.scene.to_toml() }
    }

    /// Counts of what the scene holds, as JSON.
    fn info(&self, py: Python<'_>) -> PyResult<String> {
        let info = compute(py, |_| self.scene.info())?.finish()?.map_err(error::input)?;
        serde_json::to_string(&info).map_err(error::internal)
    }

    #[getter]
    fn name(&self) -> &str {
        self.scene.name()
    }

    #[getter]
    fn frames(&self) -> usize {
        self.scene.simulation.frames
    }

    #[getter]
    fn time_step(&self) -> f64 {
        self.scene.simulation.dt
    }

    /// Folder that mesh paths are relative to.
    #[getter]
    fn folder(&self) -> &Path {
        &self.scene.folder
    }

    /// Names of bodies and of obstacles.
    #[getter]
    fn names(&self) -> [Vec<&str>; 2] {
        let bodies = self.scene.bodies.iter().map(|body| body.name.as_str());
        let obstacles = self.scene.obstacles.iter().map(|obstacle| obstacle.name.as_str());
        [bodies.collect(), obstacles.collect()]
    }

    fn __eq__(&self, other: &Self) -> bool {
        self.scene == other.scene
    }
}

/// The least mesh of the kind that a mesh makes. It stands for the mesh while tables are read, so that no large
/// array becomes a table.
fn stand_in(mesh: &MeshArrays) -> MeshArrays {
    let corners = |count: usize| {
        let all = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        all[..count].iter().map(|corner| Point::from(*corner)).collect()
    };
    match mesh {
        MeshArrays { tets, .. } if !tets.is_empty() => MeshArrays::volume(corners(4), vec![[0, 1, 2, 3]]),
        MeshArrays { triangles, .. } if !triangles.is_empty() => {
            MeshArrays::surface(corners(3), vec![[0, 1, 2]])
        }
        MeshArrays { edges, .. } if !edges.is_empty() => MeshArrays::strands(corners(2), vec![[0, 1]]),
        _ => MeshArrays::points(corners(1)),
    }
}

fn extend(
    base: &bowknot::Scene,
    tables: Table,
    given: Vec<(List, usize, MeshArrays)>,
) -> Result<bowknot::Scene, String> {
    let in_words = |error: SceneError| error.to_string();
    let mut base = base.clone();
    let mut meshes: Vec<(List, usize, MeshArrays)> = Vec::new();
    for (index, body) in base.bodies.iter_mut().enumerate() {
        take_out(&mut body.shape, (List::Body, index), &mut meshes);
    }
    for (index, obstacle) in base.obstacles.iter_mut().enumerate() {
        take_out(&mut obstacle.shape, (List::Obstacle, index), &mut meshes);
    }
    let counts = [base.bodies.len(), base.obstacles.len()];
    let is_empty = base == bowknot::Scene::default();
    let mut root = if is_empty { Table::new() } else { Table::try_from(&base).map_err(|e| e.to_string())? };
    for (key, value) in tables {
        merge(&mut root, key, value);
    }
    for (list, index, mesh) in given {
        let (key, first) = match list {
            List::Body => ("body", counts[0]),
            List::Obstacle => ("obstacle", counts[1]),
        };
        let entry =
            root.get_mut(key).and_then(Value::as_array_mut).and_then(|all| all.get_mut(first + index));
        let entry = entry.and_then(Value::as_table_mut).ok_or("a mesh without its body or obstacle")?;
        let shape = Shape::Arrays(stand_in(&mesh));
        entry.insert("shape".to_owned(), Value::try_from(shape).map_err(|error| error.to_string())?);
        if list == List::Body {
            entry.entry("kind").or_insert_with(|| Value::from(mesh.kind().name()));
        }
        meshes.push((list, first + index, mesh));
    }
    // A scene that is still being put together may have no body yet.
    let holds = |key: &str| root.get(key).and_then(Value::as_array).is_some_and(|list| !list.is_empty());
    let lacks_body = !holds("body") && !holds("pin");
    if lacks_body {
        let body = Table::from_iter([("shape".to_owned(), Value::from("sheet"))]);
        root.insert("body".to_owned(), Value::Array(vec![Value::Table(body)]));
    }
    let mut scene =
        bowknot::Scene::deserialize(Value::Table(root)).map_err(|error| error.message().to_owned())?;
    if lacks_body {
        scene.bodies.clear();
    }
    for (list, index, mesh) in meshes {
        let shape = match list {
            List::Body => scene.bodies.get_mut(index).map(|body| &mut body.shape),
            List::Obstacle => scene.obstacles.get_mut(index).map(|obstacle| &mut obstacle.shape),
        };
        if let Some(shape) = shape {
            *shape = Some(Shape::Arrays(mesh));
        }
    }
    let scene = bowknot::Scene { folder: base.folder, ..scene };
    if !lacks_body {
        scene.validate().map_err(in_words)?;
    }
    Ok(scene)
}

/// Puts a stand-in in the place of a mesh of arrays.
fn take_out(
    shape: &mut Option<Shape>,
    (list, index): (List, usize),
    meshes: &mut Vec<(List, usize, MeshArrays)>,
) {
    if let Some(Shape::Arrays(mesh)) = shape {
        let stand_in = stand_in(mesh);
        meshes.push((list, index, std::mem::replace(mesh, stand_in)));
    }
}

/// Adds a key to a table: entries of lists behind those that there are, keys of tables over them.
fn merge(table: &mut Table, key: String, value: Value) {
    match (table.get_mut(&key), value) {
        (Some(Value::Array(own)), Value::Array(more)) => own.extend(more),
        (Some(Value::Table(own)), Value::Table(more)) => {
            more.into_iter().for_each(|(key, value)| merge(own, key, value));
        }
        (_, value) => {
            table.insert(key, value);
        }
    }
}
