//! Kernels beside their twins.

use crate::scene::{EDGE, Scene, assert_no_intersections, collision, device, scene, target, with_settings};
use bowknot_geometry::{BodyFilter, CollisionModel, HalfSpace, Point, Topology, Vector};
use bowknot_gpu::{
    Call, Carried, ComparingEngine, Constraints, Phase, PhaseSeconds, Settings, Stop, TwinEngine,
};

/// With all contact rows in one bucket, and in many.
#[test]
fn every_kernel_computes_what_its_twin_does() {
    for bucket_vertices in [1000, 4] {
        let mut random = fastrand::Rng::with_seed(6);
        let mut scene = scene();
        let engine = ComparingEngine::new(device());
        let settings = Settings { bucket_vertices, ..Settings::default() };
        let mut collision = with_settings(engine, &scene, &Constraints::default(), &settings).unwrap();
        let every_third: Vec<bool> = (0..scene.x.len()).map(|v| v % 3 == 0).collect();
        let mut carried: Vec<Carried> = Vec::new();
        for known in [&[], every_third.as_slice()] {
            assert_eq!(carried.iter().any(|pair| pair.multiplier > 0.0), !known.is_empty());
            let target = target(&scene, &mut random);
            collision.begin(&Call { known, carried: &carried, ..Call::toward(&target) }).unwrap();
            for step in 0..3 {
                collision.steps(1 + step % 2 * 2).unwrap();
                let end = collision.end().unwrap();
                scene.x = end.positions;
                carried = end.rows.iter().map(Carried::from).collect();
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

#[test]
fn a_device_agrees_with_the_twins_as_long_as_rounding_decides_nothing() {
    let scene = scene();
    let target = target(&scene, &mut fastrand::Rng::with_seed(6));
    let mut twin = collision(TwinEngine::new(), &scene, &Constraints::default());
    let mut device = collision(device(), &scene, &Constraints::default());
    twin.begin(&Call::toward(&target)).unwrap();
    device.begin(&Call::toward(&target)).unwrap();
    // Rounding of displacements of 0.2 m, which sweeps and the next step amplify.
    for tolerance in [2e-8, 2e-6] {
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

/// However many steps are submitted together, with many buckets of contact rows. Some of them end their
/// submission: a rule is met.
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

/// Pins among free vertices, all over two sheets that are folded through everything: every kernel does what
/// its twin does, also while some of the pins make no progress.
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
    let faults = collision.engine().faults();
    assert!(pressing > 20 && faults.len() < 50, "{pressing} {:?}", &faults[..faults.len().min(5)]);
}

/// A device that does not answer in time ends a call with an error, which names it.
#[test]
fn a_device_that_does_not_answer_is_lost() {
    let scene = scene();
    let mut engine = device();
    engine.set_time_limit(Some(std::time::Duration::ZERO));
    let lost = match with_settings(engine, &scene, &Constraints::default(), &Settings::default()) {
        Err(error) => error.to_string(),
        Ok(mut collision) => {
            // A device may have answered before the host looks, but not each time.
            let target = target(&scene, &mut fastrand::Rng::with_seed(6));
            let call = |_| match collision.begin(&Call::toward(&target)) {
                Ok(()) => collision.steps(8).err().map(|error| error.to_string()),
                Err(error) => Some(error.to_string()),
            };
            (0..100).find_map(call).expect("no time")
        }
    };
    assert!(lost.contains("no answer within 0 s"), "{lost}");
}
