//! What is changed between two time steps. Nothing here makes an intersection: pins and obstacles are led.

use crate::arrays;
use crate::error::{self, Thrown, input};
use crate::simulator::Simulator;
use bowknot::dynamics::{ClothMaterial, SolidMaterial, StrandMaterial};
use bowknot::geometry::nalgebra::{Isometry3, Matrix3, Rotation3, Translation3, UnitQuaternion};
use bowknot::scene::Material;
use js_sys::{Float64Array, Uint32Array};
use wasm_bindgen::prelude::wasm_bindgen;

/// Largest deviation of a rotation's columns from unit vectors at right angles [1].
const RIGID: f64 = 1e-6;

#[wasm_bindgen]
impl Simulator {
    /// Adds a pin that holds vertices of a body where they are until it is led or removed. Vertices are numbered as in the
    /// body's mesh.
    #[wasm_bindgen(js_name = addPin)]
    pub fn add_pin(&mut self, name: &str, body: &str, vertices: &Uint32Array) -> Result<(), Thrown> {
        self.inner.add_pin(name, body, &vertices.to_vec()).map_err(input)
    }

    /// Removes a pin.
    #[wasm_bindgen(js_name = removePin)]
    pub fn remove_pin(&mut self, name: &str) -> Result<(), Thrown> {
        self.inner.remove_pin(name).map_err(input)
    }

    /// Leads the vertices of a pin to targets, x y z of each [m], at the end of the next time step.
    #[wasm_bindgen(js_name = setPinTargets)]
    pub fn set_pin_targets(&mut self, name: &str, targets: &Float64Array) -> Result<(), Thrown> {
        self.inner.set_pin_targets(name, &arrays::points("targets", targets)?).map_err(input)
    }

    /// Leads the vertices of a pin as a rigid body, by a matrix of 16 numbers in the order of columns, as three.js has
    /// them, from where they were when the pin was added.
    #[wasm_bindgen(js_name = setPinPose)]
    pub fn set_pin_pose(&mut self, name: &str, matrix: &Float64Array) -> Result<(), Thrown> {
        self.inner.set_pin_pose(name, &isometry(matrix)?).map_err(input)
    }

    /// Forces that a pin exerts on its vertices [N].
    #[wasm_bindgen(js_name = pinForces)]
    pub fn pin_forces(&self, name: &str) -> Result<Float64Array, Thrown> {
        Ok(arrays::from_vectors(self.inner.pin_forces(name).map_err(input)?))
    }

    /// Leads the vertices of an obstacle to targets, x y z of each in the order of its mesh [m].
    #[wasm_bindgen(js_name = setObstacleTargets)]
    pub fn set_obstacle_targets(&mut self, name: &str, targets: &Float64Array) -> Result<(), Thrown> {
        self.inner.set_obstacle_targets(name, &arrays::points("targets", targets)?).map_err(input)
    }

    /// Leads an obstacle as a rigid body, by a matrix as for `setPinPose`, from where its scene puts it.
    #[wasm_bindgen(js_name = setObstaclePose)]
    pub fn set_obstacle_pose(&mut self, name: &str, matrix: &Float64Array) -> Result<(), Thrown> {
        self.inner.set_obstacle_pose(name, &isometry(matrix)?).map_err(input)
    }

    /// Sets gravity [m/s^2].
    #[wasm_bindgen(js_name = setGravity)]
    pub fn set_gravity(&mut self, gravity: &Float64Array) -> Result<(), Thrown> {
        self.inner.set_gravity(arrays::vector("gravity", gravity)?).map_err(input)
    }

    /// Sets the velocity of the air [m/s].
    #[wasm_bindgen(js_name = setWind)]
    pub fn set_wind(&mut self, wind: &Float64Array) -> Result<(), Thrown> {
        self.inner.set_wind(arrays::vector("wind", wind)?).map_err(input)
    }

    /// Sets forces on all vertices in the order of `positions` [N], until they are set anew; an empty array ends them.
    #[wasm_bindgen(js_name = setExternalForces)]
    pub fn set_external_forces(&mut self, forces: &Float64Array) -> Result<(), Thrown> {
        self.inner.set_external_forces(&arrays::vectors("forces", forces)?).map_err(input)
    }

    /// Sets the velocities of a body's vertices [m/s].
    #[wasm_bindgen(js_name = setVelocities)]
    pub fn set_velocities(&mut self, body: &str, velocities: &Float64Array) -> Result<(), Thrown> {
        self.inner.set_velocities(body, &arrays::vectors("velocities", velocities)?).map_err(input)
    }

    /// Puts a body somewhere at once [m]; what would intersect is refused.
    pub fn place(&mut self, body: &str, positions: &Float64Array) -> Result<(), Thrown> {
        self.inner.place(body, &arrays::points("positions", positions)?).map_err(error::simulation)
    }

    /// Adds the bodies and obstacles of another scene. This takes as long as a new simulator.
    pub fn add(&mut self, scene: &crate::scene::Scene) -> Result<(), Thrown> {
        for body in scene.scene.bodies.clone() {
            self.inner.add_body(body).map_err(error::simulation)?;
        }
        for obstacle in scene.scene.obstacles.clone() {
            self.inner.add_obstacle(obstacle).map_err(error::simulation)?;
        }
        Ok(())
    }

    /// Removes a body or an obstacle.
    pub fn remove(&mut self, name: &str) -> Result<(), Thrown> {
        self.inner.remove(name).map_err(error::simulation)
    }

    /// Sets the coefficient of friction of a body, an obstacle or a half-space [1].
    #[wasm_bindgen(js_name = setFriction)]
    pub fn set_friction(&mut self, name: &str, friction: f64) -> Result<(), Thrown> {
        self.inner.set_friction(name, friction).map_err(error::simulation)
    }

    /// Sets the coefficient of friction of all bodies, obstacles and half-spaces [1].
    #[wasm_bindgen(js_name = setFrictionOfAll)]
    pub fn set_friction_of_all(&mut self, friction: f64) -> Result<(), Thrown> {
        let names: Vec<String> = self.inner.world().names().cloned().collect();
        names.iter().try_for_each(|name| self.set_friction(name, friction))
    }

    /// Gives a body a material, as the value of the key `material` in TOML: `"\"silk\""`, `"{ young_modulus = 1e5 }"`.
    #[wasm_bindgen(js_name = setMaterial)]
    pub fn set_material(&mut self, body: &str, material: &str) -> Result<(), Thrown> {
        let spec = self.inner.scene().bodies.iter().find(|spec| spec.name == body);
        let kind = spec.map(|spec| spec.kind);
        // An unknown body is refused by the simulator, whatever the material.
        let material =
            kind.map_or_else(|| Ok(Material::default()), |kind| Material::from_toml(kind, material));
        let material = material.map_err(|error| input(error.to_string()))?;
        self.inner.set_material(body, material).map_err(error::simulation)
    }

    /// Makes every body `ratio` times as stiff as it is, in stretching, shearing, bending and twisting.
    #[wasm_bindgen(js_name = scaleStiffness)]
    pub fn scale_stiffness(&mut self, ratio: f64) -> Result<(), Thrown> {
        if !(ratio.is_finite() && ratio > 0.0) {
            return Err(input(format!("ratio {ratio} must be finite and above 0")));
        }
        let stiffer: Vec<(String, Material)> = self
            .inner
            .scene()
            .bodies
            .iter()
            .map(|body| (body.name.clone(), scaled(body.material, ratio)))
            .collect();
        for (body, material) in stiffer {
            self.inner.set_material(&body, material).map_err(error::simulation)?;
        }
        Ok(())
    }
}

/// A material that is `ratio` times as stiff. Particles have no stiffness.
fn scaled(material: Material, ratio: f64) -> Material {
    match material {
        Material::Cloth(cloth) => Material::Cloth(ClothMaterial {
            stretch_stiffness: ratio * cloth.stretch_stiffness,
            weft_stiffness: cloth.weft_stiffness.map(|own| ratio * own),
            shear_stiffness: cloth.shear_stiffness.map(|own| ratio * own),
            bend_stiffness: ratio * cloth.bend_stiffness,
            ..cloth
        }),
        Material::Solid(solid) => {
            Material::Solid(SolidMaterial { young_modulus: ratio * solid.young_modulus, ..solid })
        }
        Material::Strands(strand) => Material::Strands(StrandMaterial {
            stretch_stiffness: ratio * strand.stretch_stiffness,
            bend_stiffness: ratio * strand.bend_stiffness,
            twist_stiffness: ratio * strand.twist_stiffness,
            ..strand
        }),
        other => other,
    }
}

/// A rigid transform of a matrix in the order of columns.
fn isometry(matrix: &Float64Array) -> Result<Isometry3<f64>, Thrown> {
    let rows = arrays::rows::<16>("matrix", matrix)?;
    let [m] = rows.as_slice() else {
        return Err(input("matrix: one of 16 numbers is expected"));
    };
    let rotation = Matrix3::from_columns(&[
        [m[0], m[1], m[2]].into(),
        [m[4], m[5], m[6]].into(),
        [m[8], m[9], m[10]].into(),
    ]);
    let is_finite = m.iter().all(|number| number.is_finite());
    let is_rotation = (rotation.transpose() * rotation - Matrix3::identity()).amax() <= RIGID;
    if !(is_finite && is_rotation && rotation.determinant() > 0.0) {
        return Err(input("matrix: not that of a rotation and a displacement"));
    }
    let rotation = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(rotation));
    Ok(Isometry3::from_parts(Translation3::new(m[12], m[13], m[14]), rotation))
}
