//! Tetrahedra on the same side of a face as another.

use super::center;
use crate::repair::solid_report::SolidRepair;
use bowknot_geometry::boundary_triangles;
use bowknot_geometry::tet_check::check_tets;
use bowknot_io::Mesh;
use std::collections::{BTreeSet, HashSet};

/// Drops tetrahedra until no two lie on the same side of a face that they share. Of two goes the one that
/// overlaps more others, then the one with fewer neighbors, then the later one.
pub(super) fn drop_overlapping(mesh: &mut Mesh, solid: &mut SolidRepair) {
    loop {
        let pairs = check_tets(&mesh.positions, &mesh.tets).overlapping;
        if pairs.is_empty() {
            return;
        }
        let mut overlaps = vec![Vec::new(); mesh.tets.len()];
        for [a, b] in pairs.iter().map(|pair| pair.tets) {
            overlaps[a].push(b);
            overlaps[b].push(a);
        }
        let open = open_faces(&mesh.tets);
        let mut queue: BTreeSet<(usize, usize, usize)> = (0..mesh.tets.len())
            .filter(|&t| !overlaps[t].is_empty())
            .map(|t| (overlaps[t].len(), open[t], t))
            .collect();
        let mut dropped = vec![false; mesh.tets.len()];
        while let Some((_, _, tet)) = queue.pop_last().filter(|(count, _, _)| *count > 0) {
            dropped[tet] = true;
            solid.overlapping.add(center(&mesh.positions, &mesh.tets[tet]));
            for other in std::mem::take(&mut overlaps[tet]) {
                // Once per face that the two share.
                if let Some(place) = overlaps[other].iter().position(|&t| t == tet) {
                    queue.remove(&(overlaps[other].len(), open[other], other));
                    overlaps[other].swap_remove(place);
                    queue.insert((overlaps[other].len(), open[other], other));
                }
            }
        }
        let mut index = 0;
        mesh.tets.retain(|_| {
            index += 1;
            !dropped[index - 1]
        });
    }
}

/// How many faces of each tetrahedron no other has.
fn open_faces(tets: &[[u32; 4]]) -> Vec<usize> {
    let sorted = |mut face: [u32; 3]| {
        face.sort_unstable();
        face
    };
    let open: HashSet<[u32; 3]> = boundary_triangles(tets).into_iter().map(sorted).collect();
    tets.iter()
        .map(|&[a, b, c, d]| {
            [[a, b, c], [a, b, d], [a, c, d], [b, c, d]]
                .into_iter()
                .filter(|&face| open.contains(&sorted(face)))
                .count()
        })
        .collect()
}
