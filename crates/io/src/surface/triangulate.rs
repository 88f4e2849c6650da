//! Polygons whose fans do not fill them.
//!
//! The triangles of a mesh are the fans of its polygons around their first corners. Where a polygon is
//! concave, or has corners on straight sides, such a fan may leave the outline or have triangles without an
//! area. Then the polygon begins with another of its corners, if the fan around that one fills it, else
//! triangles take its place.

use super::polygons::{Corner, Surface};
use crate::mesh::Mesh;
use bowknot_geometry::{Point, Vector};
use earcut::Earcut;
use std::collections::HashMap;

/// Corners that a polygon has at most for its fans around all of them to be tried.
const MOST_CORNERS: usize = 64;

/// Sine of the angle between two sides up to which their corner is on a straight line. Files of single
/// precision have such corners 1e-7 beside it.
const STRAIGHT: f64 = 1e-6;

/// Twice the area of a triangle over its longest side squared, below which another fan is preferred if it is
/// better.
const THIN: f64 = 1e-3;

/// Height of corners over the mean plane of a polygon, in the root of twice its area, from which on it has no
/// plane outline.
const WARPED: f64 = 0.2;

/// Relative error of areas up to which triangles fill a polygon.
const FILLED: f64 = 1e-6;

/// Polygons that stay as they are although their fans do not fill them, by their numbers.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct PolygonFaults {
    /// Their outlines cross themselves.
    pub crossing: Vec<usize>,
    /// They are too far from flat to have a plane outline.
    pub warped: Vec<usize>,
}

impl PolygonFaults {
    /// The faults in words; none if there are none.
    pub fn describe(&self) -> Option<String> {
        let of = |list: &[usize], one: &str, many: &str| match list {
            [] => None,
            [polygon] => Some(format!("polygon {polygon} {one}")),
            [first, ..] => Some(format!("{} polygons {many}, the first is polygon {first}", list.len())),
        };
        let crossing = of(&self.crossing, "crosses itself", "cross themselves");
        let warped = of(&self.warped, "is far from flat", "are far from flat");
        let faults: Vec<String> = crossing.into_iter().chain(warped).collect();
        (!faults.is_empty())
            .then(|| faults.join("; ") + "; the triangles of such polygons share their first corner")
    }
}

impl Mesh {
    /// Makes the triangles fill the polygons of the surface, see [`Surface`]. Polygons that are convex keep
    /// their first corners, unless their triangles would be slivers. Nothing changes for a mesh without
    /// polygons.
    pub fn triangulate(&mut self) -> PolygonFaults {
        let mut faults = PolygonFaults::default();
        let Some(surface) = &self.surface else { return faults };
        let mut filled: Option<Surface> = None;
        for (index, polygon) in surface.polygons().enumerate() {
            let outline: Vec<Point> =
                polygon.corners.iter().map(|c| self.positions[c.vertex as usize]).collect();
            let filling = Filling::of(&outline);
            match filling {
                Filling::Fan(0) => {}
                Filling::Crossing => faults.crossing.push(index),
                Filling::Warped => faults.warped.push(index),
                Filling::Fan(_) | Filling::Triangles(_) => {
                    filled.get_or_insert_with(|| surface.first(index));
                }
            }
            let Some(filled) = &mut filled else { continue };
            match filling {
                Filling::Triangles(triangles) => {
                    let triangles = triangles.iter().map(|t| t.map(|k| polygon.corners[k as usize]));
                    triangles.for_each(|triangle| filled.push(triangle, polygon.labels));
                }
                Filling::Fan(start) => {
                    let (before, after) = polygon.corners.split_at(start);
                    filled.push(after.iter().chain(before).copied(), polygon.labels);
                }
                Filling::Crossing | Filling::Warped => {
                    filled.push(polygon.corners.iter().copied(), polygon.labels);
                }
            }
        }
        if let Some(filled) = filled {
            self.triangles = filled.triangles().collect();
            self.surface = Some(filled);
        }
        faults
    }
}

impl Surface {
    /// The first polygons, and all that polygons refer to.
    fn first(&self, count: usize) -> Self {
        let corners = count.checked_sub(1).map_or(0, |last| self.ends[last]);
        Self {
            corners: Vec::<Corner>::from(&self.corners[..corners]),
            ends: self.ends[..count].to_vec(),
            label: self.label[..count].to_vec(),
            labels: self.label[..count]
                .last()
                .map_or(&[][..], |last| &self.labels[..=*last as usize])
                .to_vec(),
            texture_coordinates: self.texture_coordinates.clone(),
            normal_count: self.normal_count,
            material_libraries: self.material_libraries.clone(),
        }
    }
}

/// What fills a polygon.
#[derive(Debug, PartialEq)]
enum Filling {
    /// The fan around a corner. If no triangles fill it, that around the first: what is wrong with one of its
    /// triangles is found with all others.
    Fan(usize),
    /// Triangles of its corners.
    Triangles(Vec<[u32; 3]>),
    Crossing,
    Warped,
}

impl Filling {
    fn of(outline: &[Point]) -> Self {
        let count = outline.len();
        let normal = area_vector(outline);
        let area = normal.norm();
        if count == 3 || area == 0.0 || !area.is_finite() {
            return Self::Fan(0);
        }
        let corner = |k: usize| outline[k % count];
        let fan = |start: usize| {
            fan_quality((1..count).map(|k| corner(start + k) - corner(start)), &(normal / area))
        };
        let first = fan(0);
        // Whoever repeats a corner is told so.
        if first > THIN || (0..count).any(|k| corner(k) == corner(k + 1)) {
            return Self::Fan(0);
        }
        let flat = Flat::new(outline, &(normal / area));
        if first <= 0.0 && flat.height > WARPED * area.sqrt() {
            return Self::Warped;
        }
        if first <= 0.0 && flat.crosses_itself() {
            return Self::Crossing;
        }
        let others = if count <= MOST_CORNERS { 1..count } else { 0..0 };
        let better = |best: (usize, f64), next: (usize, f64)| if next.1 > best.1 { next } else { best };
        let (start, quality) = others.map(|start| (start, fan(start))).fold((0, first), better);
        if quality > THIN || first > 0.0 {
            return Self::Fan(start);
        }
        // Where no triangles fill it, sides lie on each other.
        flat.triangles().map_or(Self::Crossing, Self::Triangles)
    }
}

/// The least ratio of twice the area of a triangle to its longest side squared in a fan, whose sides from the
/// apex these are; not above 0 if a triangle faces away from the `normal`, or the fan goes around its apex.
fn fan_quality(mut sides: impl Iterator<Item = Vector>, normal: &Vector) -> f64 {
    let Some(mut before) = sides.next() else { return 0.0 };
    let (mut least, mut angle) = (f64::INFINITY, 0.0);
    for side in sides {
        let (doubled, dot) = (before.cross(&side).dot(normal), before.dot(&side));
        let longest = before.norm_squared().max(side.norm_squared()).max((side - before).norm_squared());
        least = least.min(doubled / longest);
        angle += doubled.atan2(dot);
        before = side;
    }
    if angle < std::f64::consts::TAU { least } else { 0.0 }
}

/// Twice the area of a polygon times its mean normal [m^2] (Newell's formula; Sutherland, Sproull,
/// Schumacker, "A characterization of ten hidden-surface algorithms", Computing Surveys 6, 1974).
fn area_vector(outline: &[Point]) -> Vector {
    let fan = outline[1..].windows(2).map(|pair| (pair[0] - outline[0]).cross(&(pair[1] - outline[0])));
    fan.sum()
}

/// A polygon in its mean plane, counterclockwise.
struct Flat {
    points: Vec<[f64; 2]>,
    /// Corners that are on no straight line between their neighbors, ascending.
    turning: Vec<usize>,
    /// Largest distance of a corner from the plane [m].
    height: f64,
}

impl Flat {
    fn new(outline: &[Point], normal: &Vector) -> Self {
        let across = Vector::ith(normal.iamin(), 1.0).cross(normal).normalize();
        let along = normal.cross(&across);
        let center = outline.iter().map(|p| p.coords).sum::<Vector>() / outline.len() as f64;
        let places = || outline.iter().map(|p| p.coords - center);
        let points: Vec<[f64; 2]> = places().map(|p| [across.dot(&p), along.dot(&p)]).collect();
        let height = places().map(|p| normal.dot(&p).abs()).fold(0.0, f64::max);
        // Each is compared with the last that turns, so that many in a row are left out.
        let mut turning: Vec<usize> = Vec::new();
        for k in 0..points.len() {
            let before = turning.last().map_or(points.len() - 1, |last| *last);
            let turn = Turn::at([points[before], points[k], points[(k + 1) % points.len()]]);
            if !turn.is_straight() {
                turning.push(k);
            }
        }
        Self { points, turning, height }
    }

    /// Whether two sides cross within both.
    fn crosses_itself(&self) -> bool {
        let count = self.turning.len();
        let corner = |k: usize| self.points[self.turning[k % count]];
        let side = |k: usize| {
            let ([a, b], [c, d]) = (corner(k), corner(k + 1));
            Side { x: [a.min(c), a.max(c)], y: [b.min(d), b.max(d)], first: k }
        };
        let mut sides: Vec<Side> = (0..count).map(side).collect();
        sides.sort_by(|a, b| a.x[0].total_cmp(&b.x[0]));
        let orientation = |p, q, r| robust::orient2d(coord(p), coord(q), coord(r));
        let cross = |i: usize, j: usize| {
            let [a, b, c, d] = [corner(i), corner(i + 1), corner(j), corner(j + 1)];
            orientation(a, b, c) * orientation(a, b, d) < 0.0
                && orientation(c, d, a) * orientation(c, d, b) < 0.0
        };
        sides.iter().enumerate().any(|(place, one)| {
            let mut beside = sides[place + 1..].iter().take_while(|other| other.x[0] <= one.x[1]);
            beside.any(|other| {
                other.y[0] <= one.y[1] && one.y[0] <= other.y[1] && cross(one.first, other.first)
            })
        })
    }

    /// Triangles of the corners; none if none fill the outline.
    fn triangles(&self) -> Option<Vec<[u32; 3]>> {
        let turning: Vec<[f64; 2]> = self.turning.iter().map(|&k| self.points[k]).collect();
        let mut cut: Vec<u32> = Vec::new();
        Earcut::new().earcut_slice(&turning, &[], &mut cut);
        if cut.len() != 3 * turning.len().saturating_sub(2) {
            return None;
        }
        earcut::refine(&mut cut, &turning);
        let (triples, _) = cut.as_chunks::<3>();
        let mut triangles: Vec<[u32; 3]> =
            triples.iter().map(|t| t.map(|k| self.turning[k as usize] as u32)).collect();
        for triangle in &mut triangles {
            if self.area(triangle) < 0.0 {
                triangle.swap(1, 2);
            }
        }
        self.insert_straight(&mut triangles)?;
        let all: Vec<u32> = (0..self.points.len() as u32).collect();
        let whole: f64 = all[1..].windows(2).map(|pair| self.area(&[0, pair[0], pair[1]])).sum();
        let sum: f64 = triangles.iter().map(|t| self.area(t)).sum();
        let is_filled = (sum - whole).abs() <= FILLED * whole && triangles.iter().all(|t| self.area(t) > 0.0);
        is_filled.then_some(triangles)
    }

    /// Divides triangles at the corners on the straight sides of the outline; none if a side has no triangle.
    fn insert_straight(&self, triangles: &mut Vec<[u32; 3]>) -> Option<()> {
        let count = self.points.len();
        let edges = |t: usize, [a, b, c]: [u32; 3]| [([a, b], (t, c)), ([b, c], (t, a)), ([c, a], (t, b))];
        // The triangle at each edge, and its corner that is not on the edge.
        let mut at: HashMap<[u32; 2], (usize, u32)> =
            triangles.iter().enumerate().flat_map(|(t, &triangle)| edges(t, triangle)).collect();
        for (k, &from) in self.turning.iter().enumerate() {
            let to = self.turning[(k + 1) % self.turning.len()];
            let between = (to + count - from) % count - 1;
            if between == 0 {
                continue;
            }
            let (index, apex) = at.get(&[from as u32, to as u32]).copied()?;
            let on_side = |k: usize| ((from + k) % count) as u32;
            triangles[index] = [on_side(0), on_side(1), apex];
            triangles.extend((1..=between).map(|k| [on_side(k), on_side(k + 1), apex]));
            let last = triangles.len() - 1;
            at.extend([index, last].into_iter().flat_map(|t| edges(t, triangles[t])));
        }
        Some(())
    }

    /// Twice the area of a triangle [m^2].
    fn area(&self, triangle: &[u32; 3]) -> f64 {
        let [a, b, c] = triangle.map(|k| self.points[k as usize]);
        Turn::at([a, b, c]).cross
    }
}

/// How an outline turns from one side to the next.
struct Turn {
    /// Products of the sides [m^2].
    cross: f64,
    dot: f64,
}

impl Turn {
    fn at([a, b, c]: [[f64; 2]; 3]) -> Self {
        let (to, on) = ([b[0] - a[0], b[1] - a[1]], [c[0] - b[0], c[1] - b[1]]);
        Self { cross: to[0] * on[1] - to[1] * on[0], dot: to[0] * on[0] + to[1] * on[1] }
    }

    /// Whether it goes straight on. Where it turns back, as at the ends of a hole, it does not.
    fn is_straight(&self) -> bool {
        self.dot > 0.0 && self.cross.abs() <= STRAIGHT * self.dot
    }
}

/// A side of an outline: its range in x and in y, and the place of its first corner.
struct Side {
    x: [f64; 2],
    y: [f64; 2],
    first: usize,
}

fn coord([x, y]: [f64; 2]) -> robust::Coord<f64> {
    robust::Coord { x, y }
}
