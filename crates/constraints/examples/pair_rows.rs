//! Contact rows of a vertex above a triangle, in both forms: values and gradients at the linearization point,
//! and values at targets on both sides.
//!
//! `cargo run --release -p bowknot-constraints --example pair_rows`
#![allow(clippy::print_stdout)]

use bowknot_constraints::{ContactForm, contact_row, predicted_gap};
use bowknot_geometry::{PairKind, Point, Vector, separation};

/// The distance that the pair should keep [m].
const DESIRED: f64 = 0.02;

fn main() {
    let kind = PairKind::VertexTriangle;
    let vertices = [0, 1, 2, 3];
    let triangle = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]].map(Point::from);

    // Above the interior the two forms differ only in the gradients of the triangle's vertices. Beside the
    // triangle the volume form would block the whole plane of the triangle, so the gap form applies.
    for (place, vertex) in [("over the inside", [0.25, 0.25, 0.05]), ("beside an edge", [0.5, -0.04, 0.005])]
    {
        let x = [Point::from(vertex), triangle[0], triangle[1], triangle[2]];
        let separation = separation::separate(kind, &x);
        println!("vertex {place}: {:.4} m from the triangle", separation.distance);
        for form in [ContactForm::Gap, ContactForm::Volume] {
            let row = contact_row(form, kind, vertices, &x, &separation, DESIRED);
            println!("  {form:?} form: value {:+.5} m", row.value(&x.map(|p| p.coords)));
            for (k, g) in row.gradients.iter().enumerate() {
                println!("    gradient of vertex {k}: ({:+.3}, {:+.3}, {:+.3})", g.x, g.y, g.z);
            }
            for fall in [0.02, 0.04, 0.1] {
                let y = [x[0] - fall * Vector::z(), x[1], x[2], x[3]];
                let value = row.value(&y.map(|p| p.coords));
                let gap = predicted_gap(kind, &vertices, &separation, &x, &y);
                let verdict = if value < 0.0 { "violated" } else { "met" };
                println!("    {fall:.2} m lower: value {value:+.5} m, {verdict}; predicted gap {gap:+.5} m");
            }
            // No row pushes the pair as a whole: the gradients sum to zero.
            assert!(row.gradients.iter().sum::<Vector>().norm() < 1e-12);
        }
    }
}
