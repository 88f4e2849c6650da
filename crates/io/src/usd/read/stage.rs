//! A stage as an animation.

use super::layer::{Attribute, Layer, Prim, SKIN, Value};
use super::part::{SUBSET, elements, is_other_shape, is_part};
use super::subset::add_subsets;
use super::text::{Arrays, read_layer};
use super::xform::Placement;
use crate::animation::{Animation, FrameOptions, frame_times};
use crate::error::{IoError, Place};
use crate::import::{Import, Up};
use crate::mesh::Mesh;
use crate::parts::PartsBuilder;
use crate::transform::place;
use bowknot_errors::counted;
use bowknot_geometry::Point;
use bowknot_geometry::nalgebra::Matrix4;
use std::path::Path;

/// Meshes, curves and points of a stage, each prim a part.
#[derive(Debug)]
pub(crate) struct Stage {
    arrays: Arrays,
    parts: Vec<Part>,
    placements: Vec<Placement>,
    /// Of the parts.
    paths: Vec<String>,
    /// All parts where nothing moves.
    mesh: Mesh,
    /// Time codes of the frames; a single 0 if nothing moves.
    codes: Vec<f64>,
    /// In seconds, if anything moves.
    times: Option<Vec<f64>>,
}

#[derive(Debug)]
struct Part {
    path: String,
    points: Attribute,
    count: usize,
    /// The placements that lead to it, by their numbers, the outermost first.
    chain: Vec<usize>,
}

impl Stage {
    /// Reads everything but the positions.
    ///
    /// # Errors
    /// A missing or malformed file, with the line; prims whose arrays do not fit, with their paths; no meshes,
    /// curves or points.
    pub fn open(path: &Path, options: &FrameOptions) -> Result<Self, IoError> {
        let layer = read_layer(path)?;
        let arrays = Arrays { path: path.to_owned() };
        Self::new(layer, arrays, options)
    }

    fn new(mut layer: Layer, arrays: Arrays, options: &FrameOptions) -> Result<Self, IoError> {
        let prims = std::mem::take(&mut layer.prims);
        let mut walk =
            Walk { arrays: &arrays, found: Vec::new(), placements: Vec::new(), left_out: Notes::default() };
        for prim in prims {
            walk.prim(prim, "", &[])?;
        }
        let Walk { found, placements, left_out, .. } = walk;
        left_out.warn(&arrays.path, &layer);
        warn_of_axes(&arrays.path, &layer, &options.import);
        if found.is_empty() {
            let message = "no meshes, curves or points in it";
            return Err(IoError::content(&arrays.path, Place::File, message));
        }
        let names = names(&found);
        let (parts, prims): (Vec<Part>, Vec<Prim>) = found.into_iter().unzip();
        let paths = parts.iter().map(|part| part.path.clone()).collect();
        let (mesh, codes) = (Mesh::default(), Vec::new());
        let mut stage = Self { parts, paths, arrays, placements, mesh, codes, times: None };
        let mut unfit = Notes::default();
        let mut builder = PartsBuilder::default();
        for ((index, name), prim) in names.into_iter().enumerate().zip(&prims) {
            let part = &mut stage.parts[index];
            let points = point_count(&stage.arrays, part)?;
            part.count = points;
            let part = &stage.parts[index];
            // The winding of faces is that of the mesh before it is mirrored.
            let mirrored = stage.part_matrix(part, None)?.determinant() < 0.0;
            let mut mesh = elements(&stage.arrays, &part.path, prim, points, mirrored)?;
            mesh.positions = stage.part_positions(&stage.parts[index], None)?;
            mesh.triangulate();
            if !add_subsets(&stage.arrays, prim, &mut mesh.groups, points)? {
                unfit.add("subsets that are no lists of its faces or points, so left out", &part.path);
            }
            let overflow =
                || stage.arrays.fault(&stage.parts[index].path, "more vertices than 32 bits count");
            builder.add(mesh, name).ok_or_else(overflow)?;
        }
        unfit.warn(&stage.arrays.path, &Layer::default());
        stage.mesh = builder.finish();
        stage.set_times(&layer, options.rate);
        Ok(stage)
    }

    /// The mesh where nothing moves: default values, else those of the first time codes. And the paths of its
    /// parts.
    pub fn into_mesh(self) -> (Mesh, Vec<String>) {
        (self.mesh, self.paths)
    }

    fn set_times(&mut self, layer: &Layer, rate: Option<f64>) {
        let of_points = self.parts.iter().flat_map(|part| part.points.samples.iter().map(|(code, _)| *code));
        let of_placements = self.parts.iter().flat_map(|part| &part.chain);
        let of_placements = of_placements.flat_map(|&index| self.placements[index].codes());
        let mut codes: Vec<f64> = of_points.chain(of_placements).collect();
        codes.sort_by(f64::total_cmp);
        codes.dedup();
        let number = |name: &str| match layer.metadata.get(name) {
            Some(Value::Numbers(numbers)) => numbers.first().copied().filter(|n| n.is_finite() && *n > 0.0),
            _ => None,
        };
        // The fallbacks of USD.
        let per_second = number("timeCodesPerSecond").or_else(|| number("framesPerSecond")).unwrap_or(24.0);
        if codes.is_empty() {
            self.codes = vec![0.0];
            return;
        }
        if rate.is_some() {
            let keys: Vec<f64> = codes.iter().map(|code| code / per_second).collect();
            codes = frame_times(&keys, rate).iter().map(|time| time * per_second).collect();
        }
        self.times = Some(codes.iter().map(|code| code / per_second).collect());
        self.codes = codes;
    }

    fn part_positions(&self, part: &Part, code: Option<f64>) -> Result<Vec<Point>, IoError> {
        let ends = match code {
            Some(code) => part.points.around(code),
            None => part.points.first().map(|value| (value, value, 0.0)),
        };
        let (low, high, weight) = ends.ok_or_else(|| self.arrays.fault(&part.path, "points are missing"))?;
        let mut points = self.points(part, low)?;
        if weight > 0.0 {
            let high = self.points(part, high)?;
            points.iter_mut().zip(high).for_each(|(p, q)| *p += (q - *p) * weight);
        }
        place(&self.part_matrix(part, code)?, &mut points);
        match points.iter().position(|point| !point.iter().all(|c| c.is_finite())) {
            None => Ok(points),
            Some(point) => Err(self.arrays.fault(&part.path, format!("point {point} is not finite"))),
        }
    }

    /// From a part to the stage.
    fn part_matrix(&self, part: &Part, code: Option<f64>) -> Result<Matrix4<f64>, IoError> {
        part.chain.iter().try_fold(Matrix4::identity(), |all, &index| {
            let own = self.placements[index].matrix(code);
            Ok(all * own.map_err(|message| self.arrays.fault(&part.path, message))?)
        })
    }

    fn points(&self, part: &Part, value: &Value) -> Result<Vec<Point>, IoError> {
        let Value::Array(place) = value else {
            return Err(self.arrays.fault(&part.path, "points must be an array"));
        };
        let numbers = self.arrays.read(place)?;
        let (points, rest) = numbers.as_chunks::<3>();
        if !rest.is_empty() || points.len() != part.count {
            let message = format!(
                "points has {} numbers; 3 for each of {} are needed in all frames",
                numbers.len(),
                counted(part.count, "point", "points")
            );
            return Err(self.arrays.fault(&part.path, message));
        }
        Ok(points.iter().map(|&p| Point::from(p)).collect())
    }
}

fn point_count(arrays: &Arrays, part: &Part) -> Result<usize, IoError> {
    match part.points.first() {
        Some(Value::Array(place)) => Ok(arrays.read(place)?.len() / 3),
        _ => Err(arrays.fault(&part.path, "points are missing")),
    }
}

impl Animation for Stage {
    fn len(&self) -> usize {
        self.codes.len()
    }

    fn times(&self) -> Option<&[f64]> {
        self.times.as_deref()
    }

    fn codes(&self) -> Option<&[f64]> {
        self.times.as_ref().map(|_| &self.codes[..])
    }

    fn names(&self) -> &[String] {
        &self.mesh.names
    }

    fn paths(&self) -> &[String] {
        &self.paths
    }

    fn path(&self, _index: usize) -> &Path {
        &self.arrays.path
    }

    fn read(&self, index: usize) -> Result<Mesh, IoError> {
        if self.times.is_none() {
            return Ok(self.mesh.clone());
        }
        let mut positions = Vec::with_capacity(self.mesh.positions.len());
        for part in &self.parts {
            positions.append(&mut self.part_positions(part, Some(self.codes[index]))?);
        }
        Ok(Mesh { positions, ..self.mesh.clone() })
    }
}

/// The names of the parts: display names, else names of prims; paths where these are not unique.
fn names(found: &[(Part, Prim)]) -> Vec<String> {
    let short = |prim: &Prim| prim.display_name.clone().unwrap_or_else(|| prim.name.clone());
    let mut all: Vec<String> = found.iter().map(|(_, prim)| short(prim)).collect();
    all.sort_unstable();
    let is_unique =
        |name: &String| all.partition_point(|n| n <= name) - all.partition_point(|n| n < name) == 1;
    let name =
        |part: &Part, prim: &Prim| Some(short(prim)).filter(is_unique).unwrap_or_else(|| part.path.clone());
    found.iter().map(|(part, prim)| name(part, prim)).collect()
}

/// Goes through the prims of a layer.
struct Walk<'a> {
    arrays: &'a Arrays,
    found: Vec<(Part, Prim)>,
    placements: Vec<Placement>,
    left_out: Notes,
}

/// What is read in another way than it is meant, each with the first prim and the number of prims.
#[derive(Debug, Default)]
struct Notes(Vec<(&'static str, String, usize)>);

impl Notes {
    fn add(&mut self, what: &'static str, path: &str) {
        match self.0.iter_mut().find(|(other, _, _)| *other == what) {
            Some((_, _, count)) => *count += 1,
            None => self.0.push((what, path.to_owned(), 1)),
        }
    }

    fn warn(&self, path: &Path, layer: &Layer) {
        for (what, prim, count) in &self.0 {
            let prims = counted(*count, "prim", "prims");
            tracing::warn!("{}: {what}: {prims}, the first is {prim}", path.display());
        }
        if let Some(composed) = &layer.composed {
            tracing::warn!(
                "{}: {composed} are not followed: `usdcat --flatten IN.usd -o OUT.usda` puts all in one file",
                path.display()
            );
        }
    }
}

impl Walk<'_> {
    fn prim(&mut self, mut prim: Prim, parent: &str, chain: &[usize]) -> Result<(), IoError> {
        let path = format!("{parent}/{}", prim.name);
        if prim.text("visibility") == Some("invisible")
            || matches!(prim.text("purpose"), Some("guide" | "proxy"))
        {
            self.left_out.add("invisible, guide or proxy, so left out", &path);
            return Ok(());
        }
        if is_other_shape(&prim.kind) {
            self.left_out.add("no meshes, curves or points, so left out", &path);
            return Ok(());
        }
        let placement = Placement::of(&mut prim).map_err(|message| self.arrays.fault(&path, message))?;
        let mut chain = if placement.resets { Vec::new() } else { chain.to_vec() };
        if !placement.is_identity() {
            chain.push(self.placements.len());
            self.placements.push(placement);
        }
        let is_subset = |child: &Prim| child.kind == SUBSET;
        let (subsets, children) = std::mem::take(&mut prim.children).into_iter().partition(is_subset);
        prim.children = subsets;
        for child in children {
            self.prim(child, &path, &chain)?;
        }
        if !is_part(&prim.kind) {
            return Ok(());
        }
        if prim.kind == "Mesh" && prim.text("subdivisionScheme") != Some("none") {
            self.left_out.add("subdivision surfaces, of which the control cages are taken", &path);
        }
        if prim.attributes.keys().any(|name| name.starts_with(SKIN)) {
            self.left_out.add(
                "skinned by a skeleton, of which the points at rest are taken (`UsdSkel.BakeSkinning` writes how \
                 they move)",
                &path,
            );
        }
        if prim.kind == "BasisCurves" && prim.text("type") != Some("linear") {
            self.left_out.add("cubic curves, taken as lines through their control points", &path);
        }
        let points = prim.attributes.remove("points").unwrap_or_default();
        // Prims that are defined but hold nothing.
        if points.first().is_some() {
            self.found.push((Part { path, points, count: 0, chain }, prim));
        }
        Ok(())
    }
}

/// Says how axes and unit of the file are converted, if nobody has.
fn warn_of_axes(path: &Path, layer: &Layer, import: &Import) {
    if *import != Import::default() {
        return;
    }
    let up = match layer.metadata.get("upAxis") {
        Some(Value::Text(up)) if up == "Y" => Up::Y,
        _ => Up::Z,
    };
    let unit = match layer.metadata.get("metersPerUnit") {
        Some(Value::Numbers(unit)) => unit.first().copied().unwrap_or(1.0),
        _ => 1.0,
    };
    if up != import.up || unit != import.scale {
        let up = if up == Up::Y { "y" } else { "z" };
        tracing::warn!(
            "{}: it says that {up} is up and that its unit is {unit} m; coordinates are taken as they are, \
             unless up = \"{up}\" and scale = {unit} are given",
            path.display()
        );
    }
}
