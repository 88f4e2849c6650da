use super::knot::{Hand, ribbons};
use crate::description::Scene;
use bowknot_geometry::Vector;

/// 36,432 vertices and 69,468 triangles, after Fig. 1 of the paper. Two ribbons of 4 cm width and 155 cm
/// length lie as a loose reef knot, 80 cm long and 37 cm wide, nowhere nearer than 2 cm; their four ends are
/// drawn out by 35.5 cm each within 2.4 s, which ties it to a size of about 3 cm, and held. No gravity.
pub(super) fn scene(scale: f64) -> Scene {
    let infinity = f64::INFINITY;
    let ends = Hand::new(
        [-infinity, -infinity, -infinity],
        [-0.39, infinity, infinity],
        Vector::new(-0.355, 0.0, 0.0),
        2.4,
    );
    super::knot::scene(ribbons(&curve(), WIDTH, 0.00187 / scale), &[ends], 280)
}

/// Width of the ribbons [m].
const WIDTH: f64 = 0.04;

/// The left ribbon: in from the left, over and under the right ribbon to the bight, and back by the mirror
/// image.
pub(super) fn curve() -> Vec<[f64; 6]> {
    let mirrored = HALF.iter().rev().skip(1).map(|&[x, y, z, a, b, c]| [x, -y, z, a, -b, c]);
    HALF.into_iter().chain(mirrored).collect()
}

/// The half from the upper end to the middle of the bight, as a `Curve`. It began as sines with the crossings
/// over, under, over, and was then relaxed: a flat strip kept clear of its neighbor, bent as little as can
/// be; the strip is true to its flat shape within 0.2 %.
const HALF: [[f64; 6]; 16] = [
    [-400.1, 50.3, -0.3, -82.0, 443.0, 893.0],
    [-352.8, 47.1, 5.2, -45.0, 420.0, 906.0],
    [-301.4, 45.1, 10.4, -70.0, 420.0, 905.0],
    [-249.2, 49.4, 12.7, 21.0, 472.0, 881.0],
    [-199.5, 63.5, 9.7, 68.0, 536.0, 842.0],
    [-154.6, 86.4, 1.3, 82.0, 630.0, 772.0],
    [-113.9, 113.8, -10.6, -15.0, 660.0, 751.0],
    [-72.2, 141.6, -22.7, -235.0, 574.0, 784.0],
    [-24.6, 165.0, -30.0, -137.0, 634.0, 761.0],
    [27.2, 177.3, -27.7, -11.0, 523.0, 852.0],
    [79.1, 175.2, -16.6, -182.0, 387.0, 904.0],
    [128.0, 158.9, 0.2, -368.0, 338.0, 866.0],
    [170.3, 130.7, 19.0, -378.0, 245.0, 893.0],
    [202.8, 93.7, 36.1, -286.0, -46.0, 957.0],
    [223.6, 49.7, 48.7, -370.0, -310.0, 876.0],
    [231.0, 0.0, 53.7, -626.0, 0.0, 780.0],
];
