use super::*;
use nalgebra::{DMatrix, DVector};

type Block = SMatrix<f64, 2, 2>;

struct Grid {
    positions: Vec<Vector>,
    rows: Vec<Vec<u32>>,
    blocks: Vec<Vec<Block>>,
    dense: DMatrix<f64>,
}

/// A grid graph with symmetric positive definite blocks.
fn grid(n: usize) -> Grid {
    let count = n * n;
    let mut positions = Vec::new();
    let mut rows = vec![Vec::new(); count];
    for j in 0..n {
        for i in 0..n {
            positions.push(Vector::new(i as f64, j as f64, 0.0));
            let me = i + j * n;
            rows[me].push(me as u32);
            if i + 1 < n {
                rows[me].push(me as u32 + 1);
                rows[me + 1].push(me as u32);
            }
            if j + 1 < n {
                rows[me].push((me + n) as u32);
                rows[me + n].push(me as u32);
            }
        }
    }
    let mut dense = DMatrix::zeros(2 * count, 2 * count);
    for (i, row) in rows.iter().enumerate() {
        for &j in row.iter().filter(|&&j| j as usize >= i) {
            let j = j as usize;
            for a in 0..2 {
                for b in 0..2 {
                    let value = if i == j {
                        if a == b { 9.0 } else { 1.0 }
                    } else {
                        ((i + 3 * j + 5 * a + 7 * b) as f64).sin()
                    };
                    dense[(2 * i + a, 2 * j + b)] = value;
                    dense[(2 * j + b, 2 * i + a)] = value;
                }
            }
        }
    }
    let blocks = rows
        .iter()
        .enumerate()
        .map(|(i, row)| {
            row.iter().map(|&j| dense.fixed_view::<2, 2>(2 * i, 2 * j as usize).into_owned()).collect()
        })
        .collect();
    Grid { positions, rows, blocks, dense }
}

#[test]
fn the_solution_is_that_of_a_dense_factorization() {
    let Grid { positions, rows, blocks, dense } = grid(9);
    let symbolic = Symbolic::new(&positions, |i| &rows[i]);
    let mut factor = Cholesky::<2>::default();
    factor.factorize(&symbolic, PivotPolicy::Drop, |i| (&rows[i], &blocks[i]));
    let right = DVector::from_fn(dense.nrows(), |i, _| (i as f64 * 0.7).cos());
    let exact = dense.cholesky().expect("diagonally dominant").solve(&right);
    let mut x: Vec<SVector<f64, 2>> =
        symbolic.order.iter().map(|&old| right.fixed_rows::<2>(2 * old as usize).into_owned()).collect();
    factor.solve(&symbolic, &mut x);
    for (new, &old) in symbolic.order.iter().enumerate() {
        assert!((x[new] - exact.fixed_rows::<2>(2 * old as usize)).norm() < 1e-12);
    }
}

#[test]
fn nested_dissection_fills_less_than_a_band() {
    let Grid { positions, rows, .. } = grid(32);
    let symbolic = Symbolic::new(&positions, |i| &rows[i]);
    // A band matrix of width 32 has 32 * 1024 entries.
    assert!(symbolic.fill() < 32 * 1024 / 2, "{}", symbolic.fill());
}

#[test]
fn semi_definite_systems_give_a_solution() {
    // Two equal unknowns: the second is dropped, and the equation still holds.
    let block = SMatrix::<f64, 2, 2>::new(4.0, 4.0, 4.0, 4.0);
    let rows = [0u32];
    let symbolic = Symbolic::new(&[Vector::zeros()], |_| &rows);
    let mut factor = Cholesky::<2>::default();
    let blocks = [block];
    factor.factorize(&symbolic, PivotPolicy::Drop, |_| (&rows, &blocks));
    let mut x = [SVector::<f64, 2>::new(8.0, 8.0)];
    factor.solve(&symbolic, &mut x);
    assert!((block * x[0] - SVector::<f64, 2>::new(8.0, 8.0)).norm() < 1e-14);
}
