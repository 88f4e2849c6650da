//! The file of a checkpoint.

use crate::simulator::{Checkpoint, ContactForce, SleepState};
use bowknot_constraints::Feature;
use bowknot_errors::counted;
use bowknot_geometry::{Point, Vector};
use bowknot_io::{IoError, Place, write_atomic};
use ndarray::{Array1, Array2};
use ndarray_npy::{NpzReader, NpzWriter};
use std::fs::File;
use std::io;
use std::path::Path;

impl Checkpoint {
    /// Writes the state as one NPZ file, atomically: `step[1]`, `positions[n,3]`, `velocities[n,3]`,
    /// `anchor_counts[p]`, `anchors[k,3]`, `contact_features[c,4]` (kind and index of either feature: 0
    /// vertex, 1 edge, 2 triangle, 3 half-space), `contact_normals[c,3]`, `contact_forces[c,3]`; where bodies
    /// may sleep, `sleep_origins[n,3]`, `sleep_calm_steps[b]` and `sleep_islands[b]` (4294967295: awake).
    ///
    /// # Errors
    /// The system's refusal, with the path.
    pub fn write(&self, path: &Path) -> Result<(), IoError> {
        let flat = |rows: usize, values: Vec<f64>| {
            Array2::from_shape_vec((rows, 3), values).map_err(io::Error::other)
        };
        write_atomic(path, |out| {
            let mut archive = NpzWriter::new(out);
            let points = |points: &[Point]| points.iter().flat_map(|p| [p.x, p.y, p.z]).collect();
            let velocities = self.velocities.iter().flat_map(|v| [v.x, v.y, v.z]).collect();
            let anchors: Vec<Point> = self.anchors.concat();
            let counts: Array1<u64> = self.anchors.iter().map(|a| a.len() as u64).collect();
            let codes = self.contacts.iter().flat_map(|c| c.features.map(code)).flatten().collect();
            let codes = Array2::from_shape_vec((self.contacts.len(), 4), codes).map_err(io::Error::other)?;
            let of_contacts = |vector: fn(&ContactForce) -> Vector| {
                let values = self.contacts.iter().map(vector).flat_map(|v| [v.x, v.y, v.z]).collect();
                flat(self.contacts.len(), values)
            };
            let arrays = [
                ("contact_normals", of_contacts(|c| c.normal)?),
                ("contact_forces", of_contacts(|c| c.force)?),
                ("positions", flat(self.positions.len(), points(&self.positions))?),
                ("velocities", flat(self.velocities.len(), velocities)?),
                ("anchors", flat(anchors.len(), points(&anchors))?),
            ];
            let step = Array1::from_elem(1, self.step as u64);
            archive.add_array("step", &step).map_err(io::Error::other)?;
            archive.add_array("anchor_counts", &counts).map_err(io::Error::other)?;
            archive.add_array("contact_features", &codes).map_err(io::Error::other)?;
            for (name, array) in &arrays {
                archive.add_array(*name, array).map_err(io::Error::other)?;
            }
            let SleepState { origins, calm_steps, islands } = &self.sleep;
            if !origins.is_empty() {
                let origins = flat(origins.len(), points(origins))?;
                archive.add_array("sleep_origins", &origins).map_err(io::Error::other)?;
                for (name, numbers) in [("sleep_calm_steps", calm_steps), ("sleep_islands", islands)] {
                    let numbers: Array1<u64> = numbers.iter().map(|&n| u64::from(n)).collect();
                    archive.add_array(name, &numbers).map_err(io::Error::other)?;
                }
            }
            archive.finish().map_err(io::Error::other)?;
            Ok(())
        })
    }

    /// Reads a state written by [`Self::write`].
    ///
    /// # Errors
    /// A missing or malformed file.
    pub fn read(path: &Path) -> Result<Self, IoError> {
        let file = File::open(path).map_err(|source| IoError::system("read", path, source))?;
        let fault =
            |name: &str, message: String| IoError::content(path, Place::Array(name.to_owned()), message);
        let mut archive = NpzReader::new(file)
            .map_err(|e| IoError::content(path, Place::File, format!("not a checkpoint: {e}")))?;
        let names = archive.names().map_err(|e| IoError::content(path, Place::File, e.to_string()))?;
        let has_sleep = names.iter().any(|name| name.trim_end_matches(".npy") == "sleep_origins");
        let mut rows = |name: &str| -> Result<Vec<[f64; 3]>, IoError> {
            let array: Array2<f64> = archive.by_name(name).map_err(|e| fault(name, e.to_string()))?;
            if array.ncols() != 3 {
                return Err(fault(
                    name,
                    format!("has {}, not 3", counted(array.ncols(), "column", "columns")),
                ));
            }
            Ok(array.rows().into_iter().map(|row| [row[0], row[1], row[2]]).collect())
        };
        let positions: Vec<Point> = rows("positions")?.into_iter().map(Point::from).collect();
        let velocities: Vec<Vector> = rows("velocities")?.into_iter().map(Vector::from).collect();
        let anchors: Vec<Point> = rows("anchors")?.into_iter().map(Point::from).collect();
        let origins = if has_sleep { rows("sleep_origins")? } else { Vec::new() };
        let (normals, forces) = (rows("contact_normals")?, rows("contact_forces")?);
        let codes: Array2<u64> =
            archive.by_name("contact_features").map_err(|e| fault("contact_features", e.to_string()))?;
        if codes.ncols() != 4 || codes.nrows() != forces.len() || normals.len() != forces.len() {
            let message = "is not of 4 columns and a row for each normal and each force".to_owned();
            return Err(fault("contact_features", message));
        }
        let contacts = codes.rows().into_iter().zip(normals.into_iter().zip(forces));
        let contacts = contacts.map(|(row, (normal, force))| {
            let features = [feature(row[0], row[1])?, feature(row[2], row[3])?];
            Some(ContactForce { features, normal: Vector::from(normal), force: Vector::from(force) })
        });
        let contacts: Option<Vec<ContactForce>> = contacts.collect();
        let contacts =
            contacts.ok_or_else(|| fault("contact_features", "has an unknown kind of feature".to_owned()))?;
        let mut integers = |name: &str| -> Result<Vec<usize>, IoError> {
            let array: Array1<u64> = archive.by_name(name).map_err(|e| fault(name, e.to_string()))?;
            Ok(array.iter().map(|&count| count as usize).collect())
        };
        let counts = integers("anchor_counts")?;
        let step = integers("step")?;
        let [step] = step[..] else {
            return Err(fault("step", format!("has {} entries, not 1", step.len())));
        };
        let mut sleep = SleepState::default();
        if has_sleep {
            let narrow = |n: usize| u32::try_from(n).unwrap_or(u32::MAX);
            sleep.origins = origins.into_iter().map(Point::from).collect();
            sleep.calm_steps = integers("sleep_calm_steps")?.into_iter().map(narrow).collect();
            sleep.islands = integers("sleep_islands")?.into_iter().map(narrow).collect();
        }
        let mut split = Vec::with_capacity(counts.len());
        let mut rest = anchors.as_slice();
        for count in counts {
            let Some((own, tail)) = rest.split_at_checked(count) else {
                return Err(fault("anchors", "has fewer rows than anchor_counts says".to_owned()));
            };
            split.push(own.to_vec());
            rest = tail;
        }
        Ok(Self { step, positions, velocities, anchors: split, contacts, sleep })
    }
}

/// A feature in numbers.
fn code(feature: Feature) -> [u64; 2] {
    match feature {
        Feature::Vertex(v) => [0, u64::from(v)],
        Feature::Edge(e) => [1, u64::from(e)],
        Feature::Triangle(t) => [2, u64::from(t)],
        Feature::HalfSpace(h) => [3, u64::from(h)],
    }
}

fn feature(kind: u64, index: u64) -> Option<Feature> {
    let index = u32::try_from(index).ok()?;
    match kind {
        0 => Some(Feature::Vertex(index)),
        1 => Some(Feature::Edge(index)),
        2 => Some(Feature::Triangle(index)),
        3 => Some(Feature::HalfSpace(index)),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_checkpoint_survives_its_file_to_the_bit() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("state.npz");
        let checkpoint = Checkpoint {
            step: 17,
            positions: vec![Point::new(0.1, -0.0, 1e-300), Point::new(1.0 / 3.0, 2.0, 3.0)],
            velocities: vec![Vector::new(-1e300, 0.0, 5e-324), Vector::zeros()],
            anchors: vec![Vec::new(), vec![Point::new(0.7, 0.8, 0.9)]],
            contacts: vec![ContactForce {
                features: [Feature::Vertex(7), Feature::HalfSpace(1)],
                normal: Vector::z(),
                force: Vector::new(0.1, -0.0, 1e-300),
            }],
            sleep: SleepState {
                origins: vec![Point::new(0.2, -0.0, 1e-300), Point::origin()],
                calm_steps: vec![3, 50],
                islands: vec![SleepState::AWAKE, 1],
            },
        };
        checkpoint.write(&path).expect("write");
        let read = Checkpoint::read(&path).expect("read");
        assert_eq!(read, checkpoint);
        assert!(read.positions[0].y.is_sign_negative());
        // Runs in which nothing may sleep write nothing about sleep.
        let checkpoint = Checkpoint { sleep: SleepState::default(), ..checkpoint };
        checkpoint.write(&path).expect("write");
        assert_eq!(Checkpoint::read(&path).expect("read"), checkpoint);
    }

    #[test]
    fn a_damaged_checkpoint_is_an_error() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("state.npz");
        assert!(Checkpoint::read(&path).expect_err("missing").to_string().contains("no such file"));
        std::fs::write(&path, b"PK but not really").expect("write");
        assert!(Checkpoint::read(&path).expect_err("damaged").to_string().contains("not a checkpoint"));
    }
}
