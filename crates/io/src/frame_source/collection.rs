//! Collections of VTK files with their times, `.pvd`.
//!
//! Source: VTK's page "VTK XML file formats", and the page "ParaView/Data formats" on `.pvd`.

use crate::animation::Animation;
use crate::error::{IoError, Place};
use crate::import::{Import, without_mark};
use crate::mesh::Mesh;
use crate::parts::PartsBuilder;
use crate::read::read_mesh;
use std::path::{Path, PathBuf};

/// The frames of a collection: files of one time are parts of one frame.
#[derive(Debug)]
pub(super) struct Collection {
    times: Vec<f64>,
    /// Of each time.
    files: Vec<Vec<PathBuf>>,
}

impl Collection {
    /// Reads which files there are; entries without a time count from 0.
    ///
    /// # Errors
    /// A missing file, one that is no collection, has no entries, or entries without a file or with a time
    /// that is no number; with the line.
    pub fn open(path: &Path) -> Result<Self, IoError> {
        let bytes = std::fs::read(path).map_err(|source| IoError::system("read", path, source))?;
        let text = String::from_utf8_lossy(without_mark(&bytes));
        let folder = path.parent().unwrap_or(Path::new(""));
        if !text.contains("<Collection") {
            return Err(IoError::content(path, Place::File, "not a collection of VTK files"));
        }
        let mut entries: Vec<(f64, PathBuf)> = Vec::new();
        for (start, _) in text.match_indices("<DataSet") {
            let line = 1 + text[..start].matches('\n').count();
            let fault = |message: String| IoError::content(path, Place::Line(line), message);
            let tag = &text[start + "<DataSet".len()..];
            let end = tag.find(['<', '>']).filter(|end| tag.as_bytes()[*end] == b'>');
            let tag = &tag[..end.ok_or_else(|| fault("the tag has no end '>'".to_owned()))?];
            let file = attribute(tag, "file").ok_or_else(|| fault("DataSet has no file".to_owned()))?;
            let time = match attribute(tag, "timestep") {
                Some(word) => word.trim().parse().ok().filter(|time: &f64| time.is_finite()),
                None => Some(entries.len() as f64),
            };
            let time = time.ok_or_else(|| fault("timestep is not a number".to_owned()))?;
            entries.push((time, folder.join(file)));
        }
        if entries.is_empty() {
            return Err(IoError::content(path, Place::File, "it has no DataSet"));
        }
        entries.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut times: Vec<f64> = Vec::new();
        let mut files: Vec<Vec<PathBuf>> = Vec::new();
        for (time, file) in entries {
            match files.last_mut().filter(|_| times.last() == Some(&time)) {
                Some(parts) => parts.push(file),
                None => {
                    times.push(time);
                    files.push(vec![file]);
                }
            }
        }
        Ok(Self { times, files })
    }
}

/// The value of an attribute of a tag, with its entities resolved.
fn attribute(tag: &str, name: &str) -> Option<String> {
    let mut rest = tag;
    loop {
        let (before, after) = rest.split_once('=')?;
        let quote = after.trim_start().chars().next().filter(|c| "\"'".contains(*c))?;
        let (value, next) = after.trim_start()[1..].split_once(quote)?;
        if before.trim() == name {
            let entities = [("&lt;", "<"), ("&gt;", ">"), ("&quot;", "\""), ("&apos;", "'"), ("&amp;", "&")];
            return Some(entities.iter().fold(value.to_owned(), |text, (from, to)| text.replace(from, to)));
        }
        rest = next;
    }
}

impl Animation for Collection {
    fn len(&self) -> usize {
        self.times.len()
    }

    fn times(&self) -> Option<&[f64]> {
        Some(&self.times)
    }

    fn names(&self) -> &[String] {
        &[]
    }

    fn path(&self, index: usize) -> &Path {
        &self.files[index][0]
    }

    fn read(&self, index: usize) -> Result<Mesh, IoError> {
        let import = Import::default();
        let [file] = self.files[index].as_slice() else {
            let mut builder = PartsBuilder::default();
            for file in &self.files[index] {
                let name = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
                let overflow =
                    || IoError::content(file, Place::File, "more vertices than can be counted in 32 bits");
                builder.add(read_mesh(file, &import)?, name).ok_or_else(overflow)?;
            }
            return Ok(builder.finish());
        };
        read_mesh(file, &import)
    }
}
