//! What is wrong with a scene.

use crate::origin::Origin;
use bowknot_geometry::MeshProblem;
use bowknot_io::{IoError, MESH_ENDINGS};
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
    /// A file that is no scene, by its ending.
    #[error("{}: a scene is a .toml file; meshes that can be read are {}", file.display(), endings())]
    NoScene {
        /// The file.
        file: PathBuf,
    },
    /// A scale of a built-in scene out of its range.
    #[error("scale {scale} must be finite, at least {min} and at most {max}")]
    Scale {
        /// The scale given.
        scale: f64,
        /// Smallest scale allowed.
        min: f64,
        /// Largest scale allowed.
        max: f64,
    },
    /// A scale for a scene file.
    #[error("{}: a scale applies to built-in scenes; a file states its own resolution", file.display())]
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
    /// What goes wrong with a part of a scene file.
    #[error("{origin}{source}")]
    At {
        /// The line of the part.
        origin: Origin,
        /// What goes wrong.
        source: Box<SceneError>,
    },
    /// There is nothing to simulate.
    #[error("the scene is empty: it needs at least one [[body]]")]
    Empty,
    /// The model cannot be built from the parts.
    #[error("{0}")]
    Model(String),
}

impl SceneError {
    /// The error with the place of the part that it is about, if that is known.
    pub(crate) fn at(self, origin: Option<Origin>) -> Self {
        match origin {
            Some(origin) => Self::At { origin, source: Box::new(self) },
            None => self,
        }
    }
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

impl fmt::Display for SceneProblem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}{}: {}", self.origin, self.key, self.message)
    }
}

/// The candidate most similar to `name`, if it is similar enough to be what was meant.
pub fn nearest<'a>(name: &str, candidates: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    candidates
        .map(|candidate| (strsim::normalized_damerau_levenshtein(name, candidate), candidate))
        .filter(|(similarity, _)| *similarity >= 0.5)
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, candidate)| candidate)
}

/// Endings of meshes, in words.
fn endings() -> String {
    MESH_ENDINGS.map(|ending| format!(".{ending}")).join(", ")
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
        ". The triangles of a deformable body need an area and must differ: \
         the command `bowknot repair` drops these, `bowknot info` lists them"
    } else {
        ""
    }
}
