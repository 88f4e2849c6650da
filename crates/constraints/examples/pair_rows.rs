//! Contact rows of a vertex above a triangle, in both forms: values and gradients where they were linearised, and
//! what they say about targets on either side.
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

    // Over the inside the two differ only in what they ask of the triangle's vertices; beside the triangle
    // the volume would be a false wall in its whole plane, so that the gap form stands in.
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
            // No row pushes a pair as a whole: the gradients cancel.
            assert!(row.gradients.iter().sum::<Vector>().norm() < 1e-12);
        }
    }
}
