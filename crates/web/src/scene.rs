//! Scenes: of text and meshes, or built in.

use crate::error::{Thrown, input};
use crate::meshes::Meshes;
use crate::options::object;
use bowknot::scene::BUILTIN;
use serde::Serialize;
use wasm_bindgen::JsValue;
use wasm_bindgen::prelude::wasm_bindgen;

/// A scene: bodies, obstacles, pins, and how they are simulated. It never changes.
#[wasm_bindgen]
pub struct Scene {
    pub(crate) scene: bowknot::Scene,
}

/// A built-in scene.
#[derive(Serialize)]
struct Summary {
    name: &'static str,
    summary: &'static str,
}

/// Names of the built-in scenes, and what happens in each.
#[wasm_bindgen(js_name = builtinScenes, unchecked_return_type = "BuiltinScene[]")]
pub fn builtin_scenes() -> Result<JsValue, Thrown> {
    let summary = |scene: &bowknot::scene::Builtin| Summary { name: scene.name, summary: scene.summary };
    object(&BUILTIN.iter().map(summary).collect::<Vec<_>>())
}

#[wasm_bindgen]
impl Scene {
    /// A scene from TOML, whose keys are those of the scene reference. A browser has no files: `meshes` has one for each
    /// `mesh` that the text names.
    #[wasm_bindgen(js_name = fromToml)]
    pub fn from_toml(
        text: &str,
        #[wasm_bindgen(unchecked_optional_param_type = "Record<string, MeshSource>")] meshes: &JsValue,
    ) -> Result<Scene, Thrown> {
        let mut scene = bowknot::Scene::from_toml(text, "").map_err(input)?;
        Meshes::new(meshes)?.put_into(&mut scene)?;
        Ok(Self { scene })
    }

    /// A built-in scene. `scale` multiplies its resolution: vertices of sheets grow with the square. Default 1.
    pub fn builtin(name: &str, scale: Option<f64>) -> Result<Scene, Thrown> {
        let scene = bowknot::Scene::builtin(name, scale.unwrap_or(1.0)).map_err(input)?;
        Ok(Self { scene })
    }

    /// The scene with assignments to its keys, such as `"simulation.dt=0.02"` or `"contact.preset=quick"`.
    #[wasm_bindgen(js_name = withSets)]
    pub fn with_sets(&self, sets: Vec<String>) -> Result<Scene, Thrown> {
        let scene = self.scene.clone().with_sets(&sets).map_err(input)?;
        Ok(Self { scene })
    }

    /// The scene as TOML, without what is default.
    #[wasm_bindgen(js_name = toToml)]
    pub fn to_toml(&self) -> String {
        self.scene.to_short_toml()
    }

    /// Its name.
    #[wasm_bindgen(getter)]
    pub fn name(&self) -> String {
        self.scene.name().to_owned()
    }

    /// Its time step [s].
    #[wasm_bindgen(getter, js_name = timeStep)]
    pub fn time_step(&self) -> f64 {
        self.scene.simulation.dt
    }
}
