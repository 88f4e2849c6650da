//! A strip along a curve.

use super::mesh::{TriangleMesh, segments};
use super::sheet::cut;
use bowknot_errors::counted;
use bowknot_errors::{Checks, Parameters};
use bowknot_geometry::{Point, Vector};
use serde::{Deserialize, Serialize};

/// A strip of constant width along a smooth center-line, such as a ribbon that is to be tied. The center-line
/// is the uniform cubic B-spline of `points`, which starts and ends at the first and last of them and rounds
/// the others; rows of vertices cross it at equal distances along the curve, at right angles.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Ribbon {
    /// Control points of the center-line [m], two at least. Default: from (-0.5, 0, 0) to (0.5, 0, 0).
    pub points: Vec<Point>,
    /// Directions across the strip at the control points [1], of any length but zero, blended like the points
    /// and then made orthogonal to the curve. Empty: the first row lies level and the others follow without
    /// turning about the curve (Wang et al. 2008, "Computation of Rotation Minimizing Frames"). Default
    /// empty.
    pub across: Vec<Vector>,
    /// Width [m]. Default 0.05.
    pub width: f64,
    /// Length of the edges [m], rounded so that whole numbers fit. Default 0.01.
    pub edge: f64,
}

impl Default for Ribbon {
    fn default() -> Self {
        Self {
            points: vec![Point::new(-0.5, 0.0, 0.0), Point::new(0.5, 0.0, 0.0)],
            across: Vec::new(),
            width: 0.05,
            edge: 0.01,
        }
    }
}

/// Samples of each span of the spline from which arc length is tabulated.
const SAMPLES: usize = 64;

impl Ribbon {
    /// The mesh: vertices row by row from the first control point.
    pub fn mesh(&self) -> TriangleMesh {
        let (parameters, length) = self.rows();
        let tangents: Vec<Vector> = parameters.iter().map(|&u| self.tangent(u)).collect();
        let centers: Vec<Point> = parameters.iter().map(|&u| self.center(u)).collect();
        let across = if self.across.is_empty() {
            rotation_minimizing(&centers, &tangents)
        } else {
            let control = |k: usize| self.across[k];
            let blended = |(&u, t): (&f64, &Vector)| orthogonal(blend(control, self.spans(), u, &BASIS), t);
            parameters.iter().zip(&tangents).map(blended).collect()
        };
        let (along, wide) = (segments(length, self.edge), segments(self.width, self.edge));
        let mut mesh = TriangleMesh::default();
        for (center, across) in centers.iter().zip(&across) {
            for i in 0..=wide {
                let s = self.width * (f64::from(i) / f64::from(wide) - 0.5);
                mesh.positions.push(center + across * s);
            }
        }
        let vertex = |i: u32, j: u32| j * (wide + 1) + i;
        for j in 0..along {
            for i in 0..wide {
                let corners = [vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)];
                mesh.triangles.extend(cut(corners, (i + j) % 2 == 1));
            }
        }
        mesh
    }

    /// Length of the center-line [m].
    pub fn length(&self) -> f64 {
        self.arc_lengths().last().copied().unwrap_or(0.0)
    }

    fn spans(&self) -> usize {
        self.points.len().saturating_sub(1)
    }

    fn center(&self, u: f64) -> Point {
        Point::from(blend(|k| self.points[k].coords, self.spans(), u, &BASIS))
    }

    fn tangent(&self, u: f64) -> Vector {
        let slope = blend(|k| self.points[k].coords, self.spans(), u, &SLOPE);
        slope.try_normalize(0.0).unwrap_or_else(Vector::x)
    }

    /// Length of the curve [m] up to each sample.
    fn arc_lengths(&self) -> Vec<f64> {
        let mut lengths = vec![0.0];
        let mut last = self.center(0.0);
        let mut sum = 0.0;
        for k in 1..=self.spans() * SAMPLES {
            let next = self.center(k as f64 / SAMPLES as f64);
            sum += (next - last).norm();
            lengths.push(sum);
            last = next;
        }
        lengths
    }

    /// Spline parameters of rows at equal distances along the curve, and its length [m].
    fn rows(&self) -> (Vec<f64>, f64) {
        let lengths = self.arc_lengths();
        let total = lengths.last().copied().unwrap_or(0.0);
        let along = segments(total, self.edge);
        let row = |j: u32| {
            let s = total * f64::from(j) / f64::from(along);
            let k = lengths.partition_point(|l| *l < s).clamp(1, lengths.len() - 1);
            let (low, high) = (lengths[k - 1], lengths[k]);
            let part = if high > low { ((s - low) / (high - low)).clamp(0.0, 1.0) } else { 0.0 };
            ((k - 1) as f64 + part) / SAMPLES as f64
        };
        ((0..=along).map(row).collect(), total)
    }
}

impl Parameters for Ribbon {
    fn check(&self, checks: &mut Checks) {
        let n = self.points.len();
        if n < 2 {
            checks.refuse("points", counted(n, "point", "points"), "must be at least two");
        }
        if let Some(index) = self.points.iter().position(|p| !p.iter().all(|c| c.is_finite())) {
            checks.refuse("points", format!("point {index}"), "must be finite");
        }
        if let Some(index) = self.points.windows(2).position(|w| w[0] == w[1]) {
            checks.refuse("points", format!("points {index} and {}", index + 1), "must not be the same");
        }
        if !(self.across.is_empty() || self.across.len() == n) {
            let given = format!(
                "{} for {}",
                counted(self.across.len(), "direction", "directions"),
                counted(n, "point", "points")
            );
            checks.refuse("across", given, "must be one for each point, or none");
        }
        let usable = |v: &Vector| v.iter().all(|c| c.is_finite()) && v.norm() > 0.0;
        if let Some(index) = self.across.iter().position(|v| !usable(v)) {
            checks.refuse("across", format!("direction {index}"), "must be finite and not zero");
        }
    }
}

/// Weights of four neighboring control points at a place in their middle span.
type Weights = fn(f64) -> [f64; 4];

const BASIS: Weights = |t| {
    let s = 1.0 - t;
    [
        s * s * s / 6.0,
        (3.0 * t * t * t - 6.0 * t * t + 4.0) / 6.0,
        (3.0 * s * s * s - 6.0 * s * s + 4.0) / 6.0,
        t * t * t / 6.0,
    ]
};

const SLOPE: Weights = |t| {
    let s = 1.0 - t;
    [-0.5 * s * s, 1.5 * t * t - 2.0 * t, 2.0 * s - 1.5 * s * s, 0.5 * t * t]
};

/// Blends the control vectors 0 to `last` at the spline parameter `u` from 0 to `last`. Beyond the ends stand
/// the mirror images of the second ones, which makes the curve start and end at its first and last control
/// point.
fn blend(control: impl Fn(usize) -> Vector, last: usize, u: f64, weights: &Weights) -> Vector {
    let span = (u.floor() as usize).min(last.saturating_sub(1));
    let at = |k: usize| match k.checked_sub(1) {
        None => control(0) * 2.0 - control(1.min(last)),
        Some(k) if k > last => control(last) * 2.0 - control(last.saturating_sub(1)),
        Some(k) => control(k),
    };
    let w = weights(u - span as f64);
    (0..4).map(|k| at(span + k) * w[k]).sum()
}

/// The part of `v` at right angles to the unit vector `t`, normalized; any such direction if there is none.
fn orthogonal(v: Vector, t: &Vector) -> Vector {
    let part = |v: Vector| (v - t * t.dot(&v)).try_normalize(1e-9 * v.norm());
    let other = if t.z.abs() < 0.9 { Vector::z() } else { Vector::x() };
    part(v).or_else(|| part(other)).unwrap_or_else(Vector::y)
}

/// Directions across a curve that turn about it as little as can be: double reflection, from row to row.
fn rotation_minimizing(centers: &[Point], tangents: &[Vector]) -> Vec<Vector> {
    let Some(first) = tangents.first() else { return Vec::new() };
    let mut across = vec![orthogonal(Vector::z().cross(first), first)];
    for j in 1..centers.len() {
        let reflect = |v: Vector, n: &Vector| {
            let square = n.norm_squared();
            if square > 0.0 { v - n * (2.0 * n.dot(&v) / square) } else { v }
        };
        let step = centers[j] - centers[j - 1];
        let (side, tangent) = (reflect(across[j - 1], &step), reflect(tangents[j - 1], &step));
        across.push(orthogonal(reflect(side, &(tangents[j] - tangent)), &tangents[j]));
    }
    across
}
