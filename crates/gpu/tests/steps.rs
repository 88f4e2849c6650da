//! Steps toward random targets, by twins and by a device: nothing ever intersects, and both agree.
#![allow(clippy::unwrap_used)] // helpers of tests are outside the functions that the lint knows as tests

use bowknot_check::{Judge, PathOptions, StateOptions};
use bowknot_geometry::{BodyFilter, CollisionModel, HalfSpace, PairKind, Point, Topology, Vector};
use bowknot_gpu::{
    Adapter, Call, Candidate, Collision, CollisionError, ComparingEngine, Constraints, DeviceEngine, Engine,
    GpuError, Kind, Lengths, NONE, Phase, PhaseSeconds, Settings, Stop, TwinEngine,
};
use bowknot_proximity::{PairList, ProximitySearch};

const EDGE: f64 = 0.02;
const MIN_SEPARATION: f64 = 1e-4;
const MARGIN: f64 = 2e-3;
const DELTA: f64 = 1e-3;
const STRETCH: f64 = 1.1;

/// A scene with everything that collides: two sheets, an obstacle, strands, particles, the ground.
struct Scene {
    model: CollisionModel,
    x: Vec<Point>,
    /// Local edge length of all vertices.
    edge: f64,
}

fn scene() -> Scene {
    let (mut x, mut triangles, mut strands, mut bodies) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    let n = 9usize;
    for (body, height) in [0.03, 0.033, 0.027].into_iter().enumerate() {
        let first = x.len() as u32;
        for k in 0..n * n {
            let warp = 1e-4 * ((k * 37 % 11) as f64 - 5.0);
            x.push(Point::new((k % n) as f64 * EDGE, (k / n) as f64 * EDGE, height + warp));
        }
        for k in (0..n * n - n).filter(|k| k % n != n - 1) {
            let [a, b, c, d] = [k, k + 1, k + n + 1, k + n].map(|v| first + v as u32);
            triangles.extend([[a, b, c], [a, c, d]]);
        }
        bodies.resize(x.len(), body as u32);
    }
    for strand in 0..3 {
        let first = x.len() as u32;
        let y = 0.03 + 0.04 * f64::from(strand);
        x.extend((0..8).map(|k| Point::new(0.01 + EDGE * f64::from(k), y, 0.036 + 1e-4 * f64::from(strand))));
        strands.extend((first..first + 7).map(|v| [v, v + 1]));
    }
    bodies.resize(x.len(), 3);
    let first = x.len() as u32;
    for k in 0..27 {
        let place = [k % 3, k / 3 % 3, k / 9].map(f64::from);
        x.push(Point::new(0.05 + 0.003 * place[0], 0.068 + 0.003 * place[1], 0.039 + 0.003 * place[2]));
    }
    bodies.resize(x.len(), 4);
    let topology = Topology::builder(x.len())
        .triangles(triangles)
        .strand_edges(strands)
        .particles((first..x.len() as u32).collect::<Vec<_>>())
        .build()
        .unwrap();
    let mut filters = vec![BodyFilter::DEFORMABLE; 5];
    filters[2] = BodyFilter::OBSTACLE;
    let ground = HalfSpace::new(Point::origin(), Vector::new(0.1, 0.0, 1.0)).unwrap();
    let model = CollisionModel::new(topology, bodies, filters, vec![ground]).unwrap();
    let x = x.into_iter().map(|p| p + Vector::new(3.0, -2.0, 0.05) - Vector::new(0.0, 0.0, 0.3)).collect();
    Scene { model, x, edge: EDGE }
}

fn collision<E: Engine>(engine: E, scene: &Scene, constraints: &Constraints<'_>) -> Collision<E> {
    try_collision(engine, scene, constraints).unwrap()
}

fn try_collision<E: Engine>(
    engine: E,
    scene: &Scene,
    constraints: &Constraints<'_>,
) -> Result<Collision<E>, CollisionError> {
    with_settings(engine, scene, constraints, &Settings::default())
}

fn with_settings<E: Engine>(
    engine: E,
    scene: &Scene,
    constraints: &Constraints<'_>,
    settings: &Settings,
) -> Result<Collision<E>, CollisionError> {
    let count = scene.x.len();
    let edges = &scene.model.topology().edges;
    let length = |[a, b]: [u32; 2]| (scene.x[a as usize] - scene.x[b as usize]).norm();
    let lengths = Lengths {
        edges: &vec![scene.edge; count],
        margins: &vec![MARGIN; count],
        deltas: &vec![DELTA; count],
        half_space_deltas: &[],
        thicknesses: &[],
        half_space_thicknesses: &[],
        min_separation: MIN_SEPARATION,
        edge_limits: &edges.iter().map(|edge| STRETCH * length(*edge)).collect::<Vec<f64>>(),
    };
    Collision::new(engine, &scene.model, &scene.x, &scene.x, &lengths, constraints, settings)
}

fn device() -> DeviceEngine {
    let adapter = Adapter::choose(None).unwrap_or_else(|error| panic!("{error}"));
    DeviceEngine::open(&adapter).unwrap()
}

/// Targets that fold the sheets through each other, the obstacle, the strands and the ground.
fn target(scene: &Scene, random: &mut fastrand::Rng) -> Vec<Point> {
    let body = scene.model.vertex_body();
    let wave = 20.0 + 60.0 * random.f64();
    let shift = Vector::new(random.f64() - 0.5, random.f64() - 0.5, random.f64() - 0.5) * 0.2;
    let target = |(v, x): (usize, &Point)| {
        let bent = Vector::new(0.0, 0.0, 0.05 * (wave * x.x).sin() * (wave * x.y).cos());
        match body[v] {
            2 => x + shift * 0.2,
            k => x + bent + if k % 2 == 0 { shift } else { -shift },
        }
    };
    scene.x.iter().enumerate().map(target).collect()
}

fn assert_no_intersections(scene: &Scene, x: &[Point], what: &str) {
    let judge = Judge::from_model(&scene.model);
    let report = judge.check_state(x, &StateOptions { limit: 1, distance: true }).unwrap();
    assert_eq!(report.intersection_count, 0, "{what}: {report:?}");
}

#[test]
fn nothing_intersects_on_the_way_to_random_targets() {
    let mut random = fastrand::Rng::with_seed(5);
    let mut hindered = false;
    for round in 0..4 {
        let mut scene = scene();
        let mut collision = collision(TwinEngine::new(), &scene, &Constraints::default());
        for _ in 0..3 {
            let target = target(&scene, &mut random);
            collision.begin(&Call::toward(&target)).unwrap();
            for step in 0..20 {
                let report = collision.step().unwrap();
                let before = std::mem::replace(&mut scene.x, collision.positions().unwrap());
                assert_no_intersections(&scene, &scene.x, &format!("round {round} step {step}"));
                let judge = Judge::from_model(&scene.model);
                let path = judge.check_path(&before, &scene.x, &PathOptions::default()).unwrap();
                assert!(path.is_clear(), "round {round} step {step}: {path:?}");
                assert_eq!(report.frozen, 0, "{report:?}");
                hindered |= report.pressing > 20;
            }
        }
    }
    assert!(hindered, "contacts must press");
}

/// Trust regions and boxes are integers of 32 bits too: radii up to an edge length, and margins.
#[test]
fn the_grid_has_room_for_edges_and_margins_that_are_larger_than_the_scene() {
    for scale in [1.0, 1e-3, 1e-6] {
        let mut scene = scene();
        scene.x.iter_mut().for_each(|x| *x = Point::from(scale * x.coords));
        let collision = collision(TwinEngine::new(), &scene, &Constraints::default());
        let half = collision.grid().quantum() * f64::from(1 << 29);
        assert!(half >= 4.0 * EDGE.max(MARGIN), "{scale}: {half}");
    }
}

/// Checks that all pairs within contact range at `x` are among the candidates; counts them by kind.
fn assert_complete(scene: &Scene, x: &[Point], candidates: &[Candidate]) -> [usize; 5] {
    let (mut pairs, mut separations) = (PairList::default(), Vec::new());
    let radii = vec![MARGIN; x.len()];
    let mut search = ProximitySearch::new(&scene.model);
    search.search(&scene.model, x, &radii, &mut pairs, &mut separations);
    let mut kinds = [0; 5];
    for kind in PairKind::ALL {
        let here = match kind {
            PairKind::VertexVertex => Kind::VertexVertex,
            PairKind::VertexEdge => Kind::VertexEdge,
            PairKind::VertexTriangle => Kind::VertexTriangle,
            PairKind::EdgeEdge => Kind::EdgeEdge,
            PairKind::VertexHalfSpace => Kind::VertexHalfSpace,
        };
        for pair in &pairs.pairs()[pairs.range(kind)] {
            let [a, b] = pair.elements;
            kinds[here as usize] += 1;
            assert!(candidates.binary_search(&Candidate::new(here, a, b)).is_ok(), "{kind:?} {a} {b}");
        }
    }
    kinds
}

#[test]
fn every_pair_within_range_before_and_after_a_step_is_a_candidate() {
    let scene = scene();
    let mut collision = collision(TwinEngine::new(), &scene, &Constraints::default());
    let mut target = target(&scene, &mut fastrand::Rng::with_seed(3));
    // Down to the ground.
    target.iter_mut().for_each(|y| y.z -= 0.1);
    // Nothing has been searched for.
    assert_eq!(collision.end().unwrap().near, None);
    collision.begin(&Call::toward(&target)).unwrap();
    assert_eq!(collision.end().unwrap().near, None);
    let (mut x, mut kinds, mut most_near) = (scene.x.clone(), [0; 5], 0);
    for _ in 0..20 {
        let report = collision.step().unwrap();
        let candidates = collision.candidates().unwrap();
        assert_eq!(candidates.len(), report.candidates);
        assert!(candidates.windows(2).all(|two| two[0] != two[1]), "no pair twice");
        let after = collision.positions().unwrap();
        for x in [&x, &after] {
            let found = assert_complete(&scene, x, &candidates);
            (0..5).for_each(|k| kinds[k] += found[k]);
        }
        // Of the candidates, these are listed at the end of a call, and few others.
        let near = collision.end().unwrap().near.unwrap();
        assert!(near.iter().all(|pair| candidates.binary_search(pair).is_ok()), "a candidate each");
        let in_range: usize = assert_complete(&scene, &after, &near).iter().sum();
        assert!(near.len() <= in_range + in_range / 8 + 4, "{} of {in_range}", near.len());
        most_near = most_near.max(near.len());
        x = after;
    }
    assert!(kinds.iter().all(|count| *count > 0) && most_near > 400, "{kinds:?}, {most_near}");
    collision.place(&x).unwrap();
    assert_eq!(collision.end().unwrap().near, None);
}

/// However often the host looks at the end of a call, later steps have the same bits.
#[test]
fn steps_after_an_end_are_those_without_it() {
    let run = |looks: bool| {
        let scene = scene();
        let mut collision = collision(TwinEngine::new(), &scene, &Constraints::default());
        collision.begin(&Call::toward(&target(&scene, &mut fastrand::Rng::with_seed(9)))).unwrap();
        let step = |_| {
            let report = collision.step().unwrap();
            if looks {
                collision.end().unwrap();
            }
            report
        };
        let reports: Vec<_> = (0..8).map(step).collect();
        (reports, collision.end().unwrap())
    };
    assert!(run(false) == run(true));
}

/// With all contact rows in one bucket, and in many.
#[test]
fn every_kernel_computes_what_its_twin_does() {
    for bucket_vertices in [1000, 4] {
        let mut random = fastrand::Rng::with_seed(6);
        let mut scene = scene();
        let engine = ComparingEngine::new(device());
        let settings = Settings { bucket_vertices, ..Settings::default() };
        let mut collision = with_settings(engine, &scene, &Constraints::default(), &settings).unwrap();
        for _ in 0..2 {
            collision.begin(&Call::toward(&target(&scene, &mut random))).unwrap();
            for step in 0..3 {
                collision.steps(1 + step % 2 * 2).unwrap();
                scene.x = collision.end().unwrap().positions;
                assert_no_intersections(&scene, &scene.x, &format!("step {step}"));
            }
        }
        let (words, differences) = (collision.engine().words_compared(), collision.engine().differences());
        println!("{words} words, {} of which differ", differences.len());
        // Where a number is compared with a threshold, rounding may decide.
        assert!(
            differences.len() < 50,
            "{} of {words} words differ, first {:?}",
            differences.len(),
            &differences[..differences.len().min(5)]
        );
    }
}

/// Triangles that lie apart, with a particle under each.
fn scattered(count: usize) -> Scene {
    let (mut x, mut triangles) = (Vec::new(), Vec::new());
    for k in 0..count {
        let corner = Vector::new(2.0 * (k % 20) as f64, 2.0 * (k / 20) as f64, 0.0) * EDGE;
        let at = |x: f64, y: f64| Point::from(corner + Vector::new(x, y, 0.0) * EDGE);
        let first = x.len() as u32;
        x.extend([at(0.0, 0.0), at(1.0, 0.0), at(0.0, 1.0)]);
        triangles.push([first, first + 1, first + 2]);
    }
    let first = x.len() as u32;
    let under = |k: usize| x[3 * k] + Vector::new(0.3 * EDGE, 0.3 * EDGE, -1.2 * DELTA);
    let particles: Vec<Point> = (0..count).map(under).collect();
    x.extend(particles);
    let topology = Topology::builder(x.len())
        .triangles(triangles)
        .particles((first..x.len() as u32).collect::<Vec<_>>())
        .build()
        .unwrap();
    Scene { model: CollisionModel::single_body(topology), x, edge: EDGE }
}

/// A workgroup keeps the rows of a bucket if they are no more than its threads and have no more vertices than its table has
/// slots (sweep_rows.wgsl): buckets on both sides of both limits.
#[test]
fn sweeps_of_rows_that_a_workgroup_keeps_and_of_others_are_those_of_the_twin() {
    for count in [100, 128, 150, 256, 300] {
        let scene = scattered(count);
        let engine = ComparingEngine::new(device());
        let settings = Settings { bucket_vertices: 10_000, ..Settings::default() };
        let mut collision = with_settings(engine, &scene, &Constraints::default(), &settings).unwrap();
        let particles = 3 * count;
        let up = |(v, x): (usize, &Point)| x + Vector::z() * if v < particles { -0.3 } else { 0.5 } * EDGE;
        let target: Vec<Point> = scene.x.iter().enumerate().map(up).collect();
        collision.begin(&Call::toward(&target)).unwrap();
        for step in 0..3 {
            let report = collision.steps(1).unwrap()[0];
            // In the first step nothing presses yet.
            assert!(step == 0 || report.pressing == count, "{count}, step {step}: {report:?}");
        }
        let differences = collision.engine().differences();
        assert!(differences.is_empty(), "{count}: {:?}", &differences[..differences.len().min(3)]);
        let x = collision.positions().unwrap();
        assert_no_intersections(&scene, &x, "the end");
    }
}

#[test]
fn a_device_agrees_with_the_twins_as_long_as_rounding_decides_nothing() {
    let scene = scene();
    let target = target(&scene, &mut fastrand::Rng::with_seed(6));
    let mut twin = collision(TwinEngine::new(), &scene, &Constraints::default());
    let mut device = collision(device(), &scene, &Constraints::default());
    twin.begin(&Call::toward(&target)).unwrap();
    device.begin(&Call::toward(&target)).unwrap();
    // Rounding of displacements of 0.2 m, which 8 sweeps and the next step amplify.
    for tolerance in [2e-8, 2e-7] {
        let reports = (twin.step().unwrap(), device.step().unwrap());
        let (x, y) = (twin.positions().unwrap(), device.positions().unwrap());
        let worst = x.iter().zip(&y).map(|(x, y)| (x - y).amax()).fold(0.0, f64::max);
        assert!(worst <= tolerance, "{worst:e} m, {reports:?}");
        assert_eq!(twin.candidates().unwrap(), device.candidates().unwrap());
    }
}

/// Two bodies of one kind that meet, with friction, and nothing else: what a scene lacks has no buffers.
#[test]
fn scenes_of_one_kind_of_body_run_on_a_device() {
    let corner = [(0.0, 0.0), (EDGE, 0.0), (0.0, EDGE)];
    let at = |z: f64| corner.map(|(x, y)| Point::new(x, y, z));
    let x = [at(0.0), at(0.5 * EDGE)].concat();
    let target = [at(0.5 * EDGE), at(0.0)].concat();
    let ground = HalfSpace::new(Point::new(0.0, 0.0, -0.1 * EDGE), Vector::z()).unwrap();
    let mut pressed = Vec::new();
    for (what, planes) in [(0, vec![]), (1, vec![]), (2, vec![]), (2, vec![ground])] {
        let builder = Topology::builder(6);
        let builder = match what {
            0 => builder.triangles([[0, 1, 2], [3, 4, 5]]),
            1 => builder.strand_edges([[0, 1], [1, 2], [3, 4], [4, 5]]),
            _ => builder.particles([0, 1, 2, 3, 4, 5]),
        };
        let model = CollisionModel::new(
            builder.build().unwrap(),
            vec![0, 0, 0, 1, 1, 1],
            vec![BodyFilter::DEFORMABLE; 2],
            planes.clone(),
        );
        let scene = Scene { model: model.unwrap(), x: x.clone(), edge: EDGE };
        let constraints = Constraints {
            frictions: &[0.3; 6],
            half_space_frictions: &vec![0.3; planes.len()],
            ..Constraints::default()
        };
        let mut collision = collision(ComparingEngine::new(device()), &scene, &constraints);
        collision.begin(&Call::toward(&target)).unwrap();
        let last = (0..12).map(|_| collision.step().unwrap()).last().unwrap();
        pressed.push(last.pressing > 0);
        assert_eq!(collision.engine().differences(), []);
        assert_no_intersections(&scene, &collision.positions().unwrap(), &format!("{what}"));
    }
    assert_eq!(pressed, [true; 4]);
}

/// Triangles of a sheet of n x n vertices, the first of which has that number.
fn sheet_triangles(n: u32, first: u32) -> impl Iterator<Item = [u32; 3]> {
    let corners = (0..n * (n - 1)).filter(move |k| k % n != n - 1).map(move |k| first + k);
    corners.flat_map(move |k| [[k, k + 1, k + n + 1], [k, k + n + 1, k + n]])
}

/// Root mean square of the distances of points.
fn distance(x: &[Point], y: &[Point]) -> f64 {
    let squares: f64 = x.iter().zip(y).map(|(x, y)| (x - y).norm_squared()).sum();
    (squares / x.len() as f64).sqrt()
}

/// A sheet of n x n vertices that hangs from a row of vertices that do not move; which these are, and targets so far
/// below.
fn hanging_sheet(n: u32, depth: f64) -> (Scene, Vec<bool>, Vec<Point>) {
    let x: Vec<Point> =
        (0..n * n).map(|k| Point::new(EDGE * f64::from(k % n), 0.0, -EDGE * f64::from(k / n))).collect();
    let topology = Topology::builder(x.len()).triangles(sheet_triangles(n, 0)).build().unwrap();
    let pinned: Vec<bool> = (0..n * n).map(|k| k < n).collect();
    let below = |(x, pinned): (&Point, &bool)| if *pinned { *x } else { x - depth * Vector::z() };
    let target = x.iter().zip(&pinned).map(below).collect();
    (Scene { model: CollisionModel::single_body(topology), x, edge: EDGE }, pinned, target)
}

#[test]
fn edges_stay_below_their_limits() {
    let n = 9;
    let (scene, pinned, target) = hanging_sheet(n, 1.0);
    let x = scene.x.clone();
    let constraints = Constraints { prescribed: &pinned, ..Constraints::default() };
    let mut collision = collision(TwinEngine::new(), &scene, &constraints);
    collision.begin(&Call::toward(&target)).unwrap();
    (0..60).for_each(|_| {
        collision.step().unwrap();
    });
    let end = collision.positions().unwrap();
    let stretch = |[a, b]: &[u32; 2]| {
        let length = |x: &[Point]| (x[*a as usize] - x[*b as usize]).norm();
        length(&end) / length(&x)
    };
    let worst = scene.model.topology().edges.iter().map(stretch).fold(0.0, f64::max);
    let lowest = end.iter().map(|x| x.z).fold(f64::INFINITY, f64::min);
    let hanging = f64::from(n - 1) * EDGE * STRETCH;
    assert!(worst < 1.02 * STRETCH, "{worst}");
    assert!(lowest < -0.99 * hanging && lowest > -1.02 * hanging, "{lowest} {hanging}");
}

#[test]
fn phases_of_steps_are_measured_between_time_stamps() {
    let scene = scene();
    let mut random = fastrand::Rng::with_seed(5);
    let target = target(&scene, &mut random);
    let mut twins = collision(TwinEngine::new(), &scene, &Constraints::default());
    assert_eq!(twins.take_phase_seconds(), None);
    let mut collision = collision(device(), &scene, &Constraints::default());
    collision.take_phase_seconds();
    let timer = std::time::Instant::now();
    collision.begin(&Call::toward(&target)).expect("a call");
    for _ in 0..3 {
        collision.step().expect("a step");
    }
    let most = timer.elapsed().as_secs_f64();
    if !collision.engine().has_time_stamps() {
        assert_eq!(collision.take_phase_seconds(), None);
        return;
    }
    let seconds = collision.take_phase_seconds().expect("time stamps");
    assert!(Phase::ALL.iter().all(|phase| seconds.of(*phase) > 0.0), "{seconds:?}");
    assert!(seconds.total() <= most, "{seconds:?} in {most} s");
    assert_eq!(collision.take_phase_seconds(), Some(PhaseSeconds::default()));
}

/// However many steps are submitted together, with many buckets of contact rows. Some of them end their submission: a
/// rule is met.
#[test]
fn two_runs_on_one_device_have_the_same_bits() {
    let stop = Stop {
        distance: EDGE,
        unhindered: EDGE,
        net_residual: f64::INFINITY,
        mean_residual: f64::INFINITY,
        stretch_to_limit: f64::INFINITY,
        finishing_steps: 0,
    };
    let run = |most: usize| {
        let scene = scene();
        let settings = Settings { bucket_vertices: 4, ..Settings::default() };
        let mut collision = with_settings(device(), &scene, &Constraints::default(), &settings).unwrap();
        let target = target(&scene, &mut fastrand::Rng::with_seed(8));
        collision.begin(&Call { stop, ..Call::toward(&target) }).unwrap();
        let (mut reports, mut halted) = (Vec::new(), 0);
        while reports.len() < 16 {
            let wanted = most.min(16 - reports.len());
            let made = collision.steps(wanted).unwrap();
            halted += usize::from(made.len() < wanted);
            reports.extend(made);
        }
        (reports, collision.end().unwrap(), halted)
    };
    let [(reports, end, _), again, (together, together_end, halted)] = [1, 1, 5].map(run);
    assert_eq!((&reports, &end), (&again.0, &again.1));
    assert_eq!((&reports, &end), (&together, &together_end));
    assert!(halted > 0);
}

/// The table of `docs/gpu/collisions.md`: how far the aim of a first step is from that after many sweeps.
#[test]
#[ignore = "it prints a table"]
fn errors_by_number_of_sweeps() {
    const MANY: usize = 3000;
    let folded = scene();
    let folded_target = target(&folded, &mut fastrand::Rng::with_seed(6));
    let [small, large] = [(12, 1.0), (40, EDGE)].map(|(n, depth)| hanging_sheet(n, depth));
    for (name, scene, pinned, target) in [
        ("144 vertices, 1 m below", &small.0, &small.1[..], &small.2),
        ("1600 vertices, an edge below", &large.0, &large.1[..], &large.2),
        ("everything", &folded, &[][..], &folded_target),
    ] {
        let aims = |sweeps: usize, cluster_sweeps: usize, coarse_correction: bool| {
            let settings = Settings {
                cluster_sweeps,
                sweeps,
                polish_sweeps: sweeps,
                coarse_correction,
                ..Settings::default()
            };
            let constraints = Constraints { prescribed: pinned, ..Constraints::default() };
            let mut collision = with_settings(TwinEngine::new(), scene, &constraints, &settings).unwrap();
            collision.begin(&Call::toward(target)).unwrap();
            collision.step().unwrap();
            collision.end().unwrap().aims
        };
        let solved = aims(MANY, 1, true);
        for (cluster_sweeps, coarse_correction) in
            [1, 2, 3, 4].into_iter().flat_map(|s| [(s, false), (s, true)])
        {
            let errors = [2, 4, 5, 8, 16, 32].map(|sweeps| {
                let aims = aims(sweeps, cluster_sweeps, coarse_correction);
                format!("{:.3}", distance(&aims, &solved) / EDGE)
            });
            println!("| {name} | {cluster_sweeps} | {coarse_correction} | {} |", errors.join(" | "));
        }
    }
}

/// The table of `docs/gpu/collisions.md`: how far the aim of a first step is from that after many sweeps, with contact rows in one
/// bucket and in many.
#[test]
#[ignore = "it prints a table"]
fn errors_by_buckets_of_contact_rows() {
    const MANY: usize = 3000;
    for (name, (scene, target)) in [("two sheets", pressed_sheets(64)), ("grains", pressed_grains(16))] {
        let aims = |sweeps: usize, bucket_vertices: usize, bucket_sweeps: usize| {
            let settings = Settings {
                bucket_vertices,
                bucket_sweeps,
                sweeps,
                polish_sweeps: sweeps,
                ..Settings::default()
            };
            let mut collision =
                with_settings(TwinEngine::new(), &scene, &Constraints::default(), &settings).unwrap();
            collision.begin(&Call::toward(&target)).unwrap();
            let report = collision.step().unwrap();
            (collision.end().unwrap().aims, report.contact_rows)
        };
        let (solved, rows) = aims(MANY, usize::MAX, 1);
        for (buckets, bucket_vertices, bucket_sweeps) in
            [("one", usize::MAX, 1), ("many", 16, 1), ("many", 16, 2), ("many", 16, 3)]
        {
            let errors = [2, 4, 5, 8, 16, 32].map(|sweeps| {
                let (aims, _) = aims(sweeps, bucket_vertices, bucket_sweeps);
                format!("{:.5}", distance(&aims, &solved) / DELTA)
            });
            println!(
                "| {name} | {} | {rows} | {buckets} | {bucket_sweeps} | {} |",
                scene.x.len(),
                errors.join(" | ")
            );
        }
    }
}

/// Two sheets of n x n vertices above each other, closer than they should be, and targets in which they have changed
/// places, and are stretched.
fn pressed_sheets(n: u32) -> (Scene, Vec<Point>) {
    let (mut x, mut triangles) = (Vec::new(), Vec::new());
    for sheet in 0..2 {
        let first = sheet * n * n;
        let corner = 0.3 * EDGE * f64::from(sheet);
        x.extend((0..n * n).map(|k| {
            let [x, y] = [k % n, k / n].map(|k| corner + EDGE * f64::from(k));
            Point::new(x, y, 0.9 * DELTA * f64::from(sheet))
        }));
        triangles.extend(sheet_triangles(n, first));
    }
    let topology = Topology::builder(x.len()).triangles(triangles).build().unwrap();
    let bodies = (0..2 * n * n).map(|v| v / (n * n)).collect();
    let model = CollisionModel::new(topology, bodies, vec![BodyFilter::DEFORMABLE; 2], vec![]).unwrap();
    let target = x.iter().map(|x| Point::new(1.02 * x.x, x.y, 0.9 * DELTA - x.z)).collect();
    (Scene { model, x, edge: EDGE }, target)
}

/// A cube of n x n x n grains on the ground, closer than they should be, and targets in which it is flatter by a fifth and
/// below the ground.
fn pressed_grains(n: u32) -> (Scene, Vec<Point>) {
    let mut random = fastrand::Rng::with_seed(1);
    let mut grain = |k: u32| {
        let place = [k % n, k / n % n, k / (n * n)];
        let [x, y, z] = place.map(|k| DELTA * (0.9 * f64::from(k) + 0.2 * random.f64()));
        Point::new(x, y, z + 0.5 * DELTA)
    };
    let x: Vec<Point> = (0..n * n * n).map(&mut grain).collect();
    let topology = Topology::builder(x.len()).particles((0..n * n * n).collect::<Vec<_>>()).build().unwrap();
    let ground = HalfSpace::new(Point::origin(), Vector::z()).unwrap();
    // Grains of one body may stay as close as they are at rest.
    let bodies = (0..n * n * n).collect();
    let filters = vec![BodyFilter::DEFORMABLE; x.len()];
    let model = CollisionModel::new(topology, bodies, filters, vec![ground]).unwrap();
    let target = x.iter().map(|x| Point::new(x.x, x.y, 0.8 * x.z - 0.2 * DELTA)).collect();
    (Scene { model, x, edge: DELTA }, target)
}

#[test]
fn bodies_that_move_as_one_stay_as_they_are() {
    let scene = scene();
    let mut random = fastrand::Rng::with_seed(7);
    let target = target(&scene, &mut random);
    // The strands are a group of pinned vertices.
    let is_strand = |v: usize| scene.model.vertex_body()[v] == 3;
    let groups: Vec<u32> = (0..scene.x.len()).map(|v| if is_strand(v) { 0 } else { NONE }).collect();
    let prescribed: Vec<bool> = (0..scene.x.len()).map(is_strand).collect();
    let constraints =
        Constraints { prescribed: &prescribed, groups: &groups, masses: &[], ..Constraints::default() };
    let mut collision = collision(TwinEngine::new(), &scene, &constraints);
    collision.begin(&Call::toward(&target)).unwrap();
    (0..10).for_each(|_| {
        collision.step().unwrap();
    });
    let end = collision.positions().unwrap();
    for body in [2, 3] {
        let vertices: Vec<usize> = (0..end.len()).filter(|&v| scene.model.vertex_body()[v] == body).collect();
        let share = |v: usize| (end[v] - scene.x[v]).norm() / (target[v] - scene.x[v]).norm();
        let first = share(vertices[0]);
        assert!(first > 0.01, "body {body}: {first}");
        for &v in &vertices {
            assert!((share(v) - first).abs() < 1e-4, "body {body}: {} {first}", share(v));
        }
    }
}

/// Bytes of the largest buffer with an entry per candidate, for so many candidates.
fn bytes_of_candidates(count: usize) -> u64 {
    48 * count as u64
}

fn limited_twins(bytes: u64) -> TwinEngine {
    let mut engine = TwinEngine::new();
    engine.limit_buffers(bytes);
    engine
}

/// Two calls, judged after each step: everything goes four edges aside until it has arrived, then it is folded through
/// everything for eight steps. The numbers of steps and of most candidates of each call, and where it ends.
fn judged_calls<E: Engine>(engine: E, submitted: usize) -> ([(usize, usize); 2], Vec<Point>, E) {
    let mut scene = scene();
    let judge = Judge::from_model(&scene.model);
    let mut collision = collision(engine, &scene, &Constraints::default());
    let mut counts = [(0, 0); 2];
    for (call, (steps, most)) in counts.iter_mut().enumerate() {
        let folds = call == 1;
        let aside = |x: &Point| x + Vector::new(0.0, 4.0 * EDGE, 0.0);
        let target = match folds {
            true => target(&scene, &mut fastrand::Rng::with_seed(6)),
            false => scene.x.iter().map(aside).collect(),
        };
        collision.begin(&Call::toward(&target)).unwrap();
        let mut remaining = f64::INFINITY;
        while if folds { *steps < 8 } else { remaining > 0.0 } {
            let most_steps = if folds { submitted.min(8 - *steps) } else { submitted };
            let reports = collision.steps(most_steps).unwrap();
            let before = std::mem::replace(&mut scene.x, collision.positions().unwrap());
            assert_no_intersections(&scene, &scene.x, &format!("call {call} step {steps}"));
            if submitted == 1 {
                let path = judge.check_path(&before, &scene.x, &PathOptions::default()).unwrap();
                assert!(path.is_clear(), "call {call} step {steps}: {path:?}");
            }
            // Of steps that are submitted together, some come after the arrival.
            for report in reports {
                if !folds && remaining == 0.0 {
                    break;
                }
                assert_eq!(report.frozen, 0);
                *steps += 1;
                *most = report.candidates.max(*most);
                remaining = report.remaining;
            }
            assert!(*steps < 500, "{remaining} m are left");
        }
    }
    (counts, scene.x, collision.into_engine())
}

/// Where a device does not bind all candidates, trust regions shrink: calls take more steps and end where they should.
#[test]
fn a_device_that_binds_few_candidates_takes_more_steps() {
    let (plenty, _, _) = judged_calls(TwinEngine::new(), 1);
    let room = plenty.map(|(_, most)| most).into_iter().min().unwrap() * 8 / 10;
    let twins = || limited_twins(bytes_of_candidates(room));
    let (few, end, _) = judged_calls(twins(), 1);
    assert!(few.iter().all(|(_, most)| *most <= room && *most > 0), "{few:?}, room for {room}");
    assert!(few[0].0 > plenty[0].0, "{few:?}, not as many as {plenty:?}");
    // How many steps are submitted together makes no difference; neither does the engine.
    let (together, together_end, _) = judged_calls(twins(), 4);
    assert!(together == few && together_end == end, "{together:?} {few:?}");
    let mut device = device();
    device.limit_buffers(bytes_of_candidates(room));
    let (compared, compared_end, engine) = judged_calls(ComparingEngine::new(device), 1);
    assert!(compared == few && compared_end == end, "{compared:?} {few:?}");
    // Where a number is compared with a threshold, rounding may decide.
    assert!(engine.differences().len() < 50, "{:?}", &engine.differences()[..5]);
}

#[test]
fn too_many_pairs_within_contact_range_are_an_error_that_names_both_sizes() {
    let scene = scene();
    let (room, target) = (1000, target(&scene, &mut fastrand::Rng::with_seed(6)));
    let bytes = bytes_of_candidates(room);
    let mut collision = collision(limited_twins(bytes), &scene, &Constraints::default());
    let start = collision.positions().unwrap();
    for _ in 0..2 {
        collision.begin(&Call::toward(&target)).unwrap();
        let error = collision.step().expect_err("more pairs are within range");
        let CollisionError::Gpu(GpuError::TooLarge { bytes: needed, most, .. }) = error else {
            panic!("{error}")
        };
        assert!(most == bytes && needed > most, "{needed} {most}");
        let text = error.to_string();
        assert!([needed, most].iter().all(|size| text.contains(&size.to_string())), "{text}");
        assert_eq!(collision.positions().unwrap(), start);
    }
}

#[test]
fn a_lost_device_is_an_error_and_no_panic() {
    let scene = scene();
    let engine = device();
    let name = engine.name().to_owned();
    engine.lose();
    let collision = try_collision(engine, &scene, &Constraints::default());
    let error = collision.expect_err("the device is lost").to_string();
    assert!(error.contains(&name), "{error}");
}

/// Pins among free vertices, all over two sheets that are folded through everything: every kernel does what its twin does,
/// also while some of the pins do not get on.
#[test]
fn kernels_and_twins_agree_on_rows_with_pins() {
    let scene = scene();
    let body = scene.model.vertex_body();
    let prescribed: Vec<bool> = (0..scene.x.len()).map(|v| body[v] < 2 && v % 5 == 0).collect();
    let constraints = Constraints { prescribed: &prescribed, ..Constraints::default() };
    let mut collision = collision(ComparingEngine::new(device()), &scene, &constraints);
    collision.begin(&Call::toward(&target(&scene, &mut fastrand::Rng::with_seed(6)))).unwrap();
    let mut pressing = 0;
    for step in 0..12 {
        pressing = collision.step().unwrap().pressing.max(pressing);
        assert_no_intersections(&scene, &collision.positions().unwrap(), &format!("step {step}"));
    }
    let differences = collision.engine().differences();
    assert!(
        pressing > 20 && differences.len() < 50,
        "{pressing} {:?}",
        &differences[..differences.len().min(5)]
    );
}
