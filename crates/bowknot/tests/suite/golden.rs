//! The same bits on every machine with x86-64, on any number of threads, with and without statistics, in
//! debug and release builds: hashes of five scenes of all kinds of bodies.
//!
//! `golden.txt` has the accepted hashes; `BOWKNOT_ACCEPT=1 cargo test --release -p bowknot --all-features
//! golden` writes those of this machine. They change with every change of the solver that rounds differently.
//! A hash that differs on one machine only is a bug: a function of the system, or code that depends on the
//! processor.

use bowknot::{Scene, Simulator};
use std::path::Path;

/// Scenes into contact: name, scale, time steps.
const SCENES: [(&str, f64, usize); 5] =
    [("needle", 0.15, 16), ("dress", 0.08, 8), ("mat", 0.1, 60), ("hair", 0.05, 40), ("sand", 0.1, 40)];

/// The hash of a scene's positions and velocities after its last time step. Statistics that are measured and
/// those that are not must be the same to the simulation.
fn hash((name, scale, frames): (&str, f64, usize), threads: usize, measured: bool) -> u64 {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
    pool.install(|| {
        let scene = Scene::builtin(name, scale).expect("a scene");
        let mut simulator = Simulator::new(&scene).expect("a simulator");
        simulator.set_measured(measured);
        (0..frames).for_each(|_| {
            simulator.step().expect("a step");
        });
        let positions = simulator.positions().iter().flat_map(|x| [x.x, x.y, x.z]);
        let velocities = simulator.velocities().iter().flat_map(|v| [v.x, v.y, v.z]);
        fnv(positions.chain(velocities).flat_map(|number| number.to_bits().to_le_bytes()))
    })
}

/// The 64-bit FNV-1a hash (Fowler, Noll and Vo).
fn fnv(bytes: impl Iterator<Item = u8>) -> u64 {
    bytes.fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
}

#[test]
fn golden_hashes_are_those_of_every_machine() {
    let hashes: String =
        SCENES.iter().map(|scene| format!("{} {:016x}\n", scene.0, hash(*scene, 1, true))).collect();
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/suite/golden.txt");
    if std::env::var_os("BOWKNOT_ACCEPT").is_some() {
        std::fs::write(&path, &hashes).expect("a file to write");
    }
    let accepted = std::fs::read_to_string(&path).expect("accepted hashes");
    assert_eq!(accepted, hashes, "accepted, of this machine; BOWKNOT_ACCEPT=1 accepts those of this machine");
}

#[test]
fn threads_and_statistics_change_no_bit_of_any_kind_of_body() {
    for scene in SCENES {
        let one = hash(scene, 1, true);
        for (threads, measured) in [(1, false), (2, true), (3, false), (8, true)] {
            assert_eq!(hash(scene, threads, measured), one, "{}, {threads} threads", scene.0);
        }
    }
}
