//! Arrays of any number type, by name.

use crate::atomic::write_atomic;
use crate::error::{IoError, Place};
use bowknot_errors::counted;
use bowknot_geometry::Point;
use ndarray::ArrayD;
use ndarray_npy::{NpzWriter, ReadDataError, ReadNpyError, ReadNpyExt, ReadableElement};
use py_literal::Value as PyValue;
use std::fs::File;
use std::io::{BufReader, BufWriter, ErrorKind, Read};
use std::path::Path;
use zip::ZipArchive;
use zip::result::ZipError;

/// Longest header of an array [bytes]. NumPy writes 118 for our arrays, and reads no more than 10,000.
const MAX_HEADER: usize = 10_000;

/// A number of an archive, widened from whatever type it was stored as. Integers above 2^53 lose their last
/// digits; none that we read are indices.
#[derive(Clone, Copy)]
struct Number(f64);

impl ReadableElement for Number {
    fn read_to_end_exact_vec<R: Read>(
        mut reader: R,
        descriptor: &PyValue,
        len: usize,
    ) -> Result<Vec<Self>, ReadDataError> {
        let unknown = || ReadDataError::WrongDescriptor(descriptor.clone());
        let PyValue::String(name) = descriptor else { return Err(unknown()) };
        let big_endian = name.starts_with('>');
        let kind = name.trim_start_matches(['<', '>', '|', '=']);
        macro_rules! widen {
            ($type:ty) => {
                read_numbers(&mut reader, len, |bytes| {
                    (if big_endian { <$type>::from_be_bytes(bytes) } else { <$type>::from_le_bytes(bytes) })
                        as f64
                })
            };
        }
        let values = match kind {
            "f4" => widen!(f32),
            "f8" => widen!(f64),
            "i1" => widen!(i8),
            "i2" => widen!(i16),
            "i4" => widen!(i32),
            "i8" => widen!(i64),
            "u1" | "b1" => widen!(u8),
            "u2" => widen!(u16),
            "u4" => widen!(u32),
            "u8" => widen!(u64),
            _ => return Err(unknown()),
        }?;
        // What follows the last number is not part of the array; reading on also checks the archive's
        // checksum.
        let extra = std::io::copy(&mut reader, &mut std::io::sink())?;
        if extra > 0 { Err(ReadDataError::ExtraBytes(extra as usize)) } else { Ok(values) }
    }
}

/// Reads `len` numbers of `N` bytes. Memory grows with what was read, never with what the header claims.
fn read_numbers<R: Read, const N: usize>(
    reader: &mut R,
    len: usize,
    widen: impl Fn([u8; N]) -> f64,
) -> Result<Vec<Number>, ReadDataError> {
    let mut values = Vec::new();
    let mut buffer = Vec::new();
    while values.len() < len {
        let chunk = (len - values.len()).min(1 << 16);
        buffer.resize(chunk * N, 0);
        reader.read_exact(&mut buffer)?;
        values.extend(buffer.chunks_exact(N).filter_map(|bytes| Some(Number(widen(bytes.try_into().ok()?)))));
    }
    Ok(values)
}

/// Reads an array. Its header is read as a whole before it is parsed: the parser believes any length that it
/// claims.
fn read_array(mut reader: impl Read) -> Result<ArrayD<Number>, ReadNpyError> {
    let refuse = |message: String| ReadNpyError::Io(std::io::Error::new(ErrorKind::InvalidData, message));
    // Magic, version, and the length of the header in two bytes, from version 2 on in four.
    let mut header = vec![0; 10];
    reader.read_exact(&mut header)?;
    let mut length = usize::from(u16::from_le_bytes([header[8], header[9]]));
    if header[6] > 1 {
        header.resize(12, 0);
        reader.read_exact(&mut header[10..])?;
        length += usize::from(u16::from_le_bytes([header[10], header[11]])) << 16;
    }
    if length > MAX_HEADER {
        return Err(refuse(format!("its header claims {length} bytes, more than {MAX_HEADER}")));
    }
    let start = header.len();
    header.resize(start + length, 0);
    reader.read_exact(&mut header[start..])?;
    ArrayD::read_npy(header.chain(reader))
}

/// Lengths of an array's axes.
pub type Shape = Vec<usize>;

/// An open archive. Arrays may be stored or deflated, of any number type, in either byte order; every refusal
/// names the file and the array.
pub struct Archive<'a> {
    path: &'a Path,
    zip: ZipArchive<BufReader<File>>,
    names: Vec<String>,
}

impl<'a> Archive<'a> {
    /// Opens an archive.
    ///
    /// # Errors
    /// A missing file, or one that is not an archive.
    pub fn open(path: &'a Path) -> Result<Self, IoError> {
        let file = File::open(path).map_err(|source| IoError::system("read", path, source))?;
        // A folder opens, but does not read; say so in the system's words.
        if file.metadata().is_ok_and(|m| m.is_dir()) {
            return Err(IoError::system("read", path, ErrorKind::IsADirectory.into()));
        }
        let not_npz = |_: ZipError| {
            let hint = if starts_as_npy(path) { "; it is a single array, use np.savez" } else { "" };
            IoError::content(path, Place::File, format!("not an NPZ archive, as np.savez writes it{hint}"))
        };
        let mut zip = ZipArchive::new(BufReader::new(file)).map_err(not_npz)?;
        let mut names = Vec::new();
        for index in 0..zip.len() {
            let entry = zip.by_index(index).map_err(not_npz)?;
            let name = entry.name();
            names.push(name.strip_suffix(".npy").unwrap_or(name).to_owned());
        }
        Ok(Self { path, zip, names })
    }

    /// Whether the archive has an array of this name.
    pub fn has(&self, name: &str) -> bool {
        self.names.iter().any(|n| n == name)
    }

    /// Names of all arrays.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// The array of this name in row-major order, with its shape; none if the archive has none.
    ///
    /// # Errors
    /// An unreadable array.
    pub fn array(&mut self, name: &str) -> Result<Option<(Vec<f64>, Shape)>, IoError> {
        if !self.has(name) {
            return Ok(None);
        }
        let file_name = format!("{name}.npy");
        let entry = if self.zip.index_for_name(&file_name).is_some() { &file_name } else { name };
        let array = self.zip.by_name(entry).map_err(|error| error.to_string()).map(read_array);
        let array = array.map_err(|error| self.fault(name, format!("unreadable: {error}")))?;
        let array = match array {
            Ok(array) => array,
            Err(ReadNpyError::WrongDescriptor(descriptor)) => {
                let allowed = "f32, f64, bool and integers of 8 to 64 bits can be read";
                return Err(self.fault(name, format!("its type is {descriptor}; {allowed}")));
            }
            Err(error) => return Err(self.fault(name, format!("unreadable: {error}"))),
        };
        let shape = array.shape().to_vec();
        Ok(Some((array.iter().map(|number| number.0).collect(), shape)))
    }

    /// An array of rows of `N` numbers. One of no numbers at all may have any shape.
    ///
    /// # Errors
    /// An unreadable array, another shape.
    pub fn rows<const N: usize>(&mut self, name: &str) -> Result<Option<Vec<[f64; N]>>, IoError> {
        let Some((values, shape)) = self.array(name)? else { return Ok(None) };
        if !values.is_empty() && (shape.len() != 2 || shape[1] != N) {
            let hint = if shape.len() == 2 && shape[0] == N { "; transpose it" } else { "" };
            return Err(self.fault(name, format!("its shape is {shape:?}, it must be [n, {N}]{hint}")));
        }
        Ok(Some(values.as_chunks::<N>().0.to_vec()))
    }

    /// An array of `count` numbers.
    ///
    /// # Errors
    /// An unreadable array, another shape or length.
    pub fn column(&mut self, name: &str, count: Option<usize>) -> Result<Option<Vec<f64>>, IoError> {
        let Some((values, shape)) = self.array(name)? else { return Ok(None) };
        if let Some(count) = count
            && values.len() != count
        {
            return Err(self.fault(
                name,
                format!(
                    "it has {} for {}; it needs one per vertex",
                    counted(values.len(), "entry", "entries"),
                    counted(count, "vertex", "vertices")
                ),
            ));
        }
        if shape.iter().filter(|&&n| n != 1).count() > 1 {
            return Err(self.fault(name, format!("its shape is {shape:?}, it must be [n]")));
        }
        Ok(Some(values))
    }

    /// An array of finite points; `count` of them, if given.
    ///
    /// # Errors
    /// An unreadable array, another shape or length, coordinates that are not finite.
    pub fn points(&mut self, name: &str, count: Option<usize>) -> Result<Option<Vec<Point>>, IoError> {
        let Some(rows) = self.rows::<3>(name)? else { return Ok(None) };
        if let Some(count) = count
            && rows.len() != count
        {
            return Err(self.fault(
                name,
                format!(
                    "it has {} for {}",
                    counted(rows.len(), "row", "rows"),
                    counted(count, "vertex", "vertices")
                ),
            ));
        }
        if let Some(vertex) = rows.iter().position(|row| !row.iter().all(|c| c.is_finite())) {
            return Err(self.fault(name, format!("row {vertex} is not finite: {:?}", rows[vertex])));
        }
        Ok(Some(rows.into_iter().map(Point::from).collect()))
    }

    /// An array of elements that name vertices below `count`.
    ///
    /// # Errors
    /// An unreadable array, another shape, vertices that do not exist.
    pub fn elements<const N: usize>(&mut self, name: &str, count: usize) -> Result<Vec<[u32; N]>, IoError> {
        let rows = if N == 1 {
            self.column(name, None)?.map(|values| values.as_chunks::<N>().0.to_vec())
        } else {
            self.rows::<N>(name)?
        };
        let mut elements = Vec::new();
        for (index, row) in rows.unwrap_or_default().into_iter().enumerate() {
            if let Some(bad) = row.iter().find(|&&v| !(v >= 0.0 && v < count as f64 && v.fract() == 0.0)) {
                return Err(self.fault(
                    name,
                    format!(
                        "row {index} names vertex {bad}, but the archive has {}",
                        counted(count, "vertex", "vertices")
                    ),
                ));
            }
            elements.push(row.map(|v| v as u32));
        }
        Ok(elements)
    }

    /// What is wrong with an array.
    pub fn fault(&self, name: &str, message: impl Into<String>) -> IoError {
        IoError::content(self.path, Place::Array(name.to_owned()), message)
    }

    /// What is wrong with the archive as a whole.
    pub fn file_fault(&self, message: impl Into<String>) -> IoError {
        IoError::content(self.path, Place::File, message)
    }
}

/// Whether a file is a single NumPy array, `.npy`.
fn starts_as_npy(path: &Path) -> bool {
    let mut start = [0; 6];
    File::open(path).and_then(|mut file| file.read_exact(&mut start)).is_ok() && start == *b"\x93NUMPY"
}

/// Writes an archive atomically; `fill` adds the arrays.
///
/// # Errors
/// The system's refusal, with the path.
pub fn write_archive(
    path: &Path,
    compressed: bool,
    fill: impl FnOnce(&mut NpzWriter<&mut BufWriter<File>>) -> Result<(), ndarray_npy::WriteNpzError>,
) -> Result<(), IoError> {
    write_atomic(path, |out| {
        let mut writer = if compressed { NpzWriter::new_compressed(out) } else { NpzWriter::new(out) };
        fill(&mut writer).map_err(as_system_error)?;
        writer.finish().map_err(as_system_error)?;
        Ok(())
    })
}

/// The system's error inside the archive writer's, so that a full disk is called one.
fn as_system_error(error: ndarray_npy::WriteNpzError) -> std::io::Error {
    use ndarray_npy::{WriteNpyError, WriteNpzError};
    match error {
        WriteNpzError::Npy(WriteNpyError::Io(source)) => source,
        WriteNpzError::Zip(zip) => {
            match std::error::Error::source(&zip).and_then(|s| s.downcast_ref::<std::io::Error>()) {
                Some(source) => std::io::Error::new(source.kind(), source.to_string()),
                None => std::io::Error::other(zip.to_string()),
            }
        }
        other => std::io::Error::other(other.to_string()),
    }
}
