//! The numbers of an array, however the file stores them.

use crate::error::Place;
use base64::Engine;
use base64::engine::general_purpose::STANDARD_NO_PAD;
use flate2::read::ZlibDecoder;
use roxmltree::{Document, Node};
use std::borrow::Cow;
use std::io::Read;

/// What is wrong, and where.
pub(super) type Fault = (Place, String);

/// How a file stores its arrays.
pub(super) struct Storage<'a> {
    pub is_big_endian: bool,
    /// Size of lengths [bytes]: 4 or 8.
    pub length_size: usize,
    /// What the content is compressed by, if it is no text.
    pub compressor: Option<&'a str>,
    /// What stands behind the last element, without the underscore before it.
    pub appended: &'a [u8],
    pub is_appended_raw: bool,
    /// Where arrays begin in `appended`, ascending.
    pub offsets: Vec<usize>,
}

impl Storage<'_> {
    /// The numbers of an array. Integers above 2^53 are rounded.
    pub(super) fn numbers(&self, array: Node<'_, '_>) -> Result<Vec<f64>, Fault> {
        let fault = |message: String| {
            let name = array.attribute("Name").unwrap_or("without a name");
            (line(array.document(), array), format!("array {name}: {message}"))
        };
        let text = array.text().unwrap_or("");
        let bytes = match array.attribute("format") {
            Some("ascii") => {
                let number =
                    |word: &str| word.parse().map_err(|_| fault(format!("'{word}' is not a number")));
                return text.split_ascii_whitespace().map(number).collect();
            }
            Some("binary") => Cow::from(decode(text.as_bytes()).map_err(fault)?),
            Some("appended") => self.appended_bytes(array).map_err(fault)?,
            format => {
                let format = format.unwrap_or("missing");
                return Err(fault(format!("format {format} must be ascii, binary or appended")));
            }
        };
        let content = match self.compressor {
            None => self.uncompressed(&bytes),
            Some("vtkZLibDataCompressor") => self.decompress(&bytes),
            Some(other) => {
                let message = format!("compressor {other} is not read: save it with that of zlib or none");
                return Err(fault(message));
            }
        };
        numbers_of(array.attribute("type").unwrap_or("missing"), &content.map_err(fault)?, self.is_big_endian)
            .map_err(fault)
    }

    /// From the beginning of an appended array to that of the next, or beyond.
    fn appended_bytes(&self, array: Node<'_, '_>) -> Result<Cow<'_, [u8]>, String> {
        let offset = offset(array).ok_or("the attribute offset must be a number of bytes")?;
        let rest = self.appended.get(offset..).ok_or_else(|| {
            format!("truncated: offset {offset}, but {} bytes are appended", self.appended.len())
        })?;
        if self.is_appended_raw {
            return Ok(rest.into());
        }
        let next = self.offsets.get(self.offsets.partition_point(|&other| other <= offset));
        decode(&rest[..next.map_or(rest.len(), |next| (next - offset).min(rest.len()))]).map(Cow::from)
    }

    /// The length at this place, of those before the content.
    fn length(&self, bytes: &[u8], index: usize) -> Result<u64, String> {
        let bytes = bytes.get(index * self.length_size..).unwrap_or(&[]);
        let wide = |bytes: &[u8; 8]| {
            if self.is_big_endian { u64::from_be_bytes(*bytes) } else { u64::from_le_bytes(*bytes) }
        };
        let short = |bytes: &[u8; 4]| {
            if self.is_big_endian { u32::from_be_bytes(*bytes) } else { u32::from_le_bytes(*bytes) }
        };
        let length = match self.length_size {
            4 => bytes.first_chunk().map(|bytes| short(bytes).into()),
            _ => bytes.first_chunk().map(wide),
        };
        length.ok_or_else(|| "truncated: it ends before its content".to_owned())
    }

    fn uncompressed<'b>(&self, bytes: &'b [u8]) -> Result<Cow<'b, [u8]>, String> {
        let length = self.length(bytes, 0)?;
        let content = &bytes[self.length_size..];
        let has = content.len();
        let content = usize::try_from(length).ok().and_then(|length| content.get(..length));
        Ok(content.ok_or_else(|| format!("truncated: {length} bytes are declared, {has} are left"))?.into())
    }

    fn decompress<'b>(&self, bytes: &[u8]) -> Result<Cow<'b, [u8]>, String> {
        let blocks = self.length(bytes, 0)?;
        if blocks == 0 {
            return Ok(Cow::default());
        }
        if blocks > (bytes.len() / self.length_size) as u64 {
            return Err(format!("truncated: {blocks} blocks are declared, {} bytes are left", bytes.len()));
        }
        let blocks = blocks as usize;
        let (size, last) = (self.length(bytes, 1)?, self.length(bytes, 2)?);
        let mut rest = bytes.get((3 + blocks) * self.length_size..).unwrap_or(&[]);
        let mut content = Vec::new();
        for block in 0..blocks {
            let compressed = self.length(bytes, 3 + block)?;
            let split = usize::try_from(compressed).ok().and_then(|length| rest.split_at_checked(length));
            let (compressed, behind) =
                split.ok_or_else(|| format!("truncated: block {block} is not whole"))?;
            rest = behind;
            let expected = if block + 1 == blocks && last > 0 { last } else { size };
            // One byte more tells whether there is more.
            let mut decoder = ZlibDecoder::new(compressed).take(expected.saturating_add(1));
            let read = decoder.read_to_end(&mut content);
            let read = read.map_err(|error| format!("block {block} is no stream of zlib: {error}"))?;
            if read as u64 != expected {
                return Err(format!("block {block} has not the {expected} bytes that it declares"));
            }
        }
        Ok(content.into())
    }
}

/// Where an appended array begins.
pub(super) fn offset(array: Node<'_, '_>) -> Option<usize> {
    array.attribute("offset")?.trim().parse().ok()
}

/// The line on which an element begins.
pub(super) fn line(document: &Document<'_>, node: Node<'_, '_>) -> Place {
    Place::Line(document.text_pos_at(node.range().start).row as usize)
}

/// Decodes base64 in pieces that may each have a padding: lengths and content are encoded apart or together.
fn decode(text: &[u8]) -> Result<Vec<u8>, String> {
    let text: Vec<u8> = text.iter().copied().filter(|byte| !byte.is_ascii_whitespace()).collect();
    let mut bytes = Vec::new();
    for piece in text.split(|&byte| byte == b'=') {
        STANDARD_NO_PAD.decode_vec(piece, &mut bytes).map_err(|error| format!("no base64: {error}"))?;
    }
    Ok(bytes)
}

fn numbers_of(kind: &str, bytes: &[u8], is_big_endian: bool) -> Result<Vec<f64>, String> {
    macro_rules! numbers {
        ($type:ty) => {{
            let (chunks, rest) = bytes.as_chunks();
            if !rest.is_empty() {
                return Err(format!("{} bytes are no whole number of {kind}", bytes.len()));
            }
            let number = if is_big_endian { <$type>::from_be_bytes } else { <$type>::from_le_bytes };
            Ok(chunks.iter().map(|chunk| number(*chunk) as f64).collect())
        }};
    }
    match kind {
        "Int8" => numbers!(i8),
        "UInt8" => numbers!(u8),
        "Int16" => numbers!(i16),
        "UInt16" => numbers!(u16),
        "Int32" => numbers!(i32),
        "UInt32" => numbers!(u32),
        "Int64" => numbers!(i64),
        "UInt64" => numbers!(u64),
        "Float32" => numbers!(f32),
        "Float64" => numbers!(f64),
        _ => Err(format!("type {kind} is no type of numbers (Int32, Float64, ..)")),
    }
}
