//! Devices that bind little, or are lost.

use crate::scene::{EDGE, assert_no_intersections, collision, device, scene, target, try_collision};
use bowknot_check::{Judge, PathOptions};
use bowknot_geometry::{Point, Vector};
use bowknot_gpu::{Call, CollisionError, ComparingEngine, Constraints, Engine, GpuError, TwinEngine};

/// Bytes of the largest buffer with an entry per candidate, for so many candidates.
fn bytes_of_candidates(count: usize) -> u64 {
    48 * count as u64
}

fn limited_twins(bytes: u64) -> TwinEngine {
    let mut engine = TwinEngine::new();
    engine.limit_buffers(bytes);
    engine
}

/// Two calls, judged after each step: everything goes four edges aside until it has arrived, then it is
/// folded through everything for eight steps. The numbers of steps and of most candidates of each call, and
/// where it ends.
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

/// Where a device does not bind all candidates, trust regions shrink: calls take more steps and end where
/// they should.
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
