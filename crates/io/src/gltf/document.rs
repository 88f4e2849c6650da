//! What the JSON of a file says, as far as meshes and motion need it (sections 3 and 5).

use crate::error::{IoError, Place};
use serde::Deserialize;
use std::collections::BTreeMap;
use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::Path;

#[derive(Debug, Default, Deserialize)]
#[serde(rename_all = "camelCase", default)]
pub(super) struct Document {
    pub asset: Asset,
    pub extensions_required: Vec<String>,
    pub scene: Option<usize>,
    pub scenes: Vec<SceneNodes>,
    pub nodes: Vec<Node>,
    pub meshes: Vec<MeshEntry>,
    pub skins: Vec<Skin>,
    pub animations: Vec<AnimationEntry>,
    pub accessors: Vec<Accessor>,
    pub buffer_views: Vec<BufferView>,
    pub buffers: Vec<Buffer>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(super) struct Asset {
    pub version: String,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(super) struct SceneNodes {
    pub nodes: Vec<usize>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(super) struct Node {
    pub name: Option<String>,
    pub children: Vec<usize>,
    pub mesh: Option<usize>,
    pub skin: Option<usize>,
    /// Column by column; in the place of the three that follow.
    pub matrix: Option<[f64; 16]>,
    pub translation: Option<[f64; 3]>,
    /// x y z w.
    pub rotation: Option<[f64; 4]>,
    pub scale: Option<[f64; 3]>,
    pub weights: Option<Vec<f64>>,
    pub extras: Option<Extras>,
}

/// What our own files say about a node.
#[derive(Debug, Default, Deserialize)]
#[serde(untagged)]
pub(super) enum Extras {
    Ours {
        obstacle: bool,
    },
    Other(serde::de::IgnoredAny),
    #[default]
    None,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(super) struct MeshEntry {
    pub name: Option<String>,
    pub primitives: Vec<Primitive>,
    pub weights: Vec<f64>,
}

#[derive(Debug, Deserialize)]
pub(super) struct Primitive {
    pub attributes: BTreeMap<String, usize>,
    pub indices: Option<usize>,
    #[serde(default = "triangles")]
    pub mode: u32,
    #[serde(default)]
    pub targets: Vec<BTreeMap<String, usize>>,
}

fn triangles() -> u32 {
    4
}

#[derive(Debug, Default, Deserialize)]
#[serde(rename_all = "camelCase", default)]
pub(super) struct Skin {
    pub inverse_bind_matrices: Option<usize>,
    pub joints: Vec<usize>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(super) struct AnimationEntry {
    pub name: Option<String>,
    pub channels: Vec<Channel>,
    pub samplers: Vec<Sampler>,
}

#[derive(Debug, Deserialize)]
pub(super) struct Channel {
    pub sampler: usize,
    pub target: Target,
}

#[derive(Debug, Deserialize)]
pub(super) struct Target {
    pub node: Option<usize>,
    pub path: String,
}

#[derive(Debug, Deserialize)]
pub(super) struct Sampler {
    pub input: usize,
    pub output: usize,
    #[serde(default)]
    pub interpolation: Interpolation,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize)]
#[serde(rename_all = "UPPERCASE")]
pub(super) enum Interpolation {
    #[default]
    Linear,
    Step,
    CubicSpline,
}

#[derive(Debug, Default, Deserialize)]
#[serde(rename_all = "camelCase", default)]
pub(super) struct Accessor {
    pub buffer_view: Option<usize>,
    pub byte_offset: usize,
    pub component_type: u32,
    pub normalized: bool,
    pub count: usize,
    #[serde(rename = "type")]
    pub kind: String,
    pub sparse: Option<Sparse>,
}

#[derive(Debug, Deserialize)]
pub(super) struct Sparse {
    pub count: usize,
    pub indices: SparseIndices,
    pub values: SparseValues,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct SparseIndices {
    pub buffer_view: usize,
    #[serde(default)]
    pub byte_offset: usize,
    pub component_type: u32,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct SparseValues {
    pub buffer_view: usize,
    #[serde(default)]
    pub byte_offset: usize,
}

#[derive(Debug, Default, Deserialize)]
#[serde(rename_all = "camelCase", default)]
pub(super) struct BufferView {
    pub buffer: usize,
    pub byte_offset: usize,
    pub byte_length: usize,
    pub byte_stride: Option<usize>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(super) struct Buffer {
    pub uri: Option<String>,
}

const MAGIC: &[u8; 4] = b"glTF";
const JSON: u32 = 0x4E4F_534A;
const BIN: u32 = 0x004E_4942;

/// Reads the JSON of a file, and where the binary chunk of a `.glb` is (section 4.4): its first byte and
/// length.
///
/// # Errors
/// A missing or malformed file; another version; extensions without which the meshes cannot be read.
pub(super) fn read(path: &Path) -> Result<(Document, Option<(u64, u64)>), IoError> {
    let system = |source| IoError::system("read", path, source);
    let fault = |message: String| IoError::content(path, Place::File, message);
    let mut file = File::open(path).map_err(system)?;
    let mut magic = [0; 4];
    let is_binary = file.read_exact(&mut magic).is_ok() && &magic == MAGIC;
    let (mut json, mut chunk) = (Vec::new(), None);
    if is_binary {
        let [version, _] = words(&mut file).ok_or_else(|| fault("its header is cut".to_owned()))?;
        if version != 2 {
            return Err(fault(format!("version {version} of glTF is not read: export version 2.0")));
        }
        let (length, kind) = match words(&mut file) {
            Some([length, kind]) => (u64::from(length), kind),
            None => return Err(fault("its first chunk is cut".to_owned())),
        };
        if kind != JSON {
            return Err(fault("its first chunk is not JSON".to_owned()));
        }
        file.by_ref().take(length).read_to_end(&mut json).map_err(system)?;
        if json.len() as u64 != length {
            return Err(fault(format!("its JSON is cut: {} of {length} bytes", json.len())));
        }
        // Chunks of other kinds are to be skipped.
        let mut at = 20 + length;
        while let Some([length, kind]) = words(&mut file) {
            if kind == BIN {
                chunk = Some((at + 8, u64::from(length)));
                break;
            }
            at += 8 + u64::from(length);
            file.seek(SeekFrom::Start(at)).map_err(system)?;
        }
    } else {
        file.seek(SeekFrom::Start(0)).map_err(system)?;
        file.read_to_end(&mut json).map_err(system)?;
    }
    let document: Document = serde_json::from_slice(crate::import::without_mark(&json)).map_err(|error| {
        let place = if is_binary || error.line() == 0 { Place::File } else { Place::Line(error.line()) };
        IoError::content(path, place, format!("not glTF: {error}"))
    })?;
    let version = document.asset.version.as_str();
    if !version.starts_with("2.") {
        return Err(fault(format!("version '{version}' of glTF is not read: export version 2.0")));
    }
    let compressed = ["KHR_draco_mesh_compression", "EXT_meshopt_compression", "KHR_meshopt_compression"];
    match document.extensions_required.iter().find(|name| compressed.contains(&name.as_str())) {
        Some(name) => Err(fault(format!("its meshes need {name}: export it without compression"))),
        None => Ok((document, chunk)),
    }
}

fn words(file: &mut File) -> Option<[u32; 2]> {
    let mut bytes = [0; 8];
    file.read_exact(&mut bytes).ok()?;
    let [a, b, c, d, e, f, g, h] = bytes;
    Some([u32::from_le_bytes([a, b, c, d]), u32::from_le_bytes([e, f, g, h])])
}
