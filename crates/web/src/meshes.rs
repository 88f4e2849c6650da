//! Meshes in place of the files that a browser does not have.

use crate::arrays;
use crate::error::{Thrown, input};
use crate::options::Options;
use bowknot::geometry::Point;
use bowknot::io::{Import, Mesh, read_mesh_bytes};
use bowknot::shapes::{MeshArrays, Shape};
use js_sys::{Array, Float64Array, Object, Uint8Array};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use wasm_bindgen::prelude::wasm_bindgen;
use wasm_bindgen::{JsCast, JsValue};

/// Keys of a mesh that is given by its arrays.
const ARRAYS: [&str; 4] = ["positions", "triangles", "tets", "edges"];

/// Meshes by the names that a scene has for them.
pub struct Meshes(BTreeMap<PathBuf, MeshArrays>);

impl Meshes {
    /// From an object whose keys are names of files, and whose values are their texts, their bytes, or arrays.
    pub fn new(given: &JsValue) -> Result<Self, Thrown> {
        if given.is_undefined() || given.is_null() {
            return Ok(Self(BTreeMap::new()));
        }
        let Some(object) = given.dyn_ref::<Object>() else {
            return Err(input("meshes: an object with a mesh for each name is expected"));
        };
        let mesh = |entry: JsValue| {
            let entry = Array::from(&entry);
            let name = entry.get(0).as_string().unwrap_or_default();
            let mesh = mesh(&name, &entry.get(1))?;
            Ok((PathBuf::from(name), mesh))
        };
        Ok(Self(Object::entries(object).iter().map(mesh).collect::<Result<_, Thrown>>()?))
    }

    /// Puts the meshes into a scene, each in place of the file of its name.
    pub fn put_into(&self, scene: &mut bowknot::Scene) -> Result<(), Thrown> {
        for body in &mut scene.bodies {
            let owner = format!("body {}", body.name);
            self.replace(&owner, &mut body.mesh, &body.part, &mut body.shape)?;
        }
        for obstacle in &mut scene.obstacles {
            let owner = format!("obstacle {}", obstacle.name);
            self.replace(&owner, &mut obstacle.mesh, &obstacle.part, &mut obstacle.shape)?;
            if let Some(sequence) = &obstacle.sequence {
                let sequence = sequence.display();
                let remedy = "lead it with setObstacleTargets";
                return Err(input(format!("{owner}: a browser reads no animation {sequence}; {remedy}")));
            }
        }
        scene.validate().map_err(input)
    }

    fn replace(
        &self,
        owner: &str,
        mesh: &mut Option<PathBuf>,
        part: &Option<String>,
        shape: &mut Option<Shape>,
    ) -> Result<(), Thrown> {
        let Some(path) = mesh.as_deref() else { return Ok(()) };
        let file = path.display();
        let Some(arrays) = self.0.get(path) else {
            let known: Vec<String> = self.0.keys().map(|name| name.display().to_string()).collect();
            let known = if known.is_empty() { "none is given".to_owned() } else { known.join(", ") };
            return Err(input(format!("{owner}: no mesh {file} is given; meshes are: {known}")));
        };
        if let Some(part) = part {
            return Err(input(format!("{owner}: a browser reads {file} as a whole, not its part {part}")));
        }
        *shape = Some(Shape::Arrays(arrays.clone()));
        *mesh = None;
        Ok(())
    }
}

/// The box of a mesh, whose `source` is one as for `Scene.fromToml`: its lowest x y z, then its highest [m].
#[wasm_bindgen(js_name = boundsOf)]
pub fn bounds_of(
    name: &str,
    #[wasm_bindgen(unchecked_param_type = "MeshSource")] source: &JsValue,
) -> Result<Float64Array, Thrown> {
    let mesh = mesh(name, source)?;
    let first = mesh.positions.first().copied().ok_or_else(|| input(format!("{name}: no vertices")))?;
    let around = |(low, high): (Point, Point), point: &Point| (low.inf(point), high.sup(point));
    let (low, high) = mesh.positions.iter().fold((first, first), around);
    Ok(arrays::from_points(&[low, high]))
}

/// One mesh: the text or the bytes of a file of this name, or arrays.
fn mesh(name: &str, given: &JsValue) -> Result<MeshArrays, Thrown> {
    let bytes = match (given.as_string(), given.dyn_ref::<Uint8Array>()) {
        (Some(text), _) => text.into_bytes(),
        (None, Some(bytes)) => bytes.to_vec(),
        (None, None) => return of_arrays(name, given),
    };
    let mut mesh = read_mesh_bytes(Path::new(name), &bytes, &Import::default()).map_err(input)?;
    if let Some(faults) = mesh.triangulate().describe() {
        tracing::warn!("{name}: {faults}");
    }
    let Mesh { positions, triangles, tets, strands, .. } = mesh;
    Ok(MeshArrays { positions, triangles, tets, edges: strands })
}

fn of_arrays(name: &str, given: &JsValue) -> Result<MeshArrays, Thrown> {
    let options = Options::new(given, "a mesh of arrays", &ARRAYS)?;
    let key = |key: &str| format!("mesh {name}: {key}");
    let Some(positions) = options.floats("positions")? else {
        return Err(input(format!("mesh {name}: text, bytes, or an object with positions is expected")));
    };
    let none = || js_sys::Uint32Array::new_with_length(0);
    Ok(MeshArrays {
        positions: arrays::points(&key("positions"), &positions)?,
        triangles: arrays::elements(&key("triangles"), &options.indices("triangles")?.unwrap_or_else(none))?,
        tets: arrays::elements(&key("tets"), &options.indices("tets")?.unwrap_or_else(none))?,
        edges: arrays::elements(&key("edges"), &options.indices("edges")?.unwrap_or_else(none))?,
    })
}
