//! Collision problems: a state x, a target y, and what collides.

use super::columns::per;
use super::filters;
use bowknot_errors::counted;
use bowknot_geometry::{BodyFilter, HalfSpace, PairKind, Point, Vector};
use bowknot_io::IoError;
use bowknot_io::npz::{Archive, write_archive};
use bowknot_scene::nearest;
use bowknot_twoway::lcp::DistanceLimit;
use bowknot_twoway::{
    BodyContact, ContactSide, HalfSpaceContact, PairFriction, PairMultipliers, ResolveInput,
};
use ndarray::{Array0, Array1, Array2};
use ndarray_npy::{NpzWriter, WriteNpzError};
use std::io::{Seek, Write};
use std::path::Path;

/// The arrays of a problem.
const ARRAYS: [&str; 29] = [
    "x",
    "y",
    "F",
    "E",
    "P",
    "rest",
    "mass",
    "fixed",
    "O",
    "body",
    "planes",
    "dt",
    "thickness",
    "delta",
    "friction",
    "stretch_limit",
    "plane_thickness",
    "plane_friction",
    "pair_friction",
    "group",
    "start",
    "known",
    "carried",
    "multipliers",
    "yielding",
    "yielding_limit",
    filters::GROUPS,
    filters::MASK,
    filters::SELF_COLLISION,
];

/// One collision problem as `--record` writes it and `resolve` reads it.
///
/// In the archive: `x[n,3]`, `y[n,3]` [m], `F[m,3]`, and optionally `E[k,2]` (strands), `P[p]` (particles),
/// `rest[n,3]` [m], `mass[n]` [kg], `fixed[n]`, `O[n]` (obstacle), `body[n]`, `planes[h,4]` (unit normal,
/// offset [m], -inf while it is not there), `dt` [s]; stored or deflated, f32 or f64, integers of any width.
///
/// What bodies bring into their contacts, optional as well, with one entry per body of `body`: `thickness`,
/// `delta` [m], `friction`, `stretch_limit` [1], each nan where the body leaves it open; `plane_thickness[h]`
/// [m] and `plane_friction[h]` likewise; `pair_friction[k,3]`: two bodies, half-spaces numbered after the
/// bodies, and their coefficient. `group[n]`: pins that go as one, -1 for none. `start[n,3]` [m]: what
/// friction measures slip from. `known[n]`: vertices whose contacts the target knows. `carried[k,3]`: pairs
/// that carry something at the start, by their kind (0 vertex and vertex, 1 vertex and edge, 2 vertex and
/// triangle, 3 edge and edge, 4 vertex and half-space) and elements, and `multipliers[k,4]`: of normal and
/// friction [m]. `yielding[k,2]`: edges that may be longer than by `stretch_limit`, and `yielding_limit[k]`:
/// how long [m]. `collision_groups[b]`, `collides_with[b]` (bits of the groups that a body is in, and of
/// those that it meets) and `self_collision[b]`: which bodies collide.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct States {
    /// The state, free of intersections.
    pub x: Vec<Point>,
    /// The target.
    pub y: Vec<Point>,
    /// Triangles (`F`).
    pub triangles: Vec<[u32; 3]>,
    /// Strand edges (`E`).
    pub strands: Vec<[u32; 2]>,
    /// Particles (`P`).
    pub particles: Vec<u32>,
    /// Rest positions (`rest`); those of `x` if the archive has none.
    pub rest: Vec<Point>,
    /// Masses (`mass`); 1 if the archive has none.
    pub masses: Vec<f64>,
    /// Prescribed vertices (`fixed`); none if the archive has none.
    pub fixed: Vec<bool>,
    /// Obstacle vertices (`O`); none if the archive has none.
    pub obstacle: Vec<bool>,
    /// Body of each vertex (`body`); if the archive has none, 0 for deformable and 1 for obstacle vertices.
    pub body: Vec<u32>,
    /// Half-spaces (`planes`).
    pub half_spaces: Vec<HalfSpace>,
    /// Time step that the problem stands for (`dt`).
    pub time_step: Option<f64>,
    /// What each body brings into its contacts; empty: nothing.
    pub body_contacts: Vec<BodyContact>,
    /// What each half-space brings into its contacts; empty: nothing.
    pub half_space_contacts: Vec<HalfSpaceContact>,
    /// Friction of pairs of bodies and half-spaces.
    pub pair_frictions: Vec<PairFriction>,
    /// Group of each vertex, [`ResolveInput::NO_GROUP`] for none; empty: no groups.
    pub groups: Vec<u32>,
    /// Positions at the start of the time step; empty: those of `x`.
    pub start: Vec<Point>,
    /// Vertices whose contacts the target knows; empty: none.
    pub known: Vec<bool>,
    /// What pairs carry at the start.
    pub carried: Vec<PairMultipliers>,
    /// Edges that may be longer than their stretch limits, and how long [m].
    pub yielding: Vec<DistanceLimit>,
    /// Which bodies each body collides with; empty: each with all, and deformable ones with themselves.
    pub filters: Vec<BodyFilter>,
}

impl States {
    /// Whether an archive holds a problem rather than a stack of frames.
    ///
    /// # Errors
    /// A missing or malformed archive.
    pub fn are_in(archive: &Path) -> Result<bool, IoError> {
        Ok(!Archive::open(archive)?.has("X"))
    }

    /// Reads a problem.
    ///
    /// # Errors
    /// A missing or malformed archive, a missing or misshapen array, numbers out of range; with the array.
    pub fn read(path: &Path) -> Result<Self, IoError> {
        let mut archive = Archive::open(path)?;
        refuse_unknown(&archive)?;
        let missing = |archive: &Archive<'_>, name: &str| {
            let names = archive.names().join(", ");
            archive.file_fault(format!("array {name} is missing; the archive has: {names}"))
        };
        let x = archive.points("x", None)?.ok_or_else(|| missing(&archive, "x"))?;
        let n = x.len();
        if n == 0 {
            return Err(archive.fault("x", "it has no vertices"));
        }
        if n > u32::MAX as usize {
            return Err(archive.fault("x", format!("{n} vertices; at most {} are possible", u32::MAX)));
        }
        let y = archive.points("y", Some(n))?.ok_or_else(|| missing(&archive, "y"))?;
        let rest = archive.points("rest", Some(n))?.unwrap_or_else(|| x.clone());
        let masses = archive.column("mass", Some(n))?.unwrap_or_else(|| vec![1.0; n]);
        let fixed = flags(&mut archive, "fixed", n)?;
        let obstacle = flags(&mut archive, "O", n)?;
        let body = bodies(&mut archive, &obstacle)?;
        let particles = archive.elements::<1>("P", n)?.into_iter().flatten().collect();
        let half_spaces = planes(&mut archive)?;
        let count = body.iter().max().map_or(0, |&b| b as usize + 1);
        Ok(Self {
            body_contacts: body_contacts(&mut archive, count)?,
            half_space_contacts: half_space_contacts(&mut archive, half_spaces.len())?,
            pair_frictions: pair_frictions(&mut archive, count, half_spaces.len())?,
            groups: groups(&mut archive, n)?,
            start: archive.points("start", Some(n))?.unwrap_or_default(),
            known: if archive.has("known") { flags(&mut archive, "known", n)? } else { Vec::new() },
            carried: carried(&mut archive)?,
            yielding: yielding(&mut archive, n)?,
            filters: filters::read(&mut archive, &body, &obstacle)?,
            triangles: archive.elements("F", n)?,
            strands: archive.elements("E", n)?,
            particles,
            half_spaces,
            time_step: time_step(&mut archive)?,
            x,
            y,
            rest,
            masses,
            fixed,
            obstacle,
            body,
        })
    }

    /// Writes the problem, deflated and atomically; f64 and i32, so that it reads back to the same bits.
    ///
    /// # Errors
    /// The system's refusal, with the path.
    pub fn write(&self, path: &Path) -> Result<(), IoError> {
        write_archive(path, true, |archive| {
            archive.add_array("x", &points(&self.x))?;
            self.write_elements(archive)?;
            archive.add_array("rest", &points(&self.rest))?;
            archive.add_array("mass", &Array1::from_iter(self.masses.iter().copied()))?;
            archive.add_array("fixed", &Array1::from_iter(self.fixed.iter().copied()))?;
            if let Some(dt) = self.time_step {
                archive.add_array("dt", &Array0::from_elem((), dt))?;
            }
            self.write_contacts(archive)
        })
    }

    /// The target and what collides.
    fn write_elements<W: Write + Seek>(&self, archive: &mut NpzWriter<W>) -> Result<(), WriteNpzError> {
        archive.add_array("y", &points(&self.y))?;
        archive.add_array("F", &elements(&self.triangles))?;
        archive.add_array("E", &elements(&self.strands))?;
        archive.add_array("P", &Array1::from_iter(self.particles.iter().map(|&p| p as i32)))?;
        archive.add_array("O", &Array1::from_iter(self.obstacle.iter().copied()))?;
        archive.add_array("body", &Array1::from_iter(self.body.iter().map(|&b| b as i32)))?;
        let rows: Vec<[f64; 4]> =
            self.half_spaces.iter().map(|h| [h.normal.x, h.normal.y, h.normal.z, h.offset]).collect();
        archive.add_array("planes", &table(&rows, |v| v))?;
        filters::write(archive, &self.filters)
    }

    /// What the problem has beyond geometry, each array only where it says something.
    fn write_contacts<W: Write + Seek>(&self, archive: &mut NpzWriter<W>) -> Result<(), WriteNpzError> {
        let mut column =
            |name: &str, values: Vec<f64>, open: fn(f64) -> bool| match values.iter().all(|&v| open(v)) {
                true => Ok(()),
                false => archive.add_array(name, &Array1::from(values)),
            };
        let given = |value: Option<f64>| value.unwrap_or(f64::NAN);
        let (bodies, planes) = (&self.body_contacts, &self.half_space_contacts);
        column("thickness", bodies.iter().map(|b| given(b.thickness)).collect(), f64::is_nan)?;
        column("delta", bodies.iter().map(|b| given(b.delta)).collect(), f64::is_nan)?;
        column("friction", bodies.iter().map(|b| b.friction).collect(), |f| f == 0.0)?;
        column("stretch_limit", bodies.iter().map(|b| given(b.stretch_limit)).collect(), f64::is_nan)?;
        column("plane_thickness", planes.iter().map(|h| given(h.thickness)).collect(), f64::is_nan)?;
        column("plane_friction", planes.iter().map(|h| h.friction).collect(), |f| f == 0.0)?;
        if !self.pair_frictions.is_empty() {
            let count = self.body.iter().max().map_or(0, |&b| b + 1);
            let number = |side| match side {
                ContactSide::Body(body) => f64::from(body),
                ContactSide::HalfSpace(plane) => f64::from(count + plane),
            };
            let row = |pair: &PairFriction| [number(pair.sides[0]), number(pair.sides[1]), pair.friction];
            let rows: Vec<[f64; 3]> = self.pair_frictions.iter().map(row).collect();
            archive.add_array("pair_friction", &table(&rows, |v| v))?;
        }
        if self.groups.iter().any(|&g| g != ResolveInput::NO_GROUP) {
            let number = |&g: &u32| if g == ResolveInput::NO_GROUP { -1 } else { g as i32 };
            archive.add_array("group", &Array1::from_iter(self.groups.iter().map(number)))?;
        }
        if !self.start.is_empty() && self.start != self.x {
            archive.add_array("start", &points(&self.start))?;
        }
        if !self.known.is_empty() {
            archive.add_array("known", &Array1::from_iter(self.known.iter().copied()))?;
        }
        if !self.carried.is_empty() {
            let pairs = self.carried.iter().map(|c| [c.kind as u32, c.elements[0], c.elements[1]]);
            archive.add_array("carried", &table(&pairs.collect::<Vec<_>>(), |v| v))?;
            let multipliers =
                self.carried.iter().map(|c| [c.normal, c.friction.x, c.friction.y, c.friction.z]);
            archive.add_array("multipliers", &table(&multipliers.collect::<Vec<_>>(), |v| v))?;
        }
        if !self.yielding.is_empty() {
            let edges: Vec<[u32; 2]> = self.yielding.iter().map(|edge| edge.vertices).collect();
            archive.add_array("yielding", &elements(&edges))?;
            archive.add_array("yielding_limit", &Array1::from_iter(self.yielding.iter().map(|e| e.limit)))?;
        }
        Ok(())
    }
}

/// Writes the answer to a problem, atomically: the resolved `x[n,3]` [m] as f64, and of the problem what
/// tells whether a state intersects, `y`, `F`, `E`, `P`, `O`, `body`, `planes` and the collision groups.
///
/// # Errors
/// The system's refusal, with the path.
pub fn write_result(path: &Path, problem: &States, x: &[Point]) -> Result<(), IoError> {
    write_archive(path, false, |archive| {
        archive.add_array("x", &points(x))?;
        problem.write_elements(archive)
    })
}

/// What pairs carry at the start; none if nothing is said.
fn carried(archive: &mut Archive<'_>) -> Result<Vec<PairMultipliers>, IoError> {
    let (Some(pairs), Some(multipliers)) = (archive.rows::<3>("carried")?, archive.rows::<4>("multipliers")?)
    else {
        return Ok(Vec::new());
    };
    if pairs.len() != multipliers.len() {
        return Err(archive.fault("multipliers", "has not one row for each row of carried"));
    }
    let whole = |x: f64| (x >= 0.0 && x <= f64::from(u32::MAX) && x.fract() == 0.0).then_some(x as u32);
    let entry = |([kind, a, b], [normal, x, y, z]): ([f64; 3], [f64; 4])| {
        let kind = *PairKind::ALL.get(whole(kind)? as usize)?;
        Some(PairMultipliers {
            kind,
            elements: [whole(a)?, whole(b)?],
            normal,
            friction: Vector::new(x, y, z),
        })
    };
    let carried: Option<Vec<PairMultipliers>> = pairs.into_iter().zip(multipliers).map(entry).collect();
    carried.ok_or_else(|| archive.fault("carried", "has a kind of pair or an element that does not exist"))
}

/// Edges that may be longer than their stretch limits; none if nothing is said.
fn yielding(archive: &mut Archive<'_>, n: usize) -> Result<Vec<DistanceLimit>, IoError> {
    let edges = archive.elements::<2>("yielding", n)?;
    let limits = archive.column("yielding_limit", Some(edges.len()))?.unwrap_or_default();
    if edges.len() != limits.len() {
        return Err(archive.fault("yielding", "has no array yielding_limit beside it"));
    }
    if let Some(row) = limits.iter().position(|limit| !(limit.is_finite() && *limit > 0.0)) {
        let message = format!("row {row} is {}; limits are finite and above 0", limits[row]);
        return Err(archive.fault("yielding_limit", message));
    }
    let edge = |(vertices, limit)| DistanceLimit { vertices, limit };
    Ok(edges.into_iter().zip(limits).map(edge).collect())
}

/// Refuses arrays of unknown names: a misspelled one would be ignored, and the result be that of another
/// problem.
fn refuse_unknown(archive: &Archive<'_>) -> Result<(), IoError> {
    let Some(name) = archive.names().iter().find(|name| !ARRAYS.contains(&name.as_str())) else {
        return Ok(());
    };
    let meant = match name.to_ascii_lowercase().as_str() {
        "faces" | "face" | "triangles" | "tris" | "f" => Some("F"),
        "edges" | "edge" | "strands" | "segments" | "lines" | "e" => Some("E"),
        "particles" | "points" | "p" => Some("P"),
        "masses" | "m" => Some("mass"),
        "pinned" | "pins" | "prescribed" => Some("fixed"),
        "obstacle" | "obstacles" | "o" => Some("O"),
        "bodies" | "body_id" => Some("body"),
        "positions" | "vertices" | "v" => Some("x"),
        "target" | "targets" => Some("y"),
        "time_step" | "timestep" => Some("dt"),
        name => nearest(name, ARRAYS.iter().copied()),
    };
    let hint = meant.map_or_else(String::new, |meant| format!("; did you mean {meant}?"));
    Err(archive
        .file_fault(format!("array {name} has no meaning here{hint}; known are: {}", ARRAYS.join(", "))))
}

fn flags(archive: &mut Archive<'_>, name: &str, n: usize) -> Result<Vec<bool>, IoError> {
    let values = archive.column(name, Some(n))?;
    Ok(values.map_or_else(|| vec![false; n], |v| v.into_iter().map(|flag| flag != 0.0).collect()))
}

fn bodies(archive: &mut Archive<'_>, obstacle: &[bool]) -> Result<Vec<u32>, IoError> {
    let Some(values) = archive.column("body", Some(obstacle.len()))? else {
        return Ok(obstacle.iter().map(|&o| u32::from(o)).collect());
    };
    // Bodies are counted, so that a stray large number would cost memory; none has more bodies than vertices,
    // but that of obstacles is 1 by default even where there is no deformable vertex.
    let limit = values.len().max(2) as f64;
    if let Some(vertex) = values.iter().position(|&b| !(b >= 0.0 && b < limit && b.fract() == 0.0)) {
        let body = values[vertex];
        return Err(archive.fault(
            "body",
            format!(
                "vertex {vertex} has body {body}; bodies are numbered 0, 1, 2 and so on, here up to {} at \
                     most, because there are no more bodies than vertices",
                limit - 1.0
            ),
        ));
    }
    Ok(values.into_iter().map(|b| b as u32).collect())
}

fn planes(archive: &mut Archive<'_>) -> Result<Vec<HalfSpace>, IoError> {
    let mut half_spaces = Vec::new();
    for (index, [x, y, z, offset]) in archive.rows::<4>("planes")?.unwrap_or_default().into_iter().enumerate()
    {
        let normal = Vector::new(x, y, z);
        let length = normal.norm();
        let is_offset = offset.is_finite() || offset == f64::NEG_INFINITY;
        if !(length.is_finite() && length > 0.0 && is_offset) {
            let message = format!(
                "row {index} needs a normal (finite, not zero) and an offset (finite, or -inf while it is \
                 not there)"
            );
            return Err(archive.fault("planes", message));
        }
        // A normal that is a unit to rounding is kept bit by bit, so that a recorded problem is the one that
        // was run.
        let scale = if (length - 1.0).abs() < 1e-12 { 1.0 } else { length };
        half_spaces.push(HalfSpace { normal: normal / scale, offset: offset / scale });
    }
    Ok(half_spaces)
}

fn time_step(archive: &mut Archive<'_>) -> Result<Option<f64>, IoError> {
    let Some((values, _)) = archive.array("dt")? else { return Ok(None) };
    match values.as_slice() {
        [dt] if dt.is_finite() && *dt > 0.0 => Ok(Some(*dt)),
        _ => Err(archive.fault("dt", format!("{values:?} must be one finite number above 0"))),
    }
}

/// Ranges are checked where the numbers are used, by [`bowknot_twoway::Resolver::with_contact`].
fn body_contacts(archive: &mut Archive<'_>, count: usize) -> Result<Vec<BodyContact>, IoError> {
    let mut column = |name| per(archive, name, count, ["body", "bodies"]);
    let (thickness, delta) = (column("thickness")?, column("delta")?);
    let (friction, stretch_limit) = (column("friction")?, column("stretch_limit")?);
    let body = |b: usize| BodyContact {
        thickness: thickness[b],
        delta: delta[b],
        friction: friction[b].unwrap_or(0.0),
        stretch_limit: stretch_limit[b],
    };
    let contacts: Vec<BodyContact> = (0..count).map(body).collect();
    let given = contacts.iter().any(|c| *c != BodyContact::default());
    Ok(if given { contacts } else { Vec::new() })
}

fn half_space_contacts(archive: &mut Archive<'_>, count: usize) -> Result<Vec<HalfSpaceContact>, IoError> {
    let thickness = per(archive, "plane_thickness", count, ["plane", "planes"])?;
    let friction = per(archive, "plane_friction", count, ["plane", "planes"])?;
    let plane = |h: usize| HalfSpaceContact { thickness: thickness[h], friction: friction[h].unwrap_or(0.0) };
    let contacts: Vec<HalfSpaceContact> = (0..count).map(plane).collect();
    let given = contacts.iter().any(|c| *c != HalfSpaceContact::default());
    Ok(if given { contacts } else { Vec::new() })
}

fn pair_frictions(
    archive: &mut Archive<'_>,
    bodies: usize,
    planes: usize,
) -> Result<Vec<PairFriction>, IoError> {
    let mut pairs = Vec::new();
    for (index, row) in archive.rows::<3>("pair_friction")?.unwrap_or_default().into_iter().enumerate() {
        let count = (bodies + planes) as f64;
        if let Some(side) = row[..2].iter().find(|&&s| !(s >= 0.0 && s < count && s.fract() == 0.0)) {
            let message = format!(
                "row {index} names side {side}, but the archive has {} and {}",
                counted(bodies, "body", "bodies"),
                counted(planes, "plane", "planes")
            );
            return Err(archive.fault("pair_friction", message));
        }
        if !row[2].is_finite() {
            let friction = row[2];
            return Err(archive.fault("pair_friction", format!("row {index} has coefficient {friction}")));
        }
        let side = |number: f64| match (number as usize).checked_sub(bodies) {
            None => ContactSide::Body(number as u32),
            Some(plane) => ContactSide::HalfSpace(plane as u32),
        };
        pairs.push(PairFriction { sides: [side(row[0]), side(row[1])], friction: row[2] });
    }
    Ok(pairs)
}

fn groups(archive: &mut Archive<'_>, n: usize) -> Result<Vec<u32>, IoError> {
    let Some(values) = archive.column("group", Some(n))? else { return Ok(Vec::new()) };
    let allowed = |g: f64| g == -1.0 || (g >= 0.0 && g < f64::from(u32::MAX) && g.fract() == 0.0);
    if let Some(vertex) = values.iter().position(|&g| !allowed(g)) {
        let group = values[vertex];
        return Err(archive.fault(
            "group",
            format!("vertex {vertex} has group {group}; groups are numbered from 0 up, -1 is none"),
        ));
    }
    let groups: Vec<u32> =
        values.into_iter().map(|g| if g < 0.0 { ResolveInput::NO_GROUP } else { g as u32 }).collect();
    Ok(if groups.iter().any(|&g| g != ResolveInput::NO_GROUP) { groups } else { Vec::new() })
}

fn points(points: &[Point]) -> Array2<f64> {
    Array2::from_shape_fn((points.len(), 3), |(i, k)| points[i][k])
}

fn elements<const N: usize>(rows: &[[u32; N]]) -> Array2<i32> {
    table(rows, |v| v as i32)
}

fn table<A: Copy, B, const N: usize>(rows: &[[A; N]], convert: impl Fn(A) -> B) -> Array2<B> {
    Array2::from_shape_fn((rows.len(), N), |(i, k)| convert(rows[i][k]))
}
