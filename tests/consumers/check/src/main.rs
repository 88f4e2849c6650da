//! Two triangles, one of which passes through the other.
#![allow(clippy::print_stdout, reason = "a command")]

use bowknot_check::geometry::{Point, Vector};
use bowknot_check::{CheckError, Judge, Parts, PathOptions, StateOptions};

fn main() -> Result<(), CheckError> {
    let triangle = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]].map(Point::from);
    let state = |height: f64| -> Vec<Point> {
        let lifted = triangle.map(|p| p + Vector::new(0.1, 0.1, height));
        triangle.into_iter().chain(lifted).collect()
    };
    let judge =
        Judge::new(&Parts { vertex_count: 6, triangles: &[[0, 1, 2], [3, 4, 5]], ..Parts::default() })?;
    let (above, below) = (state(0.01), state(-0.01));
    assert!(judge.check_state(&above, &StateOptions::default())?.is_clear());
    assert!(judge.check_state(&below, &StateOptions::default())?.is_clear());
    let path = judge.check_path(&above, &below, &PathOptions::default())?;
    println!("{} pairs meet on the way", path.hit_count);
    assert!(!path.is_clear());
    Ok(())
}

#[test]
fn runs() {
    main().unwrap();
}
