use super::*;

const O: Point = Point::new(0.0, 0.0, 0.0);
const X: Point = Point::new(1.0, 0.0, 0.0);
const Y: Point = Point::new(0.0, 1.0, 0.0);

fn p(x: f64, y: f64, z: f64) -> Point {
    Point::new(x, y, z)
}

#[test]
fn an_edge_pierces_touches_or_misses_a_triangle() {
    let t = [&O, &X, &Y];
    for (q0, q1, expected) in [
        (p(0.25, 0.25, -1.0), p(0.25, 0.25, 1.0), true),
        (p(0.75, 0.75, -1.0), p(0.75, 0.75, 1.0), false),
        (p(0.5, 0.5, -1.0), p(0.5, 0.5, 1.0), true),
        (p(0.25, 0.25, 0.0), p(0.25, 0.25, 1.0), true),
        (p(0.25, 0.25, f64::EPSILON), p(0.25, 0.25, 1.0), false),
        (p(0.0, 0.0, -1.0), p(0.0, 0.0, 1.0), true),
        // In the plane: across, inside, beside, along the hypotenuse, collinear with a side.
        (p(-1.0, 0.25, 0.0), p(2.0, 0.25, 0.0), true),
        (p(0.25, 0.25, 0.0), p(0.3, 0.25, 0.0), true),
        (p(-1.0, -0.25, 0.0), p(2.0, -0.25, 0.0), false),
        (p(2.0, -1.0, 0.0), p(1.5, -0.5, 0.0), false),
        (p(2.0, -1.0, 0.0), p(1.0, 0.0, 0.0), true),
        (p(1.5, 0.0, 0.0), p(2.0, 0.0, 0.0), false),
    ] {
        assert_eq!(edge_triangle([&q0, &q1], t), expected, "{q0} {q1}");
        assert_eq!(edge_triangle([&q1, &q0], [t[1], t[0], t[2]]), expected, "{q0} {q1}");
    }
}

#[test]
fn degenerate_elements_are_what_they_span() {
    let half = p(0.5, 0.0, 0.0);
    // A triangle that is a segment, one that is a point, an edge that is a point.
    assert!(edge_triangle([&p(0.75, -1.0, 0.0), &p(0.75, 1.0, 0.0)], [&O, &half, &X]));
    assert!(!edge_triangle([&p(1.25, -1.0, 0.0), &p(1.25, 1.0, 0.0)], [&O, &half, &X]));
    assert!(edge_triangle([&O, &X], [&half, &half, &half]));
    assert!(!edge_triangle([&O, &X], [&Y, &Y, &Y]));
    assert!(edge_triangle([&half, &half], [&O, &X, &Y]));
    assert!(!edge_triangle([&p(2.0, 0.0, 0.0); 2], [&O, &X, &Y]));
    assert!(edge_edge([&half, &half], [&O, &X]) && !edge_edge([&Y, &Y], [&O, &X]));
    assert!(point_on_edge(&O, [&O, &O]) && !point_on_edge(&X, [&O, &O]));
    assert!(point_on_triangle(&half, [&O, &X, &X]) && !point_on_triangle(&Y, [&O, &X, &X]));
}

#[test]
fn decisions_are_exact_where_rounding_would_blur_them() {
    // On the plane x + y + z = 3e4 exactly, and one unit in the last place off it.
    let (a, b, c) = (p(1e4, 1e4, 1e4), p(1e4 + 1.0, 1e4 - 1.0, 1e4), p(1e4 + 1.0, 1e4, 1e4 - 1.0));
    let inside = p(1e4 + 0.75, 1e4 - 0.375, 1e4 - 0.375);
    let off = p(inside.x.next_up(), inside.y, inside.z);
    assert!(point_on_triangle(&inside, [&a, &b, &c]));
    assert!(!point_on_triangle(&off, [&a, &b, &c]));
    assert!(!edge_triangle([&off, &(off + nalgebra::Vector3::new(1.0, 1.0, 1.0))], [&a, &b, &c]));
    assert!(edge_triangle([&inside, &off], [&a, &b, &c]));
}
