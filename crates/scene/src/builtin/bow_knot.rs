use super::knot::{Hand, ribbons};
use crate::description::Scene;
use bowknot_geometry::{Point, Vector};

/// 71,778 vertices and 136,640 triangles, after Fig. 1 of the paper. Two ribbons of 5 cm width and 424 cm
/// length lie as the loose bow of a shoelace, nowhere nearer than 2 cm: a half knot of their standing ends,
/// and above it a half knot of opposite sense of two bights, which makes a reef knot with two loops. Within
/// 3.5 s the standing ends are drawn apart, the free ends down and outward, and the loops to where they stand
/// upright, a quarter turn about their axis, 48 cm from the knot. No gravity.
pub(super) fn scene(scale: f64) -> Scene {
    let infinity = f64::INFINITY;
    let knot = Vector::new(0.0, -0.02, 0.0);
    // Each hand goes to its distance from the knot; what is left for the knot itself is 22 cm of a ribbon
    // between the standing end and the loop, 12 cm between the loop and the free end.
    let to = |direction: [f64; 3], distance: f64, from: [f64; 3]| {
        knot + Vector::from(direction).normalize() * distance - Vector::from(from)
    };
    let everywhere = [-infinity; 3];
    let standing = Hand::new(
        everywhere,
        [-0.59, -0.1, infinity],
        to([-1.0, -0.08, 0.0], STANDING, [-0.6096, -0.1693, 0.0]),
        TIME,
    );
    let free = Hand::new(
        [0.45, -infinity, -infinity],
        [infinity, -0.345, infinity],
        to([0.6, -0.8, 0.05], FREE, [0.5359, -0.3659, 0.071]),
        TIME,
    );
    let (axis, tip) = ([-0.92, 0.39, 0.0], [-0.6452, 0.2594, 0.023]);
    let looped = Hand {
        turn: 90.0,
        axis: Vector::from(axis),
        center: Point::from(tip),
        ..Hand::new([-infinity, 0.1, -infinity], [-0.6, infinity, infinity], to(axis, LOOP, tip), TIME)
    };
    super::knot::scene(ribbons(&curve(), WIDTH, 0.00248 / scale), &[standing, looped, free], 420)
}

/// Width of the ribbons [m].
const WIDTH: f64 = 0.05;
/// Time of pulling [s].
const TIME: f64 = 3.5;
/// Distances from the knot at the end: of the standing ends, the loops' tips and the free ends [m].
const STANDING: f64 = 1.785;
const LOOP: f64 = 0.48;
const FREE: f64 = 1.15;

/// The left ribbon.
pub(super) fn curve() -> Vec<[f64; 6]> {
    CURVE.to_vec()
}

/// From the standing end at the left through the lower half knot to the right, up, through the upper half
/// knot to the left, around the loop, back beside itself, and down to the free end at the right, as a
/// `Curve`. Made like that of the reef knot; the strip is true to its flat shape within 3 %, 0.4 % in the
/// mean square.
const CURVE: [[f64; 6]; 64] = [
    [-609.6, -169.3, 0.2, 764.0, 549.0, -338.0],
    [-544.0, -151.1, 4.7, -223.0, 591.0, -776.0],
    [-472.4, -142.5, 0.3, 350.0, 650.0, -674.0],
    [-411.0, -127.3, 3.0, -351.0, 527.0, -774.0],
    [-360.4, -100.5, 15.4, -796.0, -591.0, -131.0],
    [-307.2, -69.8, 29.7, -867.0, -126.0, -483.0],
    [-221.8, -52.1, 35.1, -664.0, 495.0, -560.0],
    [-163.4, -79.0, 11.2, -213.0, 889.0, -405.0],
    [-132.5, -112.4, -21.2, 280.0, 566.0, -775.0],
    [-86.4, -147.2, -53.3, 485.0, 732.0, -479.0],
    [-25.0, -160.7, -42.8, 653.0, 566.0, -504.0],
    [58.3, -164.9, -15.6, 920.0, 273.0, -280.0],
    [106.3, -173.9, -4.7, 769.0, 68.0, -636.0],
    [180.1, -197.3, 10.1, -104.0, 107.0, -989.0],
    [248.7, -206.1, 24.2, -5.0, -374.0, -928.0],
    [288.6, -163.8, 22.6, -67.0, -22.0, -998.0],
    [299.8, -93.5, 26.2, -519.0, 122.0, -846.0],
    [296.6, -17.8, 41.1, -854.0, 412.0, -317.0],
    [291.6, 66.6, 63.8, -989.0, 2.0, 146.0],
    [287.9, 135.2, 72.4, -774.0, -148.0, 616.0],
    [266.0, 185.8, 50.1, -642.0, 447.0, 623.0],
    [222.4, 180.3, 16.5, -858.0, -494.0, -143.0],
    [169.6, 138.0, -36.9, 116.0, -155.0, 981.0],
    [129.2, 115.5, -72.4, 521.0, -471.0, 712.0],
    [68.6, 107.3, -89.1, 506.0, -823.0, 258.0],
    [-24.8, 99.6, -89.1, 537.0, -829.0, -153.0],
    [-96.7, 92.2, -81.3, 680.0, -559.0, -474.0],
    [-151.9, 78.8, -58.8, 47.0, -694.0, -719.0],
    [-198.7, 54.3, -23.0, -216.0, -836.0, -504.0],
    [-257.9, 43.8, -2.9, -246.0, -546.0, -801.0],
    [-327.2, 64.8, -8.0, 132.0, -789.0, -600.0],
    [-377.8, 102.7, -34.7, -88.0, -864.0, -496.0],
    [-415.0, 138.1, -63.9, 399.0, -900.0, 175.0],
    [-459.9, 175.2, -91.6, 268.0, -954.0, -137.0],
    [-518.5, 211.0, -105.3, -304.0, -872.0, -384.0],
    [-584.6, 240.5, -91.1, -775.0, -631.0, 0.0],
    [-637.0, 257.3, -40.4, -534.0, -660.0, 529.0],
    [-652.0, 260.7, 34.0, -30.0, -954.0, 299.0],
    [-622.8, 256.3, 99.8, -200.0, -956.0, -216.0],
    [-570.5, 248.3, 137.1, -544.0, -839.0, -6.0],
    [-499.1, 233.2, 152.7, -390.0, -878.0, 277.0],
    [-420.1, 209.9, 150.4, -530.0, -699.0, 481.0],
    [-362.8, 181.8, 129.2, -513.0, -365.0, 777.0],
    [-328.7, 147.0, 95.4, -364.0, 131.0, 922.0],
    [-304.1, 111.8, 62.6, 53.0, -528.0, 847.0],
    [-261.4, 82.2, 30.7, 228.0, -348.0, 909.0],
    [-180.4, 88.6, 5.7, -161.0, -688.0, 708.0],
    [-123.6, 109.1, 3.2, 463.0, -723.0, 513.0],
    [-63.5, 130.2, 1.9, 982.0, -187.0, 15.0],
    [13.1, 150.7, -19.5, 634.0, -755.0, -168.0],
    [70.7, 167.5, -39.5, -389.0, -915.0, -103.0],
    [124.4, 175.9, -31.1, -8.0, -831.0, -556.0],
    [160.0, 166.9, 16.7, -218.0, -868.0, -446.0],
    [198.8, 156.9, 87.9, -507.0, -858.0, -86.0],
    [237.7, 144.6, 118.6, -661.0, -694.0, 286.0],
    [316.0, 99.0, 137.5, -942.0, 172.0, 288.0],
    [366.8, 50.8, 134.4, -309.0, -218.0, 926.0],
    [378.2, -4.7, 112.4, -480.0, -145.0, 865.0],
    [388.0, -70.3, 83.3, -661.0, -150.0, 735.0],
    [413.1, -128.1, 72.0, -739.0, -433.0, 516.0],
    [453.8, -182.3, 83.4, -855.0, -84.0, 512.0],
    [489.3, -231.8, 91.6, -811.0, 145.0, 566.0],
    [516.9, -289.6, 88.4, -594.0, -42.0, 804.0],
    [535.9, -365.9, 71.0, -515.0, -506.0, 692.0],
];
