//! The game without a window.

use super::*;
use bevy::mesh::VertexAttributeValues;
use simulation::Simulation;
use std::sync::Arc;

fn app() -> App {
    headless(simulator().expect("a scene without faults"))
}

#[test]
fn the_cloth_lies_on_the_box_that_moves() {
    let mut app = app();
    advance(&mut app, 60).expect("60 time steps");
    let world = app.world_mut();
    assert_eq!(world.resource::<Report>().intersections, 0);

    let mut leaders = world.query_filtered::<&Transform, With<Leads>>();
    let leader = leaders.single(world).expect("the box is led").translation;
    assert!(leader.x > 0.05, "{leader}");
    let mut surfaces = world.query::<(&Name, &Mesh3d, &Surface)>();
    assert_eq!(surfaces.iter(world).count(), 2);
    for (name, mesh, _) in surfaces.iter(world) {
        let mesh = world.resource::<Assets<Mesh>>().get(mesh).expect("a mesh");
        let [positions, normals] = [Mesh::ATTRIBUTE_POSITION, Mesh::ATTRIBUTE_NORMAL].map(|attribute| {
            let Some(VertexAttributeValues::Float32x3(values)) = mesh.attribute(attribute) else { panic!() };
            values.iter().copied().map(Vec3::from).collect::<Vec<_>>()
        });
        assert!(normals.iter().all(|normal| normal.is_normalized()), "{name}");
        if name.as_str() == "cloth" {
            let heights = positions.iter().map(|x| x.y);
            let (low, high) = (heights.clone().fold(f32::MAX, f32::min), heights.fold(f32::MIN, f32::max));
            assert!(low > -0.3 && low < -0.2 && high > 0.1 && high < 0.12, "cloth from {low} to {high}");
        } else {
            // The leader is ahead by the time step in flight.
            let center = positions.iter().sum::<Vec3>() / positions.len() as f32;
            assert!(center.distance(leader) < 0.01, "{center} is led to {leader}");
        }
    }
}

#[test]
fn frames_do_not_wait_for_the_time_step_in_flight() {
    let mut app = app();
    // Spawns the surfaces; the first time step begins in a later frame.
    app.update();
    let simulator = Arc::clone(&app.world().resource::<Simulation>().simulator);
    let held = simulator.lock().expect("no step has panicked");
    for _ in 0..20 {
        std::thread::sleep(Duration::from_millis(10));
        app.update();
    }
    assert!(app.world().resource::<Time<Fixed>>().elapsed() > Duration::ZERO);
    assert_eq!(app.world().resource::<Report>().last.step, 0);
    drop(held);
    advance(&mut app, 2).expect("two time steps");
}

#[test]
fn errors_are_told_in_plain_words() {
    let mut app = app();
    app.world_mut().spawn((Leads("bxo"), Transform::default()));
    let error = advance(&mut app, 1).expect_err("no such obstacle");
    let words = "The simulation has stopped: no obstacle with a mesh \"bxo\"; there are: box";
    assert_eq!(error.lines().last(), Some(words));
    let error = run(&["--headless", "many"]).expect_err("no number");
    assert!(error.starts_with("\"many\" is no number of time steps\nusage: "), "{error}");
}
