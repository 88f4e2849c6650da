//! Materials, by name or by numbers over those of one with a name.

use super::section::Section;
use crate::error::nearest;
use crate::kind::BodyKind;
use crate::material::Material;
use crate::values::describe;
use toml::Value;

/// Reads the material of a body, at the key `material`.
pub fn read(body: &Section<'_>, kind: BodyKind) -> Material {
    match body.get("material") {
        None => Material::of(kind),
        Some(Value::Table(numbers)) => {
            let mut numbers = body.at("material", numbers.clone());
            // `fabric` is the older word for the base of a cloth.
            let words: &[&str] = if kind == BodyKind::Cloth { &["base", "fabric"] } else { &["base"] };
            let mut base = Material::of(kind);
            for word in words {
                if let Some(name) = numbers.remove(word) {
                    base = by_name(&numbers, word, &name, kind);
                }
            }
            refuse_keys(&mut numbers, kind, words);
            match base {
                Material::Cloth(base) => Material::Cloth(numbers.fields(&base, &[])),
                Material::Solid(base) => Material::Solid(numbers.fields(&base, &[])),
                Material::Strands(base) => Material::Strands(numbers.fields(&base, &[])),
                Material::Particles(base) => Material::Particles(numbers.fields(&base, &[])),
            }
        }
        Some(name) => by_name(body, "material", name, kind),
    }
}

fn by_name(section: &Section<'_>, key: &str, value: &Value, kind: BodyKind) -> Material {
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
    section.fail(key, format!("{} must be one of {}{hint}", describe(value), names.join(", ")));
    Material::of(kind)
}

/// Reports and removes keys that no material of the kind has; those of other kinds by their kind.
fn refuse_keys(numbers: &mut Section<'_>, kind: BodyKind, words: &[&str]) {
    let foreign: Vec<(String, &str)> = numbers
        .keys()
        .filter(|key| !kind.keys().contains(key))
        .filter_map(|key| {
            let owner = BodyKind::ALL.into_iter().find(|k| k.keys().contains(&key))?;
            Some((key.to_owned(), owner.name()))
        })
        .collect();
    for (key, owner) in foreign {
        numbers.remove(&key);
        let message = format!("a key of kind {owner}, but this body is of kind {}", kind.name());
        numbers.fail(&key, message);
    }
    numbers.check_keys(&[words, kind.keys()].concat());
}
