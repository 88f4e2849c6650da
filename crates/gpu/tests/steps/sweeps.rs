//! Sweeps of rows and edges.

use crate::scene::{
    DELTA, EDGE, Scene, assert_no_intersections, device, distance, hanging_sheet, scene, sheet_triangles,
    target, with_settings,
};
use bowknot_geometry::{BodyFilter, CollisionModel, HalfSpace, Point, Topology, Vector};
use bowknot_gpu::{Call, ComparingEngine, Constraints, Settings, TwinEngine};

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
    let under = |k: usize| x[3 * k] + Vector::new(0.3 * EDGE, 0.3 * EDGE, -1.5 * DELTA);
    let particles: Vec<Point> = (0..count).map(under).collect();
    x.extend(particles);
    let topology = Topology::builder(x.len())
        .triangles(triangles)
        .particles((first..x.len() as u32).collect::<Vec<_>>())
        .build()
        .unwrap();
    Scene { model: CollisionModel::single_body(topology), x, edge: EDGE }
}

/// A workgroup keeps the rows of a bucket if they are no more than its threads and have no more vertices than
/// its table has slots (sweep_rows.wgsl): buckets on both sides of both limits.
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
            assert_eq!(report.pressing, count, "step {step}: {report:?}");
        }
        let differences = collision.engine().differences();
        assert!(differences.is_empty(), "{count}: {:?}", &differences[..differences.len().min(3)]);
        let x = collision.positions().unwrap();
        assert_no_intersections(&scene, &x, "the end");
    }
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

/// The table of `docs/gpu/collisions.md`: how far the aim of a first step is from that after many sweeps,
/// with contact rows in one bucket and in many.
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

/// Two sheets of n x n vertices above each other, closer than they should be, and targets in which they have
/// changed places, and are stretched.
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

/// A cube of n x n x n grains on the ground, closer than they should be, and targets in which it is flatter
/// by a fifth and below the ground.
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

/// A sheet of 5 x 5 vertices on one of 65 x 65, closer than they should be, and targets in which they have
/// changed places: more rows hold each vertex of the coarse sheet than there are colors.
fn coarse_on_fine() -> (Scene, Vec<Point>) {
    const FINE: u32 = 65;
    const COARSE: u32 = 5;
    let (mut x, mut triangles) = (Vec::new(), Vec::new());
    for (sheet, n) in [FINE, COARSE].into_iter().enumerate() {
        let (first, height) = (x.len() as u32, 0.9 * DELTA * sheet as f64);
        let edge = 0.25 * EDGE * f64::from(FINE - 1) / f64::from(n - 1);
        x.extend((0..n * n).map(|k| {
            // Not on a line with the other sheet's.
            let [x, y] = [k % n, k / n].map(|k| edge * (f64::from(k) + 0.003 * sheet as f64));
            Point::new(x, y, height)
        }));
        triangles.extend(sheet_triangles(n, first));
    }
    let topology = Topology::builder(x.len()).triangles(triangles).build().unwrap();
    let bodies = (0..x.len() as u32).map(|v| u32::from(v >= FINE * FINE)).collect();
    let model = CollisionModel::new(topology, bodies, vec![BodyFilter::DEFORMABLE; 2], vec![]).unwrap();
    let target = x.iter().map(|x| Point::new(x.x, x.y, 0.9 * DELTA - x.z)).collect();
    (Scene { model, x, edge: 0.25 * EDGE }, target)
}

/// Rows without a color share the masses of their vertices, and are swept at once: alike by kernels and
/// twins, and twice alike.
#[test]
fn sweeps_of_rows_without_a_color_are_those_of_the_twin() {
    let (scene, target) = coarse_on_fine();
    for bucket_vertices in [128, 100_000] {
        let settings = Settings { sweeps: 2, bucket_vertices, ..Settings::default() };
        let engine = ComparingEngine::new(device());
        let mut collision = with_settings(engine, &scene, &Constraints::default(), &settings).unwrap();
        collision.begin(&Call::toward(&target)).unwrap();
        let report = collision.step().unwrap();
        assert!(report.contact_rows > 3000 && report.pressing > 1000, "{report:?}");
        let faults = collision.engine().faults();
        assert!(faults.len() < 20, "{}: {:?}", faults.len(), &faults[..3]);
        let aims = [(); 2].map(|()| {
            let mut collision = with_settings(device(), &scene, &Constraints::default(), &settings).unwrap();
            collision.begin(&Call::toward(&target)).unwrap();
            collision.step().unwrap();
            let x = collision.positions().unwrap();
            assert_no_intersections(&scene, &x, "the end");
            collision.end().unwrap().aims
        });
        assert!(aims[0] == aims[1]);
    }
}

/// The figure of the design note on rows without a color: how far the aim of a first step is from that after
/// many sweeps where a few vertices have most of the rows.
#[test]
#[ignore = "it prints a table"]
fn errors_by_sweeps_of_rows_without_a_color() {
    const MANY: usize = 3000;
    let (scene, target) = coarse_on_fine();
    let aims = |sweeps: usize| {
        let settings = Settings { sweeps, polish_sweeps: sweeps, ..Settings::default() };
        let mut collision =
            with_settings(TwinEngine::new(), &scene, &Constraints::default(), &settings).unwrap();
        collision.begin(&Call::toward(&target)).unwrap();
        let report = collision.step().unwrap();
        (collision.end().unwrap().aims, report.contact_rows)
    };
    let (solved, rows) = aims(MANY);
    let errors = [2, 4, 5, 8, 16, 32].map(|sweeps| {
        let (aims, _) = aims(sweeps);
        format!("{:.4}", distance(&aims, &solved) / DELTA)
    });
    println!("| coarse on fine | {rows} | {} |", errors.join(" | "));
}
