//! The barriers as functions of one distance.

/// Smallest gap as a share of the range; a smaller gap counts as this one.
const MIN_SHARE: f64 = 1e-18;

/// Value and derivatives of a barrier. Units are those of a function of gaps.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Jet {
    /// B [J].
    pub value: f64,
    /// dB/ds [N]; at most 0.
    pub slope: f64,
    /// d^2B/ds^2 [N/m]; at least 0.
    pub curvature: f64,
}

/// Eq. 8 of the paper: B(s) = -k (s - r)^2 ln(s/r) for a gap s [m] below the range r [m], 0 above; k is the
/// strength [kg/s^2].
///
/// With u = s/r: B = -k r^2 (u-1)^2 ln u, B' = -k r (u-1) [2 ln u + (u-1)/u], B'' = -k [2 ln u + 4 (u-1)/u -
/// ((u-1)/u)^2]. It is convex: ln u and (u-1)/u are negative below the range, so every term of B'' is at
/// least 0.
pub fn barrier(strength: f64, gap: f64, range: f64) -> Jet {
    if gap >= range {
        return Jet::default();
    }
    let u = (gap / range).max(MIN_SHARE);
    let (log, below, ratio) = (u.ln(), u - 1.0, (u - 1.0) / u);
    Jet {
        value: -strength * range * range * below * below * log,
        slope: -strength * range * below * (2.0 * log + ratio),
        curvature: -strength * (2.0 * log + 4.0 * ratio - ratio * ratio),
    }
}

/// The barrier of IPC (Li et al. 2020): B(d) = -k (D - R)^2 ln(D/R) with D = d^2 - xi^2 and R = r^2 - xi^2,
/// for a distance d and a range r that both include the minimum separation xi [m] (Li et al. 2021); k in
/// kg/(m^2 s^2). It is [`barrier`] of D, derived by d.
pub fn squared_barrier(stiffness: f64, distance: f64, range: f64, min_separation: f64) -> Jet {
    let thickness = min_separation * min_separation;
    let of_square = barrier(stiffness, distance * distance - thickness, range * range - thickness);
    Jet {
        value: of_square.value,
        slope: 2.0 * distance * of_square.slope,
        curvature: 4.0 * distance * distance * of_square.curvature + 2.0 * of_square.slope,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn derivatives_are_those_of_the_value() {
        for share in [1e-4, 0.01, 0.1, 0.5, 0.9, 0.999] {
            let (k, r) = (20.0, 0.002);
            let s = share * r;
            let h = 1e-5 * s;
            let at = |s| barrier(k, s, r);
            let slope = (at(s + h).value - at(s - h).value) / (2.0 * h);
            let curvature = (at(s + h).slope - at(s - h).slope) / (2.0 * h);
            let scale = k * r;
            assert!((at(s).slope - slope).abs() < 1e-7 * (slope.abs() + scale), "{share}: {slope}");
            assert!(
                (at(s).curvature - curvature).abs() < 1e-6 * (curvature.abs() + k),
                "{share}: {curvature}"
            );
            assert!(at(s).value > 0.0 && at(s).slope < 0.0 && at(s).curvature > 0.0);
        }
    }

    #[test]
    fn derivatives_by_the_distance_are_those_of_the_value() {
        let (k, r) = (2e7, 0.002);
        for (share, xi) in [(1e-4, 0.0), (0.1, 0.0), (0.6, 0.0), (0.97, 0.0), (0.3, 0.0005), (0.9, 0.0005)] {
            let d = share * r;
            let h = 1e-5 * (d - xi);
            let at = |d| squared_barrier(k, d, r, xi);
            let slope = (at(d + h).value - at(d - h).value) / (2.0 * h);
            let curvature = (at(d + h).slope - at(d - h).slope) / (2.0 * h);
            assert!((at(d).slope - slope).abs() < 1e-7 * (slope.abs() + k * r * r * r), "{share}: {slope}");
            assert!((at(d).curvature - curvature).abs() < 1e-6 * (curvature.abs() + k * r * r), "{share}");
            let [square, range] = [d * d - xi * xi, r * r - xi * xi];
            let expected = -k * (square - range).powi(2) * (square / range).ln();
            assert!((at(d).value / expected - 1.0).abs() < 1e-12, "{share}");
            assert!(at(d).slope < 0.0 && at(d).curvature > 0.0, "{share}");
        }
        assert_eq!(squared_barrier(k, r, r, 0.0).value, 0.0);
    }

    #[test]
    fn it_is_what_equation_8_says_and_ends_at_its_range() {
        let (k, d, dist) = (20.0, 1e-3, 0.4e-3_f64);
        let expected = k * (dist - d) * (dist - d) * f64::max(-(dist / d).ln(), 0.0);
        assert!((barrier(k, dist, d).value / expected - 1.0).abs() < 1e-14);
        assert_eq!(barrier(k, d, d), Jet::default());
        assert_eq!(barrier(k, 1.0, d), Jet::default());
    }

    #[test]
    fn a_gap_of_nothing_pushes_without_overflow() {
        let jet = barrier(20.0, 0.0, 1e-3);
        assert!(jet.value.is_finite() && jet.slope.is_finite() && jet.curvature.is_finite());
        assert_eq!(jet, barrier(20.0, -1.0, 1e-3));
    }
}
