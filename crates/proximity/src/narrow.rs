//! Contact geometry of many pairs of one kind at once.
//!
//! The arithmetic is that of `bowknot_geometry`'s distances and separations, operation by operation, without
//! branches over [`BATCH`] pairs side by side, so that it compiles to vector instructions. Pairs that need a
//! branch there (nearly parallel edges, a slab much narrower than the distance, differences beyond [1e-60,
//! 1e60] m) are marked and left to [`bowknot_geometry::separation::separate`]. The derivation in that module
//! certifies a width whatever the closest points, and it holds here because the operations are the same.

use crate::min_max::{larger, smaller};
use crate::pair_test::{EdgeEdge, PairTest, VertexEdge, VertexTriangle, VertexVertex};
use crate::pairs::Pair;
use bowknot_geometry::{CollisionModel, PairKind, Point, Separation, Vector, separation};

/// Pairs that are computed side by side.
const BATCH: usize = 8;

/// Bound of the rounding error of a width per largest coordinate difference, see
/// `bowknot_geometry::separation`.
const WIDTH_ROUNDING: f64 = 10.0 * f64::EPSILON;

/// If the width is below this part of the distance, other directions are tried.
const MIN_WIDTH_RATIO: f64 = 0.9;

/// Fills a list of separations before they are written.
pub const BLANK: Separation =
    Separation { normal: Vector::new(0.0, 0.0, 0.0), weights: [0.0; 4], distance: 0.0, width: 0.0 };

/// Contact geometry of pairs of one kind at `positions` [m].
///
/// # Panics
/// If the model does not have a pair's vertices or half-space.
pub fn separate_all(
    model: &CollisionModel,
    kind: PairKind,
    pairs: &[Pair],
    positions: &[Point],
    separations: &mut [Separation],
) {
    match kind {
        PairKind::VertexHalfSpace => {
            for (separation, pair) in separations.iter_mut().zip(pairs) {
                let [vertex, half_space] = pair.elements.map(|element| element as usize);
                *separation =
                    separation::separate_half_space(&positions[vertex], &model.half_spaces()[half_space]);
            }
        }
        PairKind::VertexVertex => separate_kind::<VertexVertex, 1, 1>(pairs, positions, separations),
        PairKind::VertexEdge => separate_kind::<VertexEdge, 1, 2>(pairs, positions, separations),
        PairKind::VertexTriangle => separate_kind::<VertexTriangle, 1, 3>(pairs, positions, separations),
        PairKind::EdgeEdge => separate_kind::<EdgeEdge, 2, 2>(pairs, positions, separations),
    }
}

/// Contact geometry of one pair, with the same bits as among many.
///
/// # Panics
/// As [`separate_all`].
pub fn separate_one(model: &CollisionModel, kind: PairKind, pair: &Pair, positions: &[Point]) -> Separation {
    let mut separation = [BLANK];
    separate_all(model, kind, std::slice::from_ref(pair), positions, &mut separation);
    separation[0]
}

type V3 = [f64; 3];

/// Weights and offset of the closest points, and whether they can be trusted.
#[derive(Clone, Copy)]
pub struct Nearest {
    weights: [f64; 4],
    offset: V3,
    trusted: bool,
}

/// The closest points of one kind of pair, in `f64`.
pub trait ClosestPoints {
    /// Closest points, as `bowknot_geometry::distance` finds them.
    fn nearest(points: &[V3; 4]) -> Nearest;
}

#[derive(Clone, Copy)]
struct Lanes<const N: usize>([[f64; BATCH]; N]);

#[multiversion::multiversion(targets(
    "x86_64+avx512f+avx512bw+avx512cd+avx512dq+avx512vl+avx2+bmi1+bmi2+lzcnt+popcnt",
    "x86_64+avx2+bmi1+bmi2+lzcnt+popcnt",
))]
fn separate_kind<K: PairTest<A, B> + ClosestPoints, const A: usize, const B: usize>(
    pairs: &[Pair],
    positions: &[Point],
    separations: &mut [Separation],
) {
    let mut points = [[[0.0; BATCH]; 3]; 4];
    let mut normal = Lanes([[0.0; BATCH]; 3]);
    let mut weights = Lanes([[0.0; BATCH]; 4]);
    let mut measures = Lanes([[0.0; BATCH]; 2]);
    let mut trusted = [0_u8; BATCH];
    for (pairs, separations) in pairs.chunks(BATCH).zip(separations.chunks_mut(BATCH)) {
        for (lane, pair) in pairs.iter().enumerate() {
            for j in 0..A + B {
                let p = &positions[pair.vertices[j] as usize];
                points[j][0][lane] = p.x;
                points[j][1][lane] = p.y;
                points[j][2][lane] = p.z;
            }
        }
        for lane in 0..BATCH {
            let mut at = [[0.0; 3]; 4];
            for j in 0..A + B {
                for k in 0..3 {
                    at[j][k] = points[j][k][lane];
                }
            }
            let nearest = K::nearest(&at);
            let squared = dot(nearest.offset, nearest.offset);
            let distance = squared.sqrt();
            let inverse = 1.0 / distance;
            let n = [nearest.offset[0] * inverse, nearest.offset[1] * inverse, nearest.offset[2] * inverse];
            let mut width = f64::INFINITY;
            let mut scale = 0.0;
            for i in 0..A {
                for j in A..A + B {
                    let difference = sub(at[i], at[j]);
                    width = smaller(dot(n, difference), width);
                    for x in difference {
                        scale = larger(x.abs(), scale);
                    }
                }
            }
            width -= WIDTH_ROUNDING * scale;
            let certain = (width >= MIN_WIDTH_RATIO * distance) & (squared > 1e-120) & (scale < 1e60);
            trusted[lane] = u8::from(certain & nearest.trusted);
            for k in 0..3 {
                normal.0[k][lane] = n[k];
            }
            for j in 0..4 {
                weights.0[j][lane] = nearest.weights[j];
            }
            measures.0[0][lane] = distance;
            measures.0[1][lane] = width;
        }
        let mut any_untrusted = false;
        for (lane, separation) in separations.iter_mut().enumerate() {
            // Field by field: a value assembled on the stack would be read by wider loads than the stores
            // that wrote it, which stalls.
            for k in 0..3 {
                separation.normal[k] = normal.0[k][lane];
            }
            for j in 0..4 {
                separation.weights[j] = weights.0[j][lane];
            }
            separation.distance = measures.0[0][lane];
            separation.width = measures.0[1][lane];
            any_untrusted |= trusted[lane] == 0;
        }
        if any_untrusted {
            for (lane, (pair, separation)) in pairs.iter().zip(separations).enumerate() {
                if trusted[lane] == 0 {
                    *separation = separate_scalar(K::KIND, pair, positions);
                }
            }
        }
    }
}

#[cold]
#[inline(never)]
fn separate_scalar(kind: PairKind, pair: &Pair, positions: &[Point]) -> Separation {
    separation::separate(kind, &pair.vertices.map(|v| positions[v as usize]))
}

impl ClosestPoints for VertexVertex {
    #[inline(always)]
    fn nearest([a, b, ..]: &[V3; 4]) -> Nearest {
        Nearest { weights: [1.0, 1.0, 0.0, 0.0], offset: sub(*a, *b), trusted: true }
    }
}

impl ClosestPoints for VertexEdge {
    #[inline(always)]
    fn nearest([p, b0, b1, _]: &[V3; 4]) -> Nearest {
        let (t, offset) = foot(p, b0, b1);
        Nearest { weights: [1.0, 1.0 - t, t, 0.0], offset, trusted: true }
    }
}

impl ClosestPoints for VertexTriangle {
    #[inline(always)]
    fn nearest([p, b0, b1, b2]: &[V3; 4]) -> Nearest {
        let (e1, e2, r) = (sub(*b1, *b0), sub(*b2, *b0), sub(*p, *b0));
        let (e1e1, e2e2) = (dot(e1, e1), dot(e2, e2));
        let shear = dot(e1, e2) / e1e1;
        let height = along(e2, e1, shear);
        let hh = dot(height, height);
        let place = dot(r, e1) / e1e1;
        let from_line = along(r, e1, place);
        let w2 = dot(from_line, height) / hh;
        let w1 = place - shear * w2;
        let w0 = 1.0 - w1 - w2;
        let inside = (w0 > 0.0) & (w1 > 0.0) & (w2 > 0.0);
        let in_plane = along(from_line, height, w2);

        let (t01, o01) = foot(p, b0, b1);
        let (t12, o12) = foot(p, b1, b2);
        let (t20, o20) = foot(p, b2, b0);
        let mut weights = [1.0 - t01, t01, 0.0];
        let mut offset = o01;
        let mut squared = dot(o01, o01);
        let next = dot(o12, o12);
        let closer = next < squared;
        weights = select(closer, [0.0, 1.0 - t12, t12], weights);
        offset = select(closer, o12, offset);
        squared = if closer { next } else { squared };
        let next = dot(o20, o20);
        let closer = next < squared;
        weights = select(closer, [t20, 0.0, 1.0 - t20], weights);
        offset = select(closer, o20, offset);
        squared = if closer { next } else { squared };
        // In a sliver the foot in the plane is only one of the candidates.
        let plane_wins = inside & ((hh > 1e-6 * e2e2) | (dot(in_plane, in_plane) <= squared));
        let weights = select(plane_wins, [w0, w1, w2], weights);
        let offset = select(plane_wins, in_plane, offset);
        Nearest { weights: [1.0, weights[0], weights[1], weights[2]], offset, trusted: true }
    }
}

impl ClosestPoints for EdgeEdge {
    #[inline(always)]
    fn nearest([a0, a1, b0, b1]: &[V3; 4]) -> Nearest {
        let (d1, d2, r) = (sub(*a1, *a0), sub(*b1, *b0), sub(*a0, *b0));
        let (aa, bb, ab) = (dot(d1, d1), dot(d2, d2), dot(d1, d2));
        let (per_aa, per_bb, r_d2) = (1.0 / aa, 1.0 / bb, dot(r, d2));
        let across = along(d1, d2, ab * per_bb);
        let from_line = along(r, d2, r_d2 * per_bb);
        let cc = dot(across, across);
        let s = clamp_unit(-dot(from_line, across) / cc);
        let t = clamp_unit((ab * s + r_d2) * per_bb);
        let s = clamp_unit((ab * t - dot(r, d1)) * per_aa);

        let (start_of_a, start_of_b) = (s <= 0.5, t <= 0.5);
        let between = sub(select(start_of_a, *a0, *a1), select(start_of_b, *b0, *b1));
        let ds = if start_of_a { s } else { s - 1.0 };
        let dt = if start_of_b { t } else { t - 1.0 };
        let offset = along(along(between, d1, -ds), d2, dt);
        Nearest { weights: [1.0 - s, s, 1.0 - t, t], offset, trusted: cc > 1e-8 * aa }
    }
}

/// The parameter in [0, 1] of the point of an edge that is closest to p, and p minus that point, measured
/// from the nearer end.
#[inline(always)]
fn foot(p: &V3, start: &V3, end: &V3) -> (f64, V3) {
    let edge = sub(*end, *start);
    let from_start = sub(*p, *start);
    let t = clamp_unit(dot(from_start, edge) / dot(edge, edge));
    let near_start = t <= 0.5;
    let from_near = select(near_start, from_start, sub(*p, *end));
    (t, along(from_near, edge, if near_start { t } else { t - 1.0 }))
}

/// Clamps to [0, 1]; not-a-number becomes 0.
#[inline(always)]
fn clamp_unit(t: f64) -> f64 {
    smaller(larger(t, 0.0), 1.0)
}

/// p - t v.
#[inline(always)]
fn along(p: V3, v: V3, t: f64) -> V3 {
    [p[0] - v[0] * t, p[1] - v[1] * t, p[2] - v[2] * t]
}

#[inline(always)]
fn select(first: bool, a: V3, b: V3) -> V3 {
    let pick = |k: usize| if first { a[k] } else { b[k] };
    [pick(0), pick(1), pick(2)]
}

#[inline(always)]
fn sub(a: V3, b: V3) -> V3 {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

#[inline(always)]
fn dot(a: V3, b: V3) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
