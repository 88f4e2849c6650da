//! Material libraries: `mtllib` names them relative to the file that it stands in.

use std::iter;
use std::path::{Component, Path, PathBuf};

/// The files that a statement names, seen from the working folder. Names are separated by blanks, but may
/// also contain some.
pub(super) fn named_files(names: &str, folder: &Path) -> Vec<PathBuf> {
    let is_library = |name: &str| name.to_ascii_lowercase().ends_with(".mtl");
    let words: Vec<&str> = names.split_whitespace().collect();
    if words.iter().all(|word| is_library(word)) && !folder.join(names).exists() {
        return words.iter().map(|word| folder.join(word)).collect();
    }
    vec![folder.join(names)]
}

/// The path of `file` as seen from `folder`, with `/`; the absolute one if there is no way from one to the
/// other. Programs look for libraries relative to the OBJ, and many refuse absolute paths.
pub(super) fn relative(file: &Path, folder: &Path) -> String {
    let file = match (file.parent(), file.file_name()) {
        (Some(parent), Some(name)) => plain(parent).join(name),
        _ => plain(file),
    };
    let folder = plain(folder);
    let (from, to): (Vec<_>, Vec<_>) = (folder.components().collect(), file.components().collect());
    let common = from.iter().zip(&to).take_while(|(a, b)| a == b).count();
    if common == 0 {
        return file.to_string_lossy().into_owned();
    }
    let up = iter::repeat_n("..".into(), from.len() - common);
    let down = to[common..].iter().map(|component| component.as_os_str().to_string_lossy());
    up.chain(down).collect::<Vec<_>>().join("/")
}

/// The absolute path of a folder without links and detours.
fn plain(folder: &Path) -> PathBuf {
    let here = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    here.canonicalize().unwrap_or_else(|_| {
        let mut path = PathBuf::new();
        for component in std::path::absolute(here).unwrap_or_else(|_| here.to_owned()).components() {
            match component {
                Component::ParentDir => drop(path.pop()),
                other => path.push(other),
            }
        }
        path
    })
}
