//! Numbers of buffers (section 3.6), read when they are needed.

use super::document::{Accessor, BufferView, Document};
use crate::error::{IoError, Place};
use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

/// The accessors of a file.
#[derive(Debug)]
pub(super) struct Accessors {
    pub path: PathBuf,
    accessors: Vec<Accessor>,
    views: Vec<BufferView>,
    buffers: Vec<Buffer>,
}

#[derive(Debug)]
enum Buffer {
    /// A part of a file: its first byte and length.
    File(PathBuf, u64, u64),
    /// In the JSON.
    Memory(Vec<u8>),
}

impl Accessors {
    /// Takes the accessors out of a document, whose binary chunk is at `chunk`.
    ///
    /// # Errors
    /// Buffers that are neither in the file nor beside it.
    pub fn new(path: &Path, document: &mut Document, chunk: Option<(u64, u64)>) -> Result<Self, IoError> {
        let folder = path.parent().unwrap_or(Path::new(""));
        let buffers = document.buffers.iter().enumerate().map(|(index, buffer)| {
            let fault =
                |message: &str| IoError::content(path, Place::Element("buffer".to_owned(), index), message);
            match (&buffer.uri, chunk) {
                (None, Some((start, length))) => Ok(Buffer::File(path.to_owned(), start, length)),
                (None, None) => Err(fault("it has no uri, and the file has no binary chunk")),
                (Some(uri), _) if uri.starts_with("data:") => {
                    let encoded = uri.split_once(";base64,").map(|(_, text)| text);
                    let bytes = encoded.and_then(base64).ok_or_else(|| fault("its data are not base64"))?;
                    Ok(Buffer::Memory(bytes))
                }
                (Some(uri), _) if uri.contains("://") => {
                    Err(fault("it is not on this machine: put it beside the file"))
                }
                (Some(uri), _) => {
                    let name = percent_decoded(uri).ok_or_else(|| fault("its uri is not UTF-8"))?;
                    Ok(Buffer::File(folder.join(name), 0, u64::MAX))
                }
            }
        });
        Ok(Self {
            path: path.to_owned(),
            buffers: buffers.collect::<Result<_, _>>()?,
            accessors: std::mem::take(&mut document.accessors),
            views: std::mem::take(&mut document.buffer_views),
        })
    }

    /// Number of elements of an accessor, which must have so many components each.
    ///
    /// # Errors
    /// No such accessor, or one of another type.
    pub fn count(&self, index: usize, components: usize) -> Result<usize, IoError> {
        let accessor = self.accessor(index)?;
        match size_of(&accessor.kind) {
            Some(size) if size == components => Ok(accessor.count),
            _ => {
                let message = format!("its type is {:?}; {components} components are needed", accessor.kind);
                Err(self.fault(index, message))
            }
        }
    }

    /// Elements `first` to before `first + count` of an accessor, component by component. Whoever asks must
    /// know `count` from something that is in the file, since accessors without a view are zeros.
    ///
    /// # Errors
    /// What [`Self::count`] refuses; ranges that are not in the buffer, numbers that are not finite.
    pub fn rows(
        &self,
        index: usize,
        components: usize,
        first: usize,
        count: usize,
    ) -> Result<Vec<f64>, IoError> {
        let total = self.count(index, components)?;
        let accessor = self.accessor(index)?;
        let end = first.checked_add(count).filter(|end| *end <= total);
        if end.is_none() {
            return Err(
                self.fault(index, format!("it has {total} elements, {count} from {first} on are needed"))
            );
        }
        let kind = Component::of(accessor.component_type)
            .ok_or_else(|| self.fault(index, format!("unknown componentType {}", accessor.component_type)))?;
        let mut numbers = match accessor.buffer_view {
            Some(view) => {
                let place = Rows { view, offset: accessor.byte_offset, first, count, components, kind };
                self.view_rows(index, &place)?
            }
            None => vec![0.0; count * components],
        };
        if let Some(sparse) = &accessor.sparse {
            let of_index = Component::of(sparse.indices.component_type)
                .ok_or_else(|| self.fault(index, "unknown componentType of sparse indices"))?;
            let place = |view, offset, components, kind| Rows {
                view,
                offset,
                first: 0,
                count: sparse.count,
                components,
                kind,
            };
            let indices = &sparse.indices;
            let at = self.view_rows(index, &place(indices.buffer_view, indices.byte_offset, 1, of_index))?;
            let values = &sparse.values;
            let values =
                self.view_rows(index, &place(values.buffer_view, values.byte_offset, components, kind))?;
            for (at, value) in at.iter().zip(values.chunks_exact(components)) {
                if !(0.0..total as f64).contains(at) {
                    return Err(self.fault(index, format!("its sparse index {at} is not below {total}")));
                }
                if let Some(row) = (*at as usize).checked_sub(first).filter(|row| *row < count) {
                    numbers[row * components..][..components].copy_from_slice(value);
                }
            }
        }
        if accessor.normalized {
            numbers.iter_mut().for_each(|number| *number = kind.normalized(*number));
        }
        match numbers.iter().position(|number| !number.is_finite()) {
            None => Ok(numbers),
            Some(at) => {
                Err(self.fault(index, format!("its element {} is not finite", first + at / components)))
            }
        }
    }

    /// All elements of an accessor with a view.
    ///
    /// # Errors
    /// As [`Self::rows`].
    pub fn all(&self, index: usize, components: usize) -> Result<Vec<f64>, IoError> {
        let count = self.count(index, components)?;
        if self.accessor(index)?.buffer_view.is_none() {
            return Err(self.fault(index, "it has no bufferView"));
        }
        self.rows(index, components, 0, count)
    }

    /// An error of an accessor.
    pub fn fault(&self, index: usize, message: impl Into<String>) -> IoError {
        IoError::content(&self.path, Place::Element("accessor".to_owned(), index), message)
    }

    fn accessor(&self, index: usize) -> Result<&Accessor, IoError> {
        self.accessors.get(index).ok_or_else(|| self.fault(index, "there is no such accessor"))
    }

    fn view_rows(&self, index: usize, rows: &Rows) -> Result<Vec<f64>, IoError> {
        let outside = || self.fault(index, "its bufferView or its range is not in a buffer of the file");
        let view = self.views.get(rows.view).ok_or_else(outside)?;
        let size = rows.components * rows.kind.size();
        let stride = view.byte_stride.unwrap_or(size);
        if stride < size {
            return Err(self.fault(index, format!("byteStride {stride} is less than its {size} bytes")));
        }
        if rows.count == 0 {
            return Ok(Vec::new());
        }
        let length =
            stride.checked_mul(rows.count - 1).and_then(|n| n.checked_add(size)).ok_or_else(outside)?;
        let start = stride.checked_mul(rows.first).and_then(|n| n.checked_add(rows.offset));
        let start =
            start.filter(|start| start.checked_add(length).is_some_and(|end| end <= view.byte_length));
        let start = start.and_then(|start| start.checked_add(view.byte_offset)).ok_or_else(outside)?;
        let bytes = self.bytes(view.buffer, start, length)?.ok_or_else(outside)?;
        let numbers = bytes.chunks(stride).flat_map(|row| row[..size].chunks_exact(rows.kind.size()));
        Ok(numbers.map(|bytes| rows.kind.number(bytes)).collect())
    }

    /// Bytes of a buffer; `None` if they are not all there.
    fn bytes(&self, buffer: usize, start: usize, length: usize) -> Result<Option<Vec<u8>>, IoError> {
        match self.buffers.get(buffer) {
            None => Ok(None),
            Some(Buffer::Memory(bytes)) => Ok(bytes.get(start..start + length).map(<[u8]>::to_vec)),
            Some(Buffer::File(path, first, size)) => {
                if start as u64 + length as u64 > *size {
                    return Ok(None);
                }
                let system = |source| IoError::system("read", path, source);
                let mut file = File::open(path).map_err(system)?;
                file.seek(SeekFrom::Start(first + start as u64)).map_err(system)?;
                let mut bytes = Vec::new();
                file.take(length as u64).read_to_end(&mut bytes).map_err(system)?;
                Ok(Some(bytes).filter(|bytes| bytes.len() == length))
            }
        }
    }
}

/// Elements in a view.
struct Rows {
    view: usize,
    offset: usize,
    first: usize,
    count: usize,
    components: usize,
    kind: Component,
}

/// The type of a number (section 3.6.2.2).
#[derive(Clone, Copy, Debug, PartialEq)]
enum Component {
    I8,
    U8,
    I16,
    U16,
    U32,
    F32,
}

impl Component {
    fn of(code: u32) -> Option<Self> {
        Some(match code {
            5120 => Self::I8,
            5121 => Self::U8,
            5122 => Self::I16,
            5123 => Self::U16,
            5125 => Self::U32,
            5126 => Self::F32,
            _ => return None,
        })
    }

    fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::U32 | Self::F32 => 4,
        }
    }

    fn number(self, bytes: &[u8]) -> f64 {
        match (self, bytes) {
            (Self::I8, &[a]) => f64::from(a as i8),
            (Self::U8, &[a]) => f64::from(a),
            (Self::I16, &[a, b]) => f64::from(i16::from_le_bytes([a, b])),
            (Self::U16, &[a, b]) => f64::from(u16::from_le_bytes([a, b])),
            (Self::U32, &[a, b, c, d]) => f64::from(u32::from_le_bytes([a, b, c, d])),
            (Self::F32, &[a, b, c, d]) => f64::from(f32::from_le_bytes([a, b, c, d])),
            _ => f64::NAN,
        }
    }

    /// The fraction that an integer stands for (section 3.6.2.2).
    fn normalized(self, number: f64) -> f64 {
        match self {
            Self::I8 => (number / 127.0).max(-1.0),
            Self::U8 => number / 255.0,
            Self::I16 => (number / 32767.0).max(-1.0),
            Self::U16 => number / 65535.0,
            Self::U32 | Self::F32 => number,
        }
    }
}

fn size_of(kind: &str) -> Option<usize> {
    Some(match kind {
        "SCALAR" => 1,
        "VEC2" => 2,
        "VEC3" => 3,
        "VEC4" => 4,
        "MAT4" => 16,
        _ => return None,
    })
}

/// The bytes of a text in base64 (RFC 4648, section 4); none if it is none.
fn base64(text: &str) -> Option<Vec<u8>> {
    let text = text.trim_end_matches('=').as_bytes();
    let mut bytes = Vec::with_capacity(text.len() / 4 * 3 + 2);
    for group in text.chunks(4) {
        let mut word = 0_u32;
        for &letter in group {
            let digit = match letter {
                b'A'..=b'Z' => letter - b'A',
                b'a'..=b'z' => letter - b'a' + 26,
                b'0'..=b'9' => letter - b'0' + 52,
                b'+' => 62,
                b'/' => 63,
                _ => return None,
            };
            word = word << 6 | u32::from(digit);
        }
        word <<= 6 * (4 - group.len());
        match group.len() {
            1 => return None,
            count => bytes.extend(&word.to_be_bytes()[1..count]),
        }
    }
    Some(bytes)
}

/// A relative uri as a path.
fn percent_decoded(uri: &str) -> Option<String> {
    let (mut bytes, mut rest) = (Vec::new(), uri.as_bytes());
    while let [first, others @ ..] = rest {
        rest = others;
        let code = others.get(..2).and_then(|hex| std::str::from_utf8(hex).ok());
        match code.and_then(|hex| u8::from_str_radix(hex, 16).ok()).filter(|_| *first == b'%') {
            Some(byte) => {
                bytes.push(byte);
                rest = &others[2..];
            }
            None => bytes.push(*first),
        }
    }
    String::from_utf8(bytes).ok()
}

#[cfg(test)]
mod tests {
    use super::{base64, percent_decoded};

    #[test]
    fn texts_are_decoded() {
        // The examples of RFC 4648, section 10.
        for (text, encoded) in
            [("", ""), ("f", "Zg=="), ("fo", "Zm8="), ("foo", "Zm9v"), ("foob", "Zm9vYg==")]
        {
            assert_eq!(base64(encoded).as_deref(), Some(text.as_bytes()));
        }
        assert_eq!((base64("A"), base64("Zm9*")), (None, None));
        assert_eq!(percent_decoded("a%20b%c3%a9%").as_deref(), Some("a bé%"));
        assert_eq!(percent_decoded("%ff"), None);
    }
}
