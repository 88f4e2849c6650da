//! The file of a checkpoint.

use crate::simulator::{CarriedContacts, Checkpoint, ContactForce, ContactMean, Driven, SleepState};
use bowknot_constraints::Feature;
use bowknot_dynamics::{RepulsionSpring, SpringKind};
use bowknot_geometry::{Point, Vector};
use bowknot_io::IoError;
use bowknot_io::npz::{Archive, write_archive};
use bowknot_twoway::lcp::DistanceLimit;
use ndarray::{Array1, Array2};
use std::path::Path;

/// The array of the checksum, as bytes: readers widen numbers to f64, which does not hold all of 64 bits.
const CHECKSUM: &str = "checksum";

/// The array of edges that yield to prescribed vertices.
const YIELDING: &str = "yielding_edges";

/// The array of what a program has changed.
const DRIVEN: &str = "driven";

/// The array of the positions by which a device orders what it searches in.
const ORDER: &str = "search_order";

impl Checkpoint {
    /// Writes the state as one NPZ file, atomically: `step[1]`, `positions[n,3]`, `velocities[n,3]`,
    /// `anchor_counts[p]`, `anchors[k,3]`, `present[b+h]` (1 for bodies and half-spaces that are there),
    /// `contact_features[c,4]` (kind and index of either feature: 0 vertex, 1 edge, 2 triangle, 3 half-space),
    /// `contact_normals[c,3]`, `contact_forces[c,3]`; of contacts near
    /// rest `contact_means[m,22]` (kind and index of either feature, four vertices, their weights, normal, offset,
    /// reach, floor, stiffness, friction, distance, and how many times found the mean goes back); `yielding_edges[e,3]`, if
    /// there are any (two vertices, limit); where bodies
    /// may sleep, `sleep_origins[n,3]`, `sleep_calm_steps[b]` and `sleep_islands[b]` (4294967295: awake); in runs on a device
    /// `search_order[v,3]` after 64 time steps; where a program has changed something `driven[b]`, the bytes of
    /// [`Checkpoint::driven`] as TOML; and `checksum[8]` of all that.
    ///
    /// # Errors
    /// The system's refusal, with the path.
    pub fn write(&self, path: &Path) -> Result<(), IoError> {
        let points = |points: &[Point]| table(points.iter().map(|p| [p.x, p.y, p.z]));
        let vectors = |vectors: &[Vector]| table(vectors.iter().map(|v| [v.x, v.y, v.z]));
        let CarriedContacts { forces, means, yielding } = &self.contacts;
        let driven = text_of(&self.driven);
        let of_forces = |vector: fn(&ContactForce) -> Vector| {
            vectors(&forces.iter().map(vector).collect::<Vec<Vector>>())
        };
        write_archive(path, false, |archive| {
            archive.add_array("step", &Array1::from_elem(1, self.step as u64))?;
            let counts: Array1<u64> = self.anchors.iter().map(|a| a.len() as u64).collect();
            archive.add_array("anchor_counts", &counts)?;
            archive.add_array("present", &Array1::from_iter(self.present.iter().copied()))?;
            archive.add_array("contact_features", &table(forces.iter().map(|c| codes(c.features))))?;
            archive.add_array("contact_normals", &of_forces(|c| c.normal))?;
            archive.add_array("contact_forces", &of_forces(|c| c.force))?;
            archive.add_array("contact_means", &table(means.iter().map(row_of)))?;
            if !yielding.is_empty() {
                archive.add_array(YIELDING, &table(yielding.iter().map(row_of_edge)))?;
            }
            archive.add_array("positions", &points(&self.positions))?;
            archive.add_array("velocities", &vectors(&self.velocities))?;
            archive.add_array("anchors", &points(&self.anchors.concat()))?;
            let SleepState { origins, calm_steps, islands } = &self.sleep;
            if !origins.is_empty() {
                archive.add_array("sleep_origins", &points(origins))?;
                for (name, numbers) in [("sleep_calm_steps", calm_steps), ("sleep_islands", islands)] {
                    archive
                        .add_array(name, &numbers.iter().map(|&n| u64::from(n)).collect::<Array1<u64>>())?;
                }
            }
            if !self.order.is_empty() {
                archive.add_array(ORDER, &points(&self.order))?;
            }
            if !driven.is_empty() {
                archive.add_array(DRIVEN, &Array1::from_iter(driven.bytes()))?;
            }
            archive.add_array(CHECKSUM, &Array1::from_iter(checksum(self, driven.as_bytes())))
        })
    }

    /// Reads a state written by [`Self::write`].
    ///
    /// # Errors
    /// A missing, malformed or damaged file: one whose content is not what its checksum was computed of.
    pub fn read(path: &Path) -> Result<Self, IoError> {
        let mut archive = Archive::open(path)?;
        let step = integers(&mut archive, "step")?;
        let [step] = step[..] else {
            return Err(archive.fault("step", format!("has {} entries, not 1", step.len())));
        };
        let mut checkpoint = Self {
            step: step as usize,
            positions: rows(&mut archive, "positions")?.into_iter().map(Point::from).collect(),
            velocities: rows(&mut archive, "velocities")?.into_iter().map(Vector::from).collect(),
            anchors: anchors(&mut archive)?,
            present: integers(&mut archive, "present")?.into_iter().map(|flag| flag != 0).collect(),
            contacts: CarriedContacts {
                forces: forces(&mut archive)?,
                means: means(&mut archive)?,
                yielding: yielding(&mut archive)?,
            },
            sleep: SleepState::default(),
            order: archive.rows::<3>(ORDER)?.unwrap_or_default().into_iter().map(Point::from).collect(),
            driven: Driven::default(),
        };
        if archive.has("sleep_origins") {
            let narrow = |n: u64| u32::try_from(n).unwrap_or(u32::MAX);
            let narrow = |numbers: Vec<u64>| numbers.into_iter().map(narrow).collect();
            checkpoint.sleep.origins =
                rows(&mut archive, "sleep_origins")?.into_iter().map(Point::from).collect();
            checkpoint.sleep.calm_steps = narrow(integers(&mut archive, "sleep_calm_steps")?);
            checkpoint.sleep.islands = narrow(integers(&mut archive, "sleep_islands")?);
        }
        let mut driven = Vec::new();
        if archive.has(DRIVEN) {
            let bytes = integers(&mut archive, DRIVEN)?;
            driven = bytes.into_iter().map(|byte| u8::try_from(byte).unwrap_or_default()).collect();
            let text = String::from_utf8_lossy(&driven);
            checkpoint.driven =
                toml::from_str(&text).map_err(|error| archive.fault(DRIVEN, error.message().to_owned()))?;
        }
        let sum: Vec<u64> = checksum(&checkpoint, &driven).iter().map(|&byte| u64::from(byte)).collect();
        if integers(&mut archive, CHECKSUM)? != sum {
            let message = "the content is not what was written: the file is damaged";
            return Err(archive.fault(CHECKSUM, message));
        }
        Ok(checkpoint)
    }
}

/// What a program has changed, as text; empty if that is nothing.
fn text_of(driven: &Driven) -> String {
    // No field is one that TOML cannot hold; a test writes and reads all of them.
    if *driven == Driven::default() { String::new() } else { toml::to_string(driven).unwrap_or_default() }
}

/// Rows as an array.
fn table<T: Copy, const N: usize>(rows: impl Iterator<Item = [T; N]>) -> Array2<T> {
    let rows: Vec<[T; N]> = rows.collect();
    Array2::from_shape_fn((rows.len(), N), |(i, k)| rows[i][k])
}

fn missing(archive: &Archive<'_>, name: &str) -> IoError {
    archive.file_fault(format!("array {name} is missing: not a checkpoint, or one of an earlier version"))
}

/// An array of points, vectors or other rows, which must be there.
fn rows<const N: usize>(archive: &mut Archive<'_>, name: &str) -> Result<Vec<[f64; N]>, IoError> {
    archive.rows::<N>(name)?.ok_or_else(|| missing(archive, name))
}

/// An array of whole numbers, which must be there.
fn integers(archive: &mut Archive<'_>, name: &str) -> Result<Vec<u64>, IoError> {
    let values = archive.column(name, None)?.ok_or_else(|| missing(archive, name))?;
    whole(archive, name, &values)
}

fn whole(archive: &Archive<'_>, name: &str, values: &[f64]) -> Result<Vec<u64>, IoError> {
    /// Whole numbers below it are exact in f64.
    const LIMIT: f64 = (1u64 << 53) as f64;
    match values.iter().find(|v| !(**v >= 0.0 && **v < LIMIT && v.fract() == 0.0)) {
        Some(bad) => Err(archive.fault(name, format!("{bad} is no whole number from 0 up"))),
        None => Ok(values.iter().map(|&v| v as u64).collect()),
    }
}

fn anchors(archive: &mut Archive<'_>) -> Result<Vec<Vec<Point>>, IoError> {
    let counts = integers(archive, "anchor_counts")?;
    let all: Vec<Point> = rows(archive, "anchors")?.into_iter().map(Point::from).collect();
    let mut rest = all.as_slice();
    let mut split = Vec::with_capacity(counts.len());
    for count in counts {
        let Some((own, tail)) = rest.split_at_checked(count as usize) else {
            return Err(archive.fault("anchors", "has fewer rows than anchor_counts says"));
        };
        split.push(own.to_vec());
        rest = tail;
    }
    Ok(split)
}

fn forces(archive: &mut Archive<'_>) -> Result<Vec<ContactForce>, IoError> {
    const FEATURES: &str = "contact_features";
    let (normals, forces) = (rows(archive, "contact_normals")?, rows(archive, "contact_forces")?);
    let codes: Vec<[f64; 4]> = rows(archive, FEATURES)?;
    if codes.len() != forces.len() || normals.len() != forces.len() {
        return Err(archive.fault(FEATURES, "has not one row for each normal and each force"));
    }
    let force = |(codes, (normal, force)): ([f64; 4], ([f64; 3], [f64; 3]))| {
        let features = features(archive, FEATURES, codes)?;
        Ok(ContactForce { features, normal: Vector::from(normal), force: Vector::from(force) })
    };
    codes.into_iter().zip(normals.into_iter().zip(forces)).map(force).collect()
}

/// A mean as a row.
fn row_of(mean: &ContactMean) -> [f64; 22] {
    let RepulsionSpring { vertices, weights, normal, offset, reach, floor, stiffness, friction, .. } =
        mean.spring;
    let fours = [
        codes(mean.features).map(|code| code as f64),
        vertices.map(f64::from),
        weights,
        [normal.x, normal.y, normal.z, offset],
        [reach, floor, stiffness, friction],
    ];
    let last = [mean.distance, f64::from(mean.depth)];
    let numbers = fours.as_flattened().iter().chain(&last);
    let mut row = [0.0; 22];
    row.iter_mut().zip(numbers).for_each(|(place, number)| *place = *number);
    row
}

fn means(archive: &mut Archive<'_>) -> Result<Vec<ContactMean>, IoError> {
    const MEANS: &str = "contact_means";
    let mut means = Vec::new();
    for row in rows::<22>(archive, MEANS)? {
        let (fours, last) = row.as_chunks::<4>();
        let (&[codes, vertices, weights, [x, y, z, offset], spring], &[distance, depth]) = (fours, last)
        else {
            unreachable!("a row has five times four numbers and two")
        };
        let [reach, floor, stiffness, friction] = spring;
        let spring = RepulsionSpring {
            kind: SpringKind::Contact,
            vertices: vertices.map(|vertex| vertex as u32),
            weights,
            normal: Vector::new(x, y, z),
            offset,
            reach,
            floor,
            start_gap: 0.0,
            stiffness,
            friction,
            friction_ratio: Vector::zeros(),
        };
        let features = features(archive, MEANS, codes)?;
        means.push(ContactMean { features, spring, distance, depth: depth as u32 });
    }
    Ok(means)
}

/// An edge with its limit as a row.
fn row_of_edge(edge: &DistanceLimit) -> [f64; 3] {
    let [a, b] = edge.vertices.map(f64::from);
    [a, b, edge.limit]
}

fn yielding(archive: &mut Archive<'_>) -> Result<Vec<DistanceLimit>, IoError> {
    let rows = archive.rows::<3>(YIELDING)?.unwrap_or_default();
    let edge = |[a, b, limit]: [f64; 3]| DistanceLimit { vertices: [a, b].map(|v| v as u32), limit };
    Ok(rows.into_iter().map(edge).collect())
}

/// The checksum of a checkpoint's content, with the text of what is `driven`. CRCs of the archive guard its arrays one by one; this one guards
/// them together, so that no array is of another checkpoint, or left out.
fn checksum(checkpoint: &Checkpoint, driven: &[u8]) -> [u8; 8] {
    let Checkpoint { step, positions, velocities, anchors, present, contacts, sleep, order, driven: _ } =
        checkpoint;
    let mut sum = Checksum(0);
    sum.add(*step as u64);
    sum.points(positions);
    sum.vectors(velocities);
    sum.add(anchors.len() as u64);
    anchors.iter().for_each(|anchors| sum.points(anchors));
    sum.add(present.len() as u64);
    present.iter().for_each(|&flag| sum.add(u64::from(flag)));
    sum.add(contacts.forces.len() as u64);
    for contact in &contacts.forces {
        codes(contact.features).into_iter().for_each(|word| sum.add(word));
        sum.vectors(&[contact.normal, contact.force]);
    }
    sum.add(contacts.means.len() as u64);
    for mean in &contacts.means {
        row_of(mean).into_iter().for_each(|number| sum.add(number.to_bits()));
    }
    for edge in &contacts.yielding {
        row_of_edge(edge).into_iter().for_each(|number| sum.add(number.to_bits()));
    }
    sum.points(&sleep.origins);
    for numbers in [&sleep.calm_steps, &sleep.islands] {
        sum.add(numbers.len() as u64);
        numbers.iter().for_each(|&n| sum.add(u64::from(n)));
    }
    // Checkpoints of runs without an order have the sums of earlier versions.
    if !order.is_empty() {
        sum.points(order);
    }
    driven.iter().for_each(|&byte| sum.add(u64::from(byte)));
    sum.0.to_le_bytes()
}

/// A sum of words that depends on their order. Each step is one to one, so a single changed word always
/// changes it.
struct Checksum(u64);

impl Checksum {
    fn add(&mut self, word: u64) {
        // The golden ratio in 64 bits spreads each bit upward, the rotation brings it down again.
        self.0 = (self.0 ^ word).wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15).rotate_left(29);
    }

    fn points(&mut self, points: &[Point]) {
        self.add(points.len() as u64);
        points.iter().flat_map(|p| p.coords.iter()).for_each(|c| self.add(c.to_bits()));
    }

    fn vectors(&mut self, vectors: &[Vector]) {
        self.add(vectors.len() as u64);
        vectors.iter().flatten().for_each(|c| self.add(c.to_bits()));
    }
}

/// Two features in numbers.
fn codes(features: [Feature; 2]) -> [u64; 4] {
    let [a, b] = features.map(code);
    [a[0], a[1], b[0], b[1]]
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

/// Two features from their numbers in the array `name`.
fn features(archive: &Archive<'_>, name: &str, codes: [f64; 4]) -> Result<[Feature; 2], IoError> {
    let codes = whole(archive, name, &codes)?;
    let feature = |kind: u64, index: u64| {
        let index = u32::try_from(index).ok()?;
        match kind {
            0 => Some(Feature::Vertex(index)),
            1 => Some(Feature::Edge(index)),
            2 => Some(Feature::Triangle(index)),
            3 => Some(Feature::HalfSpace(index)),
            _ => None,
        }
    };
    let pair = feature(codes[0], codes[1]).zip(feature(codes[2], codes[3]));
    let (a, b) = pair.ok_or_else(|| archive.fault(name, "has an unknown kind of feature"))?;
    Ok([a, b])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simulator::ObstacleDrive;
    use bowknot_scene::world::Pin;
    use bowknot_scene::{Keyframe, Motion};

    /// A change of each kind but for the scene.
    fn driven() -> Driven {
        let keyframe = Keyframe { time: 0.1, translate: Vector::new(1.0 / 3.0, 0.0, -0.0), angle: 5e-324 };
        let motion = Motion { keyframes: vec![keyframe], ..Motion::default() };
        let places = vec![Point::new(0.1, 1e-300, 1.0 / 3.0)];
        let drives = [ObstacleDrive::Places(places.clone()), ObstacleDrive::Motion(motion)];
        let names = ["a finger", "\"b\""].map(str::to_owned);
        let pin = |end: f64| Pin {
            name: "hand".to_owned(),
            vertices: vec![3, 1],
            motion: None,
            follow: None,
            start: 0.25,
            end,
        };
        Driven {
            scene: None,
            pins: Some(vec![pin(0.5), pin(f64::INFINITY)]),
            grips: [("hand".to_owned(), places)].into(),
            obstacles: names.into_iter().zip(drives).collect(),
            gravity: Some(Vector::new(0.1, 0.2, -1e300)),
            wind: Some(Vector::x()),
            external_forces: vec![Vector::zeros(), Vector::new(1.0 / 3.0, 0.0, 5e-324)],
            elements: [("a \"spring\"".to_owned(), vec![vec![3, 1], vec![0]])].into(),
            pushed: vec![true, false],
        }
    }

    #[test]
    fn a_checkpoint_survives_its_file_to_the_bit() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("state.npz");
        let checkpoint = Checkpoint {
            step: 17,
            positions: vec![Point::new(0.1, -0.0, 1e-300), Point::new(1.0 / 3.0, 2.0, 3.0)],
            velocities: vec![Vector::new(-1e300, 0.0, 5e-324), Vector::zeros()],
            anchors: vec![Vec::new(), vec![Point::new(0.7, 0.8, 0.9)]],
            present: vec![true, false, true],
            contacts: CarriedContacts {
                forces: vec![ContactForce {
                    features: [Feature::Vertex(7), Feature::HalfSpace(1)],
                    normal: Vector::z(),
                    force: Vector::new(0.1, -0.0, 1e-300),
                }],
                means: vec![ContactMean {
                    features: [Feature::Vertex(7), Feature::Triangle(2)],
                    spring: RepulsionSpring {
                        kind: SpringKind::Contact,
                        vertices: [7, 3, u32::MAX, 0],
                        weights: [1.0, -1.0 / 3.0, -0.0, 5e-324],
                        normal: Vector::new(0.1, 0.2, 0.3),
                        offset: -0.5,
                        reach: 0.012,
                        floor: 0.004,
                        start_gap: 0.0,
                        stiffness: 0.7,
                        friction: 0.3,
                        friction_ratio: Vector::zeros(),
                    },
                    distance: 0.01,
                    depth: 9,
                }],
                yielding: vec![DistanceLimit { vertices: [3, 7], limit: 1.0 / 3.0 }],
            },
            sleep: SleepState {
                origins: vec![Point::new(0.2, -0.0, 1e-300), Point::origin()],
                calm_steps: vec![3, 50],
                islands: vec![SleepState::AWAKE, 1],
            },
            order: vec![Point::new(0.5, -0.0, 1.0 / 3.0)],
            driven: driven(),
        };
        checkpoint.write(&path).expect("write");
        let read = Checkpoint::read(&path).expect("read");
        assert_eq!(read, checkpoint);
        assert!(read.positions[0].y.is_sign_negative());
        // Runs in which nothing may sleep write nothing about sleep, and those that nobody drives nothing of that.
        let (sleep, driven) = (SleepState::default(), Driven::default());
        let checkpoint = Checkpoint { sleep, driven, order: Vec::new(), ..checkpoint };
        checkpoint.write(&path).expect("write");
        assert_eq!(Checkpoint::read(&path).expect("read"), checkpoint);
    }

    #[test]
    fn no_flipped_bit_and_no_cut_gives_another_state() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("state.npz");
        let checkpoint = Checkpoint {
            step: 3,
            positions: vec![Point::new(0.1, 0.2, 0.3)],
            velocities: vec![Vector::x()],
            ..Checkpoint::default()
        };
        checkpoint.write(&path).expect("write");
        let bytes = std::fs::read(&path).expect("just written");
        let mut refused = 0;
        for bit in 0..8 * bytes.len() {
            let mut flipped = bytes.clone();
            flipped[bit / 8] ^= 1 << (bit % 8);
            std::fs::write(&path, &flipped).expect("write");
            match Checkpoint::read(&path) {
                // Dates and the like may be wrong.
                Ok(read) => assert_eq!(read, checkpoint, "bit {bit}"),
                Err(_) => refused += 1,
            }
        }
        assert!(refused > 4 * bytes.len(), "{refused} of {} bits", 8 * bytes.len());
        for length in 0..bytes.len() {
            std::fs::write(&path, &bytes[..length]).expect("write");
            Checkpoint::read(&path).expect_err("a cut file");
        }
    }

    /// The archive's own sums hold for each array, so an array of another checkpoint passes them.
    #[test]
    fn an_array_of_another_checkpoint_is_noticed() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("state.npz");
        let checkpoint = Checkpoint { step: 3, positions: vec![Point::origin()], ..Checkpoint::default() };
        checkpoint.write(&path).expect("write");
        let bytes = std::fs::read(&path).expect("just written");
        let other = Checkpoint { step: 4, ..checkpoint };
        write_archive(&path, false, |archive| {
            let mut old = ndarray_npy::NpzReader::new(std::io::Cursor::new(&bytes)).expect("an archive");
            let contacts = ["contact_normals", "contact_forces", "contact_means"];
            for name in ["positions", "velocities", "anchors"].into_iter().chain(contacts) {
                let array: Array2<f64> = old.by_name(name).expect("an array");
                archive.add_array(name, &array)?;
            }
            let codes: Array2<u64> = old.by_name("contact_features").expect("an array");
            archive.add_array("contact_features", &codes)?;
            let counts: Array1<u64> = old.by_name("anchor_counts").expect("an array");
            archive.add_array("anchor_counts", &counts)?;
            let present: Array1<bool> = old.by_name("present").expect("an array");
            archive.add_array("present", &present)?;
            let sum: Array1<u8> = old.by_name(CHECKSUM).expect("an array");
            archive.add_array(CHECKSUM, &sum)?;
            archive.add_array("step", &Array1::from_elem(1, other.step as u64))
        })
        .expect("write");
        let error = Checkpoint::read(&path).expect_err("mixed").to_string();
        assert!(error.contains("checksum") && error.contains("damaged"), "{error}");
    }

    #[test]
    fn a_damaged_checkpoint_is_an_error() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("state.npz");
        assert!(Checkpoint::read(&path).expect_err("missing").to_string().contains("no such file"));
        std::fs::write(&path, b"PK but not really").expect("write");
        assert!(Checkpoint::read(&path).expect_err("damaged").to_string().contains("not an NPZ archive"));
    }
}
