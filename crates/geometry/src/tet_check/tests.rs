use super::*;

fn corners() -> Vec<Point> {
    let places = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
        [0.0, 0.0, -1.0],
        [0.1, 0.1, 2.0],
    ];
    places.map(|[x, y, z]| Point::new(x, y, z)).to_vec()
}

/// All orders of four vertices, and whether each is even.
fn orders([a, b, c, d]: [u32; 4]) -> Vec<([u32; 4], bool)> {
    let rotated = [[a, b, c, d], [b, c, a, d], [c, a, b, d], [b, a, d, c], [a, d, b, c], [d, b, a, c]];
    let more = [[a, c, d, b], [d, a, c, b], [c, d, a, b], [c, b, d, a], [d, c, b, a], [b, d, c, a]];
    rotated.into_iter().chain(more).flat_map(|t| [(t, true), ([t[1], t[0], t[2], t[3]], false)]).collect()
}

/// The order of vertices is no geometry: it decides on `turned` alone.
#[test]
fn overlaps_are_found_in_any_order_of_vertices() {
    let x = corners();
    for (first, first_even) in orders([0, 1, 2, 3]) {
        for (below, even) in orders([0, 2, 1, 4]) {
            let faults = check_tets(&x, &[first, below]);
            assert_eq!(faults.overlapping, [], "{first:?} {below:?}");
            let turned = [(0, first_even), (1, even)].into_iter().filter(|(_, even)| !even).map(|(t, _)| t);
            assert_eq!(faults.turned, turned.collect::<Vec<usize>>(), "{first:?} {below:?}");
        }
        for (above, _) in orders([0, 1, 2, 5]) {
            let faults = check_tets(&x, &[above, first]);
            assert_eq!(faults.overlapping, [SharedSide { tets: [0, 1], face: [0, 1, 2] }]);
        }
    }
    // Each makes a pair with the next.
    let faults = check_tets(&x, &[[0, 1, 2, 3], [0, 1, 2, 4], [0, 1, 2, 5], [2, 1, 0, 3]]);
    let pairs: Vec<[usize; 2]> =
        faults.overlapping.iter().filter(|o| o.face == [0, 1, 2]).map(|o| o.tets).collect();
    assert_eq!(pairs, [[0, 2], [2, 3]]);
}

#[test]
fn flat_ones_are_found_at_any_size_and_place() {
    for (scale, shift) in [(1.0, 0.0), (1e-150, 0.0), (1e150, 0.0), (0.125, 4096.0)] {
        let at = |x: f64, y: f64, z: f64| Point::new(x * scale + shift, y * scale + shift, z * scale + shift);
        let base = [at(0.0, 0.0, 0.0), at(1.0, 0.0, 0.0), at(0.0, 1.0, 0.0)];
        let with = |apex| [base[0], base[1], base[2], apex];
        assert!(is_flat(&with(at(1.0, 1.0, 0.0))) && is_flat(&with(base[0])) && is_flat(&[base[0]; 4]));
        assert!(!is_flat(&with(at(0.0, 0.0, 1e-9))));
    }
    let faults = check_tets(&corners(), &[[0, 1, 2, 2], [0, 0, 0, 0], [0, 1, 2, 3]]);
    assert_eq!((faults.flat, faults.overlapping.len()), (vec![0, 1], 0));
}

#[test]
fn volume_and_thinness_of_known_tetrahedra() {
    let regular = [[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]].map(Point::from);
    assert!((thinness(&regular) - (2.0_f64 / 3.0).sqrt()).abs() < 1e-15);
    assert!((signed_volume(&regular).abs() - 8.0 / 3.0).abs() < 1e-15);
    let [a, b, c, d] = regular;
    assert_eq!(signed_volume(&[a, b, c, d]), -signed_volume(&[b, a, c, d]));
    let thin = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.2, 0.2, 0.01]].map(Point::from);
    assert!((thinness(&thin) - 0.01 / 2.0_f64.sqrt()).abs() < 1e-15);
    assert_eq!(thinness(&[a, a, b, c]), 0.0);
}
