//! Point caches, `.pc2`: positions of one object's vertices, frame by frame, for Blender's Mesh Cache
//! modifier, 3ds Max and Maya.
//!
//! The layout, little-endian: `POINTCACHE2\0`, version 1 (i32), points a sample (i32), first frame (f32),
//! sampling rate in frames (f32), number of samples (i32), then x y z (f32) of every point of every sample.
//! Source: the format notes in Blender's exporter `export_pc2`.

use crate::error::{IoError, Place};
use bowknot_geometry::Point;
use std::fs::{File, OpenOptions};
use std::io::{ErrorKind, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

const MAGIC: &[u8; 12] = b"POINTCACHE2\0";
const HEADER: u64 = 32;
/// Where the header says how many samples there are.
const SAMPLES_AT: u64 = 28;

/// Writes the sample of a frame, counted from 0, and drops those behind it; frame 0 makes the file. The
/// header counts a sample once it is written as a whole, so that a run that dies leaves a sound file.
///
/// # Errors
/// The system's refusal; a file that is no point cache of as many points, or has fewer samples.
pub fn write_pc2_frame(path: &Path, frame: usize, positions: &[Point]) -> Result<(), IoError> {
    let system = |source| IoError::system("write", path, source);
    let points = i32::try_from(positions.len()).ok().filter(|_| frame < i32::MAX as usize);
    let points = points.ok_or_else(|| system(ErrorKind::FileTooLarge.into()))?;
    let mut file = if frame == 0 {
        let mut file = File::create(path).map_err(system)?;
        let mut header = MAGIC.to_vec();
        header.extend(1_i32.to_le_bytes());
        header.extend(points.to_le_bytes());
        header.extend(0_f32.to_le_bytes());
        header.extend(1_f32.to_le_bytes());
        header.extend(0_i32.to_le_bytes());
        file.write_all(&header).map_err(system)?;
        file
    } else {
        truncate_pc2(path, frame, positions.len())?;
        OpenOptions::new().write(true).open(path).map_err(system)?
    };
    let sample: Vec<u8> =
        positions.iter().flat_map(|p| [p.x, p.y, p.z]).flat_map(|x| (x as f32).to_le_bytes()).collect();
    let mut append = || {
        file.seek(SeekFrom::Start(HEADER + 12 * points as u64 * frame as u64))?;
        file.write_all(&sample)?;
        file.seek(SeekFrom::Start(SAMPLES_AT))?;
        file.write_all(&(frame as i32 + 1).to_le_bytes())
    };
    append().map_err(system)
}

/// A point cache that is read sample by sample.
#[derive(Clone, Debug)]
pub(crate) struct PointCache {
    path: PathBuf,
    points: usize,
    samples: usize,
}

impl PointCache {
    /// Reads the header, and whether the file is as long as it says.
    ///
    /// # Errors
    /// The system's refusal; a file that is no point cache, or is cut.
    pub fn open(path: &Path) -> Result<Self, IoError> {
        let system = |source| IoError::system("read", path, source);
        let fault = |message: String| Err(IoError::content(path, Place::File, message));
        let mut file = File::open(path).map_err(system)?;
        let mut header = [0; HEADER as usize];
        if file.read_exact(&mut header).is_err() || !header.starts_with(MAGIC) {
            return fault("not a point cache".to_owned());
        }
        let (points, samples) = (number_at(&header, 16), number_at(&header, SAMPLES_AT as usize));
        if points == 0 {
            return fault("it has no points".to_owned());
        }
        // Both are below 2^31.
        let (expected, length) =
            (u128::from(HEADER) + 12 * points as u128 * samples as u128, file.metadata());
        let length = length.map_err(system)?.len();
        if u128::from(length) < expected {
            return fault(format!(
                "it has {length} bytes; {samples} samples of {points} points take {expected}"
            ));
        }
        Ok(Self { path: path.to_owned(), points, samples })
    }

    /// The file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Points of each sample.
    pub fn points(&self) -> usize {
        self.points
    }

    /// Number of samples.
    pub fn samples(&self) -> usize {
        self.samples
    }

    /// The points of a sample.
    ///
    /// # Errors
    /// The system's refusal; coordinates that are not finite.
    pub fn read(&self, sample: usize) -> Result<Vec<Point>, IoError> {
        let mut bytes = Vec::new();
        let size = 12 * self.points as u64;
        let mut read = || {
            let mut file = File::open(&self.path)?;
            file.seek(SeekFrom::Start(HEADER + size * sample as u64))?;
            match file.take(size).read_to_end(&mut bytes)? as u64 == size {
                true => Ok(()),
                false => Err(ErrorKind::UnexpectedEof.into()),
            }
        };
        read().map_err(|source| IoError::system("read", &self.path, source))?;
        let numbers: Vec<f64> =
            bytes.as_chunks::<4>().0.iter().map(|&b| f32::from_le_bytes(b).into()).collect();
        let points: Vec<Point> = numbers.as_chunks::<3>().0.iter().map(|&p| Point::from(p)).collect();
        match points.iter().position(|point| !point.iter().all(|c| c.is_finite())) {
            None => Ok(points),
            Some(point) => {
                let message = format!("point {point} is not finite");
                Err(IoError::content(&self.path, Place::Element("sample".to_owned(), sample), message))
            }
        }
    }
}

/// The number at a place of a header; 0 if it is negative.
fn number_at(header: &[u8; HEADER as usize], at: usize) -> usize {
    let bytes = [header[at], header[at + 1], header[at + 2], header[at + 3]];
    usize::try_from(i32::from_le_bytes(bytes)).unwrap_or(0)
}

/// Drops the samples from `frames` on.
///
/// # Errors
/// The system's refusal; a file that is no point cache of `points` points, or has fewer than `frames`
/// samples.
pub fn truncate_pc2(path: &Path, frames: usize, points: usize) -> Result<(), IoError> {
    let system = |source| IoError::system("write", path, source);
    let fault = |message: String| Err(IoError::content(path, Place::File, message));
    let mut file = OpenOptions::new().read(true).write(true).open(path).map_err(system)?;
    let mut header = [0; HEADER as usize];
    if file.read_exact(&mut header).is_err() || !header.starts_with(MAGIC) {
        return fault("not a point cache".to_owned());
    }
    let (given, samples) = (number_at(&header, 16), number_at(&header, SAMPLES_AT as usize));
    if given != points {
        return fault(format!("it is a point cache of {given} points, not of {points}"));
    }
    let length = HEADER + 12 * points as u64 * frames as u64;
    if samples < frames || file.metadata().map_err(system)?.len() < length {
        return fault(format!("it has {samples} samples, {frames} are needed"));
    }
    let mut shorten = || {
        file.seek(SeekFrom::Start(SAMPLES_AT))?;
        file.write_all(&(frames as i32).to_le_bytes())?;
        file.set_len(length)
    };
    shorten().map_err(system)
}
