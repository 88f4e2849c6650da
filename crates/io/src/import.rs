//! From a file's axes and unit to ours: z up, meters.

use crate::error::{IoError, Place};
use crate::mesh::Mesh;
use bowknot_errors::{Checks, Parameters};
use bowknot_geometry::Point;
use serde::{Deserialize, Serialize};
use std::path::Path;

/// Which axis of a file points up.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Up {
    /// The x axis: x becomes z, y becomes x, z becomes y.
    X,
    /// The y axis, as most modelling tools have it: y becomes z, z becomes -y.
    Y,
    /// The z axis, ours: nothing changes.
    #[default]
    Z,
}

/// How coordinates of a file become ours.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Import {
    /// Which axis of the file points up. Default z.
    pub up: Up,
    /// Length of the file's unit [m]: 0.001 for millimeters. Default 1.
    pub scale: f64,
}

impl Default for Import {
    fn default() -> Self {
        Self { up: Up::Z, scale: 1.0 }
    }
}

impl Import {
    /// A point of the file in our axes [m]. Both conversions are rotations: no mesh is turned inside out.
    pub fn point(&self, [x, y, z]: [f64; 3]) -> Point {
        let [x, y, z] = match self.up {
            Up::X => [y, z, x],
            Up::Y => [x, -z, y],
            Up::Z => [x, y, z],
        };
        Point::new(self.scale * x, self.scale * y, self.scale * z)
    }

    /// Converts all points of a mesh that was read from a file.
    pub(crate) fn convert(&self, mesh: &mut Mesh, path: &Path) -> Result<(), IoError> {
        for (vertex, point) in mesh.positions.iter_mut().enumerate() {
            *point = self.point([point.x, point.y, point.z]);
            if !point.iter().all(|c| c.is_finite()) {
                let message = format!("a coordinate overflows when scaled by {}", self.scale);
                return Err(IoError::content(path, Place::Element("vertex".to_owned(), vertex), message));
            }
        }
        Ok(())
    }

    /// As [`Self::point`].
    ///
    /// # Errors
    /// Coordinates that are not finite, or overflow when scaled.
    pub(crate) fn finite_point(&self, raw: [f64; 3]) -> Result<Point, String> {
        let point = self.point(raw);
        match point.iter().all(|c| c.is_finite()) {
            true => Ok(point),
            false if raw.iter().all(|c| c.is_finite()) => {
                Err(format!("a coordinate overflows when scaled by {}", self.scale))
            }
            false => Err(format!("coordinates {raw:?} are not finite")),
        }
    }
}

impl Parameters for Import {
    fn check(&self, checks: &mut Checks) {
        checks.positive("scale", self.scale);
    }
}

/// The bytes of a file that is to be imported like this.
pub(crate) fn read_bytes(path: &Path, import: &Import) -> Result<Vec<u8>, IoError> {
    import.validate().map_err(|errors| IoError::content(path, Place::File, errors.to_string()))?;
    std::fs::read(path).map_err(|source| IoError::system("read", path, source))
}

/// A text without the byte order mark that some editors put before it.
pub(crate) fn without_mark(bytes: &[u8]) -> &[u8] {
    bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes)
}
