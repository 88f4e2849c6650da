//! What a value must be, in the words of a scene file instead of those of serde.

use crate::error::nearest;
use crate::values::describe;
use toml::Value;

/// Explains why a value was refused, from serde's message.
pub(crate) fn explain(message: &str, value: &Value) -> String {
    let message = message.trim().replace('\n', " ");
    if message.starts_with("unknown variant") {
        return unknown_name(&message);
    }
    let Some((given, expected)) = message.rsplit_once(", expected ") else { return message };
    let given = given.split_once(": ").map_or(given, |(_, given)| given);
    let needed = match expected {
        "a matrix array" => "3 numbers, as in [0.0, 0.0, 1.0]".to_owned(),
        "f64" => "a number".to_owned(),
        "u32" | "usize" | "u64" => "a whole number, at least 0".to_owned(),
        "string only" | "a string" | "path string" => "a string".to_owned(),
        "a boolean" => "true or false".to_owned(),
        other => match other.strip_prefix("an array of length ") {
            Some(count) => format!("an array of {count} values"),
            None => other.to_owned(),
        },
    };
    format!("must be {needed}, not {}", found(given, value))
}

/// Names the values that are allowed in place of an unknown one, and the one that is meant.
fn unknown_name(message: &str) -> String {
    // The unknown name and those allowed stand between backticks.
    let mut names = message.split('`').skip(1).step_by(2);
    let Some(given) = names.next() else { return message.to_owned() };
    let allowed: Vec<&str> = names.collect();
    let hint = nearest(&given.to_lowercase(), allowed.iter().copied());
    let hint = hint.map_or_else(String::new, |name| format!("; did you mean {name:?}?"));
    format!("{given:?} must be one of {}{hint}", allowed.join(", "))
}

/// What was found: the value itself, or of an array the element that serde names.
fn found(given: &str, value: &Value) -> String {
    match value {
        Value::Array(list) => {
            let quoted = given.split(['`', '"']).nth(1);
            let element = |entry: &&Value| {
                quoted.is_some_and(|quoted| match entry {
                    Value::String(text) => text == quoted,
                    other => other.to_string() == quoted,
                })
            };
            match list.iter().find(element) {
                Some(element) => format!("an array with {}", describe(element)),
                None => format!("an array of {}", list.len()),
            }
        }
        other => describe(other),
    }
}

#[cfg(test)]
mod tests {
    use crate::{Scene, SceneError};

    fn message(lines: &str) -> String {
        let text = format!("[[body]]\nname = \"a\"\n{lines}\n");
        match Scene::from_toml(&text, "") {
            Err(SceneError::Invalid(problems)) => problems[0].to_string(),
            other => panic!("{lines}: {other:?}"),
        }
    }

    #[test]
    fn values_of_a_wrong_type_are_explained() {
        for (lines, says) in [
            (
                "translate = 3.0",
                "scene.toml:3: body[0].translate: must be 3 numbers, as in [0.0, 0.0, 1.0], not the number 3",
            ),
            (
                "translate = [3.0, 1]",
                "body[0].translate: must be 3 numbers, as in [0.0, 0.0, 1.0], not an array of 2",
            ),
            (
                "translate = [0, 0, \"a\"]",
                "body[0].translate: must be a number, not an array with the string \"a\"",
            ),
            ("up = \"Y\"", "body[0].up: \"Y\" must be one of x, y, z; did you mean \"y\"?"),
            ("up = 3", "body[0].up: must be a string, not the number 3"),
            ("kind = \"Clothes\"", "did you mean \"cloth\"?"),
            ("friction = true", "body[0].friction: must be a number, not true"),
            ("self_collision = 1", "body[0].self_collision: must be true or false, not the number 1"),
            (
                "[[pin]]\nvertices = [-1]",
                "pin[0].vertices: must be a whole number, at least 0, not an array with the number -1",
            ),
            (
                "[contact]\npreset = \"Paper\"",
                "contact.preset: \"Paper\" must be one of fast, quick, paper; did you mean \"paper\"?",
            ),
            (
                "[output]\nformats = [\"PLY\"]",
                "\"PLY\" must be one of ply, obj, npz, pc2, usd, vtu, gltf; did you mean \"ply\"?",
            ),
            ("shape = { type = \"sheet\", size = 3 }", "must be an array of 2 values, not the number 3"),
        ] {
            let found = message(lines);
            assert!(found.contains(says), "{lines}: {found}");
        }
    }
}
