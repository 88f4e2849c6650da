use super::*;
use crate::linear::block::{BlockPattern, BlockValues};
use crate::linear::scalar::{ScalarBuilder, SplitForm};
use nalgebra::{DMatrix, SMatrix};

/// A chain of 12 nodes with pseudo-random couplings; one node is held.
fn chain() -> (Vec<Vector>, BlockPattern, BlockValues, SplitForm, Vec<bool>) {
    let count = 12;
    let wave = |k: usize| (k as f64 * 2.3).sin();
    let x: Vec<Vector> = (0..count).map(|k| Vector::new(k as f64, wave(k), wave(k + 50))).collect();
    let pattern = BlockPattern::from_cliques(count, |visit| {
        (1..count as u32).for_each(|k| visit(&[k - 1, k]));
    });
    let mut values = BlockValues::zeros(&pattern);
    for k in 0..count {
        values.diagonal[k] = Matrix3::from_diagonal_element(10.0 + wave(k));
        if k > 0 {
            let block = Matrix3::from_fn(|i, j| wave(7 * k + 3 * i + j));
            values.blocks[pattern.slot(k as u32 - 1, k as u32) as usize] = block;
            values.blocks[pattern.slot(k as u32, k as u32 - 1) as usize] = block.transpose();
        }
    }
    let mut scalar = ScalarBuilder::new(count);
    (2..count as u32).for_each(|k| scalar.add(k - 2, k, -0.3));
    let free = (0..count).map(|k| k != 9).collect();
    let scalar = scalar.build().split(&pattern);
    (x, pattern, values, scalar, free)
}

/// The coarse correction for `r`.
fn correct(coarse: &mut Coarse, r: &[Vector]) -> Vec<Vector> {
    let lanes: Vec<Lane<f64>> = r.iter().map(|r| Lane::new(r, 1.0)).collect();
    let arms: Vec<Lane<f64>> = coarse.arms().collect();
    coarse.solve(&lanes, &arms);
    let displacement =
        |node: usize| coarse.motion(coarse.aggregate_of(node)).displacement(&arms[node]).vector();
    (0..r.len()).map(displacement).collect()
}

#[test]
fn the_correction_is_the_galerkin_projection() {
    let (x, pattern, values, scalar, free) = chain();
    let system = System { pattern: &pattern, values: &values, scalar: &scalar, springs: None, free: &free };
    let aggregates = [0..4u32, 4..7, 7..12];
    let mut coarse = Coarse::new(&aggregates, &x, |row, visit| {
        pattern.columns[pattern.row(row)].iter().for_each(|&c| visit(c));
        scalar.off_pattern(row).0.iter().for_each(|&c| visit(c));
    });
    coarse.build(&system, &x, 100);

    // Dense H over free nodes, dense P from the definition.
    let count = x.len();
    let mut matrix = DMatrix::zeros(3 * count, 3 * count);
    for column in 0..3 * count {
        let mut unit = vec![Vector::zeros(); count];
        unit[column / 3][column % 3] = 1.0;
        let mut image = vec![Vector::zeros(); count];
        system.multiply(&unit, &mut image);
        (0..3 * count).for_each(|row| matrix[(row, column)] = image[row / 3][row % 3]);
    }
    let mut motions = DMatrix::zeros(3 * count, 18);
    for (a, range) in aggregates.iter().enumerate() {
        let nodes = range.start as usize..range.end as usize;
        let center = x[nodes.clone()].iter().sum::<Vector>() / nodes.len() as f64;
        for node in nodes.filter(|&n| free[n]) {
            let mut part = SMatrix::<f64, 3, 6>::zeros();
            part.fixed_view_mut::<3, 3>(0, 0).fill_with_identity();
            for axis in 0..3 {
                let spin = Vector::ith(axis, 1.0).cross(&(x[node] - center));
                part.set_column(3 + axis, &spin);
            }
            motions.view_mut((3 * node, 6 * a), (3, 6)).copy_from(&part);
        }
    }
    let galerkin = motions.transpose() * &matrix * &motions;
    let r: Vec<Vector> = (0..count)
        .map(|k| if free[k] { Vector::new(1.0, k as f64, -2.0) } else { Vector::zeros() })
        .collect();
    let flat = nalgebra::DVector::from_iterator(3 * count, r.iter().flat_map(|v| [v.x, v.y, v.z]));
    let amounts = galerkin.cholesky().expect("definite").solve(&(motions.transpose() * flat));
    let expected = &motions * amounts;
    let displacements = correct(&mut coarse, &r);
    for node in 0..count {
        let found = displacements[node];
        for axis in 0..3 {
            assert!((found[axis] - expected[3 * node + axis]).abs() < 1e-11, "node {node}");
        }
    }
}

#[test]
fn aggregates_with_fewer_than_six_motions_are_solved() {
    // Aggregates with one free node, two and none: spins and shifts that move nothing are dropped.
    let (x, pattern, values, scalar, _) = chain();
    let free: Vec<bool> = (0..12).map(|k| [0, 4, 5].contains(&k)).collect();
    let system = System { pattern: &pattern, values: &values, scalar: &scalar, springs: None, free: &free };
    let mut coarse = Coarse::new(&[0..4, 4..7, 7..12], &x, |row, visit| {
        pattern.columns[pattern.row(row)].iter().for_each(|&c| visit(c));
        scalar.off_pattern(row).0.iter().for_each(|&c| visit(c));
    });
    coarse.build(&system, &x, 100);
    let r: Vec<Vector> =
        free.iter().map(|&f| if f { Vector::new(1.0, 2.0, 3.0) } else { Vector::zeros() }).collect();
    let displacements = correct(&mut coarse, &r);
    for node in 0..12 {
        let displacement = displacements[node];
        assert!(displacement.iter().all(|d| d.is_finite()));
        assert!(free[node] || displacement.norm() == 0.0);
    }
    // The correction of the single node is the exact solution.
    let alone = values.diagonal[0].try_inverse().expect("regular") * r[0];
    assert!((displacements[0] - alone).norm() < 1e-9, "{} {alone}", displacements[0]);
}
