//! What is wrong with a scene.

use bowknot_geometry::MeshProblem;
use bowknot_io::IoError;
use std::fmt;
use std::path::PathBuf;

/// Why a scene cannot be used. All of these are the user's input (exit code 2 of the command).
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SceneError {
    /// A file cannot be read, or a mesh is malformed.
    #[error(transparent)]
    Io(#[from] IoError),
    /// The text is not TOML.
    #[error("{}:{line}:{column}: not TOML: {message}", file.display())]
    Syntax {
        /// The scene file.
        file: PathBuf,
        /// Line, from 1.
        line: usize,
        /// Column in characters, from 1.
        column: usize,
        /// What the parser says.
        message: String,
    },
    /// Keys or values that are not allowed; all of them.
    #[error("{}", lines(.0))]
    Invalid(Vec<SceneProblem>),
    /// Neither a built-in scene nor a file.
    #[error("no scene {name}: it is neither a file nor a built-in scene{}", suggestion(nearest))]
    Unknown {
        /// The name given.
        name: String,
        /// The built-in scene with the most similar name, if any is similar.
        nearest: Option<&'static str>,
    },
    /// `--scale` out of its range.
    #[error("scale {scale} must be finite, at least {min} and at most {max}")]
    Scale {
        /// The scale given.
        scale: f64,
        /// Smallest scale allowed.
        min: f64,
        /// Largest scale allowed.
        max: f64,
    },
    /// `--scale` for a scene file.
    #[error("{}: --scale applies to built-in scenes; a file states its own resolution", file.display())]
    ScaleOfFile {
        /// The scene file.
        file: PathBuf,
    },
    /// The mesh of a deformable body cannot be simulated.
    #[error("body {body}: {}{}", first_problems(problems), mesh_hint(problems))]
    Mesh {
        /// The body.
        body: String,
        /// Everything that is wrong with its mesh.
        problems: Vec<MeshProblem>,
    },
    /// A body or obstacle has no elements to simulate.
    #[error("{body}: {message}")]
    Body {
        /// "body NAME" or "obstacle NAME".
        body: String,
        /// What is wrong and what is allowed.
        message: String,
    },
    /// There is nothing to simulate.
    #[error("the scene is empty: it needs at least one [[body]]")]
    Empty,
    /// The model cannot be built from the parts.
    #[error("{0}")]
    Model(String),
}

/// One thing that is wrong with a scene description.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneProblem {
    /// Where the value came from.
    pub origin: Origin,
    /// Path of the key, such as `contact.delta` or `body[0].material`.
    pub key: String,
    /// What is wrong and what is allowed.
    pub message: String,
}

/// Where a value came from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Origin {
    /// A line, from 1, of a scene file.
    File(PathBuf, Option<usize>),
    /// An option `--set`.
    Set,
    /// A scene made in code.
    Code,
}

impl fmt::Display for SceneProblem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.origin {
            Origin::File(file, Some(line)) => write!(f, "{}:{line}: ", file.display())?,
            Origin::File(file, None) => write!(f, "{}: ", file.display())?,
            Origin::Set => write!(f, "--set: ")?,
            Origin::Code => {}
        }
        write!(f, "{}: {}", self.key, self.message)
    }
}

/// The candidate most similar to `name`, if it is similar enough to be what was meant.
pub(crate) fn nearest<'a>(name: &str, candidates: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    candidates
        .map(|candidate| (strsim::normalized_damerau_levenshtein(name, candidate), candidate))
        .filter(|(similarity, _)| *similarity >= 0.5)
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, candidate)| candidate)
}

fn suggestion(nearest: &Option<&'static str>) -> String {
    nearest.map_or_else(String::new, |name| format!("; did you mean {name}?"))
}

fn lines(problems: &[SceneProblem]) -> String {
    problems.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n")
}

/// The first few problems, and how many more there are.
fn first_problems(problems: &[MeshProblem]) -> String {
    const SHOWN: usize = 5;
    let mut text = problems.iter().take(SHOWN).map(ToString::to_string).collect::<Vec<_>>().join("; ");
    if problems.len() > SHOWN {
        text.push_str(&format!("; and {} more", problems.len() - SHOWN));
    }
    text
}

fn mesh_hint(problems: &[MeshProblem]) -> &'static str {
    let degenerate =
        |p: &MeshProblem| matches!(p, MeshProblem::ZeroArea { .. } | MeshProblem::RepeatedTriangle { .. });
    if problems.iter().any(degenerate) {
        ". The triangles of a deformable body need an area and must differ: remove these from the mesh"
    } else {
        ""
    }
}
