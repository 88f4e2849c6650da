//! Builds the documentation and refuses warnings, except about units in square brackets.
//!
//! Rustdoc takes `[m]` for a link to an item `m`. The workspace therefore allows unresolved links. That would
//! hide broken ones, so this step turns the warning on again and ignores it for units.

use std::process::{Command, Stdio};

/// Flags of rustdoc: all warnings are errors but the one about unresolved links, which [`run`] sorts.
pub const FLAGS: &str = "-D warnings --force-warn rustdoc::broken-intra-doc-links";

/// Text in brackets that is not a link: units, and the superscript of x^[k].
const UNITS: [&str; 15] =
    ["pixels", "texels", "k", "m", "s", "kg", "N", "J", "Pa", "Hz", "deg", "rad", "bytes", "m2", "1"];

/// Builds the documentation and shows the compiler's messages, except those about units.
pub fn run(command: &mut Command) -> std::io::Result<bool> {
    let output = command.stderr(Stdio::piped()).output()?;
    let text = String::from_utf8_lossy(&output.stderr);
    let broken: Vec<&str> = text.split("\n\n").filter(|block| is_broken_link(block)).collect();
    if !output.status.success() {
        eprint!("{text}");
    } else if !broken.is_empty() {
        eprintln!("{}", broken.join("\n\n"));
    }
    Ok(output.status.success() && broken.is_empty())
}

/// Whether a paragraph of the compiler's output is about a link that is not a unit.
fn is_broken_link(block: &str) -> bool {
    let target = block.split("unresolved link to `").nth(1).and_then(|rest| rest.split('`').next());
    target.is_some_and(|name| !UNITS.contains(&name))
}

#[cfg(test)]
mod tests {
    use super::is_broken_link;

    #[test]
    fn units_are_not_links() {
        assert!(!is_broken_link("warning: unresolved link to `m`\n  --> a.rs:1:2"));
        assert!(is_broken_link("warning: unresolved link to `Mesh`\n  --> a.rs:1:2"));
        assert!(!is_broken_link("   Compiling m v0.1.0"));
    }
}
