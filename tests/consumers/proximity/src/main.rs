//! All pairs nearer than 2 cm between two strips.
#![allow(clippy::print_stdout, reason = "a command")]

use bowknot_proximity::geometry::{PairKind, Point, Topology};
use bowknot_proximity::{CollisionModel, PairList, ProximitySearch};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // Two strips of ten cells of 5 cm, one 1 cm above the other.
    let mut x = Vec::new();
    let mut triangles = Vec::new();
    for layer in 0..2u32 {
        let first = x.len() as u32;
        for i in 0..11 {
            let (along, height) = (0.05 * i as f64, 0.01 * layer as f64);
            x.extend([Point::new(along, 0.0, height), Point::new(along, 0.05, height)]);
        }
        for i in 0..10 {
            let a = first + 2 * i;
            triangles.extend([[a, a + 2, a + 1], [a + 1, a + 2, a + 3]]);
        }
    }
    let topology = Topology::builder(x.len()).triangles(triangles).build()?;
    let model = CollisionModel::single_body(topology);
    let (mut pairs, mut separations) = (PairList::default(), Vec::new());
    // Both sides reach 1 cm.
    let radii = vec![0.01; x.len()];
    ProximitySearch::new(&model).search(&model, &x, &radii, &mut pairs, &mut separations);

    let smallest = separations.iter().map(|s| s.distance).fold(f64::INFINITY, f64::min);
    let facing = pairs.range(PairKind::VertexTriangle).len();
    println!("{} pairs, {facing} of a vertex and a triangle, the nearest {smallest:.4} m apart", pairs.len());
    assert!((smallest - 0.01).abs() < 1e-15);
    // Every vertex faces at least one triangle of the other strip.
    for v in 0..x.len() as u32 {
        assert!(pairs.pairs()[pairs.range(PairKind::VertexTriangle)].iter().any(|p| p.elements[0] == v));
    }
    Ok(())
}

#[test]
fn runs() {
    main().unwrap();
}
