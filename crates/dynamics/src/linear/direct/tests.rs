use super::*;
use crate::linear::block::BlockValues;
use crate::linear::scalar::ScalarBuilder;

#[test]
fn strands_are_solved_exactly_and_fill_in_little() {
    // Two strands of 30 nodes with links to first and second neighbors, one with a branch of 5 nodes, and a
    // node in neither; some nodes are held.
    let count = 66u32;
    let pattern = BlockPattern::from_cliques(count as usize, |visit| {
        (0..28).for_each(|k| visit(&[k, k + 1, k + 2]));
        (30..58).for_each(|k| visit(&[k, k + 1, k + 2]));
        visit(&[40, 60, 61]);
        (60..63).for_each(|k| visit(&[k, k + 1, k + 2]));
    });
    let mut values = BlockValues::zeros(&pattern);
    for row in 0..count {
        values.diagonal[row as usize] = Matrix3::from_diagonal_element(9.0);
        for k in pattern.row(row as usize) {
            let column = pattern.columns[k];
            let (low, high) = (row.min(column), row.max(column));
            let block =
                Matrix3::from_fn(|i, j| ((low * 7 + high * 3 + 3 * i as u32 + j as u32) as f64).sin());
            values.blocks[k] = if row < column { block } else { block.transpose() };
        }
    }
    let scalar = ScalarBuilder::new(count as usize).build().split(&pattern);
    let free: Vec<bool> = (0..count).map(|k| k != 0 && k != 45).collect();
    let system = System { pattern: &pattern, values: &values, scalar: &scalar, springs: None, free: &free };
    let members: Vec<bool> = (0..count).map(|k| k != 65).collect();
    let mut direct = Direct::new(&pattern, &members).expect("strands");
    assert_eq!(direct.groups.len(), 1);
    assert!(direct.groups[0].symbolic.fill() <= 3 * 65, "{}", direct.groups[0].symbolic.fill());

    direct.build(&system);
    let solution: Vec<Vector> = (0..count as usize)
        .map(|k| {
            if free[k] && members[k] {
                Vector::new(1.0 + k as f64, (k as f64).cos(), 2.0)
            } else {
                Vector::zeros()
            }
        })
        .collect();
    let mut r = vec![Vector::zeros(); count as usize];
    system.multiply(&solution, &mut r);
    let lanes: Vec<Lane<f64>> = r.iter().map(|r| Lane::new(r, 1.0)).collect();
    direct.solve(&lanes);
    for k in 0..65 {
        let found = direct.displacement(k).expect("a member");
        assert!((found - solution[k]).norm() < 1e-11, "{k}: {found} {}", solution[k]);
    }
    assert_eq!(direct.displacement(65), None);
    assert!(Direct::new(&pattern, &[false; 66]).is_none());
}
