//! Changes between time steps that need more than a call.

use crate::arrays::{self, Rows};
use crate::error;
use bowknot::Simulator;
use bowknot::geometry::Vector;
use bowknot::geometry::nalgebra::{Isometry3, Matrix3, Rotation3, Translation3, UnitQuaternion};
use bowknot::scene::{BodyKind, Material};
use pyo3::PyResult;
use serde::Deserialize;
use toml::{Table, Value};

/// A rigid transform from the rows of its 4 x 4 matrix, whose rotation the Python part has checked.
pub fn isometry(rows: &Rows<'_>) -> PyResult<Isometry3<f64>> {
    let rows = arrays::table::<4>(rows)?;
    let [a, b, c, _] = rows.as_slice() else {
        return Err(error::input("a pose is an array of shape (4, 4)"));
    };
    let rotation = Matrix3::new(a[0], a[1], a[2], b[0], b[1], b[2], c[0], c[1], c[2]);
    let rotation = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(rotation));
    Ok(Isometry3::from_parts(Translation3::from(Vector::new(a[3], b[3], c[3])), rotation))
}

/// Adds the bodies and obstacles of another scene.
pub fn add(simulator: &mut Simulator, scene: &bowknot::Scene) -> PyResult<()> {
    for body in scene.bodies.clone() {
        simulator.add_body(body).map_err(error::simulation)?;
    }
    for obstacle in scene.obstacles.clone() {
        simulator.add_obstacle(obstacle).map_err(error::simulation)?;
    }
    Ok(())
}

/// Gives a body the material that `text` describes, as the value of the key `material` in TOML.
pub fn set_material(simulator: &mut Simulator, body: &str, text: &str) -> PyResult<()> {
    let spec = simulator.scene().bodies.iter().find(|spec| spec.name == body);
    let kind = spec.map(|spec| spec.kind);
    // An unknown body is refused by the simulator, whatever the material.
    let material = kind.map_or_else(|| Ok(Material::default()), |kind| material(kind, text))?;
    simulator.set_material(body, material).map_err(error::simulation)
}

/// A material by a name or by its numbers.
fn material(kind: BodyKind, text: &str) -> PyResult<Material> {
    // Read as the material of a body that has nothing else, so that messages are those of a scene.
    let read = |text: &str| -> Result<Material, String> {
        let table: Table = text.parse().map_err(|error: toml::de::Error| error.message().to_owned())?;
        let mut body = table;
        // No file is read before the scene is simulated.
        body.insert("mesh".to_owned(), Value::from("mesh.obj"));
        body.insert("kind".to_owned(), Value::from(kind.name()));
        let root = Table::from_iter([("body".to_owned(), Value::Array(vec![Value::Table(body)]))]);
        let scene =
            bowknot::Scene::deserialize(Value::Table(root)).map_err(|error| error.message().to_owned())?;
        scene.bodies.first().map(|body| body.material).ok_or_else(|| "no material".to_owned())
    };
    read(&format!("material = {text}")).map_err(error::input)
}

/// Radius with which strands and grains touch in a picture when they are in contact [m].
pub fn drawn_radius(simulator: &Simulator) -> f64 {
    let resolver = simulator.resolver().scene();
    let own = resolver.contact().bodies().iter().filter_map(|body| body.delta);
    own.min_by(f64::total_cmp).unwrap_or(resolver.lengths().delta) / 2.0
}
