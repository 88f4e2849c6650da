use super::*;

const STYLE: Style = Style { strand_radius: 0.05, particle_radius: 0.2 };

fn points() -> Vec<Point> {
    (0..7).map(|k| Point::new(1000.0 + f64::from(k), f64::from(k % 2), f64::from(k / 3))).collect()
}

#[test]
fn a_drawing_holds_everything_around_its_origin() {
    let elements = Elements {
        triangles: &[[0, 1, 2]],
        strands: &[[3, 4], [4, 5]],
        particles: &[6],
        obstacle: &[false, false, false, true, true, true, false],
        body: &[0, 0, 0, 1, 1, 1, 2],
    };
    let points = points();
    let model = Model::new(&elements, &points, &STYLE).unwrap();
    let values = [0.5, 2.0, f32::NAN, 0.0, 0.0, 0.0, -3.0];
    let drawing = model.drawing(&Frame { positions: &points, values: &values }).unwrap();
    assert_eq!((drawing.balls.len(), drawing.indices.len() % 3), (1, 0));
    assert!(drawing.indices.iter().all(|&v| (v as usize) < drawing.vertices.len()));
    for vertex in &drawing.vertices {
        let distance = vertex.point.iter().map(|c| c * c).sum::<f32>().sqrt();
        assert!(f64::from(distance) <= drawing.radius);
    }
    let shown: Vec<f32> = drawing.vertices[..3].iter().map(|v| v.value).collect();
    assert_eq!(shown, [0.5, 1.0, -1.0]);
    assert_eq!(drawing.balls[0].value, 0.0);
    assert_eq!(drawing.vertices[0].color[..3], palette::body(0));
    assert_eq!(drawing.vertices[3].color, [176, 178, 182, 0]);
    // Colors of one's own leave the sides of a surface as they are.
    let mut model = model;
    let colors: Vec<[u8; 3]> = (0..7).map(|v| [v, 0, 1]).collect();
    model.set_colors(&colors).unwrap();
    let drawing = model.drawing(&Frame { positions: &points, values: &values }).unwrap();
    assert_eq!(drawing.vertices[1].color, [1, 0, 1, 255]);
    assert_eq!((drawing.vertices[3].color[3], drawing.balls[0].color[..3].to_vec()), (0, vec![6, 0, 1]));
    assert!(model.set_colors(&colors[1..]).is_err());
}

#[test]
fn arrays_that_do_not_fit_are_refused() {
    let points = points();
    let wrong = Elements { strands: &[[0, 1], [2, 7]], ..Elements::default() };
    let error = Model::new(&wrong, &points, &STYLE).unwrap_err().to_string();
    assert_eq!(error, "strand edge 1 names vertex 7, but there are only 7 vertices");
    let short = Elements { body: &[0], ..Elements::default() };
    assert!(Model::new(&short, &points, &STYLE).is_err());
    let model = Model::new(&Elements::default(), &points, &STYLE).unwrap();
    assert!(model.drawing(&Frame { positions: &points[1..], values: &[] }).is_err());
    assert!(model.drawing(&Frame { positions: &points, values: &[0.0] }).is_err());
    // A model without elements is not an error.
    assert!(model.drawing(&Frame { positions: &points, values: &[] }).unwrap().radius > 0.0);
}
