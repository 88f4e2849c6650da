use super::*;

fn square() -> (Vec<Point>, Vec<[u32; 3]>) {
    let positions = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    (positions.map(|[x, y]| Point::new(x, y, 0.5)).to_vec(), vec![[0, 1, 2], [0, 2, 3]])
}

fn messages(positions: &[Point], triangles: &[[u32; 3]]) -> Vec<String> {
    check_mesh(positions, triangles).iter().map(ToString::to_string).collect()
}

#[test]
fn a_good_mesh_has_no_problem() {
    let (positions, triangles) = square();
    assert_eq!(check_mesh(&positions, &triangles), []);
    // It has none far from the origin, at a tiny or huge size, or as a needle that is still a triangle.
    for (scale, shift) in [(1.0, 1e4), (1e-200, 0.0), (1e200, 0.0)] {
        let moved: Vec<Point> = positions.iter().map(|p| p.map(|x| x * scale + shift)).collect();
        assert_eq!(check_mesh(&moved, &triangles), []);
    }
    let needle: Vec<Point> = positions.iter().map(|p| Point::new(p.x, p.y * 1e-12, p.z)).collect();
    assert_eq!(check_mesh(&needle, &triangles), []);
}

#[test]
fn every_problem_names_its_element_and_place() {
    let (mut positions, mut triangles) = square();
    positions.push(Point::new(2.0, 2.0, 0.5));
    positions.push(Point::new(f64::NAN, 0.0, 0.0));
    triangles.extend([[0, 2, 4], [3, 0, 2], [1, 1, 2], [0, 1, 9], [2, 3, 0]]);
    assert_eq!(
        messages(&positions, &triangles),
        [
            "vertex 5 has a coordinate that is not finite: (NaN, 0, 0)",
            "triangle 5 names vertex 9, but there are only 6 vertices",
            "triangle 2 (vertices 0, 2, 4) has zero area, at (1, 1, 0.5)",
            "triangle 4 (vertices 1, 1, 2) has zero area, at (1, 0.3333333333333333, 0.5)",
            "triangle 3 repeats triangle 1 (vertices 3, 0, 2), at (0.3333333333333333, 0.6666666666666666, \
             0.5)",
            "triangle 6 repeats triangle 1 (vertices 2, 3, 0), at (0.3333333333333333, 0.6666666666666666, \
             0.5)",
            "vertex 5 belongs to no triangle, at (NaN, 0, 0)",
        ]
    );
}

#[test]
fn zero_area_is_found_where_rounding_hides_it() {
    // Collinear exactly in decimal, but not as stored.
    let line = [0.1, 0.2, 0.7].map(|t| Point::new(t, 3.0 * t, 0.3 * t));
    assert_eq!(messages(&line, &[[0, 1, 2]]).len(), 1);
    let point = [Point::new(1e4, 0.0, 1.0); 3];
    assert_eq!(messages(&point, &[[0, 1, 2]]).len(), 1);
}
