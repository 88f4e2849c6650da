//! Changes between time steps that need more than a call.

use crate::arrays::{self, Rows};
use crate::error;
use bowknot::Simulator;
use bowknot::geometry::Vector;
use bowknot::geometry::nalgebra::{Isometry3, Matrix3, Rotation3, Translation3, UnitQuaternion};
use bowknot::scene::Material;
use pyo3::PyResult;

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
    let material = kind.map_or_else(|| Ok(Material::default()), |kind| Material::from_toml(kind, text));
    let material = material.map_err(|error| error::input(error.to_string()))?;
    simulator.set_material(body, material).map_err(error::simulation)
}

/// Radius with which strands and grains touch in a picture when they are in contact [m].
pub fn drawn_radius(simulator: &Simulator) -> f64 {
    let resolver = simulator.resolver().scene();
    let own = resolver.contact().bodies().iter().filter_map(|body| body.delta);
    own.min_by(f64::total_cmp).unwrap_or(resolver.lengths().delta) / 2.0
}
