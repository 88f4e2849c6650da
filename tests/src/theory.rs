//! Scenes with contacts or collisions whose outcome is known from theory, and measurements of them.
//!
//! Each function runs a scene with additional `settings`, as for `--set`, and returns the measurements.

use crate::contact::{GRAVITY, Slope, velocity};
use bowknot::geometry::{Point, Vector};
use bowknot::io::{MeshView, write_obj};
use bowknot::{Scene, Simulator, StepStatistics};
use std::f64::consts::PI;
use std::fmt::Write as _;
use std::ops::Range;
use std::path::Path;

/// A simulator of a scene that is given as text.
pub fn simulator(text: &str, folder: &Path, settings: &[String]) -> Simulator {
    let scene = Scene::from_toml(text, folder)
        .and_then(|scene| scene.with_sets(settings))
        .unwrap_or_else(|error| panic!("{error}"));
    Simulator::new(&scene).unwrap_or_else(|error| panic!("{error}"))
}

/// Mass, momenta and energy of some vertices.
#[derive(Clone, Copy, Debug)]
pub struct Motion {
    /// Mass [kg].
    pub mass: f64,
    /// Center of mass [m].
    pub center: Point,
    /// Momentum [kg m/s].
    pub momentum: Vector,
    /// Angular momentum about the origin [kg m^2/s].
    pub angular: Vector,
    /// Kinetic energy [J].
    pub kinetic: f64,
}

/// The motion of all bodies whose names begin with `prefix`.
pub fn motion(simulator: &Simulator, prefix: &str) -> Motion {
    let (masses, x, v) = (simulator.dynamics_model().masses(), simulator.positions(), simulator.velocities());
    let zero = Vector::zeros();
    let mut sum = Motion { mass: 0.0, center: Point::origin(), momentum: zero, angular: zero, kinetic: 0.0 };
    for body in &simulator.world().bodies {
        if body.kind.is_none() || !body.name.starts_with(prefix) {
            continue;
        }
        for i in body.vertices.clone().chain(body.interior.clone()).map(|i| i as usize) {
            sum.mass += masses[i];
            sum.center += x[i].coords * masses[i];
            sum.momentum += v[i] * masses[i];
            sum.angular += x[i].coords.cross(&v[i]) * masses[i];
            sum.kinetic += 0.5 * masses[i] * v[i].norm_squared();
        }
    }
    sum.center /= sum.mass;
    sum
}

fn step(simulator: &mut Simulator) -> StepStatistics {
    simulator.step().unwrap_or_else(|error| panic!("{error}"))
}

/// Two cubes that meet in free space, without gravity.
#[derive(Clone, Copy, Debug)]
pub struct Meeting {
    /// Largest change of the momentum, relative to that of one cube at the start [1].
    pub momentum: f64,
    /// Largest change of the angular momentum about the common center, relative to the momentum of one cube
    /// times its size [1].
    pub angular: f64,
    /// Largest kinetic and elastic energy of any later state, relative to that at the start [1].
    pub energy: f64,
    /// Kinetic and elastic energy at the end, relative to that at the start [1].
    pub energy_left: f64,
    /// Relative velocity along the way at the end, relative to that at the start: minus the coefficient of
    /// restitution [1].
    pub restitution: f64,
}

/// Two cubes of 8 cm that collide at 1 m/s each with friction; their centers are offset sideways by `offset`
/// [m].
pub fn meeting(offset: [f64; 2], modulus: f64, steps: usize, settings: &[String]) -> Meeting {
    let folder = tempfile::tempdir().expect("a folder");
    let cube = |name: &str, x: f64, y: f64, z: f64, speed: f64| {
        format!(
            "[[body]]\nname = \"{name}\"\nkind = \"solid\"\nfriction = 0.3\nvelocity = [{speed:?}, 0, 0]\n\
             material = {{ base = \"jelly\", young_modulus = {modulus:?}, density = 1000 }}\n\
             shape = {{ type = \"block\", size = [0.08, 0.08, 0.08], edge = 0.02 }}\n\
             translate = [{x:?}, {y:?}, {z:?}]\n"
        )
    };
    let text = format!(
        "[simulation]\ngravity = [0, 0, 0]\n[solver.sleep]\nenabled = false\n[contact]\ndelta = 1e-3\n{}{}",
        cube("left", -0.06, 0.0, 0.0, 1.0),
        cube("right", 0.06, offset[0], offset[1], -1.0)
    );
    let mut simulator = simulator(&text, folder.path(), settings);
    let start = motion(&simulator, "");
    let one = motion(&simulator, "left").momentum.norm();
    let (mut momentum, mut angular, mut energy, mut energy_left) = (0.0f64, 0.0f64, 0.0f64, 0.0);
    for _ in 0..steps {
        let statistics = step(&mut simulator);
        let now = motion(&simulator, "");
        momentum = momentum.max((now.momentum - start.momentum).norm() / one);
        angular = angular.max((now.angular - start.angular).norm() / (one * 0.08));
        energy_left = (statistics.energy.kinetic + statistics.energy.elastic) / start.kinetic;
        energy = energy.max(energy_left);
    }
    let speed = |name: &str| motion(&simulator, name).momentum.x / one;
    Meeting { momentum, angular, energy, energy_left, restitution: 0.5 * (speed("left") - speed("right")) }
}

/// A floor at z = 0.
fn floor(mesh: bool) -> &'static str {
    if mesh {
        "shape = { type = \"box\", size = [0.6, 0.6, 0.05], edge = 0.03 }\ntranslate = [0, 0, -0.025]\n"
    } else {
        "shape = \"half-space\"\n"
    }
}

/// A cube of jelly falls by 5 cm on a floor. Returns the largest horizontal velocity of its center of mass
/// [m/s] and the largest gain of energy since the start [J].
pub fn dropped_cube(
    rotate: [f64; 3],
    friction: f64,
    mesh: bool,
    steps: usize,
    settings: &[String],
) -> [f64; 2] {
    let folder = tempfile::tempdir().expect("a folder");
    let [x, y, z] = rotate;
    let text = format!(
        "[solver.sleep]\nenabled = false\n[contact]\ndelta = 1e-3\n[[body]]\nname = \"cube\"\nkind \
         = \"solid\"\nfriction = {friction:?}\n\
         material = {{ base = \"jelly\", young_modulus = 1e5, density = 1000 }}\n\
         shape = {{ type = \"block\", size = [0.08, 0.08, 0.08], edge = 0.02 }}\n\
         rotate = [{x:?}, {y:?}, {z:?}]\ntranslate = [0, 0, 0.12]\n\
         [[obstacle]]\nname = \"floor\"\nfriction = {friction:?}\n{}",
        floor(mesh)
    );
    let mut simulator = simulator(&text, folder.path(), settings);
    let start = motion(&simulator, "");
    let before = start.mass * GRAVITY * start.center.z;
    let (mut aside, mut gain) = (0.0f64, f64::NEG_INFINITY);
    for _ in 0..steps {
        let statistics = step(&mut simulator);
        let now = motion(&simulator, "");
        aside = aside.max((now.momentum.xy() / now.mass).norm());
        gain = gain.max(
            statistics.energy.kinetic + statistics.energy.elastic + statistics.energy.potential - before,
        );
    }
    [aside, gain]
}

/// A cube of 8 cm is thrown at a floor at 3 m/s without gravity. Returns its velocity away from the floor
/// after each of `steps` time steps, relative to the speed at the start [1].
pub fn thrown_cube(modulus: f64, mesh: bool, steps: usize, settings: &[String]) -> Vec<f64> {
    let folder = tempfile::tempdir().expect("a folder");
    let text = format!(
        "[simulation]\ngravity = [0, 0, 0]\n[solver.sleep]\nenabled = false\n[contact]\ndelta = \
         1e-3\n[[body]]\nname = \"cube\"\nkind = \"solid\"\n\
         velocity = [0, 0, -3]\n\
         material = {{ base = \"jelly\", young_modulus = {modulus:?}, density = 1000 }}\n\
         shape = {{ type = \"block\", size = [0.08, 0.08, 0.08], edge = 0.02 }}\ntranslate = [0, 0, 0.1]\n\
         [[obstacle]]\nname = \"floor\"\n{}",
        floor(mesh)
    );
    let mut simulator = simulator(&text, folder.path(), settings);
    let mut velocity = || {
        step(&mut simulator);
        let now = motion(&simulator, "");
        now.momentum.z / (3.0 * now.mass)
    };
    (0..steps).map(|_| velocity()).collect()
}

/// Spins a cube in free space for `steps` steps at `rate` [rad/s]. Returns the shares of its angular momentum
/// and of its energy that are lost.
pub fn spinning_cube(rate: f64, steps: usize, settings: &[String]) -> [f64; 2] {
    let folder = tempfile::tempdir().expect("a folder");
    let text = format!(
        "[simulation]\ngravity = [0, 0, 0]\n[[body]]\nname = \"cube\"\nkind = \"solid\"\n\
         angular_velocity = [0, {:?}, 0]\n\
         material = {{ base = \"jelly\", young_modulus = 1e6, density = 1000 }}\n\
         shape = {{ type = \"block\", size = [0.08, 0.08, 0.08], edge = 0.02 }}\n",
        rate.to_degrees()
    );
    let mut simulator = simulator(&text, folder.path(), settings);
    let start = motion(&simulator, "");
    let mut energy = start.kinetic;
    for _ in 0..steps {
        let statistics = step(&mut simulator);
        energy = statistics.energy.kinetic + statistics.energy.elastic;
    }
    let end = motion(&simulator, "");
    [(start.angular - end.angular).norm() / start.angular.norm(), 1.0 - energy / start.kinetic]
}

/// A ball of 5 cm on a slope of `degrees` with friction 0.5: mean acceleration down the slope over the time
/// steps of `range`, relative to the 5/7 g sin a of a ball that rolls [1].
pub fn rolling_ball(degrees: f64, edge: f64, dt: f64, range: Range<usize>, settings: &[String]) -> f64 {
    let folder = tempfile::tempdir().expect("a folder");
    let (sine, cosine) = degrees.to_radians().sin_cos();
    let text = format!(
        "[simulation]\ndt = {dt:?}\ngravity = [{:?}, 0, {:?}]\n[solver.sleep]\nenabled = \
         false\n[contact]\ndelta = 1e-3\n\
         [[body]]\nname = \"ball\"\nkind = \"solid\"\nfriction = 0.5\n\
         material = {{ base = \"rubber\", young_modulus = 1e6, density = 1000 }}\n\
         shape = {{ type = \"tet-ball\", radius = 0.05, edge = {edge:?} }}\n\
         translate = [0, 0, 0.051]\n\
         [[obstacle]]\nname = \"ground\"\nfriction = 0.5\nshape = \"half-space\"\n",
        GRAVITY * sine,
        -GRAVITY * cosine
    );
    let mut simulator = simulator(&text, folder.path(), settings);
    let mut velocities = vec![0.0];
    for _ in 0..range.end {
        step(&mut simulator);
        velocities.push(velocity(&simulator).x);
    }
    let found = (velocities[range.end] - velocities[range.start]) / (range.len() as f64 * dt);
    found / (5.0 / 7.0 * GRAVITY * sine)
}

/// A belt of cotton around a fixed cylinder through `degrees`. One end is pulled, the other is held. Returns
/// the ratio of the tensions of its straight ends, and the one by Euler and Eytelwein, exp(mu theta).
pub fn belt(degrees: f64, friction: f64, settings: &[String]) -> [f64; 2] {
    const RADIUS: f64 = 0.05;
    const EDGE: f64 = 0.005;
    const END: f64 = 0.06;
    let folder = tempfile::tempdir().expect("a folder");
    let theta = degrees.to_radians();
    // The width of the strip is along the y axis. A full turn climbs along y, so that it does not touch
    // itself.
    let radius = RADIUS + 1.05e-3;
    let climb = if degrees > 300.0 { 0.03 } else { 0.0 };
    let width = 0.015;
    let length = radius * theta + 2.0 * END;
    let (rows, columns) = ((length / EDGE).round() as usize, (width / EDGE) as usize);
    let mut positions = Vec::new();
    for row in 0..=rows {
        let s = length * row as f64 / rows as f64 - END;
        let angle = (s / radius).clamp(0.0, theta);
        let (sine, cosine) = angle.sin_cos();
        let rest = s - angle * radius;
        let (x, z) = (radius * sine + rest * cosine, radius * cosine - rest * sine);
        let lift = climb * s / length;
        for column in 0..=columns {
            positions.push(Point::new(x, width * (column as f64 / columns as f64 - 0.5) + lift, z));
        }
    }
    let at = |row: usize, column: usize| (row * (columns + 1) + column) as u32;
    write_strip(&folder.path().join("belt.obj"), &positions, rows, columns);
    let range = |row: usize| (0..=columns).map(|c| at(row, c).to_string()).collect::<Vec<_>>().join(", ");
    let drawn = (theta.cos(), -theta.sin());
    let reach = 0.02 * length;
    let text = format!(
        "[simulation]\ngravity = [0, 0, 0]\nair_drag = 5\n[solver.sleep]\nenabled = false\n[contact]\ndelta \
         = 1e-3\n\
         [[body]]\nname = \"belt\"\nmesh = \"belt.obj\"\nmaterial = {{ base = \"cotton\", poisson_ratio = \
         0.0 }}\nfriction = {friction:?}\n\
         [[pin]]\nvertices = [{}]\n[[pin]]\nvertices = [{}]\n\
         motion = {{ keyframes = [{{ time = 1.0, translate = [{:?}, 0, {:?}] }}] }}\n\
         [[obstacle]]\nname = \"cylinder\"\nfriction = {friction:?}\nrotate = [90, 0, 0]\n\
         shape = {{ type = \"lathe\", profile = [[0.02, -0.06], [{RADIUS}, -0.06], [{RADIUS}, 0.06], [0.02, \
         0.06]], edge = 0.0015 }}\n",
        range(0),
        range(rows),
        reach * drawn.0,
        reach * drawn.1,
    );
    let mut simulator = simulator(&text, folder.path(), settings);
    for _ in 0..100 {
        step(&mut simulator);
    }
    // Strain of the straight ends: the mean over a few rows.
    let x = simulator.positions();
    let strain = |first: usize, last: usize| {
        let mut sum = 0.0;
        for column in 0..=columns {
            let (a, b) = (at(first, column) as usize, at(last, column) as usize);
            let rest = (positions[b] - positions[a]).norm();
            sum += (x[b] - x[a]).norm() / rest - 1.0;
        }
        sum / (columns + 1) as f64
    };
    let straight = (END / EDGE) as usize;
    let (held, pulled) = (strain(2, straight - 2), strain(rows - straight + 2, rows - 2));
    [pulled / held, (friction * theta).exp()]
}

/// A rope over a horizontal bar. One end hangs down `share` times as far as friction can just hold. Returns
/// the speed at which the rope falls, the mean over time steps from `from` to `to` [m/s]. Its bending, EI /
/// R^2, is about 1 % of the tension at the light end.
///
/// With weight w per length, the tension T grows around a bar of radius R by at most dT/dphi = mu (T + w R
/// cos phi) - w R sin phi, where phi is the angle from the top (Euler's belt with weight).
pub fn rope(share: f64, friction: f64, (from, to): (usize, usize), settings: &[String]) -> f64 {
    const RADIUS: f64 = 0.03;
    const LIGHT: f64 = 0.12;
    const EDGE: f64 = 0.005;
    const PARTS: usize = 2000;
    let around = RADIUS + 1.1e-3;
    let part = PI / PARTS as f64;
    let heavy = (0..PARTS).fold(LIGHT, |tension, k| {
        let (sine, cosine) = (part * (k as f64 + 0.5) - 0.5 * PI).sin_cos();
        tension + part * (friction * (tension + around * cosine) - around * sine)
    });
    let length = LIGHT + PI * around + share * heavy;
    let count = (length / EDGE).round() as usize;
    let mut text = String::new();
    for k in 0..=count {
        let s = length * k as f64 / count as f64 - LIGHT;
        let angle = (s / around).clamp(0.0, PI);
        let rest = s - angle * around;
        let (sine, cosine) = angle.sin_cos();
        let z = around * sine + if angle < 1.0 { rest } else { -rest };
        let _ = writeln!(text, "v {:?} 0 {z:?}", -around * cosine);
    }
    (1..=count).for_each(|k| {
        let _ = writeln!(text, "l {k} {}", k + 1);
    });
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("rope.obj"), text).expect("writes");
    let text = format!(
        "[simulation]\nair_drag = 1\n[solver.sleep]\nenabled = false\n[contact]\ndelta = 1e-3\n\
         [[body]]\nname = \"rope\"\nkind = \"strands\"\nmesh = \"rope.obj\"\nmaterial = {{ base = \"rope\", \
         stretch_stiffness = 200, bend_stiffness = 1e-6 }}\nfriction = {friction:?}\n\
         [[obstacle]]\nname = \"bar\"\nfriction = {friction:?}\nrotate = [90, 0, 0]\n\
         shape = {{ type = \"lathe\", profile = [[0.01, -0.03], [{RADIUS}, -0.03], [{RADIUS}, 0.03], [0.01, \
         0.03]], edge = 0.0015 }}\n"
    );
    let mut simulator = simulator(&text, folder.path(), settings);
    let mut height = |steps: usize| {
        (0..steps).for_each(|_| {
            step(&mut simulator);
        });
        motion(&simulator, "rope").center.z
    };
    let before = height(from);
    (before - height(to - from)) / (0.01 * (to - from) as f64)
}

/// A sheet on a table with a rounded edge. It hangs over the edge by `pull` times the length that friction
/// can just hold. Returns how far it has slid after `steps` time steps [m].
///
/// Per width, with weight w per area, the tension T grows around an edge of radius R by at most dT/dtheta =
/// mu (T + w R cos theta) - w R sin theta, from the mu w L that the lying part of length L holds to the w H
/// of the hanging part of length H.
pub fn table_edge(pull: f64, friction: f64, steps: usize, settings: &[String]) -> f64 {
    const RADIUS: f64 = 0.03;
    const LENGTH: f64 = 0.3;
    const WIDTH: f64 = 0.03;
    const EDGE: f64 = 0.005;
    let folder = tempfile::tempdir().expect("a folder");
    let delta = 1e-3;
    let around = RADIUS + delta;
    // T at the end of the arc is an affine function of T at its start.
    let carried = |start: f64| {
        let count = 1000;
        let dt = 0.5 * PI / f64::from(count);
        (0..count).fold(start, |tension, k| {
            let (sine, cosine) = ((f64::from(k) + 0.5) * dt).sin_cos();
            let slope = |t: f64| friction * (t + around * cosine) - around * sine;
            tension + dt * slope(tension + 0.5 * dt * slope(tension))
        })
    };
    let (least, gain) = (carried(0.0), carried(1.0) - carried(0.0));
    let rest = LENGTH - 0.5 * PI * around;
    let hanging = pull * (least + gain * friction * rest) / (1.0 + pull * gain * friction);
    let lying = rest - hanging;
    let place = |s: f64, distance: f64| {
        let (turn, out) = ((s / around).clamp(0.0, 0.5 * PI), RADIUS + distance);
        let (sine, cosine) = turn.sin_cos();
        let straight = s - turn * around;
        (out * sine + straight * cosine, out * cosine - RADIUS - straight * sine)
    };
    let strip = |name: &str, stations: &[f64], distance: f64, columns: usize, width: f64| {
        let mut positions = Vec::new();
        for &s in stations {
            let (x, z) = place(s, distance);
            let across = (0..=columns).map(|c| width * (c as f64 / columns as f64 - 0.5));
            positions.extend(across.map(|y| Point::new(x, y, z)));
        }
        write_strip(&folder.path().join(name), &positions, stations.len() - 1, columns);
        positions
    };
    let rows = (LENGTH / EDGE).round() as usize;
    let stations: Vec<f64> = (0..=rows).map(|row| LENGTH * row as f64 / rows as f64 - lying).collect();
    let columns = (WIDTH / EDGE).round() as usize;
    // Where contacts carry load: between the contact distance and the reach of their forces.
    let start = strip("sheet.obj", &stations, 1.1 * delta, columns, WIDTH);
    let end = 0.5 * PI * around;
    let table: Vec<f64> = (0..=8)
        .map(|k| -0.4 + 0.05 * f64::from(k))
        .chain((1..16).map(|k| end * f64::from(k) / 16.0))
        .chain((0..=8).map(|k| end + 0.05 * f64::from(k)))
        .collect();
    strip("table.obj", &table, 0.0, 2, 0.1);
    let text = format!(
        "[simulation]\nair_drag = 2\n[solver.sleep]\nenabled = false\n[contact]\ndelta = {delta:?}\n\
         [[body]]\nname = \"sheet\"\nmesh = \"sheet.obj\"\nfriction = {friction:?}\n\
         [[obstacle]]\nname = \"table\"\nmesh = \"table.obj\"\nfriction = {friction:?}\n"
    );
    let mut simulator = simulator(&text, folder.path(), settings);
    for _ in 0..steps {
        step(&mut simulator);
    }
    // The lying end.
    let moved = (0..=columns).map(|c| simulator.positions()[c].x - start[c].x);
    moved.sum::<f64>() / (columns + 1) as f64
}

/// Writes a strip of `rows` by `columns` quadrangles, cut into triangles, with vertices row by row.
fn write_strip(path: &Path, positions: &[Point], rows: usize, columns: usize) {
    let at = |row: usize, column: usize| (row * (columns + 1) + column) as u32;
    let mut triangles = Vec::new();
    for row in 0..rows {
        for column in 0..columns {
            let [a, b, c, d] =
                [at(row, column), at(row, column + 1), at(row + 1, column + 1), at(row + 1, column)];
            let even = (row + column) % 2 == 0;
            triangles.extend(if even { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] });
        }
    }
    let view = MeshView { positions, triangles: &triangles, ..MeshView::default() };
    write_obj(path, &view).unwrap_or_else(|error| panic!("{error}"));
}

/// Slides a body over a level ground from `slope.speed` until it stops. Returns its way relative to v^2 / (2
/// mu g) less v dt / 2 [1]: implicit Euler has no motion at the speed of the start.
pub fn stopping_distance(slope: &Slope) -> f64 {
    let theory = slope.speed * slope.speed / (2.0 * slope.friction * GRAVITY);
    let steps = (1.3 * slope.speed / (slope.friction * GRAVITY) / slope.dt).ceil() as usize;
    slope.run(steps).way()[0] / (theory - 0.5 * slope.speed * slope.dt)
}
