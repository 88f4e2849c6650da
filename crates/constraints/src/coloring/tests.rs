use super::*;

fn check(rows: &[Vec<u32>], vertex_count: usize) -> usize {
    let mut coloring = Coloring::default();
    for _ in 0..2 {
        // Twice: the first call must leave the scratch clean.
        coloring.first_fit(vertex_count, rows.len(), |r| rows[r].iter().copied());
        let mut seen: Vec<u32> = coloring.order().to_vec();
        seen.sort_unstable();
        assert_eq!(seen, (0..rows.len() as u32).collect::<Vec<_>>());
        for range in coloring.ranges() {
            let mut used = vec![false; vertex_count];
            for &row in &coloring.order()[range] {
                for &v in &rows[row as usize] {
                    assert!(!std::mem::replace(&mut used[v as usize], true), "two rows of a color share {v}");
                }
            }
        }
    }
    coloring.color_count()
}

#[test]
fn a_path_needs_two_colors() {
    let rows: Vec<Vec<u32>> = (0..100).map(|i| vec![i, i + 1]).collect();
    assert_eq!(check(&rows, 101), 2);
}

#[test]
fn a_star_needs_one_color_per_row_even_beyond_the_mask() {
    let rows: Vec<Vec<u32>> = (0..300).map(|i| vec![0, i + 1]).collect();
    assert_eq!(check(&rows, 301), 300);
}

#[test]
fn rows_without_movable_vertices_and_no_rows_are_fine() {
    assert_eq!(check(&[vec![], vec![], vec![3]], 4), 1);
    assert_eq!(check(&[], 0), 0);
}
