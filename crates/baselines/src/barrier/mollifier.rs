//! The factor by which the barrier between two edges fades as they become parallel (Li et al. 2020), where
//! the distance has no gradient.

use bowknot_twoway::geometry::{Point, Vector};
use nalgebra::{Matrix3, SMatrix, SVector};

/// Share of the product of both squared rest lengths below which |u x v|^2 counts as nearly parallel.
const THRESHOLD: f64 = 1e-3;

/// m(c) = c/e (2 - c/e) for c = |u x v|^2 below e, else 1, with u and v along the edges.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mollifier {
    /// m [1].
    pub value: f64,
    /// dm/dc [1/m^4].
    pub slope: f64,
    /// d^2m/dc^2 [1/m^8].
    pub curvature: f64,
}

impl Mollifier {
    /// A factor of 1, that of all other pairs.
    pub const NONE: Self = Self { value: 1.0, slope: 0.0, curvature: 0.0 };

    /// That of two edges at `x` with these ends at rest.
    pub fn of_edges(x: &[Point; 4], rest: &[Point; 4]) -> Self {
        let [u, v] = along(rest);
        let threshold = THRESHOLD * u.norm_squared() * v.norm_squared();
        let [u, v] = along(x);
        let share = u.cross(&v).norm_squared() / threshold;
        if share >= 1.0 {
            return Self::NONE;
        }
        Self {
            value: share * (2.0 - share),
            slope: 2.0 * (1.0 - share) / threshold,
            curvature: -2.0 / (threshold * threshold),
        }
    }

    /// Whether the factor depends on positions.
    pub fn fades(&self) -> bool {
        self.slope != 0.0
    }
}

/// Gradient of c, over the four ends.
pub fn gradient(x: &[Point; 4]) -> SVector<f64, 12> {
    let [u, v] = along(x);
    let dot = u.dot(&v);
    let by_u = 2.0 * (v.norm_squared() * u - dot * v);
    let by_v = 2.0 * (u.norm_squared() * v - dot * u);
    let mut gradient = SVector::<f64, 12>::zeros();
    for (k, part) in [-by_u, by_u, -by_v, by_v].iter().enumerate() {
        gradient.fixed_rows_mut::<3>(3 * k).copy_from(part);
    }
    gradient
}

/// Second derivatives of c.
pub fn hessian(x: &[Point; 4]) -> SMatrix<f64, 12, 12> {
    let [u, v] = along(x);
    let identity = Matrix3::identity();
    let by_u_u = 2.0 * (v.norm_squared() * identity - v * v.transpose());
    let by_v_v = 2.0 * (u.norm_squared() * identity - u * u.transpose());
    let by_u_v = 2.0 * (2.0 * u * v.transpose() - v * u.transpose() - u.dot(&v) * identity);
    let mut hessian = SMatrix::<f64, 12, 12>::zeros();
    for i in 0..4 {
        for j in 0..4 {
            let block = match (i / 2, j / 2) {
                (0, 0) => by_u_u,
                (1, 1) => by_v_v,
                (0, _) => by_u_v,
                _ => by_u_v.transpose(),
            };
            let sign = if i % 2 == j % 2 { 1.0 } else { -1.0 };
            hessian.fixed_view_mut::<3, 3>(3 * i, 3 * j).copy_from(&(sign * block));
        }
    }
    hessian
}

/// u and v.
fn along(x: &[Point; 4]) -> [Vector; 2] {
    [x[1] - x[0], x[3] - x[2]]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn edges(turn: f64) -> [Point; 4] {
        let p = Point::new;
        [p(0.0, 0.1, 0.1), p(1.0, 0.2, 0.1), p(0.2, 0.0, 0.0), p(1.3, 0.11 + turn, 0.02)]
    }

    #[test]
    fn derivatives_are_those_of_the_value() {
        let (x, h) = (edges(0.02), 1e-5);
        let c = |x: &[Point; 4]| along(x)[0].cross(&along(x)[1]).norm_squared();
        let (gradient_here, hessian_here) = (gradient(&x), hessian(&x));
        for k in 0..12 {
            let moved = |sign: f64| {
                let mut moved = x;
                moved[k / 3][k % 3] += sign * h;
                moved
            };
            let slope = (c(&moved(1.0)) - c(&moved(-1.0))) / (2.0 * h);
            assert!((gradient_here[k] - slope).abs() < 1e-8, "{k}: {slope}");
            let column = (gradient(&moved(1.0)) - gradient(&moved(-1.0))) / (2.0 * h);
            assert!((hessian_here.column(k) - column).amax() < 1e-8, "{k}: {column}");
        }
    }

    #[test]
    fn it_rises_from_0_between_parallel_edges_to_1_without_a_kink() {
        let rest = edges(0.0);
        let p = Point::new;
        let turned = |angle: f64| {
            let (sine, cosine) = angle.sin_cos();
            [p(0.0, 0.0, 0.1), p(1.0, 0.0, 0.1), p(0.0, 0.0, 0.0), p(cosine, sine, 0.0)]
        };
        let at = |angle: f64| Mollifier::of_edges(&turned(angle), &rest);
        assert_eq!(at(0.0).value, 0.0);
        assert_eq!(at(0.5), Mollifier::NONE);
        // c = sine^2 reaches the threshold where sine is its root.
        let [u, v] = along(&rest);
        let end = (THRESHOLD * u.norm_squared() * v.norm_squared()).sqrt().asin();
        let near = at(end * (1.0 - 1e-6));
        assert!((near.value - 1.0).abs() < 1e-9 && near.slope * THRESHOLD < 1e-5 && near.fades());
        assert!((at(0.5 * end).value - 0.25 * 1.75).abs() < 1e-3, "{:?}", at(0.5 * end));
    }
}
