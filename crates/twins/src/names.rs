//! Names that Rust keeps for itself.

const KEPT: [&str; 20] = [
    "as", "box", "crate", "dyn", "enum", "extern", "fn", "impl", "in", "match", "mod", "move", "mut", "pub",
    "ref", "static", "trait", "type", "use", "where",
];

/// A name of a shader in Rust.
pub fn rust(name: &str) -> String {
    if KEPT.contains(&name) || name == "m" || name == "p" || name == "t" {
        format!("{name}_")
    } else {
        name.to_owned()
    }
}
