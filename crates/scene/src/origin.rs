//! Where values of a scene came from, for messages.

use std::collections::HashMap;
use std::fmt;
use std::path::PathBuf;

/// Where a value came from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Origin {
    /// A line, from 1, of a scene file.
    File(PathBuf, Option<usize>),
    /// An assignment `KEY.PATH=VALUE` ([`crate::Scene::load`]).
    Set,
    /// A scene made in code.
    Code,
}

/// The prefix of a message: "scene.toml:3: ", "assignment: ", or nothing.
impl fmt::Display for Origin {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::File(file, Some(line)) => write!(f, "{}:{line}: ", file.display()),
            Self::File(file, None) => write!(f, "{}: ", file.display()),
            Self::Set => write!(f, "assignment: "),
            Self::Code => Ok(()),
        }
    }
}

/// Where the keys of a scene file stand. It is no content of a scene, so all are equal.
#[derive(Clone, Debug, Default)]
pub struct Origins {
    file: PathBuf,
    /// Line, from 1, of each key, such as `body[0].mesh`.
    lines: HashMap<String, usize>,
}

impl PartialEq for Origins {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl Origins {
    /// Those of a file whose keys stand at the given lines.
    pub(crate) fn new(file: PathBuf, lines: HashMap<String, usize>) -> Self {
        Self { file, lines }
    }

    /// The line of the first of the keys that the file has.
    pub(crate) fn of<const N: usize>(&self, keys: [&str; N]) -> Option<Origin> {
        let line = keys.iter().find_map(|key| self.lines.get(*key));
        line.map(|line| Origin::File(self.file.clone(), Some(*line)))
    }
}
