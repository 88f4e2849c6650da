//! The properties of the fuzz targets in `tests/fuzz` hold for seeded random bytes and for valid files with
//! some bytes changed. Enough of both lead to a check of the property.
//!
//! `BOWKNOT_SEEDS=20 cargo test --release -p bowknot-tests fuzz_bodies` tries ten times as many.

use crate::interior_points::seeds;
use bowknot::io::{MeshView, write_obj, write_ply};
use bowknot::recording::States;
use bowknot_tests::states::GENERATORS;
use bowknot_tests::{Random, fuzz};
use std::fs;

fn bytes(random: &mut Random, length: usize) -> Vec<u8> {
    (0..length).map(|_| random.bits() as u8).collect()
}

/// Runs the body of a fuzz target on random bytes. Returns the share of runs that led to a check of its
/// property.
fn share(body: fn(&[u8]) -> bool, cases: u64, length: usize) -> f64 {
    let mut random = Random::new(cases);
    let reached = (0..cases).filter(|_| body(&bytes(&mut random, length))).count();
    reached as f64 / cases as f64
}

/// One tetrahedron in files of the formats that are only read, behind the byte that chooses the format.
const SOLID: &[u8] =
    b"\x04$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n9 0 0 1\n\
    $EndNodes\n$Elements\n3\n1 15 2 0 1 1\n2 2 2 0 1 1 2 3\n3 4 2 0 1 1 2 3 9\n$EndElements\n";
const TETS: &[u8] = b"\x05Vertex 0 0 0 0\nVertex 1 1 0 0\nVertex 2 0 1 0\nVertex 3 0 0 1\nTet 0 0 1 2 3\n";
const SEGMENTS: &[u8] = b"\x06v 0 0 0\nv 1 0 0\nv 0 1 0\ns 1 2\ns 2 3\n";

/// The same as a binary file of version 4.1 with counts of `size` bytes.
fn binary_solid(size: usize) -> Vec<u8> {
    [b"\x04", fuzz::binary_msh_4(size).as_slice()].concat()
}

#[test]
fn certified_widths_hold_for_any_points() {
    assert_eq!(share(fuzz::separate, 50_000 * seeds(), 104), 1.0);
}

#[test]
fn no_small_scene_is_ever_brought_to_intersect() {
    let reached = share(fuzz::resolve, 2_000 * seeds(), 800);
    assert!(reached > 0.1, "only {reached:.3} of the scenes were taken");
}

#[test]
fn no_small_scene_is_brought_to_intersect_by_the_twins_of_the_kernels() {
    let reached = share(fuzz::resolve_on_twins, 2_000 * seeds(), 800);
    assert!(reached > 0.05, "only {reached:.3} of the scenes were taken");
}

#[test]
fn arrays_of_any_kind_are_read_or_refused() {
    let compose = |data: &[u8]| fuzz::read_mesh(&[&[3], data].concat());
    let reached = share(compose, 500 * seeds(), 600);
    assert!(reached > 0.05, "only {reached:.3} of the archives were taken");
}

#[test]
fn damaged_files_are_read_or_refused() {
    let folder = tempfile::tempdir().expect("a folder for files");
    let (mut files, mut taken, mut refused) = (Vec::new(), 0, 0);
    for generator in GENERATORS {
        let case = generator(0);
        let topology = case.model.topology();
        let strands: Vec<[u32; 2]> =
            topology.strand_edges.iter().map(|&e| topology.edges[e as usize]).collect();
        let mesh = MeshView {
            positions: &case.positions,
            triangles: &topology.triangles,
            strands: &strands,
            particles: &topology.particles,
            body: case.model.vertex_body(),
            ..MeshView::default()
        };
        let count = case.positions.len();
        let states = States {
            x: case.positions.clone(),
            y: case.positions.clone(),
            triangles: topology.triangles.clone(),
            strands: strands.clone(),
            particles: topology.particles.clone(),
            rest: case.positions.clone(),
            masses: vec![1.0; count],
            fixed: vec![false; count],
            obstacle: vec![false; count],
            body: case.model.vertex_body().to_vec(),
            half_spaces: case.model.half_spaces().to_vec(),
            time_step: Some(0.01),
            ..States::default()
        };
        for choice in 0..3 {
            let path = folder.path().join("file");
            let written = match choice {
                0 => write_obj(&path, &mesh),
                1 => write_ply(&path, &mesh),
                _ => states.write(&path),
            };
            written.expect("the folder can be written");
            files.push([vec![choice], fs::read(&path).expect("just written")].concat());
        }
    }
    files.extend([SOLID, TETS, SEGMENTS].map(<[u8]>::to_vec));
    files.extend([binary_solid(8), binary_solid(4)]);
    let mut random = Random::new(1);
    for file in &files {
        assert!(fuzz::read_mesh(file), "a sound file is refused");
        for _ in 0..10 * seeds() {
            let mut damaged = file.clone();
            // The beginning of a file decides how the rest is read.
            let reach = if random.below(2) == 0 { damaged.len().min(400) } else { damaged.len() };
            for _ in 0..1 + random.below(3) {
                let place = 1 + random.below(reach - 1);
                match random.below(4) {
                    0 => damaged[place] = random.bits() as u8,
                    1 => damaged[place] ^= 1 << random.below(8),
                    2 => damaged[place] = b"0123456789-+.eE \n#/\\"[random.below(20)],
                    _ => damaged.truncate(place + 1),
                }
                if damaged.len() < reach {
                    break;
                }
            }
            if fuzz::read_mesh(&damaged) {
                taken += 1;
            } else {
                refused += 1;
            }
        }
    }
    assert!(taken > 0 && refused > 0, "{taken} taken, {refused} refused");
}
