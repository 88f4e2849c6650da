//! The positions of all frames so far on disk, for formats that are one file in the end: memory holds one
//! frame.

use bowknot_geometry::Point;
use bowknot_io::IoError;
use std::fs::{File, OpenOptions};
use std::io::{Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

/// A file of bare positions, little-endian doubles, frame behind frame.
#[derive(Clone, Debug)]
pub(super) struct Spool {
    path: PathBuf,
    /// Vertices of a frame.
    vertices: usize,
}

impl Spool {
    pub fn new(path: PathBuf, vertices: usize) -> Self {
        Self { path, vertices }
    }

    pub fn path(&self) -> &Path {
        &self.path
    }

    fn offset(&self, frame: usize) -> u64 {
        24 * self.vertices as u64 * frame as u64
    }

    /// Number of whole frames in the file; 0 if there is none.
    pub fn frames(&self) -> usize {
        let length = self.path.metadata().map_or(0, |m| m.len());
        (length / self.offset(1).max(1)) as usize
    }

    /// Writes a frame and drops those behind it. There must be as many before it.
    pub fn write(&self, frame: usize, positions: &[Point]) -> Result<(), IoError> {
        let bytes: Vec<u8> =
            positions.iter().flat_map(|p| [p.x, p.y, p.z]).flat_map(f64::to_le_bytes).collect();
        let write = || {
            let mut file = OpenOptions::new().create(true).truncate(false).write(true).open(&self.path)?;
            file.seek(SeekFrom::Start(self.offset(frame)))?;
            file.write_all(&bytes)?;
            file.set_len(self.offset(frame + 1))
        };
        write().map_err(|source| IoError::system("write", &self.path, source))
    }

    /// Appends the bytes of a frame's coordinates.
    pub fn read_bytes(&self, frame: usize, bytes: &mut Vec<u8>) -> std::io::Result<()> {
        let mut file = File::open(&self.path)?;
        file.seek(SeekFrom::Start(self.offset(frame)))?;
        let size = self.offset(1);
        if file.take(size).read_to_end(bytes)? as u64 == size {
            Ok(())
        } else {
            Err(std::io::ErrorKind::UnexpectedEof.into())
        }
    }

    /// Positions of a frame [m].
    pub fn read(&self, frame: usize) -> std::io::Result<Vec<Point>> {
        let mut bytes = Vec::new();
        self.read_bytes(frame, &mut bytes)?;
        let coordinates: Vec<f64> = bytes.as_chunks::<8>().0.iter().map(|&b| f64::from_le_bytes(b)).collect();
        Ok(coordinates.as_chunks::<3>().0.iter().map(|&p| Point::from(p)).collect())
    }

    pub fn remove(&self) {
        // What cannot be removed is only in the way.
        let _ = std::fs::remove_file(&self.path);
    }
}
