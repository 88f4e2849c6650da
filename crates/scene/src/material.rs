//! What bodies are made of: materials by name or by numbers.

use crate::error::nearest;
use crate::kind::BodyKind;
use crate::reader::Reader;
use crate::values::{describe, join};
use bowknot_dynamics::{ClothMaterial, ParticleMaterial, SolidMaterial, StrandMaterial};
use bowknot_errors::{Checks, Parameters};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use toml::{Table, Value};

/// Material of a body, of the kind that the body is.
// Read by its fields, so the one whose fields any other has as well comes last.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
#[non_exhaustive]
pub enum Material {
    /// Of a cloth.
    Cloth(ClothMaterial),
    /// Of a solid.
    Solid(SolidMaterial),
    /// Of particles.
    Particles(ParticleMaterial),
    /// Of strands.
    Strands(StrandMaterial),
}

impl Default for Material {
    fn default() -> Self {
        Self::Cloth(ClothMaterial::default())
    }
}

impl Material {
    /// The default of a kind.
    pub fn of(kind: BodyKind) -> Self {
        match kind {
            BodyKind::Cloth => Self::Cloth(ClothMaterial::default()),
            BodyKind::Solid => Self::Solid(SolidMaterial::default()),
            BodyKind::Strands => Self::Strands(StrandMaterial::default()),
            BodyKind::Particles => Self::Particles(ParticleMaterial::default()),
        }
    }

    /// The material of a kind by name.
    pub fn named(kind: BodyKind, name: &str) -> Option<Self> {
        Some(match kind {
            BodyKind::Cloth => Self::Cloth(ClothMaterial::named(name)?),
            BodyKind::Solid => Self::Solid(SolidMaterial::named(name)?),
            BodyKind::Strands => Self::Strands(StrandMaterial::named(name)?),
            BodyKind::Particles => Self::Particles(ParticleMaterial::named(name)?),
        })
    }

    /// The kind of body that it is for.
    pub fn kind(&self) -> BodyKind {
        match self {
            Self::Cloth(_) => BodyKind::Cloth,
            Self::Solid(_) => BodyKind::Solid,
            Self::Strands(_) => BodyKind::Strands,
            Self::Particles(_) => BodyKind::Particles,
        }
    }

    /// Largest ratio of an edge's length to its rest length [1], if the material says: that of a cloth. Solids have none: their
    /// own elasticity limits how far they stretch.
    pub fn stretch_limit(&self) -> Option<f64> {
        match self {
            Self::Cloth(material) => Some(material.stretch_limit),
            Self::Solid(_) => Some(f64::INFINITY),
            Self::Strands(_) | Self::Particles(_) => None,
        }
    }

    /// Its name, if all of its numbers are those of one that has a name.
    pub fn name(&self) -> Option<&'static str> {
        let kind = self.kind();
        kind.materials().iter().copied().find(|name| Self::named(kind, name).as_ref() == Some(self))
    }
}

impl Parameters for Material {
    fn check(&self, checks: &mut Checks) {
        match self {
            Self::Cloth(material) => material.check(checks),
            Self::Solid(material) => material.check(checks),
            Self::Strands(material) => material.check(checks),
            Self::Particles(material) => material.check(checks),
        }
    }
}

/// Reads the material of a body, at the key `material` of its table.
pub(super) fn read(reader: &mut Reader<'_>, table: &Table, path: &str, kind: BodyKind) -> Material {
    let path = join(path, "material");
    match table.get("material") {
        None => Material::of(kind),
        Some(Value::Table(numbers)) => {
            let mut numbers = numbers.clone();
            // `fabric` is the older word for the base of a cloth.
            let words: &[&str] = if kind == BodyKind::Cloth { &["base", "fabric"] } else { &["base"] };
            let mut base = Material::of(kind);
            for word in words {
                if let Some(name) = numbers.remove(*word) {
                    base = by_name(reader, &join(&path, word), &name, kind);
                }
            }
            refuse_keys(reader, &mut numbers, &path, kind, words);
            match base {
                Material::Cloth(base) => Material::Cloth(over(reader, &base, &numbers, &path)),
                Material::Solid(base) => Material::Solid(over(reader, &base, &numbers, &path)),
                Material::Strands(base) => Material::Strands(over(reader, &base, &numbers, &path)),
                Material::Particles(base) => Material::Particles(over(reader, &base, &numbers, &path)),
            }
        }
        Some(name) => by_name(reader, &path, name, kind),
    }
}

fn over<T>(reader: &mut Reader<'_>, base: &T, numbers: &Table, path: &str) -> T
where
    T: Serialize + DeserializeOwned + Default + Clone,
{
    reader.fields(base, numbers, path, &[])
}

fn by_name(reader: &mut Reader<'_>, key: &str, value: &Value, kind: BodyKind) -> Material {
    let name = value.as_str();
    if let Some(material) = name.and_then(|name| Material::named(kind, name)) {
        return material;
    }
    let names = kind.materials();
    let elsewhere = |name: &str| BodyKind::ALL.into_iter().find(|k| k.materials().contains(&name));
    let hint = match (name, name.and_then(elsewhere)) {
        (_, Some(other)) => format!("; that is a material of kind {}", other.name()),
        (Some(name), None) => nearest(name, names.iter().copied())
            .map_or_else(String::new, |name| format!("; did you mean {name}?")),
        (None, None) => String::new(),
    };
    reader.fail(key, format!("{} must be one of {}{hint}", describe(value), names.join(", ")));
    Material::of(kind)
}

/// Reports and removes keys that no material of the kind has; those of other kinds by their kind.
fn refuse_keys(reader: &mut Reader<'_>, numbers: &mut Table, path: &str, kind: BodyKind, words: &[&str]) {
    let foreign: Vec<(String, &str)> = numbers
        .keys()
        .filter(|key| !kind.keys().contains(&key.as_str()))
        .filter_map(|key| {
            let owner = BodyKind::ALL.into_iter().find(|k| k.keys().contains(&key.as_str()))?;
            Some((key.clone(), owner.name()))
        })
        .collect();
    for (key, owner) in foreign {
        numbers.remove(&key);
        let message = format!("a key of kind {owner}, but this body is of kind {}", kind.name());
        reader.fail(&join(path, &key), message);
    }
    reader.check_keys(numbers, path, &[words, kind.keys()].concat());
}
