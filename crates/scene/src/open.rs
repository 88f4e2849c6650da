//! How a scene is read and written.

use crate::builtin::{self, BUILTIN};
use crate::description::Scene;
use crate::error::{self, SceneError, SceneProblem};
use crate::kind::BodyKind;
use crate::material::Material;
use crate::origin::Origin;
use crate::source::Source;
use crate::{read, short, validate, write};
use bowknot_io::IoError;
use serde::{Deserialize, Deserializer, Serialize, Serializer, de};
use std::path::Path;
use toml::{Table, Value};

impl Material {
    /// From the value of a body's key `material` as a scene file has it: `"\"silk\""`, `"{ young_modulus = 1e5 }"`.
    ///
    /// # Errors
    /// Text that is not TOML, unknown names and keys, wrong types, values out of range.
    pub fn from_toml(kind: BodyKind, text: &str) -> Result<Self, SceneError> {
        let refused = |message: &str| {
            let (key, message) = ("material".to_owned(), message.to_owned());
            SceneError::Invalid(vec![SceneProblem { origin: Origin::Code, key, message }])
        };
        // Of a body that has nothing else, so that messages are those of a scene. No mesh is read.
        let mut body: Table = format!("material = {text}")
            .parse()
            .map_err(|error: toml::de::Error| refused(error.message()))?;
        body.insert("mesh".to_owned(), Value::from("mesh.obj"));
        body.insert("kind".to_owned(), Value::from(kind.name()));
        let scene = Table::from_iter([("body".to_owned(), Value::Array(vec![Value::Table(body)]))]);
        let scene = read::scene(&Source::from_table(scene), Path::new(""), "scene")?;
        scene.bodies.first().map(|body| body.material).ok_or_else(|| refused("is missing"))
    }
}

impl Scene {
    /// Reads a scene file and applies `sets`, each `KEY.PATH=VALUE`, before anything is interpreted.
    ///
    /// # Errors
    /// A missing file, text that is not TOML, unknown keys, wrong types, values out of range; every
    /// problem with its line and key.
    pub fn load<S: AsRef<str>>(path: impl AsRef<Path>, sets: &[S]) -> Result<Self, SceneError> {
        let path = path.as_ref();
        let text = std::fs::read_to_string(path).map_err(|source| IoError::system("read", path, source))?;
        let text = text.strip_prefix('\u{feff}').unwrap_or(&text);
        let mut source = Source::parse(text, path)?;
        apply(&mut source, sets)?;
        let folder = path.parent().unwrap_or(Path::new("")).to_owned();
        let name = path.file_stem().and_then(|s| s.to_str()).unwrap_or("scene");
        read::scene(&source, &folder, name)
    }

    /// Reads a scene from text; mesh paths are relative to `folder`.
    ///
    /// # Errors
    /// As [`Self::load`].
    pub fn from_toml(text: &str, folder: impl AsRef<Path>) -> Result<Self, SceneError> {
        let source = Source::parse(text, Path::new("scene.toml"))?;
        read::scene(&source, folder.as_ref(), "scene")
    }

    /// A built-in scene, see [`BUILTIN`]. `scale` multiplies its resolution: vertices of sheets grow with
    /// the square; dimensions stay.
    ///
    /// # Errors
    /// An unknown name, with the nearest one; a scale out of its range.
    pub fn builtin(name: &str, scale: f64) -> Result<Self, SceneError> {
        builtin::scene(name, scale)
    }

    /// A built-in scene by name, or a scene file by path, with `sets` applied. `scale` is for built-in
    /// scenes, 1 by default.
    ///
    /// # Errors
    /// As [`Self::load`] and [`Self::builtin`].
    pub fn open<S: AsRef<str>>(name: &str, scale: Option<f64>, sets: &[S]) -> Result<Self, SceneError> {
        if BUILTIN.iter().any(|b| b.name == name) {
            return Self::builtin(name, scale.unwrap_or(1.0))?.with_sets(sets);
        }
        let path = Path::new(name);
        if path.extension().is_none() && !path.exists() {
            let nearest = error::nearest(name, BUILTIN.iter().map(|b| b.name));
            return Err(SceneError::Unknown { name: name.to_owned(), nearest });
        }
        if path.extension().is_some_and(|ending| !ending.eq_ignore_ascii_case("toml")) && path.exists() {
            return Err(SceneError::NoScene { file: path.to_owned() });
        }
        if scale.is_some() {
            return Err(SceneError::ScaleOfFile { file: path.to_owned() });
        }
        Self::load(path, sets)
    }

    /// The scene with `KEY.PATH=VALUE` assignments applied.
    ///
    /// # Errors
    /// As [`Self::load`].
    pub fn with_sets<S: AsRef<str>>(self, sets: &[S]) -> Result<Self, SceneError> {
        if sets.is_empty() {
            return Ok(self);
        }
        let mut source = Source::from_table(write::table_of_names(&self));
        // A preset changes defaults, so what only repeats the old preset's defaults must not stay.
        let preset = |s: &S| s.as_ref().split('=').next().map(str::trim) == Some("contact.preset");
        if sets.iter().any(preset) {
            write::drop_defaults(&mut source.table, &self);
        }
        apply(&mut source, sets)?;
        let scene = read::scene(&source, &self.folder, &self.simulation.name)?;
        Ok(Self { origins: self.origins, ..scene })
    }

    /// The scene as TOML with every default filled in; [`Self::from_toml`] reads it back equal. Mesh
    /// paths become absolute if the system tells where they are.
    pub fn to_toml(&self) -> String {
        write::text(self)
    }

    /// The scene as TOML without what is default, the way a person would write it; [`Self::from_toml`] reads
    /// it back equal.
    pub fn to_short_toml(&self) -> String {
        short::text(self)
    }

    /// Checks every value; what [`Self::load`] reports for files, for scenes made in code.
    ///
    /// # Errors
    /// [`SceneError::Invalid`] with all problems, or [`SceneError::Empty`].
    pub fn validate(&self) -> Result<(), SceneError> {
        validate::scene(self, &Source::default())
    }
}

/// Parameters of the two-way method from assignments to keys of `[contact]` and `[solver]`, for callers
/// without a scene.
///
/// # Errors
/// Assignments to other keys, and as [`Scene::load`].
pub fn twoway_params<S: AsRef<str>>(sets: &[S]) -> Result<bowknot_twoway::Params, SceneError> {
    let mut source = Source::default();
    apply(&mut source, sets)?;
    read::twoway(&source)
}

fn apply<S: AsRef<str>>(source: &mut Source, sets: &[S]) -> Result<(), SceneError> {
    let problems: Vec<SceneProblem> = sets.iter().filter_map(|set| source.set(set.as_ref()).err()).collect();
    if problems.is_empty() { Ok(()) } else { Err(SceneError::Invalid(problems)) }
}

impl Serialize for Scene {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        write::table_without_ends(self).serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for Scene {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let source = Source::from_table(Table::deserialize(deserializer)?);
        read::scene(&source, Path::new(""), "scene").map_err(de::Error::custom)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn materials_are_read_as_scene_files_have_them() {
        let silk = Material::from_toml(BodyKind::Cloth, "\"silk\"").expect("a named material");
        assert_eq!(Some(silk), Material::named(BodyKind::Cloth, "silk"));
        let Ok(Material::Solid(solid)) = Material::from_toml(BodyKind::Solid, "{ young_modulus = 2e5 }")
        else {
            panic!("a material by its numbers");
        };
        assert_eq!(solid.young_modulus, 2e5);
        for (text, words) in [
            ("silk", "material: string values must be quoted"),
            ("\"silc\"", "did you mean silicone"),
            ("{ youngs = 1.0 }", "material.youngs: unknown key"),
            ("{ young_modulus = -1.0 }", "material.young_modulus: -1 Pa must be finite"),
        ] {
            let error = Material::from_toml(BodyKind::Solid, text).expect_err(text).to_string();
            assert!(error.contains(words), "{text}: {error}");
        }
    }
}
