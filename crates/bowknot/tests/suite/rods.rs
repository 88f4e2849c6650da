//! Strands that resist twist, by theory, and what a simulator promises for them.

use super::scene;
use bowknot::check::StateOptions;
use bowknot::dynamics::StrandMaterial;
use bowknot::geometry::nalgebra::{Isometry3, Rotation3, Translation3};
use bowknot::geometry::{Point, Vector};
use bowknot::scene::Material;
use bowknot::{Simulator, StepStatistics};
use std::f64::consts::PI;

/// Rigidities [N m^2] of the rods below, which are 30 cm long and of 30 edges. Edges of which both ends are held clamp a rod
/// in their middles: it is 29 cm long between two of them.
const BENDING: f64 = 6e-3;
const TWIST: f64 = 4e-3;

/// A straight rod that hangs from its first two vertices, with more of the scene, and of `[simulation]`.
fn straight(simulation: &str, more: &str) -> String {
    format!(
        "[solver.sleep]\nenabled = false\n[simulation]\ndt = 0.01\n{simulation}\n[[body]]\nname = \"rod\"\nkind = \"strands\"\nstretch_limit = inf\n\
         shape = {{ type = \"strands\", count = 1, length = 0.3, segments = 30 }}\n\
         material = {{ density = 6e-3, stretch_stiffness = 1e4, bend_stiffness = {BENDING}, twist_stiffness = {TWIST}, \
         radius = 1.5e-3, bend_damping = 0.02 }}\n[[pin]]\nbody = \"rod\"\nroots = 2\n{more}"
    )
}

const TIP: &str = "[[pin]]\nbody = \"rod\"\nroots = 2\nroot_end = \"last\"\n";

fn simulator(text: &str) -> Simulator {
    Simulator::new(&scene(text)).unwrap_or_else(|error| panic!("{error}"))
}

fn run(simulator: &mut Simulator, steps: usize) -> StepStatistics {
    let step = |_| simulator.step().unwrap_or_else(|error| panic!("{error}"));
    (0..steps).map(step).last().expect("steps")
}

/// The largest distance of the rod's own vertices from its axis [m].
fn sideways(simulator: &Simulator) -> f64 {
    let own = simulator.world().bodies[0].own_vertices();
    own.map(|v| simulator.positions()[v as usize].coords.xy().norm()).fold(0.0, f64::max)
}

/// The rod with its tip turned by `angle` [rad], which takes two seconds.
fn twisted(angle: f64) -> Simulator {
    let tip = format!(
        "{TIP}motion = {{ keyframes = [{{ time = 0.0, angle = 0.0 }}, {{ time = 2.0, angle = {:?} }}] }}\n",
        angle.to_degrees()
    );
    // A breath of wind from one side lets it choose a direction.
    let mut simulator = simulator(&straight("gravity = [1e-4, 0, 0]", &tip));
    run(&mut simulator, 200);
    simulator
}

#[test]
fn a_twisted_rod_stores_the_energy_of_a_torsion_spring() {
    let mut simulator = twisted(4.0);
    let statistics = run(&mut simulator, 1);
    // From the middle of the first edge to that of the last.
    let expected = 0.5 * TWIST * 4.0 * 4.0 / 0.29;
    let energy = statistics.energy.elastic;
    assert!((energy - expected).abs() < 1e-3 * expected, "{energy} instead of {expected} J");
    assert!(statistics.solved && sideways(&simulator) < 1e-6);
}

/// The smallest torque at which a rod that is clamped at both ends, these not free to turn sideways, is not straight
/// any more: T l/(EI) = 8.9868, the first root of tan(x) = x doubled (Timoshenko and Gere, "Theory of Elastic
/// Stability", section 2.21).
#[test]
fn a_rod_buckles_at_its_critical_torque() {
    let critical = 8.9868 * BENDING / TWIST;
    for (share, buckles) in [(0.97, false), (1.04, true)] {
        let mut simulator = twisted(share * critical);
        run(&mut simulator, 400);
        let found = sideways(&simulator);
        assert_eq!(found > 1e-5, buckles, "{share}: {found} m");
        assert!(found < 0.01, "{found} m");
    }
}

/// Euler's critical load of a column with both ends clamped, 4 pi^2 EI/l^2 (Timoshenko and Gere, section 2.2), is
/// reached by shortening the 28 free edges by 0.028 %.
#[test]
fn a_rod_buckles_at_eulers_load() {
    let shortening = 4.0 * PI * PI * BENDING / (1e4 * 0.29 * 0.29) * 0.28;
    for (share, buckles) in [(0.95, false), (1.05, true)] {
        let lift = share * shortening;
        let tip = format!(
            "{TIP}motion = {{ keyframes = [{{ time = 0.0 }}, {{ time = 1.0, translate = [0, 0, {lift:?}] }}] }}\n"
        );
        let mut simulator = simulator(&straight("gravity = [1e-3, 0, 0]", &tip));
        run(&mut simulator, 400);
        let found = sideways(&simulator);
        assert_eq!(found > 1e-5, buckles, "{share}: {found} m");
    }
}

/// A curl of hair hangs as a helical spring does: under its weight W it becomes longer by W/2 R^2 l (cos^2 a/GJ +
/// sin^2 a/EI), with wire of length l that rises at an angle a on a cylinder of radius R (Wahl, "Mechanical Springs").
/// Without twist stiffness there is nothing but bending, and it unwinds.
#[test]
fn a_curl_is_a_helical_spring() {
    let (radius, turns, bending, twist, gravity) = (0.008, 5.0, 7.84e-9, 5e-9, 0.5);
    let sag = |twist: f64| {
        let text = format!(
            "[simulation]\ndt = 0.02\ngravity = [0, 0, -{gravity}]\n[[body]]\nname = \"hair\"\nkind = \"strands\"\n\
             shape = {{ type = \"strands\", count = 1, length = 0.1, segments = 160, curl = {radius}, turns = {turns} }}\n\
             material = {{ base = \"hair\", bend_stiffness = {bending:?}, twist_stiffness = {twist:?}, \
             bend_damping = 0.05 }}\nstretch_limit = inf\n[[pin]]\nbody = \"hair\"\nroots = 2\n"
        );
        let mut simulator = simulator(&text);
        let tip = |simulator: &Simulator| simulator.positions()[160].z;
        let start = tip(&simulator);
        run(&mut simulator, 200);
        start - tip(&simulator)
    };
    let (pitch, around): (f64, f64) = (0.1 / turns, 2.0 * PI * radius);
    let (wire, rise) = (turns * pitch.hypot(around), pitch.atan2(around));
    let weight = 6.635e-6 * wire * gravity;
    let compliance = rise.cos().powi(2) / twist + rise.sin().powi(2) / bending;
    let expected = 0.5 * weight * radius * radius * wire * compliance;
    let found = sag(twist);
    assert!((found - expected).abs() < 0.05 * expected, "{found} instead of {expected} m");
    let unwound = sag(0.0);
    assert!(unwound > 4.0 * expected, "{unwound} m");
}

/// The deflection of a cantilever with a load w per length, w l^4/(8 EI), and the frequency of a clamped rod, 3.516
/// sqrt(EI/(m l^4)) (Timoshenko, "Vibration Problems in Engineering"), with twist stiffness or without.
#[test]
fn a_clamped_rod_sags_and_swings_by_beam_theory() {
    let length: f64 = 0.295;
    for twist in [0.0, TWIST] {
        let text =
            straight("gravity = [0.02, 0, 0]", "").replace("bend_damping = 0.02", "bend_damping = 0.0");
        let text =
            text.replace(&format!("twist_stiffness = {TWIST}"), &format!("twist_stiffness = {twist:?}"));
        let text = text.replace("dt = 0.01", "dt = 0.001\nintegrator = \"sdirk2\"");
        let mut simulator = simulator(&text);
        // Released from the straight shape it swings about the sagged one: from its first turning point, twice as far, to
        // the next one it takes a period.
        let mut tips: Vec<f64> = Vec::new();
        for _ in 0..400 {
            run(&mut simulator, 1);
            tips.push(simulator.positions()[30].x);
        }
        let mean = tips.iter().sum::<f64>() / tips.len() as f64;
        let crossings: Vec<f64> = (1..tips.len())
            .filter(|&k| tips[k - 1] < mean && tips[k] >= mean)
            .map(|k| k as f64 + (mean - tips[k - 1]) / (tips[k] - tips[k - 1]))
            .collect();
        let period = (crossings[crossings.len() - 1] - crossings[0]) / (crossings.len() - 1) as f64 * 0.001;
        let expected = 2.0 * PI / (3.516 * (BENDING / (6e-3 * length.powi(4))).sqrt());
        assert!((period - expected).abs() < 0.02 * expected, "{twist}: {period} instead of {expected} s");
        let sag = 6e-3 * 0.02 * length.powi(4) / (8.0 * BENDING);
        let largest = tips.iter().copied().fold(0.0, f64::max);
        assert!((largest - 2.0 * sag).abs() < 0.06 * sag, "{twist}: {largest} instead of twice {sag} m");
    }
}

#[test]
fn frame_points_are_nobodys_vertices_but_pins_hold_and_lead_them() {
    let mut simulator = simulator(&straight("gravity = [0, 0, 0]", TIP));
    let world = simulator.world();
    let body = &world.bodies[0];
    assert_eq!((body.own_vertices().count(), body.mesh_order().len(), body.interior.len()), (31, 31, 30));
    assert_eq!((world.info(0.01).vertices, world.sizes()[0].vertices), (31, 31));
    let pins: Vec<(String, usize)> =
        world.pins.iter().map(|pin| (pin.name.clone(), pin.vertices.len())).collect();
    assert_eq!(pins.iter().map(|pin| pin.1).collect::<Vec<_>>(), [3, 3]);
    // A turn of the tip by a pose twists the rod; targets of its vertices alone do not.
    let ends: Vec<Point> =
        world.pins[1].vertices[..2].iter().map(|&v| simulator.positions()[v as usize]).collect();
    simulator.set_pin_targets(&pins[1].0, &ends).expect("frame points may be left out");
    assert!(run(&mut simulator, 5).energy.elastic < 1e-20);
    let turn = Isometry3::from_parts(Translation3::identity(), Rotation3::new(Vector::z() * 0.5).into());
    simulator.set_pin_pose(&pins[1].0, &turn).expect("a pose");
    let energy = run(&mut simulator, 50).energy.elastic;
    let expected = 0.5 * TWIST * 0.25 / 0.29;
    assert!((energy - expected).abs() < 0.01 * expected, "{energy} instead of {expected} J");
    // Put somewhere else as a whole, it stays as it is.
    let moved: Vec<Point> = (0..31).map(|v| simulator.positions()[v] + Vector::new(0.1, 0.2, 0.3)).collect();
    let before = simulator.positions()[simulator.positions().len() - 1];
    simulator.place("rod", &moved).expect("nothing is there");
    let after = simulator.positions()[simulator.positions().len() - 1];
    assert!((after - before - Vector::new(0.1, 0.2, 0.3)).norm() < 1e-12);
}

#[test]
fn twist_stiffness_changes_but_neither_begins_nor_ends_while_a_simulation_runs() {
    let mut simulator = simulator(&straight("", ""));
    let material = |twist_stiffness: f64| {
        Material::Strands(StrandMaterial { twist_stiffness, ..StrandMaterial::straw() })
    };
    simulator.set_material("rod", material(2e-3)).expect("another stiffness");
    run(&mut simulator, 2);
    let error = simulator.set_material("rod", material(0.0)).expect_err("no twist");
    assert!(error.to_string().contains("cannot become 0"), "{error}");
    run(&mut simulator, 2);
}

/// Locks that fall onto a ball, hold each other and twist: judged, and the same bits on two threads and after a restart.
#[test]
fn rods_in_contact_are_judged_and_resume_to_the_same_bits() {
    let text = "[simulation]\ndt = 0.01\n[[body]]\nname = \"hair\"\nkind = \"strands\"\n\
                shape = { type = \"strands\", count = 16, length = 0.12, segments = 12, curl = 0.004, turns = 3, \
                spacing = 0.012 }\nmaterial = { base = \"lock\", twist_stiffness = 5e-7 }\n\
                translate = [0, 0, 0.2]\nangular_velocity = [0, 300, 0]\n\
                [[obstacle]]\nname = \"ball\"\nshape = { type = \"ball\", radius = 0.05, edge = 0.015 }\n";
    let finish = |threads: usize, restart: bool| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| {
            let mut one = simulator(text);
            run(&mut one, 15);
            if restart {
                let carried = one.checkpoint();
                one = simulator(text);
                one.restore(&carried).expect("its own checkpoint");
            }
            let last = run(&mut one, 15);
            assert!(last.max_stretch < 1.12 && last.pressing_contacts > 0, "{last:?}");
            let count = one.world().collision_vertices();
            let options = StateOptions { distance: false, ..StateOptions::default() };
            let report = one.judge().check_state(&one.positions()[..count], &options).expect("judged");
            assert!(report.is_clear(), "{report:?}");
            let bits = |x: &Point| [x.x, x.y, x.z].map(f64::to_bits);
            one.positions().iter().map(bits).collect::<Vec<_>>()
        })
    };
    let alone = finish(1, false);
    assert!(alone == finish(2, false) && alone == finish(1, true));
}
