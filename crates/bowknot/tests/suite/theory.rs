//! Shapes and periods that textbooks give: a catenary, a strip of cloth that overhangs, a pendulum.

use super::scene;
use bowknot::Simulator;
use std::f64::consts::PI;

fn ran(text: &str, steps: usize) -> Simulator {
    let mut simulator = Simulator::new(&scene(text)).unwrap_or_else(|error| panic!("{error}"));
    for _ in 0..steps {
        simulator.step().unwrap_or_else(|error| panic!("{error}"));
    }
    simulator
}

/// The root of an increasing function between two places.
fn root(f: impl Fn(f64) -> f64, mut low: f64, mut high: f64) -> f64 {
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        *if f(middle) < 0.0 { &mut low } else { &mut high } = middle;
    }
    0.5 * (low + high)
}

/// A thread of length S between two points at the same height, 2 a apart, sags by c (cosh(a/c) - 1), with S = 2 c
/// sinh(a/c) (Bernoulli, Huygens and Leibniz, 1691).
#[test]
fn a_thread_hangs_as_a_catenary() {
    let text = "[solver.sleep]\nenabled = false\n[simulation]\ndt = 0.02\nair_drag = 5.0\n\
                [[body]]\nname = \"thread\"\nkind = \"strands\"\n\
                shape = { type = \"strands\", count = 1, length = 0.4, segments = 80 }\n\
                material = { base = \"yarn\", bend_stiffness = 0.0 }\n[[pin]]\nbody = \"thread\"\nroots = 1\n\
                [[pin]]\nbody = \"thread\"\nroots = 1\nroot_end = \"last\"\n\
                motion = { keyframes = [{ time = 0.0 }, { time = 1.0, translate = [0.3, 0, 0.4] }] }\n";
    let simulator = ran(text, 300);
    let x = simulator.positions();
    let lowest = x.iter().map(|x| x.z).fold(f64::INFINITY, f64::min);
    let (half, length) = (0.15, 0.4);
    // Shorter the larger c is.
    let c = root(|c| length - 2.0 * c * (half / c).sinh(), 0.01, 10.0);
    let expected = c * ((half / c).cosh() - 1.0);
    let sag = x[0].z - lowest;
    assert!((sag - expected).abs() < 0.005 * expected, "{sag} instead of {expected} m");
}

/// The angle below the horizontal at which the tip of a strip is seen from its clamp: B theta'' = -w (l - s) cos(theta)
/// with theta(0) = 0 and theta'(l) = 0, for B = 1 and l = 1 (Peirce, "The 'handle' of cloth as a measurable quantity", 1930,
/// from which cloth has its bending length).
fn overhang(weight: f64) -> f64 {
    let shoot = |curvature: f64| {
        let steps = 2000;
        let h = 1.0 / f64::from(steps);
        let (mut theta, mut bend, mut x, mut z) = (0.0_f64, curvature, 0.0, 0.0);
        for k in 0..steps {
            // The midpoint rule.
            let s = f64::from(k) * h;
            let (middle, middle_bend) =
                (theta + 0.5 * h * bend, bend - 0.5 * h * weight * (1.0 - s) * theta.cos());
            x += h * middle.cos();
            z += h * middle.sin();
            bend -= h * weight * (1.0 - s - 0.5 * h) * middle.cos();
            theta += h * middle_bend;
        }
        (bend, z.atan2(x))
    };
    shoot(root(|curvature| shoot(curvature).0, 0.0, 10.0)).1
}

#[test]
fn a_strip_of_cloth_overhangs_by_its_bending_length() {
    // Peirce: 41.5 degrees where the overhang is twice the bending length, (B/w)^(1/3).
    assert!((overhang(8.0).to_degrees() - 41.5).abs() < 1.0, "{}", overhang(8.0).to_degrees());
    let (bending, density): (f64, f64) = (2e-6, 0.15);
    let edge = 0.001;
    // Edges of which both ends are held clamp the strip in their middle.
    let length = 0.024 + 0.5 * edge;
    let text = format!(
        "[solver.sleep]\nenabled = false\n[simulation]\ndt = 0.01\nair_drag = 10.0\n\
         [[body]]\nname = \"strip\"\nshape = {{ type = \"sheet\", size = [0.028, 0.008], edge = {edge} }}\n\
         material = {{ density = {density}, stretch_stiffness = 300.0, bend_stiffness = {bending:?}, \
         poisson_ratio = 0.25 }}\nstretch_limit = inf\n\
         [[pin]]\nbody = \"strip\"\nbox = {{ min = [-1, -1, -1], max = [-0.00999, 1, 1] }}\n"
    );
    let simulator = ran(&text, 250);
    let tip = simulator.positions().iter().min_by(|a, b| a.z.total_cmp(&b.z)).expect("a tip");
    let clamp = -0.01 - 0.5 * edge;
    let found = (-tip.z).atan2(tip.x - clamp).to_degrees();
    let expected = overhang(density * 9.81 * length.powi(3) / bending).to_degrees();
    assert!((found - expected).abs() < 0.03 * expected, "{found} instead of {expected} degrees");
}

/// A stiff rod that hangs from a hinge swings with the period 2 pi sqrt(I/(M g l/2)) (1 + theta^2/16) at the amplitude theta;
/// n edges with masses at their ends have I = M l^2 (1/3 + 1/(6 n^2)).
#[test]
fn a_rod_swings_with_the_period_of_a_pendulum() {
    let (length, edges, amplitude): (f64, f64, f64) = (0.3, 10.0, 5.0_f64.to_radians());
    let text = "[solver.sleep]\nenabled = false\n[simulation]\ndt = 0.004\nintegrator = \"sdirk2\"\n\
                [[body]]\nname = \"rod\"\nkind = \"strands\"\nmaterial = \"straw\"\nrotate = [0, 5, 0]\n\
                shape = { type = \"strands\", count = 1, length = 0.3, segments = 10 }\n\
                [[pin]]\nbody = \"rod\"\nroots = 1\n";
    let mut simulator = ran(text, 0);
    let mut tips = vec![simulator.positions()[10].x - simulator.positions()[0].x];
    for _ in 0..700 {
        simulator.step().unwrap_or_else(|error| panic!("{error}"));
        tips.push(simulator.positions()[10].x - simulator.positions()[0].x);
    }
    let crossings: Vec<f64> = (1..tips.len())
        .filter(|&k| tips[k - 1] < 0.0 && tips[k] >= 0.0)
        .map(|k| k as f64 - tips[k] / (tips[k] - tips[k - 1]))
        .collect();
    let period = 0.004 * (crossings[crossings.len() - 1] - crossings[0]) / (crossings.len() - 1) as f64;
    let inertia = length * length * (1.0 / 3.0 + 1.0 / (6.0 * edges * edges));
    let expected = 2.0 * PI * (inertia / (9.81 * 0.5 * length)).sqrt() * (1.0 + amplitude * amplitude / 16.0);
    assert!((period - expected).abs() < 0.002 * expected, "{period} instead of {expected} s");
    // It keeps its energy: the amplitude after three swings.
    let last = tips[400..].iter().copied().fold(0.0, f64::max) / length;
    assert!((last - amplitude.sin()).abs() < 0.01 * amplitude, "{last}");
}
